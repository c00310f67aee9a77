# Chores of the project: `just` lists them (https://just.systems). Each line also works in a shell.

# The list.
default:
    @just --list

# The inner loop: does it compile, is it formatted?
check:
    cargo fmt --all --check
    cargo check --workspace --all-targets

# Unit tests of all crates, without the long tests of the folder tests.
unit:
    cargo test --release -p voussoir-core -p voussoir-laws -p voussoir-solvers

# All tests.
test:
    cargo test --workspace --release --locked

# All of CI.
ci:
    .ci/run

# The long stress tests that CI leaves out.
stress:
    cargo test --release -p voussoir-tests --test stress -- --ignored

# Run time of limit analysis, paths and laws at a point.
bench:
    cargo bench -p voussoir-benches

# The tables of docs/notebook/performance.md.
goals:
    cargo build --release -p voussoir
    python3 benches/goals.py

# The book, to target/book.
book:
    cargo run --release -p voussoir-tests --example book -- target/book

# A small binary with drawings and pixels.
dist:
    cargo build --profile dist --locked -p voussoir --features png

# Packages of all crates, built from what they contain.
package:
    cargo package --locked -p voussoir-core -p voussoir-laws -p voussoir-solvers -p voussoir-external -p voussoir

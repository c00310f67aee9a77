# Chores of the project: `just` lists them (https://just.systems). Each line also works in a shell.

# Tests compile the crates below studies/ without optimisation. Use the same flags each time, or everything is compiled again.
light := "--config .ci/light.toml"

# The list.
default:
    @just --list

# The inner loop: less than a minute once compiled.
fast:
    cargo fmt --all --check
    cargo test --release --locked {{light}} --workspace --exclude voussoir-tests --exclude voussoir-benches --lib
    cargo test --release --locked {{light}} -p voussoir-tests --test architecture --test messages

# All tests.
test:
    cargo test --workspace --release --locked

# All of CI.
ci:
    .ci/run

# Everything that CI leaves out: long stress tests, benches, mutants, processors under emulation.
# It takes hours.
everything: ci stress bench mutants package
    .ci/extra features
    .ci/processors

# The long stress tests.
stress:
    cargo test --release --locked -p voussoir-tests -- --ignored

# Run time of limit analysis, paths and laws at a point.
bench:
    cargo bench --locked -p voussoir-benches

# Small faults are planted in the keys, the reports and the store; tests must find at least 80 % of them.
mutants:
    .ci/mutants

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
    strip "${CARGO_TARGET_DIR:-target}/dist/voussoir"

# Packages of all crates in order, each built from what its package contains. Cargo keeps unpacked packages by the path of the
# target folder, also if they have changed: hence one folder for each commit.
package:
    cargo package --workspace --locked --exclude voussoir-tests --exclude voussoir-independent --exclude voussoir-benches --target-dir "target/package-$(git rev-parse --short HEAD)"

# Public names of the crates for plug-ins, compared with a revision: `just semver v0.1.0`. It needs cargo-semver-checks and,
# for the first run, a network.
semver baseline="v0.1.0":
    cargo semver-checks -p voussoir-core -p voussoir-plug --baseline-rev {{baseline}}

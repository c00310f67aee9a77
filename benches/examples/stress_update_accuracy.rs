//! Run time against error of the stress update ([`voussoir_benches::walk`]). The program prints a Markdown table:
//! `cargo run --release -p voussoir-benches --example stress_update_accuracy`.

use voussoir_benches::walk::ladders;

fn main() {
    println!("| stone | update | increments or tolerance | returns | time [µs] | error |\n|---|---|---|---|---|---|");
    for (stone, kind, runs) in ladders() {
        for run in runs {
            let time = 1e6 * run.seconds;
            println!("| {stone} | {kind} | {} | {} | {time:.2} | {:.1e} |", run.setting, run.returns, run.error);
        }
    }
}

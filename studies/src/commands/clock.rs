//! Processor time of a thread.

use std::sync::LazyLock;
use std::time::Instant;

static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Processor time of this thread \[s\] on Linux; time since the start of the program on other systems.
pub fn processor_time() -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent = counted.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    spent.map_or_else(|| START.elapsed().as_secs_f64(), |nanoseconds| nanoseconds * 1e-9)
}

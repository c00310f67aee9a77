//! Work on several processors.

/// Does some work with at most `jobs` threads for what it does in parallel; results must not depend on their number.
pub fn side_by_side<T: Send>(jobs: usize, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(jobs.max(1)).build() {
        Ok(pool) => pool.install(work),
        // No thread to be had: the caller's own, and those of the process.
        Err(_) => work(),
    }
}

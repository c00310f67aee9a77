//! Parallel work on several processors.

use rayon::prelude::*;

/// Stack of a thread \[bytes\]: the usual stack of a program's first thread.
const STACK: usize = 8 << 20;

/// Runs `work` with at most `jobs` threads for its parallel parts. Results must not depend on the number of threads. Nested
/// calls share the threads of the outer call.
pub fn side_by_side<T: Send>(jobs: usize, work: impl FnOnce() -> T + Send) -> T {
    let jobs = jobs.max(1);
    if within() == Some(jobs) {
        return work();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(jobs).stack_size(STACK).build() {
        Ok(pool) => pool.install(work),
        // If no threads can be created, the calling thread does the work.
        Err(_) => work(),
    }
}

/// Applies `one` to each item and returns the results in the order of the items. Runs in parallel within [`side_by_side`],
/// otherwise sequentially.
pub fn in_order<A: Sync, B: Send>(items: &[A], one: impl Fn(&A) -> B + Send + Sync) -> Vec<B> {
    match within() {
        Some(2..) => items.par_iter().map(one).collect(),
        _ => items.iter().map(one).collect(),
    }
}

/// Returns the number of threads that [`in_order`] uses here.
pub fn threads() -> usize {
    within().unwrap_or(1)
}

/// Returns the number of threads of the enclosing [`side_by_side`]; `None` outside of it.
fn within() -> Option<usize> {
    rayon::current_thread_index().map(|_| rayon::current_num_threads())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_within_work_is_done_by_the_same_threads_and_in_order() {
        let items: Vec<usize> = (0..1000).collect();
        let squares = || in_order(&items, |i| i * i);
        assert_eq!(within(), None);
        let expected = squares();
        for jobs in [1, 2, 3] {
            let pool = || side_by_side(jobs, || (within(), rayon::current_thread_index()));
            let inner = side_by_side(jobs, || (rayon::current_thread_index(), pool(), squares()));
            assert_eq!(inner, (inner.1.1, (Some(jobs), inner.0), expected.clone()));
        }
    }
}

//! Work on several processors.

use rayon::prelude::*;

/// Stack of a thread: as much as the first one of a program has.
const STACK: usize = 8 << 20;

/// Does some work with at most `jobs` threads for what it does in parallel; results must not depend on their number.
/// Work within such work is done by the same threads.
pub fn side_by_side<T: Send>(jobs: usize, work: impl FnOnce() -> T + Send) -> T {
    let jobs = jobs.max(1);
    if within() == Some(jobs) {
        return work();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(jobs).stack_size(STACK).build() {
        Ok(pool) => pool.install(work),
        // No thread to be had: the caller's own, and those of the process.
        Err(_) => work(),
    }
}

/// What `one` makes of each item, in their order: side by side within [`side_by_side`], else one after the other.
pub fn in_order<A: Sync, B: Send>(items: &[A], one: impl Fn(&A) -> B + Send + Sync) -> Vec<B> {
    match within() {
        Some(2..) => items.par_iter().map(one).collect(),
        _ => items.iter().map(one).collect(),
    }
}

/// Threads that [`in_order`] works with here.
pub fn threads() -> usize {
    within().unwrap_or(1)
}

/// Threads of the work that the caller is a part of; `None` outside of such work.
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

//! Threads that work in parallel. A forked process has none of those of the process before: each makes its own when it first needs them.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// The threads of a process, and those of one that was forked from it.
struct Pool {
    process: u32,
    threads: ThreadPool,
    of_fork: OnceLock<Box<Pool>>,
}

static FIRST: OnceLock<Box<Pool>> = OnceLock::new();

/// Does work, whose parallel parts are done by threads of this process. All that may work in parallel is done here: threads of all of Rust, which are made
/// once for all, are gone in a forked process, and who waits for them waits for ever. Nothing that another thread may want is to be locked in `work`.
pub(crate) fn in_parallel<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    own(std::process::id()).install(work)
}

/// No lock is held while threads are made: another thread may fork meanwhile.
fn own(process: u32) -> &'static ThreadPool {
    let mut place = &FIRST;
    loop {
        match place.get() {
            Some(pool) if pool.process == process => return &pool.threads,
            Some(pool) => place = &pool.of_fork,
            None => {
                let threads = ThreadPoolBuilder::new().build();
                let of_fork = OnceLock::new();
                let threads = threads.unwrap_or_else(|error| panic!("threads cannot be started: {error}"));
                let _ = place.set(Box::new(Pool {
                    process,
                    threads,
                    of_fork,
                })); // or another thread's were made first
            }
        }
    }
}

//! Threads for parallel work. A forked process has none of its parent's threads: each process makes
//! its own when it first needs them.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// The threads of a process, and those of a process that was forked from it.
struct Pool {
    process: u32,
    threads: ThreadPool,
    of_fork: OnceLock<Box<Pool>>,
}

static FIRST: OnceLock<Box<Pool>> = OnceLock::new();

/// Does work whose parallel parts run on threads of this process. All parallel work has to run
/// here: the global threads of rayon are made only once and do not exist in a forked process, which
/// would wait for them forever. `work` must not lock anything that another thread may need.
pub(crate) fn in_parallel<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    own(std::process::id()).install(work)
}

/// The pool of a process. No lock is held while threads are made, because another thread may fork
/// meanwhile.
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
                })); // or another thread was faster
            }
        }
    }
}

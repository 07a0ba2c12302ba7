//! Threads: with a stack of their own size, no more than are of use, and as many of these as the system gives.

use std::thread::{Builder, JoinHandle, available_parallelism};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::Error;
use crate::float_mode::Standard;

/// Stack of a thread [bytes], whatever the environment asks for.
const STACK: usize = 2 << 20;

/// Threads to a processor beyond which more only cost.
const CROWD: usize = 4;

/// Starts a thread.
pub fn start(work: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, Error> {
    let builder = Builder::new().name("spanwise".to_string()).stack_size(STACK);
    builder.spawn(work).map_err(|e| Error::Threads(e.to_string()))
}

/// How many of so many threads are of use for so many tasks.
pub fn of_use(threads: usize, tasks: usize) -> usize {
    let processors = available_parallelism().map_or(1, usize::from);
    threads.min(CROWD * processors).min(tasks).max(1)
}

/// A pool of this many threads, or of fewer if the system does not give as many; at the worst the caller's own.
pub fn pool(threads: usize) -> Result<ThreadPool, Error> {
    let builder = ThreadPoolBuilder::new()
        .stack_size(STACK)
        .thread_name(|i| format!("spanwise-{i}"))
        // For as long as the thread lives.
        .start_handler(|_| std::mem::forget(Standard::set()));
    match threads {
        0 => builder.num_threads(1).use_current_thread().build().map_err(|e| Error::Threads(e.to_string())),
        _ => builder.num_threads(threads).build().or_else(|_| pool(threads / 2)),
    }
}

//! Threads and instruction set that a run works with, and its progress as others see it.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use crate::error::Error;
use crate::lane::dispatch::Isa;

/// Most samples that a worker takes at a time unless told otherwise.
pub const BLOCK: usize = 256;

/// Who does the work, and in which portions; none of it changes a result.
#[derive(Debug, Clone, Copy)]
pub struct Workers {
    /// The instruction set.
    pub isa: Isa,
    /// Threads at most: no more than are of use are started.
    pub threads: usize,
    /// Samples that a worker takes at a time; without it [`BLOCK`], or fewer where there is not much to share out.
    pub chunk: Option<usize>,
}

impl Workers {
    /// As many as the machine has, or as the caller wants.
    pub fn new(threads: Option<usize>) -> Result<Self, Error> {
        let threads = match threads {
            Some(0) => return Err(Error::input("threads", 0, "must be 1 or more")),
            Some(threads) if threads > 4096 => return Err(Error::input("threads", threads, "must be at most 4096")),
            Some(threads) => threads,
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };
        Ok(Workers { isa: Isa::chosen()?, threads, chunk: None })
    }
}

/// What others may see of a run, and whether it shall go on.
#[derive(Debug, Default)]
pub struct Progress {
    /// Samples done.
    pub done: AtomicUsize,
    /// Set to end the run.
    pub stop: AtomicBool,
}

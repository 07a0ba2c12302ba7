//! A run of a study: samples in portions on all cores, and what comes of them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rayon::prelude::*;

use super::clock::{Clock, Pace};
use super::record::{Failure, Layout, Record, Results};
use super::sample::Samples;
use super::simd::{self, Isa, SAMPLES};
use super::table::{Below, Table};
use super::together::{self, Part, Task};
use super::{March, Study, alone};
use crate::error::Error;
use crate::float_mode::Standard;
use crate::recovery::Place;
use crate::threads;

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

impl Study {
    /// Runs all samples.
    pub fn run(&self, samples: &Samples, workers: &Workers, progress: &Progress) -> Result<Run, Error> {
        // Here too, not only in the workers' threads: the geometry is laid out on this one.
        let _mode = Standard::set();
        samples.check(&self.vehicles())?;
        self.check_factors(samples)?;
        if !self.shares {
            // Before its entry a vehicle comes from the farther away, the faster it is.
            let fastest = samples.speeds.iter().copied().fold(0.0, f64::max);
            (0..self.kinds.len()).try_for_each(|kind| self.check_road(kind, fastest))?;
        }
        let layout = self.layout(samples);
        let count = samples.count;
        check_room(count, &layout)?;
        let own = if self.shares { self.marches(samples)? } else { vec![(0, 0); count] };
        let mut distinct: BTreeMap<March, Vec<u32>> = BTreeMap::new();
        for (sample, march) in own.iter().enumerate() {
            distinct.entry(*march).or_default().push(sample as u32);
        }
        let marches: Vec<March> = distinct.keys().copied().collect();
        let number: BTreeMap<March, u32> = marches.iter().zip(0..).map(|(&march, i)| (march, i)).collect();
        let of_samples: Vec<u32> = own.iter().map(|march| number[march]).collect();
        drop(own);
        self.check_tables(&marches, count as f64 * layout.bytes())?;
        let go_on = || !progress.stop.load(Ordering::Relaxed);
        let mut tables: Vec<Arc<Table>> = Vec::new();
        for &march in marches.iter().filter(|_| self.shares) {
            if !go_on() {
                return Err(Error::Interrupted);
            }
            tables.push(Arc::new(self.table(march)));
        }
        let couplings = vec![OnceLock::new(); marches.len()];
        let order: Vec<u32> = distinct.values().flatten().copied().collect();
        let mut results = Results {
            layout,
            numbers: vec![0.0; count * layout.width()],
            instants: vec![0; count * layout.instants()],
            marches: of_samples,
            digests: vec![0; count],
            failures: Vec::new(),
        };
        let failures = Mutex::new(Vec::new());
        // A few portions for every thread, in whole groups of lanes.
        let working = threads::of_use(workers.threads, count);
        let share = count.div_ceil(4 * working).next_multiple_of(SAMPLES).max(SAMPLES);
        let portions = portions(&distinct, &mut results, workers.chunk.unwrap_or(share.min(BLOCK)));
        let work = || {
            portions.into_par_iter().try_for_each(|portion| {
                let Portion { march, members, mut records, digests } = portion;
                let mut failed = Vec::new();
                let (kind, _) = marches[march];
                if self.shares {
                    let (table, couplings) = (&tables[march], &couplings[march]);
                    let task = Task { study: self, layout, samples, kind, table, couplings };
                    let (records, failed, go_on) = (&mut records[..], &mut failed, &go_on);
                    simd::with(workers.isa, Part { task, members, records, failed, go_on })?;
                } else {
                    for (&member, record) in members.iter().zip(&mut records) {
                        let sample = member as usize;
                        match alone::cross(self, &layout, samples, sample, record, &mut || go_on()) {
                            Ok(()) => {}
                            Err(Error::Interrupted) => return Err(Error::Interrupted),
                            Err(cause) => {
                                record.forget();
                                failed.push(Failure { sample, step: cause.step(), cause });
                            }
                        }
                    }
                }
                for (record, digest) in records.iter().zip(digests) {
                    *digest = record.digest();
                }
                if !failed.is_empty() {
                    failures.lock().unwrap_or_else(|e| e.into_inner()).extend(failed);
                }
                progress.done.fetch_add(members.len(), Ordering::Relaxed);
                if go_on() { Ok(()) } else { Err(Error::Interrupted) }
            })
        };
        threads::pool(working)?.install(work)?;
        results.failures = failures.into_inner().unwrap_or_else(|e| e.into_inner());
        results.failures.sort_by_key(|failure| failure.sample);
        if marches.len() > 1 {
            put_back(&order, &mut results);
        }
        let paces = marches.iter().zip(&tables).map(|(&(_, halvings), table)| Pace::new(table, halvings)).collect();
        let clock = Clock::new(self.settings.tail.seconds(), paces);
        let statics = marches.iter().zip(&tables).filter(|_| !layout.own_statics);
        let at_rest = statics.map(|((kind, _), table)| together::at_rest(self, *kind, table)).collect();
        Ok(Run { results, clock, at_rest })
    }

    /// Refuses geometry that there is no memory for beside results of so many bytes.
    fn check_tables(&self, marches: &[March], results: f64) -> Result<(), Error> {
        let rows = &self.analysis.rows;
        let bytes = |&(kind, halvings): &March| {
            let contacts = &self.vehicle(kind).assembly().contacts;
            let steps = self.plan(kind).0 as f64 * f64::from(1u32 << halvings);
            let kinds = if contacts.iter().all(|contact| contact.law.is_plain()) { 1 } else { 3 };
            let numbers = self.analysis.model.omega.len() * kinds + rows.width();
            steps * (contacts.len() * (size_of::<f64>() * numbers + size_of::<Below>() + size_of::<Place>())) as f64
        };
        let all: f64 = marches.iter().filter(|_| self.shares).map(bytes).sum();
        if results + all <= memory() {
            return Ok(());
        }
        let steps = marches.iter().map(|&(kind, halvings)| self.plan(kind).0 << halvings).max().unwrap_or(0);
        let allowed = format!(
            "the geometry of {steps} steps would take {:.1} GB of memory, more than there is: use fewer modes or longer \
             steps",
            all / 1e9
        );
        Err(Error::input("modes", self.analysis.model.omega.len(), allowed))
    }
}

/// Refuses more samples than can be numbered, or than there is memory for: a mistyped number is told at once.
fn check_room(count: usize, layout: &Layout) -> Result<(), Error> {
    let bytes = count as f64 * layout.bytes();
    if u32::try_from(count).is_ok() && bytes <= memory() {
        return Ok(());
    }
    let allowed = format!("results would take {:.1} GB of memory, more than there is; use fewer", bytes / 1e9);
    Err(Error::input("samples", count, allowed))
}

/// Memory of this machine [bytes]; where it does not say, what an address can reach. To ask the allocator would not help:
/// many systems promise more than they have.
fn memory() -> f64 {
    let told = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        line.trim().trim_end_matches(" kB").parse::<f64>().ok()
    });
    told.map_or(isize::MAX as f64, |kilobytes| 1024.0 * kilobytes)
}

/// What a run leaves.
#[derive(Debug)]
pub struct Run {
    /// The results.
    pub results: Results,
    /// What their instants mean.
    pub clock: Clock,
    /// Static extremes in the steps of each march, largest of all responses looked at, then smallest; none if samples have
    /// their own.
    pub at_rest: Vec<Vec<f64>>,
}

/// What a worker takes at a time.
struct Portion<'a> {
    march: usize,
    members: &'a [u32],
    records: Vec<Record<'a>>,
    digests: &'a mut [u64],
}

/// The samples of each march in portions, with the rows that they fill, which follow each other in this order.
fn portions<'a>(distinct: &'a BTreeMap<March, Vec<u32>>, results: &'a mut Results, chunk: usize) -> Vec<Portion<'a>> {
    let (width, instants) = (results.layout.width(), results.layout.instants());
    let mut numbers = &mut results.numbers[..];
    let mut moments = &mut results.instants[..];
    let mut digests = &mut results.digests[..];
    let mut portions = Vec::new();
    for (march, members) in distinct.values().enumerate() {
        for members in members.chunks(chunk) {
            let n = members.len();
            let (own_numbers, rest_numbers) = std::mem::take(&mut numbers).split_at_mut(n * width);
            let (own_moments, rest_moments) = std::mem::take(&mut moments).split_at_mut(n * instants);
            let (own_digests, rest_digests) = std::mem::take(&mut digests).split_at_mut(n);
            (numbers, moments, digests) = (rest_numbers, rest_moments, rest_digests);
            let rows = own_numbers.chunks_exact_mut(width).zip(own_moments.chunks_exact_mut(instants.max(1)));
            let records = rows.map(|(numbers, instants)| Record { numbers, instants }).collect();
            portions.push(Portion { march, members, records, digests: own_digests });
        }
    }
    portions
}

/// Puts rows that follow each other as in `order` in the order of the samples.
fn put_back(order: &[u32], results: &mut Results) {
    let (width, instants) = (results.layout.width(), results.layout.instants());
    let mut from: Vec<u32> = vec![0; order.len()];
    for (row, &sample) in order.iter().enumerate() {
        from[sample as usize] = row as u32;
    }
    for sample in 0..from.len() {
        // Round each cycle: the row that belongs here comes in exchange for the one that stands here.
        let mut here = sample;
        while from[here] as usize != sample {
            let there = from[here] as usize;
            swap_rows(&mut results.numbers, width, here, there);
            swap_rows(&mut results.instants, instants, here, there);
            results.digests.swap(here, there);
            from[here] = here as u32;
            here = there;
        }
        from[here] = here as u32;
    }
}

fn swap_rows<T>(values: &mut [T], width: usize, a: usize, b: usize) {
    let (a, b) = (a.min(b), a.max(b));
    let (low, high) = values.split_at_mut(b * width);
    low[a * width..(a + 1) * width].swap_with_slice(&mut high[..width]);
}

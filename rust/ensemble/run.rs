//! A run of a study: samples in portions on all cores, and what comes of them.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, OnceLock, RwLock};

use rayon::prelude::*;

use super::clock::{Clock, Pace};
use super::own_ways;
use super::results::{Failure, Format, Record, Results};
use super::room::Room;
use super::sample::Samples;
use super::shelf::{Shelf, are_few};
use super::side_by_side::{Part, Task};
use super::study::{March, Study};
use super::table::Layout;
use super::varied::vehicles;
use super::workers::{BLOCK, Progress, Workers};
use crate::error::Error;
use crate::float_mode::Standard;
use crate::lane::dispatch::{InLanes, with};
use crate::memory;
use crate::stop_token::StopToken;
use crate::threads;

impl Study {
    /// Runs all samples.
    pub fn run(&self, samples: &Samples, workers: &Workers, progress: &Progress) -> Result<Run, Error> {
        // Here too, not only in the workers' threads: the geometry is laid out on this one.
        let _mode = Standard::set();
        samples.check(&self.vehicles())?;
        samples.check_damping(&self.analysis.model.damping)?;
        if !self.shares {
            // Before its entry a vehicle comes from the farther away, the faster it is.
            let fastest = samples.speeds.iter().copied().fold(0.0, f64::max);
            (0..self.kinds.len()).try_for_each(|kind| self.check_road(kind, fastest))?;
        }
        let format = self.format(samples);
        let count = samples.count;
        check_room(count, &format)?;
        let (own, lost) = if self.shares { self.marches(samples) } else { (vec![(0, 0); count], Vec::new()) };
        if let Some(failure) = lost.first().filter(|_| lost.len() == count) {
            // What no sample can do is asked too much.
            return Err(failure.cause.clone());
        }
        let mut distinct: BTreeMap<March, Vec<u32>> = BTreeMap::new();
        let mut failing = lost.iter().map(|failure| failure.sample).peekable();
        for (sample, march) in own.iter().enumerate() {
            let members = distinct.entry(*march).or_default();
            if failing.next_if_eq(&sample).is_none() {
                members.push(sample as u32);
            }
        }
        let marches: Vec<March> = distinct.keys().copied().collect();
        let number: BTreeMap<March, u32> = marches.iter().zip(0..).map(|(&march, i)| (march, i)).collect();
        let of_samples: Vec<u32> = own.iter().map(|march| number[march]).collect();
        drop((own, number));
        let room = Room::of(self, samples, &marches, workers, count as f64 * format.bytes())?;
        let stopped = || progress.stop.load(Ordering::Relaxed);
        let order: Vec<u32> =
            distinct.values().flatten().copied().chain(lost.iter().map(|failure| failure.sample as u32)).collect();
        let mut results = Results {
            format,
            numbers: memory::zeros("samples", count, count * format.width())?,
            instants: memory::zeros("samples", count, count * format.instants())?,
            marches: of_samples,
            digests: memory::zeros("samples", count, count)?,
            failures: Vec::new(),
        };
        // A few portions for every thread, in whole groups of lanes.
        let working = threads::of_use(room.threads, count);
        let side_by_side = workers.isa.samples();
        let share = count.div_ceil(4 * working).next_multiple_of(side_by_side).max(side_by_side);
        let chunk = workers.chunk.unwrap_or(share.min(BLOCK));
        let shelf = |(&march, members): (&March, &Vec<u32>)| {
            let (kind, driven) = (march.0, self.is_driven(march.0));
            let fit = driven || own_ways::have_room(self, self.vehicle(kind).assembly().contacts.len());
            let few = fit && are_few(members.len(), driven);
            let laid_out = !few && room.lays_out(march);
            let layout = if laid_out { self.layout(kind, samples) } else { Layout::Bare };
            Shelf::new(march, few, layout, members.len().div_ceil(chunk))
        };
        let shelves: Vec<Shelf> = distinct.iter().filter(|_| self.shares).map(shelf).collect();
        let lost_rows = lost.len();
        let few = |march: usize| shelves.get(march).is_some_and(|shelf| shelf.few);
        let portions = portions(&distinct, few, &mut results, chunk);
        progress.done.fetch_add(lost.len(), Ordering::Relaxed);
        let failures = Mutex::new(lost);
        // Of crossings by themselves.
        let company = RwLock::new(());
        let own_ways = OnceLock::new();
        let work = |portion: Portion<'_>| {
            let Portion { marches: of_portion, members, mut records, digests } = portion;
            let (stop, mut failed) = (StopToken::when(&stopped), Vec::new());
            stop.check()?;
            let (study, failures_here) = (self, &mut failed);
            match of_portion[..] {
                [march] if shelves.get(march).is_some_and(|shelf| !shelf.few) => {
                    let shelf = &shelves[march];
                    let shared = shelf.take(self, &format, stop)?;
                    let task = Task { study, format, samples, kind: marches[march].0, shared: &shared };
                    let (members, records, failed) = (&members, &mut records[..], failures_here);
                    let part = Part { task, members, records, failed, stop };
                    if shared.table.laid_out {
                        with(workers.isa, part)?;
                    } else {
                        part.run::<f64>()?;
                    }
                    shelf.give_back();
                }
                _ => {
                    let shared = own_ways.get_or_init(|| own_ways::Shared::new(self, samples));
                    let of_members: Vec<(March, &Shelf)> = match self.shares {
                        true => of_portion.iter().map(|&march| (marches[march], &shelves[march])).collect(),
                        false => Vec::new(),
                    };
                    let (marches, members, company) = (&of_members, &members, &company);
                    let (records, failed) = (&mut records[..], failures_here);
                    let part = own_ways::Part {
                        study,
                        shared,
                        marches,
                        company,
                        format,
                        samples,
                        members,
                        records,
                        failed,
                        stop,
                    };
                    with(workers.isa, part)?;
                }
            }
            for (record, digest) in records.iter().zip(digests) {
                *digest = record.digest();
            }
            if !failed.is_empty() {
                failures.lock().unwrap_or_else(|e| e.into_inner()).extend(failed);
            }
            progress.done.fetch_add(members.len(), Ordering::Relaxed);
            stop.check()
        };
        // In order, so that few marches are under way at a time. One thread is this one.
        match working {
            1 => portions.into_iter().try_for_each(&work)?,
            _ => threads::pool(working)?.install(|| portions.into_iter().par_bridge().try_for_each(work))?,
        }
        results.failures = failures.into_inner().unwrap_or_else(|e| e.into_inner());
        results.failures.sort_by_key(|failure| failure.sample);
        if !self.shares && self.ask_too_much(samples, &results.failures) {
            return Err(results.failures.swap_remove(0).cause);
        }
        if distinct.len() > 1 || lost_rows > 0 {
            put_back(&order, &mut results);
        }
        let paces =
            marches.iter().filter(|_| self.shares).map(|&march| Pace { path: self.path(march), halvings: march.1 });
        let places = self.look.marks.iter().map(|mark| mark.x).collect();
        let clock = Clock::new(self.settings.tail.seconds(), places, paces.collect());
        let shelves = shelves.into_iter().filter(|_| !format.own_statics);
        let at_rest = shelves.map(|shelf| shelf.leaves(&format)).collect();
        Ok(Run { results, marches, clock, at_rest })
    }
}

impl Study {
    /// Whether no sample can do what is asked, though its vehicles are sound.
    fn ask_too_much(&self, samples: &Samples, failures: &[Failure]) -> bool {
        let refused = |f: &Failure| {
            f.cause.is_input() && vehicles(&self.kinds[samples.kind(f.sample)].passages, samples, f.sample).is_ok()
        };
        !failures.is_empty() && failures.len() == samples.count && failures.iter().all(refused)
    }
}

/// Refuses more samples than can be numbered, or than there is memory for: a mistyped number is told at once.
fn check_room(count: usize, format: &Format) -> Result<(), Error> {
    let mend = "use fewer";
    if u32::try_from(count).is_err() {
        return Err(Error::input("samples", count, format!("must be at most {}; {mend}", u32::MAX)));
    }
    memory::check("samples", count, count as f64 * format.bytes(), f64::INFINITY, "results", mend)
}

/// What a run leaves.
#[derive(Debug)]
pub struct Run {
    /// The results.
    pub results: Results,
    /// The marches that samples took.
    pub marches: Vec<March>,
    /// What their instants mean.
    pub clock: Clock,
    /// Static extremes in these steps, largest of all responses looked at, then smallest, by march; none if samples have
    /// their own.
    pub at_rest: Vec<Vec<f64>>,
}

/// What a worker takes at a time.
struct Portion<'a> {
    /// The march of all, or, of those that are few, that of each.
    marches: Vec<usize>,
    members: Vec<u32>,
    records: Vec<Record<'a>>,
    digests: &'a mut [u64],
}

/// The samples of each march in portions, those of marches of few together, with the rows that they fill, which follow
/// each other in this order; the rows behind them are those of samples without a result.
fn portions<'a>(
    distinct: &BTreeMap<March, Vec<u32>>,
    few: impl Fn(usize) -> bool,
    results: &'a mut Results,
    chunk: usize,
) -> Vec<Portion<'a>> {
    let mut parts: Vec<(Vec<usize>, Vec<u32>)> = Vec::new();
    for (march, members) in distinct.values().enumerate() {
        if !few(march) {
            parts.extend(members.chunks(chunk).map(|members| (vec![march], members.to_vec())));
            continue;
        }
        for &member in members {
            match parts.last_mut() {
                Some((marches, members)) if members.len() < chunk && few(marches[0]) => {
                    marches.push(march);
                    members.push(member);
                }
                _ => parts.push((vec![march], vec![member])),
            }
        }
    }
    let (width, instants) = (results.format.width(), results.format.instants());
    let mut numbers = &mut results.numbers[..];
    let mut moments = &mut results.instants[..];
    let mut digests = &mut results.digests[..];
    let mut portions = Vec::new();
    for (marches, members) in parts {
        let n = members.len();
        let (own_numbers, rest_numbers) = std::mem::take(&mut numbers).split_at_mut(n * width);
        let (own_moments, rest_moments) = std::mem::take(&mut moments).split_at_mut(n * instants);
        let (own_digests, rest_digests) = std::mem::take(&mut digests).split_at_mut(n);
        (numbers, moments, digests) = (rest_numbers, rest_moments, rest_digests);
        let rows = own_numbers.chunks_exact_mut(width).zip(own_moments.chunks_exact_mut(instants.max(1)));
        let records = rows.map(|(numbers, instants)| Record { numbers, instants }).collect();
        portions.push(Portion { marches, members, records, digests: own_digests });
    }
    let rows = numbers.chunks_exact_mut(width).zip(moments.chunks_exact_mut(instants.max(1)));
    for ((numbers, instants), digest) in rows.zip(digests) {
        let mut record = Record { numbers, instants };
        record.forget();
        *digest = record.digest();
    }
    portions
}

/// Puts rows that follow each other as in `order` in the order of the samples.
fn put_back(order: &[u32], results: &mut Results) {
    let (width, instants) = (results.format.width(), results.format.instants());
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

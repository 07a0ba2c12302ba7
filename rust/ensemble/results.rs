//! Results of a run: of each sample a row of numbers and one of instants, its fingerprint, and why it failed if it did.

use std::ops::Range;

use crate::error::Error;
use crate::extremes::Instant;
use crate::lane::Lane;
use crate::statistics::Ride;

/// Where everything stands in a sample's rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Format {
    /// Responses looked at.
    pub responses: usize,
    /// Axles, at most.
    pub axles: usize,
    /// Bodies, at most.
    pub bodies: usize,
    /// Whether each sample has static extremes of its own.
    pub own_statics: bool,
    /// Whether times and positions of the extremes are numbers, not instants that all samples share.
    pub own_times: bool,
}

/// A column of numbers in [`Format`]; of extremes the largest come first, then the smallest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// Extremes of the responses.
    Responses,
    /// Extremes of the axle loads [N].
    Loads,
    /// Root mean square of each axle load about its static value, by that value, on the bridge [-].
    LoadCoefficients,
    /// Time each axle was off the road [s].
    Aloft,
    /// Largest magnitude of the vertical acceleration of each body [m/s²].
    Accelerations,
    /// Root mean square of the same on the bridge [m/s²].
    Vibrations,
    /// Extremes of the static responses, if each sample has its own.
    Statics,
    /// Times of the extremes of responses, then of loads, if they are the sample's own [s].
    Times,
    /// Positions of the front axle at these [m].
    Positions,
    /// Length of the tail [s]; how far free vibration after it can exceed an extreme, in parts of the largest of its kind
    /// along the bridge, not a number where a vehicle stands on the bridge; and which: twice its place among the
    /// responses looked at, and one more of the smallest.
    Tail,
}

impl Format {
    /// Pairs of extremes: largest of all, smallest of all.
    fn extremes(&self) -> usize {
        2 * (self.responses + self.axles)
    }

    /// Where a column is among a sample's numbers.
    pub fn range(&self, column: Column) -> Range<usize> {
        let own = |own: bool, width: usize| if own { width } else { 0 };
        let widths = [
            (Column::Responses, 2 * self.responses),
            (Column::Loads, 2 * self.axles),
            (Column::LoadCoefficients, self.axles),
            (Column::Aloft, self.axles),
            (Column::Accelerations, self.bodies),
            (Column::Vibrations, self.bodies),
            (Column::Statics, own(self.own_statics, 2 * self.responses)),
            (Column::Times, own(self.own_times, self.extremes())),
            (Column::Positions, own(self.own_times, self.extremes())),
            (Column::Tail, 3),
        ];
        let mut start = 0;
        for (each, width) in widths {
            if each == column {
                return start..start + width;
            }
            start += width;
        }
        start..start
    }

    /// Whether all numbers that a sample of so many axles and bodies leaves are finite.
    pub fn is_finite(&self, numbers: &[f64], axles: usize, bodies: usize) -> bool {
        let finite = |column: Column, sides: usize, count: usize| {
            let range = self.range(column);
            let width = range.len() / sides;
            let numbers = &numbers[range];
            width == 0 || numbers.chunks(width).all(|side| side[..count.min(width)].iter().all(|v| v.is_finite()))
        };
        finite(Column::Responses, 2, usize::MAX)
            && finite(Column::Statics, 2, usize::MAX)
            && finite(Column::Loads, 2, axles)
            && finite(Column::LoadCoefficients, 1, axles)
            && finite(Column::Accelerations, 1, bodies)
            && finite(Column::Vibrations, 1, bodies)
    }

    /// Numbers of a sample.
    pub fn width(&self) -> usize {
        self.range(Column::Tail).end
    }

    /// Bytes of a sample, with its march, digest, and what it takes to share it out and to sort it in.
    pub fn bytes(&self) -> f64 {
        (8 * self.width() + 4 * self.instants() + 40 + size_of::<Record<'_>>()) as f64
    }

    /// Instants of a sample: of the extremes of responses and loads in the order of the numbers, then how often each axle
    /// left the road.
    pub fn instants(&self) -> usize {
        self.extremes() + self.axles
    }
}

/// A sample's rows, to be filled.
#[derive(Debug)]
pub struct Record<'a> {
    /// Numbers, after [`Format::range`].
    pub numbers: &'a mut [f64],
    /// Instants, after [`Format::instants`]; see [`encoded`].
    pub instants: &'a mut [u32],
}

/// The bit that tells a stop between two steps from a step.
const STOP: u32 = 1 << 31;

/// An instant as a number.
pub fn encoded(instant: Instant) -> u32 {
    match instant {
        Instant::Step(step) => step as u32,
        Instant::Stop(stop) => STOP | stop as u32,
    }
}

/// The instant of a number.
pub fn decoded(instant: u32) -> Instant {
    match instant & STOP {
        0 => Instant::Step(instant as usize),
        _ => Instant::Stop((instant & !STOP) as usize),
    }
}

impl Record<'_> {
    /// Marks the sample as one without a result.
    pub fn forget(&mut self) {
        self.numbers.fill(f64::NAN);
        self.instants.fill(0);
    }

    /// Writes down the ride of a vehicle in one lane, in steps of h [s]; its axles and bodies come after so many others.
    pub fn write_ride<L: Lane>(
        &mut self,
        format: &Format,
        ride: &Ride<L>,
        lane: usize,
        [axles, bodies]: [usize; 2],
        static_loads: &[f64],
        h: f64,
    ) {
        let column = |column: Column| format.range(column).start;
        for (own, &static_load) in static_loads.iter().enumerate() {
            let (k, peaks) = (axles + own, &ride.loads[own]);
            for (side, value) in [peaks.max, peaks.min].into_iter().enumerate() {
                self.numbers[column(Column::Loads) + side * format.axles + k] = value.get(lane) + 0.0;
            }
            self.numbers[column(Column::LoadCoefficients) + k] = ride.load_coefficient(own, lane, static_load);
            self.numbers[column(Column::Aloft) + k] = ride.aloft[own].get(lane) * h;
            self.instants[2 * (format.responses + format.axles) + k] = ride.lift_offs[own].get(lane) as u32;
        }
        for own in 0..ride.accelerations.len() {
            let b = bodies + own;
            self.numbers[column(Column::Accelerations) + b] = ride.accelerations[own].get(lane);
            self.numbers[column(Column::Vibrations) + b] = ride.vibration(own, lane);
        }
    }

    /// Fingerprint of the rows, the same on every machine.
    pub fn digest(&self) -> u64 {
        let mut hasher = xxhash_rust::xxh3::Xxh3::new();
        for number in self.numbers.iter() {
            // All that is not a number is one and the same.
            let bits = if number.is_nan() { f64::NAN.to_bits() } else { number.to_bits() };
            hasher.update(&bits.to_le_bytes());
        }
        for instant in self.instants.iter() {
            hasher.update(&instant.to_le_bytes());
        }
        hasher.digest()
    }
}

/// A sample that failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Its place among the samples of the run.
    pub sample: usize,
    /// The step in which it failed, if it came so far.
    pub step: Option<usize>,
    /// Why.
    pub cause: Error,
}

/// What a run leaves, in the order of its samples.
#[derive(Debug, Clone)]
pub struct Results {
    /// Where things are in the rows.
    pub format: Format,
    /// Numbers, sample after sample.
    pub numbers: Vec<f64>,
    /// Instants, sample after sample.
    pub instants: Vec<u32>,
    /// By sample, the march it took: which of the paces of its clock.
    pub marches: Vec<u32>,
    /// Fingerprint of every sample.
    pub digests: Vec<u64>,
    /// Samples without a result, in order.
    pub failures: Vec<Failure>,
}

impl Results {
    /// Fingerprint of all samples together.
    pub fn hash(&self) -> u64 {
        fingerprint(self.digests.iter().copied())
    }
}

/// Fingerprint of samples together, from that of each.
pub fn fingerprint(digests: impl Iterator<Item = u64>) -> u64 {
    let mut hasher = xxhash_rust::xxh3::Xxh3::new();
    for digest in digests {
        hasher.update(&digest.to_le_bytes());
    }
    hasher.digest()
}

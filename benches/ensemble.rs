//! Crossings per second of the headline case, what its roads take of that, and the share of the processor's peak it has.

#[path = "../tests/problems/mod.rs"]
mod problems;

use std::cell::Cell;
use std::hint::black_box;
use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group};
use problems::ensemble::{SEED, headline, isas, one, run, samples, synthesis};
use pulp::{Simd, WithSimd};
use spanwise::ensemble::Drawing;
use spanwise::lane::{InLanes, Lane, Lanes, Work, with};
use spanwise::road::Synthesis;

/// Crossings per measurement.
const CROSSINGS: usize = 256;

fn crossings(c: &mut Criterion) {
    let (study, synthesis) = (headline(), synthesis());
    let samples = samples(CROSSINGS);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut group = c.benchmark_group("ensemble/kishan_1973");
    group.throughput(Throughput::Elements(CROSSINGS as u64)).sampling_mode(SamplingMode::Flat).sample_size(20);
    group.warm_up_time(Duration::from_secs(1));
    for (name, isa) in isas() {
        group.bench_function(format!("modes=3/{name}"), |b| b.iter(|| run(&study, &samples, isa, 1)));
        group.bench_function(format!("modes=3/{name}/threads=all"), |b| {
            b.iter(|| run(&study, &samples, isa, threads));
        });
    }
    for (name, isa) in isas() {
        group.throughput(Throughput::Elements(isa.samples() as u64));
        let roads = Synthesised { synthesis: &synthesis };
        group.bench_function(BenchmarkId::new("roads", name), |b| b.iter(|| with(isa, roads)));
    }
    group.finish();
}

/// The roads of one block.
#[derive(Clone, Copy)]
struct Synthesised<'a> {
    synthesis: &'a Synthesis,
}

impl InLanes for Synthesised<'_> {
    type Output = usize;

    fn run<L: Lanes>(self) -> usize {
        let mut road: Vec<L> = Vec::new();
        let (synthesis, seed) = (self.synthesis, black_box(SEED));
        L::dispatch(Drawing { synthesis, seed, sample: |lane| lane as u64, road: &mut road });
        black_box(road).len()
    }
}

/// Independent sums a = a b + c of whole vectors, with a multiplication and an addition that stay apart as they do in the
/// engine: fused, they would be faster, but round differently from machine to machine.
///
/// By vector instructions, because the compiler fills vectors across sums if left to itself, and shuffles them back each
/// time.
struct Sums;

/// Two multiplications and two additions may begin in each cycle, and take three cycles each: twelve would do if nothing
/// were ever late. Fourteen, with b and c, fill the sixteen registers.
const SUMS: usize = 14;

const ROUNDS: usize = 20_000;

impl WithSimd for Sums {
    type Output = u64;

    /// Returns the number of operations done.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        // They tend to 2, so that nothing overflows or becomes denormal.
        let (b, c) = (simd.splat_f64s(black_box(0.5)), simd.splat_f64s(black_box(1.0)));
        let mut sums = [simd.splat_f64s(black_box(1.5)); SUMS];
        for _ in 0..ROUNDS {
            for a in &mut sums {
                *a = simd.add_f64s(simd.mul_f64s(*a, b), c);
            }
        }
        black_box(sums);
        (2 * S::F64_LANES * SUMS * ROUNDS) as u64
    }
}

/// Runs the sums once on vectors as wide as the instruction set has; returns their number of operations.
fn multiply_add(isa: &str) -> u64 {
    match isa {
        #[cfg(target_arch = "x86_64")]
        "avx2" => Simd::vectorize(pulp::x86::V3::try_new().unwrap(), Sums),
        #[cfg(target_arch = "x86_64")]
        "avx512" => Simd::vectorize(pulp::x86::V4::try_new().unwrap(), Sums),
        // Two numbers side by side, as every 64-bit processor has them.
        _ => Simd::vectorize(pulp::Scalar128b, Sums),
    }
}

fn peak(c: &mut Criterion) {
    let mut group = c.benchmark_group("peak/unfused-multiply-add");
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(2));
    for (name, _) in isas() {
        // Gelem/s are Gflop/s.
        group.throughput(Throughput::Elements(multiply_add(name)));
        group.bench_function(name, |b| b.iter(|| multiply_add(name)));
    }
    group.finish();
}

/// What a crossing computes.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    multiplications: u64,
    additions: u64,
    divisions: u64,
    negations: u64,
    comparisons: u64,
    selections: u64,
    exponentials: u64,
}

thread_local! {
    static COUNTS: Cell<Counts> = Cell::default();
}

fn count(of: impl FnOnce(&mut Counts) -> &mut u64) {
    let mut counts = COUNTS.get();
    *of(&mut counts) += 1;
    COUNTS.set(counts);
}

/// A lane of one number that counts what is done with it.
#[derive(Debug, Clone, Copy)]
struct Counted(f64);

#[derive(Debug, Clone, Copy)]
struct Truth(bool);

macro_rules! counted {
    ($trait:ident, $method:ident, $op:tt, $count:ident) => {
        impl $trait for Counted {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                count(|counts| &mut counts.$count);
                Counted(self.0 $op other.0)
            }
        }
    };
}

counted!(Add, add, +, additions);
counted!(Sub, sub, -, additions);
counted!(Mul, mul, *, multiplications);
counted!(Div, div, /, divisions);

impl Neg for Counted {
    type Output = Self;

    fn neg(self) -> Self {
        count(|counts| &mut counts.negations);
        Counted(-self.0)
    }
}

impl BitOr for Truth {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Truth(self.0 | other.0)
    }
}

impl Not for Truth {
    type Output = Self;

    fn not(self) -> Self {
        Truth(!self.0)
    }
}

impl Lane for Counted {
    type Mask = Truth;

    type Bits = u64;

    const SAMPLES: usize = 1;

    type Few = Self;

    fn few(&self, _number: usize) -> Self {
        *self
    }

    fn put_few(&mut self, _number: usize, numbers: Self) {
        *self = numbers;
    }

    fn splat(value: f64) -> Self {
        Counted(value)
    }

    fn from_fn(value: impl Fn(usize) -> f64) -> Self {
        Counted(value(0))
    }

    fn get(&self, _sample: usize) -> f64 {
        self.0
    }

    fn less(self, other: Self) -> Truth {
        count(|counts| &mut counts.comparisons);
        Truth(self.0 < other.0)
    }

    fn select(mask: Truth, yes: Self, no: Self) -> Self {
        count(|counts| &mut counts.selections);
        if mask.0 { yes } else { no }
    }

    fn all(mask: Truth) -> bool {
        mask.0
    }

    fn any(mask: Truth) -> bool {
        mask.0
    }

    fn magnitude(self) -> Self {
        Counted(self.0.abs())
    }

    fn exp(self) -> Self {
        count(|counts| &mut counts.exponentials);
        Counted(self.0.exp())
    }

    fn to_bits(self) -> u64 {
        self.0.to_bits()
    }

    fn from_bits(bits: u64) -> Self {
        Counted(f64::from_bits(bits))
    }
}

impl Lanes for Counted {
    fn dispatch<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

/// Counts the operations of a crossing and says which share of the peak they are at the measured speed.
///
/// Peak and crossings are measured in turns, and the best of each counts, so that what else the machine does disturbs
/// neither. What is done before the lanes come in, matrices of the step and phases of the waves, is not counted: it only
/// makes the share smaller.
fn share() {
    const COUNTED: usize = 16;
    const TURNS: usize = 15;
    let study = headline();
    let before = COUNTS.take();
    let counted: Vec<(Vec<f64>, Vec<u32>)> =
        (0..COUNTED).map(|number| one::<Counted>(&study, number as u64, true)).collect();
    let counts = COUNTS.replace(before);
    // Else something else was counted than what the engine does.
    let engine = run(&study, &samples(COUNTED), isas()[0].1, 1).results;
    let counted: Vec<f64> = counted.into_iter().flat_map(|(numbers, _)| numbers).collect();
    assert_eq!(counted, engine.numbers);
    let each = |count: u64| count as f64 / COUNTED as f64;
    let flops = each(counts.multiplications + counts.additions);
    println!("\none crossing of the headline case, mean of {COUNTED}, {} steps:", study.plan(0).0);
    println!("  {:.0} multiplications, {:.0} additions", each(counts.multiplications), each(counts.additions));
    println!("  {:.0} divisions, {:.0} negations", each(counts.divisions), each(counts.negations));
    println!("  {:.0} comparisons, {:.0} selections", each(counts.comparisons), each(counts.selections));
    println!("  {:.0} exponentials", each(counts.exponentials));
    let all = samples(CROSSINGS);
    let mut shares = Vec::new();
    for (name, isa) in isas() {
        let (mut peak, mut rate) = (0.0_f64, 0.0_f64);
        for _ in 0..TURNS {
            let started = Instant::now();
            let mut operations = 0;
            while started.elapsed() < Duration::from_millis(20) {
                operations += multiply_add(name);
            }
            peak = peak.max(operations as f64 / started.elapsed().as_secs_f64());
            let started = Instant::now();
            black_box(run(&study, &all, isa, 1));
            rate = rate.max(CROSSINGS as f64 / started.elapsed().as_secs_f64());
        }
        let (reached, share) = (rate * flops, 100.0 * rate * flops / peak);
        let [reached, peak] = [reached, peak].map(|flops| flops / 1e9);
        println!("{name}: {rate:.0} crossings/s, {reached:.2} of {peak:.1} Gflop/s, {share:.1} %");
        shares.push(format!("\"{name}\": {share:.2}"));
    }
    // For the history of the figures.
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/share.json"), format!("{{{}}}\n", shares.join(", ")))
        .unwrap();
}

criterion_group!(benches, crossings, peak);

fn main() {
    benches();
    share();
    Criterion::default().configure_from_args().final_summary();
}

//! Choosing among numbers in lanes, NaN, zeros of either sign and infinities among them: the same bits wherever it is done.

use std::marker::PhantomData;

use spanwise::extremes::Peaks;
use spanwise::lane::{Bits, InLanes, Isa, Lane, Lanes, Wide, Work, with};

/// All that can go wrong, and something that does not.
const NUMBERS: [f64; 14] = [
    f64::NAN,
    f64::NEG_INFINITY,
    f64::MIN,
    -1.0,
    -f64::MIN_POSITIVE,
    -5e-324,
    -0.0,
    0.0,
    5e-324,
    f64::MIN_POSITIVE,
    1.0,
    1.0 + f64::EPSILON,
    f64::MAX,
    f64::INFINITY,
];

/// Does a work, given what it works on, in lanes of every kind that the processor has, and checks each outcome.
macro_rules! in_all_lanes {
    ($work:ident of $given:ty, $what:expr, $check:expr) => {{
        struct Any<'a>(&'a $given);

        impl InLanes for Any<'_> {
            type Output = <$work<'static, f64> as Work>::Output;

            fn run<L: Lanes>(self) -> Self::Output {
                L::dispatch($work::<L>(self.0, PhantomData))
            }
        }

        let (what, check) = ($what, $check);
        check("single", f64::dispatch($work::<f64>(what, PhantomData)));
        check("one wide", Wide::<1>::dispatch($work::<Wide<1>>(what, PhantomData)));
        check("four wide", Wide::<4>::dispatch($work::<Wide<4>>(what, PhantomData)));
        for isa in Isa::present() {
            check(isa.name(), with(isa, Any(what)));
        }
    }};
}

/// NaN with a sign and a payload, by its bits.
fn other_nan() -> f64 {
    f64::from_bits(0xFFF8_0000_0000_1234)
}

fn numbers() -> Vec<f64> {
    NUMBERS.into_iter().chain([other_nan()]).collect()
}

/// Every pair of numbers.
fn pairs() -> Vec<[f64; 2]> {
    let all = numbers();
    all.iter().flat_map(|&a| all.iter().map(move |&b| [a, b])).collect()
}

/// What is asked of a pair, by comparing and choosing alone.
fn expected([a, b]: [f64; 2]) -> Vec<f64> {
    let larger = if b < a { a } else { b };
    let smaller = if a < b { a } else { b };
    let magnitude = a.abs();
    let chosen = if a < b { a } else { b };
    vec![larger, smaller, magnitude, chosen, -a, f64::from(u8::from(a < b))]
}

/// The same in lanes, pair after pair.
struct Choices<'a, L>(&'a [[f64; 2]], PhantomData<L>);

impl<L: Lane> Work for Choices<'_, L> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut all = Vec::new();
        for pairs in self.0.chunks(L::SAMPLES) {
            let [a, b] = [0, 1].map(|k| L::from_fn(|lane| pairs[lane.min(pairs.len() - 1)][k]));
            let mask = a.less(b);
            let (zero, one) = (L::splat(0.0), L::splat(1.0));
            let found =
                [a.larger(b), a.smaller(b), a.magnitude(), L::select(mask, a, b), -a, L::select(mask, one, zero)];
            for (lane, &[a, b]) in pairs.iter().enumerate() {
                all.push(found.iter().map(|value| value.get(lane)).collect());
                // Masks: not, or, all and any.
                let (less, alone) = (a < b, L::splat(a).less(L::splat(b)));
                assert_eq!([L::all(alone), L::any(alone)], [less; 2]);
                assert_eq!([L::all(!alone), L::any(!alone)], [!less; 2]);
                assert!(L::all(alone | !alone) && !L::any(L::never()));
                // Of several samples, all but one.
                if L::SAMPLES > 1 {
                    let mixed = L::from_fn(|other| f64::from(u8::from(other == lane))).less(one);
                    assert!(L::any(mixed) && !L::all(mixed));
                }
            }
        }
        all
    }
}

fn bits(all: &[Vec<f64>]) -> Vec<Vec<u64>> {
    all.iter().map(|values| values.iter().map(|value| value.to_bits()).collect()).collect()
}

#[test]
fn choices_keep_every_bit() {
    let pairs = pairs();
    let expected: Vec<Vec<f64>> = pairs.iter().map(|&pair| expected(pair)).collect();
    in_all_lanes!(Choices of [[f64; 2]], &pairs, |lanes, found: Vec<Vec<f64>>| {
        assert_eq!(bits(&found), bits(&expected), "{lanes}");
    });
}

/// Sums, products and quotients in lanes are those of single numbers.
struct Sums<'a, L>(&'a [[f64; 2]], PhantomData<L>);

impl<L: Lane> Work for Sums<'_, L> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut all = Vec::new();
        for pairs in self.0.chunks(L::SAMPLES) {
            let [a, b] = [0, 1].map(|k| L::from_fn(|lane| pairs[lane.min(pairs.len() - 1)][k]));
            let found = [a + b, a - b, a * b, a / b, a * b + a];
            all.extend((0..pairs.len()).map(|lane| found.iter().map(|value| value.get(lane)).collect::<Vec<f64>>()));
        }
        all
    }
}

#[test]
fn arithmetic_is_exact_in_every_lane() {
    let tight = [1.0 + f64::EPSILON, 1.0 - 0.5 * f64::EPSILON, 1e-170, 3e-160, 1e16 + 2.0, 0.1];
    let pairs: Vec<[f64; 2]> =
        pairs().into_iter().chain(tight.iter().flat_map(|&a| tight.iter().map(move |&b| [a, b]))).collect();
    // A product rounded before something is added: fused, the last would differ.
    let expected: Vec<Vec<f64>> = pairs
        .iter()
        .map(|&[a, b]| {
            let product = std::hint::black_box(a * b);
            vec![a + b, a - b, product, a / b, product + a]
        })
        .collect();
    // What is not a number is so everywhere; which of them it is is not promised.
    let plain = |all: &[Vec<f64>]| -> Vec<Vec<u64>> {
        let bits = |v: &f64| if v.is_nan() { f64::NAN.to_bits() } else { v.to_bits() };
        all.iter().map(|values| values.iter().map(bits).collect()).collect()
    };
    in_all_lanes!(Sums of [[f64; 2]], &pairs, |lanes, found: Vec<Vec<f64>>| {
        assert_eq!(plain(&found), plain(&expected), "{lanes}");
    });
}

/// What a row of values leaves: largest, when, smallest, when.
struct Seen<'a, L>(&'a [Vec<f64>], PhantomData<L>);

impl<L: Lane> Work for Seen<'_, L> {
    type Output = Vec<[f64; 4]>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut all = Vec::new();
        for rows in self.0.chunks(L::SAMPLES) {
            let mut peaks = Peaks::<L>::nothing();
            for (step, _) in rows[0].iter().enumerate() {
                let value = L::from_fn(|lane| rows[lane.min(rows.len() - 1)][step]);
                peaks.take(value, L::splat(step as f64));
            }
            let Peaks { max, max_at, min, min_at } = peaks;
            all.extend((0..rows.len()).map(|lane| [max, max_at, min, min_at].map(|v| v.get(lane))));
        }
        all
    }
}

/// The same by looking for the first value that no other exceeds.
fn seen(row: &[f64]) -> [f64; 4] {
    let first = |of: &dyn Fn(f64, f64) -> bool, none: f64| {
        let beats_all =
            |(_, v): &(usize, &f64)| !v.is_nan() && row.iter().all(|&other| !of(other, **v)) && of(**v, none);
        row.iter().enumerate().find(beats_all).map_or([none, 0.0], |(at, &v)| [v, at as f64])
    };
    let [max, max_at] = first(&|a, b| a > b, f64::NEG_INFINITY);
    let [min, min_at] = first(&|a, b| a < b, f64::INFINITY);
    [max, max_at, min, min_at]
}

#[test]
fn the_first_of_equal_extremes_counts() {
    let zeros = [[0.0, -0.0, 0.0], [-0.0, 0.0, -0.0]];
    let mut rows: Vec<Vec<f64>> = zeros.iter().map(|row| row.to_vec()).collect();
    rows.extend([vec![1.0, 2.0, 2.0], vec![2.0, 1.0, 1.0], vec![f64::NAN; 3], vec![f64::NAN, 3.0, f64::NAN]]);
    rows.extend([vec![f64::INFINITY; 3], vec![f64::NEG_INFINITY; 3], vec![f64::NEG_INFINITY, f64::NAN, f64::INFINITY]]);
    let all = numbers();
    for &a in &all {
        for &b in &all {
            rows.extend(all.iter().map(|&c| vec![a, b, c]));
        }
    }
    let expected: Vec<[f64; 4]> = rows.iter().map(|row| seen(row)).collect();
    in_all_lanes!(Seen of [Vec<f64>], &rows, |lanes, found: Vec<[f64; 4]>| {
        for ((found, expected), row) in found.iter().zip(&expected).zip(&rows) {
            let same = found.map(f64::to_bits) == expected.map(f64::to_bits);
            assert!(same, "{lanes}, {row:?}: {found:?}, {expected:?}");
        }
    });
}

/// Each lane sees its own numbers only.
#[test]
fn lanes_do_not_mix() {
    struct Each<'a, L>(&'a [f64], PhantomData<L>);

    impl<L: Lane> Work for Each<'_, L> {
        type Output = Vec<Vec<f64>>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let own = L::from_fn(|lane| self.0[lane]);
            let found = [own + own, own * own, own.larger(L::splat(2.5)), own.smaller(L::splat(2.5)), own.exp()];
            (0..L::SAMPLES).map(|lane| found.iter().map(|value| value.get(lane)).collect()).collect()
        }
    }

    let own: Vec<f64> = (0..16).map(f64::from).collect();
    in_all_lanes!(Each of [f64], own.as_slice(), |lanes, found: Vec<Vec<f64>>| {
        for (found, &x) in found.into_iter().zip(&own) {
            assert_eq!(found, [x + x, x * x, x.max(2.5), x.min(2.5), libm_exp(x)], "{lanes}");
        }
    });
}

/// Whole numbers in lanes are those of single ones.
#[test]
fn bits_are_exact_in_every_lane() {
    struct Whole<'a, L>(&'a [u64], PhantomData<L>);

    impl<L: Lane> Work for Whole<'_, L> {
        type Output = Vec<Vec<u64>>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let mut all = Vec::new();
            for pairs in self.0.windows(2).collect::<Vec<_>>().chunks(L::SAMPLES) {
                let [a, b] = [0, 1].map(|k| L::Bits::from_fn(|lane| pairs[lane.min(pairs.len() - 1)][k]));
                let moved = [a.up(0), a.up(33), a.down(0), a.down(32), a.spread(), L::Bits::splat(self.0[1])];
                let joint = [a.plus(b), a.and(b), a.or(b), a.xor(b), a.times(b), L::from_bits(a).to_bits()];
                let found = [moved, joint].concat();
                all.extend((0..pairs.len()).map(|lane| found.iter().map(|bits| bits.get(lane)).collect::<Vec<u64>>()));
            }
            all
        }
    }

    let mut all = vec![0, 1, u64::MAX, 1 << 63, (1 << 63) - 1, 0x0123_4567_89ab_cdef, 0xffff_ffff, 1 << 32];
    all.extend(numbers().into_iter().filter(|x| !x.is_nan()).map(f64::to_bits));
    let expected: Vec<Vec<u64>> = all
        .windows(2)
        .map(|pair| {
            let (a, b) = (pair[0], pair[1]);
            let spread = if a >> 63 == 1 { u64::MAX } else { 0 };
            let product = (a & 0xffff_ffff) * (b & 0xffff_ffff);
            vec![a, a << 33, a, a >> 32, spread, all[1], a.wrapping_add(b), a & b, a | b, a ^ b, product, a]
        })
        .collect();
    in_all_lanes!(Whole of [u64], &all, |lanes, found: Vec<Vec<u64>>| assert_eq!(found, expected, "{lanes}"));
}

/// Taken a few at a time, samples stay in their order, and go back to their places.
#[test]
fn a_few_at_a_time_are_all_in_order() {
    struct Fews<'a, L>(&'a [f64], PhantomData<L>);

    impl<L: Lane> Work for Fews<'_, L> {
        type Output = Vec<f64>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let (numbers, mut back) = (L::from_fn(|lane| self.0[lane]), L::splat(0.0));
            let mut all = Vec::new();
            for number in 0..L::FEWS {
                let few = numbers.few(number);
                all.extend((0..L::Few::SAMPLES).map(|lane| few.get(lane)));
                back.put_few(number, few);
            }
            all.extend((0..L::SAMPLES).map(|lane| back.get(lane)));
            all
        }
    }

    let all: Vec<f64> = (1..=64_u8).map(f64::from).collect();
    in_all_lanes!(Fews of [f64], &all, |lanes, found: Vec<f64>| {
        let samples = found.len() / 2;
        assert_eq!(found, [&all[..samples], &all[..samples]].concat(), "{lanes}");
    });
}

/// That of a single number, which tests/road.rs and tests/friction.rs hold to what is known.
fn libm_exp(x: f64) -> f64 {
    <f64 as Lane>::exp(x)
}

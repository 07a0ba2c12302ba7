//! Choosing among numbers in lanes, NaN, zeros of either sign and infinities among them: the same bits wherever it is done.

mod problems;

use std::marker::PhantomData;

use spanwise::ensemble::simd::{Isa, SAMPLES, Work, dispatch};
use spanwise::ensemble::watch::Watched;
use spanwise::lane::Lane;
use spanwise::lane::wide::Wide;

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
    assert_eq!(bits(&Choices::<f64>(&pairs, PhantomData).run()), bits(&expected));
    assert_eq!(bits(&Choices::<Wide<1>>(&pairs, PhantomData).run()), bits(&expected));
    assert_eq!(bits(&Choices::<Wide<4>>(&pairs, PhantomData).run()), bits(&expected));
    // Those that the processor does not have come to the same without them.
    for isa in Isa::ALL {
        assert_eq!(bits(&dispatch(isa, Choices::<Wide<SAMPLES>>(&pairs, PhantomData))), bits(&expected), "{isa:?}");
    }
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
    for isa in Isa::ALL {
        assert_eq!(plain(&dispatch(isa, Sums::<Wide<SAMPLES>>(&pairs, PhantomData))), plain(&expected), "{isa:?}");
    }
}

/// What a row of values leaves: largest, when, smallest, when.
struct Seen<'a, L>(&'a [Vec<f64>], PhantomData<L>);

impl<L: Lane> Work for Seen<'_, L> {
    type Output = Vec<[f64; 4]>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut all = Vec::new();
        for rows in self.0.chunks(L::SAMPLES) {
            let mut watched = Watched::<L>::nothing();
            for (step, _) in rows[0].iter().enumerate() {
                let value = L::from_fn(|lane| rows[lane.min(rows.len() - 1)][step]);
                watched.take(value, L::splat(step as f64));
            }
            let Watched { max, max_at, min, min_at } = watched;
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
    let same = |found: &[[f64; 4]]| {
        for ((found, expected), row) in found.iter().zip(&expected).zip(&rows) {
            assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{row:?}: {found:?}, {expected:?}");
        }
    };
    same(&Seen::<f64>(&rows, PhantomData).run());
    for isa in Isa::ALL {
        same(&dispatch(isa, Seen::<Wide<SAMPLES>>(&rows, PhantomData)));
    }
}

/// Each lane sees its own numbers only.
#[test]
fn lanes_do_not_mix() {
    struct Each<L>(PhantomData<L>);

    impl<L: Lane> Work for Each<L> {
        type Output = Vec<Vec<f64>>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let own = L::from_fn(|lane| lane as f64);
            let found = [own + own, own * own, own.larger(L::splat(2.5)), own.smaller(L::splat(2.5)), own.exp()];
            (0..L::SAMPLES).map(|lane| found.iter().map(|value| value.get(lane)).collect()).collect()
        }
    }

    for isa in Isa::ALL {
        let found = dispatch(isa, Each::<Wide<SAMPLES>>(PhantomData));
        assert_eq!(found.len(), SAMPLES);
        for (lane, found) in found.into_iter().enumerate() {
            let x = lane as f64;
            let expected = vec![x + x, x * x, x.max(2.5), x.min(2.5), libm_exp(x)];
            assert_eq!(found, expected, "{isa:?}");
        }
    }
}

/// That of a single number, which tests/road.rs and tests/friction.rs hold to what is known.
fn libm_exp(x: f64) -> f64 {
    <f64 as Lane>::exp(x)
}

//! Roads: random ones against the spectrum of their class, measured and single features against their own definitions.

use spanwise::stop_token::StopToken;
use std::f64::consts::{PI, TAU};

use nalgebra::Complex;
use spanwise::ensemble::Drawing;
use spanwise::error::Error;
use spanwise::lane::{Bits, InLanes, Isa, Lane, Lanes, Wide, WideBits, with};
use spanwise::road::{
    Class, Feature, InverseFft, Patch, Point, Profile, Road, Spectrum, Synthesis, golden_car, philox4x32,
    philox4x32_lanes, turn,
};

/// Usual contact patch of a lorry's tyre [m].
const PATCH: f64 = 0.24;
/// Usual band [cycle/m].
const BAND: [f64; 2] = [0.01, 4.0];
/// G_d(n₀) of a good road, class B [m³].
const GOOD: f64 = 64e-6;
/// Roads of an ensemble.
const ROADS: u64 = 1000;

fn patch(length: f64) -> Patch {
    Patch::new(length).unwrap()
}

fn synthesis(contact_patch: f64) -> Synthesis {
    Synthesis::new(Spectrum::new(GOOD, 2.0, BAND).unwrap(), patch(contact_patch), None).unwrap()
}

fn random(contact_patch: f64, seed: u64, sample: u64) -> Road {
    synthesis(contact_patch).road(seed, sample).into()
}

fn profile(x: &[f64], r: impl Fn(f64) -> f64, contact_patch: f64) -> Road {
    let elevation = x.iter().map(|&x| r(x)).collect();
    Profile::new(x.to_vec(), elevation, false, patch(contact_patch), None).unwrap().into()
}

fn grid(from: f64, to: f64, spacing: f64) -> Vec<f64> {
    (0..=((to - from) / spacing).round() as usize).map(|k| from + k as f64 * spacing).collect()
}

/// Points at no regular distance.
fn uneven(points: usize) -> Vec<f64> {
    (0..points).map(|k| 0.25 * k as f64 + 0.08 * (1.7 * k as f64).sin()).collect()
}

/// One of each kind, and their sum, on 0 to 30 m.
fn kinds(length: f64) -> Vec<(&'static str, Road)> {
    let p = patch(length);
    let mut kinds: Vec<(&str, Road)> = vec![
        ("random", random(length, 7, 3)),
        ("profile", profile(&uneven(140), |x| 0.01 * (0.9 * x).sin() + 0.002 * (5.0 * x).cos(), length)),
        ("step", Feature::step(4.0, 0.01, p).unwrap().into()),
        ("ramp", Feature::ramp(5.0, 9.0, 0.02, p).unwrap().into()),
        ("bump", Feature::plateau(12.0, 2.0, 0.03, 1.0, p).unwrap().into()),
        ("pothole", Feature::plateau(20.0, 0.8, -0.04, 0.1, p).unwrap().into()),
        ("joint", Feature::plateau(22.0, 0.05, -0.02, 0.0, p).unwrap().into()),
        ("camber", Feature::camber(1.0, 29.0, 0.1, p).unwrap().into()),
    ];
    let sum = Road::sum(kinds.iter().map(|(_, road)| road.clone()));
    kinds.push(("sum", sum));
    kinds
}

// Generator, angles and transform.

#[test]
fn philox_gives_the_published_answers() {
    // Random123 1.14, tests/kat_vectors, lines "philox4x32 10": counter, key, answer.
    let answers = [
        ([0; 4], [0; 2], [0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8]),
        ([0xffffffff; 4], [0xffffffff; 2], [0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd]),
        (
            [0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344],
            [0xa4093822, 0x299f31d0],
            [0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1],
        ),
    ];
    for (counter, key, answer) in answers {
        assert_eq!(philox4x32(counter, key), answer);
        // In lanes: the last one with this counter, the others with others; what is above a word is not looked at.
        let of_lane = |counter: [u32; 4], lane: usize| counter.map(|word| word.wrapping_add(3 - lane as u32));
        let wide = [0, 1, 2, 3].map(|k| {
            WideBits::<4>::from_fn(|lane| u64::from(of_lane(counter, lane)[k]) | (0xabcd_0000 + lane as u64) << 32)
        });
        let found = philox4x32_lanes(wide, key);
        for lane in 0..4 {
            let words = found.map(|words| words.get(lane) as u32);
            assert_eq!(words, philox4x32(of_lane(counter, lane), key));
            assert!(lane < 3 || words == answer);
        }
    }
}

#[test]
fn angles_in_words_are_angles() {
    let near_quarters = (0..8_u32).flat_map(|k| (0..5).map(move |d| (k << 29).wrapping_add(d).wrapping_sub(2)));
    let words: Vec<u32> = near_quarters.chain((0..100_000).map(|k: u32| k.wrapping_mul(2_654_435_769))).collect();
    for words in words.as_chunks::<8>().0 {
        let wide = WideBits::<8>::from_fn(|lane| u64::from(words[lane]) | 0x1234_5678 << 32);
        let (sines, cosines) = turn::sin_cos_of_words::<Wide<8>>(wide);
        for (lane, &word) in words.iter().enumerate() {
            let found = (sines.get(lane), cosines.get(lane));
            assert_eq!(found, turn::sin_cos_of_words::<f64>(u64::from(word)));
            assert_eq!(found, turn::sin_cos(f64::from(word) / 4_294_967_296.0));
        }
    }
}

#[test]
fn sine_and_cosine_are_exact_to_the_last_bits() {
    // The reference must not spoil it: u is a multiple of 1/8192, so that TAU u has an error of half a unit only.
    let mut worst: f64 = 0.0;
    for k in -16384..=16384 {
        let u = f64::from(k) / 8192.0;
        let (sine, cosine) = turn::sin_cos(u);
        let near = (u - u.round()) * TAU;
        worst = worst.max((sine - near.sin()).abs()).max((cosine - near.cos()).abs());
    }
    println!("largest error {worst:.1e}");
    assert!(worst <= 1e-15);
    for (u, expected) in [(0.25, (1.0, 0.0)), (0.5, (0.0, -1.0)), (-0.25, (-1.0, 0.0)), (3.0, (0.0, 1.0))] {
        assert_eq!(turn::sin_cos(u), expected);
    }
    assert_eq!(turn::sinc(0.0), 1.0);
    assert!((turn::sinc(0.5) - 2.0 / PI).abs() < 1e-15);
    assert_eq!(turn::sinc(2.0), 0.0);
}

#[test]
fn the_transform_is_the_sum_it_stands_for() {
    for n in [4_usize, 8, 16, 32, 512, 1024] {
        let z: Vec<[f64; 2]> = (0..n).map(|m| [(1.3 * m as f64).cos(), (2.1 * (m * m) as f64).sin()]).collect();
        let fft = InverseFft::new(n);
        let mut found = vec![[0.0; 2]; n];
        for (m, z) in z.iter().enumerate() {
            found[fft.place(m)] = *z;
        }
        fft.transform(&mut found);
        let roots: Vec<_> = (0..n).map(|k| Complex::from_polar(1.0, TAU * k as f64 / n as f64)).collect();
        let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
        for (j, [re, im]) in found.into_iter().enumerate() {
            let expected: Complex<f64> =
                z.iter().enumerate().map(|(m, [re, im])| Complex::new(*re, *im) * roots[m * j % n]).sum();
            apart = apart.max((Complex::new(re, im) - expected).norm());
            largest = largest.max(expected.norm());
        }
        println!("n = {n}: {:.1e}", apart / largest);
        assert!(apart <= 1e-13 * largest, "n = {n}");
    }
}

// Samples side by side.

/// What is to be the same in one lane, in sixteen, and in as many as an instruction set has.
struct Draw<'a> {
    synthesis: &'a Synthesis,
    first: u64,
}

impl InLanes for Draw<'_> {
    type Output = Vec<Vec<u64>>;

    fn run<L: Lanes>(self) -> Self::Output {
        let Draw { synthesis, first } = self;
        // Not only zeros before.
        let mut road = vec![L::splat(f64::NAN); 5 + first as usize % 2 * 100_000];
        L::dispatch(Drawing { synthesis, seed: 7, sample: |lane| first + lane as u64, road: &mut road });
        (0..L::SAMPLES).map(|lane| road.iter().map(|c| c.get(lane).to_bits()).collect()).collect()
    }
}

#[test]
fn lanes_and_instruction_sets_do_not_matter() {
    let bands = [[1.0, 1.1], [0.3, 1.9], [0.01, 2.3], BAND];
    for (band, period) in bands.into_iter().flat_map(|band| [1.0, 2.0, 16.0, 128.0, 1024.0].map(|p| (band, p))) {
        if period * band[0] < 1.0 {
            continue;
        }
        let spectrum = Spectrum::new(GOOD, 2.0, band).unwrap();
        let synthesis = Synthesis::new(spectrum, patch(PATCH), Some(period)).unwrap();
        for first in [0, u64::from(u32::MAX) - 3] {
            let draw = || Draw { synthesis: &synthesis, first };
            let plain = draw().run::<Wide<16>>();
            for (lane, plain) in plain.iter().enumerate() {
                let one: Vec<f64> = synthesis.coefficients(7, |_| first + lane as u64);
                assert_eq!(&one.iter().map(|c| c.to_bits()).collect::<Vec<u64>>(), plain);
            }
            for isa in Isa::present() {
                assert!(with(isa, draw()) == plain[..isa.samples()], "{isa:?}");
            }
        }
    }
}

#[test]
fn coefficients_are_the_sum_of_the_waves() {
    let (seed, sample) = (0x0123_4567_89ab_cdef_u64, 0xfedc_ba98_7654_3210_u64);
    // The second band ends at a quarter of the points, the others before.
    for (band, period) in [([0.02, 2.3], 128.0), ([0.05, 4.0], 32.0), ([1.0, 1.1], 1.0)] {
        let spectrum = Spectrum::new(GOOD, 2.0, band).unwrap();
        let synthesis = Synthesis::new(spectrum, patch(PATCH), Some(period)).unwrap();
        let points = synthesis.points();
        let wave = |m: usize| {
            let counter = [(m / 4) as u32, 0, sample as u32, (sample >> 32) as u32];
            let word = philox4x32(counter, [seed as u32, (seed >> 32) as u32])[m % 4];
            let power = spectrum.power((m as f64 - 0.5) / period, (m as f64 + 0.5) / period);
            let response = turn::sinc(m as f64 / period * PATCH) / turn::sinc(m as f64 / points as f64).powi(4);
            ((2.0 * power).sqrt() * response, f64::from(word) / 4_294_967_296.0)
        };
        let waves: Vec<(usize, (f64, f64))> =
            ((band[0] * period).round() as usize..=(band[1] * period).round() as usize).map(|m| (m, wave(m))).collect();
        let largest: f64 = waves.iter().map(|(_, (amplitude, _))| amplitude.abs()).sum();
        let found: Vec<f64> = synthesis.coefficients(seed, |_| sample);
        for (j, found) in found.into_iter().enumerate() {
            let angle = |m: usize| (m * j % points) as f64 / points as f64;
            let expected: f64 = waves.iter().map(|&(m, (a, phase))| a * (TAU * (angle(m) + phase)).cos()).sum();
            assert!((found - expected).abs() <= 1e-14 * largest, "{band:?}, {j}: {found} {expected}");
        }
    }
}

// Spectrum.

#[test]
fn classes_have_the_values_of_the_standard() {
    // ISO 8608, in 1e-6 m³ at n₀ = 0.1 cycle/m; at 1 rad/m (and per rad/m) the numbers are 1, 4, 16 for A, B, C.
    let means = [16, 64, 256, 1024, 4096, 16_384, 65_536, 262_144];
    let limits = [32, 128, 512, 2048, 8192, 32_768, 131_072];
    for (k, class) in Class::ALL.into_iter().enumerate() {
        assert!((class.mean() / (f64::from(means[k]) * 1e-6) - 1.0).abs() < 1e-14);
        match class.upper() {
            Some(upper) => assert!((upper / (f64::from(limits[k]) * 1e-6) - 1.0).abs() < 1e-14),
            None => assert_eq!(class, Class::H),
        }
    }
}

#[test]
fn power_is_the_integral_of_the_spectrum() {
    for waviness in [0.0, 0.7, 1.0, 1.0 + 1e-9, 1.5, 2.0, 2.0 + 1e-9, 2.5, 3.0] {
        let spectrum = Spectrum::new(GOOD, waviness, BAND).unwrap();
        for [from, to] in [[0.02, 0.03], [0.1, 0.5], [1.0, 1.001]] {
            // Simpson's rule in 2000 panels.
            let h = (to - from) / 2000.0;
            let density = |n: f64| GOOD * (n / 0.1).powf(-waviness);
            let sum: f64 = (0..2000)
                .map(|k| from + h * f64::from(k))
                .map(|n| density(n) + 4.0 * density(n + 0.5 * h) + density(n + h))
                .sum();
            let expected = sum * h / 6.0;
            assert!((spectrum.power(from, to) / expected - 1.0).abs() < 1e-11, "w = {waviness}, {from} to {to}");
        }
        let clipped = spectrum.power(0.0, 0.05) + spectrum.power(0.05, 9.0);
        assert!((clipped / spectrum.variance() - 1.0).abs() < 1e-13);
    }
}

/// Powers of two real functions, transformed as one complex one, by wave number m per period.
fn powers(first: &[f64], second: &[f64]) -> [Vec<f64>; 2] {
    let n = first.len();
    let shift = usize::BITS - n.trailing_zeros();
    let reversed = (0..n).map(|i| i.reverse_bits() >> shift);
    let mut z: Vec<_> = reversed.map(|i| Complex::new(first[i], second[i])).collect();
    let mut half = 1;
    while half < n {
        let roots: Vec<_> = (0..half).map(|k| Complex::from_polar(1.0, -PI * k as f64 / half as f64)).collect();
        for block in z.chunks_exact_mut(2 * half) {
            let (even, odd) = block.split_at_mut(half);
            for ((even, odd), root) in even.iter_mut().zip(odd).zip(&roots) {
                let turned = *odd * root;
                (*even, *odd) = (*even + turned, *even - turned);
            }
        }
        half *= 2;
    }
    let scale = 2.0 / (n as f64 * n as f64);
    let power = |m: usize, sign: f64| {
        let (a, b) = (z[m], z[n - m].conj());
        scale * (0.5 * (a + b * sign)).norm_sqr()
    };
    [1.0, -1.0].map(|sign| (0..n / 2).map(|m| if m == 0 { 0.0 } else { power(m, sign) }).collect())
}

fn check_spectra(length: f64) {
    let synthesis = synthesis(length);
    let period = synthesis.road(1, 0).period();
    assert!(period >= 1000.0);
    // Amplitudes are not drawn, so that there is no statistical error: four standard errors are none, and every
    // single road must agree. Sampling folds the images of the B-splines at multiples of the sampling rate onto
    // the band, each wave's in its phase with amplitudes (m/(m + jM))⁴; M is twice as fine as the road's grid.
    let samples = (8.0 * BAND[1] * period).round() as usize;
    let sampled = |sample: u64| -> Vec<f64> {
        let road = synthesis.road(1, sample);
        (0..samples).map(|k| road.at(period * k as f64 / samples as f64).elevation).collect()
    };
    // Octaves from the lowest wave number, of whole bins.
    let bin = |n: f64| (n * period).round();
    let edges: Vec<f64> = (0..).map(|k| BAND[0] * f64::from(1u32 << k)).take_while(|n| *n < BAND[1]).collect();
    let octaves: Vec<[f64; 2]> = edges.iter().map(|&n| [bin(n), bin((2.0 * n).min(BAND[1]) + 1.0 / period)]).collect();
    // The integral of 64e-6 (n/0.1)^−2 sinc²(nL): in closed form bin by bin, the sinc at the bin's wave.
    let expected = |m: f64| {
        let (a, b) = (((m - 0.5) / period).max(BAND[0]), ((m + 0.5) / period).min(BAND[1]));
        let u = PI * m / period * length;
        let response = if u == 0.0 { 1.0 } else { u.sin() / u };
        64e-6 * 0.01 * (1.0 / a - 1.0 / b) * response * response
    };
    let folded = |m: f64| {
        let image = |j: f64| (m / (m + j * samples as f64)).powi(4);
        (1..=8).map(|j| image(f64::from(j)) + image(-f64::from(j))).sum::<f64>()
    };
    let mut worst = vec![0.0_f64; octaves.len()];
    let mut worst_variance: f64 = 0.0;
    let waves = bin(BAND[0]) as usize..=bin(BAND[1]) as usize;
    let total: f64 = waves.map(|m| expected(m as f64)).sum();
    for pair in 0..ROADS / 2 {
        let (first, second) = (sampled(2 * pair), sampled(2 * pair + 1));
        for (r, power) in [&first, &second].into_iter().zip(powers(&first, &second)) {
            for (worst, [from, to]) in worst.iter_mut().zip(&octaves) {
                let bins = *from as usize..*to as usize;
                let found: f64 = power[bins.clone()].iter().sum();
                let expected: f64 = bins.map(|m| expected(m as f64) * (1.0 + folded(m as f64)).powi(2)).sum();
                *worst = worst.max((found / expected - 1.0).abs());
            }
            let variance = r.iter().map(|r| r * r).sum::<f64>() / samples as f64;
            worst_variance = worst_variance.max((variance / total - 1.0).abs());
        }
    }
    for (worst, [_, to]) in worst.iter().zip(&octaves) {
        let (n, images) = ((to - 1.0) / period, 2.0 * folded(to - 1.0));
        println!("patch {length} m, up to {n:.3} cycle/m: {worst:.1e}, beside images of up to {images:.1e}");
        assert!(*worst <= 1e-6 && images <= 1.3e-3);
    }
    println!("variance {worst_variance:.1e}");
    assert!(worst_variance <= 2e-6);
    if length == 0.0 {
        // The whole integral, not only its bins.
        assert!((total / (64e-6 * 0.01 * (1.0 / 0.01 - 1.0 / 4.0)) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn every_road_has_the_spectrum_of_its_class() {
    check_spectra(0.0);
}

#[test]
fn under_a_contact_patch_it_is_the_average_of_that() {
    check_spectra(PATCH);
}

/// Mean and its standard error.
fn estimate(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

#[test]
fn mean_squares_over_an_ensemble_are_those_of_the_class() {
    // At fixed x, so that the phases decide: ∫G dn and ∫(2πn)² G dn = (2π)² 64e-6 · 0.01 · (4 − 0.01).
    let synthesis = synthesis(0.0);
    let variance = 64e-6 * 0.01 * (1.0 / 0.01 - 1.0 / 4.0);
    let slope_variance = TAU * TAU * 64e-6 * 0.01 * 3.99;
    let roads: Vec<Road> = (0..ROADS).map(|sample| synthesis.road(11, sample).into()).collect();
    for x in [-90.0, 0.0, 12.34, 500.0] {
        let points: Vec<Point> = roads.iter().map(|road| road.at(x)).collect();
        for (name, squares, expected) in [
            ("r²", points.iter().map(|p| p.elevation * p.elevation).collect::<Vec<_>>(), variance),
            ("r'²", points.iter().map(|p| p.slope * p.slope).collect(), slope_variance),
        ] {
            let (mean, error) = estimate(&squares);
            println!("{name} at {x} m: {mean:.4e} ± {error:.1e}, expected {expected:.4e}");
            assert!((mean - expected).abs() <= 4.0 * error && error < 0.05 * expected);
        }
        let (mean, error) = estimate(&points.iter().map(|p| p.elevation).collect::<Vec<_>>());
        assert!(mean.abs() <= 4.0 * error);
    }
}

#[test]
fn samples_and_seeds_are_uncorrelated() {
    let synthesis = synthesis(0.0);
    for (name, pair) in [
        ("samples", [[5, 0], [5, 1]]),
        ("far samples", [[5, 0], [5, 1 << 40]]),
        ("seeds", [[5, 0], [6, 0]]),
        ("far seeds", [[5, 0], [5 + (1 << 40), 0]]),
    ] {
        let ([seed, sample], [other_seed, other_sample]) = (pair[0], pair[1]);
        for slope in [false, true] {
            let products: Vec<f64> = (0..300)
                .map(|k| {
                    let a = synthesis.road(seed + 100 * k, sample + 2 * k);
                    let b = synthesis.road(other_seed + 100 * k, other_sample + 2 * k);
                    let of = |p: Point| if slope { p.slope } else { p.elevation };
                    grid(0.0, 1000.0, 3.7).iter().map(|&x| of(a.at(x)) * of(b.at(x))).sum()
                })
                .collect();
            let (mean, error) = estimate(&products);
            println!("{name}: {:.2} standard errors", mean / error);
            assert!(mean.abs() <= 4.0 * error, "{name}");
        }
    }
}

#[test]
fn a_seed_is_one_function_of_x() {
    let (road, again) = (random(PATCH, 7, 0), random(PATCH, 7, 0));
    assert_eq!(road, again);
    assert_ne!(road, random(PATCH, 8, 0));
    assert_ne!(road, random(PATCH, 7, 1));
    // Asked in another order and at other places in between: the same bits.
    let x = grid(-300.0, 700.0, 0.37);
    let forward: Vec<Point> = x.iter().map(|&x| road.at(x)).collect();
    for (k, &x) in x.iter().enumerate().rev() {
        again.at(x + 0.1);
        assert_eq!(again.at(x), forward[k]);
    }
    // And periodic: 1024 m = 16384 grid points of 1/16 m.
    assert_eq!(road.period(), 1024.0);
    for x in [0.0, 17.3, 900.0] {
        let (here, there) = (road.at(x), road.at(x - 1024.0));
        assert!((here.elevation - there.elevation).abs() < 1e-13);
    }
}

#[test]
fn a_contact_patch_does_not_change_which_road_it_is() {
    // Long waves pass through the patch: sinc(0.01 · 0.24) = 1 − 1e-5. The rest differs by little.
    let (bare, felt) = (random(0.0, 7, 0), random(PATCH, 7, 0));
    let (mut difference, mut square): (f64, f64) = (0.0, 0.0);
    for x in grid(0.0, 1000.0, 0.1) {
        difference += (bare.at(x).elevation - felt.at(x).elevation).powi(2);
        square += bare.at(x).elevation.powi(2);
    }
    assert!(difference < 1e-2 * square && difference > 0.0);
}

#[test]
fn periods_are_kept_and_grids_fine_enough() {
    let spectrum = |band| Spectrum::new(GOOD, 2.0, band).unwrap();
    for (band, period, expected) in [
        (BAND, None, 1024.0),
        (BAND, Some(1000.0), 1000.0),
        ([0.0005, 4.0], None, 2048.0),
        ([0.05, 3.0], None, 4096.0 / 3.0),
    ] {
        let found = Synthesis::new(spectrum(band), patch(0.0), period).unwrap().road(1, 0).period();
        assert!((found / expected - 1.0).abs() < 1e-12, "{band:?}: {found}");
    }
}

// Derivatives and averages.

#[test]
fn slope_and_curvature_are_the_derivatives() {
    // Central differences are off by h² r'''/6, relatively (8πh)²/6 for the shortest waves, of 0.25 m, and where the
    // curvature has a kink by a quarter of its change, h Δr'''/4: the places stay clear of most kinks.
    let h = 1e-5;
    for length in [0.0, PATCH] {
        for (name, road) in kinds(length) {
            let x: Vec<f64> = grid(0.21377, 29.8, 0.0531);
            let points: Vec<Point> = x.iter().map(|&x| road.at(x)).collect();
            let largest = |of: fn(&Point) -> f64| points.iter().map(|p| of(p).abs()).fold(0.0, f64::max);
            let (slope, curvature) = (largest(|p| p.slope), largest(|p| p.curvature));
            for (&x, point) in x.iter().zip(&points) {
                let (before, after) = (road.at(x - h), road.at(x + h));
                let first = (after.elevation - before.elevation) / (2.0 * h);
                assert!((first - point.slope).abs() <= 2e-5 * slope + 1e-11, "{name} with {length} at {x}");
                let second = (after.slope - before.slope) / (2.0 * h);
                assert!((second - point.curvature).abs() <= 2e-5 * curvature + 1e-9, "{name} with {length} at {x}");
            }
        }
    }
}

#[test]
fn the_patch_average_is_the_average() {
    // Midpoints of 2400 strips: exact to a strip where the road jumps.
    let strips = 2400;
    for ((name, bare), (_, felt)) in kinds(0.0).into_iter().zip(kinds(PATCH)) {
        for x in grid(0.4137, 29.5, 0.531) {
            let width = PATCH / f64::from(strips);
            let at = |k: i32| bare.at(x - 0.5 * PATCH + (f64::from(k) + 0.5) * width).elevation;
            let average = (0..strips).map(at).sum::<f64>() / f64::from(strips);
            // Jumps of up to 20 mm, and the images of the random road's B-splines, which its average in the spectrum
            // leaves out: less than 1/81 of its waves of 0.25 m, of 64e-6 · 0.01/4 m² together.
            let allowed = match name {
                "step" | "joint" | "sum" => 0.02 / f64::from(strips) + 1e-5,
                "random" => 1e-5,
                _ => 1e-8,
            };
            assert!((felt.at(x).elevation - average).abs() <= allowed, "{name} at {x}");
        }
    }
}

#[test]
fn a_step_under_a_patch_is_a_ramp() {
    let step: Road = Feature::step(4.0, 0.012, patch(PATCH)).unwrap().into();
    let ramp: Road = Feature::ramp(3.88, 4.12, 0.012, patch(0.0)).unwrap().into();
    for x in grid(3.7, 4.3, 0.0123) {
        assert!((step.at(x).elevation - ramp.at(x).elevation).abs() < 1e-15);
        assert!((step.at(x).slope - ramp.at(x).slope).abs() < 1e-14);
        assert_eq!(step.at(x).curvature, 0.0);
    }
}

#[test]
fn features_have_their_shapes() {
    let none = patch(0.0);
    let at = |feature: Result<Feature, Error>, x: f64| Road::from(feature.unwrap()).at(x).elevation;
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    for s in [0.1, 0.35, 0.5, 0.8] {
        near(at(Feature::plateau(10.0, 2.0, 0.03, 1.0, none), 9.0 + 2.0 * s), 0.015 * (1.0 - (TAU * s).cos()));
        near(at(Feature::camber(10.0, 12.0, 0.03, none), 10.0 + 2.0 * s), 0.12 * s * (1.0 - s));
        near(at(Feature::ramp(10.0, 12.0, 0.03, none), 10.0 + 2.0 * s), 0.03 * s);
    }
    near(at(Feature::plateau(10.0, 2.0, -0.05, 0.2, none), 10.3), -0.05);
    near(at(Feature::plateau(10.0, 2.0, -0.05, 0.2, none), 9.1), -0.025);
    for outside in [8.9, 11.1] {
        near(at(Feature::plateau(10.0, 2.0, -0.05, 0.2, none), outside), 0.0);
    }
    near(at(Feature::step(1.0, 0.02, none), 0.999), 0.0);
    near(at(Feature::step(1.0, 0.02, none), 1.0), 0.02);
    near(at(Feature::ramp(1.0, 2.0, 0.02, none), 50.0), 0.02);
    // Joints under a patch: the dip of the gap's area spread over the patch, nothing beyond it.
    near(at(Feature::plateau(5.0, 0.06, -0.02, 0.0, patch(PATCH)), 5.0), -0.02 * 0.06 / PATCH);
    near(at(Feature::plateau(5.0, 0.06, -0.02, 0.0, patch(PATCH)), 5.16), 0.0);
}

// Profiles.

#[test]
fn profiles_reproduce_cubics_and_pass_through_their_points() {
    let x = uneven(30);
    let cubic = |x: f64| 0.3 - 0.2 * x + 0.05 * x * x - 0.003 * x * x * x;
    let road = profile(&x, cubic, 0.0);
    for x in grid(0.01, 7.1, 0.0371) {
        let point = road.at(x);
        assert!((point.elevation - cubic(x)).abs() < 1e-13);
        assert!((point.slope - (-0.2 + 0.1 * x - 0.009 * x * x)).abs() < 1e-12);
        assert!((point.curvature - (0.1 - 0.018 * x)).abs() < 1e-11);
    }
    let wild = |x: f64| (9.0 * x).sin();
    let road = profile(&x, wild, 0.0);
    for &x in &x {
        assert!((road.at(x).elevation - wild(x)).abs() < 1e-14);
    }
    // As few as four, and beyond the ends the tangent.
    let road = profile(&[0.0, 1.0, 1.5, 2.5], cubic, 0.0);
    assert!((road.at(0.7).elevation - cubic(0.7)).abs() < 1e-15);
    assert!((road.at(-1.0).elevation - (0.3 + 0.2)).abs() < 1e-14);
}

#[test]
fn profiles_converge_at_fourth_order() {
    let error = |spacing: f64| {
        let road = profile(&grid(0.0, 12.0, spacing), |x| (2.0 * x).sin(), 0.0);
        grid(3.0, 9.0, 0.0137).iter().map(|&x| (road.at(x).elevation - (2.0 * x).sin()).abs()).fold(0.0, f64::max)
    };
    let order = (error(0.2) / error(0.1)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

#[test]
fn detrending_takes_off_the_least_squares_line() {
    let x = uneven(200);
    let trend = |x: f64| 131.0 + 0.02 * x;
    let wave = |x: f64| 0.01 * x.sin();
    let make = |r: &dyn Fn(f64) -> f64| {
        let elevation = x.iter().map(|&x| r(x)).collect();
        Road::from(Profile::new(x.clone(), elevation, true, patch(0.0), None).unwrap())
    };
    let (with, without) = (make(&|x| wave(x) + trend(x)), make(&wave));
    let residual: Vec<f64> = x.iter().map(|&x| with.at(x).elevation).collect();
    for (&x, residual) in x.iter().zip(&residual) {
        assert!((residual - without.at(x).elevation).abs() < 1e-12);
    }
    // Normal equations: neither mean nor slope is left.
    assert!(residual.iter().sum::<f64>().abs() < 1e-10);
    assert!(residual.iter().zip(&x).map(|(r, x)| r * x).sum::<f64>().abs() < 1e-9);
}

// The datum.

/// Off its datum a profile is the same at any height and on any grade, but for the rounding of its elevations.
#[test]
fn heights_and_grades_go_with_the_datum() {
    let x = grid(-30.0, 40.0, 0.25);
    let wave = |x: f64| 0.004 * (0.9 * x).sin() + 0.002 * (2.3 * x).cos();
    for contact_patch in [0.0, PATCH] {
        let off = |height: f64, grade: f64, [start, far]: [f64; 2]| {
            let road = profile(&x, |x| wave(x) + height + grade * x, contact_patch);
            road.off(road.datum(start, far))
        };
        for ends in [[-20.0, 30.0], [35.0, 0.0]] {
            let plain = off(0.0, 0.0, ends);
            // Neither mean nor slope is left of what it begins with.
            let ahead = (ends[1] - ends[0]).signum();
            let begins: Vec<f64> =
                (0..50).map(|k| plain.at(ends[0] + ahead * 10.0 / 49.0 * f64::from(k)).elevation).collect();
            let moment = |power: i32| (0..50).map(|k| f64::from(k).powi(power) * begins[k as usize]).sum::<f64>();
            assert!(moment(0).abs() < 1e-14 && moment(1).abs() < 1e-12);
            for (height, grade) in [(500.0, 0.0), (0.0, 0.06), (-80.0, -0.1)] {
                let other = off(height, grade, ends);
                for x in grid(-29.0, 39.0, 0.0713) {
                    let (one, its) = (plain.at(x), other.at(x));
                    // The line is fitted to 10 m and carried on over seven times as many, and its rounding with it.
                    let apart = (one.elevation - its.elevation).abs();
                    assert!(apart < 1e-11, "{height} m, {grade}, at {x} m: {apart:e}");
                    assert!((one.slope - its.slope).abs() < 1e-11 && (one.curvature - its.curvature).abs() < 1e-10);
                }
            }
        }
    }
}

/// Of features the level at the start goes, of random roads nothing; of a sum all that goes of its parts.
#[test]
fn the_datum_of_a_sum_is_the_sum() {
    let step = |at: f64| Road::from(Feature::step(at, 0.3, patch(PATCH)).unwrap());
    let random = random(0.0, 1, 0);
    let measured = profile(&grid(-30.0, 40.0, 0.5), |x| 3.0 + 0.02 * x, 0.0);
    assert!(random.datum(-20.0, 30.0).is_zero() && step(0.0).datum(-20.0, 30.0).is_zero());
    assert!(Road::smooth().off(Road::smooth().datum(-20.0, 30.0)).is_smooth());
    let off = |road: &Road| road.off(road.datum(-20.0, 30.0)).at(7.0).elevation;
    assert!(off(&step(-90.0)).abs() < 1e-13);
    assert!((off(&step(0.0)) - 0.3).abs() < 1e-13);
    let both = Road::sum([random.clone(), step(-90.0), step(2.0), measured]);
    assert!((off(&both) - 0.3 - random.at(7.0).elevation).abs() < 1e-13);
    assert!((both.datum(-20.0, 30.0).slope - 0.02).abs() < 1e-14);
    // Of a way of less than 10 m, all of it.
    let kinked = profile(&grid(-30.0, 40.0, 0.5), |x| if x < -16.0 { 0.02 * x } else { -0.32 }, 0.0);
    assert!((kinked.datum(-20.0, -17.5).slope - 0.02).abs() < 1e-4);
    // Nothing else of the road is another.
    let felt = both.off(both.datum(-20.0, 30.0));
    assert_eq!((felt.ends(), felt.period()), (both.ends(), both.period()));
    assert_eq!((felt.texture(0.0, 9.0), felt.smoothness()), (both.texture(0.0, 9.0), both.smoothness()));
}

// Golden car.

/// Transfer function from the slope of the road to that between body and axle, at a wave number [cycle/m].
fn quarter_car(n: f64) -> Complex<f64> {
    // m z_s'' = −c d' − k d and m_u z_u'' = c d' + k d − k_t (z_u − r) with d = z_s − z_u, per body mass, so that
    // (s² + c s + k) z_s = (c s + k) z_u and (0.15 s² + c s + k + k_t) z_u = (c s + k) z_s + k_t r.
    let s = Complex::new(0.0, TAU * n * 80.0 / 3.6);
    let a = s * 6.0 + 63.3;
    let body_by_axle = a / (s * s + a);
    let axle = (s * s * 0.15 + a + 653.0 - a * body_by_axle).inv() * 653.0;
    axle * (body_by_axle - 1.0)
}

fn iri(road: &Road, start: f64, end: f64) -> Result<f64, Error> {
    golden_car::iri(road, start, end, StopToken::NEVER)
}

#[test]
fn the_golden_car_follows_its_transfer_function() {
    for wavelength in [2.0, 5.0, 16.0, 50.0] {
        let n = 1.0 / wavelength;
        let road = profile(&grid(0.0, 800.0, 0.02), |x| 0.01 * (TAU * n * x).sin(), 0.0);
        let mut response = Vec::new();
        golden_car::drive(&road, 0.0, 800.0, StopToken::NEVER, |_, slope| response.push(slope)).unwrap();
        // 400 m, a whole number of waves of 100 steps a metre, long after the start.
        let tail = &response[response.len() - 40_000..];
        let found = (2.0 * tail.iter().map(|d| d * d).sum::<f64>() / tail.len() as f64).sqrt();
        let u = PI * n * 0.25;
        let expected = 0.01 * TAU * n * quarter_car(n).norm() * (u.sin() / u);
        // The mean over each step and holding it lose (πnΔ)²/6 of its amplitude each, chords of 20 mm for an arc
        // (πn 20 mm)²/3.
        let allowed = (PI * n * 0.01).powi(2) / 3.0 * 1.05 + (PI * n * 0.02).powi(2) / 3.0 * 1.05 + 1e-6;
        println!("{wavelength} m: {:.1e} of {allowed:.1e}", found / expected - 1.0);
        assert!((found / expected - 1.0).abs() < allowed);
    }
}

#[test]
fn the_index_of_simple_roads() {
    // No roughness, or a gradient, which the initial slope is of.
    assert_eq!(iri(&Road::smooth(), 0.0, 100.0).unwrap(), 0.0);
    let hill = Road::from(Feature::ramp(-10.0, 210.0, 4.4, patch(0.0)).unwrap());
    assert!(iri(&hill, 0.0, 200.0).unwrap() < 1e-12);
    // Linear in the amplitude, and blind to its sign.
    let bump = |height| Road::from(Feature::plateau(50.0, 1.0, height, 0.5, patch(0.0)).unwrap());
    let [one, three, dip] = [0.01, 0.03, -0.01].map(|height| iri(&bump(height), 0.0, 200.0).unwrap());
    assert!((three / one - 3.0).abs() < 1e-10 && (dip / one - 1.0).abs() < 1e-10);
    // And over a section twice as long the same bump counts half.
    let longer = iri(&bump(0.01), 0.0, 399.75).unwrap();
    assert!((longer / one - 0.5).abs() < 1e-6);
}

#[test]
fn the_golden_car_feels_all_points() {
    // Waves shorter than the average, on points that hold them: of a slope of 0.1 next to nothing is felt, wherever the
    // steps lie. Single points every 50 mm made waves of 2.5 m of the first, and an index of 2.6 m/km.
    for (wavelength, spacing) in [(0.051, 0.005), (0.0101, 0.001), (0.247, 0.013)] {
        let road = profile(&grid(0.0, 60.0, spacing), |x| 1e-3 * (TAU * x / wavelength).sin(), 0.0);
        let index = iri(&road, 0.0, 59.9).unwrap();
        println!("{wavelength} m: {:.4} m/km", 1e3 * index);
        assert!(index < 0.1e-3, "{wavelength}: {index}");
    }
    // And the start does not matter: 5 mm are less than 1 %.
    let rough =
        |x: f64| (1..400).map(|k| 2e-3 / f64::from(k) * (0.31 * f64::from(k * k % 997) + f64::from(k) * x).sin()).sum();
    let road = profile(&grid(0.0, 220.0, 0.005), rough, 0.0);
    let indices: Vec<f64> = (0..10).map(|k| iri(&road, 0.005 * f64::from(k), 210.0).unwrap()).collect();
    for index in &indices {
        assert!((index / indices[0] - 1.0).abs() < 0.01, "{indices:?}");
    }
}

#[test]
fn segments_are_one_drive() {
    let road = random(0.0, 5, 0);
    let stop = StopToken::NEVER;
    // From the first point on there is no lead-in, and the segments are the parts of the index of the whole.
    let x = grid(0.0, 130.25, 0.05);
    let measured = profile(&x, |x| road.at(x).elevation, 0.0);
    let found = golden_car::segments(&measured, 0.0, 130.25, 10.0, stop).unwrap();
    assert_eq!((found.values.len(), found.lead_in), (13, 0.0));
    assert_eq!(found.edges[12..], [120.0, 130.0]);
    // The first lacks half an average of response, and the whole has half an average more at the end.
    let felt = found.values.iter().sum::<f64>() - 0.0125 * found.values[0];
    let whole = iri(&measured, 0.0, 130.25).unwrap();
    assert!((felt / 12.9875 / whole - 1.0).abs() < 2e-3, "{} {whole}", felt / 12.9875);
    // Where there is road before, the car comes from there, at least 11 m and at most 50 m: a start anew is 10 % off
    // somewhere, and a longer way before changes next to nothing.
    let [near, far] = [20.0, 1e4].map(|before| {
        let measured = profile(&grid(60.0 - f64::min(before, 50.0), 130.0, 0.05), |x| road.at(x).elevation, 0.0);
        golden_car::segments(&measured, 60.0, 130.0, 20.0, stop).unwrap()
    });
    assert_eq!((near.lead_in, far.lead_in), (20.0, 50.0));
    assert_eq!(far.edges, [60.0, 80.0, 100.0, 120.0, 130.0]);
    for (near, far) in near.values.iter().zip(&far.values) {
        assert!((near / far - 1.0).abs() < 0.05);
    }
    let anew = iri(&road, 60.0, 80.25).unwrap();
    assert!((anew / far.values[0] - 1.0).abs() > 0.01, "{anew} {}", far.values[0]);
    let random = golden_car::segments(&road, 60.0, 130.0, 20.0, stop).unwrap();
    for (random, far) in random.values.iter().zip(&far.values) {
        assert!((random / far - 1.0).abs() < 1e-2);
    }
    let interrupted = golden_car::segments(&road, 60.0, 960.0, 20.0, StopToken::when(&|| true));
    assert_eq!(interrupted.unwrap_err(), Error::Interrupted);
    assert_eq!(road.averaged(0.1, StopToken::when(&|| true)).unwrap_err(), Error::Interrupted);
    for (every, part) in [(0.2, "at least 0.25 m"), (-1.0, "greater than 0"), (f64::NAN, "greater than 0")] {
        assert!(refusal(golden_car::segments(&road, 0.0, 100.0, every, stop)).contains(part));
    }
}

#[test]
fn averages_of_any_length_are_those_of_the_surface() {
    for ((name, bare), (_, felt)) in kinds(0.0).into_iter().zip(kinds(PATCH)) {
        for x in grid(0.4137, 29.5, 0.531) {
            assert_eq!(felt.averaged(0.0, StopToken::NEVER).unwrap().at(x), bare.at(x), "{name}");
            assert_eq!(bare.averaged(PATCH, StopToken::NEVER).unwrap().at(x), felt.at(x), "{name}");
        }
    }
}

#[test]
fn waves_that_are_known() {
    let near = |found: [f64; 2], expected: [f64; 2]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(found == expected || (found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    };
    let measured = |spacing: f64| profile(&grid(-10.0, 110.0, spacing), f64::sin, PATCH);
    let step = || Road::from(Feature::step(1.0, 0.01, patch(PATCH)).unwrap());
    near(measured(0.5).waves(0.0, 100.0), [0.8, 0.8]);
    near(random(PATCH, 1, 0).waves(0.0, 100.0), [4.0, 4.0]);
    near(step().waves(0.0, 100.0), [f64::INFINITY, 0.0]);
    near(Road::sum([measured(0.5), measured(0.05), step()]).waves(0.0, 100.0), [0.8, 8.0]);
    near(Road::sum([measured(0.05), random(0.0, 1, 0)]).waves(0.0, 100.0), [4.0, 8.0]);
    // A gap does not count, a coarse part of the way does; what lies outside the section does not.
    let mut x = grid(0.0, 50.0, 0.1);
    x.extend(grid(50.4, 80.0, 0.1));
    x.extend(grid(81.0, 120.0, 1.0));
    let elevation = x.iter().map(|x| x.sin()).collect();
    let uneven = Road::from(Profile::new(x, elevation, false, patch(PATCH), Some(1.0)).unwrap());
    near(uneven.waves(0.0, 80.0), [4.0, 4.0]);
    near(uneven.waves(0.0, 120.0), [0.4, 0.4]);
    near(uneven.waves(90.0, 120.0), [0.4, 0.4]);
    near(uneven.waves(3.01, 3.02), [4.0, 4.0]);
    near(uneven.waves(-9.0, -8.0), [4.0, 4.0]);
    near(uneven.waves(500.0, 600.0), [0.4, 0.4]);
}

#[test]
fn random_roads_have_the_index_of_their_roughness() {
    // IRI = 0.543 √(G/1e-6) m/km: the mean rectified Gaussian, √(2/π) σ, with σ² = ∫ (2πn)² G |H|² sinc² dn.
    let expected = 0.543 * (GOOD / 1e-6).sqrt() * 1e-3;
    let synthesis = synthesis(0.0);
    let indices: Vec<f64> =
        (0..200).map(|sample| iri(&synthesis.road(3, sample).into(), 0.0, 1000.0).unwrap()).collect();
    let (mean, error) = estimate(&indices);
    println!("IRI {:.4} ± {:.4} m/km, expected {:.4}", 1e3 * mean, 1e3 * error, 1e3 * expected);
    assert!((mean / expected - 1.0).abs() < 0.01);
}

// What is refused.

fn refusal<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
    let error = result.unwrap_err();
    assert!(error.is_input());
    error.to_string()
}

#[test]
fn paths_that_are_not_covered_are_refused() {
    let measured = profile(&grid(-50.0, 80.0, 0.25), f64::sin, PATCH);
    assert_eq!(measured.check_covers(-50.0, 80.0), Ok(()));
    for (from, to) in [(-50.1, 20.0), (0.0, 80.1)] {
        let text = refusal(measured.check_covers(from, to));
        assert!(text.contains("road = path from") && text.contains("-50 m to 80 m"), "{text}");
    }
    let random = random(0.0, 1, 0);
    assert_eq!(random.check_covers(-500.0, 524.0), Ok(()));
    assert!(refusal(random.check_covers(-500.0, 524.1)).contains("period of 1024 m"));
    let both = Road::sum([random, measured]);
    assert!(both.check_covers(-50.0, 81.0).is_err() && both.check_covers(-50.0, 80.0).is_ok());
    assert!(Road::smooth().check_covers(-1e6, 1e6).is_ok() && Road::smooth().is_smooth());
    assert!(Road::smooth().check_covers(f64::NAN, 0.0).is_err());
    assert!(Road::sum([Road::smooth()]).is_smooth() && !both.is_smooth());
}

#[test]
fn bad_values_are_refused() {
    let (x, r) = (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0; 5]);
    let make = |x: &[f64], r: &[f64], gap| refusal(Profile::new(x.to_vec(), r.to_vec(), false, patch(0.0), gap));
    for (text, parts) in [
        (make(&[0.0, 1.0, 1.0, 2.0], &r[..4], None), ["x[2] = 1 m", "greater than x[1] = 1 m"]),
        (make(&[0.0, 2.0, 1.0, 3.0], &r[..4], None), ["x[2] = 1 m", "greater than x[1] = 2 m"]),
        (make(&[0.0, 1.0, f64::NAN, 3.0], &r[..4], None), ["x[2] = NaN", "finite"]),
        (make(&x, &[0.0, f64::INFINITY, 0.0, 0.0, 0.0], None), ["elevations[1] = inf", "finite"]),
        (make(&[0.0, 1.0, 2.0, 3.0, 9.0], &r, None), ["x[4] = 9 m: 6 m", "max_gap = 5 m"]),
        (make(&x, &r, Some(0.5)), ["x[1] = 1 m: 1 m", "max_gap = 0.5 m"]),
        (make(&x, &r, Some(0.0)), ["max_gap = 0", "greater than 0"]),
        (make(&x[..3], &r[..3], None), ["x = 3 points", "4 or more"]),
        (make(&x, &r[..4], None), ["elevations = 4 values", "one for each x, 5"]),
        (refusal(Patch::new(-0.1)), ["contact_patch = -0.1", "0 or more"]),
        (refusal(Spectrum::new(0.0, 2.0, BAND)), ["G = 0", "greater than 0"]),
        (refusal(Spectrum::new(GOOD, -1.0, BAND)), ["waviness = -1", "0 or more"]),
        (refusal(Spectrum::new(GOOD, 1e6, BAND)), ["waviness = 1000000", "variance"]),
        (refusal(Spectrum::new(GOOD, 2.0, [0.0, 4.0])), ["band[0] = 0", "greater than 0"]),
        (refusal(Spectrum::new(GOOD, 2.0, [4.0, 1.0])), ["band[1] = 1 cycle/m", "greater than"]),
        (refusal(Spectrum::new(GOOD, 2.0, [0.01, f64::INFINITY])), ["band[1] = inf", "finite"]),
        (refusal(Feature::ramp(2.0, 2.0, 0.1, patch(0.0))), ["end = 2 m", "greater than start, 2 m"]),
        (refusal(Feature::plateau(0.0, 1.0, 0.1, 0.6, patch(0.0))), ["edge = 0.6 m", "half the length, 0.5 m"]),
        (refusal(Feature::plateau(0.0, 0.0, 0.1, 0.0, patch(0.0))), ["length = 0", "greater than 0"]),
        (refusal(Feature::step(f64::NAN, 0.1, patch(0.0))), ["at = NaN", "finite"]),
        (refusal(iri(&Road::smooth(), 0.0, 10.0)), ["end = 10 m", "11 to 100000 m beyond start"]),
    ] {
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    }
    let spectrum = Spectrum::new(GOOD, 2.0, BAND).unwrap();
    let synthesis = |period| refusal(Synthesis::new(spectrum, patch(0.0), Some(period)));
    assert!(synthesis(99.0).contains("period = 99 m: must hold the longest wave: 100 m"));
    assert!(synthesis(1e9).contains("period = 1000000000 m") && synthesis(1e9).contains("4194304 grid points"));
    assert!(synthesis(f64::NAN).contains("period = NaN"));
}

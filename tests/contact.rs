//! Contact forces against brute force: bisection for one axle, all combinations of states for several.

use crate::problems::{POUND, in_series, kishan_vehicle};
use faer::Mat;
use faer::linalg::solvers::Solve;
use nalgebra::DVector;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use spanwise::step::{Contact, Elements, HELD, Prepared, Stroke};
use spanwise::vehicle::{Axle, ContactLaw, ContactPoint, Friction};

/// Bisection and closed form agree to this fraction of the static load.
const BISECTED: f64 = 1e-9;

/// The sweeps stop at changes of 1e-13 of the weight; by how much more the force may still be off depends on how
/// strongly the axles are coupled, here moderately.
const SWEPT: f64 = 1e-10;

/// Cases of every property, the same in every run; a failing one is printed, and shrunk.
fn cases() -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(1973);
    ProptestConfig { cases: 2000, failure_persistence: None, rng_seed, ..ProptestConfig::default() }
}

/// An axle, its static load, and the suspension shortening it starts the step with.
#[derive(Debug, Clone, Copy)]
struct Wheel {
    axle: Axle,
    static_load: f64,
    shortening: f64,
}

impl Wheel {
    fn contact(&self) -> Contact<f64> {
        contact(&self.axle, self.static_load)
    }

    fn stroke(&self) -> Stroke<f64> {
        Stroke { shortening: self.shortening, rate: 0.0, friction: self.axle.friction.initial }
    }

    /// Friction if the suspension has length s under total shortening d.
    fn friction(&self, d: f64, s: f64) -> f64 {
        self.axle.friction.initial + self.axle.tyre_stiffness * (d - s) - self.axle.suspension_stiffness * s
    }

    /// Where the suspension goes under total shortening d: nowhere, if friction holds, else as far as it must.
    fn slip(&self, d: f64) -> f64 {
        let limit = self.axle.friction.limit;
        let trial = self.friction(d, self.shortening);
        if trial.abs() <= limit {
            return self.shortening;
        }
        let target = limit.copysign(trial);
        bisect(-10.0, 10.0, |s| target - self.friction(d, s))
    }

    fn law(&self, d: f64) -> f64 {
        (self.axle.tyre_stiffness * (d - self.slip(d))).max(-self.static_load)
    }
}

/// The contact of an undamped massless axle, to which the length of a step makes no difference.
fn contact(axle: &Axle, static_load: f64) -> Contact<f64> {
    let point = ContactPoint {
        row: DVector::zeros(0),
        behind: 0.0,
        position: 0.0,
        surge_row: DVector::zeros(0),
        share: static_load,
        law: ContactLaw::Series {
            tyre_stiffness: axle.tyre_stiffness,
            tyre_damping: 0.0,
            suspension_stiffness: axle.suspension_stiffness,
            suspension_damping: 0.0,
            friction: axle.friction,
        },
    };
    Contact::new(&point, 1.0, 1e-3, false)
}

fn solve(wheels: &[Wheel], u: &[f64], s: &[f64], p: &mut [f64]) -> bool {
    let elements = Elements::new(wheels.iter().map(Wheel::contact).collect(), Vec::new());
    let strokes: Vec<Stroke<f64>> = wheels.iter().map(Wheel::stroke).collect();
    let known = elements.known();
    let mut held = vec![0.0; wheels.len() * HELD];
    elements.hold(known, s, &mut held);
    let mut prepared = vec![Prepared::nothing(); wheels.len()];
    elements.prepare(known, &held, &strokes, &mut prepared);
    elements.solve(known, u, s, &strokes, &prepared, [p, &mut vec![0.0; known.all()]])
}

/// Root of a rising function.
fn bisect(mut low: f64, mut high: f64, rising: impl Fn(f64) -> f64) -> f64 {
    assert!(rising(low) <= 0.0 && rising(high) >= 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if rising(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

prop_compose! {
    /// Wheels of trucks, from frictionless to nearly locked, in any state.
    fn wheel()(
        tyre in 2e5..8e6, spring in 1e5..8e6, load in 1e4..2e5,
        share in prop_oneof![Just(0.0), 0.0..0.4_f64], initial in -1.0..1.0_f64, shortening in -0.03..0.03_f64,
    ) -> Wheel {
        let friction_limit = share * load;
        let friction = Friction { initial: initial * friction_limit, ..Friction::coulomb(friction_limit) };
        let axle = Axle { friction, ..Axle::new(0.0, tyre, spring) };
        Wheel { axle, static_load: load, shortening }
    }
}

prop_compose! {
    /// Two to four wheels, their shortenings without load increments, and a compliance S: positive definite, with
    /// k S up to about one.
    fn train()(n in 2..=4_usize)(
        wheels in prop::collection::vec(wheel(), n),
        u in prop::collection::vec(-0.12..0.08_f64, n),
        root in prop::collection::vec(-1.0..1.0_f64, n * n),
        scale in prop_oneof![Just(1e-10), Just(1e-8), Just(1e-7)],
    ) -> (Vec<Wheel>, Vec<f64>, Vec<f64>) {
        let n = wheels.len();
        let entry = |i: usize, j: usize| {
            let product: f64 = (0..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
            scale * (product + if i == j { 0.1 } else { 0.0 })
        };
        let s = (0..n * n).map(|ij| entry(ij / n, ij % n)).collect();
        (wheels, u, s)
    }
}

/// What a wheel may be doing at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Doing {
    Sticks,
    Shortens,
    Lengthens,
    Flies,
}

const ALL: [Doing; 4] = [Doing::Sticks, Doing::Shortens, Doing::Lengthens, Doing::Flies];

/// Solves p + diag(k) S p = diag(k) u + c for one combination, or `None` if its solution contradicts it by more than
/// `near` of the static load.
fn consistent(wheels: &[Wheel], u: &[f64], s: &[f64], doing: &[Doing], near: f64) -> Option<Vec<f64>> {
    let n = wheels.len();
    let stiffness_and_constant = |k: usize| {
        let Wheel { axle, static_load, shortening } = wheels[k];
        let slide = |limit: f64| in_series(&axle) * (limit - axle.friction.initial) / axle.suspension_stiffness;
        match doing[k] {
            Doing::Sticks => (axle.tyre_stiffness, -axle.tyre_stiffness * shortening),
            Doing::Shortens => (in_series(&axle), slide(axle.friction.limit)),
            Doing::Lengthens => (in_series(&axle), slide(-axle.friction.limit)),
            Doing::Flies => (0.0, -static_load),
        }
    };
    let matrix = Mat::from_fn(n, n, |k, j| f64::from(k == j) + stiffness_and_constant(k).0 * s[k * n + j]);
    let right = Mat::from_fn(n, 1, |k, _| stiffness_and_constant(k).0 * u[k] + stiffness_and_constant(k).1);
    let p = matrix.partial_piv_lu().solve(&right);
    let fits = (0..n).all(|k| {
        let wheel = &wheels[k];
        let slack = near * wheel.static_load;
        let d = u[k] - (0..n).map(|j| s[k * n + j] * p[(j, 0)]).sum::<f64>();
        let trial = wheel.friction(d, wheel.shortening);
        let limit = wheel.axle.friction.limit;
        let on_the_road = p[(k, 0)] >= -wheel.static_load - slack;
        match doing[k] {
            Doing::Sticks => on_the_road && trial.abs() <= limit + slack,
            Doing::Shortens => on_the_road && trial >= limit - slack,
            Doing::Lengthens => on_the_road && trial <= -limit + slack,
            Doing::Flies => wheel.law(d) <= -wheel.static_load + slack,
        }
    });
    fits.then(|| p.col(0).iter().copied().collect())
}

fn combinations(n: usize) -> impl Iterator<Item = Vec<Doing>> {
    (0..ALL.len().pow(n as u32)).map(move |i| (0..n).map(|k| ALL[i / ALL.len().pow(k as u32) % ALL.len()]).collect())
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn one_axle_is_its_scalar_law(wheel in wheel(), u in -0.15..0.1_f64, share in 0.0..5.0_f64) {
        // From rigid ground to a ground five times as soft as the tyre.
        let compliance = share / wheel.axle.tyre_stiffness;
        let prepared = wheel.contact().prepare(wheel.contact().hold(compliance), &wheel.stroke(), false);
        let p = wheel.contact().solve(u, &prepared, &wheel.stroke(), false);
        let exact = bisect(-wheel.static_load, wheel.axle.tyre_stiffness, |p| p - wheel.law(u - compliance * p));
        prop_assert!((p - exact).abs() <= BISECTED * wheel.static_load, "{p} N, by bisection {exact} N");

        // The suspension it leaves behind: on the road it went where the law says, in the air it has let go.
        let Stroke { shortening: s, friction, .. } = wheel.contact().commit(p, &prepared, &wheel.stroke(), false);
        let limit = wheel.axle.friction.limit;
        prop_assert!(friction.abs() <= limit);
        let carried = wheel.axle.suspension_stiffness * s + friction - wheel.axle.friction.initial;
        prop_assert!((carried - p).abs() <= BISECTED * wheel.static_load, "carries {carried} N of {p} N");
        if p > -wheel.static_load {
            let expected = wheel.slip(u - compliance * p);
            let near = BISECTED * wheel.static_load / wheel.axle.suspension_stiffness;
            prop_assert!((s - expected).abs() <= near, "shortened to {s} m, by bisection {expected} m");
        }
        prop_assert!((s == wheel.shortening) || (friction.abs() == limit), "moves without sliding");
    }

    #[test]
    fn several_axles_are_the_one_consistent_combination((wheels, u, s) in train()) {
        let mut p = vec![0.0; wheels.len()];
        prop_assert!(solve(&wheels, &u, &s, &mut p), "does not settle");

        let weight: f64 = wheels.iter().map(|w| w.static_load).sum();
        let fitting: Vec<Vec<f64>> =
            combinations(wheels.len()).filter_map(|doing| consistent(&wheels, &u, &s, &doing, 1e-9)).collect();
        prop_assert!(!fitting.is_empty(), "no combination fits");
        // At a border between states two combinations may fit, and then they agree.
        for exact in fitting {
            for (p, exact) in p.iter().zip(&exact) {
                prop_assert!((p - exact).abs() <= SWEPT * weight, "{p} N, by combinations {exact} N");
            }
        }
    }

    /// Where the solve starts makes no difference.
    #[test]
    fn the_solution_is_unique((wheels, u, s) in train(), start in prop::collection::vec(-2e5..5e5_f64, 4)) {
        let weight: f64 = wheels.iter().map(|w| w.static_load).sum();
        let mut p = vec![0.0; wheels.len()];
        let mut q = start[..wheels.len()].to_vec();
        prop_assert!(solve(&wheels, &u, &s, &mut p));
        prop_assert!(solve(&wheels, &u, &s, &mut q));
        for (p, q) in p.iter().zip(&q) {
            prop_assert!((p - q).abs() <= SWEPT * weight, "{p} N and {q} N");
        }
    }
}

/// The random cases do visit every state.
#[test]
fn every_state_occurs() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let mut seen = [0; 4];
    for _ in 0..300 {
        let (wheels, u, s) = train().new_tree(&mut runner).unwrap().current();
        let fitting = combinations(wheels.len()).find(|doing| consistent(&wheels, &u, &s, doing, 0.0).is_some());
        for doing in fitting.into_iter().flatten() {
            seen[ALL.iter().position(|d| *d == doing).unwrap()] += 1;
        }
    }
    println!("{ALL:?}: {seen:?}");
    assert!(seen.iter().all(|&n| n > 20), "{ALL:?}: {seen:?}");
}

/// The axle of the paper by hand: 4800 lb of friction give way at 0.01 ft of tyre, then both springs share.
#[test]
fn the_axle_of_the_paper() {
    let axle = kishan_vehicle().axles()[0];
    let contact = contact(&axle, 32_040.0 * POUND);
    let foot = crate::problems::FOOT;
    let series = 480.0 * 270.0 / (480.0 + 270.0);
    for (feet, kilopounds) in [
        (0.005, 0.005 * 480.0),
        (0.01, 4.8),
        (0.02, 4.8 + 0.01 * series),
        (-0.01, -4.8),
        (-0.05, -4.8 - 0.04 * series),
        (-1.0, -32.04),
    ] {
        let rest = contact.at_rest();
        let p = contact.solve(feet * foot, &contact.prepare(contact.hold(0.0), &rest, false), &rest, false);
        assert!((p - kilopounds * 1e3 * POUND).abs() <= BISECTED * axle.friction.limit, "{feet} ft: {p} N");
    }
}

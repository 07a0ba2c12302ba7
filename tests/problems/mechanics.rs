//! What tests need to write down equations of motion beside those of the library.

use spanwise::bridge::{Bridge, Line, Mesh};
use spanwise::crossing::Preparation;
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::modes::Modes;
use spanwise::passage::{Passage, Settings};
use spanwise::recovery::Recovery;
use spanwise::road::{Patch, Profile, Road};
use spanwise::statics::Flexibility;
use spanwise::step::{Law, Stroke};
use spanwise::stop_token::StopToken;
use spanwise::vehicle::Vehicle;

use super::Run;

/// The modes of a bridge along it, each with two derivatives.
pub struct Shapes {
    mesh: Mesh,
    lines: Vec<Line>,
    pub omega: Vec<f64>,
}

impl Shapes {
    pub fn new(bridge: &Bridge, modes: usize) -> Self {
        let flexibility = Flexibility::new(bridge, &[]).unwrap();
        let modes = Modes::new(bridge, &flexibility, modes).unwrap();
        let lines = modes.lines(bridge, &flexibility);
        Shapes { mesh: flexibility.mesh().clone(), lines, omega: modes.omega }
    }

    /// φ, φ' and φ'' of every mode; zeros off the bridge.
    pub fn at(&self, x: f64) -> Vec<[f64; 3]> {
        let Some(panel) = self.mesh.panel_at(x) else { return vec![[0.0; 3]; self.lines.len()] };
        let (t, width) = (self.mesh.fraction(panel, x), self.mesh.width(panel));
        let of = |line: &Line| {
            let [a, b, c, d] = line.cubics()[panel];
            let slope = (b + t * (2.0 * c + t * 3.0 * d)) / width;
            [a + t * (b + t * (c + t * d)), slope, (2.0 * c + t * 6.0 * d) / (width * width)]
        };
        self.lines.iter().map(of).collect()
    }
}

/// One step of the classical Runge–Kutta method for y' = f(t, y).
pub fn runge_kutta(y: &mut [f64], t: f64, h: f64, f: &dyn Fn(f64, &[f64]) -> Vec<f64>) {
    let moved = |slope: &[f64], h: f64| -> Vec<f64> { y.iter().zip(slope).map(|(y, k)| y + h * k).collect() };
    let k1 = f(t, y);
    let k2 = f(t + 0.5 * h, &moved(&k1, 0.5 * h));
    let k3 = f(t + 0.5 * h, &moved(&k2, 0.5 * h));
    let k4 = f(t + h, &moved(&k3, h));
    for (i, y) in y.iter_mut().enumerate() {
        *y += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
}

/// As [`super::run`], with several vehicles.
pub fn run_all(
    bridge: &Bridge,
    passages: &[Passage],
    settings: &Settings,
    modes: usize,
    damping: &Damping,
    recovery: Recovery,
    sections: &[f64],
) -> Result<Run, Error> {
    let modes = Modes::new(bridge, &Flexibility::new(bridge, &[])?, modes)?;
    let sections = (!sections.is_empty()).then(|| sections.to_vec());
    let preparation = Preparation { damping: damping.clone(), sections, recovery };
    let analysis = preparation.of(bridge, modes, StopToken::NEVER)?;
    let outcome = analysis.cross_all(passages, settings, StopToken::NEVER)?;
    let all = 0..analysis.rows.len();
    let responded = outcome.history.responses(&analysis.rows, all, StopToken::NEVER)?;
    let flexibility = Flexibility::new(bridge, &analysis.sections)?;
    Ok(Run { bridge: bridge.clone(), flexibility, analysis, outcome, responded })
}

/// Values, velocities and accelerations of a vehicle's coordinates at an instant, its travel last.
pub fn motion(run: &Run, vehicle: usize, row: usize) -> Vec<[f64; 3]> {
    let history = &run.outcome.history;
    let columns = history.vehicles[vehicle].motion.clone();
    let all = &history.motion[row * history.motion_width()..][columns];
    all.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}

/// Modal coordinates and coordinates of all vehicles, and their velocities if `rates`.
pub fn state(run: &Run, row: usize, rates: bool) -> Vec<f64> {
    let history = &run.outcome.history;
    let mut all = history.a[row * history.modes..][..history.modes].to_vec();
    if rates {
        all.extend(&history.a_dot[row * history.modes..][..history.modes]);
    }
    for vehicle in 0..history.vehicles.len() {
        for [x, v, _] in motion(run, vehicle, row) {
            all.push(x);
            if rates {
                all.push(v);
            }
        }
    }
    all
}

/// Orders between neighbouring refinements from differences of answers, each number in units of what it is worth.
pub fn orders(answers: &[Vec<f64>], scale: &[f64]) -> Vec<f64> {
    let apart =
        |a: &[f64], b: &[f64]| a.iter().zip(b).zip(scale).map(|((a, b), s)| ((a - b) / s).powi(2)).sum::<f64>().sqrt();
    let differences: Vec<f64> = answers.windows(2).map(|w| apart(&w[0], &w[1])).collect();
    differences.windows(2).map(|w| (w[0] / w[1]).log2()).collect()
}

/// What energy does in a crossing by one vehicle, instant after instant [J].
pub struct Budget {
    /// Of bridge, bodies, springs and weight, and of the motion along the road relative to the centre of mass if wanted.
    pub stored: Vec<f64>,
    /// Work of the force that keeps the vehicle at its speed, −∫vΣH dt.
    pub driven: Vec<f64>,
    /// Taken out by the damping of the bridge and by dampers.
    pub damped: Vec<f64>,
    /// Taken out by friction, what its sticks store included.
    pub rubbed: Vec<f64>,
}

impl Budget {
    /// What does not add up at each instant.
    pub fn error(&self) -> Vec<f64> {
        let at = |i: usize| self.stored[i] - self.stored[0] - self.driven[i] + self.damped[i] + self.rubbed[i];
        (0..self.stored.len()).map(at).collect()
    }

    /// Of a vehicle whose axles have mass, without friction in the static state; `rolls` if the speed is its own.
    pub fn of(run: &Run, vehicle: &Vehicle, road: &Road, ratio: f64, rolls: bool) -> Self {
        use spanwise::vehicle::ContactLaw;
        let (history, assembly) = (&run.outcome.history, vehicle.assembly());
        let shapes = Shapes::new(&run.bridge, history.modes);
        let mass = if rolls { &assembly.mass + &assembly.surge_mass } else { assembly.mass.clone() };
        let n = mass.nrows();
        let direction = history.vehicles[0].direction;
        // The road off its datum, against whose rise the weight of what rolls works.
        let far = if direction > 0.0 { run.bridge.length() } else { 0.0 };
        let datum = road.datum(history.positions[0], far);
        let road = road.off(datum);
        let weight = history.static_loads.iter().sum::<f64>();
        let mut budget = Budget { stored: vec![], driven: vec![], damped: vec![], rubbed: vec![] };
        let (mut powers, mut strokes): (Vec<[f64; 2]>, Vec<Vec<[f64; 2]>>) = (vec![], vec![]);
        for (i, row) in run.rows().enumerate() {
            let all = motion(run, 0, i);
            let q = nalgebra::DVector::from_iterator(n, all[..n].iter().map(|c| c[0]));
            let v = nalgebra::DVector::from_iterator(n, all[..n].iter().map(|c| c[1]));
            let speed = all[n][1];
            let mut stored = 0.5 * (&mass * &v).dot(&v) + 0.5 * (&assembly.stiffness * &q).dot(&q);
            let mut damped = (&assembly.damping * &v).dot(&v);
            let mut driven = 0.0;
            if rolls {
                stored += 0.5 * vehicle.mass() * speed * speed + weight * direction * datum.slope * all[n][0];
            }
            for ((a, a_dot), w) in row.a.iter().zip(row.a_dot).zip(&shapes.omega) {
                stored += 0.5 * (a_dot * a_dot + w * w * a * a);
                damped += 2.0 * ratio * w * a_dot * a_dot;
            }
            for (k, contact) in assembly.contacts.iter().enumerate() {
                let ContactLaw::Tyre { stiffness, damping } = contact.law else { panic!("an axle without mass") };
                let (x, load, at_rest) = (row.positions[k], row.loads[k], history.static_loads[k]);
                // Along the bridge.
                let along = direction * (speed + if rolls { contact.surge_row.dot(&v) } else { 0.0 });
                let surface = road.at(x);
                let (mut d, mut rate) = (surface.elevation, along * surface.slope);
                let mut slope = -surface.slope;
                for ([value, first, _], (a, a_dot)) in shapes.at(x).iter().zip(row.a.iter().zip(row.a_dot)) {
                    d -= value * a;
                    rate -= value * a_dot + along * first * a;
                    slope += first * a;
                }
                (d, rate) = (d + contact.row.dot(&q), rate + contact.row.dot(&v));
                // The tyre springs back in the air; what it then has in it is lost.
                let shortened = d + at_rest / stiffness;
                let pressed = shortened.max(0.0);
                stored += 0.5 * stiffness * pressed * pressed - at_rest * contact.row.dot(&q);
                damped += match load > 0.0 {
                    true => damping * rate * rate + stiffness * (shortened - pressed) * rate,
                    false => -stiffness * pressed * rate,
                };
                driven -= along * load * slope;
            }
            budget.stored.push(stored);
            powers.push([if rolls { 0.0 } else { driven }, damped]);
            let stroke = assembly
                .frictions
                .iter()
                .enumerate()
                .map(|(f, element)| [element.row.dot(&q), history.rubbing[i * history.frictions + f]]);
            strokes.push(stroke.collect());
        }
        let mut sums = [0.0; 3];
        for i in 0..history.len() {
            if i > 0 {
                let h = history.time[i] - history.time[i - 1];
                for (sum, (a, b)) in sums.iter_mut().zip(powers[i - 1].iter().zip(&powers[i])) {
                    *sum += 0.5 * h * (a + b);
                }
                sums[2] += (strokes[i - 1].iter().zip(&strokes[i]))
                    .map(|(a, b)| 0.5 * (a[1] + b[1]) * (b[0] - a[0]))
                    .sum::<f64>();
            }
            budget.driven.push(sums[0]);
            budget.damped.push(sums[1]);
            budget.rubbed.push(sums[2]);
        }
        budget
    }
}

/// A road that grows from level to another one between two places, twice differentiable, known from `ends` to `ends`.
pub fn faded(road: &Road, [from, to]: [f64; 2], ends: [f64; 2]) -> Road {
    profile(ends, |x| {
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        t * t * t * (10.0 + t * (6.0 * t - 15.0)) * road.at(x).elevation
    })
}

/// A measured road with points every 100 mm.
pub fn profile(ends: [f64; 2], elevation: impl Fn(f64) -> f64) -> Road {
    let points = ((ends[1] - ends[0]) / 0.1).round() as usize;
    let x: Vec<f64> = (0..=points).map(|i| ends[0] + (ends[1] - ends[0]) * i as f64 / points as f64).collect();
    let elevations = x.iter().map(|&x| elevation(x)).collect();
    Profile::new(x, elevations, false, Patch::new(0.0).unwrap(), None).unwrap().into()
}

/// Shortening and friction where a law, coming from `before`, meets the falling line f = a − b s.
pub fn meet(law: &Law<f64>, a: f64, b: f64, before: &Stroke<f64>) -> (f64, f64) {
    let trial = a - b * before.shortening;
    let friction = law.friction(trial, b, before);
    (before.shortening + (trial - friction) / b, friction)
}

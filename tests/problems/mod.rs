//! Problems with known answers, shared by tests and benches.
#![allow(dead_code)] // every test and bench takes what it needs

pub mod answers;
pub mod elements;
pub mod ensemble;
pub mod mechanics;
pub mod vehicles;

use faer::Mat;
use spanwise::bridge::{Along, Bridge, Fixity, Layout, Stations, Support};
use spanwise::crossing::{Analysis, Outcome};
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::passage::{Drive, Passage, Settings};
use spanwise::recovery::Recovery;
use spanwise::statics::{Flexibility, Quantity};
use spanwise::stop_token::StopToken;
use spanwise::vehicle::{Axle, Friction, Vehicle, catalogue};

/// One foot [m].
pub const FOOT: f64 = 0.3048;
/// One pound-force [N].
pub const POUND: f64 = 4.448_221_615_260_5;
/// One slug [kg]: the mass that a pound-force accelerates by a foot per second squared.
pub const SLUG: f64 = POUND / FOOT;

pub const PINNED: Option<Fixity> = Some(Fixity::Pinned);
pub const CLAMPED: Option<Fixity> = Some(Fixity::Clamped);

/// A beam of `length` [m] on `supports`.
pub fn beam(
    length: f64,
    supports: Vec<Support>,
    flexural_rigidity: &[f64],
    mass: &[f64],
    stations: &Stations,
    point_masses: &[(f64, f64)],
) -> Result<Bridge, Error> {
    let layout = Layout::new(length, supports, flexural_rigidity, mass);
    layout.stations(stations.clone()).point_masses(point_masses).build()
}

/// A beam of consecutive `spans` [m], pinned between them, with these ends (`None` is free).
pub fn continuous(
    spans: &[f64],
    ends: [Option<Fixity>; 2],
    flexural_rigidity: &[f64],
    mass: &[f64],
    stations: &Stations,
    point_masses: &[(f64, f64)],
) -> Result<Bridge, Error> {
    let (length, supports) = Bridge::consecutive(spans, ends)?;
    beam(length, supports, flexural_rigidity, mass, stations, point_masses)
}

pub fn pinned(at: f64) -> Support {
    Support { at, fixity: Fixity::Pinned }
}

pub fn clamped(at: f64) -> Support {
    Support { at, fixity: Fixity::Clamped }
}

/// Two spans of 60 ft with three masses each ([KTN73] §4).
pub fn kishan_bridge() -> Bridge {
    two_spans(3)
}

/// The bridge of the example with another number of masses in each span.
pub fn two_spans(stations_per_span: usize) -> Bridge {
    continuous(
        &[60.0 * FOOT; 2],
        [PINNED; 2],
        &[4.698e9 * POUND * FOOT * FOOT],
        &[126.1 * SLUG / FOOT],
        &Stations::PerSpan(vec![stations_per_span]),
        &[],
    )
    .unwrap()
}

/// One bridge for every arrangement of outer supports in Table 1 of [KTN73], with and without redundants.
pub fn arrangements() -> Vec<(&'static str, Bridge)> {
    let [ei, mass] = [1.9e9, 6.0e3];
    let on = |length: f64, supports: &[Support], counts: &[usize]| {
        beam(length, supports.to_vec(), &[ei], &[mass], &Stations::PerSpan(counts.to_vec()), &[]).unwrap()
    };
    let varied = continuous(
        &[12.0, 17.0, 14.0],
        [CLAMPED, PINNED],
        &[1.1e9, 2.9e9, 1.7e9],
        &[5.0e3, 7.5e3, 6.0e3],
        &Stations::PerSpan(vec![2, 4, 3]),
        &[(20.0, 9.0e3)],
    );
    vec![
        ("case 1: two spans of the paper", kishan_bridge()),
        ("case 1: simple span", on(20.0, &[pinned(0.0), pinned(20.0)], &[6])),
        ("case 2: cantilever from the left", on(9.0, &[clamped(0.0)], &[5])),
        ("case 2: clamped-clamped", on(18.0, &[clamped(0.0), clamped(18.0)], &[6])),
        ("case 2: three spans, clamped and pinned, EI by span", varied.unwrap()),
        ("case 2: clamped, with an overhang", on(22.0, &[clamped(0.0), pinned(16.0)], &[4, 3])),
        ("case 3: cantilever from the right", on(9.0, &[clamped(9.0)], &[5])),
        ("case 3: overhang and clamp", on(22.0, &[pinned(5.0), pinned(13.0), clamped(22.0)], &[2, 3, 3])),
        ("case 4: double overhang", on(26.0, &[pinned(5.0), pinned(20.0)], &[2, 4, 3])),
        ("case 4: double overhang, redundant", on(34.0, &[pinned(5.0), pinned(16.0), pinned(29.0)], &[2, 3, 3, 2])),
        ("case 5: left overhang", on(24.0, &[pinned(6.0), pinned(24.0)], &[3, 5])),
    ]
}

/// Bridges with all that a beam bridge may have beyond the paper's: springs, hinges, EI and mass that vary.
pub fn general_arrangements() -> Vec<(&'static str, Bridge)> {
    let stations = |counts: &[usize]| Stations::PerSpan(counts.to_vec());
    let plain = |length: f64, supports: Vec<Support>, counts: &[usize]| Layout {
        length,
        supports,
        hinges: Vec::new(),
        flexural_rigidity: Along::PerSpan(vec![1.9e9]),
        mass: Along::PerSpan(vec![6.0e3]),
        stations: stations(counts),
        point_masses: Vec::new(),
    };
    let between = |at: &[f64], values: &[f64]| Along::Between { at: at.to_vec(), values: values.to_vec(), pieces: 3 };
    let inf = f64::INFINITY;
    let springs = vec![elastic(0.0, 8e7, 0.0), elastic(14.0, 2e8, 0.0), elastic(30.0, 5e7, 0.0)];
    let turned = vec![elastic(0.0, inf, 3e8), elastic(12.0, inf, 9e8), elastic(27.0, 4e8, 2e8)];
    let piers = vec![pinned(4.0), clamped(18.0), elastic(30.0, inf, 5e8), pinned(44.0)];
    let gerber = vec![pinned(0.0), pinned(20.0), pinned(45.0), pinned(65.0)];
    let mixed = vec![clamped(0.0), elastic(15.0, 3e8, 4e8), elastic(32.0, 2e8, 0.0), elastic(46.0, inf, 1e9)];
    let cases = vec![
        ("springs", plain(30.0, springs.clone(), &[3, 4])),
        (
            "springs, masses on them",
            Layout { stations: Stations::At(vec![0.0, 6.0, 14.0, 20.0, 30.0]), ..plain(30.0, springs, &[]) },
        ),
        ("rotational springs", plain(30.0, turned, &[3, 3, 1])),
        ("integral piers between overhangs", plain(48.0, piers, &[1, 3, 2, 3, 1])),
        ("one column", plain(16.0, vec![elastic(7.0, 3e8, 8e9)], &[2, 3])),
        ("guided at the left end", plain(18.0, vec![elastic(0.0, 6e7, inf), pinned(18.0)], &[6])),
        ("built in from the right, sprung", plain(20.0, vec![elastic(0.0, 3e7, 2e7), clamped(20.0)], &[6])),
        ("Gerber beam", Layout { hinges: vec![26.0, 40.0], ..plain(65.0, gerber.clone(), &[3, 4, 3]) }),
        (
            "hinge on a support and at a mass",
            Layout {
                hinges: vec![20.0, 55.0],
                stations: Stations::At(vec![5.0, 15.0, 26.0, 38.0, 55.0, 60.0]),
                ..plain(65.0, gerber, &[])
            },
        ),
        (
            "clamped, hinged, clamped",
            Layout { hinges: vec![9.0], ..plain(20.0, vec![clamped(0.0), clamped(20.0)], &[6]) },
        ),
        (
            "EI and mass between breakpoints",
            Layout {
                flexural_rigidity: between(&[0.0, 7.0, 15.0, 33.0], &[1e9, 3e9, 2e9]),
                mass: between(&[0.0, 11.0, 33.0], &[8e3, 5e3]),
                ..plain(33.0, vec![pinned(0.0), pinned(15.0), pinned(33.0)], &[3, 4])
            },
        ),
        (
            "all at once",
            Layout {
                hinges: vec![24.0, 40.0],
                flexural_rigidity: between(&[0.0, 15.0, 30.0, 46.0], &[2e9, 4e9, 2e9, 1e9]),
                mass: between(&[0.0, 15.0, 46.0], &[6e3, 9e3, 5e3]),
                ..plain(46.0, mixed, &[3, 4, 3])
            },
        ),
    ];
    cases.into_iter().map(|(name, layout)| (name, Bridge::from_layout(layout).unwrap())).collect()
}

/// [`arrangements`] and [`general_arrangements`].
pub fn all_arrangements() -> Vec<(&'static str, Bridge)> {
    arrangements().into_iter().chain(general_arrangements()).collect()
}

/// A support on springs [N/m, N m/rad].
pub fn elastic(at: f64, vertical: f64, rotation: f64) -> Support {
    Support { at, fixity: Fixity::Elastic { vertical, rotation } }
}

/// Supports of the basic bridge: the outer ones ([KTN73] §2.3).
pub fn outer_supports(bridge: &Bridge) -> Vec<Support> {
    let all = bridge.supports();
    let last = all.len() - 1;
    all.iter().enumerate().filter(|&(i, _)| i == 0 || i == last).map(|(_, s)| *s).collect()
}

/// The bridge seen from the other side.
pub fn mirrored(bridge: &Bridge) -> Bridge {
    let length = bridge.length();
    let turned = |s: &Support| Support { at: length - s.at, ..*s };
    let across = |positions: &[f64]| positions.iter().rev().map(|x| length - x).collect::<Vec<f64>>();
    let mut at = across(bridge.rigidity_bounds());
    let last = at.len() - 1;
    (at[0], at[last]) = (0.0, length);
    let values = bridge.flexural_rigidity().into_iter().rev().collect();
    Bridge::from_layout(Layout {
        length,
        supports: bridge.supports().iter().rev().map(turned).collect(),
        hinges: across(bridge.hinges()),
        flexural_rigidity: Along::Between { at, values, pieces: 1 },
        mass: Along::PerSpan(vec![0.0]),
        stations: Stations::At(Vec::new()),
        point_masses: bridge.stations().iter().rev().map(|s| (length - s.at, s.mass)).collect(),
    })
    .unwrap()
}

/// Points all over a bridge, left to right: ends, supports, stations, and others not too near these or each other.
///
/// Between neighbours lies a fiftieth of the length at least: the stiffness of an element goes with its length to the
/// power of −3, and so does the rounding of what the elements give.
pub fn points(bridge: &Bridge) -> Vec<f64> {
    let mut all: Vec<f64> = bridge.points().collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|b, a| *b - *a <= 1e-9 * bridge.length());
    add_between(&mut all, bridge.length(), 1..9);
    all
}

/// [`points`], and as many again between them.
pub fn more_points(bridge: &Bridge) -> Vec<f64> {
    let mut all = points(bridge);
    add_between(&mut all, bridge.length(), 9..60);
    all
}

fn add_between(points: &mut Vec<f64>, length: f64, numbers: std::ops::Range<usize>) {
    for x in numbers.map(|i| length * spread(i)) {
        if points.iter().all(|p| (p - x).abs() >= 0.02 * length) {
            points.push(x);
        }
    }
    points.sort_by(f64::total_cmp);
}

/// A symmetric positive definite C at the mass stations that no combination of M and K gives [N s/m].
pub fn uneven_damping(bridge: &Bridge) -> Mat<f64> {
    let n = bridge.stations().len();
    let root = Mat::from_fn(n, n, |i, j| if j > i { 0.0 } else { 150.0 * (0.3 + spread(1 + 7 * i + 3 * j)) });
    &root * root.transpose()
}

/// Two axles 14 ft apart that carry 32,040 lb each ([KTN73] §4).
pub fn kishan_vehicle() -> Vehicle {
    catalogue::kishan_1973().unwrap()
}

pub fn kishan_vehicle_with_friction(friction_limit: f64) -> Vehicle {
    vehicles::with_axles(catalogue::kishan_1973(), |_, axle| axle.friction = Friction::coulomb(friction_limit))
}

/// The paper's vehicle with axles that are linear springs: friction holds for ever, or there is none.
pub fn linear_vehicles() -> [Vehicle; 2] {
    [f64::INFINITY, 0.0].map(kishan_vehicle_with_friction)
}

/// A single sprung mass on a spring, without friction to slide [kg, N/m].
pub fn sprung_mass(mass: f64, stiffness: f64) -> Vehicle {
    let axle = Axle { friction: Friction::coulomb(f64::INFINITY), ..Axle::new(0.0, stiffness, stiffness) };
    Vehicle::new(mass, 1.0, 0.0, vec![axle]).unwrap()
}

/// The run of [KTN73] §4: 75 ft/s at constant traction, here in steps of a millisecond.
pub fn kishan_settings() -> Settings {
    Settings { drive: Drive::ConstantTraction, step: Some(1e-3), ..Settings::at_speed(75.0 * FOOT) }
}

/// A crossing of a bridge with everything that the tests look at.
pub struct Run {
    pub bridge: Bridge,
    /// On a mesh that has the sections as nodes.
    pub flexibility: Flexibility,
    pub analysis: Analysis,
    pub outcome: Outcome,
    /// All responses at every instant, dynamic and static, row by row.
    pub responded: [Vec<f64>; 2],
}

/// Crosses with `modes` modes, looking at `sections` (the default ones if empty).
pub fn run(
    bridge: &Bridge,
    vehicle: &Vehicle,
    settings: &Settings,
    modes: usize,
    damping: &Damping,
    recovery: Recovery,
    sections: &[f64],
) -> Result<Run, Error> {
    let alone = [Passage::of(vehicle.clone())];
    mechanics::run_all(bridge, &alone, settings, modes, damping, recovery, sections)
}

pub fn undamped() -> Damping {
    Damping::Ratios(vec![0.0])
}

impl Run {
    /// Index of the section at x.
    pub fn section(&self, x: f64) -> usize {
        let length = self.bridge.length();
        self.analysis.sections.iter().position(|s| (s - x).abs() < 1e-9 * length).unwrap()
    }

    /// Ratio of the largest dynamic to the largest static response of a kind, section by section.
    pub fn impact(&self, quantity: Quantity) -> Vec<f64> {
        let envelope = self.analysis.envelope_of(&self.outcome, quantity, StopToken::NEVER).unwrap();
        let (d, s) = (&envelope.dynamic.max, &envelope.at_rest.max);
        d.iter().zip(s).map(|(d, s)| d.value / s.value).collect()
    }

    /// All dynamic responses of a kind, instant after instant, section after section.
    pub fn history_of(&self, quantity: Quantity) -> Vec<f64> {
        let range = self.analysis.responses.range(quantity);
        self.rows().flat_map(|row| row.dynamic[range.clone()].to_vec()).collect()
    }

    /// What each response is measured against: its own largest value in the run, or if that is nothing but rounding
    /// (the deflection of a support, the moment of a pin) the largest of its kind.
    pub fn scales(&self) -> Vec<f64> {
        let mut own = vec![0.0_f64; self.analysis.rows.len()];
        for row in self.rows() {
            own.iter_mut().zip(row.dynamic).for_each(|(m, v)| *m = m.max(v.abs()));
        }
        for quantity in Quantity::USUAL {
            let kind = &mut own[self.analysis.responses.range(quantity)];
            let largest = largest_magnitude(kind);
            kind.iter_mut().filter(|m| **m <= 1e-9 * largest).for_each(|m| *m = largest);
        }
        own
    }

    /// The crossing instant after instant.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let (history, [dynamic, at_rest]) = (&self.outcome.history, &self.responded);
        let responses = self.analysis.rows.len();
        (0..history.len()).map(move |i| Row {
            time: history.time[i],
            positions: &history.positions[i * history.axles..][..history.axles],
            loads: &history.loads[i * history.axles..][..history.axles],
            a: &history.a[i * history.modes..][..history.modes],
            a_dot: &history.a_dot[i * history.modes..][..history.modes],
            a_ddot: &history.a_ddot[i * history.modes..][..history.modes],
            dynamic: &dynamic[i * responses..][..responses],
            at_rest: &at_rest[i * responses..][..responses],
        })
    }
}

/// Everything at one instant of a [`Run`].
pub struct Row<'a> {
    pub time: f64,
    pub positions: &'a [f64],
    pub loads: &'a [f64],
    pub a: &'a [f64],
    pub a_dot: &'a [f64],
    pub a_ddot: &'a [f64],
    pub dynamic: &'a [f64],
    pub at_rest: &'a [f64],
}

pub fn largest_magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Largest difference of two lists of equal length; infinite where a NaN hides.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (a, b)| if (a - b).is_nan() { f64::INFINITY } else { m.max((a - b).abs()) })
}

/// Slope of the straight line through log(error) over log(size) by least squares: the observed order.
pub fn observed_order(sizes: &[f64], errors: &[f64]) -> f64 {
    assert_eq!(sizes.len(), errors.len());
    let n = sizes.len() as f64;
    let (x, y): (Vec<f64>, Vec<f64>) = sizes.iter().zip(errors).map(|(s, e)| (s.ln(), e.ln())).unzip();
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let up: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    up / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

/// Number `i` of a fixed sequence of numbers spread evenly over 0 to 1: the golden-ratio sequence.
pub fn spread(i: usize) -> f64 {
    (i as f64 * 0.618_033_988_749_894_9).fract()
}

/// Energies of a crossing without bridge damping, instant after instant [J].
pub struct Energies {
    /// Of modes, body and springs, and of the weight: constant under constant traction but for friction.
    pub total: Vec<f64>,
    /// Strain energy of the bridge.
    pub strain: Vec<f64>,
}

impl Run {
    pub fn energies(&self, vehicle: &Vehicle, gravity: f64) -> Energies {
        let history = &self.outcome.history;
        let omega = &self.analysis.modes.omega;
        let strain: Vec<f64> =
            self.rows().map(|row| row.a.iter().zip(omega).map(|(a, w)| 0.5 * (a * w).powi(2)).sum()).collect();
        let total = self.rows().enumerate().map(|(i, row)| {
            let body = &history.motion[9 * i..][..9];
            let moving = 0.5 * row.a_dot.iter().map(|v| v * v).sum::<f64>()
                + 0.5 * vehicle.mass() * (body[1].powi(2) + body[7].powi(2))
                + 0.5 * vehicle.pitch_inertia() * body[4].powi(2);
            let springs = vehicle.axles().iter().enumerate().map(|(k, axle)| {
                // The suspension spring carries the static load less the friction there is in that state.
                let shortened = axle.suspension_stiffness * history.shortenings[history.axles * i + k];
                let spring = history.static_loads[k] - axle.friction.initial + shortened;
                row.loads[k].powi(2) / (2.0 * axle.tyre_stiffness) + spring.powi(2) / (2.0 * axle.suspension_stiffness)
            });
            strain[i] + moving + springs.sum::<f64>() - vehicle.mass() * gravity * body[0]
        });
        Energies { total: total.collect(), strain }
    }
}

/// Path of the paper's vehicle over the paper's bridge [ft]: two spans and the wheelbase. In steps that are a multiple
/// of its number of feet, an axle enters and leaves at the end of a step (at constant speed).
pub const KISHAN_PATH: usize = 134;

/// The run of [KTN73] §4 in three modes and `count` steps.
pub fn kishan_in_steps(vehicle: &Vehicle, drive: Drive, beta: f64, count: usize, sections: &[f64]) -> Run {
    let step = KISHAN_PATH as f64 / 75.0 / count as f64;
    let settings = Settings { drive: drive.clone(), beta, step: Some(step), ..kishan_settings() };
    run(&kishan_bridge(), vehicle, &settings, 3, &undamped(), Recovery::ForceSummation, sections).unwrap()
}

/// Tyre and suspension in series, the stiffness of an axle while it slides [N/m].
pub fn in_series(axle: &Axle) -> f64 {
    let (t, s) = (axle.tyre_stiffness, axle.suspension_stiffness);
    t * s / (t + s)
}

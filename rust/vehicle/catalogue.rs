//! Published vehicles, and trucks of design codes as trains of forces.
//!
//! Where values were recalled, and not read at the source, it is said: check them before relying on them. Heights that a
//! source does not state are asked for; at 0 braking moves no load from axle to axle.

use crate::error::{Error, not_negative};
use crate::vehicle::body::{Axle, Body, Coupling, Friction};
use crate::vehicle::{STANDARD_GRAVITY, Vehicle};

/// A foot [m].
const FOOT: f64 = 0.3048;

/// The weight of a pound [N].
const POUND: f64 = 4.4482216152605;

/// Shortest and longest distance from the second to the third axle of HS20 [m], 14 and 30 ft.
pub const HS20_REAR_SPACING: [f64; 2] = [14.0 * FOOT, 30.0 * FOOT];

/// Shortest and longest distance from the third to the fourth axle of T44 [m].
pub const T44_REAR_SPACING: [f64; 2] = [3.0, 8.0];

/// Axle loads [N] and spacings [m] of the five lorries of fatigue load model 4.
const FLM4: [(&[f64], &[f64]); 5] = [
    (&[70e3, 130e3], &[4.5]),
    (&[70e3, 120e3, 120e3], &[4.2, 1.3]),
    (&[70e3, 150e3, 90e3, 90e3, 90e3], &[3.2, 5.2, 1.3, 1.3]),
    (&[70e3, 140e3, 90e3, 90e3], &[3.4, 6.0, 1.8]),
    (&[70e3, 130e3, 90e3, 80e3, 80e3], &[4.8, 3.6, 4.4, 1.3]),
];

/// Shares of the five lorries of fatigue load model 4 in traffic, by its kind (recalled).
pub const FLM4_MIX: [(&str, [f64; 5]); 3] = [
    ("long-distance", [0.20, 0.05, 0.50, 0.15, 0.10]),
    ("medium-distance", [0.40, 0.10, 0.30, 0.15, 0.05]),
    ("local", [0.80, 0.05, 0.05, 0.05, 0.05]),
];

type Make = fn() -> Result<Vehicle, Error>;

/// An entry of the catalogue.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// The name by which a case asks for it.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Where its values come from.
    pub source: &'static str,
    /// Whether the values were recalled, and not read at the source.
    pub recalled: bool,
    make: Make,
}

/// All of them.
pub const PRESETS: [Preset; 14] = [
    read("kishan-1973", "two axles with friction", "Kishan and Traill-Nash (1973)", kishan_1973),
    recalled("quarter-car", "quarter of a lorry", "McGetrick et al. (2009)", || quarter_car(0.0)),
    recalled("half-car", "two-axle lorry", "OBrien and Keenahan (2015)", || half_car(0.0)),
    recalled("articulated-5-axle", "tractor and semi-trailer", "D. Cantero and co-authors", || {
        articulated_5_axle([0.0; 2], 0.0)
    }),
    recalled("hs20-44", "tractor and semi-trailer", "Shi and Cai (2009)", || hs20_44([0.0; 2], 0.0)),
    read("hs20", "axle loads of a code", "AASHTO HS20", || hs20(HS20_REAR_SPACING[0])),
    recalled("t44", "axle loads of a code", "NAASRA and Austroads T44", || t44(T44_REAR_SPACING[0])),
    recalled("cl-625", "axle loads of a code", "CSA S6 CL-625", cl_625),
    read("flm3", "axle loads of a code", "EN 1991-2, FLM3", flm3),
    recalled("flm4-1", "axle loads of a code, lorry 1 of 5", "EN 1991-2, FLM4", || flm4(1)),
    recalled("flm4-2", "axle loads of a code, lorry 2 of 5", "EN 1991-2, FLM4", || flm4(2)),
    recalled("flm4-3", "axle loads of a code, lorry 3 of 5", "EN 1991-2, FLM4", || flm4(3)),
    recalled("flm4-4", "axle loads of a code, lorry 4 of 5", "EN 1991-2, FLM4", || flm4(4)),
    recalled("flm4-5", "axle loads of a code, lorry 5 of 5", "EN 1991-2, FLM4", || flm4(5)),
];

impl Preset {
    /// The vehicle: heights of 0, the shortest spacings.
    pub fn vehicle(&self) -> Result<Vehicle, Error> {
        (self.make)()
    }
}

const fn read(name: &'static str, title: &'static str, source: &'static str, make: Make) -> Preset {
    Preset { name, title, source, recalled: false, make }
}

const fn recalled(name: &'static str, title: &'static str, source: &'static str, make: Make) -> Preset {
    Preset { recalled: true, ..read(name, title, source, make) }
}

/// The two-axle vehicle of KTN73, section 4, from its US units; the SI figures printed beside them are rounded. The initial
/// friction is not stated; it is zero here.
pub fn kishan_1973() -> Result<Vehicle, Error> {
    let axle = |position: f64| Axle {
        friction: Friction::coulomb(4_800.0 * POUND),
        ..Axle::new(position, 480_000.0 * POUND / FOOT, 270_000.0 * POUND / FOOT)
    };
    let (mass, slug) = (2.0 * 32_040.0 * POUND / STANDARD_GRAVITY, POUND / FOOT);
    let pitch_inertia = 38_500.0 * slug * (FOOT * FOOT);
    Vehicle::new(mass, pitch_inertia, 6.0 * FOOT, vec![axle(7.0 * FOOT), axle(-7.0 * FOOT)])
}

/// A quarter of a lorry with its centre of mass at a height [m] (recalled; P. J. McGetrick, A. Gonzalez and E. J. OBrien,
/// Insight 51, 2009). It does not pitch; its pitch inertia is not used.
pub fn quarter_car(cg_height: f64) -> Result<Vehicle, Error> {
    let axle = Axle { mass: 700.0, suspension_damping: 1e4, ..Axle::new(0.0, 1.75e6, 4e5) };
    Vehicle::new(17_300.0, 17_300.0, cg_height, vec![axle])
}

/// A two-axle lorry of 18 t with its centre of mass at a height [m] (recalled; E. J. OBrien and J. Keenahan, Structural
/// Control and Health Monitoring 22, 2015).
pub fn half_car(cg_height: f64) -> Result<Vehicle, Error> {
    let front = Axle { mass: 700.0, suspension_damping: 1e4, ..Axle::new(2.375, 1.75e6, 4e5) };
    let rear = Axle { mass: 1_100.0, suspension_damping: 2e4, ..Axle::new(-2.375, 3.5e6, 1e6) };
    Vehicle::new(16_200.0, 93_457.0, cg_height, vec![front, rear])
}

/// An articulated lorry of 40 t, with heights of the centres of mass of tractor and semi-trailer and of the fifth wheel [m]
/// (recalled; D. Cantero and co-authors, in which paper is not settled). Its suspensions are hardly damped, about 1 % of
/// critical in bounce.
pub fn articulated_5_axle(cg_heights: [f64; 2], hinge_height: f64) -> Result<Vehicle, Error> {
    let axle = |position: f64, mass: f64, tyre: f64, suspension: f64| Axle {
        mass,
        tyre_damping: 1e4,
        suspension_damping: 1e3,
        ..Axle::new(position, tyre, suspension)
    };
    let front = vec![axle(0.5, 700.0, 1.75e6, 0.4e6), axle(-2.5, 1_100.0, 3.5e6, 1.0e6)];
    let rear = [-1.8, -2.9, -4.0].map(|position| axle(position, 750.0, 3.5e6, 0.75e6)).to_vec();
    semi_trailer([(4_500.0, 4_604.0, front), (31_450.0, 16_302.0, rear)], [-2.15, 6.15], cg_heights, hinge_height)
}

/// The AASHTO HS20-44 truck, with heights of the centres of mass of tractor and semi-trailer and of the fifth wheel [m]
/// (recalled; X. Shi and C. S. Cai, Journal of Transportation Engineering 135, 2009; L. Deng and C. S. Cai, Engineering
/// Structures 32, 2010). Bodies are those of the whole truck, all else is twice that of a wheel line.
pub fn hs20_44(cg_heights: [f64; 2], hinge_height: f64) -> Result<Vehicle, Error> {
    let axle = |position: f64, mass: f64, suspension: f64, damping: f64, tyre: f64| Axle {
        mass: 2.0 * mass,
        tyre_damping: 2.0 * 2_000.0,
        suspension_damping: 2.0 * damping,
        ..Axle::new(position, 2.0 * tyre, 2.0 * suspension)
    };
    let steered = axle(1.698, 490.0, 242_604.0, 2_190.0, 875_082.0);
    let driven = axle(-2.569, 808.0, 1_903_172.0, 7_882.0, 3_503_307.0);
    let trailing = axle(-2.283, 653.0, 1_969_034.0, 7_182.0, 3_507_429.0);
    let parts = [(2_612.0, 2_022.0, vec![steered, driven]), (26_113.0, 33_153.0, vec![trailing])];
    semi_trailer(parts, [-2.215, 2.338], cg_heights, hinge_height)
}

/// The HS20 truck of AASHTO ("Standard Specifications for Highway Bridges", "LRFD Bridge Design Specifications") as forces,
/// with the distance from the second to the third axle [m], in [`HS20_REAR_SPACING`].
pub fn hs20(rear_spacing: f64) -> Result<Vehicle, Error> {
    let kip = 1_000.0 * POUND;
    within("rear_spacing", rear_spacing, HS20_REAR_SPACING)?;
    forces(&[8.0 * kip, 32.0 * kip, 32.0 * kip], &[14.0 * FOOT, rear_spacing])
}

/// The T44 truck of Australia (recalled; NAASRA, "Bridge Design Specification", 1976; Austroads, "Bridge Design Code", 1992)
/// as forces, with the distance from the third to the fourth axle [m], in [`T44_REAR_SPACING`].
pub fn t44(rear_spacing: f64) -> Result<Vehicle, Error> {
    within("rear_spacing", rear_spacing, T44_REAR_SPACING)?;
    forces(&[48e3, 96e3, 96e3, 96e3, 96e3], &[3.7, 1.2, rear_spacing, 1.2])
}

/// The CL-625 truck of Canada (recalled; CSA S6, "Canadian Highway Bridge Design Code") as forces.
pub fn cl_625() -> Result<Vehicle, Error> {
    forces(&[50e3, 125e3, 125e3, 175e3, 150e3], &[3.6, 1.2, 6.6, 6.6])
}

/// Fatigue load model 3 of the Eurocode (EN 1991-2, 4.6.4) as forces.
pub fn flm3() -> Result<Vehicle, Error> {
    forces(&[120e3; 4], &[1.2, 6.0, 1.2])
}

/// A lorry of fatigue load model 4 of the Eurocode (recalled; EN 1991-2, 4.6.5) as forces: which of the five, from 1. Their
/// shares in traffic are in [`FLM4_MIX`].
pub fn flm4(lorry: usize) -> Result<Vehicle, Error> {
    let Some((loads, spacings)) = lorry.checked_sub(1).and_then(|k| FLM4.get(k)) else {
        return Err(Error::input("lorry", lorry, format!("must be 1 to {}", FLM4.len())));
    };
    forces(loads, spacings)
}

/// Tractor and semi-trailer, each of mass [kg], pitch inertia [kg m²] and axles, with a fifth wheel so far ahead of the
/// centre of mass of one and of the other [m].
fn semi_trailer(
    [tractor, trailer]: [(f64, f64, Vec<Axle>); 2],
    [at, own]: [f64; 2],
    cg_heights: [f64; 2],
    hinge_height: f64,
) -> Result<Vehicle, Error> {
    for (k, height) in cg_heights.into_iter().enumerate() {
        not_negative(format!("cg_heights[{k}]"), height)?;
    }
    let height = not_negative("hinge_height", hinge_height)?;
    let body =
        |(mass, pitch_inertia, axles), cg_height, couplings| Body { mass, pitch_inertia, cg_height, axles, couplings };
    let fifth_wheel = Coupling::Hinge { to: 0, at, own, height };
    Vehicle::of_bodies(vec![body(tractor, cg_heights[0], vec![]), body(trailer, cg_heights[1], vec![fifth_wheel])])
}

/// Forces [N] from the first to the last, with the distances between them [m].
fn forces(loads: &[f64], spacings: &[f64]) -> Result<Vehicle, Error> {
    let mut positions = vec![0.0];
    positions.extend(spacings.iter().scan(0.0, |place, spacing| {
        *place -= spacing;
        Some(*place)
    }));
    Vehicle::force_train(loads, &positions)
}

/// Refuses a spacing outside the range of its code, which may have been rounded to the centimetre.
fn within(key: &str, value: f64, [low, high]: [f64; 2]) -> Result<(), Error> {
    if (low - 0.005..=high + 0.005).contains(&value) {
        return Ok(());
    }
    Err(Error::input(key, format!("{value} m"), format!("must be {low} to {high} m")))
}

//! Published vehicles against the totals, axle loads, lengths and frequencies printed of them.

use crate::problems::{FOOT, POUND, SLUG};
use spanwise::vehicle::catalogue::{self, PRESETS};
use spanwise::vehicle::{STANDARD_GRAVITY, Suspension, Vehicle};

/// Closed forms of a few operations.
const EXACT: f64 = 1e-12;

/// Values as printed, such as "3.49 5.56", each to half a unit of its last digit.
fn assert_printed(what: &str, values: &[f64], printed: &str) {
    let texts: Vec<&str> = printed.split_whitespace().collect();
    assert_eq!(values.len(), texts.len(), "{what}: {values:?}, printed {printed}");
    for (value, text) in values.iter().zip(texts) {
        let digits = text.split_once('.').map_or(0, |(_, digits)| digits.len());
        let half = 0.5 * 10f64.powi(-(digits as i32)) * (1.0 + 1e-9);
        assert!((value - text.parse::<f64>().unwrap()).abs() <= half, "{what}: {value}, printed {text}");
    }
}

fn preset(name: &str) -> Vehicle {
    PRESETS.iter().find(|preset| preset.name == name).unwrap().vehicle().unwrap()
}

fn in_kilonewtons(vehicle: &Vehicle, gravity: f64) -> Vec<f64> {
    vehicle.static_loads(gravity).iter().map(|load| load / 1e3).collect()
}

fn spacings(vehicle: &Vehicle) -> Vec<f64> {
    vehicle.positions().windows(2).map(|pair| pair[0] - pair[1]).collect()
}

#[test]
fn vehicles_that_vibrate() {
    // Gravity, mass [kg], axle spacings [m] and loads [kN], frequencies with sliding suspensions [Hz].
    let hs20_44 = "2.15 3.03 4.70 7.84 13.4 14.9";
    for (name, gravity, mass, apart, loads, frequencies) in [
        ("kishan-1973", 9.80665, "29066", "4.267", "142.5 142.5", "2.097 3.338"),
        ("quarter-car", 9.81, "18000", "", "176.6", "0.690 8.83"),
        ("half-car", 9.81, "18000", "4.75", "86.3 90.3", "1.00 1.55 8.83 10.2"),
        ("hs20-44", 9.81, "32627", "4.267 4.267", "35.5 142.1 142.4", hs20_44),
    ] {
        let vehicle = preset(name);
        assert_printed(name, &[vehicle.mass()], mass);
        assert_printed(name, &spacings(&vehicle), apart);
        assert_printed(name, &in_kilonewtons(&vehicle, gravity), loads);
        assert_printed(name, &vehicle.frequencies(Suspension::Sliding), frequencies);
    }
    let lorry = preset("articulated-5-axle");
    assert_printed("mass", &[lorry.mass()], "40000");
    assert_printed("spacings", &spacings(&lorry), "3.00 7.60 1.10 1.10");
    assert_printed("loads", &in_kilonewtons(&lorry, 9.81), "55.2 105.3 78.3 77.3 76.4");
    let found = lorry.frequencies(Suspension::Sliding);
    assert_printed("frequencies", &[found[0], found[1], found[2], found[3], found[7]], "1.41 1.59 5.24 8.9 12.1");
}

#[test]
fn the_vehicle_of_1973_in_its_own_units() {
    let vehicle = catalogue::kishan_1973().unwrap();
    let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() <= EXACT, "{a} {b}");
    for (load, axle) in vehicle.static_loads(STANDARD_GRAVITY).iter().zip(vehicle.axles()) {
        same(*load / POUND, 32_040.0);
        same(axle.friction.limit / POUND, 4_800.0);
        same(axle.tyre_stiffness / (POUND / FOOT), 480_000.0);
        same(axle.suspension_stiffness / (POUND / FOOT), 270_000.0);
    }
    same(vehicle.wheelbase() / FOOT, 14.0);
    same(vehicle.cg_height() / FOOT, 6.0);
    same(vehicle.pitch_inertia() / (SLUG * FOOT * FOOT), 38_500.0);
}

#[test]
fn trucks_of_codes() {
    for (name, loads, apart) in [
        ("hs20", "35.6 142.3 142.3", "4.27 4.27"),
        ("t44", "48 96 96 96 96", "3.7 1.2 3.0 1.2"),
        ("cl-625", "50 125 125 175 150", "3.6 1.2 6.6 6.6"),
        ("flm3", "120 120 120 120", "1.2 6.0 1.2"),
        ("flm4-1", "70 130", "4.5"),
        ("flm4-2", "70 120 120", "4.2 1.3"),
        ("flm4-3", "70 150 90 90 90", "3.2 5.2 1.3 1.3"),
        ("flm4-4", "70 140 90 90", "3.4 6.0 1.8"),
        ("flm4-5", "70 130 90 80 80", "4.8 3.6 4.4 1.3"),
    ] {
        let train = preset(name);
        assert_printed(name, &in_kilonewtons(&train, 1.0), loads);
        assert_printed(name, &spacings(&train), apart);
        assert_eq!((train.mass(), train.places()[0]), (0.0, 0.0), "{name}");
    }
    assert_printed("hs20", &spacings(&catalogue::hs20(30.0 * FOOT).unwrap()), "4.267 9.144");
    assert_printed("t44", &spacings(&catalogue::t44(8.0).unwrap()), "3.7 1.2 8.0 1.2");
    for (_, shares) in catalogue::FLM4_MIX {
        assert!((shares.iter().sum::<f64>() - 1.0).abs() <= EXACT);
    }
}

#[test]
fn heights_are_those_asked_for() {
    for make in [catalogue::articulated_5_axle, catalogue::hs20_44] {
        let heights: Vec<f64> = make([1.0, 1.9], 1.2).unwrap().bodies().iter().map(|body| body.cg_height).collect();
        assert_eq!(heights, [1.0, 1.9]);
    }
    assert_eq!(catalogue::half_car(1.4).unwrap().cg_height(), 1.4);
    assert_eq!(catalogue::quarter_car(1.5).unwrap().cg_height(), 1.5);
}

#[test]
fn what_the_sources_do_not_have_is_refused() {
    for (refused, says) in [
        (catalogue::hs20(4.2), "rear_spacing = 4.2 m: must be 4.2672 to 9.144 m"),
        (catalogue::t44(f64::NAN), "rear_spacing = NaN m: must be 3 to 8 m"),
        (catalogue::flm4(0), "lorry = 0: must be 1 to 5"),
        (catalogue::flm4(6), "lorry = 6: must be 1 to 5"),
        (catalogue::half_car(-1.0), "cg_height = -1: must be finite and 0 or more"),
        (catalogue::hs20_44([0.0, -1.0], 0.0), "cg_heights[1] = -1: must be finite and 0 or more"),
        (catalogue::articulated_5_axle([0.0; 2], f64::NAN), "hinge_height = NaN: must be finite and 0 or more"),
    ] {
        assert_eq!(refused.unwrap_err().to_string(), says);
    }
}

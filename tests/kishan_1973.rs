//! H. Kishan and R. W. Traill-Nash, IABSE Publications 33 (1973), §4: the illustrative example.

mod problems;

use faer::Mat;
use problems::*;
use spanwise::crossing::{Drive, Settings};
use spanwise::flexibility::{Flexibility, Restraint, Structure};
use spanwise::influence::{self, Quantity};
use spanwise::recovery::Recovery;

#[test]
fn show() {
    let b = kishan_bridge();
    let s = Settings { drive: Drive::ConstantTraction, step: Some(1e-3), ..Settings::at_speed(75.0 * FOOT) };
    for (n, rec) in [
        (1, Recovery::ForceSummation),
        (2, Recovery::ForceSummation),
        (3, Recovery::ForceSummation),
        (6, Recovery::ForceSummation),
        (1, Recovery::Superposition),
        (3, Recovery::Superposition),
        (6, Recovery::Superposition),
    ] {
        let r = run(&b, &kishan_vehicle(), &s, n, &undamped(), rec, &[]).unwrap();
        println!("{n} {rec:?} {:?}", r.modes.omega);
        println!("{:.3?}", r.sections);
        println!("{:.3?}", r.impact(Quantity::Deflection));
        println!("{:.3?}", r.impact(Quantity::Moment));
        println!("v {}  steps {}", r.history.final_speed(), r.history.len());
    }
}

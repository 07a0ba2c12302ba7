//! A sprung mass on a simply supported span: Y. B. Yang and J. D. Yau, "Vehicle-bridge interaction element for dynamic
//! analysis", Journal of Structural Engineering 123 (1997).

use crate::problems::answers::YangYau;
use crate::problems::*;
use spanwise::passage::Settings;
use spanwise::recovery::Recovery::{self, ForceSummation, Superposition};
use spanwise::vehicle::Suspension;

/// The published deflections have five digits; the rest is for their steps and ours.
const DEFLECTION: f64 = 5e-4;

/// Half a unit of the last digit of the circular frequencies [rad/s].
const FREQUENCY: f64 = 5e-3;

/// One unit of the last digit of the position, at a maximum that is flat.
const POSITION: f64 = 1e-3;

/// Largest deflection of midspan, and where the mass then is.
fn largest_deflection(modes: usize, recovery: Recovery) -> [f64; 2] {
    // Average acceleration, so that twenty modes do not ask for shorter steps than the answer needs.
    let settings =
        Settings { gravity: YangYau::GRAVITY, beta: 0.25, step: Some(2e-4), ..Settings::at_speed(YangYau::SPEED) };
    let midspan = [0.5 * YangYau::SPAN];
    let run =
        run(&YangYau::bridge(50), &YangYau::vehicle(), &settings, modes, &undamped(), recovery, &midspan).unwrap();
    let extreme = run.outcome.envelope.dynamic.max[0];
    println!("{modes} modes, {recovery:?}: {:.4} mm at {:.4}", 1e3 * extreme.value, extreme.position / YangYau::SPAN);
    [extreme.value, extreme.position / YangYau::SPAN]
}

#[test]
fn frequencies() {
    let settings = Settings::at_speed(YangYau::SPEED);
    let run = run(&YangYau::bridge(50), &YangYau::vehicle(), &settings, 1, &undamped(), Superposition, &[1.0]).unwrap();
    let vehicle = YangYau::vehicle().frequencies(Suspension::Locked)[0] * std::f64::consts::TAU;
    for (ours, published) in [run.analysis.modes.omega[0], vehicle].into_iter().zip(YangYau::FREQUENCIES) {
        assert!((ours - published).abs() <= FREQUENCY, "{ours} rad/s, published {published}");
    }
}

/// The published deflections are sums of modes, hence superposition.
#[test]
fn deflections_by_superposition() {
    for (modes, published) in YangYau::DEFLECTIONS {
        let [ours, position] = largest_deflection(modes, Superposition);
        assert!((ours / published - 1.0).abs() <= DEFLECTION, "{modes} modes: {ours:e} m, published {published:e}");
        if modes > 1 {
            assert!((position - YangYau::POSITION).abs() <= POSITION, "{modes} modes: the mass is at {position}");
        }
    }
}

/// With twenty modes the recovery no longer matters; with one, force summation finds three quarters of what superposition
/// lacks.
#[test]
fn deflections_by_force_summation() {
    let [(_, one), (modes, all)] = YangYau::DEFLECTIONS;
    let [ours, position] = largest_deflection(modes, ForceSummation);
    assert!((ours / all - 1.0).abs() <= DEFLECTION, "{modes} modes: {ours:e} m, published {all:e}");
    assert!((position - YangYau::POSITION).abs() <= POSITION, "{modes} modes: the mass is at {position}");

    let [summed, _] = largest_deflection(1, ForceSummation);
    // One mode superposed is not what force summation gives, so the published number tells the two apart.
    assert!((summed / one - 1.0).abs() > 10.0 * DEFLECTION, "{summed:e} m, published for one mode {one:e}");
    let found = (summed - one) / (all - one);
    assert!(found > 0.7 && found < 1.0, "force summation finds {found:.2} of the difference");
}

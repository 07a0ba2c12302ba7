//! Energy under constant traction: conserved without friction or damping, lost to friction and never gained.

use crate::problems::*;
use spanwise::passage::Drive::ConstantTraction;

const GRAVITY: f64 = 9.806_65;

/// Newmark's method with γ = ½ is of second order; an observed order may differ from it by this much.
const ORDER: f64 = 2.0;
const ORDER_MARGIN: f64 = 0.1;

/// Largest drift over the whole crossing in steps of a millisecond, relative to the largest strain energy. Nearly all
/// of it comes about where an axle enters or leaves the deflected bridge: the slope under it jumps.
const DRIFT: f64 = 1e-3;

/// Largest gain in a step while friction takes energy out, relative to the largest strain energy: the integration error
/// of a step of a millisecond, found as without friction.
const GAIN: f64 = 1e-7;

/// From the second axle on the bridge to the first at the middle support, and the like in the second span [ft].
const BETWEEN_SUPPORTS: [[usize; 2]; 2] = [[15, 59], [75, 119]];

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_drift_goes_with_the_square_of_the_step() {
    for vehicle in linear_vehicles() {
        for beta in [1.0 / 6.0, 0.25] {
            for [from, to] in BETWEEN_SUPPORTS {
                let drifts: Vec<f64> = (2..=5)
                    .map(|halvings| KISHAN_PATH << halvings)
                    .map(|count| {
                        let run = kishan_in_steps(&vehicle, ConstantTraction, beta, count, &[0.0]);
                        let energies = run.energies(&vehicle, GRAVITY);
                        let per_foot = count / KISHAN_PATH;
                        let interval = &energies.total[from * per_foot..=to * per_foot];
                        let drift = interval.iter().map(|e| (e - interval[0]).abs()).fold(0.0, f64::max);
                        drift / largest(&energies.strain)
                    })
                    .collect();
                let orders: Vec<f64> = drifts.windows(2).map(|w| (w[0] / w[1]).log2()).collect();
                println!("beta {beta:.3}, {from} to {to} ft: drift {:.1e}, orders {orders:.3?}", drifts[0]);
                assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "beta {beta}: {orders:?}");
            }
        }
    }
}

#[test]
fn energy_is_conserved_over_the_whole_crossing() {
    for vehicle in linear_vehicles() {
        let count = (KISHAN_PATH as f64 / 75.0 / 1e-3).ceil() as usize;
        let run = kishan_in_steps(&vehicle, ConstantTraction, 1.0 / 6.0, count, &[0.0]);
        let energies = run.energies(&vehicle, GRAVITY);
        let drift = energies.total.iter().map(|e| (e - energies.total[0]).abs()).fold(0.0, f64::max);
        let drift = drift / largest(&energies.strain);
        println!("drift {drift:.2e} of the largest strain energy");
        assert!(drift <= DRIFT, "{drift:e}");
        // At constant speed the traction works on the bridge, which this accounting would see.
        let driven = kishan_in_steps(&vehicle, spanwise::passage::Drive::ConstantSpeed, 1.0 / 6.0, count, &[0.0]);
        let energies = driven.energies(&vehicle, GRAVITY);
        let work = energies.total.iter().map(|e| (e - energies.total[0]).abs()).fold(0.0, f64::max);
        assert!(work > 10.0 * DRIFT * largest(&energies.strain), "{work:e} J");
    }
}

#[test]
fn friction_only_takes_energy_out() {
    let vehicle = kishan_vehicle_with_friction(900.0 * POUND);
    let count = 14 * KISHAN_PATH;
    let run = kishan_in_steps(&vehicle, ConstantTraction, 1.0 / 6.0, count, &[0.0]);
    let energies = run.energies(&vehicle, GRAVITY);
    let scale = largest(&energies.strain);
    let history = &run.outcome.history;
    let axles = history.axles;
    // Work of friction in every step, f Δs: not negative, to the bit.
    let mut work = vec![0.0];
    for i in axles..history.friction.len() {
        let taken = history.friction[i] * (history.shortenings[i] - history.shortenings[i - axles]);
        assert!(taken >= 0.0, "friction feeds {taken:e} J in at {} s", history.time[i / axles]);
        match i % axles {
            0 => work.push(work[work.len() - 1] + taken),
            _ => *work.last_mut().unwrap() += taken,
        }
    }
    assert_eq!(work.len(), energies.total.len());
    for [from, to] in BETWEEN_SUPPORTS {
        let interval = from * 14..=to * 14;
        let lost = (energies.total[*interval.start()] - energies.total[*interval.end()]) / scale;
        let taken = (work[*interval.end()] - work[*interval.start()]) / scale;
        let gain = largest(&energies.total[interval].windows(2).map(|w| (w[1] - w[0]) / scale).collect::<Vec<_>>());
        println!("{from} to {to} ft: lost {lost:.3e}, work of friction {taken:.3e}, largest gain {gain:.1e}");
        assert!(gain <= GAIN, "gains {gain:e} of the strain energy in a step");
        assert!(lost > 1e4 * GAIN, "hardly any friction to see: {lost:e}");
        // What is lost is the work of friction.
        assert!((lost / taken - 1.0).abs() < 1e-3, "lost {lost:e}, work of friction {taken:e}");
    }
}

//! Prescribed motion: way, speed and acceleration at any time, and when a place is reached.

use spanwise::passage::Motion;

/// Way by Simpson's rule from the speeds, exact for speeds linear in time.
fn way(motion: &Motion, [from, to]: [f64; 2]) -> f64 {
    let speed = |t: f64| motion.at(t).v;
    (to - from) / 6.0 * (speed(from) + 4.0 * speed(0.5 * (from + to)) + speed(to))
}

fn motions() -> Vec<(&'static str, Motion)> {
    vec![
        ("steady", Motion::steady(-30.0, 20.0)),
        ("faster and faster", Motion::accelerated(-30.0, 10.0, 1.5).unwrap()),
        ("to a stand", Motion::accelerated(-30.0, 20.0, -2.0).unwrap()),
        ("up and down", Motion::through(-30.0, &[1.0, 3.0, 4.0], &[15.0, 25.0, 5.0]).unwrap()),
        ("stops for good", Motion::through(-30.0, &[0.0, 2.0, 3.0], &[15.0, 15.0, 0.0]).unwrap()),
    ]
}

#[test]
fn the_way_is_the_integral_of_the_speed_and_the_speed_that_of_the_acceleration() {
    for (name, motion) in motions() {
        // Pieces that no change of acceleration falls into.
        for pair in [[0.0, 1.0], [1.0, 2.0], [2.0, 3.0], [3.0, 4.0], [4.0, 7.0], [12.0, 15.0]] {
            let [a, b] = pair.map(|t| motion.at(t));
            assert!((b.x - a.x - way(&motion, pair)).abs() < 1e-12 * (1.0 + b.x.abs()), "{name}: {pair:?}");
            let gained = motion.at(0.5 * (pair[0] + pair[1])).a * (pair[1] - pair[0]);
            if name != "to a stand" || pair[1] < 10.0 {
                assert!((b.v - a.v - gained).abs() < 1e-12, "{name}: {pair:?}");
            }
        }
    }
}

#[test]
fn a_place_is_reached_when_the_way_says() {
    for (name, motion) in motions() {
        let (first, last) = (motion.at(0.0).x, motion.at(8.0).x);
        for k in 0..=20 {
            let x = first + 0.05 * f64::from(k) * (last - first);
            let t = motion.time_at(x).unwrap();
            assert!((motion.at(t).x - x).abs() < 1e-9, "{name}: {x} m at {t} s");
        }
    }
}

/// 20 m/s and −2 m/s²: 10 s and 100 m.
#[test]
fn what_slows_down_stands_in_the_end() {
    let motion = Motion::accelerated(-30.0, 20.0, -2.0).unwrap();
    assert_eq!(motion.stands_from(), Some(10.0));
    assert_eq!(motion.at(17.0).x, 70.0);
    assert_eq!(motion.time_at(70.1), None);
    assert_eq!(motion.fastest(), 20.0);
    assert_eq!(Motion::steady(0.0, 3.0).stands_from(), None);
    assert_eq!(Motion::accelerated(0.0, 3.0, 1.0).unwrap().fastest(), f64::INFINITY);
    assert!(Motion::steady(0.0, 3.0).is_steady() && !motion.is_steady());
}

#[test]
fn bad_histories_name_what_is_wrong() {
    let refused = |times: &[f64], speeds: &[f64]| Motion::through(0.0, times, speeds).unwrap_err().to_string();
    for (times, speeds, part) in [
        (&[][..], &[][..], "give as many speeds as times"),
        (&[0.0, 1.0], &[1.0], "give as many speeds as times"),
        (&[0.0, 1.0, 1.0], &[1.0, 1.0, 1.0], "times[2]"),
        (&[-1.0, 1.0], &[1.0, 1.0], "times[0]"),
        (&[0.0, 1.0], &[1.0, -1.0], "speeds[1]"),
        (&[0.0, 1.0], &[1.0, 1e5], "speeds[1]"),
        (&[0.0, f64::NAN], &[1.0, 1.0], "times[1]"),
    ] {
        let text = refused(times, speeds);
        assert!(text.contains(part), "{text}");
    }
    assert!(Motion::accelerated(0.0, 1.0, f64::INFINITY).unwrap_err().to_string().contains("acceleration"));
}

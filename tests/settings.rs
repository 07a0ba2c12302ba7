//! Settings of a crossing: what is refused, by name.

use spanwise::passage::{Settings, Tail};

#[test]
fn values_that_are_not_allowed_are_named() {
    let good = || Settings { approach: 30.0, ramp: 10.0, ..Settings::at_speed(20.0) };
    assert!(good().check().is_ok());
    let cases: [(&str, Settings); 10] = [
        ("approach", Settings { approach: -1.0, ramp: 0.0, ..good() }),
        ("ramp", Settings { ramp: f64::NAN, ..good() }),
        ("ramp", Settings { ramp: 30.1, ..good() }),
        ("tail", Settings { tail: Tail::Fixed(-0.5), ..good() }),
        ("gravity", Settings { gravity: 0.0, ..good() }),
        ("gravity", Settings { gravity: 9.8e5, ..good() }),
        ("step", Settings { step: Some(0.0), ..good() }),
        ("step", Settings { step: Some(f64::INFINITY), ..good() }),
        ("beta", Settings { beta: 0.08, ..good() }),
        ("beta", Settings { beta: f64::NAN, ..good() }),
    ];
    for (key, settings) in cases {
        let refused = settings.check().unwrap_err();
        assert!(refused.is_input() && refused.to_string().starts_with(key), "{key}: {refused}");
    }
}

/// The limits themselves are allowed: 1/12 is Fox and Goodwin's, 1/2 the upper end of Newmark's range.
#[test]
fn the_limits_are_allowed() {
    for beta in [1.0 / 12.0, 1.0 / 6.0, 0.25, 0.5] {
        assert!(Settings { beta, ..Settings::at_speed(20.0) }.check().is_ok(), "{beta}");
    }
    assert!(Settings { approach: 5.0, ramp: 5.0, tail: Tail::Free, ..Settings::at_speed(20.0) }.check().is_ok());
    assert_eq!([Tail::Free, Tail::Fixed(2.0)].map(Tail::seconds), [None, Some(2.0)]);
}

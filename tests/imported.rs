//! Bridges given by their flexibility or their modes: the same crossing as of the bridge that these were taken from.

use faer::Mat;
use spanwise::bridge::Bridge;
use spanwise::crossing::{Analysis, Preparation};
use spanwise::damping::Damping;
use spanwise::imported::{ByFlexibility, ByModes, Given, GivenLines, TwoSided};
use spanwise::modes::Modes;
use spanwise::passage::Settings;
use spanwise::statics::influence;
use spanwise::statics::{Action, Flexibility, Quantity, Structure};
use spanwise::stop_token::StopToken;

use crate::problems::{kishan_vehicle, pinned, two_spans};

const MODES: usize = 3;

/// Largest difference of the extremes of some quantities, relative to the largest of each kind.
fn apart(one: &Analysis, other: &Analysis, quantities: &[Quantity]) -> f64 {
    let settings = Settings { step: Some(1e-3), ..Settings::at_speed(22.86) };
    let [a, b] = [one, other].map(|analysis| analysis.cross(&kishan_vehicle(), &settings, StopToken::NEVER).unwrap());
    let of = |quantity: &Quantity| {
        let [a, b] = [(one, &a), (other, &b)].map(|(analysis, outcome)| {
            let dynamic = analysis.envelope_of(outcome, *quantity, StopToken::NEVER).unwrap().dynamic;
            dynamic.max.iter().chain(&dynamic.min).map(|extreme| extreme.value).collect::<Vec<f64>>()
        });
        assert_eq!(a.len(), b.len(), "{quantity:?}");
        let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest
    };
    quantities.iter().map(of).fold(0.0, f64::max)
}

fn described(bridge: &Bridge, flexibility: &Flexibility, sections: &[f64]) -> (Modes, Analysis) {
    let modes = Modes::new(bridge, flexibility, MODES).unwrap();
    let preparation = Preparation::default().damping(damping()).sections(sections);
    (modes.clone(), preparation.of(bridge, modes, StopToken::NEVER).unwrap())
}

fn damping() -> Damping {
    Damping::Ratios(vec![0.01, 0.02, 0.03])
}

/// By F* of the span without its middle support, which the redundant puts back.
#[test]
fn by_the_flexibility_of_the_basic_bridge() {
    let bridge = two_spans(4);
    let flexibility = Flexibility::new(&bridge, &[]).unwrap();
    let middle = 0.5 * bridge.length();
    // Masses and the support between the ends are the stations.
    let mut stations: Vec<(f64, f64)> = bridge.stations().iter().map(|s| (s.at, s.mass)).collect();
    stations.push((middle, 0.0));
    stations.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (x, masses): (Vec<f64>, Vec<f64>) = stations.into_iter().unzip();
    let mesh = flexibility.mesh();
    let nodes: Vec<usize> = x.iter().map(|&x| mesh.node_at(x)).collect();
    let data = ByFlexibility {
        length: bridge.length(),
        supports: vec![pinned(0.0), pinned(bridge.length())],
        stations: x.clone(),
        masses,
        redundants: vec![(middle, f64::INFINITY)],
        path: x.clone(),
        flexibility: flexibility.matrix(&nodes, &nodes, Structure::Basic),
        slopes: None,
    };
    let given = Given::by_flexibility(&data).unwrap();
    let sections = given.sections();
    let (_, whole) = described(&bridge, &flexibility, &sections);
    let again = Preparation::default().damping(damping()).of_given(&given, MODES).unwrap();
    assert_eq!(again.sections, whole.sections);
    for (a, b) in again.modes.omega.iter().zip(&whole.modes.omega) {
        assert!((a / b - 1.0).abs() < 1e-10, "{a}, {b}");
    }
    let found = apart(&whole, &again, &[Quantity::Deflection, Quantity::Moment, Quantity::Reaction]);
    assert!(found < 1e-8, "{found:e}");

    // Without the redundant it is another bridge.
    let basic = Given::by_flexibility(&ByFlexibility { redundants: Vec::new(), ..data }).unwrap();
    let basic = Preparation::default().of_given(&basic, MODES).unwrap();
    assert!(basic.modes.omega[0] < 0.5 * whole.modes.omega[0]);
}

/// By its modes and one influence line, with slopes at all nodes.
#[test]
fn by_modes_and_influence_lines() {
    let bridge = two_spans(4);
    let section = 0.25 * bridge.length();
    let flexibility = Flexibility::new(&bridge, &[section]).unwrap();
    let (modes, whole) = described(&bridge, &flexibility, &[section]);
    let mesh = flexibility.mesh();
    let path = mesh.nodes().to_vec();
    let lines = modes.lines(&bridge, &flexibility);
    let moment = influence::moment(&flexibility, mesh.node_at(section), Structure::Actual);
    let right =
        |values: &dyn Fn(usize) -> f64| TwoSided { right: Mat::from_fn(1, path.len(), |_, i| values(i)), left: None };
    let shape = |of: &dyn Fn(usize, usize) -> f64| TwoSided { right: Mat::from_fn(path.len(), MODES, of), left: None };
    // The influence line of a moment has a kink at its section.
    let slope_before = |i: usize| if i == 0 { moment.slope_at_node(mesh, 0) } else { moment.slope(mesh, i - 1, 1.0) };
    let slopes = TwoSided {
        left: Some(Mat::from_fn(1, path.len(), |_, i| slope_before(i))),
        ..right(&|i| moment.slope_at_node(mesh, i))
    };
    let mut masses = vec![0.0; path.len()];
    for station in bridge.stations() {
        masses[mesh.node_at(station.at)] = station.mass;
    }
    let data = ByModes {
        frequencies: modes.omega.iter().map(|w| w / std::f64::consts::TAU).collect(),
        shapes: shape(&|i, m| lines[m].at_node(i)),
        slopes: Some(shape(&|i, m| lines[m].slope_at_node(mesh, i))),
        sections: vec![section],
        supports: bridge.supports().to_vec(),
        influence: vec![GivenLines {
            quantity: Quantity::Moment,
            values: right(&|i| moment.at_node(i)),
            slopes: Some(slopes),
            modal: None,
        }],
        masses: Some(masses),
        path: path.clone(),
    };
    let given = Given::by_modes(&data).unwrap();
    let again = Preparation::default().damping(damping()).of_given(&given, MODES).unwrap();
    let found = apart(&whole, &again, &[Quantity::Moment]);
    assert!(found < 1e-9, "{found:e}");
    assert!(again.missing.contains(&Quantity::Reaction) && !again.missing.contains(&Quantity::Moment));
}

/// What it cannot be is refused by name.
#[test]
fn what_is_given_wrongly_is_named() {
    let data = ByFlexibility {
        length: 20.0,
        supports: vec![pinned(0.0), pinned(20.0)],
        stations: vec![5.0, 10.0, 15.0],
        masses: vec![4e4; 3],
        redundants: Vec::new(),
        path: vec![5.0, 10.0, 15.0],
        flexibility: {
            let bridge = crate::problems::continuous(
                &[20.0],
                [crate::problems::PINNED; 2],
                &[2e9],
                &[6e3],
                &spanwise::bridge::Stations::At(vec![5.0, 10.0, 15.0]),
                &[],
            );
            let flexibility = Flexibility::new(&bridge.unwrap(), &[]).unwrap();
            let nodes = [5.0, 10.0, 15.0].map(|x| flexibility.mesh().node_at(x));
            // A column is the deflected shape under a unit load.
            let shape = flexibility.deflected(Action::Force(nodes[0]), Structure::Actual);
            let matrix = flexibility.matrix(&nodes, &nodes, Structure::Actual);
            assert!((matrix[(1, 0)] / shape.at_node(nodes[1]) - 1.0).abs() < 1e-12);
            matrix
        },
        slopes: None,
    };
    assert!(Given::by_flexibility(&data).is_ok());
    let mut lopsided = data.flexibility.clone();
    lopsided[(0, 1)] *= 1.01;
    for (part, wrong) in [
        ("masses", ByFlexibility { masses: vec![4e4; 2], ..data.clone() }),
        ("stations[2]", ByFlexibility { stations: vec![5.0, 10.0, 14.0], ..data.clone() }),
        ("redundants[0]", ByFlexibility { redundants: vec![(11.0, 1e9)], ..data.clone() }),
        ("flexibility", ByFlexibility { flexibility: lopsided, ..data.clone() }),
        ("supports", ByFlexibility { supports: vec![pinned(0.0)], ..data.clone() }),
    ] {
        let refused = Given::by_flexibility(&wrong).unwrap_err().to_string();
        assert!(refused.contains(part), "{part}: {refused}");
    }
}

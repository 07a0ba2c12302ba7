//! Vehicles of several bodies against multipliers for the hinges, hand calculations and mirrors.

use crate::problems::{in_series, kishan_vehicle, largest_difference, spread};
use nalgebra::{DMatrix, DVector};
use spanwise::vehicle::{
    Assembly, Axle, Body, BuildUp, ContactLaw, Coupling, Friction, STICK, Suspension, Vehicle, catalogue,
};

/// Two ways to solve the same small linear systems.
const SOLVED: f64 = 1e-10;

fn axle(position: f64, mass: f64, tyre: f64, suspension: f64) -> Axle {
    let (tyre_damping, suspension_damping) = (1e4, 1e3);
    Axle { mass, tyre_damping, suspension_damping, ..Axle::new(position, tyre, suspension) }
}

fn hinge(to: usize, at: f64, own: f64) -> Coupling {
    Coupling::Hinge { to, at, own, height: 1.1 }
}

fn body(mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<Axle>, couplings: Vec<Coupling>) -> Body {
    Body { mass, pitch_inertia, cg_height, axles, couplings }
}

/// A tractor with its trailer, five axles, of which one is massless if wanted.
fn articulated(massless: bool) -> Vec<Body> {
    let mut bodies = catalogue::articulated_5_axle([0.9, 1.9], 1.1).unwrap().bodies().to_vec();
    if massless {
        bodies[0].axles[1].mass = 0.0;
    }
    bodies
}

/// A truck that draws a dolly, which carries a trailer: two hinges in a chain.
fn road_train() -> Vec<Body> {
    let truck = vec![axle(3.0, 700.0, 2e6, 4e5), axle(-1.5, 1000.0, 4e6, 1e6)];
    vec![
        body(18_000.0, 6e4, 1.4, truck, vec![]),
        body(1500.0, 900.0, 0.8, vec![axle(-0.1, 700.0, 3e6, 8e5)], vec![hinge(0, -3.0, 2.5)]),
        body(16_000.0, 7e4, 1.7, vec![axle(-2.5, 800.0, 4e6, 9e5)], vec![hinge(1, 0.05, 2.7)]),
    ]
}

/// A platform on two frames with secondary springs, as of a rail vehicle, and a cab without axles on it.
fn on_frames() -> Vec<Body> {
    let spring = |at: f64, own: f64| Coupling::Spring {
        to: 0,
        at,
        own,
        stiffness: 1.2e6,
        damping: 2e4,
        friction: Friction::coulomb(3e3),
    };
    let frame = |x: f64| {
        let axles = [1.25, -1.25].map(|at| axle(at, 900.0, 4e7, 2.4e6)).to_vec();
        body(3000.0, 3500.0, 0.6, axles, vec![spring(x + 0.3, 0.3), spring(x - 0.3, -0.3)])
    };
    let cab = body(900.0, 700.0, 2.0, vec![], vec![spring(5.0, 0.6), spring(3.8, -0.6)]);
    vec![body(32_000.0, 1.2e6, 1.6, vec![], vec![]), frame(7.0), frame(-7.0), cab]
}

/// The same vehicle with all coordinates kept: heave and pitch of each body, displacement of each unsprung mass.
struct Full {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// Hinges: G x = 0.
    constraints: DMatrix<f64>,
    weight: DVector<f64>,
    /// By contact: what shortens, and with what stiffness.
    tyres: Vec<(DVector<f64>, f64)>,
}

fn full(bodies: &[Body]) -> Full {
    let axles: usize = bodies.iter().map(|b| b.axles.len()).sum();
    let n = 2 * bodies.len() + axles;
    let unit = |i: usize| DVector::from_fn(n, |j, _| if i == j { 1.0 } else { 0.0 });
    let point = |b: usize, a: f64| unit(2 * b) + unit(2 * b + 1) * a;
    let [mut mass, mut damping, mut stiffness] = [(); 3].map(|()| DMatrix::zeros(n, n));
    let mut add = |to: u8, k: f64, row: &DVector<f64>| {
        let matrix = [&mut mass, &mut damping, &mut stiffness][usize::from(to)].as_mut_slice();
        for i in 0..n * n {
            matrix[i] += k * row[i % n] * row[i / n];
        }
    };
    let (mut weight, mut tyres, mut hinges) = (DVector::zeros(n), Vec::new(), Vec::new());
    let mut next = 2 * bodies.len();
    for (b, body) in bodies.iter().enumerate() {
        add(0, body.mass, &point(b, 0.0));
        add(0, body.pitch_inertia, &unit(2 * b + 1));
        weight[2 * b] = body.mass;
        for axle in &body.axles {
            if axle.mass > 0.0 {
                let suspension = point(b, axle.position) - unit(next);
                add(0, axle.mass, &unit(next));
                add(1, axle.suspension_damping, &suspension);
                add(2, axle.suspension_stiffness, &suspension);
                weight[next] = axle.mass;
                tyres.push((unit(next), axle.tyre_stiffness));
            } else {
                // Its coordinate is not used.
                add(0, 1.0, &unit(next));
                tyres.push((point(b, axle.position), in_series(axle)));
            }
            next += 1;
        }
        for coupling in &body.couplings {
            match *coupling {
                Coupling::Hinge { to, at, own, .. } => hinges.push(point(to, at) - point(b, own)),
                Coupling::Spring { to, at, own, stiffness, damping, .. } => {
                    add(1, damping, &(point(to, at) - point(b, own)));
                    add(2, stiffness, &(point(to, at) - point(b, own)));
                }
            }
        }
    }
    let constraints = DMatrix::from_fn(hinges.len(), n, |i, j| hinges[i][j]);
    Full { mass, damping, stiffness, constraints, weight, tyres }
}

impl Full {
    /// Solves [A Gᵀ; G 0] [x; λ] = [f; 0].
    fn solve(&self, matrix: &DMatrix<f64>, force: &DVector<f64>) -> DVector<f64> {
        let (n, c) = (matrix.nrows(), self.constraints.nrows());
        let mut saddle = DMatrix::zeros(n + c, n + c);
        saddle.view_mut((0, 0), (n, n)).copy_from(matrix);
        // Multipliers on the scale of the matrix keep the elimination accurate.
        let g = &self.constraints * matrix.amax();
        saddle.view_mut((n, 0), (c, n)).copy_from(&g);
        saddle.view_mut((0, n), (n, c)).copy_from(&g.transpose());
        let mut right = DVector::zeros(n + c);
        right.rows_mut(0, n).copy_from(force);
        saddle.full_piv_lu().solve(&right).unwrap().rows(0, n).into_owned()
    }
}

/// All full coordinates of an assembly, body by body and then contact by contact, as rows over q.
fn rows(assembly: &Assembly) -> DMatrix<f64> {
    let n = assembly.coordinates.len();
    let bodies = assembly.bodies.iter().flatten().cloned();
    let hops = assembly.hops.iter().map(|hop| hop.clone().unwrap_or_else(|| DVector::zeros(n)));
    let all: Vec<DVector<f64>> = bodies.chain(hops).collect();
    DMatrix::from_fn(all.len(), n, |i, j| all[i][j])
}

fn assert_close(what: &str, a: &DVector<f64>, b: &DVector<f64>) {
    let error = largest_difference(a.as_slice(), b.as_slice()) / b.amax();
    assert!(error <= SOLVED, "{what}: {error:.1e}");
}

#[test]
fn hinges_are_eliminated_as_multipliers_would_have_it() {
    // Contacts of these vehicles go from the front in the order of their bodies.
    for bodies in [articulated(false), articulated(true), road_train(), on_frames()] {
        let vehicle = Vehicle::of_bodies(bodies.clone()).unwrap();
        let (assembly, full) = (vehicle.assembly(), full(&bodies));
        let rows = rows(assembly);
        let n = full.weight.len();
        // Loose coordinates of massless axles move under no force.
        let used: Vec<bool> = (0..n).map(|i| rows.row(i).amax() > 0.0).collect();
        for trial in 0..4 {
            let force = DVector::from_fn(n, |i, _| if used[i] { 1e4 * (spread(7 * trial + i) - 0.5) } else { 0.0 });
            let reduced = rows.transpose() * &force;
            // Accelerations under any forces.
            let q = assembly.mass.clone().cholesky().unwrap().solve(&reduced);
            assert_close("accelerations", &(&rows * q), &full.solve(&full.mass, &force));
            // Displacements under any forces, on linear tyres.
            let mut grounded = full.stiffness.clone();
            for (row, stiffness) in &full.tyres {
                grounded += row * row.transpose() * *stiffness;
            }
            for i in (0..n).filter(|&i| !used[i]) {
                grounded[(i, i)] += 1e6;
            }
            let k = assembly.grounded_stiffness(Suspension::Sliding);
            assert_close("displacements", &(&rows * k.lu().solve(&reduced).unwrap()), &full.solve(&grounded, &force));
            if trial == 0 {
                let sunk = full.solve(&grounded, &full.weight);
                let loads: Vec<f64> = full.tyres.iter().map(|(row, k)| k * row.dot(&sunk)).collect();
                let error = largest_difference(&loads, &vehicle.static_loads(1.0)) / vehicle.mass();
                assert!(error <= SOLVED, "loads {error:.1e}");
            }
        }
        let projected = rows.transpose() * &full.damping * &rows;
        assert!((&assembly.damping - &projected).amax() <= SOLVED * projected.amax());
        let projected = rows.transpose() * &full.stiffness * &rows;
        assert!((&assembly.stiffness - &projected).amax() <= SOLVED * projected.amax());
        let total: f64 = vehicle.static_loads(1.0).iter().sum();
        assert!((total - vehicle.mass()).abs() <= SOLVED * total);
    }
}

#[test]
fn the_vehicle_of_1973_in_its_coordinates() {
    let vehicle = kishan_vehicle();
    let assembly = vehicle.assembly();
    assert_eq!(assembly.coordinates, ["body 1 heave", "body 1 pitch"]);
    assert_eq!(assembly.mass, DMatrix::from_diagonal(&DVector::from(vec![vehicle.mass(), vehicle.pitch_inertia()])));
    assert_eq!((assembly.stiffness.amax(), assembly.surge_mass.amax()), (0.0, 0.0));
    for (contact, axle) in assembly.contacts.iter().zip(vehicle.axles()) {
        assert_eq!(contact.row, DVector::from(vec![1.0, axle.position]));
        assert_eq!(contact.surge_row, DVector::from(vec![0.0, -vehicle.cg_height()]));
        assert_eq!(contact.position, axle.position);
        assert!(matches!(contact.law, ContactLaw::Series { .. }));
    }
}

#[test]
fn trains_keep_their_loads() {
    let positions = [10.0, 8.0, 5.0];
    let forces = Vehicle::force_train(&[1e4, 2e4, 3e4], &positions).unwrap();
    assert_eq!(forces.static_loads(1.62), [1e4, 2e4, 3e4]);
    assert_eq!((forces.mass(), forces.wheelbase()), (0.0, 5.0));
    assert!(forces.frequencies(Suspension::Locked).is_empty());
    let masses = Vehicle::moving_masses(&[1e3, 2e3, 3e3], &positions).unwrap();
    assert_eq!(masses.static_loads(2.0), [2e3, 4e3, 6e3]);
    assert_eq!(masses.mass(), 6e3);
    // (10 + 2·8 + 3·5)/6 is the centre.
    assert!(largest_difference(&masses.positions(), &positions.map(|x| x - 41.0 / 6.0)) < 1e-12);
}

#[test]
fn bodies_that_pitch_take_each_other_along_the_road() {
    for bodies in [articulated(false), articulated(true), road_train()] {
        let vehicle = Vehicle::of_bodies(bodies.clone()).unwrap();
        let assembly = vehicle.assembly();
        let n = assembly.coordinates.len();
        // Nose down by θ, what is h below the centre of mass goes back by h θ: from road level back up to the body.
        let place = |b: usize| {
            let k = vehicle.axle_order().iter().position(|&(body, _)| body == b).unwrap();
            &assembly.contacts[k].surge_row + &assembly.bodies[b][1] * bodies[b].cg_height
        };
        for (b, body) in bodies.iter().enumerate() {
            for coupling in &body.couplings {
                let Coupling::Hinge { to, height, .. } = *coupling else { continue };
                // Both bodies have the hinge at the same place.
                let one = place(to) - &assembly.bodies[to][1] * (bodies[to].cg_height - height);
                let other = place(b) - &assembly.bodies[b][1] * (body.cg_height - height);
                assert!((&one - &other).amax() <= SOLVED, "{one} {other}");
            }
        }
        // The centre of mass stays where it is; what moves past it has kinetic energy.
        let (mut mean, mut square) = (DVector::zeros(n), DMatrix::zeros(n, n));
        let (mut moment, mut total) = (0.0, 0.0);
        let mut count = |mass: f64, row: DVector<f64>, at: f64| {
            mean += &row * mass;
            square += &row * row.transpose() * mass;
            moment += mass * at;
            total += mass;
        };
        for (b, body) in bodies.iter().enumerate() {
            count(body.mass, place(b), assembly.body_positions[b]);
        }
        for (axle, contact) in vehicle.axles().iter().zip(&assembly.contacts) {
            count(axle.mass, contact.surge_row.clone(), contact.position);
        }
        assert!(mean.amax() <= SOLVED * total);
        assert!((&square - &assembly.surge_mass).amax() <= SOLVED * square.amax());
        assert!(square.amax() > 1e3);
        assert!(f64::abs(moment) <= SOLVED * total && f64::abs(total - vehicle.mass()) <= SOLVED * total);
    }
}

#[test]
fn equal_stiff_springs_share_the_weight_by_hand() {
    // n equal springs at s_i from their middle, the weight W at e ahead of it: W/n + W e s_i/Σ s².
    let (weight, ahead) = (20e3, 0.4);
    for (at, squares) in [(vec![2.0, 0.0, -2.0], 8.0), (vec![3.0, 1.0, -1.0, -3.0], 20.0)] {
        for mass in [0.0, 1e-6] {
            let axles = at.iter().map(|s| axle(s - ahead, mass, 1e9, 3e9)).collect();
            let vehicle = Vehicle::new(weight, 5e4, 1.0, axles).unwrap();
            let hand: Vec<f64> = at.iter().map(|s| weight / at.len() as f64 + weight * ahead * s / squares).collect();
            assert!(largest_difference(&vehicle.static_loads(1.0), &hand) < 1e-5 + SOLVED * weight);
        }
    }
}

#[test]
fn a_hinged_bogie_has_equal_axle_loads_however_unequal_its_springs() {
    let bogie = |own: f64| {
        let axles = vec![axle(0.7, 600.0, 4e6, 2e6), axle(-0.7, 600.0, 3e6, 5e5)];
        vec![
            body(20e3, 6e4, 1.5, vec![axle(3.0, 700.0, 2e6, 4e5)], vec![]),
            body(900.0, 500.0, 0.7, axles, vec![hinge(0, -1.5, own)]),
        ]
    };
    let loads = Vehicle::of_bodies(bogie(0.0)).unwrap().static_loads(1.0);
    assert!((loads[1] - loads[2]).abs() <= SOLVED * loads[1], "{loads:?}");
    // Lever rule: two thirds of the body stand on the bogie, which weighs 900 and 2 600 itself.
    assert!((loads[1] + loads[2] - 20e3 * 3.0 / 4.5 - 2100.0).abs() <= SOLVED * 20e3, "{loads:?}");
    // Off its middle the pivot is a lever too: moments about it, with what the bogie weighs at its centre of mass.
    let loads = Vehicle::of_bodies(bogie(0.1)).unwrap().static_loads(1.0);
    assert!((0.6 * loads[1] - 0.8 * loads[2] - 0.6 * 600.0 + 0.8 * 600.0 + 0.1 * 900.0).abs() <= SOLVED * 20e3);
}

#[test]
fn mirrored_vehicles() {
    for bodies in [articulated(false), road_train(), on_frames()] {
        let turned = bodies.iter().map(|body| {
            let axles = body.axles.iter().rev().map(|axle| Axle { position: -axle.position, ..*axle }).collect();
            let couplings = body.couplings.iter().map(|coupling| match *coupling {
                Coupling::Hinge { to, at, own, height } => Coupling::Hinge { to, at: -at, own: -own, height },
                Coupling::Spring { to, at, own, stiffness, damping, friction } => {
                    Coupling::Spring { to, at: -at, own: -own, stiffness, damping, friction }
                }
            });
            Body { axles, couplings: couplings.collect(), ..body.clone() }
        });
        let mirrored = Vehicle::of_bodies(turned.collect()).unwrap();
        let vehicle = Vehicle::of_bodies(bodies.clone()).unwrap();
        let mut loads = mirrored.static_loads(1.0);
        loads.reverse();
        assert!(largest_difference(&loads, &vehicle.static_loads(1.0)) <= SOLVED * vehicle.mass());
        for suspension in [Suspension::Locked, Suspension::Sliding] {
            let [a, b] = [&mirrored, &vehicle].map(|v| v.frequencies(suspension));
            assert!(largest_difference(&a, &b) <= 1e-8 * b[b.len() - 1], "{a:?} {b:?}");
        }
        let mut positions = mirrored.positions();
        positions.reverse();
        assert!(largest_difference(&positions.iter().map(|x| -x).collect::<Vec<_>>(), &vehicle.positions()) < 1e-12);
    }
}

#[test]
fn friction_that_holds_is_a_spring() {
    // A mass on a spring beside a stick, on a mass on a tyre: a quadratic in ω².
    let (sprung, unsprung, tyre, spring) = (8e3, 700.0, 2e6, 4e5);
    for (build_up, stick) in
        [(BuildUp::Rigid, STICK * tyre), (BuildUp::Elastic(3e6), 3e6), (BuildUp::Leaf(0.002), 2.0 * 5e3 / 0.002)]
    {
        let friction = Friction { build_up, ..Friction::coulomb(5e3) };
        let wheel = Axle { mass: unsprung, friction, ..Axle::new(0.0, tyre, spring) };
        let vehicle = Vehicle::new(sprung, 1.0, 0.0, vec![wheel]).unwrap();
        assert_eq!(vehicle.assembly().coordinates, ["body 1 heave", "axle 1 hop"]);
        assert!(vehicle.assembly().frictions.iter().all(|f| f.friction.build_up != BuildUp::Rigid));
        for (suspension, k) in [(Suspension::Sliding, spring), (Suspension::Locked, spring + stick)] {
            let (b, c) = (k / sprung + (k + tyre) / unsprung, k * tyre / (sprung * unsprung));
            let high = 0.5 * b + (0.25 * b * b - c).sqrt();
            let expected = [c / high, high].map(|square| square.sqrt() / std::f64::consts::TAU);
            assert!(largest_difference(&vehicle.frequencies(suspension), &expected) <= SOLVED * expected[1]);
        }
    }
}

#[test]
fn what_cannot_stand_is_refused_by_name() {
    let refused = |bodies: Vec<Body>, parts: &[&str]| {
        let error = Vehicle::of_bodies(bodies).unwrap_err();
        let text = error.to_string();
        assert!(error.is_input() && parts.iter().all(|part| text.contains(part)), "{text}");
    };
    let changed = |change: &dyn Fn(&mut Vec<Body>)| {
        let mut bodies = articulated(false);
        change(&mut bodies);
        bodies
    };
    let spring = |to: usize, stiffness: f64, damping: f64| Coupling::Spring {
        to,
        at: 0.0,
        own: 0.0,
        stiffness,
        damping,
        friction: Friction::NONE,
    };
    refused(vec![], &["bodies", "at least one body"]);
    refused(changed(&|b| b[1].mass = -1.0), &["bodies[1].mass = -1", "greater than 0"]);
    refused(changed(&|b| b[0].axles[1].mass = -1.0), &["bodies[0].axles[1].mass = -1", "0 or more"]);
    refused(changed(&|b| b[1].axles[2].tyre_damping = -5.0), &["bodies[1].axles[2].tyre_damping = -5", "0 or more"]);
    refused(changed(&|b| b[0].axles[0].suspension_damping = f64::NAN), &["suspension_damping = NaN", "0 or more"]);
    refused(changed(&|b| b[0].axles[0].tyre_stiffness = 0.0), &["axles[0].tyre_stiffness = 0", "greater than 0"]);
    refused(changed(&|b| b[1].axles.reverse()), &["bodies[1].axles[1].position = -2.9 m", "less than -4 m"]);
    refused(changed(&|b| b[1].couplings = vec![hinge(1, 0.0, 1.0)]), &["bodies[1].hinge.to = 1", "earlier body: 0"]);
    refused(changed(&|b| b[1].couplings = vec![hinge(7, 0.0, 1.0)]), &["bodies[1].hinge.to = 7", "earlier body: 0"]);
    refused(changed(&|b| b[0].couplings = vec![hinge(1, 0.0, 1.0)]), &["bodies[0].hinge.to = 1", "first body"]);
    refused(changed(&|b| b[1].couplings.clear()), &["bodies[1] = uncoupled", "hinge or springs"]);
    refused(changed(&|b| b[1].couplings.push(hinge(0, 0.0, 8.3))), &["bodies[1].hinge = 2 hinges", "at most one"]);
    refused(changed(&|b| b[1].couplings.push(spring(0, 0.0, 0.0))), &["bodies[1].springs[0].stiffness = 0"]);
    refused(changed(&|b| b[1].couplings.push(spring(0, 1e6, -1.0))), &["bodies[1].springs[0].damping = -1"]);
    refused(changed(&|b| b[1].couplings.push(spring(0, 1e6, 0.0))), &["bodies[1].springs[0].own", "upright", "8.3 m"]);
    // The trailer's axles gone, it falls; with the tractor's gone as well as the rear ones, it swings.
    refused(changed(&|b| b[1].axles.clear()), &["bodies[1].axles = 0", "free to pitch"]);
    refused(changed(&|b| b[1].couplings = vec![hinge(0, -2.15, -6.0)]), &["would carry no load"]);
    let meeting = [6.15 + 2.15 - 2.5, -2.9].map(|x| axle(x, 700.0, 2e6, 1e6)).to_vec();
    refused(changed(&|b| b[1].axles = meeting.clone()), &["bodies[", "axles[", "must not be where"]);
    let leaf = Friction { build_up: BuildUp::Leaf(0.001), ..Friction::coulomb(f64::INFINITY) };
    refused(changed(&|b| b[0].axles[0].friction = leaf), &["friction_limit = inf", "leaf_decay"]);
    let stick = Friction { build_up: BuildUp::Elastic(0.0), ..Friction::coulomb(1e3) };
    refused(changed(&|b| b[0].axles[0].friction = stick), &["bodies[0].axles[0].stick_stiffness = 0"]);
    let massless =
        Axle { mass: 0.0, friction: Friction { build_up: BuildUp::Elastic(1e6), ..stick }, ..axle(0.5, 0.0, 2e6, 1e6) };
    refused(changed(&|b| b[0].axles[0] = massless), &["stick_stiffness = 1000000 N/m", "massless"]);
    let beyond = Friction { initial: -2e3, ..Friction::coulomb(1e3) };
    refused(changed(&|b| b[0].axles[0].friction = beyond), &["initial_friction = -2000 N", "-1000 to 1000 N"]);
    for (train, parts) in [
        (Vehicle::force_train(&[], &[]), ["loads = []", "at least one"]),
        (Vehicle::force_train(&[1.0, -1.0], &[1.0, 0.0]), ["loads[1] = -1", "greater than 0"]),
        (Vehicle::force_train(&[1.0, 1.0], &[0.0, 0.0]), ["positions[1] = 0 m", "less than 0 m"]),
        (Vehicle::moving_masses(&[1.0], &[]), ["positions = 0 values", "each of the 1 masses"]),
    ] {
        let text = train.unwrap_err().to_string();
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    }
}

//! Vehicles of several bodies against multipliers for the hinges, hand calculations and mirrors.

mod problems;

use nalgebra::{DMatrix, DVector};
use problems::{kishan_vehicle, largest_difference, spread};
use spanwise::assembly::{Assembly, ContactLaw, Friction};
use spanwise::vehicle::{Axle, Body, Coupling, Suspension, Vehicle};

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
    let mass = if massless { 0.0 } else { 1100.0 };
    let front = vec![axle(0.5, 700.0, 1.75e6, 4e5), axle(-2.5, mass, 3.5e6, 1e6)];
    let rear = [-1.8, -2.9, -4.0].map(|x| axle(x, 750.0, 3.5e6, 7.5e5)).to_vec();
    vec![body(4500.0, 4604.0, 0.9, front, vec![]), body(31_450.0, 16_302.0, 1.9, rear, vec![hinge(0, -2.15, 6.15)])]
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
                tyres.push((point(b, axle.position), axle.sliding_stiffness()));
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

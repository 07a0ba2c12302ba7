//! Influence lines against beam elements with a node at the load, and against each other in a mirror.

use crate::problems::elements::{self, Solved};
use crate::problems::{all_arrangements, mirrored, more_points, points};
use spanwise::bridge::{Bridge, Line, Mesh};
use spanwise::statics::influence;
use spanwise::statics::{Flexibility, Quantity, Responses, Restraint, Structure};
use spanwise::stop_token::StopToken;

/// Two routes to one number, the elements' the worse conditioned one, relative to the largest of its kind.
const ROUNDING: f64 = 1e-9;

/// Which side of a section a load at the section stands on.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

/// Value of a line for a load at x, just left or just right of it.
fn read(line: &Line, mesh: &Mesh, x: f64, side: Side) -> f64 {
    let node = mesh.node_at(x);
    match side {
        _ if (mesh.nodes()[node] - x).abs() > 1e-9 * mesh.length() => line.at(mesh, x),
        Side::Left => line.before(node),
        Side::Right => line.after(node),
    }
}

/// Remembers the largest difference and the largest value of a kind of response.
#[derive(Default)]
struct Worst {
    difference: f64,
    scale: f64,
}

impl Worst {
    fn take(&mut self, ours: f64, exact: f64) {
        self.difference = self.difference.max((ours - exact).abs());
        self.scale = self.scale.max(exact.abs());
        assert!(ours.is_finite() && exact.is_finite());
    }

    fn check(&self, what: &str) -> f64 {
        assert!(self.difference <= ROUNDING * self.scale, "{what}: {:.2e} of {:.2e}", self.difference, self.scale);
        self.difference / self.scale.max(f64::MIN_POSITIVE)
    }
}

fn solved(bridge: &Bridge, structure: Structure, x: f64) -> Solved {
    elements::solve(bridge, structure, &[(x, 1.0)], &points(bridge))
}

/// Deflection, slope, moment and both shears at every section, for a unit load everywhere.
#[test]
fn section_responses_against_elements() {
    for (name, bridge) in all_arrangements() {
        let sections = points(&bridge);
        let flexibility = Flexibility::new(&bridge, &sections).unwrap();
        let mesh = flexibility.mesh();
        for structure in [Structure::Basic, Structure::Actual] {
            let mut worst: [Worst; 5] = Default::default();
            let lines: Vec<(usize, [Line; 5])> = sections
                .iter()
                .map(|&s| {
                    let node = mesh.node_at(s);
                    let [left, right] = influence::shear(&flexibility, node, structure);
                    let moment = influence::moment(&flexibility, node, structure);
                    let deflection = influence::deflection(&flexibility, node, structure);
                    (node, [deflection, influence::slope(&flexibility, node, structure), moment, left, right])
                })
                .collect();
            for x in more_points(&bridge) {
                let exact = solved(&bridge, structure, x);
                for (&s, (_, lines)) in sections.iter().zip(&lines) {
                    let [left, right] = exact.shears(s);
                    let expected = [exact.deflection(s), exact.slope(s), exact.moment(s), left, right];
                    // A load on the section belongs to the right of its left side, and to the left of its right side.
                    let sides = [Side::Right, Side::Right, Side::Right, Side::Right, Side::Left];
                    for i in 0..5 {
                        // Nothing stands beyond an end: there the one side is the only one.
                        let side = match x {
                            0.0 => Side::Right,
                            x if x == bridge.length() => Side::Left,
                            _ => sides[i],
                        };
                        let beyond = (i == 3 && s == bridge.length() && x == s) || (i == 4 && s == 0.0 && x == s);
                        if !beyond {
                            worst[i].take(read(&lines[i], mesh, x, side), expected[i]);
                        }
                    }
                }
            }
            let found: Vec<String> = worst
                .iter()
                .zip(["deflection", "slope", "moment", "shear left", "shear right"])
                .map(|(worst, what)| format!("{:.0e}", worst.check(&format!("{name}, {structure:?}, {what}"))))
                .collect();
            println!("{name}, {structure:?}: {}", found.join(" "));
        }
    }
}

#[test]
fn reactions_against_elements() {
    for (name, bridge) in all_arrangements() {
        let flexibility = Flexibility::new(&bridge, &points(&bridge)).unwrap();
        let mesh = flexibility.mesh();
        for structure in [Structure::Basic, Structure::Actual] {
            let restraints = flexibility.restraints(structure);
            let (clamps, forces): (Vec<Restraint>, Vec<Restraint>) =
                restraints.into_iter().partition(|r| matches!(r, Restraint::Slope(_)));
            let lines = |list: &[Restraint]| -> Vec<Line> {
                list.iter().map(|&r| influence::reaction(&flexibility, r, structure)).collect()
            };
            let (forces, clamps) = (lines(&forces), lines(&clamps));
            let (mut of_forces, mut of_clamps) = (Worst::default(), Worst::default());
            for x in more_points(&bridge) {
                let exact = solved(&bridge, structure, x);
                assert_eq!((exact.reactions.len(), exact.clamp_moments.len()), (forces.len(), clamps.len()), "{name}");
                forces.iter().zip(&exact.reactions).for_each(|(line, e)| of_forces.take(line.at(mesh, x), *e));
                clamps.iter().zip(&exact.clamp_moments).for_each(|(line, e)| of_clamps.take(line.at(mesh, x), *e));
                // Whatever the load, the supports carry it.
                let sum: f64 = forces.iter().map(|line| line.at(mesh, x)).sum();
                assert!((sum - 1.0).abs() <= ROUNDING, "{name}: reactions to a unit load at {x} m add up to {sum}");
            }
            let off = [of_forces.check(&format!("{name}, reactions")), of_clamps.check(&format!("{name}, clamps"))];
            println!("{name}, {structure:?}: {:.0e} {:.0e}", off[0], off[1]);
        }
    }
}

/// Influence lines of the mirrored bridge are mirror images: slopes and shears change sign, shears also side.
#[test]
fn mirror_images() {
    for (name, bridge) in all_arrangements() {
        let image = mirrored(&bridge);
        let length = bridge.length();
        let sections = points(&bridge);
        let turned: Vec<f64> = sections.iter().rev().map(|x| length - x).collect();
        let [one, two] = [(&bridge, &sections), (&image, &turned)].map(|(bridge, sections)| {
            let flexibility = Flexibility::new(bridge, sections).unwrap();
            let responses = Responses::new(&flexibility, bridge, sections, &Quantity::USUAL, StopToken::NEVER).unwrap();
            (flexibility, responses)
        });
        for quantity in Quantity::USUAL {
            let (partner, sign) = match quantity {
                Quantity::ShearLeft => (Quantity::ShearRight, -1.0),
                Quantity::ShearRight => (Quantity::ShearLeft, -1.0),
                other => (other, 1.0),
            };
            let [ours, theirs] = [(&one.1, quantity), (&two.1, partner)].map(|(r, q)| &r.lines()[r.range(q)]);
            assert_eq!(ours.len(), theirs.len());
            let mut worst = Worst::default();
            for (i, (line, image)) in ours.iter().zip(theirs.iter().rev()).enumerate() {
                // Inside the bridge a support that holds the rotation has a moment on its left and one on its right,
                // and its own changes sign in the mirror.
                let held = bridge.supports().iter().filter(|s| s.fixity.rotation() > 0.0).map(|s| s.at);
                let inside = |x: f64| x > 0.0 && x < length;
                let sign = match quantity {
                    Quantity::Moment if held.clone().any(|x| inside(x) && x == sections[i]) => continue,
                    Quantity::ClampMoment if held.clone().nth(i).is_some_and(inside) => -sign,
                    _ => sign,
                };
                for x in more_points(&bridge) {
                    let [l, r] = [(Side::Left, Side::Right), (Side::Right, Side::Left)].map(|(side, turned)| {
                        let ours = read(line, one.0.mesh(), x, side);
                        (ours, sign * read(image, two.0.mesh(), length - x, turned))
                    });
                    worst.take(l.0, l.1);
                    worst.take(r.0, r.1);
                }
            }
            worst.check(&format!("{name}, {quantity:?}"));
        }
        let mut worst = Worst::default();
        // At a hinge the slope is the one to the right, and to the left in the mirror.
        for &s in sections.iter().filter(|s| !bridge.hinges().contains(s)) {
            let line = influence::slope(&one.0, one.0.mesh().node_at(s), Structure::Actual);
            let image = influence::slope(&two.0, two.0.mesh().node_at(length - s), Structure::Actual);
            more_points(&bridge).into_iter().for_each(|x| {
                worst.take(line.at(one.0.mesh(), x), -image.at(two.0.mesh(), length - x));
            });
        }
        worst.check(&format!("{name}, slope"));
    }
}

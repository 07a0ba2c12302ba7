//! The compliance S in δ = u − S p: how much each unit of contact or friction force takes off the shortening that the
//! contacts and friction elements follow, because bridge and vehicles give way.

use super::coupled_forces::Elements;
use super::newmark::Newmark;
use super::sizes::Form;
use super::unit::Unit;
use crate::lane::Lane;

/// How the contacts feel the bridge and each other where they stand: what a step needs that depends on the geometry and
/// the parameters alone, not on the state.
pub struct Interaction<'r, L> {
    /// Φ⁰, contact by contact.
    pub shapes: &'r [L],
    /// Modal forces under the static axle loads, contact by contact.
    pub pressing: &'r [L],
    /// Modal accelerations under unit axle loads, contact by contact.
    pub receptance: &'r [L],
    /// What the increments of the forces take off what the elements follow, by rows.
    pub compliance: &'r [L],
    /// What holds of each element.
    pub held: &'r [L],
}

impl<'r, L> Interaction<'r, L> {
    #[inline(always)]
    pub fn of(form: Form, numbers: &'r [L]) -> Self {
        let [a, b, c, d, e] = form.parts();
        Interaction {
            shapes: &numbers[..a],
            pressing: &numbers[a..b],
            receptance: &numbers[b..c],
            compliance: &numbers[c..d],
            held: &numbers[d..e],
        }
    }
}

/// What the vehicles add to the compliance of the elements, by rows.
pub fn above<L: Lane>(newmark: &Newmark<L>, units: &[Unit<L>], elements: &Elements<L>) -> Vec<L> {
    let n = elements.known().all();
    let mut above = vec![L::splat(0.0); n * n];
    // A vehicle without coordinates adds nothing.
    for unit in units.iter().filter(|unit| unit.rig.size > 0) {
        for own in 0..unit.rig.elements {
            let k = unit.element(own);
            let factor = match elements.contacts.get(k).map(|contact| contact.weights) {
                Some(weights) => weights.value * newmark.new + weights.rate * newmark.half_h,
                None => newmark.new,
            };
            for (other, coupling) in unit.rig.coupling(own).iter().enumerate() {
                above[k * n + unit.element(other)] = factor * *coupling;
            }
        }
    }
    above
}

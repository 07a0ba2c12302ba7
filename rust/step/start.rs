//! The first instant: vehicles in equilibrium on the road where they stand, and what moves them out of it.

use super::compliance::Interaction;
use super::sizes::{Desk, Form};
use super::stand::Stood;
use super::stepper::{State, Stepper, Unsettled};
use super::unit::Unit;
use crate::coordinate::Coordinate;
use crate::geometry::Geometry;
use crate::lane::Lane;

impl<L: Lane> Stepper<L> {
    /// Static equilibrium with the contacts where `geometry` has them, on the road there and with the friction of the
    /// static state, the bridge at rest and straight, each vehicle at its speed.
    ///
    /// An axle that stands on the bridge at the start loads it suddenly, as a slope of the road does a damped tyre; the first
    /// accelerations say so. To find them this stepper must have been made for steps of zero length.
    pub fn start(&mut self, speeds: &[L], geometry: &impl Geometry<L>) -> Result<State<L>, Unsettled> {
        self.start_surging(speeds, geometry, |_, _, _| ())
    }

    /// The same, where `surge` has its say on how the vehicles begin to move along the road.
    #[inline(never)]
    pub(super) fn start_surging(
        &mut self,
        speeds: &[L],
        geometry: &impl Geometry<L>,
        surge: impl FnOnce(&mut Self, &mut State<L>, &Desk<'_, L>),
    ) -> Result<State<L>, Unsettled> {
        let zero = L::splat(0.0);
        let contacts = self.elements.contacts.iter().map(|c| c.at_rest());
        let form = self.form;
        let mut state = State {
            modes: vec![Coordinate::rest(); form.modes],
            coordinates: vec![Coordinate::rest(); form.coordinates],
            travel: speeds.iter().map(|&v| Coordinate { x: zero, v, a: zero }).collect(),
            increments: vec![zero; form.all()],
            strokes: contacts.chain(self.elements.rubbing.iter().map(|r| r.at_rest())).collect(),
            along: vec![zero; form.contacts()],
        };
        let mut room = self.room.clone();
        let mut desk = room.desk();
        let stood = self.stand(geometry)?;
        self.predict(form, &state, &mut desk);
        self.push_along(form, &mut state, geometry, &desk);
        self.begin(form, &mut state, geometry, &stood, &mut desk)?;
        // The loads of the first instant do not depend on how the vehicles surge under them.
        surge(self, &mut state, &desk);
        self.begin(form, &mut state, geometry, &stood, &mut desk)?;
        for ((stroke, contact), delta) in state.strokes.iter_mut().zip(&self.elements.contacts).zip(&*desk.offset) {
            *stroke = contact.at_onset(*delta);
        }
        for (unit, stood) in self.units.iter().zip(stood) {
            let Some(stood) = stood else { continue };
            for (contact, shortening) in unit.contacts.clone().zip(stood.shortenings) {
                state.strokes[contact].shortening = shortening;
            }
            for (own, rubbing) in (unit.contacts.len()..).zip(unit.rubbing.clone()) {
                state.strokes[rubbing].shortening = unit.rig.shortening(own, &stood.coordinates);
            }
            for (coordinate, stood) in state.coordinates[unit.coordinates.clone()].iter_mut().zip(stood.coordinates) {
                coordinate.x = stood;
            }
        }
        Ok(state)
    }

    /// How each vehicle stands where `geometry` has its contacts; nothing of one on level ground, or that has nothing to
    /// settle.
    fn stand(&self, geometry: &impl Geometry<L>) -> Result<Vec<Option<Stood<L>>>, Unsettled> {
        let zero = L::splat(0.0);
        let of = |unit: &Unit<L>| {
            let Some(stand) = &unit.stand else { return Ok(None) };
            let elevations: Vec<L> = unit.contacts.clone().map(|k| geometry.surface(k).elevation).collect();
            if !elevations.iter().any(|r| L::any(r.less(zero) | zero.less(*r))) {
                return Ok(None);
            }
            stand.on(&elevations).map(Some).ok_or(Unsettled::ContactForces)
        };
        self.units.iter().map(of).collect()
    }

    /// Forces and accelerations of the first instant: what moves the vehicles out of the equilibrium in which they stand.
    fn begin(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        stood: &[Option<Stood<L>>],
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.set_up(form, geometry, None, desk);
        let wheels = self.elements.contacts.iter().enumerate().filter(|(_, contact)| !contact.constant);
        for (k, contact) in wheels {
            desk.offset[k] = desk.offset[k] - contact.weights.value * geometry.surface(k).elevation;
        }
        self.solve_forces(form, state, desk)?;
        let receptance = Interaction::of(form, desk.interaction).receptance;
        for (unit, stood) in self.units.iter().zip(stood) {
            for (k, load) in unit.contacts.clone().zip(stood.iter().flat_map(|stood| &stood.loads)) {
                state.increments[k] = self.elements.contacts[k].floor().larger(state.increments[k] + *load);
                for (m, mode) in state.modes.iter_mut().enumerate() {
                    mode.a = mode.a + receptance[k * form.modes + m] * *load;
                }
            }
        }
        Ok(())
    }
}

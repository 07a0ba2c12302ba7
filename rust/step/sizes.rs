//! Numbers of modes, contacts and coordinates in a step: callers can give the usual ones in literals, so that loops run
//! a known number of times; and the room that a step of that size works in.

use super::contact::{HELD, Prepared};
use super::coupled_forces::Known;
use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// What decides which way a step goes. It is passed by value: where a caller gives it in literals, every loop below runs
/// a known number of times, and what is not asked for is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    pub modes: usize,
    pub elements: Known,
    pub vehicles: usize,
    /// Coordinates of all vehicles.
    pub coordinates: usize,
    /// Whether all contact forces follow from the shortening alone.
    pub plain: bool,
    /// Whether each mode is damped by itself.
    pub classical: bool,
    /// Whether there are no springs and dampers between the vehicles' coordinates.
    pub bare: bool,
    /// Whether nothing but element forces acts on the vehicles' coordinates.
    pub passive: bool,
}

/// One rigid body on so many axles without mass, with Coulomb friction, on its way to the bridge.
const fn on_axles(contacts: usize) -> Form {
    Form {
        modes: 0,
        elements: Known { contacts, rubbing: 0, coulomb: true },
        vehicles: 1,
        coordinates: 2,
        plain: true,
        classical: true,
        bare: true,
        passive: true,
    }
}

pub const TWO_AXLES: Form = on_axles(2);
pub const THREE_AXLES: Form = on_axles(3);
pub const FOUR_AXLES: Form = on_axles(4);
pub const FIVE_AXLES: Form = on_axles(5);

/// On two axles on a bridge of three modes.
pub const USUAL: Form = Form { modes: 3, ..TWO_AXLES };

/// One rigid body on two axles with mass, on springs and dampers.
pub const HALF_CAR: Form = Form {
    elements: Known { coulomb: false, ..TWO_AXLES.elements },
    coordinates: 4,
    bare: false,
    passive: false,
    ..TWO_AXLES
};

impl Form {
    /// Number of contacts.
    #[inline(always)]
    pub const fn contacts(self) -> usize {
        self.elements.contacts
    }

    /// Number of elements.
    #[inline(always)]
    pub const fn all(self) -> usize {
        self.elements.contacts + self.elements.rubbing
    }

    /// Where each part of a [`Interaction`](super::compliance::Interaction) begins, and where the last ends.
    #[inline(always)]
    pub const fn parts(self) -> [usize; 5] {
        let (each, n) = (self.contacts() * self.modes, self.all());
        [each, 2 * each, 3 * each, 3 * each + n * n, 3 * each + n * n + n * HELD]
    }

    /// How many numbers a [`Interaction`](super::compliance::Interaction) has.
    #[inline(always)]
    pub const fn width(self) -> usize {
        self.parts()[4]
    }
}

/// Room to work in for a step, of any kind that can be taken as slices: arrays where their size is known, so that what is
/// in them need not be written to memory.
#[derive(Debug, Clone, Default)]
pub struct Room<C, N, P> {
    /// Modes and vehicles at the end of the step if accelerations there were zero.
    pub predicted: C,
    pub bodies: C,
    /// Forces with which the modes resist as predicted.
    pub resisting: N,
    /// Modal forces under the static axle loads, and accelerations.
    pub forces: N,
    pub accelerations: N,
    /// The end of the step under the static axle loads.
    pub loaded: C,
    /// What unit modal accelerations do to δ of a contact.
    pub senses: N,
    pub interaction: N,
    /// What the elements follow, but for the increments of the forces.
    pub offset: N,
    /// The increments, and those of the next sweep.
    pub increments: N,
    pub fresh: N,
    pub prepared: P,
}

/// The room that is borrowed for a step.
pub type Desk<'r, L> = Room<&'r mut [Coordinate<L>], &'r mut [L], &'r mut [Prepared<L>]>;

impl<C, N, P> Room<C, N, P> {
    #[inline(always)]
    pub fn desk<L>(&mut self) -> Desk<'_, L>
    where
        C: AsMut<[Coordinate<L>]>,
        N: AsMut<[L]>,
        P: AsMut<[Prepared<L>]>,
    {
        Room {
            predicted: self.predicted.as_mut(),
            bodies: self.bodies.as_mut(),
            resisting: self.resisting.as_mut(),
            forces: self.forces.as_mut(),
            accelerations: self.accelerations.as_mut(),
            loaded: self.loaded.as_mut(),
            senses: self.senses.as_mut(),
            interaction: self.interaction.as_mut(),
            offset: self.offset.as_mut(),
            increments: self.increments.as_mut(),
            fresh: self.fresh.as_mut(),
            prepared: self.prepared.as_mut(),
        }
    }
}

/// Room for the usual forms.
pub type UsualRoom<L> = Room<[Coordinate<L>; USUAL.modes], [L; USUAL.width()], [Prepared<L>; USUAL.all()]>;

// Vehicles find room there too.
const _: () = assert!(USUAL.coordinates <= USUAL.modes);

impl<L: Lane> UsualRoom<L> {
    #[inline(always)]
    pub fn usual() -> Self {
        let (rest, zeros) = ([Coordinate::rest(); USUAL.modes], [L::splat(0.0); USUAL.width()]);
        Room {
            predicted: rest,
            bodies: rest,
            resisting: zeros,
            forces: zeros,
            accelerations: zeros,
            loaded: rest,
            senses: zeros,
            interaction: zeros,
            offset: zeros,
            increments: zeros,
            fresh: zeros,
            prepared: [Prepared::nothing(); USUAL.all()],
        }
    }
}

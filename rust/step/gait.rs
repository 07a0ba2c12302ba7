//! What a vehicle is like where the usual ones have steps of their own ([`swift`](super::swift)).

/// What a vehicle is like, as far as its steps take other ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gait {
    /// Number of contacts.
    pub contacts: usize,
    /// Number of coordinates.
    pub coordinates: usize,
    /// What it stands on.
    pub law: Standing,
}

/// What a vehicle stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Massless axles with rigid Coulomb friction, and no springs and dampers elsewhere.
    Coulomb,
    /// Tyres without dampers.
    Springs,
    /// Tyres with dampers.
    Dampers,
}

/// The numbers of a law, as those of [`Standing`] are numbered.
pub const COULOMB: u8 = 0;
pub const SPRINGS: u8 = 1;
pub const DAMPERS: u8 = 2;

/// How many numbers of each mode there are in the interaction, by contact: shape, force under the static load, receptance,
/// and with dampers the pace at which the shape passes under the contact.
pub const fn of_mode(contacts: usize, law: u8) -> usize {
    if law == DAMPERS { 4 * contacts } else { 3 * contacts }
}

/// A massless axle.
#[derive(Debug, Clone, Copy)]
pub struct Slider<L> {
    pub stiffness: L,
    pub give: L,
    pub initial: L,
    pub limit: L,
}

//! How rough a road is: what the length of a time step has to know of it.

/// What of a road asks for short steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// Mean square of its slope under the contact patch, but for single features [-].
    pub slope_power: f64,
    /// Its highest wave number, but for single features [cycle/m].
    pub highest: f64,
    /// The shortest edge or contact patch of its features [m].
    pub finest: f64,
}

impl Texture {
    /// Nothing.
    pub const SMOOTH: Self = Texture { slope_power: 0.0, highest: 0.0, finest: f64::INFINITY };

    /// Of one road on top of another.
    pub fn with(self, other: Self) -> Self {
        Texture {
            slope_power: self.slope_power + other.slope_power,
            highest: self.highest.max(other.highest),
            finest: self.finest.min(other.finest),
        }
    }
}

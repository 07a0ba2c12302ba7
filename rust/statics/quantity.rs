//! The kinds of response: what each is called, where it is looked at, what its unit is.

/// A kind of response. Signs: deflection down, slope falling to the right, sagging moment, shear as the sum of upward
/// forces to the left, reactions up and clamp moments sagging, velocity and acceleration down, all positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Deflection at the sections [m].
    Deflection,
    /// Bending moment at the sections [N m].
    Moment,
    /// Shear just left of the sections [N].
    ShearLeft,
    /// Shear just right of the sections [N].
    ShearRight,
    /// Vertical reactions of the supports, on the bridge [N].
    Reaction,
    /// Moments of the supports that hold the rotation, on the bridge [N m]: at an end sagging, elsewhere the rise of the
    /// bending moment across the support.
    ClampMoment,
    /// Slope of the deflected beam at the sections [rad], at a hinge that just right of it.
    Slope,
    /// Velocity of the deck at the sections [m/s].
    Velocity,
    /// Acceleration of the deck at the sections [m/s²].
    Acceleration,
}

/// Where a kind of response is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// At the sections.
    Sections,
    /// At the supports that hold the deflection.
    Supports,
    /// At the supports that hold the rotation.
    Clamps,
}

/// What a kind of response is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// m
    Metre,
    /// N
    Newton,
    /// N m
    NewtonMetre,
    /// rad
    Radian,
}

/// What is to be known of a kind of response.
struct Row {
    name: &'static str,
    of_results: &'static str,
    at: At,
    unit: Unit,
    order: usize,
}

impl Quantity {
    /// Those of statics, in the order in which responses are laid out unless others are asked for.
    pub const USUAL: [Quantity; 6] = [
        Quantity::Deflection,
        Quantity::Moment,
        Quantity::ShearLeft,
        Quantity::ShearRight,
        Quantity::Reaction,
        Quantity::ClampMoment,
    ];

    /// All kinds.
    pub const ALL: [Quantity; 9] = [
        Quantity::Deflection,
        Quantity::Moment,
        Quantity::ShearLeft,
        Quantity::ShearRight,
        Quantity::Reaction,
        Quantity::ClampMoment,
        Quantity::Slope,
        Quantity::Velocity,
        Quantity::Acceleration,
    ];

    #[rustfmt::skip]
    const fn row(self) -> Row {
        use At::{Clamps, Sections, Supports};
        use Unit::{Metre, Newton, NewtonMetre, Radian};
        let (name, of_results, at, unit, order) = match self {
            Quantity::Deflection => ("deflection", "deflection", Sections, Metre, 0),
            Quantity::Moment => ("moment", "moment", Sections, NewtonMetre, 0),
            Quantity::ShearLeft => ("shear-left", "shear_left", Sections, Newton, 0),
            Quantity::ShearRight => ("shear-right", "shear_right", Sections, Newton, 0),
            Quantity::Reaction => ("reaction", "reactions", Supports, Newton, 0),
            Quantity::ClampMoment => ("clamp-moment", "clamp_moments", Clamps, NewtonMetre, 0),
            Quantity::Slope => ("slope", "slope", Sections, Radian, 0),
            Quantity::Velocity => ("velocity", "velocity", Sections, Metre, 1),
            Quantity::Acceleration => ("acceleration", "acceleration", Sections, Metre, 2),
        };
        Row { name, of_results, at, unit, order }
    }

    /// What it is called in messages and among the arguments of a bridge given by its modes.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// What results call it.
    pub fn of_results(self) -> &'static str {
        self.row().of_results
    }

    /// Where it is looked at.
    pub fn at(self) -> At {
        self.row().at
    }

    /// What it, or what it is a time derivative of, is measured in.
    pub fn unit(self) -> Unit {
        self.row().unit
    }

    /// Of deck motion which time derivative it is; 0 of what follows from forces.
    pub fn order(self) -> usize {
        self.row().order
    }

    /// The kind that it is one with along the bridge: shears on both sides of a section.
    pub fn together(self) -> Quantity {
        if self == Quantity::ShearRight { Quantity::ShearLeft } else { self }
    }
}

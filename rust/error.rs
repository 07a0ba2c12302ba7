//! What can go wrong, in one enum: bad input, a step that is too long, a solve that failed.

/// Every failure of the engine. [`Error::is_input`] separates what the user can mend from numerical trouble.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A value outside what is allowed.
    #[error("{}", self.in_words())]
    Input {
        /// Name of the argument, as the user wrote it.
        key: String,
        /// The offending value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// What would take more memory than this machine has left.
    #[error("{}", self.in_words())]
    Memory {
        /// Name of the argument that asks for it.
        key: String,
        /// Its value.
        value: String,
        /// How much, and what would take less.
        allowed: String,
    },
    /// The supports leave a rigid-body motion free.
    #[error("{}", self.in_words())]
    Unstable {
        /// The supports as given.
        supports: String,
        /// The rigid-body motion that nothing prevents.
        motion: &'static str,
    },
    /// The hinges leave parts of the beam free to turn.
    #[error("{}", self.in_words())]
    Mechanism {
        /// Number of the first hinge, left to right, that turns freely.
        hinge: usize,
        /// Its position [m].
        at: f64,
    },
    /// A time step beyond the stability limit of the chosen Newmark scheme.
    #[error("{}", self.in_words())]
    StepTooLong {
        /// The step asked for [s].
        step: f64,
        /// Newmark's β [-].
        beta: f64,
        /// The longest stable step [s].
        limit: f64,
        /// Upper bound of the fastest coupled frequency [Hz].
        frequency: f64,
    },
    /// The eigensolution failed or did not pass its own check.
    #[error("modes: {0}")]
    Modes(String),
    /// A flexibility matrix that should be positive definite is not.
    #[error("flexibility of the redundant restraints is not positive definite: {0}")]
    Singular(String),
    /// The contact forces or the axle positions did not settle within a step.
    #[error("no convergence of the {what} at t = {time:.6} s (front axle at x = {position:.4} m); shorten the step")]
    NoConvergence {
        /// What did not settle.
        what: &'static str,
        /// Number of the step.
        step: usize,
        /// Time [s].
        time: f64,
        /// Position of the front axle [m].
        position: f64,
    },
    /// Under constant traction the vehicle came to rest before it had left the bridge.
    #[error(
        "the vehicle comes to rest at t = {time:.4} s with its front axle at x = {position:.3} m: at this speed \
         constant traction does not carry it up the slope of bridge and road; raise speed or use drive = \
         \"constant-speed\""
    )]
    Stopped {
        /// Time [s].
        time: f64,
        /// Position of the front axle [m].
        position: f64,
    },
    /// A state that is not a finite number.
    #[error("the response stops being finite at t = {time:.6} s (front axle at x = {position:.4} m); shorten the step")]
    NotFinite {
        /// Number of the step.
        step: usize,
        /// Time [s].
        time: f64,
        /// Position of the front axle [m].
        position: f64,
    },
    /// The system starts no thread.
    #[error("no thread can be started: {0}")]
    Threads(String),
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
}

impl Error {
    /// The number of the step that failed, if one did.
    pub fn step(&self) -> Option<usize> {
        match self {
            Error::NoConvergence { step, .. } | Error::NotFinite { step, .. } => Some(*step),
            _ => None,
        }
    }

    /// An [`Error::Input`] from its parts.
    pub fn input(key: impl Into<String>, value: impl ToString, allowed: impl Into<String>) -> Self {
        Error::Input { key: key.into(), value: tidy(&value.to_string()), allowed: tidy(&allowed.into()) }
    }

    /// The same with advice at its end.
    pub fn advising(self, advice: &str) -> Self {
        match self {
            Error::Input { key, value, allowed } => Error::Input { key, value, allowed: allowed + advice },
            other => other,
        }
    }

    /// An [`Error::Memory`] from its parts.
    pub fn memory(key: impl Into<String>, value: impl ToString, allowed: impl Into<String>) -> Self {
        Error::Memory { key: key.into(), value: tidy(&value.to_string()), allowed: allowed.into() }
    }

    /// The same about one of several: `place` goes in front of the name of what is refused.
    pub fn within(self, place: &str) -> Self {
        match self {
            Error::Input { key, value, allowed } => Error::Input { key: format!("{place}{key}"), value, allowed },
            other => other,
        }
    }

    /// Whether the caller's input is at fault (otherwise the numerics are, or the user interrupted).
    pub fn is_input(&self) -> bool {
        self.refused().is_some()
    }

    /// Name and value of what is refused, and what is allowed, if the caller's input is at fault.
    pub fn refused(&self) -> Option<[String; 3]> {
        let (key, value, allowed) = match self {
            Error::Input { key, value, allowed } | Error::Memory { key, value, allowed } => {
                (key.clone(), value.clone(), allowed.clone())
            }
            Error::Unstable { supports, motion } => {
                let advice = "give at least one clamped end or two supports at different positions";
                let allowed = format!("leave the bridge unstable, free to {motion}; {advice}");
                ("supports".to_string(), format!("[{supports}]"), allowed)
            }
            Error::Mechanism { hinge, at } => {
                let others = if *hinge > 0 { " now that the hinges to its left do" } else { "" };
                let allowed = format!(
                    "makes a mechanism of the bridge, which can turn there without resistance{others}; take it out or \
                     add a support"
                );
                (format!("hinges[{hinge}]"), format!("{at} m"), allowed)
            }
            Error::StepTooLong { step, beta, limit, frequency } => {
                let allowed = format!(
                    "Newmark with beta = {beta} is stable only for steps up to {limit:.6e} s here (fastest coupled \
                     frequency about {frequency:.3} Hz); shorten the step or use beta = 0.25"
                );
                ("step".to_string(), format!("{step} s"), allowed)
            }
            _ => return None,
        };
        Some([key, value, allowed])
    }

    /// What is refused, in one sentence.
    fn in_words(&self) -> String {
        self.refused().map_or_else(String::new, |[key, value, allowed]| format!("{key} = {value}: {allowed}"))
    }
}

/// The text with numbers that bear the rounding of their last digits rounded to twelve: 5.1, not 5.100000000000001; and those
/// of hundreds of digits with a power of ten.
fn tidy(text: &str) -> String {
    const TOO_MANY: usize = 15;
    const TOO_LONG: usize = 24;
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let mut tidied = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let number = &rest[start..];
        let number = &number[..number.find(|c| !is_part(c)).unwrap_or(number.len())];
        tidied.push_str(&rest[..start]);
        let digits = number.trim_start_matches(['0', '.']).len();
        match number.parse::<f64>().and_then(|value| format!("{value:.11e}").parse::<f64>()) {
            Ok(_) if number.len() > TOO_LONG => tidied.push_str(&scientific(number)),
            Ok(value) if number.contains('.') && digits > TOO_MANY => tidied.push_str(&value.to_string()),
            _ => tidied.push_str(number),
        }
        rest = &rest[start + number.len()..];
    }
    tidied + rest
}

/// A number with a power of ten, as it was written where it is none.
fn scientific(number: &str) -> String {
    number.parse::<f64>().map_or_else(|_| number.to_string(), |value| format!("{value:e}"))
}

/// `value`, if it is finite.
pub fn finite(key: impl Into<String>, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::input(key, value, "must be a finite number")) }
}

/// `value`, if it is finite and greater than zero.
pub fn positive(key: impl Into<String>, value: f64) -> Result<f64, Error> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Error::input(key, value, "must be finite and greater than 0"))
    }
}

/// `value`, if it is finite and not negative.
pub fn not_negative(key: impl Into<String>, value: f64) -> Result<f64, Error> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::input(key, value, "must be finite and 0 or more"))
    }
}

#[cfg(test)]
mod tests {
    use super::tidy;

    #[test]
    fn numbers_lose_their_rounding_only() {
        let text = "5.100000000000001 m, x[12] = -0.30000000000000004 m.";
        assert_eq!(tidy(text), "5.1 m, x[12] = -0.3 m.");
        assert_eq!(tidy(&format!("{} m", 1e300)), "1e300 m");
        assert_eq!(tidy(&format!("{} m", 5e-324)), "5e-324 m");
        for same in ["", "1.25", "1.0000000000001 m", "100000000000000000000", "to 0.1 (0.000001 µm) 3", "1e-300."] {
            assert_eq!(tidy(same), same);
        }
    }
}

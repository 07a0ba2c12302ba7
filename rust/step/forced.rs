//! Constant loads at constant speed: nothing couples them to the bridge, and its modes follow exactly.

use super::driving::ModalForces;
use super::oscillator::Oscillator;
use super::vibration::Vibration;
use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// The modes of a bridge under forces that are known beforehand, whatever the step.
#[derive(Debug, Clone)]
pub struct Forced<L> {
    modes: Vec<Oscillator<L>>,
}

impl<L: Lane> Forced<L> {
    /// Modes of circular frequencies `omega` [rad/s], each with its own rate of damping 2ζω [1/s], in steps of h [s].
    pub fn new(omega: &[L], rates: &[L], h: L) -> Self {
        Forced { modes: omega.iter().zip(rates).map(|(&omega, &rate)| Oscillator::new(omega, rate, h)).collect() }
    }

    /// The bridge by itself.
    pub fn vibration(&self) -> Vibration<L> {
        Vibration::exact(self.modes.clone())
    }

    /// At rest, and loaded at once.
    pub fn start<N: Copy>(&self, driving: &ModalForces<N>, lift: impl Fn(N) -> L) -> Vec<Coordinate<L>> {
        let each = self.modes.iter().zip(&driving.end);
        each.map(|(own, &force)| own.accelerated(Coordinate::rest(), lift(force))).collect()
    }

    /// The modes a step later, whose forces `lift` brings into the lanes.
    #[inline(always)]
    pub fn advance<N: Copy>(&self, modes: &mut [Coordinate<L>], driving: &ModalForces<N>, lift: impl Fn(N) -> L) {
        let count = self.modes.len();
        for (m, (mode, own)) in modes.iter_mut().zip(&self.modes).enumerate() {
            let mut next = own.advance(*mode, driving.forces[m].map(&lift));
            for (onset, jumps) in driving.onsets.iter().zip(driving.jumps.chunks_exact(count)) {
                own.add(&mut next, *onset, jumps[m].map(&lift));
            }
            *mode = own.accelerated(next, lift(driving.end[m]));
        }
    }
}

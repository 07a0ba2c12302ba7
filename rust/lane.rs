//! What the time step computes with: one `f64`, or several samples side by side.
//!
//! [`dispatch`] chooses the instruction set and with it how many; what any processor can do is [`wide`]. Vehicles,
//! bridges and contacts of single samples become those of all lanes by [`gather`].

pub(crate) mod bits;
pub(crate) mod dispatch;
pub(crate) mod gather;
mod pack;
pub(crate) mod wide;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use bits::Bits;
pub use dispatch::{InLanes, Isa, with};
pub use wide::{Wide, WideBits};

use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};

/// One number per sample. All operations are exact IEEE ones, element by element, so that a sample's bits depend
/// neither on its neighbours nor on the width.
pub trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// One truth value per sample.
    type Mask: Copy + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// The bits of one number per sample.
    type Bits: Bits;

    /// Number of samples.
    const SAMPLES: usize;

    /// Samples whose extremes are looked for together: eight, or one. The more there are, the more often there is one of
    /// them for which all must be looked at; the fewer, the more work that is the same for all is done over and over.
    type Few: Lane;

    /// How many times so many there are.
    const FEWS: usize = Self::SAMPLES / Self::Few::SAMPLES;

    /// The numbers of some of them.
    fn few(&self, number: usize) -> Self::Few;

    /// Puts the numbers of some of them in their place.
    fn put_few(&mut self, number: usize, numbers: Self::Few);

    /// The same number for every sample.
    fn splat(value: f64) -> Self;

    /// One number for each sample.
    fn from_fn(value: impl Fn(usize) -> f64) -> Self;

    /// The number of one sample.
    fn get(&self, sample: usize) -> f64;

    /// self < other.
    fn less(self, other: Self) -> Self::Mask;

    /// `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Whether the mask holds for every sample.
    fn all(mask: Self::Mask) -> bool;

    /// Whether the mask holds for any sample.
    fn any(mask: Self::Mask) -> bool;

    /// The mask that holds for no sample.
    #[inline(always)]
    fn never() -> Self::Mask {
        Self::splat(0.0).less(Self::splat(0.0))
    }

    /// Larger of two by compare-and-select: `other` unless self is greater.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// Smaller of two by compare-and-select: `other` unless self is less.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// e to the power of self, the same bits on every machine.
    fn exp(self) -> Self;

    /// The bits of the numbers.
    fn to_bits(self) -> Self::Bits;

    /// The numbers of these bits.
    fn from_bits(bits: Self::Bits) -> Self;

    /// Magnitude: without the sign bit.
    fn magnitude(self) -> Self;
}

/// Numbers that are one register, or none.
macro_rules! whole {
    () => {
        type Few = Self;

        #[inline(always)]
        fn few(&self, _number: usize) -> Self {
            *self
        }

        #[inline(always)]
        fn put_few(&mut self, _number: usize, numbers: Self) {
            *self = numbers;
        }
    };
}
pub(crate) use whole;

/// A loop that is compiled once for each instruction set.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Goes through it; must be inlined, with all that it calls, or the instruction set is lost.
    fn run(self) -> Self::Output;
}

/// Lanes that work is done in.
pub trait Lanes: Lane {
    /// Does the work with the instruction set that these lanes are made for, which the processor must have.
    fn dispatch<W: Work>(work: W) -> W::Output;
}

impl Lane for f64 {
    type Mask = bool;

    type Bits = u64;

    const SAMPLES: usize = 1;

    whole!();

    fn splat(value: f64) -> Self {
        value
    }

    fn from_fn(value: impl Fn(usize) -> f64) -> Self {
        value(0)
    }

    fn get(&self, _sample: usize) -> f64 {
        *self
    }

    fn less(self, other: Self) -> bool {
        self < other
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn all(mask: bool) -> bool {
        mask
    }

    fn any(mask: bool) -> bool {
        mask
    }

    fn magnitude(self) -> Self {
        self.abs()
    }

    fn exp(self) -> Self {
        // Not the standard library's, which is that of the platform.
        libm::exp(self)
    }

    #[inline(always)]
    fn to_bits(self) -> u64 {
        f64::to_bits(self)
    }

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        f64::from_bits(bits)
    }
}

impl Lanes for f64 {
    fn dispatch<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

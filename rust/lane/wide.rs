//! Several samples side by side, in plain arrays that the compiler keeps in vector registers.

// Loops over the samples by their numbers, and no shorthand: so the compiler turns them into vectors.
#![allow(clippy::assign_op_pattern, clippy::needless_range_loop)]

use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};

use super::bits::Bits;
use super::{Lane, Lanes, Work, whole};

/// One number for each of N samples.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Wide<const N: usize>([f64; N]);

/// Which of N samples, as all or no bits of each: so that choosing is the same three operations for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub struct Samples<const N: usize>([u64; N]);

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const N: usize> $trait for Wide<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] $op other.0[i];
                }
                self
            }
        }
    };
}

operator!(Add, add, +=);
operator!(Sub, sub, -=);
operator!(Mul, mul, *=);
operator!(Div, div, /=);

impl<const N: usize> From<[f64; N]> for Wide<N> {
    #[inline(always)]
    fn from(numbers: [f64; N]) -> Self {
        Wide(numbers)
    }
}

impl<const N: usize> Neg for Wide<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(mut self) -> Self {
        for i in 0..N {
            self.0[i] = -self.0[i];
        }
        self
    }
}

impl<const N: usize> BitOr for Samples<N> {
    type Output = Self;

    #[inline(always)]
    fn bitor(mut self, other: Self) -> Self {
        for i in 0..N {
            self.0[i] |= other.0[i];
        }
        self
    }
}

impl<const N: usize> Not for Samples<N> {
    type Output = Self;

    #[inline(always)]
    fn not(mut self) -> Self {
        for i in 0..N {
            self.0[i] = !self.0[i];
        }
        self
    }
}

impl<const N: usize> Lane for Wide<N> {
    type Mask = Samples<N>;

    type Bits = WideBits<N>;

    const SAMPLES: usize = N;

    whole!();

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Wide([value; N])
    }

    #[inline(always)]
    fn from_fn(value: impl Fn(usize) -> f64) -> Self {
        let mut wide = Self::splat(0.0);
        for i in 0..N {
            wide.0[i] = value(i);
        }
        wide
    }

    #[inline(always)]
    fn get(&self, sample: usize) -> f64 {
        self.0[sample]
    }

    #[inline(always)]
    fn less(self, other: Self) -> Samples<N> {
        let mut mask = Samples([0; N]);
        for i in 0..N {
            mask.0[i] = if self.0[i] < other.0[i] { u64::MAX } else { 0 };
        }
        mask
    }

    #[inline(always)]
    fn select(mask: Samples<N>, yes: Self, no: Self) -> Self {
        let mut out = no;
        for i in 0..N {
            let m = mask.0[i];
            out.0[i] = f64::from_bits((yes.0[i].to_bits() & m) | (no.0[i].to_bits() & !m));
        }
        out
    }

    #[inline(always)]
    fn all(mask: Samples<N>) -> bool {
        let mut all = u64::MAX;
        for i in 0..N {
            all &= mask.0[i];
        }
        all == u64::MAX
    }

    #[inline(always)]
    fn any(mask: Samples<N>) -> bool {
        let mut any = 0;
        for i in 0..N {
            any |= mask.0[i];
        }
        any != 0
    }

    // As one choice for each sample, which is one instruction for several of them.
    #[inline(always)]
    fn larger(mut self, other: Self) -> Self {
        for i in 0..N {
            self.0[i] = if other.0[i] < self.0[i] { self.0[i] } else { other.0[i] };
        }
        self
    }

    #[inline(always)]
    fn smaller(mut self, other: Self) -> Self {
        for i in 0..N {
            self.0[i] = if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] };
        }
        self
    }

    #[inline(always)]
    fn magnitude(mut self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i].abs();
        }
        self
    }

    #[inline(always)]
    fn exp(mut self) -> Self {
        for i in 0..N {
            self.0[i] = libm::exp(self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn to_bits(self) -> WideBits<N> {
        WideBits(self.0.map(f64::to_bits))
    }

    #[inline(always)]
    fn from_bits(bits: WideBits<N>) -> Self {
        Wide(bits.0.map(f64::from_bits))
    }
}

/// One number of 64 bits for each of N samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub struct WideBits<const N: usize>([u64; N]);

/// What is done to one number, done to each.
macro_rules! each {
    ($($method:ident),*) => {
        $(
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] = self.0[i].$method(other.0[i]);
                }
                self
            }
        )*
    };
}

impl<const N: usize> Bits for WideBits<N> {
    const SAMPLES: usize = N;

    each!(plus, and, or, xor, times);

    #[inline(always)]
    fn splat(value: u64) -> Self {
        WideBits([value; N])
    }

    #[inline(always)]
    fn from_fn(value: impl Fn(usize) -> u64) -> Self {
        let mut wide = Self::splat(0);
        for i in 0..N {
            wide.0[i] = value(i);
        }
        wide
    }

    #[inline(always)]
    fn get(&self, sample: usize) -> u64 {
        self.0[sample]
    }

    #[inline(always)]
    fn up(mut self, bits: u32) -> Self {
        for i in 0..N {
            self.0[i] <<= bits;
        }
        self
    }

    #[inline(always)]
    fn down(mut self, bits: u32) -> Self {
        for i in 0..N {
            self.0[i] >>= bits;
        }
        self
    }

    #[inline(always)]
    fn spread(mut self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i].spread();
        }
        self
    }
}

impl<const N: usize> Lanes for Wide<N> {
    fn dispatch<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

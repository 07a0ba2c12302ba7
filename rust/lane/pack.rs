//! Several registers as one: what is done to the samples of one of them, done to each.

// Loops over the registers by their numbers, of a length that the compiler knows: it unrolls them.
#![allow(clippy::needless_range_loop)]

use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};

use super::Lane;
use super::bits::Bits;

/// The numbers of R registers.
#[derive(Debug, Clone, Copy)]
pub struct Pack<L, const R: usize>(pub(super) [L; R]);

/// A register of which R are a pack.
pub trait Together<const R: usize>: Lane {
    /// See [`Lane::Few`].
    type Some: Lane;

    /// See [`Lane::few`].
    fn some(registers: &[Self; R], number: usize) -> Self::Some;

    /// See [`Lane::put_few`].
    fn put_some(registers: &mut [Self; R], number: usize, numbers: Self::Some);
}

/// Which of their samples.
#[derive(Debug, Clone, Copy)]
pub struct PackMask<M, const R: usize>([M; R]);

/// Their bits.
#[derive(Debug, Clone, Copy)]
pub struct PackBits<B, const R: usize>([B; R]);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<L: Lane, const R: usize> $trait for Pack<L, R> {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for r in 0..R {
                    self.0[r] = self.0[r].$method(other.0[r]);
                }
                self
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

/// What is done to one register, done to each; beside another one or alone.
macro_rules! each {
    ($($method:ident),*) => {
        $(
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for r in 0..R {
                    self.0[r] = self.0[r].$method(other.0[r]);
                }
                self
            }
        )*
    };
    (alone $($method:ident),*) => {
        $(
            #[inline(always)]
            fn $method(mut self) -> Self {
                for r in 0..R {
                    self.0[r] = self.0[r].$method();
                }
                self
            }
        )*
    };
}

impl<L: Lane, const R: usize> Neg for Pack<L, R> {
    type Output = Self;

    each!(alone neg);
}

impl<M: Copy + BitOr<Output = M>, const R: usize> BitOr for PackMask<M, R> {
    type Output = Self;

    each!(bitor);
}

impl<M: Copy + Not<Output = M>, const R: usize> Not for PackMask<M, R> {
    type Output = Self;

    each!(alone not);
}

impl<L: Together<R>, const R: usize> Lane for Pack<L, R> {
    type Mask = PackMask<L::Mask, R>;

    type Bits = PackBits<L::Bits, R>;

    const SAMPLES: usize = L::SAMPLES * R;

    type Few = L::Some;

    #[inline(always)]
    fn few(&self, number: usize) -> L::Some {
        L::some(&self.0, number)
    }

    #[inline(always)]
    fn put_few(&mut self, number: usize, numbers: L::Some) {
        L::put_some(&mut self.0, number, numbers);
    }

    each!(larger, smaller);
    each!(alone exp, magnitude);

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Pack([L::splat(value); R])
    }

    #[inline(always)]
    fn from_fn(value: impl Fn(usize) -> f64) -> Self {
        let mut pack = Self::splat(0.0);
        for r in 0..R {
            pack.0[r] = L::from_fn(|i| value(r * L::SAMPLES + i));
        }
        pack
    }

    #[inline(always)]
    fn get(&self, sample: usize) -> f64 {
        self.0[sample / L::SAMPLES].get(sample % L::SAMPLES)
    }

    #[inline(always)]
    fn less(self, other: Self) -> Self::Mask {
        let mut mask = Self::never();
        for r in 0..R {
            mask.0[r] = self.0[r].less(other.0[r]);
        }
        mask
    }

    #[inline(always)]
    fn never() -> Self::Mask {
        PackMask([L::never(); R])
    }

    #[inline(always)]
    fn select(mask: Self::Mask, mut yes: Self, no: Self) -> Self {
        for r in 0..R {
            yes.0[r] = L::select(mask.0[r], yes.0[r], no.0[r]);
        }
        yes
    }

    #[inline(always)]
    fn all(mask: Self::Mask) -> bool {
        !Self::any(!mask)
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        let mut any = mask.0[0];
        for r in 1..R {
            any = any | mask.0[r];
        }
        L::any(any)
    }

    #[inline(always)]
    fn to_bits(self) -> Self::Bits {
        PackBits(self.0.map(L::to_bits))
    }

    #[inline(always)]
    fn from_bits(bits: Self::Bits) -> Self {
        Pack(bits.0.map(L::from_bits))
    }
}

impl<B: Bits, const R: usize> Bits for PackBits<B, R> {
    const SAMPLES: usize = B::SAMPLES * R;

    each!(plus, and, or, xor, times);
    each!(alone spread);

    #[inline(always)]
    fn splat(value: u64) -> Self {
        PackBits([B::splat(value); R])
    }

    #[inline(always)]
    fn from_fn(value: impl Fn(usize) -> u64) -> Self {
        let mut pack = Self::splat(0);
        for r in 0..R {
            pack.0[r] = B::from_fn(|i| value(r * B::SAMPLES + i));
        }
        pack
    }

    #[inline(always)]
    fn get(&self, sample: usize) -> u64 {
        self.0[sample / B::SAMPLES].get(sample % B::SAMPLES)
    }

    #[inline(always)]
    fn up(mut self, bits: u32) -> Self {
        for r in 0..R {
            self.0[r] = self.0[r].up(bits);
        }
        self
    }

    #[inline(always)]
    fn down(mut self, bits: u32) -> Self {
        for r in 0..R {
            self.0[r] = self.0[r].down(bits);
        }
        self
    }
}

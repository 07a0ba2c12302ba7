//! One vector register of an x86-64 processor: four numbers of AVX2, or eight of AVX-512.
//!
//! Safe code cannot name these lanes: it gets them from [`with`], which looks first whether the processor has them. The
//! compiler keeps them in registers only in work done under [`Lanes::dispatch`].
//!
//! [`with`]: super::dispatch::with

// Only here: the processor's instructions are out of the reach of safe code, unless it is compiled for them.
#![allow(unsafe_code)]
#![warn(clippy::undocumented_unsafe_blocks)]

use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};

use pulp::NullaryFnOnce;

use super::bits::Bits;
use super::pack::{Pack, Together};
use super::{Lane, Lanes, Work, whole};

/// Eight numbers in two registers of AVX2.
pub type Avx2 = Pack<Four, 2>;

/// Sixteen numbers in two registers of AVX-512: what is done to one of them hides how long the other takes.
pub type Avx512 = Pack<Eight, 2>;

/// An instruction that takes and returns numbers.
macro_rules! on {
    ($instruction:expr) => {
        // SAFETY: these instructions touch no memory, and run only where `with` found that the processor has them: no other
        // way leads to the lanes of this file, which is private.
        unsafe { $instruction }
    };
}

/// The same bits as another type.
macro_rules! as_bits {
    ($value:expr, $from:ty => $to:ty) => {
        // SAFETY: a register and an array of its numbers have the same size, all bits are valid in both, and where there are
        // references to them the register is aligned more strictly.
        unsafe { transmute::<$from, $to>($value) }
    };
}

/// One kind of register: its types, the names of its instructions, and how its masks are kept.
macro_rules! register {
    (
        $(#[$doc:meta])* $lanes:ident, $mask:ident, $bits:ident: $samples:literal in $vector:ty, $masks:ty, $words:ty;
        $add:ident $sub:ident $mul:ident $div:ident $max:ident $min:ident $splat:ident $cast:ident $back:ident;
        $plus:ident $and:ident $or:ident $xor:ident $times:ident $up:ident $down:ident $fill:ident;
        $less:expr, $select:expr, $either:expr, $not:expr, $any:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $lanes($vector);

        /// Which of the samples.
        #[derive(Debug, Clone, Copy)]
        pub struct $mask($masks);

        /// One number of 64 bits for each of the samples.
        #[derive(Debug, Clone, Copy)]
        pub struct $bits($words);

        register!(operator $lanes Add add $add);
        register!(operator $lanes Sub sub $sub);
        register!(operator $lanes Mul mul $mul);
        register!(operator $lanes Div div $div);

        impl Neg for $lanes {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                $lanes(on!($back($xor($cast(self.0), $fill(i64::MIN)))))
            }
        }

        impl BitOr for $mask {
            type Output = Self;

            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                $mask($either(self.0, other.0))
            }
        }

        impl Not for $mask {
            type Output = Self;

            #[inline(always)]
            fn not(self) -> Self {
                $mask($not(self.0))
            }
        }

        impl Lane for $lanes {
            type Mask = $mask;

            type Bits = $bits;

            const SAMPLES: usize = $samples;

            whole!();

            #[inline(always)]
            fn splat(value: f64) -> Self {
                $lanes(on!($splat(value)))
            }

            #[inline(always)]
            fn from_fn(value: impl Fn(usize) -> f64) -> Self {
                let mut numbers = [0.0; $samples];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = value(i);
                }
                $lanes(as_bits!(numbers, [f64; $samples] => $vector))
            }

            #[inline(always)]
            fn get(&self, sample: usize) -> f64 {
                as_bits!(&self.0, &$vector => &[f64; $samples])[sample]
            }

            #[inline(always)]
            fn less(self, other: Self) -> $mask {
                $mask($less(self.0, other.0))
            }

            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                $lanes($select(mask.0, yes.0, no.0))
            }

            #[inline(always)]
            fn all(mask: $mask) -> bool {
                !Self::any(!mask)
            }

            #[inline(always)]
            fn any(mask: $mask) -> bool {
                $any(mask.0)
            }

            // The instructions return the second number unless the first is the larger, or smaller.
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                $lanes(on!($max(self.0, other.0)))
            }

            #[inline(always)]
            fn smaller(self, other: Self) -> Self {
                $lanes(on!($min(self.0, other.0)))
            }

            #[inline(always)]
            fn magnitude(self) -> Self {
                $lanes(on!($back($and($cast(self.0), $fill(i64::MAX)))))
            }

            #[inline(always)]
            fn exp(self) -> Self {
                Self::from_fn(|i| libm::exp(self.get(i)))
            }

            #[inline(always)]
            fn to_bits(self) -> $bits {
                $bits(on!($cast(self.0)))
            }

            #[inline(always)]
            fn from_bits(bits: $bits) -> Self {
                $lanes(on!($back(bits.0)))
            }
        }

        impl Bits for $bits {
            const SAMPLES: usize = $samples;

            register!(each plus $plus, and $and, or $or, xor $xor, times $times);

            #[inline(always)]
            fn splat(value: u64) -> Self {
                $bits(on!($fill(value as i64)))
            }

            #[inline(always)]
            fn from_fn(value: impl Fn(usize) -> u64) -> Self {
                let mut numbers = [0; $samples];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = value(i);
                }
                $bits(as_bits!(numbers, [u64; $samples] => $words))
            }

            #[inline(always)]
            fn get(&self, sample: usize) -> u64 {
                as_bits!(&self.0, &$words => &[u64; $samples])[sample]
            }

            #[inline(always)]
            fn up(self, bits: u32) -> Self {
                $bits(on!($up(self.0, $fill(i64::from(bits)))))
            }

            #[inline(always)]
            fn down(self, bits: u32) -> Self {
                $bits(on!($down(self.0, $fill(i64::from(bits)))))
            }

            // Zero less the highest bit, moved to the lowest place.
            #[inline(always)]
            fn spread(self) -> Self {
                $bits(on!($plus($xor(self.down(63).0, $fill(-1)), $fill(1))))
            }
        }
    };
    (operator $lanes:ident $trait:ident $method:ident $instruction:ident) => {
        impl $trait for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $lanes(on!($instruction(self.0, other.0)))
            }
        }
    };
    (each $($method:ident $instruction:ident),*) => {
        $(
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(on!($instruction(self.0, other.0)))
            }
        )*
    };
}

register! {
    /// Four numbers in a register of AVX2.
    Four, FourMask, FourBits: 4 in __m256d, __m256d, __m256i;
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd _mm256_max_pd _mm256_min_pd _mm256_set1_pd
    _mm256_castpd_si256 _mm256_castsi256_pd;
    _mm256_add_epi64 _mm256_and_si256 _mm256_or_si256 _mm256_xor_si256 _mm256_mul_epu32 _mm256_sllv_epi64
    _mm256_srlv_epi64 _mm256_set1_epi64x;
    |a, b| on!(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)),
    |mask, yes, no| on!(_mm256_blendv_pd(no, yes, mask)),
    |a, b| on!(_mm256_or_pd(a, b)),
    |a| on!(_mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))),
    |a| on!(_mm256_movemask_pd(a)) != 0
}

register! {
    /// Eight numbers in a register of AVX-512.
    Eight, EightMask, EightBits: 8 in __m512d, __mmask8, __m512i;
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd _mm512_max_pd _mm512_min_pd _mm512_set1_pd
    _mm512_castpd_si512 _mm512_castsi512_pd;
    _mm512_add_epi64 _mm512_and_si512 _mm512_or_si512 _mm512_xor_si512 _mm512_mul_epu32 _mm512_sllv_epi64
    _mm512_srlv_epi64 _mm512_set1_epi64;
    |a, b| on!(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b)),
    |mask, yes, no| on!(_mm512_mask_blend_pd(mask, no, yes)),
    |a: __mmask8, b: __mmask8| a | b,
    |a: __mmask8| !a,
    |a: __mmask8| a != 0
}

impl<const R: usize> Together<R> for Four {
    type Some = Pack<Four, R>;

    #[inline(always)]
    fn some(registers: &[Self; R], _number: usize) -> Self::Some {
        Pack(*registers)
    }

    #[inline(always)]
    fn put_some(registers: &mut [Self; R], _number: usize, numbers: Self::Some) {
        *registers = numbers.0;
    }
}

impl<const R: usize> Together<R> for Eight {
    type Some = Eight;

    #[inline(always)]
    fn some(registers: &[Self; R], number: usize) -> Self {
        registers[number]
    }

    #[inline(always)]
    fn put_some(registers: &mut [Self; R], number: usize, numbers: Self) {
        registers[number] = numbers;
    }
}

/// Work as pulp wants it.
struct Compiled<W>(W);

impl<W: Work> NullaryFnOnce for Compiled<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run()
    }
}

/// Compiles work for an instruction set, whose token says that the processor has it.
macro_rules! dispatch {
    ($lanes:ty, $token:ty) => {
        impl Lanes for $lanes {
            fn dispatch<W: Work>(work: W) -> W::Output {
                // SAFETY: as for the instructions themselves.
                unsafe { <$token>::new_unchecked() }.vectorize(Compiled(work))
            }
        }
    };
}

dispatch!(Avx2, pulp::x86::V3);
dispatch!(Avx512, pulp::x86::V4);

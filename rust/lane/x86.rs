//! Eight samples side by side in the vector registers of x86-64 processors: two of AVX2, or one of AVX-512.
//!
//! They may be used only on a processor that has the instructions, which [`with`] sees to; and the compiler keeps them in
//! registers only in work done under [`Lanes::dispatch`].
//!
//! [`with`]: crate::ensemble::simd::with
//! [`Lanes::dispatch`]: crate::ensemble::simd::Lanes::dispatch

// Only here: the processor's instructions are out of the reach of safe code, unless it is compiled for them. They take
// and return numbers, and touch no memory; registers and arrays of the same size are the same bits.
#![allow(unsafe_code)]

use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, BitOr, Div, Mul, Neg, Not, Sub};

use super::Lane;
use super::bits::Bits;

/// Samples side by side.
const N: usize = 8;

/// One kind of lanes, of so many registers each: the names of the instructions, and how masks are kept.
macro_rules! lanes {
    (
        $(#[$doc:meta])* $lanes:ident, $mask:ident, $bits:ident: $registers:literal of $vector:ty, $masks:ty, $words:ty;
        $add:ident $sub:ident $mul:ident $div:ident $max:ident $min:ident $splat:ident $cast:ident $back:ident;
        $plus:ident $and:ident $or:ident $xor:ident $times:ident $up:ident $down:ident $fill:ident;
        $less:expr, $select:expr, $full:expr, $either:expr, $not:expr, $negative:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $lanes([$vector; $registers]);

        /// Which of the samples.
        #[derive(Debug, Clone, Copy)]
        pub struct $mask([$masks; $registers]);

        /// One number of 64 bits for each of the samples.
        #[derive(Debug, Clone, Copy)]
        pub struct $bits([$words; $registers]);

        lanes!(operator $lanes Add add $add $registers);
        lanes!(operator $lanes Sub sub $sub $registers);
        lanes!(operator $lanes Mul mul $mul $registers);
        lanes!(operator $lanes Div div $div $registers);

        impl $lanes {
            #[inline(always)]
            fn sign() -> $words {
                unsafe { $fill(i64::MIN) }
            }
        }

        impl Neg for $lanes {
            type Output = Self;

            #[inline(always)]
            fn neg(mut self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $back($xor($cast(self.0[i]), Self::sign())) };
                }
                self
            }
        }

        impl BitOr for $mask {
            type Output = Self;

            #[inline(always)]
            fn bitor(mut self, other: Self) -> Self {
                for i in 0..$registers {
                    self.0[i] = $either(self.0[i], other.0[i]);
                }
                self
            }
        }

        impl Not for $mask {
            type Output = Self;

            #[inline(always)]
            fn not(mut self) -> Self {
                for i in 0..$registers {
                    self.0[i] = $not(self.0[i]);
                }
                self
            }
        }

        impl Lane for $lanes {
            type Mask = $mask;

            type Bits = $bits;

            const SAMPLES: usize = N;

            #[inline(always)]
            fn splat(value: f64) -> Self {
                $lanes([unsafe { $splat(value) }; $registers])
            }

            #[inline(always)]
            fn from_fn(value: impl Fn(usize) -> f64) -> Self {
                let mut numbers = [0.0; N];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = value(i);
                }
                $lanes(unsafe { transmute::<[f64; N], [$vector; $registers]>(numbers) })
            }

            #[inline(always)]
            fn get(&self, sample: usize) -> f64 {
                let numbers = unsafe { transmute::<[$vector; $registers], [f64; N]>(self.0) };
                numbers[sample]
            }

            #[inline(always)]
            fn less(self, other: Self) -> $mask {
                let mut mask = $mask([$full; $registers]);
                for i in 0..$registers {
                    mask.0[i] = $less(self.0[i], other.0[i]);
                }
                mask
            }

            #[inline(always)]
            fn select(mask: $mask, mut yes: Self, no: Self) -> Self {
                for i in 0..$registers {
                    yes.0[i] = $select(mask.0[i], yes.0[i], no.0[i]);
                }
                yes
            }

            #[inline(always)]
            fn all(mask: $mask) -> bool {
                !Self::any(!mask)
            }

            #[inline(always)]
            fn any(mask: $mask) -> bool {
                let mut any = mask.0[0];
                for other in mask.0.into_iter().skip(1) {
                    any = $either(any, other);
                }
                $negative(any)
            }

            // The instructions return the second number unless the first is the larger, or smaller.
            #[inline(always)]
            fn larger(mut self, other: Self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $max(self.0[i], other.0[i]) };
                }
                self
            }

            #[inline(always)]
            fn smaller(mut self, other: Self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $min(self.0[i], other.0[i]) };
                }
                self
            }

            #[inline(always)]
            fn magnitude(mut self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $back($and($cast(self.0[i]), $fill(i64::MAX))) };
                }
                self
            }

            #[inline(always)]
            fn exp(self) -> Self {
                Self::from_fn(|i| libm::exp(self.get(i)))
            }

            #[inline(always)]
            fn to_bits(self) -> $bits {
                let mut bits = $bits::splat(0);
                for i in 0..$registers {
                    bits.0[i] = unsafe { $cast(self.0[i]) };
                }
                bits
            }

            #[inline(always)]
            fn from_bits(bits: $bits) -> Self {
                let mut lanes = Self::splat(0.0);
                for i in 0..$registers {
                    lanes.0[i] = unsafe { $back(bits.0[i]) };
                }
                lanes
            }
        }

        impl Bits for $bits {
            lanes!(each $registers plus $plus, and $and, or $or, xor $xor, times $times);

            #[inline(always)]
            fn splat(value: u64) -> Self {
                $bits([unsafe { $fill(value as i64) }; $registers])
            }

            #[inline(always)]
            fn from_fn(value: impl Fn(usize) -> u64) -> Self {
                let mut numbers = [0; N];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = value(i);
                }
                $bits(unsafe { transmute::<[u64; N], [$words; $registers]>(numbers) })
            }

            #[inline(always)]
            fn get(&self, sample: usize) -> u64 {
                let numbers = unsafe { transmute::<[$words; $registers], [u64; N]>(self.0) };
                numbers[sample]
            }

            #[inline(always)]
            fn up(mut self, bits: u32) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $up(self.0[i], $fill(i64::from(bits))) };
                }
                self
            }

            #[inline(always)]
            fn down(mut self, bits: u32) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $down(self.0[i], $fill(i64::from(bits))) };
                }
                self
            }

            // Zero less the highest bit, moved to the lowest place.
            #[inline(always)]
            fn spread(mut self) -> Self {
                let highest = self.down(63);
                for i in 0..$registers {
                    self.0[i] = unsafe { $plus($xor(highest.0[i], $fill(-1)), $fill(1)) };
                }
                self
            }
        }
    };
    (operator $lanes:ident $trait:ident $method:ident $instruction:ident $registers:literal) => {
        impl $trait for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $instruction(self.0[i], other.0[i]) };
                }
                self
            }
        }
    };
    (each $registers:literal $($method:ident $instruction:ident),*) => {
        $(
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..$registers {
                    self.0[i] = unsafe { $instruction(self.0[i], other.0[i]) };
                }
                self
            }
        )*
    };
}

lanes! {
    /// Numbers in two registers of AVX2.
    Avx2, Avx2Mask, Avx2Bits: 2 of __m256d, __m256d, __m256i;
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd _mm256_max_pd _mm256_min_pd _mm256_set1_pd
    _mm256_castpd_si256 _mm256_castsi256_pd;
    _mm256_add_epi64 _mm256_and_si256 _mm256_or_si256 _mm256_xor_si256 _mm256_mul_epu32 _mm256_sllv_epi64
    _mm256_srlv_epi64 _mm256_set1_epi64x;
    |a, b| unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(a, b) },
    |mask, yes, no| unsafe { _mm256_blendv_pd(no, yes, mask) },
    unsafe { _mm256_castsi256_pd(_mm256_set1_epi64x(-1)) },
    |a, b| unsafe { _mm256_or_pd(a, b) },
    |a| unsafe { _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))) },
    |a| unsafe { _mm256_movemask_pd(a) } != 0
}

lanes! {
    /// Numbers in one register of AVX-512.
    Avx512, Avx512Mask, Avx512Bits: 1 of __m512d, __mmask8, __m512i;
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd _mm512_max_pd _mm512_min_pd _mm512_set1_pd
    _mm512_castpd_si512 _mm512_castsi512_pd;
    _mm512_add_epi64 _mm512_and_si512 _mm512_or_si512 _mm512_xor_si512 _mm512_mul_epu32 _mm512_sllv_epi64
    _mm512_srlv_epi64 _mm512_set1_epi64;
    |a, b| unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) },
    |mask, yes, no| unsafe { _mm512_mask_blend_pd(mask, no, yes) },
    0xFF,
    |a: __mmask8, b: __mmask8| a | b,
    |a: __mmask8| !a,
    |a: __mmask8| a != 0
}

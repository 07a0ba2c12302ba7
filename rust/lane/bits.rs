//! Whole numbers beside the lanes, one of 64 bits for each sample: random words, and the bits of an `f64`.

/// One number of 64 bits per sample.
pub trait Bits: Copy {
    /// The same number for every sample.
    fn splat(value: u64) -> Self;

    /// One number for each sample.
    fn from_fn(value: impl Fn(usize) -> u64) -> Self;

    /// The number of one sample.
    fn get(&self, sample: usize) -> u64;

    /// Sum modulo 2⁶⁴.
    fn plus(self, other: Self) -> Self;

    /// The bits set in both.
    fn and(self, other: Self) -> Self;

    /// The bits set in either.
    fn or(self, other: Self) -> Self;

    /// The bits set in one of them only.
    fn xor(self, other: Self) -> Self;

    /// The full product of the lower halves, 32 bits each; the upper ones are ignored.
    fn times(self, other: Self) -> Self;

    /// Moved up by so many bits.
    fn up(self, bits: u32) -> Self;

    /// Moved down by so many bits.
    fn down(self, bits: u32) -> Self;

    /// The highest bit in all places.
    fn spread(self) -> Self;
}

impl Bits for u64 {
    #[inline(always)]
    fn splat(value: u64) -> Self {
        value
    }

    #[inline(always)]
    fn from_fn(value: impl Fn(usize) -> u64) -> Self {
        value(0)
    }

    #[inline(always)]
    fn get(&self, _sample: usize) -> u64 {
        *self
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self ^ other
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        (self & 0xFFFF_FFFF) * (other & 0xFFFF_FFFF)
    }

    #[inline(always)]
    fn up(self, bits: u32) -> Self {
        self << bits
    }

    #[inline(always)]
    fn down(self, bits: u32) -> Self {
        self >> bits
    }

    #[inline(always)]
    fn spread(self) -> Self {
        ((self as i64) >> 63) as u64
    }
}

/// One number of 64 bits for each of N samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub struct WideBits<const N: usize>(pub(super) [u64; N]);

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

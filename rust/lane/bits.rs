//! Whole numbers beside the lanes, one of 64 bits for each sample: random words, and the bits of an `f64`.

/// One number of 64 bits per sample.
pub trait Bits: Copy {
    /// Number of samples.
    const SAMPLES: usize;

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
    const SAMPLES: usize = 1;

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

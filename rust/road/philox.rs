//! Random words by counter: Philox4x32-10, whose every output is a pure function of a counter and a key.
//!
//! J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC'11 (2011),
//! <https://doi.org/10.1145/2063384.2063405>. No state runs from one draw to the next, so that a sample is the same
//! whichever worker draws it, and in any order.

use crate::lane::bits::Bits;

const MULTIPLIERS: [u64; 2] = [0xD251_1F53, 0xCD9E_8D57];
/// What the key grows by from round to round: the golden ratio and √3 − 1.
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// Four random words for a counter under a key.
pub fn philox4x32(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    philox4x32_lanes(counter.map(u64::from), key).map(|word| word as u32)
}

/// The same for several samples side by side: a counter of its own for each, one key.
///
/// Words stand in the lower 32 bits. The upper ones of the counter are ignored, and those of the answer mean nothing:
/// a product is of lower halves, and its own lower half is best left where it is.
#[inline(always)]
pub fn philox4x32_lanes<B: Bits>(counter: [B; 4], key: [u32; 2]) -> [B; 4] {
    // Written out, because in a loop the compiler finds no vectors.
    let words = round(counter, key, 0);
    let words = round(words, key, 1);
    let words = round(words, key, 2);
    let words = round(words, key, 3);
    let words = round(words, key, 4);
    let words = round(words, key, 5);
    let words = round(words, key, 6);
    let words = round(words, key, 7);
    let words = round(words, key, 8);
    round(words, key, 9)
}

#[inline(always)]
fn round<B: Bits>([c0, c1, c2, c3]: [B; 4], key: [u32; 2], number: u32) -> [B; 4] {
    let [k0, k1] = [0, 1].map(|k| B::splat(u64::from(key[k].wrapping_add(number.wrapping_mul(WEYL[k])))));
    let [first, second] = [c0.times(B::splat(MULTIPLIERS[0])), c2.times(B::splat(MULTIPLIERS[1]))];
    [second.down(32).xor(c1).xor(k0), second, first.down(32).xor(c3).xor(k1), first]
}

/// Upper and lower word of a number.
#[inline(always)]
pub fn words(number: u64) -> [u32; 2] {
    [(number >> 32) as u32, number as u32]
}

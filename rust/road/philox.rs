//! Random words by counter: Philox4x32-10, whose every output is a pure function of a counter and a key.
//!
//! J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC'11 (2011),
//! <https://doi.org/10.1145/2063384.2063405>. No state runs from one draw to the next, so that a sample is the same
//! whichever worker draws it, and in any order.

const ROUNDS: u32 = 10;
const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
/// What the key grows by from round to round: the golden ratio and √3 − 1.
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// Four random words for a counter under a key.
pub fn philox4x32(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let [mut c0, mut c1, mut c2, mut c3] = counter;
    let [mut k0, mut k1] = key;
    for _ in 0..ROUNDS {
        let (high0, low0) = product(MULTIPLIERS[0], c0);
        let (high1, low1) = product(MULTIPLIERS[1], c2);
        (c0, c1, c2, c3) = (high1 ^ c1 ^ k0, low1, high0 ^ c3 ^ k1, low0);
        k0 = k0.wrapping_add(WEYL[0]);
        k1 = k1.wrapping_add(WEYL[1]);
    }
    [c0, c1, c2, c3]
}

/// Upper and lower word of a product.
fn product(a: u32, b: u32) -> (u32, u32) {
    let [high, low] = words(u64::from(a) * u64::from(b));
    (high, low)
}

/// Upper and lower word of a number.
pub fn words(number: u64) -> [u32; 2] {
    [(number >> 32) as u32, number as u32]
}

//! Inverse Fourier transform of complex numbers: radix 4, in plain products and sums.
//!
//! Written here, and not taken from a library that looks for the fastest instructions, because the bits of a road must
//! not depend on the machine. Generic over the lane, so that several samples can be transformed side by side.

use super::turn::sin_cos;
use crate::lane::Lane;

/// Real and imaginary part.
pub type Complex<L> = [L; 2];

/// The tables for one number of points.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseFft {
    /// Where each component belongs before the transform: at its number with the bits reversed.
    places: Vec<u32>,
    /// From the smallest blocks to the largest, for blocks of `len` points: e^(2πi jk/len) with j = 1, 2, 3, k < len/4.
    twiddles: Vec<[Complex<f64>; 3]>,
}

impl InverseFft {
    /// For n points, a power of two of at least 4.
    pub fn new(n: usize) -> Self {
        assert!(n >= 4 && n.is_power_of_two(), "{n} points: must be a power of two of at least 4");
        let bits = n.trailing_zeros();
        let places = (0..n as u32).map(|m| m.reverse_bits() >> (u32::BITS - bits)).collect();
        let mut twiddles = Vec::new();
        let mut len = 4 * smallest(n);
        while len <= n {
            let root = |turns: usize| {
                let (sine, cosine) = sin_cos(turns as f64 / len as f64);
                [cosine, sine]
            };
            twiddles.extend((0..len / 4).map(|k| [1, 2, 3].map(|j| root(j * k))));
            len *= 4;
        }
        InverseFft { places, twiddles }
    }

    /// Number of points n.
    pub fn points(&self) -> usize {
        self.places.len()
    }

    /// Where component m belongs.
    #[inline(always)]
    pub fn place(&self, m: usize) -> usize {
        self.places[m] as usize
    }

    /// From Z_m, each at its [`place`](Self::place), to z_j = Σ Z_m e^(2πi jm/n), j = 0..n.
    ///
    /// Four blocks become one as soon as they are ready, and thus while they are in the cache.
    #[inline(always)]
    pub fn transform<L: Lane>(&self, z: &mut [Complex<L>]) {
        let n = self.points();
        assert!(z.len() == n, "as many components as points are needed");
        let smallest = smallest(n);
        let mut ready = 0;
        while ready < n {
            let [a, b, c, d] = &mut z[ready..].as_chunks_mut().0[0];
            [*a, *b, *c, *d] = match smallest {
                4 => butterfly([*a, *b, *c, *d]),
                _ => [plus(*a, *b), minus(*a, *b), plus(*c, *d), minus(*c, *d)],
            };
            ready += 4;
            let (mut len, mut twiddles) = (4 * smallest, &self.twiddles[..]);
            while len <= n && ready % len == 0 {
                let (of_this, of_larger) = twiddles.split_at(len / 4);
                join(&mut z[ready - len..ready], of_this);
                (len, twiddles) = (4 * len, of_larger);
            }
        }
    }
}

/// Points of the blocks that the transform begins with.
fn smallest(n: usize) -> usize {
    if n.trailing_zeros().is_multiple_of(2) { 4 } else { 2 }
}

/// One transform from those of every fourth component, in the order of reversed bits: from 0, 2, 1 and 3 on.
#[inline(always)]
fn join<L: Lane>(block: &mut [Complex<L>], twiddles: &[[Complex<f64>; 3]]) {
    let (front, back) = block.split_at_mut(2 * twiddles.len());
    let (a, b) = front.split_at_mut(twiddles.len());
    let (c, d) = back.split_at_mut(twiddles.len());
    for ((((a, b), c), d), &[one, two, three]) in a.iter_mut().zip(b).zip(c).zip(d).zip(twiddles) {
        [*a, *b, *c, *d] = butterfly([*a, turned(*b, two), turned(*c, one), turned(*d, three)]);
    }
}

/// Transform of four components in the order 0, 2, 1, 3.
#[inline(always)]
fn butterfly<L: Lane>([a, b, c, d]: [Complex<L>; 4]) -> [Complex<L>; 4] {
    let (even, [even_re, even_im]) = (plus(a, b), minus(a, b));
    let (odd, [odd_re, odd_im]) = (plus(c, d), minus(c, d));
    [plus(even, odd), [even_re - odd_im, even_im + odd_re], minus(even, odd), [even_re + odd_im, even_im - odd_re]]
}

#[inline(always)]
fn plus<L: Lane>(a: Complex<L>, b: Complex<L>) -> Complex<L> {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
fn minus<L: Lane>(a: Complex<L>, b: Complex<L>) -> Complex<L> {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
fn turned<L: Lane>([re, im]: Complex<L>, [cosine, sine]: Complex<f64>) -> Complex<L> {
    let (cosine, sine) = (L::splat(cosine), L::splat(sine));
    [re * cosine - im * sine, re * sine + im * cosine]
}

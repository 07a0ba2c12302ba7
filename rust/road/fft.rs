//! Inverse Fourier transform of a real function: iterative, radix 2, in plain products and sums.
//!
//! Written here, and not taken from a library that looks for the fastest instructions, because the bits of a road must
//! not depend on the machine. Generic over the lane, so that several samples can be transformed side by side.

use super::turn::sin_cos;
use crate::lane::Lane;

/// The tables for one number of points.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseFft {
    /// (cos, sin) of 2πk/n, k < n/2.
    twiddles: Vec<(f64, f64)>,
}

impl InverseFft {
    /// For n points, a power of two of at least 4.
    pub fn new(n: usize) -> Self {
        assert!(n >= 4 && n.is_power_of_two(), "{n} points: must be a power of two of at least 4");
        let twiddle = |k: usize| {
            let (sine, cosine) = sin_cos(k as f64 / n as f64);
            (cosine, sine)
        };
        InverseFft { twiddles: (0..n / 2).map(twiddle).collect() }
    }

    /// Number of points n.
    pub fn points(&self) -> usize {
        2 * self.twiddles.len()
    }

    /// From X_m, m = 0..=n/2, to x_j = Σ X_m e^(2πi jm/n) over all m from −n/2+1 to n/2, where X_−m is conjugate to X_m.
    ///
    /// Takes real and imaginary parts, n/2 + 1 each, and leaves the points with even j in the first n/2 of the real and
    /// those with odd j in the first n/2 of the imaginary parts. What stands in the imaginary parts of X_0 and X_n/2 is
    /// ignored.
    #[inline(always)]
    pub fn real<L: Lane>(&self, re: &mut [L], im: &mut [L]) {
        let half = self.twiddles.len();
        assert!(re.len() == half + 1 && im.len() == half + 1, "n/2 + 1 components are needed");
        self.fold(re, im);
        self.complex(&mut re[..half], &mut im[..half]);
    }

    /// Even and odd points are two real transforms of half the length, and thus one complex one: Z = E + iO with
    /// E_m = X_m + X_(m+n/2) and O_m = (X_m − X_(m+n/2)) e^(2πi m/n).
    #[inline(always)]
    fn fold<L: Lane>(&self, re: &mut [L], im: &mut [L]) {
        let half = self.twiddles.len();
        (re[0], im[0]) = (re[0] + re[half], re[0] - re[half]);
        for m in 1..=half / 2 {
            let (cosine, sine) = self.twiddles[m];
            let (cosine, sine) = (L::splat(cosine), L::splat(sine));
            let (a_re, a_im) = (re[m], im[m]);
            let (b_re, b_im) = (re[half - m], -im[half - m]);
            let (s_re, s_im) = (a_re + b_re, a_im + b_im);
            let (d_re, d_im) = (a_re - b_re, a_im - b_im);
            let (o_re, o_im) = (d_re * cosine - d_im * sine, d_re * sine + d_im * cosine);
            (re[m], im[m]) = (s_re - o_im, s_im + o_re);
            // E and O of the mirrored component are conjugate to these.
            (re[half - m], im[half - m]) = (s_re + o_im, o_re - s_im);
        }
    }

    /// In place: decimation in time after reversing the bits of the index.
    #[inline(always)]
    fn complex<L: Lane>(&self, re: &mut [L], im: &mut [L]) {
        let n = re.len();
        let shift = usize::BITS - n.trailing_zeros();
        for i in 0..n {
            let j = i.reverse_bits() >> shift;
            if i < j {
                re.swap(i, j);
                im.swap(i, j);
            }
        }
        let mut half = 1;
        while half < n {
            // The tables are for twice as many points.
            let stride = n / half;
            for (re, im) in re.chunks_exact_mut(2 * half).zip(im.chunks_exact_mut(2 * half)) {
                let (re, re_odd) = re.split_at_mut(half);
                let (im, im_odd) = im.split_at_mut(half);
                for k in 0..half {
                    let (cosine, sine) = self.twiddles[k * stride];
                    let (cosine, sine) = (L::splat(cosine), L::splat(sine));
                    let t_re = re_odd[k] * cosine - im_odd[k] * sine;
                    let t_im = re_odd[k] * sine + im_odd[k] * cosine;
                    (re_odd[k], im_odd[k]) = (re[k] - t_re, im[k] - t_im);
                    (re[k], im[k]) = (re[k] + t_re, im[k] + t_im);
                }
            }
            half *= 2;
        }
    }
}

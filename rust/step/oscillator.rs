//! One mode followed exactly under a force that is a cubic in time, with powers that set in within a step.
//!
//! With the step as the unit of time a mode is ẍ + Dẋ + Ω²x = f, D = dh and Ω² = ω²h². Let r₋₁ be its answer to a unit
//! impulse and r_p that to the force tᵖ/p!, from rest: each is the integral of the one before, and f = Σ f_p tᵖ/p! adds
//! Σ f_p r_p to x and Σ f_p r_{p−1} to ẋ. What is there at the beginning goes on as (ṙ₋₁ + D r₋₁) x₀ + r₋₁ ẋ₀.
//!
//! r₃ and r₂ are summed up as power series in t, all terms of which are small where Ωt and Dt are at most a half; the others
//! follow by r_{p−2} = tᵖ/p! − D r_{p−1} − Ω² r_p. In longer steps t is halved until they are, and what holds for a time
//! follows for twice that from going on: so nothing cancels, weakly damped or strongly, in short steps or long.

use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// Powers of time that a force is made of: of degree 0 to 3.
pub const POWERS: usize = 4;

/// Terms of the series of r₃ and r₂: the first one left out is below 1e-17 of the first.
const TERMS: usize = 15;

/// 1/n!, for n from 0 to the last that the series need.
const RECIPROCALS: [f64; TERMS + 5] = {
    let (mut all, mut n) = ([1.0; TERMS + 5], 1);
    while n < TERMS + 5 {
        all[n] = all[n - 1] / n as f64;
        n += 1;
    }
    all
};

/// Answers to the unit impulse and to powers of time: ṙ₋₁, r₋₁, r₀, r₁, r₂ and r₃.
type Answers<L> = [L; POWERS + 2];

/// One mode, in steps of one length.
#[derive(Debug, Clone)]
pub struct Oscillator<L> {
    /// ω² [1/s²], and d [1/s].
    omega2: L,
    rate: L,
    /// D and Ω², of a step.
    damping: L,
    stiffness: L,
    /// Derivatives of r₋₁ at the time zero, from the first on.
    derivatives: [L; TERMS],
    /// Part of a step for which the series hold, and how often it goes into one, as a power of two.
    part: L,
    doublings: L,
    /// Of x by x, x by ẋ, ẋ by x, ẋ by ẋ over a step.
    free: [L; 4],
    /// Of x and of ẋ by the parts of the force over a step.
    forced: [[L; 2]; POWERS],
    /// h² and h.
    scales: [L; 2],
    /// 1/h.
    per_step: L,
}

impl<L: Lane> Oscillator<L> {
    /// Of circular frequency ω [rad/s] with the rate d [1/s] of its damping, in steps of h [s].
    pub fn new(omega: L, rate: L, h: L) -> Self {
        let (zero, one, half) = (L::splat(0.0), L::splat(1.0), L::splat(0.5));
        let (damping, stiffness) = (rate * h, omega * omega * h * h);
        let (mut part, mut doublings) = (one, zero);
        loop {
            let fine = half.less(damping * part) | L::splat(0.25).less(stiffness * part * part);
            if !L::any(fine) {
                break;
            }
            part = L::select(fine, half * part, part);
            doublings = L::select(fine, doublings + one, doublings);
        }
        let mut derivatives = [one; TERMS];
        derivatives[1] = -damping;
        for n in 2..TERMS {
            derivatives[n] = -(damping * derivatives[n - 1] + stiffness * derivatives[n - 2]);
        }
        let mut oscillator = Oscillator {
            omega2: omega * omega,
            rate,
            damping,
            stiffness,
            derivatives,
            part,
            doublings,
            free: [zero; 4],
            forced: [[zero; 2]; POWERS],
            scales: [h * h, h],
            per_step: one / h,
        };
        let whole = oscillator.answers(one);
        let [slope, impulse, ..] = whole;
        oscillator.free = [slope + damping * impulse, h * impulse, -(stiffness * impulse) * oscillator.per_step, slope];
        oscillator.forced = std::array::from_fn(|p| [h * h * whole[p + 2], h * whole[p + 1]]);
        oscillator
    }

    /// ω² [1/s²].
    pub fn omega2(&self) -> L {
        self.omega2
    }

    /// The answers after a time, in steps.
    #[inline(always)]
    fn answers(&self, time: L) -> Answers<L> {
        let t = self.part * time;
        let series = |power: usize| {
            let term = |n: usize| L::splat(RECIPROCALS[n + power]) * self.derivatives[n];
            let mut sum = term(TERMS - 1);
            for n in (0..TERMS - 1).rev() {
                sum = sum * t + term(n);
            }
            sum
        };
        let (t2, t3) = (t * t, t * t * t);
        let (r3, r2) = (t2 * t3 * series(5), t2 * t2 * series(4));
        let before = |given: L, rate: L, value: L| given - self.damping * rate - self.stiffness * value;
        let r1 = before(L::splat(RECIPROCALS[3]) * t3, r2, r3);
        let r0 = before(L::splat(0.5) * t2, r1, r2);
        let impulse = before(t, r0, r1);
        let mut answers = [before(L::splat(1.0), impulse, r0), impulse, r0, r1, r2, r3];
        let (mut done, mut now) = (L::splat(0.0), t);
        while L::any(done.less(self.doublings)) {
            let more = done.less(self.doublings);
            let twice = self.twice(&answers, now);
            for (own, twice) in answers.iter_mut().zip(twice) {
                *own = L::select(more, twice, *own);
            }
            (done, now) = (done + L::splat(1.0), L::select(more, now + now, now));
        }
        answers
    }

    /// The answers after twice the time t.
    fn twice(&self, answers: &Answers<L>, t: L) -> Answers<L> {
        let [slope, impulse, ..] = *answers;
        let held = slope + self.damping * impulse;
        let mut twice = [
            slope * slope - self.stiffness * impulse * impulse,
            held * impulse + impulse * slope,
            answers[2],
            answers[3],
            answers[4],
            answers[5],
        ];
        for p in 0..POWERS {
            // tᵖ/p! goes on as Σ t^{p−i}/(p−i)! · sⁱ/i!.
            let mut sum = held * answers[p + 2] + impulse * answers[p + 1];
            let mut power = L::splat(1.0);
            for i in (0..=p).rev() {
                sum = sum + L::splat(RECIPROCALS[p - i]) * power * answers[i + 2];
                power = power * t;
            }
            twice[p + 2] = sum;
        }
        twice
    }

    /// The mode a step later, but for its acceleration, under Σ f_p tᵖ/p!, t in steps.
    #[inline(always)]
    pub fn advance(&self, mode: Coordinate<L>, force: [L; POWERS]) -> Coordinate<L> {
        let mut next = self.swing(mode);
        for (f, [to_x, to_v]) in force.into_iter().zip(self.forced) {
            next.x = next.x + f * to_x;
            next.v = next.v + f * to_v;
        }
        next
    }

    /// Adds what a force that set in so long before the end of a step (in steps) has done till then; it has no powers below
    /// the `least`.
    #[inline(always)]
    pub fn add(&self, mode: &mut Coordinate<L>, (since, least): (f64, usize), force: [L; POWERS]) {
        let answers = self.answers(L::splat(since));
        let [h2, h] = self.scales;
        for (p, f) in force.into_iter().enumerate().skip(least) {
            mode.x = mode.x + f * (h2 * answers[p + 2]);
            mode.v = mode.v + f * (h * answers[p + 1]);
        }
    }

    /// The acceleration of the mode under a force.
    #[inline(always)]
    pub fn accelerated(&self, mode: Coordinate<L>, force: L) -> Coordinate<L> {
        Coordinate { a: force - self.rate * mode.v - self.omega2 * mode.x, ..mode }
    }

    /// The mode a step later without a force, but for its acceleration.
    #[inline(always)]
    pub fn swing(&self, Coordinate { x, v, a }: Coordinate<L>) -> Coordinate<L> {
        let [xx, xv, vx, vv] = self.free;
        Coordinate { x: xx * x + xv * v, v: vx * x + vv * v, a }
    }
}

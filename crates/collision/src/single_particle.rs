//! The single particle model: at most one of the two particles is kept (szirmay-kalos-2017 eq. 9 and 12).

use crate::{Albedo, Branch, CollisionModel, Outcome, SingleOutcome};
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_sources::UniformSource;

/// Choice of the probabilities q_scat and q_tran from a·|r| and |1 − r|.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// The probabilities a·|r| and |1 − r| themselves: the particle may be absorbed, its energy stays ±1. Only where r ≥ 0 and their sum
    /// is at most 1.
    Terminating,
    /// The same divided by their sum: exactly one particle survives, its energy is ± the sum (eq. 12).
    NonTerminating,
    /// Non-terminating where r < 1 or the sum exceeds 1, terminating elsewhere (SimulateParticle, section 4.1).
    Adaptive,
}

/// Keeps one particle, or none, at random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleParticle {
    /// Choice of the probabilities.
    pub version: Version,
    /// σ_s / σ_t of matter. It enters the probabilities, and so the variance of transmittance too.
    pub albedo: Albedo,
}

/// Three roundings, each of at most half a unit in the last place of a number below 2, can lift a·r + (r − 1) above 1 at
/// the end of the terminating domain, r = 2 / (1 + a), where it equals 1 exactly.
const ROUNDING_OF_THE_SUM: f64 = 3.0 * f64::EPSILON;

impl SingleParticle {
    fn sum(&self, r: f64) -> f64 {
        self.albedo.get() * r.abs() + (1.0 - r).abs()
    }

    /// True if the probabilities at `r` are a·|r| and |1 − r| themselves.
    #[inline]
    fn terminates(&self, r: f64) -> bool {
        match self.version {
            Version::Terminating => true,
            Version::NonTerminating => false,
            Version::Adaptive => r >= 1.0 && self.sum(r) <= 1.0,
        }
    }
}

impl CollisionModel for SingleParticle {
    #[inline]
    fn admits(&self, r: f64) -> bool {
        match self.version {
            Version::Terminating => r >= 0.0 && self.sum(r) <= 1.0 + ROUNDING_OF_THE_SUM,
            Version::NonTerminating | Version::Adaptive => r.is_finite(),
        }
    }

    fn scattered(&self, r: f64) -> Branch {
        let sum = self.sum(r);
        let wanted = self.albedo.get() * r.abs();
        if wanted == 0.0 {
            return Branch::NONE;
        }
        let (probability, absence, size) = if self.terminates(r) {
            (wanted, 1.0 - wanted, 1.0)
        } else {
            (wanted / sum, (1.0 - r).abs() / sum, sum)
        };
        let energy = size.copysign(r);
        Branch { probability, energy, absence, excess: energy - 1.0 }
    }

    #[inline]
    fn transmitted(&self, r: f64) -> Branch {
        let a = self.albedo.get();
        let wanted = (1.0 - r).abs();
        // r = 1: transmission has no weight and no probability. (At a = 0 eq. 12 is 0/0 there: the walk ends.)
        if wanted == 0.0 {
            return Branch::NONE;
        }
        if self.terminates(r) {
            return if r <= 1.0 {
                Branch { probability: wanted, energy: 1.0, absence: r, excess: 0.0 }
            } else {
                Branch { probability: wanted, energy: -1.0, absence: 2.0 - r, excess: -2.0 }
            };
        }
        let sum = self.sum(r);
        // sum − 1 = −(1 − a) r for 0 ≤ r ≤ 1, and (1 + a) |r| for r < 0: written so that a tiny r keeps its digits.
        let (energy, excess) = if r > 1.0 {
            (-sum, -sum - 1.0)
        } else if r >= 0.0 {
            (sum, -(1.0 - a) * r)
        } else {
            (sum, (1.0 + a) * -r)
        };
        Branch { probability: wanted / sum, energy, absence: a * r.abs() / sum, excess }
    }

    /// Ratios at which |r| or |1 − r| has its kink, and the one at which an adaptive particle turns from terminating to not.
    fn kinks(&self) -> Vec<f64> {
        vec![0.0, 1.0, 2.0 / (1.0 + self.albedo.get())]
    }

    #[inline]
    fn transmit_by(&self, r: f64, u: f64) -> Option<f64> {
        let transmitted = self.transmitted(r);
        if u < transmitted.probability { Some(transmitted.energy) } else { None }
    }
}

impl SingleParticle {
    /// SimulateParticle's decision by a variate u (szirmay-kalos-2017 section 4.1): the energy of the particle that survives, ±0 if none does, and whether it is the
    /// scattered one.
    ///
    /// Without a branch, so that it becomes vector instructions in lanes.
    #[inline(always)]
    fn decide(&self, version: Version, r: f64, u: f64) -> (f64, bool) {
        let (scatter, transmit) = (self.albedo.get() * r.abs(), (1.0 - r).abs());
        let sum = scatter + transmit;
        let keeps_one = match version {
            Version::Terminating => false,
            Version::NonTerminating => true,
            Version::Adaptive => (r < 1.0) | (sum > 1.0),
        };
        // u q_sum < q_scat instead of u < q_scat / q_sum: a product in place of two quotients. Its rounding must not choose
        // a particle of probability 0. (At a = 0, r = 1 eq. 12 is 0/0: neither particle has energy, and the walk ends.)
        let is_scattered = if keeps_one { (u * sum < scatter) | (transmit == 0.0) } else { u < scatter };
        let size = if keeps_one { sum } else { f64::from(u8::from(is_scattered | (u < sum))) };
        (size.copysign(if is_scattered { r } else { 1.0 - r }), is_scattered)
    }

    /// The decisions of [`collide`](SingleOutcome::collide) in all lanes: energies, ±0 of what is absorbed, and whether the particle is the scattered one.
    #[inline(always)]
    #[must_use]
    pub fn collide_lanes(&self, r: &Lanes, u: &Lanes) -> (Lanes, [bool; LANES]) {
        // A loop for each version.
        match self.version {
            version @ Version::Terminating => self.decide_lanes(version, r, u),
            version @ Version::NonTerminating => self.decide_lanes(version, r, u),
            version @ Version::Adaptive => self.decide_lanes(version, r, u),
        }
    }

    #[inline(always)]
    fn decide_lanes(&self, version: Version, r: &Lanes, u: &Lanes) -> (Lanes, [bool; LANES]) {
        let (mut energies, mut are_scattered) = ([0.0; LANES], [false; LANES]);
        for i in 0..LANES {
            (energies[i], are_scattered[i]) = self.decide(version, r[i], u[i]);
        }
        (energies, are_scattered)
    }
}

impl SingleOutcome for SingleParticle {
    #[inline]
    fn collide(&self, r: f64, source: &mut impl UniformSource) -> Outcome {
        match self.decide(self.version, r, source.next_uniform()) {
            (0.0, _) => Outcome::Absorbed,
            (energy, true) => Outcome::Scattered(energy),
            (energy, false) => Outcome::Transmitted(energy),
        }
    }
}

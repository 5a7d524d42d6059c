//! One of the two particles that may leave a collision.

/// A particle that leaves with some probability and then carries some multiple of the incident energy.
///
/// The weight W of this branch is `energy` with probability `probability`, else 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// The probability that the particle exists.
    pub probability: f64,
    /// Energy of the particle as a multiple of the incident one; of either sign.
    pub energy: f64,
    /// 1 − probability, to full relative precision.
    pub(crate) absence: f64,
    /// energy − 1, to full relative precision.
    pub(crate) excess: f64,
}

impl Branch {
    /// A particle that never leaves.
    pub const NONE: Self = Self { probability: 0.0, energy: 0.0, absence: 1.0, excess: -1.0 };

    /// E\[W^k\] = probability · energy^k, for k ≥ 1.
    #[must_use]
    pub fn moment(&self, k: i32) -> f64 {
        debug_assert!(k >= 1, "a branch has moments from the first on");
        self.probability * self.energy.powi(k)
    }

    /// E\[(W − 1)^k\] = probability · (energy − 1)^k + (1 − probability) · (−1)^k, without cancellation for small r.
    ///
    /// These are what the variance of a walk is made of: a walk without collision has weight 1.
    #[must_use]
    pub fn moment_about_one(&self, k: i32) -> f64 {
        let lost = if k % 2 == 0 { self.absence } else { -self.absence };
        self.probability * self.excess.powi(k) + lost
    }
}

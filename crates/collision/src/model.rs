//! The law of a collision model.

use crate::Branch;
use fairflight_sources::UniformSource;

/// A model of the collision with ratio `r = σ_diff / σ_samp`.
///
/// **Law.** For every admitted r: `scattered(r)` has the expected energy a·r, `transmitted(r)` the expected energy
/// 1 − r (szirmay-kalos-2017 eq. 8), and [`transmit`](Self::transmit) draws the transmitted weight with exactly the
/// probability and energy that `transmitted(r)` states.
pub trait CollisionModel {
    /// True if a transmission draws a variate, false if it is certain.
    const DRAWS: bool = true;

    /// True if the model is defined at `r`; where it is not, it has no probabilities.
    fn admits(&self, r: f64) -> bool;

    /// The scattered particle.
    fn scattered(&self, r: f64) -> Branch;

    /// The transmitted particle.
    fn transmitted(&self, r: f64) -> Branch;

    /// The ratios at which a moment of either particle, as a function of r, is not smooth: where an integral over a ray is to be split.
    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The weight of the transmitted particle where the variate of [`transmit`](Self::transmit) is `u`; 0 is passed where none is drawn.
    fn transmit_by(&self, r: f64, u: f64) -> Option<f64>;

    /// Draws the weight of the transmitted particle; `None` where no transmitted particle leaves and the walk ends.
    #[inline]
    fn transmit(&self, r: f64, source: &mut impl UniformSource) -> Option<f64> {
        self.transmit_by(r, if Self::DRAWS { source.next_uniform() } else { 0.0 })
    }
}

/// A model that keeps at most one of the two particles, so that a walk does not branch.
///
/// **Law.** [`collide`](Self::collide) scatters and transmits with exactly the probabilities and energies that
/// [`scattered`](CollisionModel::scattered) and [`transmitted`](CollisionModel::transmitted) state.
pub trait SingleOutcome: CollisionModel {
    /// Draws what leaves the collision, from one variate.
    fn collide(&self, r: f64, source: &mut impl UniformSource) -> Outcome;
}

/// The one particle that leaves a collision, with its energy as a multiple of the incident one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The particle takes a new direction, with this energy.
    Scattered(f64),
    /// The particle goes straight on, with this energy.
    Transmitted(f64),
    /// No particle survives.
    Absorbed,
}

/// The probability that a collision with matter scatters: σ_s / σ_t, within \[0, 1\].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Albedo(f64);

/// An albedo outside \[0, 1\].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("albedo must lie in [0, 1], found {found}")]
pub struct AlbedoError {
    /// The value given.
    pub found: f64,
}

impl Albedo {
    /// A checked albedo.
    ///
    /// # Errors
    /// If `albedo` is NaN or outside \[0, 1\].
    pub fn new(albedo: f64) -> Result<Self, AlbedoError> {
        if (0.0..=1.0).contains(&albedo) { Ok(Self(albedo)) } else { Err(AlbedoError { found: albedo }) }
    }

    /// The number.
    #[inline]
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

impl std::fmt::Display for Albedo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

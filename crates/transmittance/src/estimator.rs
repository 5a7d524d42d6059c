//! The law that every estimator of transmittance obeys.

use fairflight_media::{Extinction, Majorant};
use fairflight_sources::UniformSource;

/// A random estimate of the transmittance of a whole profile.
///
/// **Law.** For every field whose values [`admits`](Self::admits) accepts,
/// `E[estimate] = exp(−∫_0^length σ_t(s) ds)`. Estimates may be negative and may exceed 1; clamping them is a bias.
///
/// The bounds that an implementation puts on `F` are the knowledge that its paper assumes: look-ups only, a majorant, …
/// An unbiased estimator never asks for the optical thickness of the field itself.
pub trait TransmittanceEstimator<F: Extinction> {
    /// Draws one estimate \[1\]. Variates come from `source` alone; nothing is allocated.
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64;

    /// True if the estimator is defined where σ_t has this value at the distance `s`. Whoever runs it on a field that it
    /// does not admit gets a biased estimate, not an error: watch the look-ups.
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool;
}

/// Majorant and length of a field; `None` where the majorant admits nothing but a vacuum, whose transmittance is 1.
#[inline]
pub(crate) fn bounded<F: Majorant>(field: &F) -> Option<(f64, f64)> {
    let majorant = field.majorant();
    if majorant <= 0.0 { None } else { Some((majorant, field.length())) }
}

/// A point at which a walk met matter, real or virtual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interaction {
    /// Distance from the start of the profile \[length\].
    pub distance: f64,
    /// σ_t there \[1/length\].
    pub sigma_t: f64,
    /// The weight of the walk *behind* it, without the control's transmittance \[1\]; 0 where the walk ended here.
    pub weight: f64,
}

impl Interaction {
    /// The weight of a walk at the distance `s`, without the control's transmittance: that behind its last interaction point
    /// at or before `s`, 1 before the first.
    #[must_use]
    pub fn weight_at(walk: &[Self], s: f64) -> f64 {
        let behind = walk.partition_point(|point| point.distance <= s);
        if behind == 0 { 1.0 } else { walk[behind - 1].weight }
    }
}

/// A random estimate of transmittance as a function of distance.
///
/// **Law.** For every s in the profile, `E[T(s)] = exp(−∫_0^s σ_t)`, with T(s) = [`Interaction::weight_at`] s times the
/// control's transmittance up to s.
pub trait TransmittanceFunction<F: Extinction>: TransmittanceEstimator<F> {
    /// Draws one walk: its interaction points in increasing order. Appends to `walk`.
    fn trace(&self, field: &F, source: &mut impl UniformSource, walk: &mut Vec<Interaction>);

    /// The control's transmittance up to `s`.
    fn main_transmittance(&self, s: f64) -> f64;
}

impl<F: Extinction, E: TransmittanceEstimator<F>> TransmittanceEstimator<F> for &E {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        (**self).estimate(field, source)
    }
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        (**self).admits(field, s, sigma_t)
    }
}

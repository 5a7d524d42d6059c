//! The law that every free-flight sampler obeys.

use fairflight_media::Extinction;
use fairflight_sources::UniformSource;

/// End of a flight.
///
/// There is no third end: a flight is absorbed by matter only after it has met it, and what happens there is not the
/// flight's business.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flight {
    /// A collision with matter inside the profile.
    Collided {
        /// The distance from the start of the profile \[length\].
        distance: f64,
        /// Weight that the flight counts with \[1\]; of either sign, 1 for an unweighted sampler.
        weight: f64,
    },
    /// The end of the profile.
    Escaped {
        /// Weight that the flight counts with \[1\]; of either sign, 1 for an unweighted sampler.
        weight: f64,
    },
}

impl Flight {
    /// The weight, wherever the flight ended.
    #[inline]
    #[must_use]
    pub fn weight(&self) -> f64 {
        match *self {
            Self::Collided { weight, .. } | Self::Escaped { weight } => weight,
        }
    }

    /// The distance of the collision; `None` where there was none.
    #[inline]
    #[must_use]
    pub fn distance(&self) -> Option<f64> {
        match *self {
            Self::Collided { distance, .. } => Some(distance),
            Self::Escaped { .. } => None,
        }
    }

    /// The flight of weight 1 to a collision at `distance`, or the one that escaped.
    #[inline]
    pub(crate) fn unweighted(distance: Option<f64>) -> Self {
        match distance {
            Some(distance) => Self::Collided { distance, weight: 1.0 },
            None => Self::Escaped { weight: 1.0 },
        }
    }
}

/// A sampler of the distance to the next collision with matter.
///
/// **Law.** For every field whose values [`admits`](Self::admits) accepts, with T(s) = exp(−∫_0^s σ_t), and for every
/// bounded test function g,
///
/// > E\[1{collided} · weight · g(distance)\] = ∫_0^length σ_t(s) T(s) g(s) ds,   E\[1{escaped} · weight\] = T(length).
///
/// Weights may be negative and may exceed 1; clamping them is a bias. An unweighted sampler (all weights 1) draws the
/// density pdf_distance(s) = σ_t(s) T(s) \[1/length\] itself (szirmay-kalos-2017 eq. 3), a weighted one does not: its
/// distances alone follow no law that the field states.
///
/// The bounds that an implementation puts on `F` are the knowledge that its paper assumes: look-ups only, a majorant, an
/// optical thickness in closed form, cells, …
pub trait FreeFlight<F: Extinction> {
    /// Draws one flight from the start of the profile. Variates come from `source` alone; nothing is allocated.
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight;

    /// True if the sampler is defined where σ_t has this value at the distance `s`. Whoever runs it on a field that it
    /// does not admit gets biased flights, not an error: watch the look-ups.
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool;
}

impl<F: Extinction, E: FreeFlight<F>> FreeFlight<F> for &E {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        (**self).sample(field, source)
    }
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        (**self).admits(field, s, sigma_t)
    }
}

//! References that a measured mean and variance are judged against.

use crate::closed_moments::ClosedMoments;

/// Relative rounding error granted to a mean, per unit of the condition number 1 + |ln mean|.
///
/// The quantities judged are exponentials of sums: a relative error d of an optical thickness tau is a relative error
/// tau d of exp(-tau), and tau is |ln mean|. 1e-12 covers sums and products of 1e4 roundings of 1e-16 each.
pub const ROUNDING: f64 = 1e-12;

/// Known facts about the values that one sample can take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scores {
    /// A sample is 0 or `high`, up to rounding: the number of successes has a binomial law.
    TwoValued {
        /// The value that is not zero.
        high: f64,
    },
    /// A sample lies in [minimum, maximum], up to rounding.
    Bounded {
        /// Lower bound; −∞ for a law with an upper one only.
        minimum: f64,
        /// Upper bound; ∞ for a law with a lower one only, such as that of weights which are never negative.
        maximum: f64,
    },
    /// Nothing is known.
    Unbounded,
}

/// Certainty of the error of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Certainty {
    /// Proved: a closed form, or a quadrature whose enclosure holds between its nodes as well.
    Certified,
    /// Estimated from the values at nodes: features between them may have been missed. Proved are only bounds of the mean,
    /// infinite where nothing is.
    Estimated {
        /// Lower bound of the mean.
        low: f64,
        /// Upper bound of the mean.
        high: f64,
    },
}

/// Known facts about values so rare and so large that a sample may lack them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tails {
    /// Nothing: the sample's own standard error and shape are blind to them, and do not reject.
    Unknown,
    /// There are none that matter at this N, by the choice of what is sampled: the sample's own standard error and shape are believed.
    Mild,
}

/// The truth that a sample should have as its mean, with its own error and what is known of the law of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The mean that an unbiased estimator has.
    pub mean: f64,
    /// Bound of the absolute error of `mean`; zero for a closed form.
    pub error: f64,
    /// Certainty of `error`: proved or estimated.
    pub certainty: Certainty,
    /// Moments of one sample in closed form, where there is one. Their mean is taken to be `mean`.
    pub moments: Option<ClosedMoments>,
    /// An upper bound of the variance of one sample: in the place of a closed form, or above one with its error.
    pub variance_bound: Option<f64>,
    /// The values that one sample can take.
    pub scores: Scores,
    /// Known facts about the tails of its law.
    pub tails: Tails,
}

impl Reference {
    /// An exact mean and nothing else known.
    #[must_use]
    pub const fn exact(mean: f64) -> Self {
        Self {
            mean,
            error: 0.0,
            certainty: Certainty::Certified,
            moments: None,
            variance_bound: None,
            scores: Scores::Unbounded,
            tails: Tails::Unknown,
        }
    }

    /// The same for a law that is known to have mild tails.
    #[must_use]
    pub const fn with_mild_tails(self) -> Self {
        Self { tails: Tails::Mild, ..self }
    }

    /// Success probability mean/high of a two-valued sample, its rounding beyond [0, 1] cut off; else `None`.
    #[must_use]
    pub fn success_probability(&self) -> Option<f64> {
        match self.scores {
            Scores::TwoValued { high } => Some((self.mean / high).clamp(0.0, 1.0)),
            Scores::Bounded { .. } | Scores::Unbounded => None,
        }
    }

    /// The moments of one sample: of two values they follow from the mean, else as given. `None` where the mean itself is
    /// estimated: what misses a feature of the law misses it in every moment.
    #[must_use]
    pub fn closed_moments(&self) -> Option<ClosedMoments> {
        match (self.certainty, self.scores, self.success_probability()) {
            (Certainty::Estimated { .. }, ..) => None,
            (_, Scores::TwoValued { high }, Some(p)) => Some(ClosedMoments::two_valued(high, p)),
            _ => self.moments,
        }
    }

    /// An upper bound of the variance of one sample, where one is certified: with its error, if that is known.
    pub(crate) fn greatest_variance(&self) -> Option<f64> {
        match self.certainty {
            Certainty::Estimated { .. } => None,
            Certainty::Certified => {
                self.variance_bound.or_else(|| self.closed_moments().and_then(|moments| moments.variance()))
            }
        }
    }

    /// Greatest distance of the true mean from `mean` that is not excluded: the error, or that of the certified bounds.
    #[must_use]
    pub fn uncertainty(&self) -> f64 {
        match self.certainty {
            Certainty::Certified => self.error,
            Certainty::Estimated { low, high } => (self.mean - low).max(high - self.mean).max(self.error),
        }
    }

    /// The interval in which the true mean lies for certain, rounding included.
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        let (low, high) = match self.certainty {
            Certainty::Certified => (self.mean - self.error, self.mean + self.error),
            Certainty::Estimated { low, high } => (low, high),
        };
        (low - self.rounding(), high + self.rounding())
    }

    /// Absolute rounding error granted to a sample and to their mean, ROUNDING (1 + |ln |mean||) |mean|; zero for zero.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let size = self.mean.abs();
        if size == 0.0 { 0.0 } else { ROUNDING * (1.0 + size.ln().abs()) * size }
    }

    /// Deviation of a mean without any evidence against it: the reference's uncertainty and rounding.
    #[must_use]
    pub fn allowance(&self) -> f64 {
        self.uncertainty() + self.rounding()
    }

    /// True if a standard deviation of one sample is nothing but rounding.
    #[must_use]
    pub(crate) fn is_rounding(&self, variance: f64) -> bool {
        variance.sqrt() <= self.rounding()
    }
}

#[cfg(test)]
mod tests {
    use super::{Certainty, Reference, Scores};
    use approx::assert_relative_eq;

    #[test]
    fn rounding_grows_with_the_condition_of_the_exponential() {
        assert_relative_eq!(Reference::exact(1.0).rounding(), 1e-12);
        assert_relative_eq!(Reference::exact((-99.0f64).exp()).rounding(), 1e-10 * (-99.0f64).exp());
        assert_eq!(Reference::exact(0.0).rounding(), 0.0);
        assert_relative_eq!(Reference { error: 1e-3, ..Reference::exact(-1.0) }.allowance(), 1e-3 + 1e-12);
    }

    #[test]
    fn an_estimated_mean_has_no_moments_and_the_certified_interval() {
        let certainty = Certainty::Estimated { low: 0.25, high: 1.5 };
        let reference = Reference { certainty, error: 1e-3, ..Reference::exact(1.0) };
        assert_eq!(reference.uncertainty(), 0.75);
        assert_eq!(reference.interval(), (0.25 - 1e-12, 1.5 + 1e-12));
        let scores = Scores::TwoValued { high: 2.0 };
        assert_eq!(Reference { scores, ..reference }.closed_moments(), None);
        assert_eq!(Reference { certainty: Certainty::Certified, ..reference }.uncertainty(), 1e-3);
        let nothing = Certainty::Estimated { low: f64::NEG_INFINITY, high: f64::INFINITY };
        assert_eq!(Reference { certainty: nothing, ..reference }.uncertainty(), f64::INFINITY);
    }

    #[test]
    fn two_values_fix_the_moments() {
        let scores = Scores::TwoValued { high: 4.0 };
        let reference = Reference { scores, ..Reference::exact(1.0) };
        assert_eq!(reference.success_probability(), Some(0.25));
        assert_eq!(reference.closed_moments().unwrap().variance(), Some(3.0));
        assert_eq!(Reference { mean: 4.000_000_1, ..reference }.success_probability(), Some(1.0));
        assert_eq!(Reference::exact(1.0).closed_moments(), None);
    }
}

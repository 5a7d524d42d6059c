//! What a measured mean and variance are judged against.

use crate::closed_moments::ClosedMoments;

/// Relative rounding error granted to a mean, per unit of the condition number 1 + |ln mean|.
///
/// The quantities judged are exponentials of sums: a relative error d of an optical thickness tau is a relative error
/// tau d of exp(-tau), and tau is |ln mean|. 1e-12 covers sums and products of 1e4 roundings of 1e-16 each.
pub const ROUNDING: f64 = 1e-12;

/// What is known of the values that one sample can take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scores {
    /// A sample is 0 or `high`, up to rounding: the number of successes has a binomial law.
    TwoValued {
        /// The value that is not zero.
        high: f64,
    },
    /// A sample lies in [minimum, maximum], up to rounding.
    Bounded {
        /// Lower bound.
        minimum: f64,
        /// Upper bound.
        maximum: f64,
    },
    /// Nothing is known.
    Unbounded,
}

/// How the error of a reference is known.
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

/// The truth that a sample should have as its mean, with its own error and what is known of the law of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The mean that an unbiased estimator has.
    pub mean: f64,
    /// Bound of the absolute error of `mean`; zero for a closed form.
    pub error: f64,
    /// Whether `error` was proved or estimated.
    pub certainty: Certainty,
    /// Moments of one sample in closed form, where there is one. Their mean is taken to be `mean`.
    pub moments: Option<ClosedMoments>,
    /// The values that one sample can take.
    pub scores: Scores,
}

impl Reference {
    /// An exact mean and nothing else known.
    #[must_use]
    pub const fn exact(mean: f64) -> Self {
        Self { mean, error: 0.0, certainty: Certainty::Certified, moments: None, scores: Scores::Unbounded }
    }

    /// Success probability mean/high of a two-valued sample, its rounding beyond [0, 1] cut off; else `None`.
    #[must_use]
    pub fn success_probability(&self) -> Option<f64> {
        match self.scores {
            Scores::TwoValued { high } => Some((self.mean / high).clamp(0.0, 1.0)),
            Scores::Bounded { .. } | Scores::Unbounded => None,
        }
    }

    /// The moments of one sample: of two values they follow from the mean, else as given.
    #[must_use]
    pub fn closed_moments(&self) -> Option<ClosedMoments> {
        match (self.scores, self.success_probability()) {
            (Scores::TwoValued { high }, Some(p)) => Some(ClosedMoments::two_valued(high, p)),
            _ => self.moments,
        }
    }

    /// Absolute rounding error granted to a sample and to their mean, ROUNDING (1 + |ln |mean||) |mean|; zero for zero.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let size = self.mean.abs();
        if size == 0.0 { 0.0 } else { ROUNDING * (1.0 + size.ln().abs()) * size }
    }

    /// What a mean may deviate without any evidence against it: the reference's error and rounding.
    #[must_use]
    pub fn allowance(&self) -> f64 {
        self.error + self.rounding()
    }

    /// Whether a standard deviation of one sample is nothing but rounding.
    #[must_use]
    pub(crate) fn is_rounding(&self, variance: f64) -> bool {
        variance.sqrt() <= self.rounding()
    }
}

#[cfg(test)]
mod tests {
    use super::{Reference, Scores};
    use approx::assert_relative_eq;

    #[test]
    fn rounding_grows_with_the_condition_of_the_exponential() {
        assert_relative_eq!(Reference::exact(1.0).rounding(), 1e-12);
        assert_relative_eq!(Reference::exact((-99.0f64).exp()).rounding(), 1e-10 * (-99.0f64).exp());
        assert_eq!(Reference::exact(0.0).rounding(), 0.0);
        assert_relative_eq!(Reference { error: 1e-3, ..Reference::exact(-1.0) }.allowance(), 1e-3 + 1e-12);
    }

    #[test]
    fn two_values_fix_the_moments() {
        let scores = Scores::TwoValued { high: 4.0 };
        let reference = Reference { scores, ..Reference::exact(1.0) };
        assert_eq!(reference.success_probability(), Some(0.25));
        assert_eq!(reference.closed_moments().unwrap().variance, Some(3.0));
        assert_eq!(Reference { mean: 4.000_000_1, ..reference }.success_probability(), Some(1.0));
        assert_eq!(Reference::exact(1.0).closed_moments(), None);
    }
}

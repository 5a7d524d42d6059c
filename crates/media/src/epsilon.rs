//! The greatest optical thickness of a stratum.

/// The greatest optical thickness that strata may have in what extinction can vary by \[1\]: in (0, 1\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epsilon(f64);

/// A reason why strata cannot have this optical thickness.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EpsilonError {
    /// Strata without optical thickness, of which there would be infinitely many.
    #[error("epsilon must be positive, found {0}")]
    NotPositive(f64),
    /// Strata whose optical thickness is no probability.
    #[error("epsilon must not exceed 1, found {0}")]
    AboveOne(f64),
}

impl Epsilon {
    /// The greatest optical thickness `epsilon` of a stratum.
    ///
    /// # Errors
    /// If `epsilon` is not in (0, 1\].
    pub fn new(epsilon: f64) -> Result<Self, EpsilonError> {
        match epsilon {
            found if found > 1.0 => Err(EpsilonError::AboveOne(found)),
            found if found > 0.0 => Ok(Self(found)),
            found => Err(EpsilonError::NotPositive(found)),
        }
    }

    /// The optical thickness \[1\].
    #[inline]
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }

    /// The least number of equal strata that make up `thickness`, none of them thicker; 0 where that is not positive.
    #[inline]
    #[must_use]
    pub fn strata(self, thickness: f64) -> f64 {
        if thickness <= 0.0 { 0.0 } else { (thickness / self.0).ceil().max(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_epsilon_outside_its_interval_is_refused() {
        for epsilon in [0.0, -1.0, f64::NAN] {
            assert!(matches!(Epsilon::new(epsilon), Err(EpsilonError::NotPositive(_))));
        }
        assert_eq!(Epsilon::new(1.5), Err(EpsilonError::AboveOne(1.5)));
    }

    #[test]
    fn strata_are_as_few_as_they_can_be() {
        let half = Epsilon::new(0.5).unwrap();
        assert_eq!(
            [-1.0, 0.0, 1e-300, 0.5, 0.6, 2.0].map(|thickness| half.strata(thickness)),
            [0.0, 0.0, 1.0, 1.0, 2.0, 4.0]
        );
    }
}

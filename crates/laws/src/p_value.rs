//! The p-values of a check, by which its level can be judged over many seeds.

use fairflight_stats::normal::two_sided_tail;
use fairflight_stats::{GoodnessOfFit, MeanTest, StandardErrorSource, Verdict};

/// Relation of P(p ≤ x) to x where the law holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Equal, up to the normal approximation: a z-score with the standard error of the law.
    Exact,
    /// Equal, up to the normal approximation and the error of the sample's own standard error.
    Studentised,
    /// At most x: a count, a bound that holds at every N, or a limit law with a factor of safety.
    Conservative,
}

impl Level {
    /// The name in a result.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Studentised => "studentised",
            Self::Conservative => "conservative",
        }
    }
}

/// One p-value. Of a z-score it is the plain two-sided one, P(|Z| > |z|): verdicts multiply it by
/// [`TAIL_INFLATION`](fairflight_stats::approximation::TAIL_INFLATION) and grant the error of the reference, and their level
/// holds far out in the tails, where no study of seeds comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct PValue {
    /// The quantity tested: `mean`, `variance`, `look-ups`, …, behind the part of the check that it belongs to.
    pub of: String,
    /// The p-value.
    pub p: f64,
    /// The law of this p-value while the hypothesis holds.
    pub level: Level,
}

impl PValue {
    fn new(of: impl Into<String>, p: f64, level: Level) -> Self {
        Self { of: of.into(), p, level }
    }

    /// The p-values of the mean and of the variance, where they were tested; the mean is called `name`.
    #[must_use]
    pub fn of_verdict(verdict: &Verdict, name: &str) -> Vec<Self> {
        let level = match verdict.standard_error_source {
            StandardErrorSource::ClosedForm => Level::Exact,
            StandardErrorSource::Sample => Level::Studentised,
        };
        let mean = match verdict.mean_test {
            MeanTest::Normal => verdict.mean_z.map(|z| Self::new(name, two_sided_tail(z), level)),
            _ => verdict.mean_p.map(|p| Self::new(name, p, Level::Conservative)),
        };
        let variance = verdict.variance_p.and(verdict.variance_z);
        let name = if name == "mean" { "variance".to_owned() } else { format!("{name} variance") };
        let variance = variance.map(|z| Self::new(name, two_sided_tail(z), Level::Exact));
        mean.into_iter().chain(variance).collect()
    }

    /// The p-value of a whole distribution, where it was tested.
    #[must_use]
    pub fn of_fit(fit: &GoodnessOfFit, name: &str) -> Option<Self> {
        fit.p_value_bound.map(|p| Self::new(name, p, Level::Conservative))
    }

    /// The same within the part `part` of a check.
    #[must_use]
    pub fn within(self, part: &str) -> Self {
        Self { of: format!("{part}: {}", self.of), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_stats::{ClosedMoments, Moments, Reference, Scores, judge};

    fn found(scores: Scores, moments: Option<ClosedMoments>) -> Vec<(String, Level)> {
        let sample: Moments = (0..200_000).map(|i| f64::from(i % 4 == 0)).collect();
        let reference = Reference { scores, moments, ..Reference::exact(0.25) };
        let p_values = PValue::of_verdict(&judge(&sample, &reference, 1e-6), "mean");
        assert!(p_values.iter().all(|p_value| (0.0..=1.0).contains(&p_value.p)));
        p_values.into_iter().map(|p_value| (p_value.of, p_value.level)).collect()
    }

    #[test]
    fn a_level_is_that_of_the_test() {
        let law = Some(ClosedMoments::two_valued(1.0, 0.25));
        let of = |name: &str, level| (name.to_owned(), level);
        let exact = [of("mean", Level::Exact), of("variance", Level::Exact)];
        assert_eq!(found(Scores::Unbounded, law), exact);
        assert_eq!(found(Scores::Unbounded, None), [of("mean", Level::Studentised)]);
        assert_eq!(found(Scores::TwoValued { high: 1.0 }, None), [of("mean", Level::Conservative)]);
    }
}

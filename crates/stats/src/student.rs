//! Quantiles of Student's law: how far a mean may be from the truth in standard errors that come from its own few values.

use crate::halving::quantile;
use statrs::function::beta::beta_reg;

/// P(|T| > t) for t ≥ 0 and so many degrees of freedom: degrees/(degrees + T²) is a beta variate of degrees/2 and 1/2.
fn two_sided_tail(t: f64, degrees: f64) -> f64 {
    beta_reg(0.5 * degrees, 0.5, degrees / (degrees + t * t))
}

/// The t ≥ 0 with P(|T| > t) = `probability` in (0, 1), for Student's law of so many degrees of freedom, 1 or more; from above to a
/// relative 1e-12.
///
/// By halving: the inverse of the beta function of statrs 0.19 does not end for a billion degrees.
#[must_use]
pub fn student_two_sided_quantile(probability: f64, degrees: u64) -> f64 {
    debug_assert!(probability > 0.0 && probability < 1.0, "a probability within (0, 1), found {probability}");
    debug_assert!(degrees > 0, "a variance has at least one degree of freedom");
    let degrees = degrees as f64;
    quantile(1.0, |t| two_sided_tail(t, degrees) <= probability)
}

#[cfg(test)]
mod tests {
    use super::student_two_sided_quantile;
    use crate::normal;

    #[test]
    fn closed_forms_of_one_and_two_degrees() {
        for probability in [0.5, 0.05, 1e-3] {
            // tan(π(1 − p)/2), and √(2 (1 − p)²/(1 − (1 − p)²)).
            let inside: f64 = 1.0 - probability;
            let one = (0.5 * std::f64::consts::PI * inside).tan();
            let two = (2.0 * inside * inside / (1.0 - inside * inside)).sqrt();
            for (degrees, expected) in [(1, one), (2, two)] {
                let found = student_two_sided_quantile(probability, degrees);
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{degrees} at {probability}: {found} {expected}"
                );
            }
        }
    }

    /// The usual table, at 95 %.
    #[test]
    fn quantiles_of_tables() {
        for (degrees, expected) in
            [(3, 3.182), (5, 2.571), (10, 2.228), (11, 2.201), (30, 2.042), (120, 1.980)]
        {
            assert!((student_two_sided_quantile(0.05, degrees) - expected).abs() < 5e-4, "{degrees}");
        }
    }

    #[test]
    fn many_degrees_are_the_normal_law() {
        // The next term of the expansion in 1/degrees is (z³ + z)/4.
        let (z, degrees) = (normal::two_sided_quantile(0.05), 10_000);
        let expected = z + (z.powi(3) + z) / (4.0 * degrees as f64);
        assert!((student_two_sided_quantile(0.05, degrees) - expected).abs() < 1e-7);
    }
}

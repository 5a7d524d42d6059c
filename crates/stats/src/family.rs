//! Many checks at once: the level of each, or the rejections among all, for a stated false alarm of the family.

/// The level of each of `checks` independent checks such that the probability of any false alarm is `family_level`:
/// 1 - (1 - family_level)^(1/checks). Source: Šidák 1967. For no checks, `family_level` itself.
///
/// Also valid (then conservative) for p-values that are positively dependent.
#[must_use]
pub fn sidak_level(family_level: f64, checks: usize) -> f64 {
    debug_assert!((0.0..=1.0).contains(&family_level), "a level lies in [0, 1], found {family_level}");
    if checks == 0 {
        return family_level;
    }
    // Through logarithms, as the level of a check is far below the rounding of 1.
    -((-family_level).ln_1p() / checks as f64).exp_m1()
}

/// Returns for each p-value, in the order given, whether Holm's step-down procedure rejects it; nothing for no p-values.
///
/// In ascending order the i-th of m (from zero) is rejected while p <= family_level/(m - i). The probability of any
/// false alarm is at most `family_level` whatever the dependence. Source: Holm 1979. A NaN is never rejected and
/// counts among the m.
#[must_use]
pub fn holm_rejections(p_values: &[f64], family_level: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&i, &j| p_values[i].abs().total_cmp(&p_values[j].abs()));
    let mut rejected = vec![false; p_values.len()];
    for (rank, &index) in order.iter().enumerate() {
        let remaining = (p_values.len() - rank) as f64;
        if p_values[index] <= family_level / remaining {
            rejected[index] = true;
        } else {
            break;
        }
    }
    rejected
}

#[cfg(test)]
mod tests {
    use super::{holm_rejections, sidak_level};
    use approx::assert_relative_eq;

    #[test]
    fn sidak_restores_the_family_level() {
        for checks in [1, 2, 10, 1000] {
            let level = sidak_level(0.05, checks);
            assert_relative_eq!(1.0 - (1.0 - level).powi(checks as i32), 0.05, max_relative = 1e-12);
        }
        // ln(1 - a) = -a - a^2/2: the level is a/m up to a relative a/2.
        assert_relative_eq!(sidak_level(1e-6, 1_000_000), 1e-12, max_relative = 1e-6);
        assert!(sidak_level(1e-6, 1_000_000) > 1e-12);
        assert_eq!((sidak_level(0.01, 0), sidak_level(0.01, 1)), (0.01, 0.01));
        assert_eq!((sidak_level(0.0, 5), sidak_level(1.0, 5)), (0.0, 1.0));
    }

    #[test]
    fn holm_steps_down_and_stops() {
        // Thresholds 0.0125, 0.0167, 0.025, 0.05: the third fails, and takes the fourth (0.04 < 0.05) with it.
        assert_eq!(holm_rejections(&[0.04, 0.01, 0.03, 0.015], 0.05), [false, true, false, true]);
        assert_eq!(holm_rejections(&[0.01, 0.02, 0.03], 0.05), [true, true, true]);
        assert_eq!(holm_rejections(&[0.02, 0.02, 0.02], 0.05), [false; 3]);
        assert!(holm_rejections(&[], 0.05).is_empty());
    }

    #[test]
    fn holm_neither_rejects_nor_forgets_a_nan() {
        assert_eq!(holm_rejections(&[f64::NAN, 0.02], 0.05), [false, true]);
        assert_eq!(holm_rejections(&[f64::NAN, 0.03], 0.05), [false, false]);
        assert_eq!(holm_rejections(&[-f64::NAN], 0.05), [false]);
    }
}

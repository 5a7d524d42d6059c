//! The exact transmittance of a pixel.

use fairflight_harness::field::AnyProfile;

/// A transmittance and its absolute error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exact {
    pub(super) transmittance: f64,
    pub(super) error: f64,
}

/// Points of each of the two rules: a hundred times the budget of an image.
const POINTS: u32 = 1024;

/// Closed form where there is one, else the midpoint rule.
///
/// Noise of twelve octaves is resolved by no rule that thousands of pixels could afford; what is left unresolved are the
/// finest octaves, which average out like independent errors. The rule is then as good as any, and its error is seen where
/// its points are split into two rules of every second one: half their difference, for the mean of the two.
pub(super) fn transmittance(profile: &AnyProfile) -> Exact {
    let field = profile.field();
    if let Some(thickness) = field.knowledge().optical_thickness {
        return Exact { transmittance: (-thickness).exp(), error: 0.0 };
    }
    let step = field.length() / f64::from(POINTS);
    let rule = |offset: f64| -> f64 {
        step * (0..POINTS).map(|k| field.sigma_t((f64::from(k) + offset) * step)).sum::<f64>()
    };
    let (even, odd) = (rule(0.25), rule(0.75));
    let transmittance = (-0.5 * (even + odd)).exp();
    Exact { transmittance, error: transmittance * (0.5 * (even - odd)).abs().exp_m1() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standard::subject;
    use fairflight_harness::field::MediumLibrary;

    #[test]
    fn the_error_of_noise_is_small_and_not_understated() {
        let subject = subject::perlin(&MediumLibrary::default()).unwrap();
        let exact = transmittance(&subject.profile);
        let deviation = (exact.transmittance - subject.facts.transmittance).abs();
        assert!(deviation < 1e-3 * exact.transmittance, "{exact:?}");
        assert!(deviation < 4.0 * exact.error + 1e-6, "{exact:?} {deviation}");
    }
}

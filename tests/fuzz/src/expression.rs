//! Formulas of extinction.

use fairflight_media::{ExpressionFieldError, ExpressionMedium, ExpressionProfile, Extinction, Medium};
use glam::DVec3;

/// Values at which a formula is evaluated: both zeros, both infinities, denormal and huge numbers among the ordinary.
const AT: [f64; 12] =
    [0.0, -0.0, 0.3, 1.0, -1.5, 1e-9, 5e-324, 1e15, 1e308, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];

/// A formula is refused at a column that it has, or it has a value (NaN is one) at every number: the same each time, the same in
/// parentheses, and the same in the variables of a profile and of a medium.
pub fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let profile = match ExpressionProfile::new(text, 1.0, None) {
        Ok(profile) => profile,
        Err(error) => {
            let ExpressionFieldError::Expression(error) = error else { panic!("refused: {error}") };
            assert!((1..=text.chars().count() + 1).contains(&error.column), "{error}");
            assert!(!error.message.trim().is_empty());
            let _ = ExpressionMedium::new(text, None).map(|medium| medium.sigma_t(DVec3::splat(0.7)));
            return;
        }
    };
    // Nothing but depth can be wrong with one more pair of parentheses.
    let enclosed = ExpressionProfile::new(&format!("({text})"), 1.0, None).ok();
    for s in AT {
        let value = profile.sigma_t(s);
        assert!(same(value, profile.sigma_t(s)));
        if let Some(enclosed) = &enclosed {
            assert!(same(value, enclosed.sigma_t(s)), "({text}) at {s}: {} for {value}", enclosed.sigma_t(s));
        }
    }
    if let Ok(medium) = ExpressionMedium::new(text, None) {
        // Without `s` both are constants.
        assert!(same(profile.sigma_t(0.3), medium.sigma_t(DVec3::new(0.1, -2.0, 9.0))));
    }
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

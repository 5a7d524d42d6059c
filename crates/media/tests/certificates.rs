//! No certificate is wrong beyond its stated error.

mod sums;

use fairflight_media::{Certificate, ExpressionProfile, Tolerance};
use sums::Sum;

#[test]
fn sums_of_terms_with_closed_forms_are_within_their_stated_errors() {
    let mut certified = 0;
    const COUNT: u64 = 500;
    for seed in 0..COUNT {
        let sum = Sum::random(seed);
        let profile = ExpressionProfile::new(&sum.formula, sum.length, None).unwrap();
        let found = Certificate::of(&profile, Tolerance::TIGHT);
        let allowed = sum.rounding;
        assert!(
            found.bounds.0 - allowed <= sum.integral && sum.integral <= found.bounds.1 + allowed,
            "seed {seed}: {} over {}: {} is not within {:?}",
            sum.formula,
            sum.length,
            sum.integral,
            found.bounds
        );
        certified += u64::from(found.doubt().is_none());
    }
    // Refusing all of them would be no feat.
    assert!(certified >= COUNT * 99 / 100, "{certified} certified");
}

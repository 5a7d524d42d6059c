//! Every wrong twin is rejected, at the z that it states.

use fairflight_catalogue::{Evident, Law, check_level, twins};
use fairflight_laws::Run;
use fairflight_stats::normal::two_sided_quantile;
use fairflight_tests::{SEED, run_checks};

#[test]
fn every_twin_is_rejected_in_the_catalogue() {
    let passed: Vec<String> = run_checks(|check| check.law == Law::WrongTwin)
        .iter()
        .filter(|(_, result)| result.holds != Some(true))
        .map(|(check, result)| format!("{}: {}", check.id, result.reason))
        .collect();
    assert!(passed.is_empty(), "{passed:#?}");
}

#[test]
fn every_twin_shows_the_z_that_it_states() {
    let alpha = check_level();
    for twin in twins() {
        let rejection = twin.run(Run { samples: twin.samples, seed: SEED, alpha });
        let (measured, stated) = match twin.evident {
            Evident::Exactly => {
                println!("{:36} exactly: {}", twin.id, rejection.reason);
                assert!(rejection.rejected && twin.samples == 0, "{}", twin.id);
                continue;
            }
            Evident::Mean { z } => (rejection.mean_z, z),
            Evident::Variance { z } => (rejection.variance_z, z),
        };
        let measured = measured.unwrap().abs();
        println!("{:36} |z| = {measured:7.1}, stated {stated:6.1}, N = {}", twin.id, twin.samples);
        // Far above what is critical at the corrected level, and where it was said to be.
        assert!(measured > 3.0 * two_sided_quantile(alpha / 4.0), "{}: {measured}", twin.id);
        assert!((measured / stated - 1.0).abs() < 0.15, "{}: {measured} for {stated}", twin.id);
    }
}

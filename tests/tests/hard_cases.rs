//! Every hard case is right, or refused where it must be.

use fairflight_catalogue::{Law, ROWS, hard_cases};
use fairflight_laws::Run;
use fairflight_tests::{SEED, run_checks};

#[test]
fn every_hard_case_passes() {
    for (check, result) in run_checks(|check| check.law == Law::HardCase) {
        assert_eq!(result.holds, Some(true), "{}: {}", check.id, result.reason);
    }
}

#[test]
fn every_row_has_a_case() {
    let mut rows: Vec<u32> = hard_cases().iter().map(|case| case.number).collect();
    rows.dedup();
    assert_eq!(rows, ROWS.map(|(number, _)| number));
}

#[test]
fn a_broken_medium_is_refused_and_nothing_else_is() {
    for case in hard_cases() {
        let outcome = case.run(Run { samples: case.samples.min(1000), seed: SEED, alpha: 1e-9 });
        assert_eq!(outcome.refused, case.refusal, "{}: {}", case.title, outcome.ours);
        assert!(case.refusal || case.number != 15, "{}", case.title);
        if outcome.refused {
            assert!(outcome.ours.contains(" at s = "), "the point is named: {}", outcome.ours);
        }
    }
}

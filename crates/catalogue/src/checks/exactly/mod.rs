//! Checks without chance: decisions, densities, closed forms and connections, each by itself.

mod closed_forms;
mod connections;
mod decisions;
mod densities;
mod variances;

use super::{Check, Law};
use crate::function::joined;
use fairflight_laws::CheckResult;

/// The inputs of these checks are lawful: a constructor that refuses one is a bug here.
const LAWFUL: &str = "the catalogue's exact inputs are lawful";

/// Checks without chance, for the catalogue.
pub(super) fn checks() -> Vec<Check> {
    joined!(checks of decisions, densities, closed_forms, variances, connections)
}

/// A check of this file that draws nothing.
fn check(
    name: &str,
    estimator: &str,
    medium: &str,
    function: impl Fn() -> CheckResult + Send + Sync + 'static,
) -> Check {
    Check::new(format!("exact/{name}"), Law::Exact, estimator, medium, 0, move |_| function())
}

#[cfg(test)]
mod tests {
    use super::checks;
    use crate::Effort;

    #[test]
    fn all_hold_whatever_the_seed_and_each_sees_more_than_rounding() {
        let mut broken = Vec::new();
        for check in checks() {
            let result = check.run(Effort::Quick, 1, 1e-9);
            assert_eq!((result.samples, check.samples(Effort::Full)), (0, 0), "{}", check.id);
            if result.holds != Some(true) {
                broken.push(format!("{}: {}", check.id, result.reason));
            }
        }
        assert!(broken.is_empty(), "{broken:#?}");
    }
}

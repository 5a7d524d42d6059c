//! Work that is bounded: what a run is expected to look up is known from its rates before anything is drawn.

use crate::Failure;
use crate::field::AnyProfile;
use cpu_time::ThreadTime;

/// Number of look-ups that a run may be expected to make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget(f64);

impl Budget {
    /// The budget without a word on the command line: at 30 ns a look-up, fifty minutes on one core.
    pub const USUAL: Self = Self(1e11);

    /// The budget of so many look-ups.
    #[must_use]
    pub fn of(lookups: f64) -> Self {
        Self(lookups)
    }

    /// Checks that a run of so many look-ups may start; `key` is what they come from, `because` says how.
    ///
    /// # Errors
    /// If they are more, or nobody can tell.
    pub fn check(self, key: &str, lookups: f64, because: &str) -> Result<(), Failure> {
        if lookups <= self.0 {
            return Ok(());
        }
        Err(Failure::refused(format!(
            "{key}: {lookups:.3e} look-ups are to be expected ({because}), more than the budget of {:e}; --budget allows more",
            self.0
        )))
    }
}

/// Time of an estimate beside a look-up \[s\]: a variate, a logarithm and a few branches take 8 to 12 ns, and
/// the code that puts them together as much again (`cargo bench --bench lookups`).
const BESIDE: f64 = 20e-9;
/// An hour \[s\].
const LONG: f64 = 3600.0;

/// A warning where so many look-ups, of `seconds` each, take more than an hour on the threads of the current
/// pool.
#[must_use]
pub fn patience(lookups: f64, seconds: f64) -> Option<String> {
    let threads = rayon::current_num_threads() as f64;
    let estimate = lookups * (seconds + BESIDE) / threads;
    (estimate > LONG).then(|| {
        format!(
            "this will take about {:.1} hours: {lookups:.1e} look-ups, each {:.0} ns with what belongs to it, on {threads} threads",
            estimate / 3600.0,
            1e9 * (seconds + BESIDE)
        )
    })
}

/// CPU seconds of a look-up of a profile, measured: the least of a few rounds, each over distances that jump
/// about as those of a walk do.
#[must_use]
pub fn seconds_per_lookup(profile: &AnyProfile) -> f64 {
    const ROUNDS: u32 = 5;
    const LOOKUPS: u32 = 512;
    let field = profile.field();
    // Multiples of the golden ratio, modulo 1, are even and in no order.
    let distances = |i: u32| field.length() * (f64::from(i) * 0.618_033_988_749_894_9).fract();
    let round = |_| {
        let clock = ThreadTime::now();
        let sum: f64 = (0..LOOKUPS).map(|i| field.sigma_t(distances(i))).sum();
        std::hint::black_box(sum);
        clock.elapsed().as_secs_f64() / f64::from(LOOKUPS)
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_can_tell_is_too_much() {
        let budget = Budget::of(10.0);
        assert!(budget.check("key", 10.0, "").is_ok());
        for lookups in [10.5, f64::INFINITY, f64::NAN] {
            let failure = budget.check("estimator.teeth", lookups, "of 3 samples").unwrap_err();
            assert_eq!(failure.code(), crate::REFUSED);
            let text = failure.to_string();
            assert!(
                text.starts_with("refused: estimator.teeth: ") && text.contains("budget of 1e1;"),
                "{text}"
            );
        }
        assert!(Budget::USUAL.check("key", 1e11, "").is_ok());
    }

    #[test]
    fn an_hour_is_worth_a_word() {
        let threads = rayon::current_num_threads() as f64;
        assert_eq!(patience(0.99 * threads * LONG / BESIDE, 0.0), None);
        assert!(patience(1.01 * threads * LONG / BESIDE, 0.0).unwrap().contains("about 1.0 hours"));
        assert!(patience(1e9 * threads, 8e-6).unwrap().contains("about 2.2 hours"));
    }
}

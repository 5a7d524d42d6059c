//! Roots of monotone conditions by halving an interval.

/// The interval between `low`, where the condition does not hold, and `high`, where it does, halved until it is no wider than
/// `width(high)`.
pub(crate) fn halved(
    (mut low, mut high): (f64, f64),
    width: impl Fn(f64) -> f64,
    holds: impl Fn(f64) -> bool,
) -> (f64, f64) {
    while high - low > width(high) {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    (low, high)
}

/// The last whole number of which the condition does not hold, and the first of which it does: `low` and `high`, or between them.
pub(crate) fn halved_whole((mut low, mut high): (u64, u64), holds: impl Fn(u64) -> bool) -> (u64, u64) {
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    (low, high)
}

/// The least number above 0 of which the monotone condition holds, from above to a relative 1e-12; `guess` is where the search begins.
pub(crate) fn quantile(guess: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, guess);
    while !holds(high) {
        (low, high) = (high, 2.0 * high);
    }
    halved((low, high), |high| 1e-12 * high, holds).1
}

//! The expectation over the variate of a decision.

use fairflight_sources::LARGEST_VARIATE;

/// Number of variates at which a function is tried first: steps that are closer together than 1/PROBES may be missed.
const PROBES: u32 = 256;

/// E\[f(u)\] over one uniform variate, for an f that is constant in pieces: a decision, and what it leads to.
///
/// Between two probes at which f differs the border is found by halving, to neighbouring numbers: the result is exact to
/// rounding, so that a probability that is off in its eleventh digit shows. Pieces shorter than 1/256 that lie between two equal
/// probes are not seen.
///
/// ```
/// use fairflight_laws::exact::decisions::expectation;
///
/// let survives = |probability: f64| expectation(|u| if u < probability { 1.0 } else { 0.0 });
/// assert!((survives(0.3) - 0.3).abs() < 1e-15);
/// ```
pub fn expectation(mut f: impl FnMut(f64) -> f64) -> f64 {
    let [mean] = expectations(|u| [f(u)]);
    mean
}

/// The same of several functions of one variate at once. A border of one is looked for on behalf of all: a short piece between two
/// different neighbours is found, however short it is.
pub fn expectations<const K: usize>(mut f: impl FnMut(f64) -> [f64; K]) -> [f64; K] {
    let mut sums = [0.0; K];
    let (mut from, mut values) = (0.0, f(0.0));
    for i in 1..=PROBES {
        let to = (f64::from(i) / f64::from(PROBES)).min(LARGEST_VARIATE);
        let next = f(to);
        add_between((from, values), (to, next), &mut f, &mut sums);
        (from, values) = (to, next);
    }
    // The last number stands for itself.
    add(&mut sums, values, 1.0 - from);
    sums
}

/// Adds ∫ f over `[from, to)`.
fn add_between<const K: usize>(
    (from, at_from): (f64, [f64; K]),
    (to, at_to): (f64, [f64; K]),
    f: &mut impl FnMut(f64) -> [f64; K],
    sums: &mut [f64; K],
) {
    let middle = 0.5 * (from + to);
    if at_from == at_to || middle <= from || middle >= to {
        add(sums, at_from, to - from);
        return;
    }
    let at_middle = f(middle);
    add_between((from, at_from), (middle, at_middle), f, sums);
    add_between((middle, at_middle), (to, at_to), f, sums);
}

fn add<const K: usize>(sums: &mut [f64; K], values: [f64; K], length: f64) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += value * length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_found_wherever_they_are() {
        for probability in [0.0, 1e-9, 0.25, 0.5, 0.812_345_678_9, 1.0 - 1e-12, 1.0] {
            let found = expectation(|u| if u < probability { 2.0 } else { -1.0 });
            assert!((found - (3.0 * probability - 1.0)).abs() < 1e-14, "{probability}: {found}");
        }
        // Three outcomes between two probes.
        let found = expectation(|u| {
            if u < 0.3 {
                1.0
            } else if u < 0.3005 {
                5.0
            } else {
                2.0
            }
        });
        assert!((found - (0.3 + 0.0025 + 2.0 * 0.6995)).abs() < 1e-14);
    }

    #[test]
    fn a_short_piece_between_two_others_is_found() {
        // A billionth at 0.3, between two outcomes that are 0 of it.
        let outcome = |u: f64| {
            if u < 0.3 {
                [1.0, 0.0]
            } else if u < 0.300_000_001 {
                [0.0, 1.0]
            } else {
                [0.0; 2]
            }
        };
        let [first, second] = expectations(outcome);
        assert!((first - 0.3).abs() < 1e-15 && (second - 1e-9).abs() < 1e-15, "{first} {second}");
    }

    #[test]
    fn a_probability_that_is_off_by_a_millionth_shows() {
        let found = expectation(|u| if u < 0.4 * (1.0 + 1e-6) { 1.0 } else { 0.0 });
        assert!((found - 0.4 - 4e-7).abs() < 1e-15);
    }
}

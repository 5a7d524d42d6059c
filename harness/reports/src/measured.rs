//! A measured number with its 95 % interval.

use fairflight_document::{Cell, Mark};
use fairflight_stats::{Moments, student_two_sided_quantile};

/// The probability that an interval misses.
const MISSES: f64 = 0.05;

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) interval: [f64; 2],
}

impl Measured {
    /// The interval that reaches as far up as down.
    fn within(value: f64, half_width: f64) -> Self {
        Self { value, interval: [value - half_width, value + half_width] }
    }

    /// A mean of very many, with this standard error: the normal law.
    pub(super) fn normal(value: f64, standard_error: f64) -> Self {
        Self::within(value, 1.96 * standard_error)
    }

    /// The mean of a few independent numbers, by Student's law.
    pub(super) fn mean(values: &[f64]) -> Self {
        let (mean, error) = mean_and_error(values);
        Self::within(mean, quantile(values) * error)
    }

    /// The mean of a few independent positive numbers, by Student's law of their logarithms: errors multiply.
    pub(super) fn positive(values: &[f64]) -> Self {
        let value = mean_and_error(values).0;
        if values.iter().any(|&x| x <= 0.0) {
            return Self { value, interval: [f64::NAN; 2] };
        }
        let logarithms: Vec<f64> = values.iter().map(|x| x.ln()).collect();
        Self::multiplied(value, (quantile(values) * mean_and_error(&logarithms).1).exp())
    }

    /// A statistic of two groups of independent elements, by the jackknife: `of` leaves out one element of either, or none. Student's law of
    /// the smaller group.
    pub(super) fn jackknife(sizes: [usize; 2], of: impl Fn([Option<usize>; 2]) -> f64) -> Self {
        let squares = [0, 1].map(|group| {
            let without = |k| of(if group == 0 { [Some(k), None] } else { [None, Some(k)] });
            let scatter = Moments::from_slice(&(0..sizes[group]).map(without).collect::<Vec<_>>());
            let others = sizes[group] as f64 - 1.0;
            others * others / (others + 1.0) * scatter.sample_variance().unwrap_or(f64::NAN)
        });
        let degrees = sizes[0].min(sizes[1]).saturating_sub(1).max(1) as u64;
        let quantile = student_two_sided_quantile(MISSES, degrees);
        Self::within(of([None; 2]), quantile * squares.iter().sum::<f64>().sqrt())
    }

    /// The variance of independent normal numbers. That of its logarithm is 2/(n − 1).
    pub(super) fn variance(values: &[f64]) -> Self {
        let variance = Moments::from_slice(values).sample_variance().unwrap_or(f64::NAN);
        Self::multiplied(variance, (1.96 * (2.0 / (values.len() - 1) as f64).sqrt()).exp())
    }

    /// The interval of an error that multiplies, by up to `factor`.
    fn multiplied(value: f64, factor: f64) -> Self {
        Self { value, interval: [value / factor, value * factor] }
    }

    /// The ratio of two independent ones, their relative errors added in squares.
    pub(super) fn over(self, other: &Self) -> Self {
        let half = |m: &Self| 0.5 * (m.interval[1] / m.interval[0]).ln();
        Self::multiplied(self.value / other.value, half(&self).hypot(half(other)).exp())
    }

    /// "value \[low, high\]" with so many digits behind the point.
    pub(super) fn words(&self, digits: usize) -> String {
        let [low, high] = self.interval;
        format!("{:.digits$} [{low:.digits$}, {high:.digits$}]", self.value)
    }

    /// A decreasing or increasing function of it.
    pub(super) fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let [a, b] = self.interval.map(&function);
        Self { value: function(self.value), interval: [a.min(b), a.max(b)] }
    }

    /// True if it is certainly below another one: the intervals are apart.
    pub(super) fn is_below(&self, other: &Self) -> bool {
        self.interval[1] < other.interval[0]
    }

    /// Verdict on exceeding `limit`: certainly so, certainly not, or none where the interval holds the limit.
    pub(super) fn exceeds(&self, limit: f64) -> Option<bool> {
        let [low, high] = self.interval;
        if low > limit { Some(true) } else { (high < limit).then_some(false) }
    }

    /// The cell of a table.
    pub(super) fn cell(&self) -> Cell {
        Cell::measured(self.value, self.interval)
    }

    /// The mark of a chart at `x`.
    pub(super) fn mark(&self, x: f64) -> Mark {
        Mark::measured(x, self.value, self.interval)
    }
}

/// Student's t that the mean of these values is judged by.
fn quantile(values: &[f64]) -> f64 {
    student_two_sided_quantile(MISSES, values.len().saturating_sub(1).max(1) as u64)
}

/// The mean of independent numbers and its standard error, NaN where there is none.
pub(super) fn mean_and_error(values: &[f64]) -> (f64, f64) {
    // An image of one sample per pixel knows no variance.
    if values.iter().any(|value| !value.is_finite()) {
        return (f64::NAN, f64::NAN);
    }
    let moments = Moments::from_slice(values);
    (moments.mean().unwrap_or(f64::NAN), moments.standard_error().unwrap_or(f64::NAN))
}

/// "0.93 (0.8 to 1)": a value and the range of those that cannot be told from it, where it has a width.
pub(super) fn with_range(value: f64, [low, high]: [f64; 2]) -> String {
    if low < high { format!("{value} ({low} to {high})") } else { value.to_string() }
}

/// The sentence on the optimum of a curve at `value`, and on the range of values that cannot be told from it.
pub(super) fn optimum_caption(subject: &str, value: f64, [low, high]: [f64; 2]) -> String {
    let rest = match low < high {
        true => format!("values from {low} to {high} cannot be told from it"),
        false => "no other value that was measured is as good".to_owned(),
    };
    format!("{subject} at σ_samp = {value}; {rest}.")
}

/// The element of the least `price`, and the least and greatest `place` of those whose price cannot be told from it.
///
/// # Panics
/// Without elements.
pub(super) fn least<T>(elements: &[T], price: fn(&T) -> &Measured, place: fn(&T) -> f64) -> (&T, [f64; 2]) {
    let order = |a: &&T, b: &&T| price(a).value.total_cmp(&price(b).value);
    let best = elements.iter().min_by(order).expect("there are elements");
    let close = elements.iter().filter(|element| !price(best).is_below(price(element))).map(place);
    let range = close.fold([f64::INFINITY, 0.0], |[low, high], x| [x.min(low), x.max(high)]);
    (best, range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_told_where_it_has_a_width() {
        assert_eq!(with_range(0.93, [0.8, 1.0]), "0.93 (0.8 to 1)");
        assert_eq!(with_range(1.0, [1.0, 1.0]), "1");
        let alone = optimum_caption("The least error is", 0.6, [0.6, 0.6]);
        assert_eq!(alone, "The least error is at σ_samp = 0.6; no other value that was measured is as good.");
    }

    #[test]
    fn an_interval_of_twelve_is_that_of_eleven_degrees() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        let mean = Measured::mean(&values);
        // Variance 13, t = 2.201.
        let half = 2.201 * (13.0_f64 / 12.0).sqrt();
        assert!((mean.value - 5.5).abs() < 1e-12 && (mean.interval[1] - 5.5 - half).abs() < 1e-3, "{mean:?}");
    }

    #[test]
    fn errors_of_positive_numbers_multiply() {
        let [low, high] = Measured::positive(&[1.0, 4.0]).interval;
        // Logarithms 0 and ln 4: standard error ln 2, t = 12.706.
        let factor = (12.706_f64 * 2.0_f64.ln()).exp();
        assert!((high / 2.5 / factor - 1.0).abs() < 1e-3 && (2.5 / low / factor - 1.0).abs() < 1e-3);
        assert!(Measured::positive(&[1.0, 0.0]).interval[0].is_nan());
        assert!(Measured::positive(&[f64::NAN; 2]).value.is_nan());
    }

    #[test]
    fn the_jackknife_of_a_difference_of_means_is_its_error() {
        let groups = [vec![1.0, 2.0, 6.0], vec![0.5, 0.0, 4.0, 2.5]];
        let mean = |group: usize, without: Option<usize>| {
            let kept = groups[group].iter().enumerate().filter(|(k, _)| Some(*k) != without);
            let kept: Vec<f64> = kept.map(|(_, &x)| x).collect();
            kept.iter().sum::<f64>() / kept.len() as f64
        };
        let found = Measured::jackknife([3, 4], |[a, b]| mean(0, a) - mean(1, b));
        // Sample variances 7 and 41/12 over 3 and 4; t of two degrees is 4.3027.
        let half = 4.3027 * (7.0_f64 / 3.0 + 41.0 / 48.0).sqrt();
        assert!(
            (found.value - 1.25).abs() < 1e-12 && (found.interval[1] - 1.25 - half).abs() < 1e-3,
            "{found:?}"
        );
    }

    #[test]
    fn an_interval_that_holds_a_limit_says_nothing() {
        let measured = Measured::within(1.0, 0.1);
        assert_eq!([0.8, 1.05, 1.2].map(|limit| measured.exceeds(limit)), [Some(true), None, Some(false)]);
    }

    #[test]
    fn what_cannot_be_told_from_the_least() {
        let of = |value: f64| (value, Measured::within(value, 1.0));
        let elements = [of(5.0), of(2.0), of(3.5), of(4.5)];
        let (best, range) = least(&elements, |element| &element.1, |element| element.0);
        assert_eq!((best.0, range), (2.0, [2.0, 3.5]));
    }
}

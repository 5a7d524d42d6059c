//! One axis: its range, its ticks, their labels.

use super::super::number::power_of_ten;

/// The values of a plot; on a logarithmic axis they are given as log10.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    title: String,
    logarithmic: bool,
    low: f64,
    high: f64,
}

/// A tick and its label; the label is empty for a minor tick.
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: String,
}

impl Axis {
    /// A linear axis around these values.
    pub(crate) fn linear(title: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = extent(values).unwrap_or((0.0, 1.0));
        let margin = if high > low { 0.03 * (high - low) } else { 0.5 };
        Self { title: title.to_owned(), logarithmic: false, low: low - margin, high: high + margin }
    }

    /// A linear axis that shows exactly this range.
    pub(crate) fn exactly(title: &str, low: f64, high: f64) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        Self { title: title.to_owned(), logarithmic: false, low, high }
    }

    /// A logarithmic axis around values given as log10, a little wider than they are.
    pub(crate) fn logarithmic(title: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = extent(values).unwrap_or((0.0, 1.0));
        let margin = if high > low { 0.02 * (high - low) } else { 0.5 };
        Self { title: title.to_owned(), logarithmic: true, low: low - margin, high: high + margin }
    }

    /// A logarithmic axis that shows exactly this range, given as log10.
    pub(crate) fn exactly_logarithmic(title: &str, low: f64, high: f64) -> Self {
        Self { logarithmic: true, ..Self::exactly(title, low, high) }
    }

    /// A logarithmic axis of whole decades around values given as log10, between these limits.
    pub(crate) fn decades(title: &str, values: impl IntoIterator<Item = f64>, limits: [f64; 2]) -> Self {
        let (low, high) = extent(values).unwrap_or((-1.0, 1.0));
        let low = low.floor().clamp(limits[0], limits[1] - 1.0);
        let high = high.ceil().clamp(low + 1.0, limits[1].max(low + 1.0));
        Self { title: title.to_owned(), logarithmic: true, low, high }
    }

    /// What is on it.
    pub(crate) fn title(&self) -> &str {
        &self.title
    }

    /// The range that is shown, as log10 on a logarithmic axis.
    pub(crate) fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Whether a value is shown.
    pub(crate) fn shows(&self, x: f64) -> bool {
        (self.low..=self.high).contains(&x)
    }

    /// Place between the ends, 0 to 1 inside.
    pub(crate) fn fraction(&self, x: f64) -> f64 {
        (x - self.low) / (self.high - self.low)
    }

    /// About `count` labelled ticks, and unlabelled ones between them.
    pub(super) fn ticks(&self, count: usize) -> Vec<Tick> {
        let ticks = if self.logarithmic { self.logarithmic_ticks(count) } else { self.linear_ticks(count) };
        ticks.into_iter().filter(|tick| self.shows(tick.at)).collect()
    }

    fn linear_ticks(&self, count: usize) -> Vec<Tick> {
        let step = nice_ceil((self.high - self.low) / count as f64);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last)
            .map(|k| Tick { at: k as f64 * step, label: format!("{:.decimals$}", k as f64 * step) })
            .collect()
    }

    fn logarithmic_ticks(&self, count: usize) -> Vec<Tick> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let decades = self.high - self.low;
        // A short axis has too few powers of ten: it is labelled 1, 2, 5.
        let dense = decades < 2.3;
        let stride = ((decades / count as f64).ceil() as i32).max(1);
        let minors = if decades <= 8.0 { 2..10 } else { 2..2 };
        let mut ticks = Vec::new();
        for exponent in first..=last {
            let major = match (exponent.rem_euclid(stride) == 0, dense) {
                (true, true) => few_digits(1, exponent),
                (true, false) => power_of_ten(exponent),
                (false, _) => String::new(),
            };
            ticks.push(Tick { at: f64::from(exponent), label: major });
            for digit in minors.clone() {
                let labelled = dense && (digit == 2 || digit == 5);
                let label = if labelled { few_digits(digit, exponent) } else { String::new() };
                ticks.push(Tick { at: f64::from(exponent) + f64::from(digit).log10(), label });
            }
        }
        ticks
    }
}

/// One digit times a power of ten, as a decimal fraction unless that is long.
fn few_digits(digit: i32, exponent: i32) -> String {
    match exponent {
        -3..=-1 => {
            format!("{:.*}", exponent.unsigned_abs() as usize, f64::from(digit) * 10_f64.powi(exponent))
        }
        0..=3 => format!("{}", digit * 10_i32.pow(exponent.unsigned_abs())),
        _ if digit == 1 => power_of_ten(exponent),
        _ => format!("{digit}·{}", power_of_ten(exponent)),
    }
}

/// The least and the greatest finite value.
fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|x| x.is_finite()).fold(None, |range, x| {
        let (low, high) = range.unwrap_or((x, x));
        Some((f64::min(low, x), f64::max(high, x)))
    })
}

/// The least of 1, 2, 5 times a power of ten that is not below a positive number.
pub(crate) fn nice_ceil(x: f64) -> f64 {
    let power = 10_f64.powf(x.log10().floor());
    let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= x * (1.0 - 1e-9)).unwrap_or(10.0);
    digit * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, count: usize) -> Vec<String> {
        axis.ticks(count).into_iter().map(|tick| tick.label).filter(|label| !label.is_empty()).collect()
    }

    #[test]
    fn decades_are_labelled_as_powers() {
        let axis = Axis::decades("", [-1.5, 2.5], [-6.0, 12.0]);
        assert_eq!(axis.range(), [-2.0, 3.0]);
        assert_eq!(labels(&axis, 6), ["10⁻²", "10⁻¹", "10⁰", "10¹", "10²", "10³"]);
    }

    #[test]
    fn enormous_ranges_are_limited() {
        let axis = Axis::decades("", [-40.0, f64::INFINITY, 300.0], [-6.0, 12.0]);
        assert_eq!(axis.range(), [-6.0, 12.0]);
        assert_eq!(labels(&axis, 7).len(), 7);
    }

    #[test]
    fn empty_and_constant_values_still_make_an_axis() {
        assert!(labels(&Axis::linear("", []), 5).len() > 2);
        assert!(labels(&Axis::linear("", [3.0, 3.0]), 5).len() > 2);
        let same = Axis::decades("", [0.0, 0.0], [-6.0, 12.0]).range();
        assert!(same[1] > same[0]);
    }

    #[test]
    fn short_ranges_are_labelled_in_between() {
        assert_eq!(labels(&Axis::logarithmic("", [-0.9, 0.8]), 6), ["0.2", "0.5", "1", "2", "5"]);
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(&Axis::exactly("", 0.0, 1.0), 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    }

    #[test]
    fn nice_numbers_are_not_below() {
        for (x, nice) in [(0.3, 0.5), (0.2, 0.2), (7.0, 10.0), (1.01, 2.0)] {
            assert!((nice_ceil(x) - nice).abs() < 1e-12, "{x}");
        }
    }
}

//! Axes in units of lengths: a logarithmic one is linear in log10.

use crate::{Axis, Scale, power_of_ten};

/// A logarithmic axis goes no further below its greatest value: the rest of the curves would be flat.
const DECADES: f64 = 12.0;

/// The stretch of an axis that is drawn, in its units of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) low: f64,
    pub(crate) high: f64,
    scale: Scale,
}

/// A value in units of length: its log10 on a logarithmic axis, minus infinity for zero, and no number for a negative value.
pub(crate) fn on(axis: &Axis, value: f64) -> f64 {
    match axis.scale {
        Scale::Linear => value,
        Scale::Logarithmic if value >= 0.0 => value.log10(),
        Scale::Logarithmic => f64::NAN,
    }
}

impl Stretch {
    /// The range of the axis, or all values with a little room.
    pub(crate) fn of(axis: &Axis, values: impl IntoIterator<Item = f64>) -> Self {
        let scale = axis.scale;
        if let Some(range) = axis.range {
            let [low, high] = range.map(|end| on(axis, end));
            return Self { low, high, scale };
        }
        let finite = values.into_iter().map(|value| on(axis, value)).filter(|place| place.is_finite());
        let [low, high] =
            finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        let [mut low, mut high] = if low <= high { [low, high] } else { [0.0, 1.0] };
        if scale == Scale::Logarithmic {
            low = low.max(high - DECADES);
        }
        let room = if high > low { 0.03 * (high - low) } else { 0.5_f64.max(0.1 * high.abs()) };
        (low, high) = (low - room, high + room);
        Self { low, high, scale }
    }

    /// The same stretch, whose ends are those of whole decades, or round numbers. A decade more would leave half of two empty.
    pub(crate) fn rounded(self) -> Self {
        let step = match self.scale {
            Scale::Logarithmic if self.high - self.low > 2.2 => 1.0,
            Scale::Logarithmic => return self,
            Scale::Linear => nice_step((self.high - self.low) / 6.0),
        };
        // The room of a stretch is no reason to show a step more.
        let slack = 0.031 * (self.high - self.low) / 1.06;
        let low = ((self.low + slack) / step + 1e-9).floor() * step;
        let high = ((self.high - slack) / step - 1e-9).ceil() * step;
        Self { low, high, ..self }
    }

    /// True for places within the stretch.
    pub(crate) fn contains(&self, place: f64) -> bool {
        (self.low..=self.high).contains(&place)
    }

    /// About `count` places with their labels; none for none.
    pub(crate) fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        let span = self.high - self.low;
        match self.scale {
            _ if count == 0 => Vec::new(),
            Scale::Linear => {
                let step = nice_step(span / count as f64);
                let decimals = usize::try_from((-step.log10().floor()).max(0.0) as i64).unwrap_or(0);
                self.multiples(step)
                    .map(|(_, place)| (place, format!("{place:.decimals$}").replace('-', "−")))
                    .collect()
            }
            Scale::Logarithmic if span > 2.2 => {
                let step = (span / count as f64).ceil().max(1.0);
                self.multiples(step).map(|(_, place)| (place, power_of_ten(place.round() as i32))).collect()
            }
            Scale::Logarithmic => {
                let decades = self.low.floor() as i32..=self.high.ceil() as i32;
                let digits: &[u32] = if span > 0.7 { &[1, 2, 5] } else { &[1, 2, 3, 4, 5, 6, 7, 8, 9] };
                let values =
                    decades.flat_map(|decade| digits.iter().map(move |&digit| (digit, 10_f64.powi(decade))));
                values
                    .map(|(digit, power)| (f64::from(digit) * power, power))
                    .filter(|(value, _)| self.contains(value.log10()))
                    .map(|(value, power)| {
                        let exponent = power.log10().round() as i32;
                        let decimals = usize::try_from(-exponent).unwrap_or(0);
                        let label = if (-3..5).contains(&exponent) {
                            format!("{value:.decimals$}")
                        } else {
                            format!("{}·{}", (value / power).round(), power_of_ten(exponent))
                        };
                        (value.log10(), label)
                    })
                    .collect()
            }
        }
    }

    fn multiples(&self, step: f64) -> impl Iterator<Item = (i64, f64)> {
        let ends = [(self.low / step - 1e-9).ceil(), (self.high / step + 1e-9).floor()].map(|end| end as i64);
        (ends[0]..=ends[1]).map(move |k| (k, k as f64 * step))
    }
}

/// A round number of about this size: 1, 2 or 5 times a power of ten, at least `step`.
fn nice_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|&nice| nice >= step * 0.999)
        .unwrap_or(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(stretch: Stretch) -> Vec<String> {
        stretch.ticks(6).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round() {
        let linear = Stretch::of(&Axis::linear("").within(0.0, 1.0), []);
        assert_eq!(labels(linear), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let decades = Stretch::of(&Axis::logarithmic("").within(1e-2, 1e3), []);
        assert_eq!(labels(decades), ["10⁻²", "10⁻¹", "10⁰", "10¹", "10²", "10³"]);
        let short = Stretch::of(&Axis::logarithmic("").within(0.13, 3.0), []);
        assert_eq!(labels(short), ["0.2", "0.5", "1", "2"]);
        let small = Stretch::of(&Axis::logarithmic("").within(1e-8, 3e-8), []);
        assert_eq!(labels(small), ["1·10⁻⁸", "2·10⁻⁸", "3·10⁻⁸"]);
        assert!(Stretch::of(&Axis::linear(""), []).ticks(0).is_empty());
        let negative = Stretch::of(&Axis::linear("").within(-10.0, 10.0), []);
        assert_eq!(labels(negative), ["−10", "−5", "0", "5", "10"]);
    }

    #[test]
    fn values_without_a_place_make_no_axis() {
        let logarithmic = Axis::logarithmic("");
        let stretch = Stretch::of(&logarithmic, [1e-40, 0.0, -1.0, f64::INFINITY, 1e3]);
        assert!((stretch.high - 3.0 - 0.36).abs() < 1e-9 && (stretch.low + 9.0 + 0.36).abs() < 1e-9);
        let rounded = stretch.rounded();
        assert_eq!((rounded.low, rounded.high), (-9.0, 3.0));
        let short = Stretch::of(&logarithmic, [1.1, 19.0]);
        assert_eq!(short.rounded(), short);
        for values in [&[][..], &[3.0], &[0.0]] {
            for axis in [&logarithmic, &Axis::linear("")] {
                let stretch = Stretch::of(axis, values.iter().copied()).rounded();
                assert!(stretch.high > stretch.low && stretch.ticks(5).len() > 1, "{stretch:?}");
            }
        }
    }
}

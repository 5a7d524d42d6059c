//! Numbers for people. Files for machines carry the full precision instead.

/// 10ᵏ in Unicode superscripts.
#[must_use]
pub fn power_of_ten(exponent: i32) -> String {
    let superscript = |c: char| match c.to_digit(10) {
        Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
        None => '⁻',
    };
    format!("10{}", exponent.to_string().chars().map(superscript).collect::<String>())
}

/// Three significant digits.
#[must_use]
pub fn short(x: f64) -> String {
    rounded(x, 3)
}

/// The number with six significant digits: more than a figure shows.
pub(crate) fn drawn(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// A number with its interval, to the second digit of the interval's width: more would say nothing.
#[must_use]
pub fn measured(x: f64, [low, high]: [f64; 2]) -> String {
    let place = |x: f64| x.abs().log10().floor();
    let digits = place(x) - place(high - low) + 2.0;
    // Beyond twelve digits the width is as good as zero, or not a number.
    let digits = if digits.is_finite() { digits.clamp(3.0, 12.0) as usize } else { 3 };
    format!("{} [{}, {}]", rounded(x, digits), rounded(low, digits), rounded(high, digits))
}

/// So many significant digits.
fn rounded(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return if x.is_nan() {
            "—"
        } else if x > 0.0 {
            "∞"
        } else {
            "−∞"
        }
        .to_owned();
    }
    // Rounding may carry into the next decade: the exponent is read from what is written.
    let scientific = format!("{:.*e}", digits - 1, x.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if x < 0.0 { "−" } else { "" };
    if (-3..5).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        format!("{sign}{:.decimals$}", x.abs())
    } else {
        format!("{sign}{mantissa}·{}", power_of_ten(exponent))
    }
}

/// A number given as log10, three significant digits.
#[must_use]
pub fn short_of_log10(log10: f64) -> String {
    if log10.abs() < 300.0 {
        return short(10_f64.powf(log10));
    }
    if !log10.is_finite() {
        return short(if log10 > 0.0 { f64::INFINITY } else { 0.0 });
    }
    format!("{}·{}", short(10_f64.powf(log10 - log10.floor())), power_of_ten(log10.floor() as i32))
}

/// Words joined by commas and "and".
#[must_use]
pub fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_everywhere() {
        let cases = [
            (0.0, "0"),
            (0.8, "0.800"),
            (9.999, "10.0"),
            (12345.0, "12345"),
            (-0.05, "−0.0500"),
            (1.5e7, "1.50·10⁷"),
            (f64::INFINITY, "∞"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn an_interval_decides_how_many_digits_are_told() {
        assert_eq!(measured(0.818_731, [0.818_53, 0.818_93]), "0.81873 [0.81853, 0.81893]");
        assert_eq!(measured(5.0, [1.0, 9.0]), "5.00 [1.00, 9.00]");
        assert_eq!(measured(1.0, [1.0, 1.0]), "1.00 [1.00, 1.00]");
        assert_eq!(measured(0.0, [-0.1, f64::INFINITY]), "0 [−0.100, ∞]");
    }

    #[test]
    fn logarithms_beyond_the_range_of_floats() {
        assert_eq!(short_of_log10(400.0), "1.00·10⁴⁰⁰");
        assert_eq!(short_of_log10(f64::NEG_INFINITY), "0");
    }
}

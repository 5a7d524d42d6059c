//! Accuracy of the difference of two extinctions.

/// Rounding error of σ_t − σ_main \[1/length\], four units of 2⁻⁵² of each: both are off by half a unit where they were read as
/// decimals, by one and a half where they were interpolated, and their own difference by half a one. Where they nearly agree that
/// is large beside the difference; a domain that ends at 0, or at a multiple of σ_samp, is to be judged with it.
#[inline]
#[must_use]
pub fn rounding_of_difference(sigma_t: f64, sigma_main: f64) -> f64 {
    4.0 * f64::EPSILON * (sigma_t.abs() + sigma_main.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_that_differ_by_a_decimal_do_so_within_it() {
        for i in 1..2000 {
            let (sigma_t, main) = (f64::from(i + 7) / 100.0, f64::from(i) / 100.0);
            let found = sigma_t - main;
            assert!((found - 0.07).abs() <= rounding_of_difference(sigma_t, main), "{i}: {found}");
        }
        assert_eq!(rounding_of_difference(0.0, 0.0), 0.0);
    }
}

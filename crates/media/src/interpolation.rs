//! Linear interpolation that keeps its bounds in floating point.

/// (1 − t) a + t b for 0 ≤ t ≤ 1: a at t = 0, b at t = 1.
///
/// **Law.** The result lies between a and b, ends included, and is a where a = b. As rounded, the sum of the two products obeys neither
/// (0.7 from 0.7 to 0.7 is 0.7000000000000001 at some t), and (1 − t) + t may exceed 1 by a rounding, so that two of the largest numbers
/// would add up to infinity: the nearer of a and b stands for what falls outside. NaN stays NaN.
///
/// **Error.** Three roundings: |result − exact| ≤ 3u ((1 − t)|a| + t|b|), u = 2⁻⁵³, and two of the least positive number.
#[inline]
#[must_use]
pub fn lerp(t: f64, a: f64, b: f64) -> f64 {
    between((1.0 - t) * a + t * b, a, b)
}

/// `value`, or the nearer of a and b if it lies beyond. NaN stays NaN, and so does a value beside a NaN: `clamp` would panic there.
#[inline]
pub(crate) fn between(value: f64, a: f64, b: f64) -> f64 {
    let (low, high) = if a <= b { (a, b) } else { (b, a) };
    if value < low {
        low
    } else if value > high {
        high
    } else {
        value
    }
}

/// Bounds of [`lerp`]\(t, a, b\) for t from `from` to `to`, at which it has the values `ends`.
///
/// The exact interpolant is monotone in t, hence within its values at both ends; `lerp` is off by its own rounding there and in between.
/// For a and b of one sign that is relative to the value itself, (1 − t)|a| + t|b|: v ≥ v_end (1 − 3u)/(1 + 3u) > v_end (1 − 8u). For both
/// signs it is relative to the greater of |a| and |b|, however small the value. The range that `lerp` cannot leave bounds it as well.
pub(crate) fn lerp_bounds(ends: [f64; 2], a: f64, b: f64) -> (f64, f64) {
    const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
    /// Two products below the normal numbers, at an end and in between, are off by one of these each.
    const UNDERFLOW: f64 = f64::from_bits(4);
    let (least, greatest) = (a.min(b), a.max(b));
    let of_one_sign = least >= 0.0 || greatest <= 0.0;
    let rounding =
        |end: f64| ROUNDINGS * if of_one_sign { end.abs() } else { a.abs().max(b.abs()) } + UNDERFLOW;
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    ((low - rounding(low)).max(least), (high + rounding(high)).min(greatest))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Numbers of all sizes and both signs: denormal, tiny, ordinary, huge, the largest.
    pub(crate) fn any_number() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => -10.0..10.0_f64,
            1 => (-1..=1_i32, -323..=308_i32).prop_map(|(sign, e)| f64::from(sign) * 10_f64.powi(e)),
            1 => prop::sample::select(vec![0.0, -0.0, 0.7, 5e-324, -5e-324, 1.5e-323, f64::MIN_POSITIVE, f64::MAX, f64::MIN]),
            1 => prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        ]
    }

    #[test]
    fn equal_values_stay_as_they_are() {
        // 0.7 rises by a rounding at some of these.
        let beyond = |t: f64| (1.0 - t) * 0.7 + t * 0.7 > 0.7;
        let at = |i: u32| f64::from(i) / 1000.0;
        assert!((0..=1000).any(|i| beyond(at(i))));
        assert!((0..=1000).all(|i| lerp(at(i), 0.7, 0.7) == 0.7));
    }

    #[test]
    fn what_is_not_a_number_is_not_hidden() {
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN)] {
            assert!(lerp(0.5, a, b).is_nan());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4096, ..ProptestConfig::default() })]

        #[test]
        fn it_lies_between_its_ends_and_attains_them(
            a in any_number(),
            b in any_number(),
            t in prop_oneof![0.0..=1.0_f64, Just(0.0), Just(1.0), Just(5e-324), Just(1.0 - f64::EPSILON / 2.0)],
        ) {
            let value = lerp(t, a, b);
            prop_assert!((a.min(b)..=a.max(b)).contains(&value), "{value}");
            prop_assert_eq!((lerp(0.0, a, b), lerp(1.0, a, b)), (a, b));
            let exact = (1.0 - t) * a + t * b;
            prop_assert!((value - exact).abs() <= f64::EPSILON * a.abs().max(b.abs()) || !exact.is_finite());
        }

        #[test]
        fn a_stretch_keeps_to_the_bounds_of_its_ends(
            a in any_number(),
            b in any_number(),
            cuts in [0.0..=1.0_f64, 0.0..=1.0_f64],
            width in -60..=0_i32,
            at in prop::collection::vec(0.0..=1.0_f64, 40),
        ) {
            // Also stretches of a few representable t.
            let from = cuts[0].min(cuts[1]);
            let to = (from + (cuts[0] - cuts[1]).abs() * 2_f64.powi(width)).min(1.0);
            let (low, high) = lerp_bounds([lerp(from, a, b), lerp(to, a, b)], a, b);
            prop_assert!(a.min(b) <= low && high <= a.max(b));
            for share in at {
                let t = (from + share * (to - from)).clamp(from, to);
                let value = lerp(t, a, b);
                prop_assert!((low..=high).contains(&value), "{value} at {t}, [{low}, {high}]");
            }
        }
    }
}

//! Values against those of 60 digits, lanes against one number, and what every function has to keep.

use fairflight_elementary::{cos, exp, exp_m1, lanes, ln, ln_1p, sin, sin_cos};
use proptest::prelude::*;

/// Distance to the number below, towards 0.
fn ulp(x: f64) -> f64 {
    let x = x.abs().max(f64::MIN_POSITIVE);
    x - x.next_down()
}

/// The greatest error over the vectors, in ulps of the value.
fn greatest_error(vectors: &str, function: impl Fn(f64) -> f64) -> f64 {
    let number = |hexadecimal: &str| f64::from_bits(u64::from_str_radix(hexadecimal, 16).unwrap());
    let lines = vectors.lines().filter(|line| !line.starts_with('#'));
    let errors = lines.map(|line| {
        let [x, rounded, rest]: [f64; 3] =
            line.split(' ').map(number).collect::<Vec<_>>().try_into().unwrap();
        let found = function(x);
        let error = ((found - rounded) - rest).abs() / ulp(rounded);
        assert!(error <= 1.0, "{x:e}: found {found:e}, not {rounded:e}: {error} ulp");
        error
    });
    errors.fold(0.0, f64::max)
}

macro_rules! within_an_ulp {
    ($($name:ident, $greatest:expr;)*) => {
        $(
            #[test]
            fn $name() {
                let error = greatest_error(include_str!(concat!("vectors/", stringify!($name), ".txt")), super::$name);
                println!("{}: {error:.3} ulp", stringify!($name));
                assert!(error < $greatest, "{error}");
            }
        )*
    };
}

mod vectors {
    use super::greatest_error;

    within_an_ulp! {
        ln, 0.51;
        ln_1p, 0.51;
        exp, 0.71;
        exp_m1, 0.62;
        sin, 0.59;
        cos, 0.56;
    }
}

#[test]
fn ends_of_the_ranges() {
    let (infinite, nan) = (f64::INFINITY, f64::NAN);
    assert_eq!([0.0, -0.0, 1.0, infinite].map(ln), [-infinite, -infinite, 0.0, infinite]);
    assert!([-1e-300, -infinite, nan].map(ln).iter().all(|value| value.is_nan()));
    assert_eq!([-1.0, 0.0, infinite].map(ln_1p), [-infinite, 0.0, infinite]);
    assert!([-1.000_000_1, -infinite, nan].map(ln_1p).iter().all(|value| value.is_nan()));
    assert_eq!(
        [0.0, 709.79, 1e300, infinite, -745.2, -1e300, -infinite].map(exp),
        [1.0, infinite, infinite, infinite, 0.0, 0.0, 0.0]
    );
    assert_eq!([0.0, 709.79, infinite, -60.0, -infinite].map(exp_m1), [0.0, infinite, infinite, -1.0, -1.0]);
    assert!(
        [exp(nan), exp_m1(nan), sin(nan), cos(nan), sin(infinite), cos(-infinite)]
            .iter()
            .all(|value| value.is_nan())
    );
    for odd in [ln_1p, exp_m1, sin] {
        assert!(odd(-0.0).is_sign_negative() && odd(-0.0) == 0.0);
        assert_eq!(odd(1e-310), 1e-310);
    }
    assert_eq!((sin(0.0), cos(0.0)), (0.0, 1.0));
}

/// Any number at all.
fn any() -> impl Strategy<Value = f64> {
    prop_oneof![any_bits(), -800.0..800.0, 0.0..1.0, -1e-8..1e-8, -2e6..2e6]
}

fn any_bits() -> impl Strategy<Value = f64> {
    proptest::num::u64::ANY.prop_map(f64::from_bits)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn lanes_are_single_numbers(x in proptest::array::uniform8(any())) {
        let bits = |values: [f64; 8]| values.map(|value| if value.is_nan() { 0 } else { value.to_bits() });
        prop_assert_eq!(bits(lanes::ln(&x)), bits(x.map(ln)));
        prop_assert_eq!(bits(lanes::ln_1p(&x)), bits(x.map(ln_1p)));
        prop_assert_eq!(bits(lanes::exp(&x)), bits(x.map(exp)));
        prop_assert_eq!(bits(lanes::exp_m1(&x)), bits(x.map(exp_m1)));
        let (sines, cosines) = lanes::sin_cos(&x);
        prop_assert_eq!(bits(sines), bits(x.map(sin)));
        prop_assert_eq!(bits(cosines), bits(x.map(cos)));
    }

    #[test]
    fn inverses(x in -700.0..700.0_f64, y in -30.0..30.0_f64) {
        // d ln z = dz/z: an ulp of e^x is one of 1 in its logarithm.
        prop_assert!((ln(exp(x)) - x).abs() <= f64::EPSILON + ulp(x));
        // Of e^y − 1 an ulp of 1 is one over e^y in its logarithm.
        let lost = f64::EPSILON * (1.0 + (-y).exp()) * y.abs().min(1.0);
        prop_assert!((ln_1p(exp_m1(y)) - y).abs() <= lost + ulp(y));
    }

    #[test]
    fn on_the_circle(x in -2e6..2e6_f64) {
        let (sine, cosine) = sin_cos(x);
        prop_assert!((sine * sine + cosine * cosine - 1.0).abs() <= 2.0 * f64::EPSILON);
        prop_assert_eq!(sin(-x), -sine);
        prop_assert_eq!(cos(-x), cosine);
    }
}

//! Series against the functions that they stand for.

use super::*;

/// Every operation on smooth arguments, with the same on numbers.
type Case = (&'static str, fn(&Series) -> Series, fn(f64) -> f64);
const CASES: [Case; 12] = [
    ("exp", Series::exp, f64::exp),
    ("ln", Series::ln, f64::ln),
    ("sin", |x| x.sin_cos().0, f64::sin),
    ("cos", |x| x.sin_cos().1, f64::cos),
    ("tan", Series::tan, f64::tan),
    ("^3", |x| x.power(3.0), |x| x.powi(3)),
    ("^-2", |x| x.power(-2.0), |x| x.powi(-2)),
    ("^0.5", |x| x.power(0.5), f64::sqrt),
    ("^-1.3", |x| x.power(-1.3), |x| x.powf(-1.3)),
    ("x exp(-x)", |x| x.multiply(&x.negate().exp()), |x| x * (-x).exp()),
    ("1/(1 + x^2)", |x| one().divide(&one().add(&x.power(2.0))), |x| 1.0 / (1.0 + x * x)),
    (
        "exp(-(x - 0.7)^2)",
        |x| x.subtract(&number(0.7)).power(2.0).negate().exp(),
        |x| (-(x - 0.7).powi(2)).exp(),
    ),
];

fn number(value: f64) -> Series {
    Series::constant(Interval::point(value))
}

fn one() -> Series {
    number(1.0)
}

#[test]
fn the_taylor_polynomial_and_its_remainder_enclose_the_function() {
    for (name, enclose, function) in CASES {
        for (centre, half) in [(0.8, 0.05), (0.8, 1e-6), (1.1, 0.2)] {
            let point = enclose(&Series::variable(Interval::point(centre), half));
            let panel = enclose(&Series::variable(Interval::new(centre - half, centre + half), half));
            assert!(point.is_smooth() && panel.is_smooth(), "{name}");
            for order in [2, 8, ORDER] {
                for i in -10..=10 {
                    let t = f64::from(i) / 10.0;
                    let (mut low, mut high) = (0.0, 0.0);
                    for k in 0..=order {
                        let from = if k < order { &point } else { &panel };
                        let (mid, radius) = from.coefficient(k);
                        let (a, b) = ((mid - radius) * t.powi(k as i32), (mid + radius) * t.powi(k as i32));
                        low += a.min(b);
                        high += a.max(b);
                    }
                    let exact = function(centre + half * t);
                    let slack = 1e-15 * exact.abs().max(1.0);
                    assert!(
                        low - slack <= exact && exact <= high + slack,
                        "{name} {order} {low} {exact} {high}"
                    );
                }
            }
            let (mid, radius) = point.coefficient(3);
            assert!(radius <= 1e-11 * mid.abs() + 1e-13, "{name} {mid} {radius}");
        }
    }
}

#[test]
fn polynomials_stay_short() {
    let x = Series::variable(Interval::new(-1.0, 1.0), 1.0);
    assert_eq!(x.power(3.0).length(), 4);
    assert_eq!(x.multiply(&x).add(&one()).length(), 3);
    assert_eq!(x.power(2.0).value(), Interval::new(0.0, x.power(2.0).value().high()));
}

#[test]
fn what_is_not_smooth_keeps_its_range_only() {
    let x = Series::variable(Interval::new(-1.0, 1.0), 1.0);
    assert!(!x.ln().is_smooth() && !x.power(0.5).is_smooth() && !one().divide(&x).is_smooth());
    assert!(!x.power(0.5).add(&one()).is_smooth());
    assert_eq!(x.power(0.5).value().low(), 0.0);
    assert!(!Series::rough(Interval::new(0.0, 1.0)).exp().is_smooth());
}

#[test]
fn crossings_are_found() {
    let x = Series::variable(Interval::point(0.5), 0.5);
    let root = x.exp().crossing(2.0).unwrap();
    assert!((0.5 + 0.5 * root - std::f64::consts::LN_2).abs() < 1e-15);
    assert_eq!(x.exp().crossing(5.0), None);
    assert_eq!(one().crossing(0.0), None);
}

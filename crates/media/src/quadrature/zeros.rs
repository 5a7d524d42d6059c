//! Sign changes of a function of the profile: the kinks of integrands that take its size.

use super::panels::Panels;
use super::rule::{Expansion, RULE, value_of};
use fairflight_elementary::cos;

/// Points at which the expansion of a panel is looked at: it has 15 zeros at most, and follows what the panels resolve.
const LOOKS: usize = 48;

/// Halvings of a bracket: the width of a panel to less than a rounding.
const HALVINGS: usize = 60;

/// Sizes below this are rounding, not a change of sign: functions are of order 1 where they matter.
const ROUNDING: f64 = 1e-13;

impl<T> Panels<T> {
    /// The zeros with a change of sign of `function`, by the Legendre expansion of each panel: as exact as the panels resolve it
    /// ([`settle`](Self::settle) first). Two zeros that are nearer than the looks at a panel are found by the extremum between them.
    pub(super) fn zeros(&self, function: &dyn Fn(f64, &T) -> f64) -> Vec<f64> {
        let mut zeros = Vec::new();
        for panel in &self.panels {
            let [row] = panel.rows(&|_, s, value| [function(s, value)]);
            let (low, high) =
                row.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
            // Far from zero compared to all that it varies by.
            if low > 2.0 * (high - low) || -high > 2.0 * (high - low) {
                continue;
            }
            let (middle, half) = (0.5 * (panel.from + panel.to), panel.half());
            let expansion = RULE.expand(&row);
            zeros.extend(zeros_of(&expansion).into_iter().map(|x| middle + half * x));
        }
        zeros
    }
}

/// The zeros with a change of sign on [−1, 1].
fn zeros_of(expansion: &Expansion) -> Vec<f64> {
    let at = |x: f64| value_of(expansion, x);
    // Denser towards the ends, as the zeros of polynomials are.
    let place = |i: usize| -cos(std::f64::consts::PI * i as f64 / LOOKS as f64);
    let mut points: Vec<(f64, f64)> = (0..=LOOKS).map(|i| (place(i), at(place(i)))).collect();
    let mut extrema = Vec::new();
    for triple in points.windows(3) {
        let [(a, before), (_, here), (b, after)] = *triple else { continue };
        let turns = here.abs() <= before.abs().min(after.abs()) && before * here > 0.0 && here * after > 0.0;
        if turns {
            let x = least(&|x| at(x) * here.signum(), a, b);
            if at(x) * here < 0.0 {
                extrema.push((x, at(x)));
            }
        }
    }
    points.extend(extrema);
    points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    points.retain(|point| point.1 != 0.0);
    let changes = points
        .windows(2)
        .filter(|pair| pair[0].1 * pair[1].1 < 0.0 && pair[0].1.abs().max(pair[1].1.abs()) > ROUNDING);
    changes
        .map(|pair| {
            let (mut a, mut b) = (pair[0].0, pair[1].0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if at(middle) * pair[0].1 > 0.0 {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            0.5 * (a + b)
        })
        .collect()
}

/// Place of the minimum of a function with one minimum between `a` and `b`, to where rounding hides it.
fn least(function: &dyn Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    /// Number of steps, each of which keeps two thirds: 1e-9 of the bracket, to the square of which the minimum is flat.
    const STEPS: usize = 50;
    for _ in 0..STEPS {
        let (left, right) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if function(left) < function(right) {
            b = right;
        } else {
            a = left;
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use crate::{Breakpoints, Extinction, RayQuadrature, Tolerance};

    /// sigma_t(s) = sin(s), without breakpoints.
    struct Sine;
    impl Extinction for Sine {
        fn sigma_t(&self, s: f64) -> f64 {
            s.sin()
        }
        fn length(&self) -> f64 {
            20.0
        }
    }
    impl Breakpoints for Sine {
        fn breakpoints(&self) -> Vec<f64> {
            Vec::new()
        }
    }

    fn borders_near(function: &dyn Fn(f64, f64) -> f64, places: &[f64]) {
        let mut quadrature = RayQuadrature::new(Sine, &[]);
        quadrature.split_at_zeros(Tolerance::TIGHT, function);
        for place in places {
            let nearest =
                quadrature.borders().map(|border| (border - place).abs()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-9, "{place} {nearest}");
        }
    }

    #[test]
    fn simple_and_close_pairs_of_zeros_are_found() {
        use std::f64::consts::{FRAC_PI_2, PI, TAU};
        borders_near(&|_, sigma| sigma, &[PI, TAU, 3.0 * PI]);
        // Two zeros a hundredth apart at each crest.
        let level = 5e-3_f64.cos();
        let pairs: Vec<f64> =
            (0..3).flat_map(|k| [-5e-3, 5e-3].map(|d| FRAC_PI_2 + TAU * f64::from(k) + d)).collect();
        borders_near(&|_, sigma| sigma - level, &pairs);
        // Of a function of the distance as well.
        borders_near(&|s, sigma| sigma + s - 4.0, &[4.967_608_020_589_481_5]);
    }

    #[test]
    fn the_size_of_a_function_is_then_integrated_to_rounding() {
        let mut quadrature = RayQuadrature::new(Sine, &[]);
        quadrature.split_at_zeros(Tolerance::TIGHT, &|_, sigma| sigma - 0.3);
        let once = quadrature.integrate(Tolerance::to(1e-9), |_, sigma| [(sigma - 0.3).abs()]);
        let again = quadrature.integrate(Tolerance::to(1e-14), |_, sigma| [(sigma - 0.3).abs()]);
        assert!((once.value[0] - again.value[0]).abs() < 1e-12);
    }

    #[test]
    fn what_is_zero_everywhere_or_rounding_has_none() {
        let mut quadrature = RayQuadrature::new(Sine, &[]);
        let before = quadrature.borders().count();
        quadrature.split_at_zeros(Tolerance::to(1e-3), &|_, _| 0.0);
        quadrature.split_at_zeros(Tolerance::to(1e-3), &|s, _| 1e-15 * (1e3 * s).sin());
        assert_eq!(quadrature.borders().count(), before);
    }
}

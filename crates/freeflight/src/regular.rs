//! Regular tracking: from cell to cell, the optical thickness of each in closed form.

use crate::root::crossing;
use crate::theory::{HIGHEST_MOMENT, Moments, powers};
use crate::{ClosedForm, Flight, FreeFlight};
use fairflight_elementary::{exp, exp_m1};
use fairflight_media::{Cells, Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Adds up optical thickness cell by cell until −ln(1 − u) is reached, then solves inside the cell.
///
/// In a cell σ_t is a cubic in s (trilinear voxels along a line), its optical thickness a quartic. Gauss–Legendre
/// quadrature with two points is exact for a cubic: two look-ups give the thickness of the cell. In the cell that holds the
/// collision two more determine the cubic itself, and the root of the quartic is found without further look-ups by
/// Newton's method inside a bracket, as in [`crate::Newton`].
///
/// **Law.** That of [`crate::Inversion`]: the density σ_t T itself, every weight is 1, to rounding: one of −ln(1 − u) for
/// each cell passed, and a few of the greatest σ_t of the last one times its width.
///
/// **Moments.** E\[weight^k; collided\] = 1 − T, E\[weight^k; escaped\] = T.
///
/// **Cost.** Two look-ups for each cell entered, two more at a collision: 2 Σ_cells T(start of the cell) + 2 (1 − T(length)).
///
/// **Domain.** σ_t ≥ 0 and [`Cells`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Regular;

/// One cell of a profile.
#[derive(Clone, Copy, Debug)]
struct Cell {
    middle: f64,
    half: f64,
    /// σ_t at the two nodes of the rule, `middle ∓ half · NODE`.
    values: [f64; 2],
}

/// 1/√3: the nodes of the two-point rule on \[−1, 1\].
const NODE: f64 = 0.577_350_269_189_625_7;

/// √(5/6): two further points, so that the squares of the two kinds differ by exactly 1/2. Inside the cell, since a value at
/// its border may belong to the neighbour.
const OUTER: f64 = 0.912_870_929_175_276_9;

impl Cell {
    #[inline]
    fn look_up<F: Extinction>(field: &F, from: f64, to: f64) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let values = [-NODE, NODE].map(|x| field.sigma_t(middle + half * x));
        Self { middle, half, values }
    }

    #[inline]
    fn thickness(&self) -> f64 {
        self.half * (self.values[0] + self.values[1])
    }

    /// σ_t = c_0 + c_1 y + c_2 y² + c_3 y³ with y = (s − from)/half between 0 and 2, from two further look-ups.
    ///
    /// On \[−1, 1\], x = y − 1, the even part is e_0 + e_2 x² and the odd part x (o_1 + o_3 x²). Each is linear in x² and
    /// known at two x² that differ by 1/2.
    fn cubic<F: Extinction>(&self, field: &F) -> [f64; 4] {
        let [low, high] = [-OUTER, OUTER].map(|x| field.sigma_t(self.middle + self.half * x));
        let parts = |low: f64, high: f64, x: f64| (0.5 * (high + low), 0.5 * (high - low) / x);
        let (inner_even, inner_odd) = parts(self.values[0], self.values[1], NODE);
        let (outer_even, outer_odd) = parts(low, high, OUTER);
        let (e2, o3) = (2.0 * (outer_even - inner_even), 2.0 * (outer_odd - inner_odd));
        let (e0, o1) = (inner_even - e2 / 3.0, inner_odd - o3 / 3.0);
        [e0 - o1 + e2 - o3, o1 - 2.0 * e2 + 3.0 * o3, e2 - 3.0 * o3, o3]
    }

    /// The distance at which the thickness from the start of the cell reaches `depth`.
    fn invert<F: Extinction>(&self, field: &F, depth: f64) -> f64 {
        let [c0, c1, c2, c3] = self.cubic(field);
        // In y, from the start of the cell: near it nothing cancels.
        let goal = depth / self.half;
        let y = crossing(0.0, 2.0, 2.0 * (depth / self.thickness()), |y| {
            let sigma_t = c0 + y * (c1 + y * (c2 + y * c3));
            let thickness = y * (c0 + y * (c1 / 2.0 + y * (c2 / 3.0 + y * (c3 / 4.0))));
            (thickness - goal, sigma_t)
        });
        (self.middle - self.half) + self.half * y
    }
}

/// The cells of a profile, from its start: pairs of neighbouring borders, empty cells left out.
fn cells<F: Cells>(field: &F) -> impl Iterator<Item = (f64, f64)> {
    let length = field.length();
    let mut from = 0.0;
    field.borders().chain([length]).filter_map(move |to| {
        let cell = (from, to);
        from = to;
        (cell.0 < cell.1).then_some(cell)
    })
}

impl<F: Cells> FreeFlight<F> for Regular {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let mut depth = source.next_exponential();
        for (from, to) in cells(field) {
            let cell = Cell::look_up(field, from, to);
            let thickness = cell.thickness();
            if depth < thickness {
                // Rounding may carry s over a border of its cell, not out of the profile.
                let distance = cell.invert(field, depth).clamp(from, to);
                return Flight::unweighted(Some(distance));
            }
            depth -= thickness;
        }
        Flight::unweighted(None)
    }

    #[inline]
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t >= 0.0
    }
}

impl<F: Cells> ClosedForm<F> for Regular {
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, _tolerance: Tolerance) -> Option<Moments> {
        let field = quadrature.field();
        let mut moments = [0.0; HIGHEST_MOMENT];
        let mut score = |number: f64, probability: f64| {
            for (moment, power) in moments.iter_mut().zip(powers(number)) {
                *moment += probability * power;
            }
        };
        let (mut passed, mut tau) = (0.0, 0.0_f64);
        for (from, to) in cells(field) {
            passed += 2.0;
            let thickness = Cell::look_up(field, from, to).thickness();
            score(passed + 2.0, exp(-tau) * -exp_m1(-thickness));
            tau += thickness;
        }
        score(passed, exp(-tau));
        Some(moments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Inversion;
    use fairflight_media::{Constant, Counted, PiecewiseConstant, PiecewiseLinear};
    use fairflight_sources::{LARGEST_VARIATE, Scripted};

    #[test]
    fn the_nodes_are_what_they_are_said_to_be() {
        assert!((NODE * NODE - 1.0 / 3.0).abs() < 1e-16);
        assert!((OUTER * OUTER - NODE * NODE - 0.5).abs() < f64::EPSILON);
    }

    /// σ_t = 1 + s − 3 s² + 2 s³ > 0 on a profile of one cell.
    struct Cubic;
    impl Extinction for Cubic {
        fn sigma_t(&self, s: f64) -> f64 {
            1.0 + s * (1.0 + s * (-3.0 + 2.0 * s))
        }
        fn length(&self) -> f64 {
            1.5
        }
    }
    impl Cells for Cubic {
        fn borders(&self) -> impl Iterator<Item = f64> {
            std::iter::empty()
        }
    }

    #[test]
    fn a_cubic_is_solved_to_rounding() {
        let tau = |s: f64| s * (1.0 + s * (0.5 + s * (-1.0 + 0.5 * s)));
        let cell = Cell::look_up(&Cubic, 0.0, 1.5);
        assert!((cell.thickness() - tau(1.5)).abs() < 4e-16 * tau(1.5));
        for i in 0..1000 {
            let u = f64::from(i) / 1000.0;
            let depth = -(1.0 - u).ln();
            match Regular.sample(&Cubic, &mut Scripted::new([u])).distance() {
                Some(s) => assert!((tau(s) - depth).abs() < 2e-15, "u = {u}: {}", tau(s) - depth),
                None => assert!(depth >= tau(1.5)),
            }
        }
    }

    #[test]
    fn it_agrees_with_the_closed_inverse() {
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 5.0, 6.0], vec![0.0, 0.7, 0.0, 2.0]).unwrap();
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 2.0, 4.0], vec![0.0, 2.0, 0.0, 0.0]).unwrap();
        for i in 0..1000 {
            let u = f64::from(i) / 1000.0;
            for (ours, exact) in [
                (
                    Regular.sample(&steps, &mut Scripted::new([u])),
                    Inversion.sample(&steps, &mut Scripted::new([u])),
                ),
                (
                    Regular.sample(&tent, &mut Scripted::new([u])),
                    Inversion.sample(&tent, &mut Scripted::new([u])),
                ),
            ] {
                match (ours.distance(), exact.distance()) {
                    // Where the tent comes down to zero a rounding of the depth is a root of it in the distance.
                    (Some(ours), Some(exact)) => {
                        assert!((ours - exact).abs() < 1e-7, "u = {u}: {ours} {exact}");
                    }
                    (ours, exact) => assert_eq!(ours, exact, "u = {u}"),
                }
            }
        }
    }

    #[test]
    fn two_look_ups_a_cell_and_two_more_at_a_collision() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.0], vec![1.0, 0.0, 0.5]).unwrap();
        let counted = Counted::new(&field);
        // Depth 1.2 lies in the third cell.
        let u = -(-1.2_f64).exp_m1();
        assert!((Regular.sample(&counted, &mut Scripted::new([u])).distance().unwrap() - 2.4).abs() < 1e-14);
        assert_eq!(counted.lookups(), 8);
        assert_eq!(Regular.sample(&counted, &mut Scripted::new([0.9])), Flight::Escaped { weight: 1.0 });
        assert_eq!(counted.lookups(), 8 + 6);
        let mut quadrature = RayQuadrature::new(&field, &[]);
        let expected = 2.0 * (1.0 + 2.0 * (-1.0_f64).exp()) + 2.0 * (1.0 - (-1.5_f64).exp());
        let found = Regular.lookups(&mut quadrature, Tolerance::TIGHT).unwrap();
        assert!((found[0] - expected).abs() < 1e-14);
    }

    #[test]
    fn ends_of_the_lattice_and_empty_profiles() {
        for variate in [0.0, LARGEST_VARIATE] {
            let mut source = Scripted::new([variate; 3]);
            let flight = Regular.sample(&Cubic, &mut source);
            assert!(flight.distance().is_none_or(|s| (0.0..=1.5).contains(&s)), "{flight:?}");
            for empty in [Constant::new(0.0, 1e300).unwrap(), Constant::new(1.0, 0.0).unwrap()] {
                assert_eq!(Regular.sample(&empty, &mut source), Flight::Escaped { weight: 1.0 });
            }
        }
    }
}

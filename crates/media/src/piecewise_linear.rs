//! Extinction interpolated linearly between n nodes.

use crate::interpolation::{lerp, lerp_bounds};
use crate::{
    Breakpoints, Extinction, FieldError, InvertOpticalThickness, Majorant, Minorant, OpticalThickness,
};

/// σ_t(s) linear between `(positions[i], sigma_t[i])` and the next node. As a profile, a control, or a sampling extinction.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    positions: Vec<f64>,
    sigma_t: Vec<f64>,
    /// ∫ σ_t from the first position to position i.
    depth_at_node: Vec<f64>,
}

impl PiecewiseLinear {
    /// Nodes at `positions` \[length\], of which the first is 0, with values `sigma_t` \[1/length\] of any sign.
    ///
    /// # Errors
    /// If the positions are fewer than two, do not start at 0, do not increase, do not fit the number of values, or a
    /// number is not finite.
    pub fn new(positions: Vec<f64>, sigma_t: Vec<f64>) -> Result<Self, FieldError> {
        FieldError::check_nodes("positions", &positions)?;
        FieldError::check_len("sigma_t", positions.len(), sigma_t.len())?;
        FieldError::check_all_finite("sigma_t", &sigma_t)?;
        if positions[0] != 0.0 {
            return Err(FieldError::NotAtStart { what: "positions", found: positions[0] });
        }
        let mut field = Self { depth_at_node: vec![0.0; positions.len()], positions, sigma_t };
        for i in 1..field.positions.len() {
            let width = field.positions[i] - field.positions[i - 1];
            let trapezoid = 0.5 * width * (field.sigma_t[i - 1] + field.sigma_t[i]);
            field.depth_at_node[i] = field.depth_at_node[i - 1] + trapezoid;
        }
        Ok(field)
    }

    /// The nodes strictly inside the profile.
    pub(crate) fn inner_nodes(&self) -> &[f64] {
        &self.positions[1..self.positions.len() - 1]
    }

    /// Bounds of σ_t on each piece that `from ≤ s < to` touches, there.
    pub(crate) fn bounds_in_pieces(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let first = self.piece(from);
        let last = self.inner_nodes().partition_point(|&node| node < to).max(first);
        (first..=last).map(move |i| {
            let ends = [from.max(self.positions[i]), to.min(self.positions[i + 1])];
            lerp_bounds(ends.map(|s| self.value_in(i, s)), self.sigma_t[i], self.sigma_t[i + 1])
        })
    }

    #[inline]
    fn piece(&self, s: f64) -> usize {
        self.inner_nodes().partition_point(|&node| node <= s)
    }

    /// σ_t at `s` in piece `i`, clamped to the piece so that rounding never extrapolates.
    #[inline]
    fn value_in(&self, i: usize, s: f64) -> f64 {
        let t = (s - self.positions[i]) / (self.positions[i + 1] - self.positions[i]);
        lerp(t.clamp(0.0, 1.0), self.sigma_t[i], self.sigma_t[i + 1])
    }

    /// The trapezoid between two points of piece `i`.
    fn thickness_in(&self, i: usize, from: f64, to: f64) -> f64 {
        0.5 * (to - from) * (self.value_in(i, from) + self.value_in(i, to))
    }
}

impl Extinction for PiecewiseLinear {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.value_in(self.piece(s), s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.positions[self.positions.len() - 1]
    }
}

impl Majorant for PiecewiseLinear {
    fn majorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Minorant for PiecewiseLinear {
    fn minorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl OpticalThickness for PiecewiseLinear {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        let (first, last) = (self.piece(from), self.piece(to));
        if first == last {
            return self.thickness_in(first, from, to);
        }
        self.thickness_in(first, from, self.positions[first + 1])
            + (self.depth_at_node[last] - self.depth_at_node[first + 1])
            + self.thickness_in(last, self.positions[last], to)
    }
}

/// Inverse of the optical thickness, for nodes that are nowhere negative.
impl InvertOpticalThickness for PiecewiseLinear {
    #[inline]
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        debug_assert!(self.minorant() >= 0.0, "a sampling extinction is not negative");
        let first = self.piece(from);
        let end = self.positions[first + 1];
        let thickness = self.thickness_in(first, from, end);
        if depth < thickness {
            let ends = (self.value_in(first, from), self.sigma_t[first + 1]);
            return self.reach((from, end), ends, depth / thickness);
        }
        // What is left is spent from the next node on. A piece without extinction never holds a depth strictly inside it.
        let depth = self.depth_at_node[first + 1] + (depth - thickness);
        let after = &self.depth_at_node[first + 2..];
        let i = first + 1 + after.partition_point(|&at_node| at_node <= depth);
        let end = *self.positions.get(i + 1)?;
        // In the depths that the piece was found with, so that the share is below 1.
        let share = (depth - self.depth_at_node[i]) / (self.depth_at_node[i + 1] - self.depth_at_node[i]);
        self.reach((self.positions[i], end), (self.sigma_t[i], self.sigma_t[i + 1]), share)
    }
}

impl PiecewiseLinear {
    /// Distance at which a stretch of one piece, with the extinctions `ends`, reaches this share of its optical thickness \[length\];
    /// `None` at the end of the profile. Rounding may carry it to an end of the stretch: not where the extinction is 0 there, and no flight
    /// of positive depth ends.
    #[inline]
    fn reach(&self, (start, end): (f64, f64), ends: (f64, f64), share: f64) -> Option<f64> {
        let s = (start + inverse_in_piece(ends, end - start, share)).min(end.next_down());
        let s = if s <= start && ends.0 == 0.0 && share > 0.0 { start.next_up() } else { s.max(start) };
        (s < self.length()).then_some(s)
    }
}

/// Distance into a stretch of this width, with the extinctions `a` and `e` at its ends, at which its optical thickness reaches
/// the `share` q of the whole, 0 ≤ q < 1 \[length\].
///
/// With the slope b = (e − a)/width the depth d is reached at t = 2 d/(a + √(a² + 2 b d)), the root that does not cancel
/// for either sign of b. The whole is D = width (a + e)/2, so that 2 b d = (e² − a²) q: the radicand, the square of the
/// extinction at t, is (1 − q) a² + q e², a sum of positive terms also where the slope runs down to 0.
#[inline]
fn inverse_in_piece((a, e): (f64, f64), width: f64, share: f64) -> f64 {
    if share == 0.0 {
        return 0.0; // also where a = 0, and the formula is 0/0
    }
    // hypot: a² alone would be lost for an extinction of 1e-160.
    let at_end = f64::hypot((1.0 - share).sqrt() * a, share.sqrt() * e);
    width * (share * ((a + e) / (a + at_end)))
}

impl Breakpoints for PiecewiseLinear {
    fn breakpoints(&self) -> Vec<f64> {
        self.inner_nodes().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::IntervalBounds;
    use crate::interpolation::tests::any_number;
    use proptest::prelude::*;

    #[test]
    fn equal_nodes_are_one_value() {
        // Between 0.7 and 0.7 the sum of the two products is 0.7000000000000001 at some of these.
        let flat = PiecewiseLinear::new(vec![0.0, 0.7, 3.0], vec![0.7; 3]).unwrap();
        for i in 0..=3000 {
            let s = 1e-3 * f64::from(i);
            assert_eq!(flat.sigma_t(s), 0.7, "{s}");
        }
        assert_eq!(flat.bounds_between(0.1, 2.9), (0.7, 0.7));
    }

    #[test]
    fn no_flight_ends_where_there_is_nothing() {
        // A narrow tent far along, where distances are 1.5e-8 apart: flights near its end must not be rounded to it.
        let (start, top, end) = (1e8, 1e8 + 1e-6, 1e8 + 2e-6);
        let field =
            PiecewiseLinear::new(vec![0.0, start, top, end, 2e8], vec![0.0, 0.0, 7e5, 0.0, 0.0]).unwrap();
        let whole = field.optical_thickness(0.0, 2e8);
        for share in (1..16).map(|k| 10_f64.powi(-k)).flat_map(|near| [near, 1.0 - near]) {
            let s = field.invert(0.0, whole * share).unwrap();
            assert!(field.sigma_t(s) > 0.0, "{s}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1024, ..ProptestConfig::default() })]

        #[test]
        fn values_keep_to_their_bounds_and_attain_them(
            nodes in prop::collection::vec((1e-12..1.0_f64, any_number()), 2..8),
            at in prop::collection::vec(0.0..=1.0_f64, 24),
            cuts in [0.0..1.0_f64, 0.0..1.0_f64],
        ) {
            let mut positions = vec![0.0];
            nodes[1..].iter().for_each(|(width, _)| positions.push(positions[positions.len() - 1] + width));
            let values: Vec<f64> = nodes.iter().map(|(_, value)| *value).collect();
            let field = PiecewiseLinear::new(positions.clone(), values.clone()).unwrap();
            let (whole, length) = ((field.minorant(), field.majorant()), field.length());
            let inside = at.iter().map(|t| t * length).chain(positions.iter().flat_map(|p| [*p, p.next_down().max(0.0)]));
            for s in inside.clone() {
                let value = field.sigma_t(s);
                prop_assert!((whole.0..=whole.1).contains(&value), "{value} at {s}");
            }
            for (position, value) in positions.iter().zip(&values) {
                prop_assert_eq!(field.sigma_t(*position), *value);
            }
            prop_assert_eq!(field.bounds_between(0.0, length), whole);

            let (from, to) = (cuts[0].min(cuts[1]) * length, cuts[0].max(cuts[1]) * length);
            if from < to {
                let (low, high) = field.bounds_between(from, to);
                for s in inside.filter(|s| (from..to).contains(s)).chain([from, to.next_down()]) {
                    let value = field.sigma_t(s);
                    prop_assert!((low..=high).contains(&value), "{value} at {s}, [{low}, {high}]");
                }
            }
        }
    }

    #[test]
    fn values_and_integral_of_a_tent() {
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0].map(|s| tent.sigma_t(s)), [0.0, 1.0, 2.0, 1.0, 0.0]);
        assert_eq!(tent.optical_thickness(0.0, 3.0), 3.0);
        assert_eq!(tent.optical_thickness(0.5, 2.0), 0.75 + 1.5);
        assert_eq!(tent.majorant(), 2.0);
        assert_eq!(tent.minorant(), 0.0);
    }

    /// The distance must have the depth that was asked for, from whichever start: to a few roundings of the depth, and one
    /// of the distance.
    fn inverts(field: &PiecewiseLinear) {
        let rounding_of_s = f64::EPSILON * field.length() * field.majorant();
        for i in 0..40 {
            let from = field.length() * f64::from(i) / 40.0;
            let whole = field.optical_thickness(from, field.length());
            for j in 0..50 {
                let depth = whole * f64::from(j) / 50.0;
                let Some(s) = field.invert(from, depth) else {
                    assert!(whole == 0.0, "from {from}, depth {depth} of {whole}");
                    continue;
                };
                assert!((from..field.length()).contains(&s));
                let found = field.optical_thickness(from, s);
                let granted = 4.0 * f64::EPSILON * whole + rounding_of_s;
                assert!((found - depth).abs() <= granted, "from {from}: {found} for {depth}");
            }
            assert_eq!(field.invert(from, whole * (1.0 + 1e-14) + f64::MIN_POSITIVE), None);
        }
    }

    #[test]
    fn inversion_undoes_the_optical_thickness() {
        let new = |p: &[f64], v: &[f64]| PiecewiseLinear::new(p.to_vec(), v.to_vec()).unwrap();
        // Up, down to zero, empty, up from zero, flat.
        let nodes = [0.0, 1.0, 3.0, 4.0, 5.0, 7.0];
        inverts(&new(&nodes, &[0.5, 2.0, 0.0, 0.0, 1.0, 1.0]));
        inverts(&new(&nodes, &[0.0, 0.0, 3.0, 1e-9, 0.0, 0.0]));
        // A slope of nearly zero: the textbook form −a + √(a² + 2bd) has no digit left here.
        inverts(&new(&[0.0, 1.0], &[1.0, 1.0 + 1e-13]));
        // Very thin, and of a size whose square is no number.
        inverts(&new(&[0.0, 1.0, 2.0], &[1e-300, 3e-300, 0.0]));
        inverts(&new(&[0.0, 1.0], &[1e200, 1e-200]));
    }

    #[test]
    fn closed_values_of_the_inverse() {
        let ramp = PiecewiseLinear::new(vec![0.0, 2.0], vec![0.0, 4.0]).unwrap();
        assert_eq!(ramp.invert(0.0, 1.0), Some(1.0));
        assert_eq!(ramp.invert(0.0, 0.0), Some(0.0));
        assert_eq!(ramp.invert(1.0, 3.0 - 1e-14).map(|s| (s - 2.0).abs() < 1e-14), Some(true));
        assert_eq!(ramp.invert(0.0, 4.0), None);
        // Downwards to zero: the last hundredth of the depth takes the last tenth of the way.
        let down = PiecewiseLinear::new(vec![0.0, 2.0], vec![4.0, 0.0]).unwrap();
        assert!((down.invert(0.0, 3.96).unwrap() - 1.8).abs() < 4e-15);
        // Empty at first: a flight of depth 0 lands where matter begins.
        let late = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.0, 0.0, 1.0]).unwrap();
        assert_eq!(late.invert(0.0, 0.0), Some(1.0));
        let empty = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 0.0]).unwrap();
        assert_eq!(empty.invert(0.0, 0.0), None);
    }

    #[test]
    fn bad_lists_are_refused() {
        let new = |p: &[f64], v: &[f64]| PiecewiseLinear::new(p.to_vec(), v.to_vec());
        assert!(matches!(new(&[0.0], &[1.0]), Err(FieldError::TooFew { .. })));
        assert!(matches!(new(&[0.0, 1.0], &[1.0]), Err(FieldError::LengthMismatch { .. })));
        assert!(matches!(new(&[0.0, -1.0], &[1.0, 1.0]), Err(FieldError::NotIncreasing { .. })));
        assert!(matches!(new(&[1.0, 2.0], &[1.0, 1.0]), Err(FieldError::NotAtStart { .. })));
    }
}

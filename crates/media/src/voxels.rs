//! A medium interpolated between voxels, and its exact integral along a line.

use crate::lattice_planes::PlaneCrossings;
use crate::{FieldError, Line, LineCells, LineThickness, Medium, MediumBreakpoints};
use glam::{DAffine3, DVec3};

/// Values at integer coordinates, interpolated between them.
///
/// **Law.** `trilinear` is continuous, and linear in each coordinate by itself between two neighbouring integers; also
/// where the lattice ends and its background begins. Outside it is defined everywhere. It stays between the values at the eight corners
/// around its point in floating point as well ([`crate::lerp`] does): where they agree, it is their value.
pub trait Lattice {
    /// The interpolated value at a point in index coordinates.
    fn trilinear(&self, x: f64, y: f64, z: f64) -> f64;

    /// A value that the interpolation exceeds nowhere, background included.
    fn maximum(&self) -> f64;

    /// A value that the interpolation falls below nowhere, background included.
    fn minimum(&self) -> f64;
}

impl<L: Lattice + ?Sized> Lattice for &L {
    #[inline]
    fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
        (**self).trilinear(x, y, z)
    }
    fn maximum(&self) -> f64 {
        (**self).maximum()
    }
    fn minimum(&self) -> f64 {
        (**self).minimum()
    }
}

/// σ_t(p) = scale · trilinear(index_from_world(p)). Its own coordinates are those of the index space.
///
/// On a line each coordinate is linear in the distance s. Between two crossings of the planes at integer coordinates the
/// interpolation is a sum of products of at most three linear functions: a cubic in s. Gauss-Legendre quadrature with two
/// points is exact for a cubic, hence the sum of two look-ups per cell is the integral, to rounding. A line that runs in a
/// plane, or along an edge, is no exception: the interpolation is continuous there.
#[derive(Clone, Copy, Debug)]
pub struct Voxels<L> {
    lattice: L,
    index_from_world: DAffine3,
    scale: f64,
}

impl<L: Lattice> Voxels<L> {
    /// The `lattice` placed by the map from world space to index coordinates, its values times `scale` \[1/length\].
    ///
    /// # Errors
    /// If a number is not finite, or the map flattens space.
    pub fn new(lattice: L, index_from_world: DAffine3, scale: f64) -> Result<Self, FieldError> {
        FieldError::check_all_finite("index_from_world", &index_from_world.to_cols_array())?;
        FieldError::check_finite("scale", scale)?;
        let determinant = index_from_world.matrix3.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return Err(FieldError::Degenerate { what: "index_from_world" });
        }
        Ok(Self { lattice, index_from_world, scale })
    }

    /// The lattice itself.
    pub fn lattice(&self) -> &L {
        &self.lattice
    }

    /// Greatest number of cells that a line in index coordinates crosses over `length`. The thickness costs two look-ups for
    /// each; whoever takes lines from elsewhere refuses too many first.
    #[must_use]
    pub fn cells_crossed(&self, local: &Line, length: f64) -> u64 {
        let planes: f64 =
            (0..3).map(|i| PlaneCrossings::count(local.origin[i], local.direction[i], length)).sum();
        // The cast saturates.
        (planes as u64).saturating_add(1)
    }

    /// scale · (low, high), in order.
    pub(crate) fn scaled(&self, (low, high): (f64, f64)) -> (f64, f64) {
        if self.scale < 0.0 {
            (self.scale * high, self.scale * low)
        } else {
            (self.scale * low, self.scale * high)
        }
    }

    /// scale · (the lattice's value), for a bound: a negative scale exchanges the two.
    fn bound(&self, positive: f64, negative: f64) -> Option<f64> {
        let bound = self.scale * if self.scale < 0.0 { negative } else { positive };
        bound.is_finite().then_some(bound)
    }
}

impl<L: Lattice> Medium for Voxels<L> {
    fn local(&self, line: Line) -> Line {
        Line {
            origin: self.index_from_world.transform_point3(line.origin),
            direction: self.index_from_world.transform_vector3(line.direction),
        }
    }
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        self.scale * self.lattice.trilinear(point.x, point.y, point.z)
    }
    fn upper_bound(&self) -> Option<f64> {
        self.bound(self.lattice.maximum(), self.lattice.minimum())
    }
    fn lower_bound(&self) -> Option<f64> {
        self.bound(self.lattice.minimum(), self.lattice.maximum())
    }
}

impl<L: Lattice> LineThickness for Voxels<L> {
    fn line_thickness(&self, local: &Line, from: f64, to: f64) -> f64 {
        let mut crossings = Crossings::new(local, from, to);
        let mut sum = Sum::default();
        let mut start = from;
        while start < to {
            let end = crossings.next().unwrap_or(to);
            // The nodes of the two-point rule lie 1/√3 of half the cell from its middle; each weighs half the cell.
            let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
            let node = half * 3f64.sqrt().recip();
            for s in [middle - node, middle + node] {
                let point = local.at(s);
                sum.add(half * self.lattice.trilinear(point.x, point.y, point.z));
            }
            start = end;
        }
        self.scale * sum.value()
    }
}

impl<L: Lattice> MediumBreakpoints for Voxels<L> {
    fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64> {
        Crossings::new(local, 0.0, length).collect()
    }
}

impl<L: Lattice> LineCells for Voxels<L> {
    fn line_borders(&self, local: &Line, length: f64) -> impl Iterator<Item = f64> {
        Crossings::new(local, 0.0, length)
    }
}

/// The crossings of a line with the planes of all three axes, merged in increasing order. Through an edge or a corner the
/// same distance comes twice or thrice.
struct Crossings {
    axes: [PlaneCrossings; 3],
    /// The next crossing of each axis, infinite after its last.
    heads: [f64; 3],
}

impl Crossings {
    fn new(local: &Line, from: f64, to: f64) -> Self {
        let mut axes = [0, 1, 2].map(|i| PlaneCrossings::new(local.origin[i], local.direction[i], from, to));
        let heads = axes.each_mut().map(|axis| axis.next().unwrap_or(f64::INFINITY));
        Self { axes, heads }
    }
}

impl Iterator for Crossings {
    type Item = f64;

    #[inline]
    fn next(&mut self) -> Option<f64> {
        let [x, y, z] = self.heads;
        let (axis, s) = if x <= y && x <= z {
            (0, x)
        } else if y <= z {
            (1, y)
        } else {
            (2, z)
        };
        if s == f64::INFINITY {
            return None;
        }
        self.heads[axis] = self.axes[axis].next().unwrap_or(f64::INFINITY);
        Some(s)
    }
}

/// Neumaier's sum: what each addition rounds away is kept, so that millions of cells cost no digits.
#[derive(Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    #[inline]
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        let (large, small) = if self.sum.abs() >= x.abs() { (self.sum, x) } else { (x, self.sum) };
        self.lost += (large - sum) + small;
        self.sum = sum;
    }
    fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::test_support::random;
    use glam::{DMat3, dvec3};

    pub(crate) const SIZE: [i64; 3] = [7, 5, 6];

    /// Random values in [0.5, 1.5] within a background of 0.25.
    pub(crate) struct Dense(Vec<f64>);

    impl Dense {
        pub(crate) fn new() -> Self {
            let mut next = random(7);
            Self((0..SIZE.iter().product()).map(|_| 0.5 + next()).collect())
        }
        fn at(&self, p: [i64; 3]) -> f64 {
            let inside = p.iter().zip(SIZE).all(|(&i, n)| (0..n).contains(&i));
            if inside { self.0[((p[0] * SIZE[1] + p[1]) * SIZE[2] + p[2]) as usize] } else { 0.25 }
        }
    }

    impl Lattice for Dense {
        fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
            let base = [x, y, z].map(f64::floor);
            let t = [x - base[0], y - base[1], z - base[2]];
            let corner = |step: [i64; 3]| self.at([0, 1, 2].map(|i| base[i] as i64 + step[i]));
            let along_z = |i, j| crate::lerp(t[2], corner([i, j, 0]), corner([i, j, 1]));
            let along_y = |i| crate::lerp(t[1], along_z(i, 0), along_z(i, 1));
            crate::lerp(t[0], along_y(0), along_y(1))
        }
        fn maximum(&self) -> f64 {
            self.0.iter().copied().fold(0.25, f64::max)
        }
        fn minimum(&self) -> f64 {
            self.0.iter().copied().fold(0.25, f64::min)
        }
    }

    fn voxels() -> Voxels<Dense> {
        Voxels::new(Dense::new(), DAffine3::IDENTITY, 2.0).unwrap()
    }

    /// Simpson's rule, exact for cubics as well, between all the planes near the lattice, sorted.
    fn brute_force(voxels: &Voxels<Dense>, line: &Line, from: f64, to: f64) -> f64 {
        let mut s = vec![from, to];
        for axis in 0..3 {
            s.extend((-60..60).map(|k| (f64::from(k) - line.origin[axis]) / line.direction[axis]));
        }
        s.retain(|s| (from..=to).contains(s));
        s.sort_by(f64::total_cmp);
        let simpson = |a: f64, b: f64| {
            let value = |s| voxels.sigma_t_local(line.at(s));
            (b - a) / 6.0 * (value(a) + 4.0 * value(0.5 * (a + b)) + value(b))
        };
        s.windows(2).map(|cell| simpson(cell[0], cell[1])).sum()
    }

    fn check(origin: DVec3, direction: DVec3, from: f64, to: f64) {
        let voxels = voxels();
        let line = Line { origin, direction };
        let (found, expected) =
            (voxels.line_thickness(&line, from, to), brute_force(&voxels, &line, from, to));
        assert!((found - expected).abs() <= 1e-13 * expected, "{origin} {direction}: {found} {expected}");
    }

    #[test]
    fn random_lines() {
        let mut next = random(7);
        let mut vector =
            |size: f64, middle: f64| DVec3::from_array([0, 1, 2].map(|_| size * (next() - 0.5) + middle));
        for _ in 0..2000 {
            let direction = vector(2.0, 0.0).normalize();
            check(vector(10.0, 3.0), direction, 0.0, 12.0);
            check(vector(10.0, 3.0) - 20.0 * direction, direction, 17.3, 26.1);
        }
    }

    #[test]
    fn axis_parallel_lines_in_cells_faces_and_edges() {
        for zero in [0.0, -0.0] {
            for direction in [dvec3(1.0, zero, zero), dvec3(zero, -1.0, zero), dvec3(zero, zero, 1.0)] {
                for across in
                    [dvec3(2.0, 2.0, 2.0), dvec3(2.5, 1.0, 3.0), dvec3(0.0, 4.0, 5.0), dvec3(1.3, 2.6, 3.9)]
                {
                    for start in [-2.0, -2.5] {
                        check(across + start * direction, direction, 0.0, 9.0);
                    }
                }
            }
        }
    }

    #[test]
    fn a_line_on_an_axis_is_the_trapezoid_rule() {
        let (dense, voxels) = (Dense::new(), voxels());
        let line = Line { origin: dvec3(0.0, 2.0, 3.0), direction: dvec3(1.0, -0.0, -0.0) };
        let ends = 0.5 * (dense.at([0, 2, 3]) + dense.at([6, 2, 3]));
        let expected = 2.0 * (ends + (1..6).map(|i| dense.at([i, 2, 3])).sum::<f64>());
        assert!((voxels.line_thickness(&line, 0.0, 6.0) - expected).abs() < 1e-14);
    }

    #[test]
    fn diagonals_through_edges_and_corners() {
        check(DVec3::ZERO, dvec3(1.0, 1.0, 0.0).normalize(), 0.0, 8.0);
        check(dvec3(6.0, 0.0, 2.5), dvec3(-1.0, 1.0, 0.0).normalize(), 0.0, 8.0);
        check(-DVec3::ONE, DVec3::ONE.normalize(), 0.0, 12.0);
        check(dvec3(0.0, 4.0, 0.0), dvec3(1.0, -1.0, 2.0).normalize(), 0.0, 7.0);
        check(dvec3(1.0, 1.0, 1.0), dvec3(1.0, 1e-17, 0.0), 0.0, 5.0);
    }

    #[test]
    fn clipped_cells_and_nothing() {
        check(dvec3(2.1, 2.2, 2.3), dvec3(0.6, 0.0, 0.8), 0.1, 0.2);
        check(dvec3(2.1, 2.2, 2.3), dvec3(0.6, 0.0, 0.8), 0.95, 1.0);
        let line = Line { origin: dvec3(2.0, 2.0, 2.0), direction: DVec3::X };
        assert_eq!(voxels().line_thickness(&line, 1.0, 1.0), 0.0);
    }

    #[test]
    fn stretches_add_up() {
        let line = Line { origin: dvec3(-1.0, 0.3, 0.7), direction: dvec3(0.8, 0.36, 0.48) };
        let voxels = voxels();
        let whole = voxels.line_thickness(&line, 0.0, 9.0);
        let parts: f64 = (0..900)
            .map(|i| voxels.line_thickness(&line, f64::from(i) / 100.0, f64::from(i + 1) / 100.0))
            .sum();
        assert!((whole - parts).abs() < 1e-13 * whole);
    }

    #[test]
    fn the_map_to_index_space_keeps_world_distances() {
        // Voxels of size 0.5, turned about z, shifted.
        let world_from_index = DAffine3::from_translation(dvec3(5.0, -3.0, 1.0))
            * DAffine3::from_rotation_z(0.7)
            * DAffine3::from_scale(DVec3::splat(0.5));
        let placed = Voxels::new(Dense::new(), world_from_index.inverse(), 2.0).unwrap();
        let index_line = Line { origin: dvec3(0.2, 0.4, 0.6), direction: dvec3(0.8, 0.36, 0.48) };
        let world_line = Line {
            origin: world_from_index.transform_point3(index_line.origin),
            direction: world_from_index.transform_vector3(index_line.direction) * 2.0,
        };
        assert!((placed.sigma_t(world_line.at(1.0)) - voxels().sigma_t(index_line.at(2.0))).abs() < 1e-14);
        let placed_thickness = placed.line_thickness(&placed.local(world_line), 0.0, 3.0);
        let expected = 0.5 * voxels().line_thickness(&index_line, 0.0, 6.0);
        assert!((placed_thickness - expected).abs() < 1e-13 * expected);
    }

    #[test]
    fn crossings_and_their_estimate() {
        let line = Line { origin: dvec3(0.5, 0.25, 3.0), direction: dvec3(0.8, -0.6, 0.0) };
        let found = voxels().line_breakpoints(&line, 4.0);
        assert!(found.is_sorted());
        assert_eq!(found.len(), 6);
        assert_eq!(voxels().cells_crossed(&line, 4.0), 7);
        assert_eq!(voxels().cells_crossed(&line, f64::INFINITY), u64::MAX);
    }

    #[test]
    fn the_bounds_follow_the_sign_of_the_scale() {
        let dense = Dense::new();
        let positive = Voxels::new(&dense, DAffine3::IDENTITY, 3.0).unwrap();
        assert_eq!(positive.upper_bound(), Some(3.0 * dense.maximum()));
        assert_eq!(positive.lower_bound(), Some(0.75));
        let negative = Voxels::new(&dense, DAffine3::IDENTITY, -3.0).unwrap();
        assert_eq!(negative.upper_bound(), Some(-0.75));
        assert_eq!(negative.lower_bound(), Some(-3.0 * dense.maximum()));
    }

    #[test]
    fn bad_maps_are_refused() {
        let new = |map, scale| Voxels::new(Dense::new(), map, scale).map(|_| ());
        let flat = DAffine3::from_mat3(DMat3::from_diagonal(dvec3(1.0, 0.0, 1.0)));
        assert_eq!(new(flat, 1.0), Err(FieldError::Degenerate { what: "index_from_world" }));
        assert!(matches!(new(DAffine3::NAN, 1.0), Err(FieldError::NotFinite { .. })));
        assert!(matches!(new(DAffine3::IDENTITY, f64::NAN), Err(FieldError::NotFinite { .. })));
    }
}

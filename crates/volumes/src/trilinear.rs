//! Trilinear interpolation, the look-up that every estimator over a voxel grid pays for.

use crate::grid::VoxelGrid;
use crate::tree::{LEAF_BITS, LEAF_SIZE, Located, slot_of};

/// Offsets of the corners of a cell in a leaf, from its lowest corner: bit 2 of the corner steps in x, 1 in y, 0 in z.
const CORNER_OFFSETS: [usize; 8] = [0, 1, 8, 9, 64, 65, 72, 73];
/// Coordinates from here on are outside: with this bound a cell and its upper corners have 32-bit indices.
const OUTSIDE: f64 = 2_147_483_646.0;

impl VoxelGrid {
    /// The trilinear interpolant at a point of index space.
    ///
    /// It equals [`value`](Self::value) at integer coordinates, is continuous, and lies between the least and the greatest of
    /// the eight voxels around the point. Far outside the grid, at infinity too, it is the background. A coordinate that is
    /// not a number gives a result that is none.
    ///
    /// Cost: one descent of the tree where the eight voxels share a leaf or tile, which is two cells in three; else one for
    /// each leaf or tile that the cell touches.
    #[must_use]
    #[inline]
    pub fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
        // Written so that a NaN fails it.
        if !(x.abs() < OUTSIDE && y.abs() < OUTSIDE && z.abs() < OUTSIDE) {
            let nan = x.is_nan() || y.is_nan() || z.is_nan();
            return if nan { f64::NAN } else { f64::from(self.background()) };
        }
        let ((i, u), (j, v), (k, w)) = (cell(x), cell(y), cell(z));
        let crossing = crosses(i) << 2 | crosses(j) << 1 | crosses(k);
        if crossing != 0 {
            return interpolate(self.corners_across_leaves([i, j, k], crossing), u, v, w);
        }
        match self.tree.locate(i, j, k) {
            Located::Tile { value, .. } => f64::from(value),
            Located::Leaf(leaf) => {
                let leaf = &self.tree.leaf_values[leaf as usize];
                let first = slot_of::<0, LEAF_BITS>(i, j, k);
                // The cell lies within the leaf, so that the remainder changes nothing; it spares the bounds checks.
                interpolate(CORNER_OFFSETS.map(|offset| leaf[(first + offset) % LEAF_SIZE]), u, v, w)
            }
        }
    }

    /// The corners of a cell that reaches into the next leaf along the axes whose bits are set in `crossing`.
    fn corners_across_leaves(&self, lowest: [i32; 3], crossing: usize) -> [f32; 8] {
        let [i, j, k] = lowest.map(|coordinate| [coordinate, coordinate + 1]);
        // Corners that differ along uncrossed axes only are in the same leaf or tile: descend once for them.
        let mut located = [Located::Leaf(0); 8];
        let mut corners = [0.0; 8];
        for corner in 0..8 {
            let (i, j, k) = (i[corner >> 2], j[corner >> 1 & 1], k[corner & 1]);
            if corner & !crossing == 0 {
                located[corner] = self.tree.locate(i, j, k);
            }
            corners[corner] = match located[corner & crossing] {
                Located::Tile { value, .. } => value,
                Located::Leaf(leaf) => self.tree.leaf_values[leaf as usize][slot_of::<0, LEAF_BITS>(i, j, k)],
            };
        }
        corners
    }
}

/// The integer below a coordinate and the fraction above it, in [0, 1]; one is reached by rounding just below an integer.
#[inline]
fn cell(coordinate: f64) -> (i32, f64) {
    // The conversion truncates towards zero, which is one too high below zero.
    let truncated = coordinate as i32;
    let floor = truncated - i32::from(coordinate < f64::from(truncated));
    (floor, coordinate - f64::from(floor))
}

/// One if the cell above a coordinate reaches into the next leaf, else zero.
#[inline]
fn crosses(coordinate: i32) -> usize {
    const LAST: u32 = (1 << LEAF_BITS) - 1;
    usize::from(coordinate.cast_unsigned() & LAST == LAST)
}

/// Interpolates along z, then y, then x.
#[inline]
fn interpolate(corners: [f32; 8], u: f64, v: f64, w: f64) -> f64 {
    let lerp = |a: f64, b: f64, t: f64| a + t * (b - a);
    let c = corners.map(f64::from);
    let low = lerp(lerp(c[0], c[1], w), lerp(c[2], c[3], w), v);
    let high = lerp(lerp(c[4], c[5], w), lerp(c[6], c[7], w), v);
    // The exact interpolant is a convex combination of the corners. Rounding can leave their range by a few last bits, and
    // a field that exceeds its majorant by one bit is refused by whoever checks majorants; so only rounding is cut here.
    let least = corners.iter().fold(corners[0], |least, &value| if value < least { value } else { least });
    let greatest = corners.iter().fold(corners[0], |most, &value| if value > most { value } else { most });
    lerp(low, high, u).max(f64::from(least)).min(f64::from(greatest))
}

#[cfg(test)]
mod tests {
    use super::{cell, interpolate};

    #[test]
    fn cells_are_floors() {
        assert_eq!(cell(2.25), (2, 0.25));
        assert_eq!(cell(-2.25), (-3, 0.75));
        assert_eq!(cell(-3.0), (-3, 0.0));
        assert_eq!(cell(-0.0), (0, 0.0));
        assert_eq!(cell(-1e-300), (-1, 1.0));
    }

    #[test]
    fn a_trilinear_polynomial_is_reproduced() {
        let f = |x: f64, y: f64, z: f64| {
            1.0 + 2.0 * x - 3.0 * y + 4.0 * z + x * y - 2.0 * y * z + 0.5 * x * y * z
        };
        let corner = |n: usize| f((n >> 2 & 1) as f64, (n >> 1 & 1) as f64, (n & 1) as f64) as f32;
        let corners = std::array::from_fn(corner);
        for (u, v, w) in [(0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (0.25, 0.5, 0.75), (0.1, 0.9, 0.3)] {
            assert!((interpolate(corners, u, v, w) - f(u, v, w)).abs() < 1e-14);
        }
    }

    #[test]
    fn rounding_does_not_leave_the_range_of_the_corners() {
        // Corners of very different size and fractions near one make the differences round; without the last step of
        // `interpolate` some of these leave the range.
        let mut state = 1_u32;
        let mut draw = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for _ in 0..20_000 {
            let corners: [f32; 8] =
                std::array::from_fn(|_| f32::from_bits((127 - draw(40)) << 23 | draw(1 << 23)));
            let mut fraction = || 1.0 - f64::from(draw(3)) * f64::EPSILON / 2.0;
            let value = interpolate(corners, fraction(), fraction(), fraction());
            let least = corners.iter().fold(f32::MAX, |least, value| least.min(*value));
            let greatest = corners.iter().fold(0.0_f32, |greatest, value| greatest.max(*value));
            assert!((f64::from(least)..=f64::from(greatest)).contains(&value), "{corners:?} {value}");
        }
    }
}

//! The gradient noise of Perlin 2002, on the permutation tables of the library `noise`.
//!
//! The values are those of `noise::Perlin` to the last bit, which a test holds it to. The arithmetic is written again
//! because twelve octaves at each look-up are the cost of the whole medium: here the corners of a cell share their hashes
//! and a gradient is read from a table, where the library hashes each corner by itself and jumps to one of 16 cases. Its tables are made
//! here too: for 256 bytes it would bring a second version of `rand` into every program.

mod lanes;

use glam::DVec3;

/// The noise of one seed. It has period 256 along each axis.
#[derive(Clone, Debug)]
pub(crate) struct GradientNoise {
    permutation: [u8; 256],
}

/// The twelve midpoints of the edges of a cube, four of them twice.
const GRADIENTS: [[f64; 3]; 16] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [0.0, -1.0, -1.0],
];

/// The permutation of a seed: 0 to 255 shuffled from the last down (Durstenfeld 1964), by a generator of Marsaglia 2003 that is seeded with 1 and three
/// times the seed. An index below n is the upper half of a 32-bit variate times n; variates of the last, incomplete round are left out.
fn permutation(seed: u32) -> [u8; 256] {
    let [mut x, mut y, mut z, mut w] = [1, seed, seed, seed];
    let mut next = || {
        let t = x ^ (x << 11);
        (x, y, z) = (y, z, w);
        w ^= (w >> 19) ^ t ^ (t >> 8);
        w
    };
    let mut below = |n: u32| loop {
        let product = u64::from(next()) * u64::from(n);
        if product as u32 <= (n << n.leading_zeros()).wrapping_sub(1) {
            return (product >> 32) as usize;
        }
    };
    let mut permutation = std::array::from_fn(|i| i as u8);
    for i in (1..256_u32).rev() {
        permutation.swap(i as usize, below(i + 1));
    }
    permutation
}

/// 2/√3, the library's factor. With it the noise would leave \[−1, 1\] here and there, and is clamped.
const AMPLITUDE: f64 = 1.154_700_538_379_251_5;

impl GradientNoise {
    /// A bound of the slope along any axis within a cell, before the clamp.
    ///
    /// With n = Σ W_c L_c over the corners, W_c the weights, L_c = g_c · (x − c) and ∂n = Σ W_c ∂L_c + Σ ∂W_c L_c: |∂L_c| ≤ 1, since a gradient has
    /// components of size 0 and 1; Σ |∂W_c| ≤ 2 · 15/8, twice the steepest slope of the quintic; |L_c| ≤ 2, since two components do not vanish.
    pub(crate) const STEEPEST: f64 = (1.0 + 2.0 * 1.875 * 2.0) * AMPLITUDE;

    /// A bound of the second derivative along any unit vector e within a cell, before the clamp.
    ///
    /// On the diagonal |Σ ∂∂W_c L_c| ≤ 2 · 10/√3 · 2, with the greatest second derivative of the quintic, and |2 Σ ∂W_c ∂L_c| ≤ 4 · 15/8; off it
    /// 4 (15/8)² · 2 and 4 · 15/8. In e: Σ e_a² = 1, and 2 Σ_{a<b} |e_a e_b| ≤ 2.
    pub(crate) const MOST_CURVED: f64 =
        ((4.0 * 5.773_502_691_896_258 + 7.5) + 2.0 * (8.0 * 1.875 * 1.875 + 7.5)) * AMPLITUDE;

    pub(crate) fn new(seed: u32) -> Self {
        Self { permutation: permutation(seed) }
    }

    /// The noise in \[−1, 1\] at a point whose coordinates fit a 32-bit integer.
    #[inline]
    pub(crate) fn at(&self, point: DVec3) -> f64 {
        self.before_the_clamp(point).clamp(-1.0, 1.0)
    }

    /// The same before it is clamped: within a cell of the lattice a polynomial of the coordinates, of degree 6 in each and 16 in all.
    #[inline]
    pub(crate) fn before_the_clamp(&self, point: DVec3) -> f64 {
        debug_assert!(
            point.abs().max_element() < 2f64.powi(31),
            "the corner of the cell is a 32-bit integer"
        );
        let ((i, x), (j, y), (k, z)) = (split(point.x), split(point.y), split(point.z));

        let [h000, h001, h010, h011, h100, h101, h110, h111] = self.hashes(i, j, k);

        let (x1, y1, z1) = (x - 1.0, y - 1.0, z - 1.0);
        let (u, v, w) = (quintic(x), quintic(y), quintic(z));
        let near = mix(
            mix(slope(h000, x, y, z), slope(h001, x, y, z1), w),
            mix(slope(h010, x, y1, z), slope(h011, x, y1, z1), w),
            v,
        );
        let far = mix(
            mix(slope(h100, x1, y, z), slope(h101, x1, y, z1), w),
            mix(slope(h110, x1, y1, z), slope(h111, x1, y1, z1), w),
            v,
        );
        mix(near, far, u) * AMPLITUDE
    }

    /// The hashes of the corners of a cell, axis by axis: two values for x, four with y, eight with z.
    #[inline(always)]
    fn hashes(&self, i: u8, j: u8, k: u8) -> [u8; 8] {
        let entry = |index: u8| self.permutation[usize::from(index)];
        let (k0, k1) = (k, k.wrapping_add(1));
        let plane = |i: u8| {
            let hash = entry(i);
            let row = |j: u8| {
                let hash = entry(hash ^ j);
                [entry(hash ^ k0), entry(hash ^ k1)]
            };
            [row(j), row(j.wrapping_add(1))]
        };
        let [[[a, b], [c, d]], [[e, f], [g, h]]] = [plane(i), plane(i.wrapping_add(1))];
        [a, b, c, d, e, f, g, h]
    }
}

/// The cell that holds a coordinate, modulo 256, and the distance from its lower end.
#[inline]
fn split(coordinate: f64) -> (u8, f64) {
    // A truncation and a correction: without the instruction for it, `floor` is a call.
    let truncated = coordinate as i32;
    let cell = truncated - i32::from(f64::from(truncated) > coordinate);
    ((cell & 0xff) as u8, coordinate - f64::from(cell))
}

/// The gradient of a corner times the offset from it.
#[inline]
fn slope(hash: u8, x: f64, y: f64, z: f64) -> f64 {
    let [gx, gy, gz] = GRADIENTS[usize::from(hash & 15)];
    gx * x + gy * y + gz * z
}

/// 6t⁵ − 15t⁴ + 10t³: from 0 to 1 with two vanishing derivatives at either end.
#[inline(always)]
fn quintic(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
fn mix(a: f64, b: f64, t: f64) -> f64 {
    b * t + a * (1.0 - t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::random;
    use glam::dvec3;
    use noise::permutationtable::{NoiseHasher, PermutationTable};
    use noise::{NoiseFn, Perlin};

    #[test]
    fn the_values_are_those_of_the_library() {
        let mut uniform = random(5);
        let mut next = || uniform() - 0.5;
        for seed in [0, 1, 77, u32::MAX] {
            let (ours, theirs) = (GradientNoise::new(seed), Perlin::new(seed));
            for size in [1.0, 10.0, 1e3, 1e9] {
                for _ in 0..5000 {
                    let point = size * dvec3(next(), next(), next());
                    assert_eq!(ours.at(point), theirs.get(point.to_array()), "{seed} {point}");
                    // On planes, edges and corners of the lattice.
                    for on_lattice in
                        [point.with_x(point.x.round()), point.with_y(point.y.round()).with_z(-3.0)]
                    {
                        assert_eq!(
                            ours.at(on_lattice),
                            theirs.get(on_lattice.to_array()),
                            "{seed} {on_lattice}"
                        );
                    }
                    assert_eq!(ours.at(point.round()), 0.0);
                }
            }
        }
    }

    #[test]
    fn permutations_are_those_of_the_library() {
        for seed in (0..500).chain([u32::MAX, 0x8000_0000, 0xBAD_5EED]) {
            let table = PermutationTable::new(seed);
            // The hash of a single coordinate is the entry of the table itself, a byte.
            let theirs: [u8; 256] = std::array::from_fn(|i| (table.hash(&[i as isize]) & 0xff) as u8);
            assert_eq!(permutation(seed), theirs, "{seed}");
        }
    }

    #[test]
    fn slopes_and_curvatures_stay_below_their_bounds() {
        let noise = GradientNoise::new(3);
        let mut uniform = random(8);
        let mut next = || uniform() - 0.5;
        let (mut steepest, mut most_curved) = (0.0_f64, 0.0_f64);
        for _ in 0..100_000 {
            let point = 100.0 * dvec3(next(), next(), next());
            let step = 1e-4 * dvec3(next(), next(), next()).normalize();
            let [before, at, after] = [-1.0, 0.0, 1.0].map(|t| noise.before_the_clamp(point + t * step));
            steepest = steepest.max((after - before).abs() / 2e-4);
            most_curved = most_curved.max((after - 2.0 * at + before).abs() / 1e-8);
        }
        assert!((2.0..GradientNoise::STEEPEST * 3f64.sqrt()).contains(&steepest), "{steepest}");
        assert!((10.0..GradientNoise::MOST_CURVED).contains(&most_curved), "{most_curved}");
    }
}

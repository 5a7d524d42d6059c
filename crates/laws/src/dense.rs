//! A small lattice as data: what voxel laws and hard cases run on, without a file.

use fairflight_media::{Lattice, lerp};

/// Values at the integer coordinates 0 … n − 1 of each axis, z fastest, zero outside.
#[derive(Clone, Debug, PartialEq)]
pub struct DenseLattice {
    size: [usize; 3],
    values: Vec<f64>,
}

impl DenseLattice {
    /// A lattice of this size with the value of `function` at each of its points.
    pub fn of(size: [usize; 3], function: impl Fn([usize; 3]) -> f64) -> Self {
        let mut values = Vec::with_capacity(size.iter().product());
        for x in 0..size[0] {
            for y in 0..size[1] {
                for z in 0..size[2] {
                    values.push(function([x, y, z]));
                }
            }
        }
        Self { size, values }
    }

    /// The value at integer coordinates.
    #[inline]
    fn at(&self, x: f64, y: f64, z: f64) -> f64 {
        let [nx, ny, nz] = self.size;
        let inside = |i: f64, n: usize| i >= 0.0 && i < n as f64;
        if !(inside(x, nx) && inside(y, ny) && inside(z, nz)) {
            return 0.0;
        }
        self.values[(x as usize * ny + y as usize) * nz + z as usize]
    }
}

impl Lattice for DenseLattice {
    #[inline]
    fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
        let (x0, y0, z0) = (x.floor(), y.floor(), z.floor());
        let along_z = |x: f64, y: f64| lerp(z - z0, self.at(x, y, z0), self.at(x, y, z0 + 1.0));
        let along_y = |x: f64| lerp(y - y0, along_z(x, y0), along_z(x, y0 + 1.0));
        lerp(x - x0, along_y(x0), along_y(x0 + 1.0))
    }
    fn maximum(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }
    fn minimum(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::min)
    }
}

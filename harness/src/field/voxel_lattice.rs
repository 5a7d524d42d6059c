//! An OpenVDB grid as a lattice of the media crate, which knows no files.

use fairflight_media::Lattice;
use fairflight_volumes::VoxelGrid;

/// The values of a grid, interpolated between voxels.
#[derive(Debug)]
pub struct VoxelLattice(pub VoxelGrid);

impl Lattice for VoxelLattice {
    #[inline]
    fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
        self.0.trilinear(x, y, z)
    }

    fn maximum(&self) -> f64 {
        f64::from(self.0.maximum())
    }

    fn minimum(&self) -> f64 {
        f64::from(self.0.minimum())
    }
}

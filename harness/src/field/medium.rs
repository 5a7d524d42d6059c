//! A medium of any kind.

use super::VoxelLattice;
use crate::Failure;
use fairflight_elementary::lanes::Lanes;
use fairflight_media::{
    AnalyticCosine, EmptySpace, ExpressionMedium, Homogeneous, Line, LineThickness, Medium, Perlin, Voxels,
};
use glam::DVec3;
use std::sync::Arc;

/// A medium of any kind.
#[derive(Clone, Debug)]
pub enum AnyMedium {
    /// No medium: that of a scene without one.
    Empty,
    /// The same everywhere.
    Homogeneous(Arc<Homogeneous>),
    /// szirmay-kalos-2017 eq. 21.
    AnalyticCosine(Arc<AnalyticCosine>),
    /// Noise.
    Perlin(Arc<Perlin>),
    /// A formula.
    Expression(Arc<ExpressionMedium>),
    /// Voxels of a file.
    Voxels(Arc<Voxels<VoxelLattice>>),
}

/// One expression of the medium inside, whatever its type.
macro_rules! of_any {
    ($any:expr, $medium:ident => $result:expr) => {
        match $any {
            AnyMedium::Empty => {
                let $medium = &EmptySpace;
                $result
            }
            AnyMedium::Homogeneous($medium) => $result,
            AnyMedium::AnalyticCosine($medium) => $result,
            AnyMedium::Perlin($medium) => $result,
            AnyMedium::Expression($medium) => $result,
            AnyMedium::Voxels($medium) => $result,
        }
    };
}

/// One branch per look-up: for what is prepared once. An image is compiled for the type of its medium.
impl Medium for AnyMedium {
    fn local(&self, line: Line) -> Line {
        of_any!(self, medium => medium.local(line))
    }
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        of_any!(self, medium => medium.sigma_t_local(point))
    }
    fn upper_bound(&self) -> Option<f64> {
        of_any!(self, medium => medium.upper_bound())
    }
    fn lower_bound(&self) -> Option<f64> {
        of_any!(self, medium => medium.lower_bound())
    }
}

impl AnyMedium {
    /// True where the optical thickness along a line has a closed form.
    #[must_use]
    pub fn has_closed_form(&self) -> bool {
        match self {
            Self::Empty | Self::Homogeneous(_) | Self::AnalyticCosine(_) | Self::Voxels(_) => true,
            Self::Perlin(_) | Self::Expression(_) => false,
        }
    }

    /// The bound of σ_t that the medium declares, 0 at least \[1/length\]; `key` is what it stands for.
    ///
    /// # Errors
    /// If it declares none.
    pub fn declared_extinction(&self, key: &str) -> Result<f64, Failure> {
        self.upper_bound().map(|bound| bound.max(0.0)).ok_or_else(|| {
            Failure::refused(format!(
                "{key}: this key is missing, and the medium declares no majorant that could stand for it"
            ))
        })
    }

    /// The same, positive also where there is none.
    ///
    /// # Errors
    /// If it declares none.
    pub fn greatest_extinction(&self, key: &str) -> Result<f64, Failure> {
        // Walks through nothing need a rate all the same; at this one they never collide.
        self.declared_extinction(key).map(|bound| bound.max(f64::MIN_POSITIVE))
    }
}

/// A medium without a closed form, as integrators take it that might ask for one: a scene that would ask is refused when it is planned
/// ([`AnyMedium::has_closed_form`]).
#[derive(Clone, Copy, Debug)]
pub struct OnlyLookUps<M>(pub M);

impl<M: Medium> Medium for OnlyLookUps<M> {
    const IS_EMPTY: bool = M::IS_EMPTY;

    fn local(&self, line: Line) -> Line {
        self.0.local(line)
    }
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        self.0.sigma_t_local(point)
    }
    #[inline(always)]
    fn sigma_t_local_lanes(&self, points: &[Lanes; 3]) -> Lanes {
        self.0.sigma_t_local_lanes(points)
    }
    fn upper_bound(&self) -> Option<f64> {
        self.0.upper_bound()
    }
    fn lower_bound(&self) -> Option<f64> {
        self.0.lower_bound()
    }
}

impl<M: Medium> LineThickness for OnlyLookUps<M> {
    fn line_thickness(&self, _local: &Line, _from: f64, _to: f64) -> f64 {
        unreachable!("what needs a closed form is refused when a scene is planned")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::PerlinParameters;

    fn perlin() -> Perlin {
        let (octaves, frequency, lacunarity, gain) = (3, 0.8, 2.0, 0.5);
        let (scale, offset, seed) = (1.0, 0.2, 1);
        let parameters = PerlinParameters { octaves, frequency, lacunarity, gain, scale, offset, seed };
        Perlin::new(parameters).unwrap()
    }

    #[test]
    fn any_medium_is_the_medium_inside() {
        let (homogeneous, cosine, perlin) =
            (Homogeneous::new(0.7).unwrap(), AnalyticCosine::new(1.3).unwrap(), perlin());
        fn agrees<M: Medium>(any: &AnyMedium, inside: &M) {
            assert_eq!((any.upper_bound(), any.lower_bound()), (inside.upper_bound(), inside.lower_bound()));
            for k in 0..20 {
                let point = f64::from(k) * DVec3::new(0.31, -0.17, 0.07);
                assert_eq!(any.sigma_t(point).to_bits(), inside.sigma_t(point).to_bits());
            }
        }
        agrees(&AnyMedium::Empty, &EmptySpace);
        agrees(&AnyMedium::Homogeneous(Arc::new(homogeneous)), &homogeneous);
        agrees(&AnyMedium::AnalyticCosine(Arc::new(cosine)), &cosine);
        agrees(&AnyMedium::Perlin(Arc::new(perlin.clone())), &perlin);
        agrees(&AnyMedium::Perlin(Arc::new(perlin.clone())), &OnlyLookUps(&perlin));
    }
}

//! A profile of any kind.

use super::known::ErasedField;
use super::{AnyMedium, KnownField, VoxelLattice, refused};
use crate::Failure;
use crate::estimator::{InLanes, On, Trial};
use fairflight_media::{
    AnalyticCosine, Certified, Clip, Constant, ExpressionMedium, ExpressionProfile, Homogeneous, Perlin,
    PiecewiseConstant, PiecewiseLinear, Ray, Voxels,
};
use glam::DVec3;
use std::sync::Arc;

/// Defines the profile: one variant per field type.
macro_rules! profiles {
    ($($(#[$doc:meta])* $Variant:ident($Field:ty)),+ $(,)?) => {
        /// A profile: one of the field types that the harness knows.
        #[derive(Clone, Debug)]
        pub enum AnyProfile { $($(#[$doc])* $Variant($Field)),+ }

        impl AnyProfile {
            /// The field, behind a pointer.
            #[must_use]
            pub fn field(&self) -> &dyn KnownField {
                match self { $(Self::$Variant(field) => field),+ }
            }

            /// An estimator on this profile, compiled for the type of its field.
            pub fn trial<E: 'static>(&self, estimator: E) -> Arc<dyn Trial>
            where
                $(On<$Field, E>: Trial),+
            {
                match self { $(Self::$Variant(field) => On::trial(field.clone(), estimator)),+ }
            }

            /// The same of an estimator that runs in lanes.
            pub fn trial_in_lanes<E>(&self, estimator: E) -> Arc<dyn Trial>
            where
                $(E: InLanes<$Field>,)+
                $(On<$Field, E>: Trial),+
            {
                match self { $(Self::$Variant(field) => On::trial_in_lanes(field.clone(), estimator)),+ }
            }

            /// An estimator on this profile, compiled once for all types of fields: a look-up is then an indirect call, which
            /// `cargo bench --bench lookups` measures.
            pub fn erased_trial<E: 'static>(&self, estimator: E) -> Arc<dyn Trial>
            where
                On<ErasedField, E>: Trial,
            {
                On::trial(self.erased(), estimator)
            }

            /// The same of an estimator that runs in lanes: an indirect call for the look-ups of all lanes.
            pub fn erased_trial_in_lanes<E: InLanes<ErasedField>>(&self, estimator: E) -> Arc<dyn Trial>
            where
                On<ErasedField, E>: Trial,
            {
                On::trial_in_lanes(self.erased(), estimator)
            }

            fn erased(&self) -> ErasedField {
                ErasedField(match self { $(Self::$Variant(field) => Arc::new(field.clone())),+ })
            }
        }
    };
}

profiles! {
    /// The same everywhere.
    Constant(Constant),
    /// One value per cell.
    PiecewiseConstant(PiecewiseConstant),
    /// Linear between nodes.
    PiecewiseLinear(PiecewiseLinear),
    /// A formula in s.
    Expression(Certified<ExpressionProfile>),
    /// A ray through a homogeneous medium.
    Homogeneous(Ray<Arc<Homogeneous>>),
    /// A ray through szirmay-kalos-2017 eq. 21.
    AnalyticCosine(Ray<Arc<AnalyticCosine>>),
    /// A ray through noise.
    Perlin(Certified<Ray<Arc<Perlin>>>),
    /// A ray through a formula in x, y, z.
    ExpressionMedium(Certified<Ray<Arc<ExpressionMedium>>>),
    /// A ray through voxels.
    Voxels(Ray<Arc<Voxels<VoxelLattice>>>),
    /// A field of the program that embeds this library, by no spec.
    Own(ErasedField),
}

/// A ray that crosses more voxel cells than this is refused: its reference alone would take minutes.
const MOST_CELLS: u64 = 1 << 24;

impl AnyProfile {
    /// A clipped ray through a medium.
    ///
    /// # Errors
    /// If it crosses too many voxels.
    pub fn ray(medium: &AnyMedium, clip: &Clip) -> Result<Self, Failure> {
        Ok(match medium {
            AnyMedium::Empty => Self::Constant(Constant::new(0.0, clip.length).map_err(refused)?),
            AnyMedium::Homogeneous(medium) => Self::Homogeneous(Ray::new(Arc::clone(medium), clip)),
            AnyMedium::AnalyticCosine(medium) => Self::AnalyticCosine(Ray::new(Arc::clone(medium), clip)),
            AnyMedium::Perlin(medium) => Self::Perlin(Certified::new(Ray::new(Arc::clone(medium), clip))),
            AnyMedium::Expression(medium) => {
                Self::ExpressionMedium(Certified::new(Ray::new(Arc::clone(medium), clip)))
            }
            AnyMedium::Voxels(medium) => {
                let ray = Ray::new(Arc::clone(medium), clip);
                let cells = medium.cells_crossed(ray.local_line(), clip.length);
                if cells > MOST_CELLS {
                    return Err(Failure::refused(format!(
                        "profile: the ray crosses up to {cells} voxel cells, more than {MOST_CELLS}"
                    )));
                }
                Self::Voxels(ray)
            }
        })
    }

    /// The distance from the ray's origin to the start of the profile: 0 for a profile that is no ray.
    #[must_use]
    pub fn entry_distance(&self) -> f64 {
        match self {
            Self::Homogeneous(ray) => ray.entry_distance(),
            Self::AnalyticCosine(ray) => ray.entry_distance(),
            Self::Perlin(ray) => ray.field().entry_distance(),
            Self::ExpressionMedium(ray) => ray.field().entry_distance(),
            Self::Voxels(ray) => ray.entry_distance(),
            _ => 0.0,
        }
    }

    /// True for a ray that meets nothing of its medium.
    #[must_use]
    pub fn misses(&self) -> bool {
        use AnyProfile::{AnalyticCosine, ExpressionMedium, Homogeneous, Perlin, Voxels};
        let is_ray =
            matches!(self, Homogeneous(_) | AnalyticCosine(_) | Perlin(_) | ExpressionMedium(_) | Voxels(_));
        is_ray && self.length() == 0.0
    }

    /// The length of the profile.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.field().length()
    }

    /// The majorant that the profile declares, 0 at least.
    #[must_use]
    pub fn declared(&self) -> Option<f64> {
        self.field().knowledge().upper_bound.map(|bound| bound.max(0.0))
    }

    /// The optical thickness of the majorant that the profile declares.
    ///
    /// # Errors
    /// If it declares none; `needs` says what for.
    pub fn declared_depth(&self, needs: &str) -> Result<f64, Failure> {
        self.declared().map(|majorant| majorant * self.length()).ok_or_else(|| {
            Failure::refused(format!("estimator: {needs}, or declare the `majorant` of the profile"))
        })
    }

    /// A distance inside the profile as a person gave it: from the ray's origin, with the point for a ray.
    #[must_use]
    pub fn place(&self, s: f64) -> String {
        let at = format!("s = {}", self.entry_distance() + s);
        let point = |ray: DVec3| format!("{at}, point [{}, {}, {}]", ray.x, ray.y, ray.z);
        match self {
            Self::Homogeneous(ray) => point(ray.world_point(s)),
            Self::AnalyticCosine(ray) => point(ray.world_point(s)),
            Self::Perlin(ray) => point(ray.field().world_point(s)),
            Self::ExpressionMedium(ray) => point(ray.field().world_point(s)),
            Self::Voxels(ray) => point(ray.world_point(s)),
            _ => at,
        }
    }
}

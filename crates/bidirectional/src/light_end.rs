//! The end of a path on a light: base cases of the recursion.

use crate::Place;
use fairflight_elementary::ln;
use fairflight_paths::transport::{Emitters, Light, Sides, Types, World};
use fairflight_scene::{Geometry, Shape, Source};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// The last vertex x_k of a path, on a light, with the densities of the strategies that choose it.
///
/// | light | P_sub: start of a light path | P_dir: chosen for a vertex | P→(x_(k−1)) from it, without T |
/// |---|---|---|---|
/// | surface | pmf/area | that of [`Shape::sample_towards`], by area | p_ω D E/r², p_ω = cos/π, or half of it on each side |
/// | point | pmf | 1 | D E/(4π r²) |
/// | direction | pmf | 1 | D E/(π R²) |
/// | map | pmf · its density | its density | D E/(π R²) |
/// | constant | pmf/(4π) | none | D E/(π R²) |
///
/// R is the radius of the ball through whose disc infinitely far light comes. Infinitely far ends are directions, in the measure of
/// solid angle.
#[derive(Clone, Copy, Debug)]
pub struct LightEnd<'s> {
    kind: Kind<'s>,
    light: Light,
    pmf: f64,
}

#[derive(Clone, Copy, Debug)]
enum Kind<'s> {
    Area { position: DVec3, normal: DVec3, shape: &'s Shape, sides: Sides },
    Point { position: DVec3 },
    Parallel { towards: DVec3, disc: f64 },
    Sky { towards: DVec3, disc: f64, pdf_start: f64, pdf_direct: f64 },
}

impl<'s> LightEnd<'s> {
    /// The end `at` a point of a surface, or at the direction `at` towards the background; a light without extent is where it is.
    #[must_use]
    pub fn new<W: Types>(
        world: &World<'s, W>,
        emitters: &Emitters<W::Spectrum>,
        light: Light,
        at: DVec3,
    ) -> Self {
        let disc = emitters.disc();
        let kind = match light {
            Light::Surface(index) => {
                let shape = &world.surfaces.surfaces()[index].shape;
                Kind::Area { position: at, normal: shape.normal(at), shape, sides: emitters.sides(light) }
            }
            Light::Source(index) => match world.lights.sources[index] {
                Source::Point { position, .. } => Kind::Point { position },
                Source::Directional { direction, .. } => Kind::Parallel { towards: -direction, disc },
            },
            Light::Map(index) => {
                let pdf = world.lights.background.maps[index].pdf_solid_angle(at);
                Kind::Sky { towards: at, disc, pdf_start: pdf, pdf_direct: pdf }
            }
            Light::Constant => Kind::Sky { towards: at, disc, pdf_start: 0.25 * FRAC_1_PI, pdf_direct: 0.0 },
        };
        Self { kind, light, pmf: emitters.pmf(light) }
    }

    /// The light.
    #[must_use]
    pub fn light(&self) -> Light {
        self.light
    }

    /// Position; `None` if infinitely far.
    #[inline]
    pub(crate) fn position(&self) -> Option<DVec3> {
        match self.kind {
            Kind::Area { position, .. } | Kind::Point { position } => Some(position),
            Kind::Parallel { .. } | Kind::Sky { .. } => None,
        }
    }

    /// The direction from a point to this end, of unit length, and the square of the distance where there is one.
    #[inline]
    pub(crate) fn seen_from(&self, point: DVec3) -> (DVec3, Option<f64>) {
        match self.kind {
            Kind::Area { position, .. } | Kind::Point { position } => {
                let offset = position - point;
                let squared = offset.length_squared();
                (offset / squared.sqrt(), Some(squared))
            }
            Kind::Parallel { towards, .. } | Kind::Sky { towards, .. } => (towards, None),
        }
    }

    /// P_sub: of the start of a light path here.
    #[inline]
    #[must_use]
    pub fn pdf_start(&self) -> f64 {
        match self.kind {
            Kind::Area { shape, .. } => self.pmf / shape.area(),
            Kind::Point { .. } | Kind::Parallel { .. } => self.pmf,
            Kind::Sky { pdf_start, .. } => self.pmf * pdf_start,
        }
    }

    /// P_dir: of this end, chosen by next-event estimation at `place`; 0 where it is not.
    #[inline]
    pub(crate) fn pdf_direct(&self, place: &Place) -> f64 {
        match self.kind {
            Kind::Area { normal, shape, .. } => {
                // What a surface sees of itself is left to directions.
                let Light::Surface(index) = self.light else { return 0.0 };
                let (towards, Some(squared)) = self.seen_from(place.position) else { return 0.0 };
                if place.surface() == Some(index) {
                    return 0.0;
                }
                let pdf_solid_angle = shape.pdf_towards(place.position, towards, squared.sqrt());
                pdf_solid_angle * normal.dot(towards).abs() / squared
            }
            Kind::Point { .. } | Kind::Parallel { .. } => 1.0,
            Kind::Sky { pdf_direct, .. } => pdf_direct,
        }
    }

    /// ln P→ of the vertex at `place`, drawn from this end, but for T.
    #[inline]
    pub(crate) fn ln_emitted(&self, place: &Place) -> f64 {
        let (towards, squared) = self.seen_from(place.position);
        let facing = place.facing(towards);
        let per_facing = match (self.kind, squared) {
            (Kind::Area { normal, sides, .. }, Some(squared)) => {
                let cosine = -normal.dot(towards);
                sides.pdf_projected(cosine) * cosine.abs() / squared
            }
            (Kind::Parallel { disc, .. } | Kind::Sky { disc, .. }, _) => 1.0 / disc,
            (_, squared) => 1.0 / (4.0 * PI * squared.unwrap_or(f64::INFINITY)),
        };
        ln(facing * per_facing.max(f64::MIN_POSITIVE))
    }

    /// ln P→ of this end, met by chance from `place`, but for the density of the direction and T; ln 0 without extent.
    #[inline]
    pub(crate) fn ln_met(&self, place: &Place) -> f64 {
        match self.kind {
            Kind::Area { position, normal, .. } => {
                let offset = position - place.position;
                let squared = offset.length_squared();
                ln(normal.dot(offset / squared.sqrt()).abs().max(f64::MIN_POSITIVE) / squared)
            }
            Kind::Sky { .. } => 0.0,
            Kind::Point { .. } | Kind::Parallel { .. } => f64::NEG_INFINITY,
        }
    }
}

//! Importance resampling of directions (antwerpen-2011 section 4.6, talbot-2005).

use super::{Extended, Extension};
use crate::Heuristic;
use crate::transport::{Scattered, Types, Vertex, World};
use fairflight_scene::{Geometry, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::num::NonZeroU32;

/// Share of directions that a vertex chooses itself, whatever else proposes some \[1\]: in (0, 1].
///
/// No direction then weighs more than 1/share: a bad proposal costs, and never biases. It costs at each vertex: where paths lose less than they
/// gain in weight, second moments grow from vertex to vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnShare(f64);

/// A share outside of (0, 1].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("own_share must be above 0 and at most 1, found {found}")]
pub struct ShareOutside {
    /// The value given.
    pub found: f64,
}

impl OwnShare {
    /// A share.
    ///
    /// # Errors
    /// If it is not above 0, or above 1.
    pub fn new(share: f64) -> Result<Self, ShareOutside> {
        if share > 0.0 && share <= 1.0 { Ok(Self(share)) } else { Err(ShareOutside { found: share }) }
    }

    /// The number.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

impl Default for OwnShare {
    /// One half: a proposal that is good for nothing at most doubles what a vertex adds to a second moment.
    fn default() -> Self {
        Self(0.5)
    }
}

/// Directions of which several are tried, and one is kept for the light that it would meet were there no medium.
///
/// ```text
/// n candidates by BRDF · cosine or phase function
/// b_i = light that candidate i would meet if nothing were in the way of it or of the lights
/// keep one: of them all with the probability own_share, else in proportion to b_i
/// ```
///
/// That is a choice in proportion to w_i = own_share · mean(b) + (1 − own_share) b_i, whose mean over the candidates is mean(b).
///
/// **Law.** E\[g(X) mean(b)/w_X\] = ∫ g s: given the candidates it is the mean of g over them, whatever numbers the b are, so that they may depend
/// on all candidates, as w does here.
///
/// **Variance.** A weight is at most 1/own_share. What pays is light that next-event estimation does not reach: the constant background where much of
/// it is hidden, bright walls beside dark ones. Where the light comes from everywhere, or from behind the second vertex, it costs.
///
/// **Cost.** An intersection per candidate, and where it meets a surface a point of each light.
#[derive(Clone, Copy, Debug)]
pub struct Resampled {
    candidates: NonZeroU32,
    own_share: f64,
}

impl Resampled {
    /// So many candidates.
    #[must_use]
    pub fn new(candidates: NonZeroU32, own_share: OwnShare) -> Self {
        Self { candidates, own_share: own_share.get() }
    }

    /// Light that is met along a direction through nothing: what directions count of emission and background, and what a surface would reflect of the
    /// lights and of the constant background if nothing were between. A guess, by any heuristic.
    fn seen<W: Types>(
        &self,
        world: &World<'_, W>,
        vertex: &Vertex,
        direction: DVec3,
        source: &mut impl UniformSource,
    ) -> f64 {
        let pdf_solid_angle = vertex.pdf_solid_angle(&world.volume.phase, direction);
        let from = Some(Scattered { vertex: *vertex, pdf_solid_angle });
        let Some(hit) = world.surfaces.intersect(&vertex.leave(direction, f64::INFINITY)) else {
            return world.background(Heuristic::Balance, from.as_ref(), direction).magnitude();
        };
        let mut light = world.emission(Heuristic::Balance, from.as_ref(), direction, &hit);
        if let Some((met, reflectance)) = world.diffuse_vertex(&hit)
            && reflectance != W::Spectrum::ZERO
        {
            let mut arriving = world.lights.background.constant;
            world.sample_emitters(&met, source, |sampled, _| {
                arriving += sampled.arriving * (sampled.scattered / sampled.pdf_solid_angle.unwrap_or(1.0));
            });
            light += reflectance * arriving;
        }
        light.magnitude()
    }
}

impl<W: Types> Extension<W> for Resampled {
    #[inline]
    fn prepare(&mut self, _world: &World<'_, W>, _vertex: &Vertex) {}

    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        let phase = &world.volume.phase;
        // The first one stands for any: they are exchangeable.
        let keeps_first = source.next_uniform() < self.own_share;
        let (mut sum, mut kept) = (0.0, (DVec3::ZERO, 0.0));
        for index in 0..self.candidates.get() {
            let direction = vertex.sample(phase, source.next_uniform(), source.next_uniform());
            let seen = self.seen(world, vertex, direction, source);
            sum += seen;
            if index == 0 || (!keeps_first && seen > 0.0 && source.next_uniform() * sum < seen) {
                kept = (direction, seen);
            }
        }
        let (direction, seen) = kept;
        let mean = sum / f64::from(self.candidates.get());
        let weight =
            if mean > 0.0 { mean / (self.own_share * mean + (1.0 - self.own_share) * seen) } else { 1.0 };
        let scattered = vertex.pdf_solid_angle(phase, direction);
        let pdf_solid_angle = Extension::<W>::pdf_solid_angle(self, vertex, direction, scattered);
        Extended { direction, weight, pdf_solid_angle }
    }

    /// That of one direction, s: of what lies behind, the one that is kept knows no more than any.
    #[inline]
    fn pdf_solid_angle(&self, _vertex: &Vertex, _direction: DVec3, scattered: f64) -> f64 {
        scattered
    }
}

#[cfg(test)]
mod tests {
    use super::super::Own;
    use super::*;
    use crate::transport::Lobe;
    use crate::transport::fixtures::{diffuse, square, vacuum};
    use fairflight_sources::Scripted;

    #[test]
    fn a_share_is_above_0_and_at_most_1() {
        assert_eq!(OwnShare::new(1.0).map(OwnShare::get), Ok(1.0));
        for found in [0.0, -0.5, 1.5] {
            assert_eq!(OwnShare::new(found), Err(ShareOutside { found }));
        }
        assert!(OwnShare::new(f64::NAN).is_err());
    }

    #[test]
    fn candidates_that_see_the_sky_are_kept_for_it() {
        // A floor under a sky of 1, half hidden by a wall beside it that reflects nothing.
        let mut scene =
            vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0), square(2.0, 1.0, diffuse(0.0), 0.0)], vec![]);
        scene.lights.background.constant = 1.0;
        let world = scene.world();
        let vertex = Vertex { position: DVec3::ZERO, lobe: Lobe::Diffuse { normal: DVec3::Z, surface: 0 } };
        let mut resampled = Resampled::new(NonZeroU32::new(2).unwrap(), OwnShare::new(0.25).unwrap());
        let mut drawn = |script: &[f64]| {
            let mut source = Scripted::new(script.iter().copied());
            let extended = resampled.sample(&world, &vertex, &mut source);
            assert_eq!(source.remaining(), 0);
            extended
        };
        // Straight up lies the lid, slantwise the sky: 1/2 on average, so that w is 1/8 and 7/8.
        let (up, aside) = ([0.0, 0.0], [0.75, 0.25]);
        let of = |[u, v]: [f64; 2]| vertex.sample(&scene.volume.phase, u, v);
        let seen = drawn(&[0.25, up[0], up[1], aside[0], aside[1], 0.999]);
        assert_eq!((seen.direction, seen.weight), (of(aside), 0.5 / 0.875));
        let own = drawn(&[0.24, up[0], up[1], aside[0], aside[1]]);
        assert_eq!((own.direction, own.weight), (of(up), 0.5 / 0.125));
        // Two that see the same are equal, whatever there is.
        assert_eq!(drawn(&[0.9, up[0], up[1], 0.01, 0.5]).weight, 1.0);
        assert_eq!(drawn(&[0.9, aside[0], aside[1], 0.75, 0.6, 0.5]).weight, 1.0);
    }

    #[test]
    fn one_candidate_is_the_direction_itself() {
        let mut scene = vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0)], vec![]);
        scene.lights.background.constant = 2.0;
        let world = scene.world();
        let vertex = Vertex { position: DVec3::ZERO, lobe: Lobe::Phase { incident: DVec3::Z } };
        let one = NonZeroU32::new(1).unwrap();
        for share in [0.1, 1.0] {
            let mut resampled = Resampled::new(one, OwnShare::new(share).unwrap());
            let found = resampled.sample(&world, &vertex, &mut Scripted::new([0.0, 0.3, 0.6]));
            let own = Own.sample(&world, &vertex, &mut Scripted::new([0.3, 0.6]));
            assert_eq!((found.direction, found.pdf_solid_angle), (own.direction, own.pdf_solid_angle));
            assert!((found.weight - 1.0).abs() < 1e-15);
        }
    }
}

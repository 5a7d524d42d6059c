//! Weights of strategies, from the ends of two subpaths.

use crate::thickness::{between, beyond};
use crate::{LightEnd, LogHeuristic, Node, Place, Site, WeightThickness};
use fairflight_elementary::ln;
use fairflight_media::Medium;
use fairflight_paths::Heuristic;
use fairflight_paths::transport::{Emitters, Types, World};
use fairflight_scene::{Camera, Hit, Material, Spectrum};
use glam::DVec3;
use std::fmt;

/// Weights of all strategies of a path, computed from what each of its two subpaths promises (antwerpen-2011 sections 5.2 and 5.3).
///
/// A path x_0 (pinhole) … x_k (light) is made by strategies (s, t), s + t = k + 1, with t vertices from the camera and s from the light:
///
/// ```text
/// p_(s,t) = Π_(0<i<t) P→(x_i) · Π_(t≤j<k) P←(x_j) · P(x_k),     w_(s,t) = (n p)^b_(s,t) / Σ (n p)^b
/// ```
///
/// with P(x_k) = P→(x_k) for s = 0, P_dir for s = 1 and P_sub for s ≥ 2, and n = n_L light paths per image for t = 1, 1 per sample
/// of a pixel otherwise. At a connection of y_t and z_s the sums over both sides are what [`Node`]s carry:
///
/// ```text
/// 1/w = 1 + P←(y_t) · (strategies with fewer eye vertices) + P→(z_s) · (strategies with more)
/// ```
///
/// **Law.** The weights of a path sum to 1 over the strategies that can make it. The densities stand in weights only: any positive
/// function of the path would do there, and what is left out of them (the variates of weighted walks, the probability of roulette
/// in the medium's collisions) costs variance and no bias.
///
/// A strategy through a smooth surface does not exist, which the nodes know.
pub struct Weigh<'s, W: Types, K> {
    /// The scene.
    pub world: World<'s, W>,
    /// The camera.
    pub camera: &'s Camera,
    /// Emitters, on which light paths start.
    pub emitters: &'s Emitters<W::Spectrum>,
    /// Optical thickness of edges in densities.
    pub thickness: K,
    /// Rule by which weights follow from densities.
    pub heuristic: Heuristic,
    /// n_L: light paths of the whole image for one sample of each pixel; 0 without a light image, whose strategies then weigh nothing.
    pub light_paths: f64,
}

impl<W: Types, K> fmt::Debug for Weigh<'_, W, K> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { heuristic, light_paths, .. } = self;
        formatter
            .debug_struct("Weigh")
            .field("heuristic", heuristic)
            .field("light_paths", light_paths)
            .finish_non_exhaustive()
    }
}

/// The weights of the two strategies that end on a light without a light path behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtLight {
    /// Met by chance: s = 0.
    pub met: f64,
    /// Chosen by next-event estimation: s = 1.
    pub sampled: f64,
}

impl<'s, W: Types, K: WeightThickness<W::Medium>> Weigh<'s, W, K> {
    /// A vertex in the medium.
    #[inline]
    pub fn place_in_medium(&self, position: DVec3) -> Place {
        let sigma_t = self.world.volume.medium.sigma_t(position);
        let survival = self.world.volume.albedo.max_channel().min(1.0);
        Place { position, site: Site::Medium { sigma_t }, survival }
    }

    /// A vertex on a surface, with the ratio of indices with which the path goes on if that is smooth.
    #[inline]
    pub fn place_on(&self, hit: &Hit<'_, W::Spectrum>, ratio: f64) -> Place {
        let (normal, surface) = (hit.normal, hit.index);
        match hit.surface.material {
            Material::Diffuse { reflectance } => Place {
                position: hit.position,
                site: Site::Diffuse { normal, surface },
                survival: reflectance.max_channel().min(1.0),
            },
            Material::Mirror | Material::Dielectric { .. } => {
                Place { position: hit.position, site: Site::Smooth { normal, surface, ratio }, survival: 1.0 }
            }
        }
    }

    /// y_2, the first vertex of an eye subpath.
    ///
    /// P→(y_2) = importance · D E: 1/(d² cos³ A) is the density of a point per pixel sample. antwerpen-2011 eq. 3.18 prints the
    /// inverse of that Jacobian; its sections 4.1 to 6.5 use this one. Nothing ends at the camera without a light image: t = 0 has
    /// the density 0.
    pub fn first_of_eye(&self, place: Place) -> Node {
        let origin = self.camera.origin();
        let incident = (place.position - origin).normalize();
        let is_connectable = place.is_connectable();
        Node {
            place,
            incident,
            ln_forward: ln(self.camera.importance(place.position) * place.facing(incident))
                - self.between(origin, place.position),
            ln_geometry: f64::NEG_INFINITY,
            ln_connectable: if is_connectable { ln(self.light_paths) } else { f64::NEG_INFINITY },
            ln_before: f64::NEG_INFINITY,
        }
    }

    /// z_2, the first vertex of a light subpath from `end`.
    pub fn first_of_light(&self, end: &LightEnd<'_>, place: Place) -> Node {
        let (towards, _) = end.seen_from(place.position);
        let thickness = self.to_light(end, &place);
        let ln_start = ln(end.pdf_start());
        let ln_direct = if place.is_connectable() { ln(end.pdf_direct(&place)) } else { f64::NEG_INFINITY };
        Node {
            place,
            incident: -towards,
            ln_forward: end.ln_emitted(&place) - thickness,
            ln_geometry: end.ln_met(&place) - thickness,
            ln_connectable: ln_direct - ln_start,
            ln_before: self.heuristic.scale(-ln_start),
        }
    }

    /// The node behind `previous`.
    #[inline]
    pub fn next(&self, previous: &Node, place: Place) -> Node {
        let thickness = self.between(previous.place.position, place.position);
        Node::after(previous, place, thickness, (&self.world.volume.phase, self.heuristic))
    }

    /// The weight of a connection of y_t and z_s, s ≥ 2, t ≥ 2.
    #[inline(never)]
    pub fn connection(&self, y: &Node, z: &Node) -> f64 {
        let offset = z.place.position - y.place.position;
        let squared = offset.length_squared();
        let direction = offset / squared.sqrt();
        let thickness = self.between(y.place.position, z.place.position);
        let phase = &self.world.volume.phase;
        // One edge, drawn from either side: q p_ω D E/r².
        let to_y = z.place.scatter(phase, z.incident, -direction) * y.place.facing(direction) / squared;
        let to_z = y.place.scatter(phase, y.incident, direction) * z.place.facing(direction) / squared;
        let heuristic = self.heuristic;
        let fewer = heuristic.scale(ln(to_y) - thickness) + y.ln_others(phase, heuristic, direction);
        let more = heuristic.scale(ln(to_z) - thickness) + z.ln_others(phase, heuristic, -direction);
        heuristic.weight(fewer, more)
    }

    /// The weight of t = 1: z_s, s ≥ 2, connected with the pinhole.
    #[inline(never)]
    pub fn light_image(&self, z: &Node) -> f64 {
        let origin = self.camera.origin();
        let direction = (origin - z.place.position).normalize();
        let thickness = self.between(origin, z.place.position);
        let drawn = self.camera.importance(z.place.position) * z.place.facing(direction);
        let ln_drawn = ln(drawn) - thickness - ln(self.light_paths);
        let heuristic = self.heuristic;
        let more = heuristic.scale(ln_drawn) + z.ln_others(&self.world.volume.phase, heuristic, direction);
        heuristic.weight(f64::NEG_INFINITY, more)
    }

    /// The weights of s = 0 and s = 1 for the eye vertex y_t, t ≥ 2, before a light; 0 for what does not exist.
    #[inline(never)]
    pub fn at_light(&self, y: &Node, end: &LightEnd<'_>) -> AtLight {
        let place = &y.place;
        let (direction, _) = end.seen_from(place.position);
        let (phase, heuristic) = (&self.world.volume.phase, self.heuristic);
        let thickness = self.to_light(end, place);
        // Three densities of one end: chosen for the vertex, met by a direction of it, or the start of a light path; behind the
        // last the recursion goes on.
        let sampled = if place.is_connectable() { ln(end.pdf_direct(place)) } else { f64::NEG_INFINITY };
        let met = ln(place.scatter(phase, y.incident, direction)) + end.ln_met(place) - thickness;
        let started = ln(end.pdf_start()) + end.ln_emitted(place) - thickness;
        let [sampled, met, started] = [sampled, met, started].map(|ln| heuristic.scale(ln));
        let connected = started + y.ln_others(phase, heuristic, direction);
        let weight = |own: f64, fewer: f64, more: f64| {
            if own == f64::NEG_INFINITY { 0.0 } else { heuristic.weight(fewer - own, more - own) }
        };
        AtLight {
            met: weight(met, heuristic.add(sampled, connected), f64::NEG_INFINITY),
            sampled: weight(sampled, connected, met),
        }
    }

    fn between(&self, a: DVec3, b: DVec3) -> f64 {
        between(self.world.volume, &self.thickness, a, b)
    }

    pub(crate) fn to_light(&self, end: &LightEnd<'_>, place: &Place) -> f64 {
        match end.position() {
            Some(position) => self.between(position, place.position),
            None => {
                let (towards, _) = end.seen_from(place.position);
                beyond(self.world.volume, &self.thickness, place.position, towards)
            }
        }
    }
}

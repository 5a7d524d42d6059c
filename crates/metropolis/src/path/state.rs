//! A light path as the state of a chain.

use super::coordinates::{Made, ln_product};
use super::vertex::Continuation;
use super::{Met, PathEdge, PathSite, PathVertex, PathWorld, Towards};
use fairflight_bidirectional::{Found, Site, Subpath};
use fairflight_elementary::ln;
use fairflight_media::Line;
use fairflight_paths::transport::Light;
use fairflight_scene::{Material, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// A path x_0 … x_k from the pinhole to a light, with what scattering and edges are made of.
///
/// **Measure.** Area on surfaces, volume in the medium, solid angle at an infinitely far end, counting measure at the pinhole and at lights without
/// extent: raab-2008 section 2 in one measure. Its contribution there is
///
/// ```text
/// f(x) = importance(x_1) D(x_1) T · Π_(0<i<k) D(x_i) D(x_(i+1))/r² T V · Π_(0<i<k) f_s(x_i) · L_e(x_k)
/// ```
///
/// with D = |cosine| on a surface and 1 elsewhere, f_s = 1/π · reflectance on one side, or σ_t · albedo · phase. A smooth vertex has no place of its own:
/// f_s = F/ratio there, with Fresnel's share F of what is reflected or refracted and the ratio of indices light side/eye side, and it stands for the
/// Dirac of a density that is ratio · |cosine| per solid angle towards the light, and |cosine|/ratio towards the camera
/// (`Place::scatter` of the bidirectional integrator has the same convention, but no F, which cancels there).
#[derive(Debug, Default, PartialEq)]
pub struct PathState {
    /// x_0 … x_k.
    pub vertices: Vec<PathVertex>,
    /// The edge behind each vertex but the last.
    pub edges: Vec<PathEdge>,
    /// Column and row of x_1's image, with their fractions.
    pub film: [f64; 2],
}

/// Written into a path, another allocates nothing where that was as long.
impl Clone for PathState {
    fn clone(&self) -> Self {
        Self { vertices: self.vertices.clone(), edges: self.edges.clone(), film: self.film }
    }

    fn clone_from(&mut self, other: &Self) {
        self.vertices.clone_from(&other.vertices);
        self.edges.clone_from(&other.edges);
        self.film = other.film;
    }
}

impl PathState {
    /// k: the number of edges.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Returns true for the state that no path was written into.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// The pixel of the path.
    #[inline]
    #[must_use]
    pub fn pixel(&self) -> [u32; 2] {
        self.film.map(|coordinate| coordinate as u32)
    }

    /// The product of reflectances, albedos and the strength of the light.
    #[inline]
    #[must_use]
    pub fn colour(&self) -> DVec3 {
        self.vertices.iter().fold(DVec3::ONE, |product, vertex| product * vertex.colour)
    }

    /// ln f, by the greatest channel, computed anew from vertices and edges.
    #[must_use]
    pub fn ln_contribution(&self, world: &dyn PathWorld) -> f64 {
        ln_product(world, self, 0..self.len(), |_| Made::Connected, false) + ln(self.colour().max_element())
    }

    /// Writes the path that a strategy of the bidirectional integrator found; false where rounding puts x_1 beside the image. Its weight f/p is the
    /// value that was found, of which the sum over strategies is the contribution of the path by all of them.
    ///
    /// Estimates of transmittance are drawn anew, as a path of that weight has them ([`EdgeTransmittance::ln_found`](super::EdgeTransmittance::ln_found)),
    /// whatever those were that its weight was found with.
    pub fn set_found<C: Spectrum>(
        &mut self,
        world: &dyn PathWorld,
        (found, eye, light): (&Found<C>, &Subpath<C>, &Subpath<C>),
        source: &mut dyn UniformSource,
    ) -> bool {
        let origin = world.camera().origin();
        self.vertices.clear();
        self.vertices.push(PathVertex { position: origin, site: PathSite::Pinhole, colour: DVec3::ONE });
        for place in found.places(eye, light) {
            let (site, colour) = match place.site {
                Site::Medium { sigma_t } => (PathSite::Medium { sigma_t }, world.albedo()),
                Site::Diffuse { normal, surface } => {
                    let Material::Diffuse { reflectance } = world.surface(surface).0 else {
                        unreachable!("the vertex was diffuse")
                    };
                    (PathSite::Diffuse { normal, surface }, reflectance)
                }
                // Which way it goes, and how much, is seen when both neighbours are known.
                Site::Smooth { normal, surface, ratio } => {
                    (PathSite::Smooth { normal, surface, ratio, reflects: false, share: 1.0 }, DVec3::ONE)
                }
            };
            self.vertices.push(PathVertex { position: place.position, site, colour });
        }
        let (end, at) = found.light_end(light);
        let site = match end {
            Light::Surface(surface) => PathSite::Lamp { normal: world.outer_side(surface, at).0, surface },
            Light::Source(index) if world.point_light(index).is_some() => PathSite::Point(index),
            Light::Constant | Light::Map(_) | Light::Source(_) => PathSite::Far(end),
        };
        let place = if let Light::Source(index) = end { world.point_light(index) } else { None };
        let position = place.unwrap_or(at);
        self.vertices.push(PathVertex { position, site, colour: world.strength(end, at) });
        self.edges.clear();
        for i in 0..self.vertices.len() - 1 {
            let segment = self.segment(i);
            let (direction, length) = (segment.line.direction, segment.length);
            self.edges.push(PathEdge {
                direction,
                length,
                ln_transmittance: world.ln_found(&segment, source),
            });
        }
        for i in 1..self.len() {
            self.set_passage(world, i);
        }
        let film = world.camera().film(self.film_point());
        self.film = film.unwrap_or_default();
        film.is_some()
    }

    /// A point that the first edge goes through.
    fn film_point(&self) -> DVec3 {
        self.vertices[0].position + self.edges[0].direction
    }

    /// Tells reflection from refraction at a smooth vertex by its edges, and finds the share of light that goes this way.
    fn set_passage(&mut self, world: &dyn PathWorld, i: usize) {
        let (before, behind) = (self.edges[i - 1].direction, self.edges[i].direction);
        let PathSite::Smooth { normal, reflects, .. } = &mut self.vertices[i].site else { return };
        *reflects = normal.dot(before) * normal.dot(behind) < 0.0;
        // Where rounding says that nothing is refracted, next to nothing is.
        if let Some(continuation) = self.pass(world, i, before) {
            self.vertices[i].site = continuation.site;
        }
    }

    /// Reflection or refraction at the smooth vertex `i`, of its kind, for what comes along `incident` from the camera's side.
    pub(super) fn pass(&self, world: &dyn PathWorld, i: usize, incident: DVec3) -> Option<Continuation> {
        let PathVertex { position, site, .. } = self.vertices[i];
        let PathSite::Smooth { surface, reflects, .. } = site else { return None };
        let outer = world.outer_side(surface, position).0;
        let outside = outer.dot(incident) < 0.0;
        let normal = if outside { outer } else { -outer };
        let met = Met { distance: 0.0, position, normal, outside, surface };
        Continuation::at(world, &met, incident, reflects, Towards::Light)
    }

    /// One of the vertices between the ends that are of some kind, each as likely as the others.
    pub(super) fn choose_vertex(
        &self,
        is_one: impl Fn(&PathVertex) -> bool,
        source: &mut dyn UniformSource,
    ) -> Option<usize> {
        let inner = 1..self.len();
        let count = inner.clone().filter(|&i| is_one(&self.vertices[i])).count();
        let chosen = (source.next_uniform() * count as f64) as usize;
        inner.filter(|&i| is_one(&self.vertices[i])).nth(chosen)
    }

    /// The segment of edge `i` between the vertices as they are.
    #[must_use]
    pub fn segment(&self, i: usize) -> Segment {
        let [from, to] = [&self.vertices[i], &self.vertices[i + 1]];
        if matches!(to.site, PathSite::Far(_)) {
            let line = Line { origin: from.position, direction: to.position };
            return Segment { line, length: f64::INFINITY, from: from.surface(), to: None };
        }
        let offset = to.position - from.position;
        let length = offset.length();
        let line = Line { origin: from.position, direction: offset / length };
        Segment { line, length, from: from.surface(), to: to.surface() }
    }
}

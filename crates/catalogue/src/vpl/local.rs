//! One point lit by a few virtual point lights, by quadrature.

use fairflight_compensation::Compensation;
use fairflight_laws::{NotFinite, Run, measure};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Homogeneous, Line, Medium};
use fairflight_paths::transport::{Lobe, MadeOf, Types, Vertex, World};
use fairflight_paths::{Heuristic, RayTransmittance, SamplingExtinction, Walk};
use fairflight_scene::{Geometry, Lights, Material, Segment, Source, Surfaces, Volume};
use fairflight_sources::UniformSource;
use fairflight_stats::{Reference, Verdict, judge};
use fairflight_vpl::{Connected, Connections, Correction, Gather, Pairing, Term, Vpl};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// A point `y`, virtual point lights, and point lights, in an endless homogeneous medium or in none, among rectangles that are as large
/// as the region around `y` in which anything is compensated.
///
/// **Law.** With one step of compensation, over what the correction draws alone,
///
/// ```text
/// E[connections + correction] = Σ_k c(y, k) + ∫ f(y)·|cos θ_y| τ(y, x) ρ(x) (G − b)₊/G · ( D(x) + Σ_k c(x, k) ) dt dω
/// ```
///
/// where c is a bounded connection, D the light of point lights, ρ(x) is σ_s, and at a surface, without dt, the reflectance (raab-2008
/// eq. 15). It says how every strategy has to be normalised, for any number of lights.
#[derive(Clone, Debug)]
pub struct Local {
    /// Homogeneous, endless as seen from here.
    pub volume: Volume<Homogeneous, HenyeyGreenstein, f64>,
    /// g.
    pub mean_cosine: f64,
    /// Rectangles, diffuse and without emission.
    pub surfaces: Surfaces<f64>,
    /// Point lights outside of the region.
    pub lights: Lights<f64>,
    /// A few.
    pub vpls: Vec<Vpl<f64>>,
    /// The point.
    pub y: Vertex,
    /// b \[1/length²\].
    pub bound: f64,
}

impl Local {
    /// The gathering of these lights by `walk` and `shadow`.
    pub fn gather<R: SamplingExtinction, T: RayTransmittance<Homogeneous>>(
        &self,
        walk: Walk<R>,
        shadow: T,
    ) -> Gather<'_, MadeOf<f64, Homogeneous, HenyeyGreenstein, Surfaces<f64>, R, T>> {
        Gather {
            world: World::new(&self.volume, &self.surfaces, &self.lights),
            vpls: &self.vpls,
            term: Term::Bounded(self.bound),
            heuristic: Heuristic::Balance,
            walk,
            shadow,
        }
    }

    /// Judges connections and `correction` at y by quadrature.
    ///
    /// # Errors
    /// If an estimate is no number.
    pub fn check<R: SamplingExtinction, T: RayTransmittance<Homogeneous>>(
        &self,
        (walk, shadow): (Walk<R>, T),
        correction: &Compensation<'_>,
        reference: &Reference,
        run: Run,
    ) -> Result<Verdict, NotFinite> {
        let mut gather = self.gather(walk, shadow);
        let mut correction = correction.clone();
        let pairing = correction.pairing();
        let measured = measure(run.seed, run.samples, |source| {
            estimate(&mut gather, &mut correction, pairing, &self.y, source)
        })?;
        Ok(judge(&measured, &reference.with_mild_tails(), run.alpha))
    }

    /// The right side of the law. Its error is the difference to half of the resolution: the midpoint rule converges with the
    /// square, kinks included.
    #[must_use]
    pub fn reference(&self) -> Reference {
        let [coarse, fine] = [1, 2].map(|factor| self.compensation(factor));
        let connections = self.connections(&self.y);
        Reference { error: (fine - coarse).abs(), ..Reference::exact(connections + fine) }
    }

    /// Bounds of the bounded connections at a vertex, and of what one in the region gets of the point lights.
    #[must_use]
    pub(crate) fn greatest(&self) -> (f64, f64) {
        let g = self.mean_cosine;
        let scatters = FRAC_1_PI.max((1.0 + g) / (4.0 * PI * (1.0 - g) * (1.0 - g)));
        let power: f64 = self.vpls.iter().map(|vpl| vpl.power).sum();
        let radius = 1.0 / self.bound.sqrt();
        let emitters = self.lights.sources.iter().map(|light| {
            let Source::Point { position, power } = light else { return 0.0 };
            let distance = position.distance(self.y.position) - radius;
            power / (4.0 * PI * distance * distance) * scatters
        });
        (power * scatters * scatters * self.bound, emitters.sum())
    }

    /// Light at y that bounding takes away from all that is scattered once more on the way.
    fn compensation(&self, factor: u32) -> f64 {
        let (turns, cosines, radii) = (36 * factor, 48 * factor, 24 * factor);
        let middle = |i: u32, of: u32| (f64::from(i) + 0.5) / f64::from(of);
        // About the normal, so that a hemisphere ends at the border of cells.
        let axis = match self.y.lobe {
            Lobe::Diffuse { normal, .. } => normal,
            Lobe::Phase { incident } => incident,
        };
        let across = axis.any_orthonormal_vector();
        let third = axis.cross(across);
        let (sigma_t, albedo) = (self.sigma_t(), self.volume.albedo);
        let mut sum = 0.0;
        for i in 0..cosines {
            let cosine = 1.0 - 2.0 * middle(i, cosines);
            let sine = (1.0 - cosine * cosine).sqrt();
            for j in 0..turns {
                let (up, right) = (TAU * middle(j, turns)).sin_cos();
                let direction = cosine * axis + sine * (right * across + up * third);
                let cos_y = cosine_at(&self.y, direction);
                if cos_y <= 0.0 {
                    continue;
                }
                let scattering = self.scatters(&self.y, direction) * cos_y;
                // G = cos θ_y/r² in the medium: b is reached there.
                let mut end = (cos_y / self.bound).sqrt();
                let mut along = 0.0;
                if let Some((distance, x, reflectance)) = self.surface_behind(direction) {
                    let lost = 1.0 - self.bound * distance * distance / (cos_y * cosine_at(&x, -direction));
                    if lost > 0.0 {
                        along += reflectance * (-sigma_t * distance).exp() * lost * self.arriving(&x);
                    }
                    end = end.min(distance);
                }
                if sigma_t > 0.0 {
                    for k in 0..radii {
                        let r = end * middle(k, radii);
                        let position = self.y.position + r * direction;
                        let x = Vertex { position, lobe: Lobe::Phase { incident: direction } };
                        let lost = 1.0 - self.bound * r * r / cos_y;
                        let density = albedo * sigma_t * (-sigma_t * r).exp() * end / f64::from(radii);
                        along += density * lost * self.arriving(&x);
                    }
                }
                sum += scattering * along;
            }
        }
        sum * 2.0 * TAU / f64::from(cosines * turns)
    }

    pub(crate) fn sigma_t(&self) -> f64 {
        self.volume.medium.sigma_t(DVec3::ZERO)
    }

    /// Phase function or BRDF of a vertex, written anew.
    fn scatters(&self, vertex: &Vertex, towards: DVec3) -> f64 {
        let Lobe::Phase { incident } = vertex.lobe else { return FRAC_1_PI };
        let g = self.mean_cosine;
        (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * incident.dot(towards)).powf(1.5))
    }

    /// The nearest surface that y sees, as a vertex, and its reflectance.
    fn surface_behind(&self, direction: DVec3) -> Option<(f64, Vertex, f64)> {
        let line = Line { origin: self.y.position, direction };
        let segment = Segment { line, length: f64::INFINITY, from: self.y.surface(), to: None };
        let hit = self.surfaces.intersect(&segment)?;
        let Material::Diffuse { reflectance } = hit.surface.material else { return None };
        let lobe = Lobe::Diffuse { normal: hit.normal, surface: hit.index };
        Some((hit.distance, Vertex { position: hit.position, lobe }, reflectance))
    }

    /// T V between two points.
    fn visibility(&self, from: &Vertex, to: DVec3, to_surface: Option<usize>) -> f64 {
        let offset = to - from.position;
        let length = offset.length();
        let line = Line { origin: from.position, direction: offset / length };
        let segment = Segment { line, length, from: from.surface(), to: to_surface };
        if self.surfaces.is_occluded(&segment) { 0.0 } else { (-self.sigma_t() * length).exp() }
    }

    /// D(x) + Σ_k c(x, k).
    fn arriving(&self, x: &Vertex) -> f64 {
        let mut sum = self.connections(x);
        for light in &self.lights.sources {
            let Source::Point { position, power } = light else { continue };
            let offset = *position - x.position;
            let towards = offset.normalize();
            let irradiance = power / (4.0 * PI * offset.length_squared()) * cosine_at(x, towards);
            if irradiance > 0.0 {
                sum += irradiance * self.scatters(x, towards) * self.visibility(x, *position, None);
            }
        }
        sum
    }

    /// Σ_k c(x, k).
    fn connections(&self, x: &Vertex) -> f64 {
        let mut sum = 0.0;
        for Vpl { vertex, power, .. } in &self.vpls {
            let offset = vertex.position - x.position;
            // No direction is defined there.
            if offset == DVec3::ZERO {
                continue;
            }
            let towards = offset.normalize();
            let cosines = cosine_at(x, towards) * cosine_at(vertex, -towards);
            let is_same = x.surface().is_some() && x.surface() == vertex.surface();
            if cosines > 0.0 && !is_same {
                let geometric = (cosines / offset.length_squared()).min(self.bound);
                sum += power
                    * self.scatters(x, towards)
                    * self.scatters(vertex, -towards)
                    * geometric
                    * self.visibility(x, vertex.position, vertex.surface());
            }
        }
        sum
    }
}

fn cosine_at(vertex: &Vertex, direction: DVec3) -> f64 {
    match vertex.lobe {
        Lobe::Diffuse { normal, .. } => normal.dot(direction),
        Lobe::Phase { .. } => 1.0,
    }
}

/// Connections and correction at one point, once, as [`VplIntegrator`](fairflight_vpl::VplIntegrator) adds them up.
pub fn estimate<W: Types>(
    gather: &mut Gather<'_, W>,
    correction: &mut impl Correction<W>,
    pairing: Pairing,
    y: &Vertex,
    source: &mut impl UniformSource,
) -> W::Spectrum {
    let count = gather.vpls.len();
    let (which, scale) = match pairing {
        Pairing::Every => (Connected::All, 1.0),
        Pairing::One => {
            let index = (source.next_uniform() * count as f64) as usize;
            (Connected::One(index), count as f64)
        }
    };
    let connected = gather.connected(y, which, source);
    (connected + correction.recover(Connections { gather, y, which }, source)) * scale
}

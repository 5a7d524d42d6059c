//! Paths that are used by all pixels of a group (bekaert-2002, antwerpen-2011 section 4.7).

mod density;
mod groups;
#[cfg(test)]
mod tests;

pub use groups::PixelGroups;

use self::density::{Factors, Origin, Second, between, factors};
use super::{One, PathSampling};
use crate::transport::{EmitterSample, Event, Lobe, Scattered, Types, Vertex, World};
use crate::{Heuristic, Integrator, Walk};
use fairflight_collision::{Albedo, SingleParticle, Version};
use fairflight_media::{Line, LineThickness, PhaseFunction};
use fairflight_scene::{Geometry, Hit, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// Path tracing in which each pixel of a group uses the paths of all.
///
/// ```text
/// each pixel: fly to its first vertex x_1, connect that with lights
/// each pixel j: go on from x_1^j to a second vertex x_2^j, and from there on as a path tracer
///     each pixel i: take what leaves x_2^j towards x_1^i, with the weight P_i(x_2^j)/Σ_k P_k(x_2^j)
/// ```
///
/// with the density of x_2 drawn from x_1^k, P_k = q s(x_1^k → x_2) D(x_2) σ_t(x_2) T V/r²: survival of roulette, BRDF · cosine or phase function, cosine
/// at a surface, and the distance's density (raab-2008 eq. 12), of which σ_t is the same for all k. A direction that leaves everything is a second vertex
/// at infinity, without D/r². A smooth surface has no density to be met from elsewhere: what is behind it is its own pixel's.
///
/// **Law.** E of each pixel is that of the path tracer: f_i/Σ_k P_k summed over the tails is the balance heuristic over the pixels that x_2 may have
/// come from (antwerpen-2011 section 4.7 with veach-1995), ∫ f_i Σ_j P_j/Σ_k P_k. Behind x_2 the direction to x_3 has been drawn from
/// the lobe as j sees it, and weighs P_i s_i(x_3)/Σ_k P_k s_k(x_3), likewise. Weights between directions and light points at x_2 know the
/// group by the density Σ_k P_k s_k/Σ_k P_k, whatever the pixel.
///
/// **Assumes** a transmittance in closed form, since P stands in the contribution: an estimate would be a bias. And that flights from x_1 have the density
/// σ_t T itself: σ_samp ≥ σ_t; [`unlawful`](Self::unlawful) counts where it was not.
///
/// **Variance.** No weight is above 1. What is left of a pixel's own noise is that of its first vertex and its lights. Pixels of a group share their tails:
/// the variance of an image's mean is seen between passes only.
///
/// **Cost.** For n pixels n² visibilities and transmittances.
pub struct PathReuse<'s, W: Types> {
    world: World<'s, W>,
    walk: Walk<W::Sampling>,
    shadow: W::Shadow,
    heuristic: Heuristic,
    max_vertices: u32,
    group: Vec<Option<Origin<W::Spectrum>>>,
    densities: Vec<f64>,
    truncated: u64,
    unlawful: u64,
}

impl<W: Types> fmt::Debug for PathReuse<'_, W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("PathReuse").field("truncated", &self.truncated).finish_non_exhaustive()
    }
}

/// A weight of an analog flight is 1 to so much: the rounding of a hundred thousand collisions.
const ANALOG: f64 = 1e-10;

impl<'s, W: Types<Medium: LineThickness>> PathReuse<'s, W> {
    /// Paths through `world` that fly by `walk`, connected with lights through `shadow`.
    pub fn new(
        world: World<'s, W>,
        walk: Walk<W::Sampling>,
        shadow: W::Shadow,
        heuristic: Heuristic,
    ) -> Self {
        let (group, densities) = (Vec::new(), Vec::new());
        let (max_vertices, truncated, unlawful) = (u32::MAX, 0, 0);
        Self { world, walk, shadow, heuristic, max_vertices, group, densities, truncated, unlawful }
    }

    /// The same with at most `max_vertices` ≥ 2 vertices on surfaces and in the medium: a bias where a path has more.
    #[must_use]
    pub fn with_max_vertices(self, max_vertices: u32) -> Self {
        Self { max_vertices: max_vertices.max(2), ..self }
    }

    /// The number of paths that were cut so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// The number of flights that met an extinction above the sampling extinction so far: each is a bias.
    pub fn unlawful(&self) -> u64 {
        self.unlawful
    }

    /// Draws one estimate \[radiance\] for each of `lines`, of unit direction, in place of what `radiances`, as many, hold.
    pub fn radiances(
        &mut self,
        lines: &[Line],
        radiances: &mut [W::Spectrum],
        source: &mut impl UniformSource,
    ) {
        self.radiances_by(lines, radiances, Factors::density, source);
    }

    /// The same, by what is made of the factors of densities: a mistake in them is a twin.
    fn radiances_by(
        &mut self,
        lines: &[Line],
        radiances: &mut [W::Spectrum],
        density: impl Fn(Factors) -> f64,
        source: &mut impl UniformSource,
    ) {
        assert_eq!(lines.len(), radiances.len(), "a radiance for each line");
        let mut group = std::mem::take(&mut self.group);
        group.clear();
        for (line, radiance) in lines.iter().zip(radiances.iter_mut()) {
            *radiance = W::Spectrum::ZERO;
            group.push(self.first(line, radiance, source));
        }
        for index in 0..group.len() {
            self.go_on((&group, index), radiances, &density, source);
        }
        self.group = group;
    }

    /// The first vertex of a path, and the light that is seen on the way there and sent to it by emitters.
    fn first(
        &mut self,
        line: &Line,
        radiance: &mut W::Spectrum,
        source: &mut impl UniformSource,
    ) -> Option<Origin<W::Spectrum>> {
        let Self { world, walk, shadow, heuristic, .. } = self;
        let collisions = world.collisions(walk);
        let mut throughput = W::Spectrum::splat(1.0);
        let mut segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        for _ in 0..self.max_vertices {
            let hit = world.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let direction = segment.line.direction;
            let (vertex, factor) = match world.follow(walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => (vertex, energy),
                Event::Passed { weight } => {
                    throughput = throughput * weight;
                    let Some(hit) = hit else {
                        *radiance += throughput * world.background(*heuristic, None, direction);
                        return None;
                    };
                    *radiance += throughput * hit.surface.emission;
                    if let Some(passage) = world.pass(&hit, direction, source) {
                        throughput = throughput * passage.radiance_scale;
                        let line = Line { origin: hit.position, direction: passage.direction };
                        segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                        continue;
                    }
                    world.diffuse_vertex(&hit).expect("what is not smooth is diffuse")
                }
                Event::Absorbed => return None,
                Event::Truncated => break,
            };
            throughput = throughput * factor;
            *radiance += throughput * world.emitters_at(*heuristic, &vertex, shadow, source);
            let survival = factor.magnitude().min(1.0);
            return (survival > 0.0).then(|| Origin {
                vertex,
                survival,
                carried: throughput * (1.0 / survival),
            });
        }
        self.truncated += 1;
        None
    }

    /// Goes on from the first vertex of one pixel, and gives all of them what is found.
    fn go_on(
        &mut self,
        (group, own): (&[Option<Origin<W::Spectrum>>], usize),
        radiances: &mut [W::Spectrum],
        density: &impl Fn(Factors) -> f64,
        source: &mut impl UniformSource,
    ) {
        let Some(origin) = &group[own] else { return };
        if source.next_uniform() >= origin.survival {
            return;
        }
        let world = self.world;
        let phase = &world.volume.phase;
        let direction = origin.vertex.sample(phase, source.next_uniform(), source.next_uniform());
        let mut segment = origin.vertex.leave(direction, f64::INFINITY);
        let hit = world.surfaces.intersect(&segment);
        segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
        // All collisions of matter, none of them absorbed: their density is σ_t T, the albedo is left to the energy.
        let albedo = Albedo::new(1.0).expect("an albedo of 1 is one");
        let analog = (SingleParticle { version: Version::NonTerminating, albedo }, world.volume.albedo);
        let (second, weight) = match world.follow(&self.walk, &analog, &segment, source) {
            Event::Scattered { vertex, energy } => {
                let size = world.volume.albedo.magnitude();
                let weight = if size > 0.0 { energy.magnitude() / size } else { 1.0 };
                (Second::Vertex(vertex, energy, None), weight)
            }
            Event::Passed { weight } => {
                let Some(hit) = hit else {
                    self.unlawful += u64::from((weight - 1.0).abs() > ANALOG);
                    let second = Second::Escaped(direction);
                    return self.share((group, own), &second, radiances, density, source);
                };
                match world.diffuse_vertex(&hit) {
                    Some((vertex, reflectance)) => (Second::Vertex(vertex, reflectance, Some(hit)), weight),
                    None => {
                        let pdf_solid_angle = origin.vertex.pdf_solid_angle(phase, direction);
                        let from = Scattered { vertex: origin.vertex, pdf_solid_angle };
                        let found = self.behind(&from, direction, &hit, source);
                        radiances[own] += origin.carried * found;
                        return;
                    }
                }
            }
            Event::Absorbed => return,
            Event::Truncated => {
                self.truncated += 1;
                return;
            }
        };
        self.unlawful += u64::from((weight - 1.0).abs() > ANALOG);
        self.share((group, own), &second, radiances, density, source);
    }

    /// The light of a smooth surface that a path has met, and what comes through it.
    fn behind(
        &mut self,
        from: &Scattered,
        direction: DVec3,
        hit: &Hit<'_, W::Spectrum>,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let Self { world, walk, shadow, heuristic, max_vertices, truncated, .. } = self;
        let mut radiance = world.emission(*heuristic, Some(from), direction, hit);
        let passage = world.pass(hit, direction, source).expect("what is not diffuse is smooth");
        let line = Line { origin: hit.position, direction: passage.direction };
        let segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
        let how = (&mut PathSampling::by(*heuristic), *max_vertices - 2);
        let traced = world.trace(walk, how, (segment, None), shadow, source);
        *truncated += u64::from(traced.is_cut);
        radiance += traced.radiance * passage.radiance_scale;
        radiance
    }

    /// Gives each pixel its share of what leaves a second vertex towards its first one.
    fn share(
        &mut self,
        (group, own): (&[Option<Origin<W::Spectrum>>], usize),
        second: &Second<'_, W::Spectrum>,
        radiances: &mut [W::Spectrum],
        density: &impl Fn(Factors) -> f64,
        source: &mut impl UniformSource,
    ) {
        let world = self.world;
        let phase = &world.volume.phase;
        let mut densities = std::mem::take(&mut self.densities);
        densities.clear();
        densities.extend(group.iter().enumerate().map(|(index, origin)| {
            let factors = origin.as_ref().and_then(|origin| factors(&world, origin, second, index == own));
            factors.map_or(0.0, density)
        }));
        // Of a path that is lost in rounding for all of them the own one knows better.
        if densities[own] == 0.0 {
            densities.fill(0.0);
            densities[own] = 1.0;
        }
        let whole: f64 = densities.iter().sum();
        let pixels = || {
            group.iter().zip(&densities).enumerate().filter_map(|(index, (origin, &density))| {
                origin.as_ref().filter(|_| density > 0.0).map(|origin| (index, origin, density))
            })
        };
        match second {
            Second::Escaped(direction) => {
                for (index, Origin { vertex, carried, .. }, density) in pixels() {
                    let from = scattered(&world, vertex, *direction);
                    let light = world.background(self.heuristic, Some(&from), *direction);
                    radiances[index] += *carried * light * (density / whole);
                }
            }
            Second::Vertex(vertex, factor, hit) => {
                if let Some(hit) = hit.filter(|hit| hit.surface.emits()) {
                    for (index, Origin { vertex: first, carried, .. }, density) in pixels() {
                        let (direction, distance) = between(first, vertex);
                        let from = scattered(&world, first, direction);
                        let hit = Hit { distance, ..hit };
                        let light = world.emission(self.heuristic, Some(&from), direction, &hit);
                        radiances[index] += *carried * light * (density / whole);
                    }
                }
                // BRDF · cosine or phase function of the second vertex, as a pixel sees it.
                let seen = |first: &Vertex, direction: DVec3| match vertex.lobe {
                    Lobe::Diffuse { .. } => vertex.pdf_solid_angle(phase, direction),
                    Lobe::Phase { .. } => phase.eval(between(first, vertex).0.dot(direction)),
                };
                // Their sum, weighted with the densities.
                let all = |direction| -> f64 {
                    pixels().map(|(_, origin, density)| density * seen(&origin.vertex, direction)).sum()
                };
                let Self { walk, shadow, heuristic, max_vertices, truncated, .. } = self;
                world.kept_emitters(
                    (vertex, |direction| all(direction) / whole),
                    (One, |_: &EmitterSample<_>| 1.0),
                    source,
                    |sampled, _, source| {
                        let visibility = world.attenuated_visibility(&sampled.segment, shadow, source);
                        let weight = sampled
                            .pdf_solid_angle
                            .map_or(1.0, |pdf| heuristic.mis_weight(pdf, sampled.scattered) / pdf);
                        let light = *factor * sampled.arriving * (weight * visibility / whole);
                        for (index, origin, density) in pixels() {
                            let seen = seen(&origin.vertex, sampled.segment.line.direction);
                            radiances[index] += origin.carried * light * (density * seen);
                        }
                    },
                );
                let survival = factor.magnitude().min(1.0);
                if source.next_uniform() < survival {
                    let direction = vertex.sample(phase, source.next_uniform(), source.next_uniform());
                    let all = all(direction);
                    let from = Scattered { vertex: *vertex, pdf_solid_angle: all / whole };
                    let start = (vertex.leave(direction, f64::INFINITY), Some(from));
                    let how = (&mut PathSampling::by(*heuristic), *max_vertices - 2);
                    let traced = world.trace(walk, how, start, shadow, source);
                    *truncated += u64::from(traced.is_cut);
                    let light = *factor * traced.radiance * (1.0 / (survival * all));
                    for (index, origin, density) in pixels() {
                        let seen = seen(&origin.vertex, direction);
                        radiances[index] += origin.carried * light * (density * seen);
                    }
                }
            }
        }
        self.densities = densities;
    }
}

fn scattered<W: Types>(world: &World<'_, W>, vertex: &Vertex, direction: DVec3) -> Scattered {
    let pdf_solid_angle = vertex.pdf_solid_angle(&world.volume.phase, direction);
    Scattered { vertex: *vertex, pdf_solid_angle }
}

/// A group of one pixel.
impl<W: Types<Medium: LineThickness>> Integrator<W::Spectrum> for PathReuse<'_, W> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> W::Spectrum {
        let mut radiance = [W::Spectrum::ZERO];
        self.radiances(std::slice::from_ref(line), &mut radiance, source);
        radiance[0]
    }
}

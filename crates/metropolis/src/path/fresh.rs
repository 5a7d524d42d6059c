//! A fresh path, independent of the old one.

use super::proposal::Proposal;
use super::{NoMajorant, PathSite, PathState, View};
use crate::Mutation;
use fairflight_bidirectional::laws::{LnDensities, Path};
use fairflight_bidirectional::{Exact, Found, LightEnd, Place, Site, Strategy, Subpath, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_elementary::{exp, ln};
use fairflight_media::LineThickness;
use fairflight_paths::transport::{Emitters, Light, Types, World};
use fairflight_paths::{Heuristic, SamplingExtinction, Walk};
use fairflight_scene::{Camera, Geometry, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// Bidirectional mutation: a path by one strategy of the bidirectional integrator, whatever the old one was (antwerpen-2011 section 6.2).
///
/// ```text
/// choose the number of edges k ≥ 2 with the probability (1 − γ) γ^(k − 2), and one of its k + 1 strategies
/// walk from the camera and from a light as far as that asks, and connect
/// ```
///
/// **Ratio.** W(Y)/W(X) with W = f/q, and q the density of a proposal: the sum over *all* strategies of their probability and density, for whichever was chosen.
/// So densities stand in the ratio, where a surrogate would be a bias, and have to be true: that asks for a closed form of transmittance, and for walks that
/// end as particles do (Woodcock's, at a majorant). Of a vertex in the medium that ends a subpath the density has the albedo, which survival has at
/// the others; every smooth vertex has its share of light, in all strategies; a light is chosen among all for s = 1, and a part of the background where a path left.
///
/// It is what makes a chain of the other mutations ergodic. Length and kind of paths change.
pub struct Fresh<'s, W: Types> {
    weigh: Weigh<'s, W, Exact>,
    view: View<'s, W, Exact>,
    walk: Walk<W::Sampling>,
    more: f64,
    eye: Subpath<W::Spectrum>,
    light: Subpath<W::Spectrum>,
    places: Vec<Place>,
    densities: LnDensities,
}

impl<W: Types> fmt::Debug for Fresh<'_, W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Fresh").field("more", &self.more).finish_non_exhaustive()
    }
}

impl<'s, M: LineThickness, R: SamplingExtinction + Copy, W: Types<Medium = M, Sampling = R>> Fresh<'s, W> {
    /// Paths of k edges with a probability that falls by `more` in (0, 1) for each edge, by walks at the rate `majorant`.
    ///
    /// # Errors
    /// If that lies below the bound of the medium somewhere, or the medium has none.
    pub fn new(
        (world, camera): (World<'s, W>, &'s Camera),
        emitters: &'s Emitters<W::Spectrum>,
        majorant: R,
        more: f64,
    ) -> Result<Self, NoMajorant> {
        debug_assert!(more > 0.0 && more < 1.0, "a share of longer paths of {more}");
        let bound = world.volume.medium.upper_bound();
        if !M::IS_EMPTY && bound.is_none_or(|bound| bound > majorant.lowest()) {
            return Err(NoMajorant { majorant: majorant.lowest(), bound });
        }
        // As many light paths as pixels: a pixel is one of all for a path from the camera.
        let light_paths = camera.resolution().map(f64::from).iter().product();
        let heuristic = Heuristic::Balance;
        Ok(Self {
            weigh: Weigh { world, camera, emitters, thickness: Exact, heuristic, light_paths },
            view: View { world, camera, edges: Exact },
            walk: Walk::new(Version::Terminating, majorant),
            more,
            eye: Subpath::empty(),
            light: Subpath::empty(),
            places: Vec::new(),
            densities: LnDensities::default(),
        })
    }

    /// The number of lights among which s = 1 chooses, and that of the background's parts.
    fn counts(&self) -> [usize; 2] {
        let World { surfaces, lights, .. } = self.weigh.world;
        let maps = lights.background.maps.len();
        let constant = usize::from(lights.background.constant != W::Spectrum::ZERO);
        [lights.sources.len() + maps + surfaces.emitters().len(), constant + maps]
    }

    /// The `index`-th of the lights among which s = 1 chooses.
    fn light(&self, index: usize) -> Light {
        let World { surfaces, lights, .. } = self.weigh.world;
        let (sources, maps) = (lights.sources.len(), lights.background.maps.len());
        match index {
            _ if index < sources => Light::Source(index),
            _ if index < sources + maps => Light::Map(index - sources),
            _ => Light::Surface(surfaces.emitters()[index - sources - maps]),
        }
    }

    /// ln q, but for a constant.
    fn ln_density(&mut self, x: &PathState) -> f64 {
        let k = x.len();
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        let mut ln_shares = 0.0;
        places.extend(x.vertices[1..k].iter().map(|vertex| {
            let survival = vertex.colour.max_element().min(1.0);
            let site = match vertex.site {
                PathSite::Medium { sigma_t } => Site::Medium { sigma_t },
                PathSite::Diffuse { normal, surface } => Site::Diffuse { normal, surface },
                PathSite::Smooth { normal, surface, ratio, share, .. } => {
                    ln_shares += ln(share);
                    Site::Smooth { normal, surface, ratio }
                }
                _ => unreachable!("light is scattered between the ends of a path"),
            };
            Place { position: vertex.position, site, survival }
        }));
        let last = &x.vertices[k];
        let light = match last.site {
            PathSite::Point(index) => Light::Source(index),
            PathSite::Far(light) => light,
            PathSite::Lamp { surface, .. } => Light::Surface(surface),
            _ => unreachable!("a path ends on a light"),
        };
        let path =
            Path { places, end: LightEnd::new(&self.weigh.world, self.weigh.emitters, light, last.position) };
        let [lights, parts] = self.counts().map(|count| count as f64);
        let ln_albedo = |i: usize| {
            if x.vertices[i].is_in_medium() { ln(x.vertices[i].colour.max_element()) } else { 0.0 }
        };
        let densities = self.weigh.ln_densities(&path, &mut self.densities);
        let of_strategy = |t: usize| {
            densities[t - 1]
                + match k + 1 - t {
                    0 if matches!(last.site, PathSite::Far(_)) => -ln(parts),
                    0 => 0.0,
                    1 => ln_albedo(t - 1) - ln(lights),
                    _ if t == 1 => ln_albedo(1),
                    _ => ln_albedo(t - 1) + ln_albedo(t),
                }
        };
        let greatest = (1..=k + 1).map(of_strategy).fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = (1..=k + 1).map(|t| exp(of_strategy(t) - greatest)).sum();
        self.places = path.places;
        k as f64 * ln(self.more) - ln(k as f64 + 1.0) + ln_shares + greatest + ln(sum)
    }

    /// Walks as far as a strategy asks. Returns the end on the light where that comes from no light subpath; `None` where the walks did not get so far.
    fn walk(
        &mut self,
        strategy: Strategy,
        source: &mut impl UniformSource,
    ) -> Option<Option<(Light, DVec3)>> {
        let Strategy { light: s, eye: t } = strategy;
        let walking = |max_vertices: u32| Walking { max_vertices, ..Walking::new(self.walk) };
        let Self { weigh, eye, light, .. } = self;
        if s >= 2 {
            weigh.walk_from_light(&walking(s - 1), light, source);
            if light.steps.len() + 1 < s as usize {
                return None;
            }
        }
        if t == 1 {
            return Some(None);
        }
        let [columns, rows] = weigh.camera.resolution().map(f64::from);
        let film = [columns * source.next_uniform(), rows * source.next_uniform()];
        weigh.walk_from_eye(&walking(t - 1), &weigh.camera.ray([0, 0], film), eye, source);
        let last = eye.steps.get(t as usize - 2);
        let at_end = match (s, last) {
            (0, Some(step)) => (Light::Surface(step.node.place.surface()?), step.node.place.position),
            (0, None) => {
                let (towards, _) = eye.escape.filter(|_| eye.steps.len() + 2 == t as usize)?;
                let part = (source.next_uniform() * self.counts()[1] as f64) as usize;
                let maps = self.weigh.world.lights.background.maps.len();
                (if part < maps { Light::Map(part) } else { Light::Constant }, towards)
            }
            (1, Some(step)) => {
                let vertex = step.node.vertex()?;
                let chosen = self.light((source.next_uniform() * self.counts()[0] as f64) as usize);
                let mut at = None;
                self.weigh.world.sample_emitters(&vertex, source, |sampled, _| {
                    if sampled.light == chosen {
                        let line = sampled.segment.line;
                        let is_near = matches!(chosen, Light::Surface(_));
                        at = Some(if is_near { line.at(sampled.segment.length) } else { line.direction });
                    }
                });
                (chosen, at?)
            }
            (_, Some(_)) => return Some(None),
            (_, None) => return None,
        };
        Some(Some(at_end))
    }
}

impl<M: LineThickness, R: SamplingExtinction + Copy, W: Types<Medium = M, Sampling = R>> Mutation<PathState>
    for Fresh<'_, W>
{
    fn propose(
        &mut self,
        x: &PathState,
        y: &mut PathState,
        mut source: &mut dyn UniformSource,
    ) -> Option<f64> {
        let k = 2 + (source.next_exponential() / -ln(self.more)) as u32;
        let t = 1 + (source.next_uniform() * f64::from(k + 1)) as u32;
        let strategy = Strategy { light: k + 1 - t, eye: t };
        let end = self.walk(strategy, &mut source)?;
        let found = Found { strategy, value: W::Spectrum::ZERO, weight: 1.0, end };
        if !y.set_found(&self.view, (&found, &self.eye, &self.light), source) {
            return None;
        }
        if strategy.light > 0 {
            let ends = [t as usize - 1, t as usize];
            if ends.iter().any(|&i| y.vertices[i].is_smooth()) {
                return None;
            }
            Proposal { world: &self.view, x, y, source, stretch: None }.connect(ends[0])?;
        }
        let proposed = y.ln_contribution(&self.view);
        if proposed == f64::NEG_INFINITY {
            return None;
        }
        let of_proposal = proposed - self.ln_density(y);
        Some(of_proposal - x.ln_contribution(&self.view) + self.ln_density(x))
    }
}

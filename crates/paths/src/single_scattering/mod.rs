//! Light that is scattered once on its way from lights without extent (szirmay-kalos-2017 section 4.3, eq. 22).

mod line;
mod marching;
mod primary;
mod scattering_driven;
mod source_driven;
mod technique;

pub use crate::Heuristic;
pub use line::LineSampled;
pub use marching::Marching;
pub use primary::{Primary, SharedExplorers, Tracked};
pub use scattering_driven::ScatteringDriven;
pub use source_driven::SourceDriven;
pub use technique::{Sampling, Technique};

use crate::{Integrator, RayTransmittance};
use fairflight_media::{Extinction, Line, Medium, PhaseFunction, Ray};
use fairflight_scene::{Connection, Lights, Source, Spectrum, Volume};
use fairflight_sources::UniformSource;

/// Background behind the medium, and one scattering event of each light on the way:
///
/// > L = T(S) L_background + ∫ T(s) σ_t(s) a ρ(ω·ω′) E(s) T(s → light) ds
///
/// with the irradiance E of the light, Φ/(4π d²) for a point.
///
/// One walk per ray estimates T at every s. Each distance that a technique of intensity λ(s) chooses scores
/// c(s)/λ(s) · mis_weight, c the integrand; the interaction points of the walk are a technique of intensity σ_samp themselves
/// (their sum is *not* divided by their number). Shadow rays draw variates of their own: their estimate is independent of what chose
/// the point and of the walk, so that the product has the product of the expectations.
///
/// **Law.** E\[radiance\] = L, for every control, every sampling extinction that is positive where the medium is, any number of
/// samples and either heuristic. The samples of source and scattering are stratified over one ray, which changes no expectation.
///
/// **Variance.** Finite for a point light except where the line of the pixel passes through it: attenuation and scattering alone
/// score 1/d² there, source does not.
#[derive(Debug)]
pub struct SingleScattering<'s, M, P, C, W, T> {
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    sampling: Sampling,
    samples: u32,
    primary: W,
    shadow: T,
    /// Points that scattering-driven sampling is fitted through, where the walk has no control.
    explorers: SharedExplorers,
    fit: ScatteringDriven,
    /// Scores of interaction points, for resampling.
    candidates: Vec<(usize, C, f64)>,
}

/// Error of a ray that cannot be sampled as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SamplingError {
    /// The Cauchy distribution needs a light at a finite distance.
    #[error("source-driven sampling needs point lights; light {light} is directional")]
    DirectionalLight {
        /// Index of the light among the sources.
        light: usize,
    },
    /// No sample, no estimate.
    #[error("samples_per_ray must be at least 1, found 0")]
    NoSamples,
    /// Attenuation-driven sampling needs a walk with interaction points.
    #[error("attenuation-driven sampling needs an estimator that walks")]
    NoInteractions,
}

impl<'s, M: Medium, P, C: Spectrum, W: Primary<M>, T> SingleScattering<'s, M, P, C, W, T> {
    /// Single scattering in `volume`: transmittance of camera rays by `primary`, of shadow rays by `shadow`, `samples` distances per
    /// ray, light and technique (attenuation apart, whose number is random). `explorers` fit the scattering-driven technique
    /// where `primary` has no control of its own.
    ///
    /// # Errors
    /// If the sampling does not fit the lights or the walk, or `samples` is 0.
    pub fn new(
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        (sampling, samples): (Sampling, u32),
        primary: W,
        shadow: T,
        explorers: SharedExplorers,
    ) -> Result<Self, SamplingError> {
        if samples == 0 {
            return Err(SamplingError::NoSamples);
        }
        let directional = lights.sources.iter().position(|light| matches!(light, Source::Directional { .. }));
        if let (true, Some(light)) = (sampling.uses(Technique::Source), directional) {
            return Err(SamplingError::DirectionalLight { light });
        }
        if sampling.uses(Technique::Attenuation) && primary.intensity() <= 0.0 {
            return Err(SamplingError::NoInteractions);
        }
        let (fit, candidates) = (ScatteringDriven::default(), Vec::new());
        Ok(Self { volume, lights, sampling, samples, primary, shadow, explorers, fit, candidates })
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, W: Primary<M>, T: RayTransmittance<M>>
    SingleScattering<'_, M, P, C, W, T>
{
    /// σ_t a ρ E at `s`, without both transmittances, and how the point sees the light.
    #[inline]
    fn scattered(
        &self,
        ray: &Ray<&M>,
        light: &Source<C>,
        s: f64,
        sigma_t: f64,
    ) -> Option<(C, Connection<C>)> {
        let connection = light.connect(ray.world_point(s))?;
        let phase = self.volume.phase.eval(ray.world_line().direction.dot(connection.towards));
        Some((self.volume.albedo * connection.irradiance * (sigma_t * phase), connection))
    }

    /// c(s) with the transmittance of the shadow ray: all of the integrand but T(0, s).
    #[inline]
    fn integrand(
        &mut self,
        ray: &Ray<&M>,
        light: &Source<C>,
        s: f64,
        sigma_t: f64,
        source: &mut impl UniformSource,
    ) -> C {
        let Some((scattered, connection)) = self.scattered(ray, light, s, sigma_t) else { return C::ZERO };
        let shadow = self.volume.towards(ray.world_point(s), &connection);
        scattered * self.shadow.estimate(&shadow, source)
    }

    /// The expected number of samples of a technique per length at `s`.
    #[inline]
    fn intensity(&self, technique: Technique, cauchy: Option<&SourceDriven>, s: f64) -> f64 {
        let n = f64::from(self.samples);
        match technique {
            Technique::Attenuation => self.primary.intensity(),
            Technique::Source => cauchy.map_or(0.0, |cauchy| n * cauchy.pdf_distance(s)),
            Technique::Scattering => n * self.fit.pdf_distance(s),
        }
    }

    /// The scores of all samples of one technique; `other` is the one it is combined with.
    fn technique(
        &mut self,
        ray: &Ray<&M>,
        light: &Source<C>,
        technique: Technique,
        other: Option<(Technique, Heuristic)>,
        source: &mut impl UniformSource,
    ) -> C {
        let cauchy = match *light {
            Source::Point { position, .. } => {
                Some(SourceDriven::new(ray.world_line(), ray.length(), position))
            }
            Source::Directional { .. } => None,
        };
        let mut sum = C::ZERO;
        let count = match technique {
            Technique::Attenuation => self.primary.interactions().len(),
            Technique::Source | Technique::Scattering => self.samples as usize,
        };
        for k in 0..count {
            let (s, sigma_t, transmittance) = if technique == Technique::Attenuation {
                let point = self.primary.interactions()[k];
                (point.distance, point.sigma_t, self.primary.transmittance_before(k))
            } else {
                let u = (k as f64 + source.next_uniform()) / f64::from(self.samples);
                let s = match (technique, &cauchy) {
                    (Technique::Source, Some(cauchy)) => cauchy.sample(u),
                    _ => self.fit.sample(u),
                };
                (s, ray.sigma_t(s), self.primary.transmittance(ray, s))
            };
            let own = self.intensity(technique, cauchy.as_ref(), s);
            let mis_weight = other.map_or(1.0, |(other, heuristic)| {
                heuristic.mis_weight(own, self.intensity(other, cauchy.as_ref(), s))
            });
            if transmittance != 0.0 && sigma_t != 0.0 {
                sum += self.integrand(ray, light, s, sigma_t, source) * (transmittance * mis_weight / own);
            }
        }
        sum
    }

    /// Estimates by as many interaction points as samples, chosen in proportion to |score without shadow ray|; each stands for the
    /// sum of all.
    fn resampled(&mut self, ray: &Ray<&M>, light: &Source<C>, source: &mut impl UniformSource) -> C {
        self.candidates.clear();
        let mut total = 0.0;
        for (k, point) in self.primary.interactions().iter().enumerate() {
            let Some((scattered, _)) = self.scattered(ray, light, point.distance, point.sigma_t) else {
                continue;
            };
            let score = scattered * (self.primary.transmittance_before(k) / self.primary.intensity());
            total += score.mean().abs();
            self.candidates.push((k, score, total));
        }
        let mut sum = C::ZERO;
        if total == 0.0 {
            return sum;
        }
        for k in 0..self.samples {
            let target = (f64::from(k) + source.next_uniform()) / f64::from(self.samples) * total;
            let chosen = self.candidates.partition_point(|&(.., below)| below <= target);
            // Rounding may put the target on the total itself: the last candidate that can be chosen is meant.
            let chosen = chosen.min(self.candidates.partition_point(|&(.., below)| below < total));
            let (index, score, _) = self.candidates[chosen];
            let probability = score.mean().abs() / total;
            let s = self.primary.interactions()[index].distance;
            let Some(connection) = light.connect(ray.world_point(s)) else { continue };
            let shadow = self.volume.towards(ray.world_point(s), &connection);
            let transmittance = self.shadow.estimate(&shadow, source);
            sum += score * (transmittance / (probability * f64::from(self.samples)));
        }
        sum
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, W: Primary<M>, T: RayTransmittance<M>> Integrator<C>
    for SingleScattering<'_, M, P, C, W, T>
{
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let background = self.lights.background.radiance(line.direction);
        let Some(ray) = self.volume.enter(line, None) else { return background };
        self.primary.trace(&ray, source);
        let mut radiance = background * self.primary.transmittance(&ray, ray.length());
        if self.sampling.uses(Technique::Scattering) {
            let fitted = self.primary.fitted().unwrap_or_else(|| self.explorers.next_ray(&ray));
            self.fit.refit(fitted, ray.length());
        }
        for light in &self.lights.sources {
            radiance += match self.sampling {
                Sampling::One(technique) => self.technique(&ray, light, technique, None, source),
                Sampling::AttenuationResampled => self.resampled(&ray, light, source),
                Sampling::Two(first, second, heuristic) => {
                    let mut both = self.technique(&ray, light, first, Some((second, heuristic)), source);
                    both += self.technique(&ray, light, second, Some((first, heuristic)), source);
                    both
                }
            };
        }
        radiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::Isotropic;
    use fairflight_media::{Bounds, Homogeneous};
    use fairflight_scene::Background;
    use fairflight_sources::Scripted;
    use fairflight_transmittance::Regular;
    use glam::{DVec3, dvec3};
    use std::f64::consts::PI;

    /// Samples of the source technique by hand: each is the integrand over its density and their number, at the variate (k + u)/n.
    #[test]
    fn a_score_is_the_integrand_over_the_intensity() {
        let (sigma_t, albedo, power) = (0.4_f64, 0.6, 9.0);
        let volume = Volume {
            medium: Homogeneous::new(sigma_t).unwrap(),
            bounds: Bounds::sphere(DVec3::ZERO, 1.5).unwrap(),
            albedo,
            phase: Isotropic,
        };
        let position = dvec3(0.0, 0.5, 0.3);
        let lights =
            Lights { background: Background::dark(), sources: vec![Source::point(position, power).unwrap()] };
        let line = Line { origin: -4.0 * DVec3::Z, direction: DVec3::Z };
        // Distances along the ray in the ball, which begins at −1.5.
        let technique = SourceDriven::new(&Line { origin: -1.5 * DVec3::Z, ..line }, 3.0, position);
        let integrand = |s: f64| {
            let squared = 0.25 + (s - 1.8) * (s - 1.8);
            let irradiance = power / (4.0 * PI * squared) * (-sigma_t * squared.sqrt()).exp();
            (-sigma_t * s).exp() * sigma_t * albedo / (4.0 * PI) * irradiance
        };
        for samples in [1, 3] {
            let explorers = SharedExplorers::new(2, 1).unwrap();
            let sampling = (Sampling::One(Technique::Source), samples);
            let mut integrator =
                SingleScattering::new(&volume, &lights, sampling, Regular, Regular, explorers).unwrap();
            let variates = [0.25, 0.6, 0.9];
            let count = samples as usize;
            let mut source = Scripted::new(variates.into_iter().take(count));
            let found: f64 = integrator.radiance(&line, &mut source);
            let n = f64::from(samples);
            let exact: f64 = (0..count)
                .map(|k| {
                    let s = technique.sample((k as f64 + variates[k]) / n);
                    integrand(s) / (n * technique.pdf_distance(s))
                })
                .sum();
            assert!((found - exact).abs() < 1e-12 * exact, "{samples}: {found} for {exact}");
        }
    }
}

//! Existence of the second moment of a walk: the criticality of its squared energy.

use crate::{SamplingExtinction, Walk};
use fairflight_collision::CollisionModel;
use fairflight_media::{Extinction, Line, Medium, PhaseFunction, Ray};
use fairflight_scene::{Spectrum, Volume};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Factor by which the expected squared energy of the particles in the medium grows from one collision to the next.
///
/// The k-th collision of a walk with energy E contributes E\[E_k²; still inside\] to the second moment of every score; these
/// fall as factor^k where the walk is subcritical, and the sum diverges where factor ≥ 1. In an endless medium the factor of the
/// non-terminating version is E\[q_sum²\], above 1 where r > 2/(1 + a) often enough; leaking out of the bounds lowers it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// The factor per collision, as measured.
    pub factor: f64,
    /// Standard error of the factor, from independent populations.
    pub standard_error: f64,
}

/// The conclusion from a [`Growth`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criticality {
    /// The second moment exists: the factor is below 1 by four standard errors.
    Subcritical,
    /// The measurement cannot tell.
    Unclear,
    /// No second moment: the factor is above 1 by four standard errors.
    Supercritical,
}

impl Growth {
    /// Compares the factor with 1: below, above, or neither by four standard errors.
    #[must_use]
    pub fn criticality(&self) -> Criticality {
        let margin = 4.0 * self.standard_error;
        if self.factor + margin < 1.0 {
            Criticality::Subcritical
        } else if self.factor - margin > 1.0 {
            Criticality::Supercritical
        } else {
            Criticality::Unclear
        }
    }
}

/// Independent populations.
const POPULATIONS: usize = 8;
/// Particles of each.
const PARTICLES: usize = 512;
/// Collisions before the populations have forgotten where they started, and collisions that are measured.
const SETTLING: u32 = 20;
const MEASURED: u32 = 30;

/// True if the bounds of the medium alone tell that the squared energy of a walk grows nowhere: 0 ≤ r ≤ 2/(1 + a) at every collision, so
/// that q_sum = a r + |1 − r| ≤ 1, and no gain. Where they do not tell, it is for [`second_moment_growth`] to measure.
pub fn grows_nowhere<M: Medium, P, C: Spectrum>(
    volume: &Volume<M, P, C>,
    walk: &Walk<impl SamplingExtinction>,
) -> bool {
    let albedo = volume.albedo.max_channel();
    let most = 2.0 / (1.0 + albedo) * walk.sampling().lowest();
    albedo <= 1.0
        && volume.medium.lower_bound().is_some_and(|bound| bound >= 0.0)
        && volume.medium.upper_bound().is_some_and(|bound| bound <= most)
}

/// Estimates the growth in `volume` by power iteration, as neutron transport estimates a multiplication factor: a population of
/// particles makes one collision at a time; each then counts E\[W²\] of its branches, and as many particles as before are
/// chosen in proportion to what they count. The mean count over the generations is the factor.
///
/// The particles start uniformly in the ball around the bounds, isotropically. What is estimated is a property of the medium, not
/// of a camera: the slowest mode to die out. `None` where no collision ever happened: an empty medium.
pub fn second_moment_growth<M: Medium, P: PhaseFunction, C: Spectrum>(
    volume: &Volume<M, P, C>,
    walk: &Walk<impl SamplingExtinction>,
    source: &mut impl UniformSource,
) -> Option<Growth> {
    let factors: Vec<f64> = (0..POPULATIONS).filter_map(|_| population(volume, walk, source)).collect();
    if factors.len() < 2 {
        return None;
    }
    let n = factors.len() as f64;
    let factor = factors.iter().sum::<f64>() / n;
    let variance = factors.iter().map(|f| (f - factor) * (f - factor)).sum::<f64>() / (n - 1.0);
    Some(Growth { factor, standard_error: (variance / n).sqrt() })
}

/// The mean count per generation of one population; `None` once nobody is left.
fn population<M: Medium, P: PhaseFunction, C: Spectrum>(
    volume: &Volume<M, P, C>,
    walk: &Walk<impl SamplingExtinction>,
    source: &mut impl UniformSource,
) -> Option<f64> {
    let (model, ratio) = walk.collisions(volume);
    // The greatest channel's energy is multiplied by this at each scattering: above 1 for a gain, which the probabilities leave out.
    let gain = ratio.max_channel();
    let mut particles: Vec<Line> = (0..PARTICLES).map(|_| start(volume, source)).collect();
    let mut next: Vec<(Line, f64)> = Vec::with_capacity(2 * PARTICLES);
    let mut sum = 0.0;
    for generation in 0..SETTLING + MEASURED {
        next.clear();
        let mut count = 0.0;
        for &line in &particles {
            let ray: Ray<&M> = volume.inside(line);
            let depth = source.next_exponential();
            let Some((s, sigma_samp)) = walk.sampling().fly(&line, 0.0, ray.length(), depth) else {
                continue;
            };
            let r = ray.sigma_t(s) / sigma_samp;
            let origin = ray.world_point(s);
            // Both branches, each with its share of the second moment: no need to choose.
            let scattered = gain * gain * model.scattered(r).moment(2);
            let transmitted = model.transmitted(r).moment(2);
            count += scattered + transmitted;
            if scattered > 0.0 {
                let (u, v) = (source.next_uniform(), source.next_uniform());
                let direction = volume.phase.sample(line.direction, u, v).direction;
                next.push((Line { origin, direction }, scattered));
            }
            next.push((Line { origin, ..line }, transmitted));
        }
        if count <= 0.0 || !count.is_finite() {
            return None;
        }
        if generation >= SETTLING {
            sum += count / PARTICLES as f64;
        }
        resample(&next, count, &mut particles, source);
    }
    Some(sum / f64::from(MEASURED))
}

/// Draws as many particles as before, each in proportion to what it counts: systematic resampling with one variate.
fn resample(from: &[(Line, f64)], count: f64, particles: &mut [Line], source: &mut impl UniformSource) {
    let shift = source.next_uniform();
    let mut entries = from.iter();
    let mut chosen = entries.next();
    let mut reached = chosen.map_or(0.0, |entry| entry.1);
    let total = particles.len() as f64;
    for (k, particle) in particles.iter_mut().enumerate() {
        let target = (k as f64 + shift) / total * count;
        while reached <= target {
            let Some(entry) = entries.next() else { break };
            chosen = Some(entry);
            reached += entry.1;
        }
        if let Some((line, _)) = chosen {
            *particle = *line;
        }
    }
}

/// A point inside the bounds and a direction, both uniform.
fn start<M, P, C>(volume: &Volume<M, P, C>, source: &mut impl UniformSource) -> Line {
    let (center, radius) = volume.bounds.enclosing_ball();
    // Rejection: the bounds fill a share of their ball; flat ones are met by their middle.
    const TRIES: u32 = 10_000;
    let mut unit = || {
        let mut draw = || 2.0 * source.next_uniform() - 1.0;
        DVec3::new(draw(), draw(), draw())
    };
    let mut in_ball = || loop {
        let point = unit();
        let squared = point.length_squared();
        if squared <= 1.0 && squared > 0.0 {
            return point;
        }
    };
    let direction = in_ball().normalize();
    for _ in 0..TRIES {
        let origin = center + radius * in_ball();
        if volume.bounds.contains(origin) {
            return Line { origin, direction };
        }
    }
    Line { origin: center, direction }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Uniform;
    use fairflight_collision::Version;
    use fairflight_media::phase::Isotropic;
    use fairflight_media::{Bounds, Homogeneous};
    use fairflight_sources::Seeded;

    fn growth(sigma_t: f64, radius: f64, albedo: f64, sigma_samp: f64, version: Version) -> Growth {
        let volume = Volume {
            medium: Homogeneous::new(sigma_t).unwrap(),
            bounds: Bounds::sphere(DVec3::ZERO, radius).unwrap(),
            albedo,
            phase: Isotropic,
        };
        let walk = Walk::new(version, Uniform::new(sigma_samp).unwrap());
        second_moment_growth(&volume, &walk, &mut Seeded::new(5)).unwrap()
    }

    #[test]
    fn in_a_large_medium_it_is_the_square_of_q_sum() {
        // r = 1.5, a = 0.8: q_sum = 1.7 per collision, and hardly anything leaks from 2000 mean free paths.
        let growth = growth(1.5, 2000.0, 0.8, 1.0, Version::NonTerminating);
        assert!((growth.factor - 1.7 * 1.7).abs() < 0.02, "{growth:?}");
        assert_eq!(growth.criticality(), Criticality::Supercritical);
    }

    #[test]
    fn terminating_grows_by_its_survivors() {
        // r = 1.05 ≤ 2/1.8: energies are ±1, a r + r − 1 = 0.89 survive.
        let growth = growth(1.05, 2000.0, 0.8, 1.0, Version::Terminating);
        assert!((growth.factor - 0.89).abs() < 0.01, "{growth:?}");
        assert_eq!(growth.criticality(), Criticality::Subcritical);
    }

    #[test]
    fn a_gain_counts_squared() {
        // r = 1, a = 1.2: all is scattered, with 1.2 times the energy.
        let growth = growth(1.0, 1e9, 1.2, 1.0, Version::NonTerminating);
        assert!((growth.factor - 1.44).abs() < 1e-9, "{growth:?}");
        assert_eq!(growth.criticality(), Criticality::Supercritical);
    }

    #[test]
    fn bounds_tell_where_nothing_can_grow() {
        let nowhere = |albedo: f64, sigma_samp: f64| {
            let volume = Volume {
                medium: Homogeneous::new(1.0).unwrap(),
                bounds: Bounds::sphere(DVec3::ZERO, 1.0).unwrap(),
                albedo,
                phase: Isotropic,
            };
            grows_nowhere(&volume, &Walk::new(Version::Adaptive, Uniform::new(sigma_samp).unwrap()))
        };
        assert!(nowhere(0.7, 1.0) && nowhere(1.0, 1.0) && nowhere(0.0, 0.5) && nowhere(0.6, 0.81));
        assert!(!nowhere(0.6, 0.79) && !nowhere(1.0, 0.99) && !nowhere(1.2, 2.0));
    }

    /// Without scattering the collisions of a walk are those of a Poisson process along a straight line: at the k-th, E\[W²\] times the
    /// share that is still inside is at most (1 − r)² · 2R σ_samp/(k + 1). A walk that began anew at each collision would not leak.
    #[test]
    fn straight_walks_get_further_at_each_collision() {
        let growth = growth(3.0, 5.0, 0.0, 1.0, Version::NonTerminating);
        let generations = SETTLING..SETTLING + MEASURED;
        let greatest = generations.map(|k| 40.0 / f64::from(k + 1)).sum::<f64>() / f64::from(MEASURED);
        let margin = 5.0 * growth.standard_error;
        assert!(growth.factor > 0.0 && growth.factor < greatest + margin, "{growth:?} above {greatest}");
    }

    /// Uniform in a ball about a centre that is not the origin: mean c, E\[|p − c|²\] = 3R²/5, and directions of mean 0.
    #[test]
    fn walks_start_evenly_in_the_bounds() {
        const COUNT: u32 = 20_000;
        let (center, radius) = (DVec3::new(3.0, -2.0, 7.0), 2.0);
        let bounds = Bounds::sphere(center, radius).unwrap();
        let volume = Volume { medium: Homogeneous::new(1.0).unwrap(), bounds, albedo: 0.5, phase: Isotropic };
        let mut source = Seeded::new(3);
        let (mut from_center, mut squared, mut direction) = (DVec3::ZERO, 0.0, DVec3::ZERO);
        for _ in 0..COUNT {
            let line = start(&volume, &mut source);
            let offset = line.origin - center;
            assert!(offset.length() <= radius);
            (from_center, squared, direction) =
                (from_center + offset, squared + offset.length_squared(), direction + line.direction);
        }
        // Five standard errors: √(1/5) R and √(1/3) along an axis, R² √(3/7 − 9/25) of the square.
        let n = f64::from(COUNT);
        let error = 5.0 / n.sqrt();
        assert!((from_center / n).abs().max_element() < error * 0.2_f64.sqrt() * radius, "{from_center}");
        assert!((direction / n).abs().max_element() < error * (1.0_f64 / 3.0).sqrt(), "{direction}");
        let square = 0.6 * radius * radius;
        assert!((squared / n - square).abs() < error * 0.07_f64.sqrt() * radius * radius, "{squared}");
    }

    #[test]
    fn a_small_medium_leaks() {
        // The same r as the supercritical one, in half a mean free path.
        let growth = growth(1.5, 0.2, 0.8, 1.0, Version::NonTerminating);
        assert_eq!(growth.criticality(), Criticality::Subcritical);
    }
}

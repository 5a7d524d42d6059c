//! Statistics of an image: mean radiance, variance, cost, efficiency.

use super::canvas::{Drawn, Found, MeanVariance, Spent};
use super::pixel::Pixel;
use super::replicas::{ChainStatistics, Chains};
use crate::estimator::Preparation;
use crate::image::Image;
use crate::plan::{IntegratorPlan, ScenePlan, Tally};
use crate::result::{Provenance, number};
use fairflight_metropolis::Acceptance;
use fairflight_scene::Spectrum;
use serde::Serialize;

/// The statistics of an image, in the form of the published spec.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Statistics {
    pub image: Size,
    pub radiance: Radiance,
    pub variance: Variance,
    pub reference: Option<ReferenceError>,
    pub cost: Cost,
    pub efficiency: Efficiency,
    /// Null without a tone-mapped file.
    pub exposure: Option<ShownAt>,
    /// Null for an integrator without any.
    pub virtual_point_lights: Option<VirtualLights>,
    /// Left out for an integrator that asks no photons.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub photon_maps: Option<PhotonMaps>,
    /// Light by strategy; left out for an integrator that has one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strategies: Vec<StrategyShare>,
    /// The power of points and directions that went straight into smooth surfaces and was not followed; left out without light paths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unseen_power: Option<f64>,
    /// Chains of the replicas; left out for an integrator without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chains: Option<ChainStatistics>,
    /// Definition of mean squared error and efficiency, in words.
    pub method: String,
    pub warnings: Vec<String>,
    pub provenance: Provenance,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Size {
    pub width: u32,
    pub height: u32,
    /// Samples per pixel that were drawn.
    pub samples_per_pixel: u32,
    pub channels: usize,
}

/// Mean over pixels and channels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Radiance {
    pub mean: f64,
    #[serde(serialize_with = "number")]
    pub standard_error: Option<f64>,
    /// The mean of each channel: one if gray.
    pub channels: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Variance {
    /// Variance of one sample, averaged over pixels and channels.
    #[serde(serialize_with = "number")]
    pub mean_per_pixel: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ReferenceError {
    /// Root mean squared error over all pixels and channels.
    pub rmse: f64,
    pub file: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Cost {
    pub lookups: u64,
    /// Camera rays.
    pub rays: u64,
    /// Seconds by the clock on the wall.
    pub seconds: f64,
    /// CPU seconds over all threads.
    pub cpu_seconds: f64,
}

/// The exposure of tone-mapped files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct ShownAt {
    /// 2 to this power is the factor in front of linear radiance.
    pub stops: f64,
    /// `--exposure`, or the pilot image.
    pub from: &'static str,
}

/// Virtual point lights, and what compensates for bounding them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct VirtualLights {
    /// Number of sets, one for each sample per pixel.
    pub sets: u32,
    pub lights_per_set: f64,
    /// CPU seconds of light paths, a part of all.
    pub light_path_seconds: f64,
    /// Number of compensation vertices that were tried.
    pub compensation_vertices: u64,
    /// Share of the compensation vertices that lay where something was lost; null if none was tried.
    #[serde(serialize_with = "number")]
    pub compensation_share_inside: Option<f64>,
}

/// Photons that light paths left, found by place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct PhotonMaps {
    /// Number of maps: one for each sample per pixel, or one for all.
    pub maps: u32,
    pub photons_per_map: f64,
    /// CPU seconds of light paths, a part of all.
    pub light_path_seconds: f64,
}

/// Light that one strategy found, weighted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StrategyShare {
    /// Vertices from a light; null for all strategies of longer paths than those that are told.
    pub s: Option<u32>,
    /// Vertices from the camera.
    pub t: Option<u32>,
    /// Share of the mean radiance.
    pub share: f64,
    /// Variance of one sample in the mean of its channels, averaged over pixels; null for one sample.
    #[serde(serialize_with = "number")]
    pub variance: Option<f64>,
}

/// 1/(MSE · cost), null at zero error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Efficiency {
    #[serde(serialize_with = "number")]
    pub per_second: Option<f64>,
    #[serde(serialize_with = "number")]
    pub per_lookup: Option<f64>,
}

/// Moments of the samples, read by all writers.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    channels: usize,
    /// Samples per pixel.
    samples: u32,
    /// Mean radiance per pixel.
    means: Vec<[f64; 3]>,
    /// The mean over pixels and channels of the variance of one sample.
    variance: Option<f64>,
    /// The variance of the mean of all pixels and channels.
    mean_variance: Option<f64>,
    cost: Spent,
    strategies: Vec<Found>,
    chains: Option<Chains>,
    warning: Option<String>,
}

/// The look-ups before the first pixel, in words.
fn prepared(integrator: &IntegratorPlan) -> String {
    let told = |Preparation { lookups, purpose }: &Preparation| {
        format!("; {lookups} before the first pixel, for {purpose}, are not charged")
    };
    integrator.preparations().map(told).collect()
}

impl<C: Spectrum> From<Drawn<C>> for Moments {
    fn from(drawn: Drawn<C>) -> Self {
        let pixels = &drawn.pixels;
        let n = pixels.len() as f64;
        let sum = |values: &mut dyn Iterator<Item = Option<f64>>| values.sum::<Option<f64>>().map(|s| s / n);
        let apart = sum(&mut pixels.iter().map(Pixel::mean_variance_gray)).map(|variance| variance / n);
        Self {
            channels: C::CHANNELS,
            samples: drawn.samples,
            means: pixels.iter().map(|pixel| pixel.mean().rgb()).collect(),
            variance: sum(&mut pixels.iter().map(|pixel| pixel.variance().map(C::mean))),
            mean_variance: match drawn.mean_variance {
                MeanVariance::OfPixels { shared } => apart.zip(shared).map(|(apart, shared)| apart + shared),
                MeanVariance::OfPasses(variance) => variance,
            },
            cost: drawn.cost,
            strategies: drawn.strategies,
            chains: drawn.chains,
            warning: drawn.warning,
        }
    }
}

impl Moments {
    /// The mean radiance of each pixel, row by row from the top.
    pub fn means(&self) -> &[[f64; 3]] {
        &self.means
    }

    /// The mean over pixels and channels of the variance of one sample; `None` for one sample per pixel.
    pub fn variance(&self) -> Option<f64> {
        self.variance
    }

    /// Look-ups of the medium.
    pub fn lookups(&self) -> u64 {
        self.cost.lookups
    }

    /// CPU seconds over all threads.
    pub fn cpu_seconds(&self) -> f64 {
        self.cost.cpu_seconds
    }

    /// The image; a pixel that f32 cannot hold is named.
    pub(super) fn image(&self, plan: &ScenePlan) -> Result<Image, String> {
        let [width, height] = plan.camera.resolution().map(|side| side as usize);
        // Beyond the range of f32 the conversion gives infinity.
        let pixels: Vec<[f32; 3]> = self.means.iter().map(|mean| mean.map(|value| value as f32)).collect();
        let lost = pixels.iter().position(|pixel| pixel.iter().any(|value| !value.is_finite()));
        match lost {
            None => Ok(Image::new(width, height, pixels)),
            Some(i) => Err(format!(
                "pixel (column {}, row {}) is {:?}, beyond the range of a 32-bit float",
                i % width,
                i / width,
                self.means[i]
            )),
        }
    }

    fn mean(&self) -> [f64; 3] {
        let n = self.means.len() as f64;
        [0, 1, 2].map(|k| self.means.iter().map(|mean| mean[k]).sum::<f64>() / n)
    }

    /// Mean over pixels and channels of the squared difference.
    pub(super) fn squared_error(&self, reference: &Image) -> f64 {
        let differences = self.means.as_flattened().iter().zip(reference.pixels().as_flattened());
        let sum: f64 = differences.map(|(found, expected)| (found - f64::from(*expected)).powi(2)).sum();
        sum / (3.0 * self.means.len() as f64)
    }

    /// The statistics of what was drawn in `seconds` by the clock.
    pub(super) fn statistics(
        &self,
        plan: &ScenePlan,
        reference: Option<(&Image, String)>,
        seconds: f64,
        warnings: Vec<String>,
        (exposure, provenance): (Option<ShownAt>, Provenance),
    ) -> Statistics {
        let [width, height] = plan.camera.resolution();
        let samples = f64::from(self.samples);
        let mean = self.mean();
        let reference = reference.map(|(image, file)| (self.squared_error(image), file));
        let squared_error = match &reference {
            Some((error, _)) => Some(*error),
            None => self.variance.map(|variance| variance / samples),
        };
        let method = match &reference {
            Some(_) => {
                "MSE: mean over pixels and channels of the squared difference from the reference image"
            }
            None => {
                "MSE: sample variance / samples per pixel, mean over pixels and channels; null for one sample"
            }
        };
        let efficiency = |cost: f64| {
            squared_error.filter(|error| *error > 0.0 && cost > 0.0).map(|error| 1.0 / (error * cost))
        };
        let Spent { lookups, cpu_seconds, .. } = self.cost;
        let virtual_lights = || VirtualLights {
            sets: self.samples,
            lights_per_set: self.cost.vpls as f64 / samples,
            light_path_seconds: self.cost.light_path_seconds,
            compensation_vertices: self.cost.compensation_tried,
            compensation_share_inside: self.compensation_share(),
        };
        let maps = if plan.integrator.keeps_its_batch() { 1 } else { self.samples };
        let photon_maps = plan.integrator.photons().map(|_| PhotonMaps {
            maps,
            photons_per_map: self.cost.vpls as f64 / f64::from(maps),
            light_path_seconds: self.cost.light_path_seconds,
        });
        let shared = plan.integrator.correlation().map_or_else(String::new, |what| format!("; {what}"));
        let points = plan.points.map_or_else(String::new, |points| {
            format!("; variance and errors are those of means over {} points of a set", points.each)
        });
        Statistics {
            image: Size { width, height, samples_per_pixel: self.samples, channels: self.channels },
            radiance: Radiance {
                mean: mean[..self.channels].iter().sum::<f64>() / self.channels as f64,
                standard_error: self.mean_variance.map(f64::sqrt),
                channels: mean[..self.channels].to_vec(),
            },
            variance: Variance { mean_per_pixel: self.variance },
            reference: reference.map(|(error, file)| ReferenceError { rmse: error.sqrt(), file }),
            cost: Cost {
                lookups,
                rays: self.means.len() as u64 * u64::from(self.samples),
                seconds,
                cpu_seconds,
            },
            efficiency: Efficiency {
                per_second: efficiency(seconds),
                per_lookup: efficiency(lookups as f64),
            },
            exposure,
            virtual_point_lights: matches!(plan.integrator, IntegratorPlan::Vpl(_)).then(virtual_lights),
            photon_maps,
            strategies: self.strategies(),
            unseen_power: (self.cost.light_paths > 0)
                .then(|| self.cost.unseen_power / self.cost.light_paths as f64),
            chains: self.chains.as_ref().map(Chains::told),
            method: format!(
                "{method}; seconds by the clock on the wall; look-ups are counted while it runs{}{shared}{points}",
                prepared(&plan.integrator)
            ),
            warnings,
            provenance,
        }
    }

    /// Light by the strategies that found some.
    pub fn strategies(&self) -> Vec<StrategyShare> {
        let total: f64 = self.strategies.iter().map(|found| found.mean).sum();
        let told = Tally::strategies().zip(&self.strategies).filter(|(_, found)| found.mean != 0.0);
        told.map(|(strategy, found)| StrategyShare {
            s: strategy.map(|strategy| strategy.light),
            t: strategy.map(|strategy| strategy.eye),
            share: found.mean / total,
            variance: found.variance,
        })
        .collect()
    }

    /// Steps of chains by their kind; empty for an integrator without any.
    pub fn steps(&self) -> &[(&'static str, Acceptance)] {
        self.chains.as_ref().map_or(&[], |chains| &chains.steps)
    }

    /// The share of compensation vertices that lay where something was lost; `None` if none was tried.
    pub fn compensation_share(&self) -> Option<f64> {
        let Spent { compensation_tried, compensation_inside, .. } = self.cost;
        (compensation_tried > 0).then(|| compensation_inside as f64 / compensation_tried as f64)
    }

    /// CPU seconds of light paths, a part of all.
    pub fn light_path_seconds(&self) -> f64 {
        self.cost.light_path_seconds
    }

    /// Virtual point lights per set.
    pub fn lights_per_set(&self) -> f64 {
        self.cost.vpls as f64 / f64::from(self.samples)
    }

    /// Samples per pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Warning about the walks.
    pub(super) fn warning(&self) -> Option<String> {
        self.warning.clone()
    }

    /// Walks that were cut.
    pub(super) fn truncated(&self) -> u64 {
        self.cost.truncated
    }
}

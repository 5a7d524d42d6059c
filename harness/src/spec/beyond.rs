//! The estimators of transmittance beyond the source papers.

use super::estimator::one_of;
use super::{Node, Object};
use crate::Failure;

/// An estimator of transmittance beyond the source papers, its parameters \[1/length\] as given.
#[derive(Clone, Debug, PartialEq)]
pub enum BeyondSpec {
    /// Next-flight estimators, and their combination with ratio tracking.
    NextFlight {
        /// A claim about the field.
        majorant: f64,
        /// Which of them.
        version: NextFlightKind,
    },
    /// Power series in the optical thickness (georgiev-2019).
    PSeries {
        /// How orders are chosen.
        version: PSeriesKind,
        /// The optical thickness about which the series is; that of the field's majorant by default.
        pivot: Option<f64>,
    },
    /// The single-term estimator (fearnhead-2008).
    GeneralisedPoisson {
        /// The optical thickness about which the series is.
        pivot: f64,
        /// The mean order.
        rate: f64,
    },
    /// Unbiased ray marching (kettunen-2021) and what comes after it.
    UnbiasedRayMarching {
        /// Look-ups per comb, or the optical thickness from which the rule takes their number.
        teeth: TeethSpec,
        /// What a comb does beside its teeth.
        comb: CombKind,
        /// When to stop.
        roulette: RouletteSpec,
        /// Factors of the transmittance.
        segments: u32,
    },
    /// Debiasing by telescoping levels (misso-2022).
    Telescoping {
        /// Look-ups of the coarsest comb.
        teeth: u32,
        /// The probability of stopping at a level.
        level_ratio: f64,
        /// Whether the ends of the profile correct each comb.
        endpoint_matching: bool,
    },
    /// Jittered ratio tracking.
    JitteredRatio {
        /// Bounds of the field.
        bounds: BoundsSpec,
        /// Optical thickness of a stratum in its majorant.
        epsilon: f64,
    },
    /// Residual ratio tracking between a minorant and a majorant in cells.
    ResidualCells {
        /// The cells.
        cells: CellsSpec,
        /// Sampling extinction over the difference of the bounds.
        rate: f64,
    },
    /// Ratio tracking that adapts its sampling extinction (misso-2023).
    AdaptiveRatio {
        /// A claim about the field.
        majorant: f64,
        /// The least sampling extinction over the majorant.
        floor: f64,
    },
    /// The closed form.
    Regular,
    /// Chooses by prediction.
    Hybrid {
        /// A claim about the field; what the field declares by default.
        majorant: Option<f64>,
    },
    /// Two combs (peters-2025): biased.
    Jackknife {
        /// Look-ups per comb.
        teeth: u32,
    },
    /// The exponential of one comb: biased.
    Naive {
        /// Look-ups.
        teeth: u32,
    },
    /// Ratio tracking that learns its majorant (misso-2023): biased, consistent.
    ProgressiveMajorant {
        /// The first guess.
        start: f64,
    },
}

/// Which next-flight estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextFlightKind {
    /// Flights end at collisions with matter.
    Delta,
    /// Flights are weighted.
    Ratio,
    /// With ratio tracking, by the balance heuristic.
    Unidirectional,
    /// With ratio tracking, from both ends.
    Bidirectional,
}

/// How the orders of a power series are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PSeriesKind {
    /// Beforehand, from a Poisson law.
    Cmf,
    /// By the current weight.
    Cumulative,
    /// One term, of Poisson order.
    Ratio,
    /// All terms up to a Poisson order.
    NextFlight,
}

/// The number of look-ups of a comb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TeethSpec {
    /// As given.
    Given(u32),
    /// By the rule, from an optical thickness; from that of the field's majorant if none is given.
    Rule {
        /// The optical thickness.
        pivot: Option<f64>,
    },
}

/// What a comb does beside its teeth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CombKind {
    /// Nothing.
    Uniform,
    /// Corrects for the difference of the ends.
    EndpointMatched,
    /// And for that of the slopes.
    Bernoulli2,
    /// And for that of the curvatures.
    Bernoulli3,
    /// Sets its teeth closer to the ends.
    Periodised,
}

/// When the series of an unbiased ray march stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RouletteSpec {
    /// With this probability at once.
    Stop(f64),
    /// With what fits the variance of earlier combs.
    SelfTuned,
}

/// What is claimed of a field for jittered ratio tracking.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundsSpec {
    /// An upper bound.
    Majorant(f64),
    /// Both bounds in cells.
    Cells(CellsSpec),
}

/// Cells with a minorant and a majorant each.
#[derive(Clone, Debug, PartialEq)]
pub enum CellsSpec {
    /// So many equal ones along the profile, their bounds found from the field.
    Count(u32),
    /// Claimed.
    Given {
        /// Borders.
        edges: Vec<f64>,
        /// One lower bound per cell.
        minorants: Vec<f64>,
        /// One upper bound per cell.
        majorants: Vec<f64>,
    },
}

/// More teeth, cells or segments than this are a slip of the keyboard.
const MOST: u64 = 1_000_000;
/// P = 0.1 (kettunen-2021).
const USUAL_STOP: f64 = 0.9;

impl BeyondSpec {
    /// The names of the kinds.
    pub const KINDS: [&str; 13] = [
        "next_flight",
        "p_series",
        "generalised_poisson",
        "unbiased_ray_marching",
        "telescoping",
        "jittered_ratio",
        "residual_cells",
        "adaptive_ratio",
        "regular",
        "hybrid",
        "jackknife",
        "naive",
        "progressive_majorant",
    ];

    /// Reads the parameters of `kind`; `None` if that is no estimator of this family.
    ///
    /// # Errors
    /// If a key is missing or of the wrong kind.
    pub(super) fn read(kind: &str, object: &Object<'_>) -> Result<Option<Self>, Failure> {
        let majorant = || object.required("majorant")?.non_negative();
        let teeth = || Ok::<_, Failure>(object.required("teeth")?.integer(1, MOST)? as u32);
        Ok(Some(match kind {
            "next_flight" => Self::NextFlight {
                majorant: majorant()?,
                version: choice(
                    &object.required("version")?,
                    &[
                        ("delta", NextFlightKind::Delta),
                        ("ratio", NextFlightKind::Ratio),
                        ("unidirectional", NextFlightKind::Unidirectional),
                        ("bidirectional", NextFlightKind::Bidirectional),
                    ],
                )?,
            },
            "p_series" => Self::PSeries {
                version: choice(
                    &object.required("version")?,
                    &[
                        ("cmf", PSeriesKind::Cmf),
                        ("cumulative", PSeriesKind::Cumulative),
                        ("ratio", PSeriesKind::Ratio),
                        ("next_flight", PSeriesKind::NextFlight),
                    ],
                )?,
                pivot: object.optional("pivot").map(|node| node.non_negative()).transpose()?,
            },
            "generalised_poisson" => Self::GeneralisedPoisson {
                pivot: object.required("pivot")?.number()?,
                rate: object.required("rate")?.positive()?,
            },
            "unbiased_ray_marching" => Self::unbiased_ray_marching(object)?,
            "telescoping" => Self::Telescoping {
                teeth: teeth()?,
                level_ratio: object.required("level_ratio")?.number()?,
                endpoint_matching: flag(object, "endpoint_matching")?.unwrap_or(true),
            },
            "jittered_ratio" => Self::JitteredRatio {
                bounds: match object.optional("cells") {
                    Some(cells) => {
                        // A single bound beside the cells would be a claim that nobody uses.
                        if let Some(majorant) = object.optional("majorant") {
                            return Err(
                                majorant.reject("cells have majorants of their own: give one of the two")
                            );
                        }
                        BoundsSpec::Cells(CellsSpec::read(&cells)?)
                    }
                    None => match object.optional("majorant") {
                        Some(majorant) => BoundsSpec::Majorant(majorant.non_negative()?),
                        None => {
                            return Err(Failure::refused(
                                "estimator: jittered_ratio needs a majorant; give `majorant`, or `cells`, or use \
                                 unbiased_ray_marching, which needs none",
                            ));
                        }
                    },
                },
                epsilon: object.required("epsilon")?.positive()?,
            },
            "residual_cells" => Self::ResidualCells {
                cells: CellsSpec::read(&object.required("cells")?)?,
                rate: object.optional("rate").map_or(Ok(1.0), |node| node.positive())?,
            },
            "adaptive_ratio" => {
                Self::AdaptiveRatio { majorant: majorant()?, floor: object.required("floor")?.positive()? }
            }
            "regular" => Self::Regular,
            "hybrid" => Self::Hybrid {
                majorant: object.optional("majorant").map(|node| node.non_negative()).transpose()?,
            },
            "jackknife" => Self::Jackknife { teeth: teeth()? },
            "naive" => Self::Naive { teeth: teeth()? },
            "progressive_majorant" => {
                Self::ProgressiveMajorant { start: object.required("start")?.positive()? }
            }
            _ => return Ok(None),
        }))
    }

    fn unbiased_ray_marching(object: &Object<'_>) -> Result<Self, Failure> {
        let pivot = object.optional("pivot");
        let teeth = match (object.optional("teeth"), pivot) {
            (Some(teeth), None) => TeethSpec::Given(teeth.integer(1, MOST)? as u32),
            (Some(_), Some(pivot)) => {
                return Err(pivot.reject("is for the rule of `teeth`: give one of the two"));
            }
            (None, pivot) => TeethSpec::Rule { pivot: pivot.map(|node| node.non_negative()).transpose()? },
        };
        let matching = flag(object, "endpoint_matching")?;
        let order = object.optional("order");
        let name = object.optional("comb").map_or(Ok("uniform"), |node| node.text())?;
        let comb = match name {
            "uniform" if matching.unwrap_or(true) => CombKind::EndpointMatched,
            "uniform" => CombKind::Uniform,
            "periodised" => CombKind::Periodised,
            "bernoulli" => match object.required("order")?.integer(2, 3)? {
                2 => CombKind::Bernoulli2,
                _ => CombKind::Bernoulli3,
            },
            _ => return Err(object.required("comb")?.refuse("must be uniform, periodised or bernoulli")),
        };
        if let (true, Some(order)) = (name != "bernoulli", order) {
            return Err(order.reject("belongs to the comb bernoulli"));
        }
        if name != "uniform" && matching.is_some() {
            return Err(object.required("endpoint_matching")?.reject("belongs to the comb uniform"));
        }
        let roulette = match object.optional("roulette") {
            None => RouletteSpec::Stop(USUAL_STOP),
            Some(node) if node.text().is_ok_and(|text| text == "self_tuned") => RouletteSpec::SelfTuned,
            Some(node) => match node.within(0.0, 1.0) {
                Ok(stop) if stop < 1.0 => RouletteSpec::Stop(stop),
                _ => return Err(node.refuse("must be a probability of stopping below 1, or self_tuned")),
            },
        };
        let segments = object.optional("segments").map_or(Ok(1), |node| node.integer(1, MOST))? as u32;
        Ok(Self::UnbiasedRayMarching { teeth, comb, roulette, segments })
    }

    /// Why this cannot be prepared for many rays at once, if it cannot.
    #[must_use]
    pub fn needs_one_ray(&self) -> Option<&'static str> {
        Some(match self {
            Self::UnbiasedRayMarching { teeth: TeethSpec::Rule { .. }, .. } => {
                "the rule takes the teeth of unbiased_ray_marching from one ray, but a scene has many: give `teeth`"
            }
            Self::UnbiasedRayMarching { roulette: RouletteSpec::SelfTuned, .. } => {
                "self_tuned is fitted to one ray, but a scene has many: give a stop probability"
            }
            Self::PSeries { pivot: None, .. } => {
                "p_series takes its pivot from one ray, but a scene has many: give `pivot`"
            }
            Self::JitteredRatio { bounds: BoundsSpec::Cells(_), .. } | Self::ResidualCells { .. } => {
                "cells are given along one ray, but a scene has many: use jittered_ratio with a majorant"
            }
            Self::Hybrid { .. } => "hybrid chooses for one ray, but a scene has many",
            Self::ProgressiveMajorant { .. } => {
                "progressive_majorant learns along one ray, but a scene has many"
            }
            _ => return None,
        })
    }

    /// Whether this is a labelled biased baseline.
    #[must_use]
    pub fn is_biased_baseline(&self) -> bool {
        matches!(self, Self::Jackknife { .. } | Self::Naive { .. } | Self::ProgressiveMajorant { .. })
    }
}

impl CellsSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if !node.is_object() {
            return match node.integer(1, MOST) {
                Ok(count) => Ok(Self::Count(count as u32)),
                Err(_) => {
                    Err(node
                        .refuse("must be a number of cells, or an object of edges, minorants and majorants"))
                }
            };
        }
        let object = node.object()?;
        let spec = Self::Given {
            edges: object.required("edges")?.numbers()?,
            minorants: object.required("minorants")?.numbers()?,
            majorants: object.required("majorants")?.numbers()?,
        };
        object.finish()?;
        Ok(spec)
    }
}

/// One of several words.
fn choice<T: Copy>(node: &Node<'_>, choices: &[(&str, T)]) -> Result<T, Failure> {
    let text = node.text()?;
    choices.iter().find(|(name, _)| *name == text).map(|&(_, choice)| choice).ok_or_else(|| {
        let names: Vec<&str> = choices.iter().map(|&(name, _)| name).collect();
        node.refuse(format!("must be {}", one_of(&names)))
    })
}

fn flag(object: &Object<'_>, key: &'static str) -> Result<Option<bool>, Failure> {
    object.optional(key).map(|node| node.boolean()).transpose()
}

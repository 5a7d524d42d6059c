//! The estimator of an experiment.

use super::{BeyondSpec, Node};
use crate::Failure;
use fairflight_collision::{Albedo, Version};
use fairflight_transmittance::Offset;

/// An estimator of transmittance with its parameters \[1/length\] as given, in the coordinates of the profile spec.
#[derive(Clone, Debug, PartialEq)]
pub enum EstimatorSpec {
    /// 1 if a flight escapes, else 0.
    Woodcock {
        /// A claim about the field.
        majorant: f64,
    },
    /// Ratio tracking, residual ratio tracking, and all beyond.
    DoubleParticle {
        /// σ_samp.
        sampling: SamplingSpec,
        /// σ_main.
        control: ControlSpec,
    },
    /// Keeps at most one particle per collision.
    SingleParticle {
        /// How the probabilities are chosen.
        version: Version,
        /// σ_s / σ_t.
        albedo: Albedo,
        /// σ_samp.
        sampling: SamplingSpec,
        /// σ_main.
        control: ControlSpec,
    },
    /// raab-2008 algorithm 2.
    LineIntegral {
        /// A claim about the field.
        majorant: f64,
        /// Flights per estimate.
        splits: u32,
    },
    /// The biased baseline.
    RayMarching {
        /// Look-ups per estimate.
        steps: u32,
        /// Where in its step a look-up lies.
        offset: Offset,
    },
    /// One of those beyond the source papers.
    Beyond(BeyondSpec),
}

/// A sampling extinction.
#[derive(Clone, Debug, PartialEq)]
pub enum SamplingSpec {
    /// The same everywhere.
    Constant(f64),
    /// One value per cell.
    PiecewiseConstant {
        /// Borders of the cells.
        edges: Vec<f64>,
        /// Their values.
        values: Vec<f64>,
    },
}

/// A control.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlSpec {
    /// No control.
    None,
    /// The same everywhere.
    Constant(f64),
    /// Linear between nodes.
    PiecewiseLinear {
        /// The nodes.
        positions: Vec<f64>,
        /// Their values.
        sigma_main: Vec<f64>,
    },
    /// Linear through equidistant look-ups of the profile.
    Explorers {
        /// Their number.
        count: usize,
    },
}

/// More than this many explorers or steps is a slip of the keyboard.
const MOST_POINTS: u64 = 10_000_000;

impl EstimatorSpec {
    /// The names of the kinds of the source papers.
    pub const KINDS: [&str; 5] =
        ["woodcock", "double_particle", "single_particle", "line_integral", "ray_marching"];

    /// Reads `estimator`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let spec = match kind.text()? {
            "woodcock" => Self::Woodcock { majorant: object.required("majorant")?.non_negative()? },
            "double_particle" => Self::DoubleParticle {
                sampling: SamplingSpec::read(&object.required("sigma_samp")?)?,
                control: ControlSpec::read(object.optional("control"))?,
            },
            "single_particle" => Self::SingleParticle {
                version: read_version(&object.required("version")?)?,
                albedo: read_albedo(&object.required("albedo")?)?,
                sampling: SamplingSpec::read(&object.required("sigma_samp")?)?,
                control: ControlSpec::read(object.optional("control"))?,
            },
            "line_integral" => Self::LineIntegral {
                majorant: object.required("majorant")?.non_negative()?,
                splits: object.required("splits")?.integer(1, MOST_POINTS)? as u32,
            },
            "ray_marching" => Self::RayMarching {
                steps: object.required("steps")?.integer(1, MOST_POINTS)? as u32,
                offset: if object.required("jitter")?.boolean()? { Offset::Jittered } else { Offset::Fixed },
            },
            name => match BeyondSpec::read(name, &object)? {
                Some(beyond) => Self::Beyond(beyond),
                None => {
                    let names: Vec<&str> = Self::KINDS.into_iter().chain(BeyondSpec::KINDS).collect();
                    return Err(kind.refuse(format!("must be {}", one_of(&names))));
                }
            },
        };
        object.finish()?;
        Ok(spec)
    }

    /// Whether this is a labelled biased baseline.
    #[must_use]
    pub fn is_biased_baseline(&self) -> bool {
        match self {
            Self::RayMarching { .. } => true,
            Self::Beyond(beyond) => beyond.is_biased_baseline(),
            _ => false,
        }
    }
}

/// `a, b or c`
pub(super) fn one_of(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

pub(super) fn read_version(node: &Node<'_>) -> Result<Version, Failure> {
    match node.text()? {
        "terminating" => Ok(Version::Terminating),
        "non_terminating" => Ok(Version::NonTerminating),
        "adaptive" => Ok(Version::Adaptive),
        _ => Err(node.refuse("must be terminating, non_terminating or adaptive")),
    }
}

fn read_albedo(node: &Node<'_>) -> Result<Albedo, Failure> {
    Albedo::new(node.within(0.0, 1.0)?).map_err(|error| node.reject(error))
}

impl SamplingSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if !node.is_object() {
            return match node.non_negative() {
                Ok(value) => Ok(Self::Constant(value)),
                Err(_) => {
                    Err(node.refuse("must be a number of at least 0, or an object of edges and values"))
                }
            };
        }
        let object = node.object()?;
        let edges = object.required("edges")?.numbers()?;
        let values = object.required("values")?;
        for value in values.items()? {
            value.non_negative()?;
        }
        let values = values.numbers()?;
        object.finish()?;
        Ok(Self::PiecewiseConstant { edges, values })
    }
}

impl ControlSpec {
    fn read(node: Option<Node<'_>>) -> Result<Self, Failure> {
        let Some(node) = node else { return Ok(Self::None) };
        let object = node.object()?;
        let kind = object.required("kind")?;
        let spec = match kind.text()? {
            "none" => Self::None,
            "constant" => Self::Constant(object.required("sigma_main")?.number()?),
            "piecewise_linear" => Self::PiecewiseLinear {
                positions: object.required("positions")?.numbers()?,
                sigma_main: object.required("sigma_main")?.numbers()?,
            },
            "explorers" => {
                Self::Explorers { count: object.required("count")?.integer(2, MOST_POINTS)? as usize }
            }
            _ => return Err(kind.refuse("must be none, constant, piecewise_linear or explorers")),
        };
        object.finish()?;
        Ok(spec)
    }
}

//! The control of an estimator on a profile: an extinction whose transmittance is known in closed form.

use super::MOST_POINTS;
use super::sampling::clipped_nodes;
use crate::field::AnyProfile;
use crate::reader::Node;
use crate::reader::rule::{Number, Numbers, Ruled, Whole};
use crate::{Failure, kind, registry};
use fairflight_laws::scores::{Interval, Ranged};
use fairflight_media::{Breakpoints, Constant, Extinction, OpticalThickness, PiecewiseLinear, Vacuum};
use fairflight_transmittance::Explorers;
use serde_json::{Value, json};

kind! {
    /// No control.
    NoControlSpec = "none" {}
}

kind! {
    /// The same everywhere.
    ConstantControlSpec = "constant" {
        /// The extinction of the control \[1/length\].
        sigma_main: f64 as Number,
    }
}

kind! {
    /// Linear between nodes.
    PiecewiseLinearControlSpec = "piecewise_linear" {
        /// Distances of the nodes \[length\].
        positions: Vec<f64> as Numbers,
        /// The extinction of the control there \[1/length\].
        sigma_main: Vec<f64> as Numbers,
    }
}

kind! {
    /// Linear through equidistant look-ups of the profile.
    ExplorersSpec = "explorers" {
        /// Look-ups.
        count: u32 as Whole<2, MOST_POINTS>,
    }
}

registry! {
    /// A control as given.
    ControlSpec {
        None(NoControlSpec),
        Constant(ConstantControlSpec),
        PiecewiseLinear(PiecewiseLinearControlSpec),
        Explorers(ExplorersSpec),
    }
}

impl ControlSpec {
    /// No control.
    #[must_use]
    pub fn none() -> Self {
        Self::None(NoControlSpec {})
    }

    /// The same everywhere \[1/length\].
    #[must_use]
    pub fn constant(sigma_main: f64) -> Self {
        Self::Constant(ConstantControlSpec { sigma_main })
    }

    /// The control through so many look-ups of the profile.
    #[must_use]
    pub fn through(count: u32) -> Self {
        Self::Explorers(ExplorersSpec { count })
    }

    /// Look-ups that fitting it takes.
    pub(super) fn explorers(&self) -> f64 {
        match self {
            Self::Explorers(ExplorersSpec { count }) => f64::from(*count),
            Self::None(_) | Self::Constant(_) | Self::PiecewiseLinear(_) => 0.0,
        }
    }
}

impl Ruled for ControlSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        Self::read(node)
    }
    fn written(&self) -> Value {
        if matches!(self, Self::None(_)) { Value::Null } else { Self::written(self) }
    }
    fn schema() -> Value {
        json!({ "$ref": "#/$defs/control" })
    }
}

/// σ_main of any kind, on one profile.
#[derive(Clone, Debug)]
pub enum AnyControl {
    /// No control.
    None(Vacuum),
    /// The same everywhere.
    Constant(Constant),
    /// Linear between nodes.
    PiecewiseLinear(PiecewiseLinear),
    /// The control through look-ups of the profile.
    Explorers(Explorers),
}

impl AnyControl {
    pub(super) fn build(spec: &ControlSpec, profile: &AnyProfile) -> Result<Self, Failure> {
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("estimator.control: {error}"));
        let length = profile.length();
        Ok(match spec {
            ControlSpec::None(_) => Self::None(Vacuum::new(length)),
            ControlSpec::Constant(ConstantControlSpec { sigma_main }) => {
                Self::Constant(Constant::new(*sigma_main, length).map_err(|error| refuse(&error))?)
            }
            ControlSpec::PiecewiseLinear(PiecewiseLinearControlSpec { positions, sigma_main }) => {
                if length == 0.0 {
                    return Ok(Self::None(Vacuum::new(0.0)));
                }
                Self::piecewise_linear(positions, sigma_main, profile)?
            }
            ControlSpec::Explorers(ExplorersSpec { count }) => {
                let explorers = Explorers::through(&profile.field(), *count as usize);
                Self::Explorers(explorers.map_err(|error| refuse(&error))?)
            }
        })
    }

    /// Nodes given from the ray's origin, cut to the profile: the value at a cut is the interpolated one.
    fn piecewise_linear(positions: &[f64], values: &[f64], profile: &AnyProfile) -> Result<Self, Failure> {
        let key = "estimator.control.positions";
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("estimator.control: {error}"));
        let nodes = clipped_nodes(key, positions, profile)?;
        let start = positions[0];
        let from_zero: Vec<f64> = positions.iter().map(|position| position - start).collect();
        let given = PiecewiseLinear::new(from_zero, values.to_vec()).map_err(|error| refuse(&error))?;
        let entry = profile.entry_distance();
        let clipped = nodes.iter().map(|s| given.sigma_t(s + entry - start)).collect();
        let field = PiecewiseLinear::new(nodes, clipped).map_err(|error| refuse(&error))?;
        Ok(Self::PiecewiseLinear(field))
    }

    /// Look-ups of the profile that building it cost; charged to every estimate.
    #[must_use]
    pub fn lookups(&self) -> u64 {
        match self {
            Self::Explorers(explorers) => explorers.count() as u64,
            Self::None(_) | Self::Constant(_) | Self::PiecewiseLinear(_) => 0,
        }
    }
}

impl Extinction for AnyControl {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        match self {
            Self::None(control) => control.sigma_t(s),
            Self::Constant(control) => control.sigma_t(s),
            Self::PiecewiseLinear(control) => control.sigma_t(s),
            Self::Explorers(control) => control.sigma_t(s),
        }
    }

    fn length(&self) -> f64 {
        match self {
            Self::None(control) => control.length(),
            Self::Constant(control) => control.length(),
            Self::PiecewiseLinear(control) => control.length(),
            Self::Explorers(control) => control.length(),
        }
    }
}

impl OpticalThickness for AnyControl {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::None(control) => control.optical_thickness(from, to),
            Self::Constant(control) => control.optical_thickness(from, to),
            Self::PiecewiseLinear(control) => control.optical_thickness(from, to),
            Self::Explorers(control) => control.optical_thickness(from, to),
        }
    }
}

impl Breakpoints for AnyControl {
    fn breakpoints(&self) -> Vec<f64> {
        match self {
            Self::None(control) => control.breakpoints(),
            Self::Constant(control) => control.breakpoints(),
            Self::PiecewiseLinear(control) => control.breakpoints(),
            Self::Explorers(control) => control.breakpoints(),
        }
    }
}

impl Ranged for AnyControl {
    fn range(&self) -> Interval {
        match self {
            Self::None(control) => control.range(),
            Self::Constant(control) => control.range(),
            Self::PiecewiseLinear(control) => control.range(),
            Self::Explorers(control) => control.range(),
        }
    }
}

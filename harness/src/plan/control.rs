//! A control of any kind.

use super::sampling::clipped_nodes;
use super::{AnyProfile, Field, FieldJob, KnownField};
use crate::Failure;
use crate::spec::ControlSpec;
use fairflight_laws::scores::{Interval, Ranged};
use fairflight_media::{Breakpoints, Constant, Extinction, OpticalThickness, PiecewiseLinear, Vacuum};
use fairflight_transmittance::{Explorers, TooFewExplorers};

/// σ_main of any kind, on one profile.
#[derive(Clone, Debug)]
pub enum AnyControl {
    /// No control.
    None(Vacuum),
    /// The same everywhere.
    Constant(Constant),
    /// Linear between nodes.
    PiecewiseLinear(PiecewiseLinear),
    /// Through look-ups of the profile.
    Explorers(Explorers),
}

impl AnyControl {
    pub(super) fn build(spec: &ControlSpec, profile: &AnyProfile) -> Result<Self, Failure> {
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("estimator.control: {error}"));
        let length = profile.length();
        Ok(match spec {
            ControlSpec::None => Self::None(Vacuum::new(length)),
            ControlSpec::Constant(sigma_main) => {
                Self::Constant(Constant::new(*sigma_main, length).map_err(|error| refuse(&error))?)
            }
            ControlSpec::PiecewiseLinear { positions, sigma_main } => {
                if length == 0.0 {
                    return Ok(Self::None(Vacuum::new(0.0)));
                }
                Self::piecewise_linear(positions, sigma_main, profile)?
            }
            ControlSpec::Explorers { count } => {
                Self::Explorers(profile.with(Explore { count: *count }).map_err(|error| refuse(&error))?)
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

struct Explore {
    count: usize,
}

impl FieldJob for Explore {
    type Output = Result<Explorers, TooFewExplorers>;
    fn run<F: KnownField>(self, field: &F) -> Self::Output
    where
        for<'a> &'a F: Field,
    {
        Explorers::through(field, self.count)
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

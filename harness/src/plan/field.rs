//! What the harness asks of a field, and what it knows of it.

use fairflight_media::{
    AnalyticCosine, Breakpoints, Certificate, Certified, Constant, ExpressionMedium, ExpressionProfile,
    Extinction, Homogeneous, Majorant, Minorant, OpticalThickness, Perlin, PiecewiseConstant,
    PiecewiseLinear, Ray, Voxels,
};
use std::sync::Arc;

use super::VoxelLattice;

/// A field that can be measured: passed by reference, looked up from several threads.
pub trait Field: Extinction + Breakpoints + Copy + Sync {}
impl<F: Extinction + Breakpoints + Copy + Sync> Field for F {}

/// How an optical thickness is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThicknessMethod {
    /// Exact to rounding.
    ClosedForm,
    /// Two-point Gauss–Legendre per voxel cell: exact to rounding.
    GaussPerCell,
    /// Quadrature with a certificate, where it proves enough; else with an error estimated from values at nodes.
    Quadrature,
}

/// Facts about a whole profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knowledge {
    /// ∫ σ_t, where a closed form exists.
    pub optical_thickness: Option<f64>,
    /// How.
    pub method: ThicknessMethod,
    /// A value that σ_t nowhere exceeds; a look-up above it refutes whoever declared it.
    pub upper_bound: Option<f64>,
    /// A value that σ_t nowhere falls below.
    pub lower_bound: Option<f64>,
    /// The greatest value that σ_t attains, where it is known exactly.
    pub maximum: Option<f64>,
}

/// A field with what is known of it.
pub trait KnownField: Extinction + Breakpoints + Sync {
    /// Facts about the profile.
    fn knowledge(&self) -> Knowledge;

    /// What is proved of the optical thickness where it has no closed form.
    fn certificate(&self) -> Option<&Certificate> {
        None
    }
}

fn finite(bound: f64) -> Option<f64> {
    bound.is_finite().then_some(bound)
}

/// A field that is bounded, and perhaps no more is known.
fn bounds_of<F: Majorant + Minorant>(field: &F) -> Knowledge {
    Knowledge {
        optical_thickness: None,
        method: ThicknessMethod::Quadrature,
        upper_bound: finite(field.majorant()),
        lower_bound: finite(field.minorant()),
        maximum: None,
    }
}

/// A field whose bounds hold and whose integral has a closed form.
fn closed_form_of<F: Majorant + Minorant + OpticalThickness>(
    field: &F,
    method: ThicknessMethod,
) -> Knowledge {
    Knowledge {
        optical_thickness: Some(field.optical_thickness(0.0, field.length())),
        method,
        ..bounds_of(field)
    }
}

/// A closed form whose majorant is attained.
fn exact<F: Majorant + Minorant + OpticalThickness>(field: &F) -> Knowledge {
    Knowledge { maximum: Some(field.majorant()), ..closed_form_of(field, ThicknessMethod::ClosedForm) }
}

impl KnownField for Constant {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}

impl KnownField for PiecewiseConstant {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}

impl KnownField for PiecewiseLinear {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}

impl KnownField for Certified<ExpressionProfile> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}

impl KnownField for Ray<Arc<Homogeneous>> {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}

impl KnownField for Ray<Arc<AnalyticCosine>> {
    fn knowledge(&self) -> Knowledge {
        closed_form_of(self, ThicknessMethod::ClosedForm)
    }
}

impl KnownField for Certified<Ray<Arc<Perlin>>> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}

impl KnownField for Certified<Ray<Arc<ExpressionMedium>>> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}

impl KnownField for Ray<Arc<Voxels<VoxelLattice>>> {
    fn knowledge(&self) -> Knowledge {
        closed_form_of(self, ThicknessMethod::GaussPerCell)
    }
}

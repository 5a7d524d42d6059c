//! Demands of the harness on a field, and its knowledge of it.

use fairflight_elementary::lanes::Lanes;
use fairflight_media::{Breakpoints, Certificate, Extinction, Majorant, Minorant, OpticalThickness};
use std::sync::Arc;

/// A field that can be measured: passed by reference, looked up from several threads.
pub trait Field: Extinction + Breakpoints + Copy + Sync {}
impl<F: Extinction + Breakpoints + Copy + Sync> Field for F {}

/// Method by which an optical thickness is known.
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
    /// Method by which the optical thickness is known.
    pub method: ThicknessMethod,
    /// A value that σ_t nowhere exceeds; a look-up above it refutes whoever declared it.
    pub upper_bound: Option<f64>,
    /// A value that σ_t nowhere falls below.
    pub lower_bound: Option<f64>,
    /// The greatest value that σ_t attains, where it is known exactly.
    pub maximum: Option<f64>,
}

/// A field with what is known of it.
pub trait KnownField: Extinction + Breakpoints + std::fmt::Debug + Send + Sync {
    /// Facts about the profile.
    fn knowledge(&self) -> Knowledge;

    /// The certificate of the optical thickness where it has no closed form.
    fn certificate(&self) -> Option<&Certificate> {
        None
    }
}

fn finite(bound: f64) -> Option<f64> {
    bound.is_finite().then_some(bound)
}

/// A field that is bounded, and perhaps no more is known.
pub(super) fn bounds_of<F: Majorant + Minorant>(field: &F) -> Knowledge {
    Knowledge {
        optical_thickness: None,
        method: ThicknessMethod::Quadrature,
        upper_bound: finite(field.majorant()),
        lower_bound: finite(field.minorant()),
        maximum: None,
    }
}

/// A field whose bounds hold and whose integral has a closed form.
pub(super) fn closed_form_of<F: Majorant + Minorant + OpticalThickness>(
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
pub(super) fn exact<F: Majorant + Minorant + OpticalThickness>(field: &F) -> Knowledge {
    Knowledge { maximum: Some(field.majorant()), ..closed_form_of(field, ThicknessMethod::ClosedForm) }
}

/// A profile of any type, behind a pointer: what is compiled for it is compiled once.
#[derive(Clone, Debug)]
pub struct ErasedField(pub Arc<dyn KnownField>);

impl Extinction for ErasedField {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.0.sigma_t(s)
    }
    #[inline]
    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        self.0.sigma_t_lanes(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.0.length()
    }
}

impl Breakpoints for ErasedField {
    fn breakpoints(&self) -> Vec<f64> {
        self.0.breakpoints()
    }
}

impl KnownField for ErasedField {
    fn knowledge(&self) -> Knowledge {
        self.0.knowledge()
    }
    fn certificate(&self) -> Option<&Certificate> {
        self.0.certificate()
    }
}

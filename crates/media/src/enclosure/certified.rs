//! A field that remembers its certificate.

use super::{Certificate, Enclosed, Stretch};
use crate::of_field::of_field;
use crate::{Breakpoints, Extinction, IntervalBounds, Majorant, Minorant, Tolerance};
use std::sync::{Arc, OnceLock};

/// A field whose [`Certificate`] is made once, when it is first asked for, and shared by all copies that are made later.
///
/// Its borders are the breakpoints of the field: every closed form that is integrated over the profile then sees its features.
#[derive(Clone, Debug)]
pub struct Certified<F> {
    field: F,
    certificate: OnceLock<Arc<Certificate>>,
}

impl<F: Enclosed> Certified<F> {
    /// The same field.
    pub fn new(field: F) -> Self {
        Self { field, certificate: OnceLock::new() }
    }

    /// The certificate of the field's optical thickness, to [`Tolerance::TIGHT`].
    pub fn certificate(&self) -> &Certificate {
        self.certificate.get_or_init(|| Arc::new(Certificate::of(&self.field, Tolerance::TIGHT)))
    }
}

impl<F> Certified<F> {
    /// The field itself.
    pub fn field(&self) -> &F {
        &self.field
    }
}

of_field!(Extinction, [F: Extinction] Certified<F>);
of_field!(Majorant, [F: Majorant] Certified<F>);

impl<F: Minorant> Minorant for Certified<F> {
    fn minorant(&self) -> f64 {
        self.field.minorant()
    }
}

impl<F: Enclosed> Breakpoints for Certified<F> {
    fn breakpoints(&self) -> Vec<f64> {
        self.certificate().borders.clone()
    }
}

impl<F: Enclosed> Enclosed for Certified<F> {
    fn enclose(&self, from: f64, to: f64) -> Stretch {
        self.field.enclose(from, to)
    }
    fn known_borders(&self) -> Vec<f64> {
        self.field.known_borders()
    }
}

/// Minus infinity and infinity where nothing is proved.
impl<F: Enclosed> IntervalBounds for Certified<F> {
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64) {
        self.field.range_between(from, to)
    }
}

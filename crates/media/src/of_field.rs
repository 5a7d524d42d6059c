//! Traits that a wrapper passes on from the field that it wraps.

/// Implements a trait of a field for a wrapper by what its `field` says.
macro_rules! of_field {
    (Extinction, [$($generics:tt)*] $wrapper:ty) => {
        impl<$($generics)*> $crate::Extinction for $wrapper {
            #[inline]
            fn sigma_t(&self, s: f64) -> f64 {
                self.field.sigma_t(s)
            }
            #[inline(always)]
            fn sigma_t_lanes(&self, s: &fairflight_elementary::lanes::Lanes) -> fairflight_elementary::lanes::Lanes {
                self.field.sigma_t_lanes(s)
            }
            #[inline]
            fn length(&self) -> f64 {
                self.field.length()
            }
        }
    };
    (Majorant, [$($generics:tt)*] $wrapper:ty) => {
        impl<$($generics)*> $crate::Majorant for $wrapper {
            #[inline]
            fn majorant(&self) -> f64 {
                self.field.majorant()
            }
        }
    };
    (OpticalThickness, [$($generics:tt)*] $wrapper:ty) => {
        /// A closed form is no look-up.
        impl<$($generics)*> $crate::OpticalThickness for $wrapper {
            #[inline]
            fn optical_thickness(&self, from: f64, to: f64) -> f64 {
                self.field.optical_thickness(from, to)
            }
        }
    };
    (InvertOpticalThickness, [$($generics:tt)*] $wrapper:ty) => {
        impl<$($generics)*> $crate::InvertOpticalThickness for $wrapper {
            #[inline]
            fn invert(&self, from: f64, depth: f64) -> Option<f64> {
                self.field.invert(from, depth)
            }
        }
    };
    (Breakpoints, [$($generics:tt)*] $wrapper:ty) => {
        impl<$($generics)*> $crate::Breakpoints for $wrapper {
            fn breakpoints(&self) -> Vec<f64> {
                self.field.breakpoints()
            }
        }
    };
}
pub(crate) use of_field;

//! Extinction of several wavelengths at once along a ray.
//!
//! A wavelength is an index below N, known at compile time; what it means (three channels of an image, samples of a
//! spectrum) is the scene's business. Knowledge beyond the look-up is a trait of its own, as for gray fields.

use crate::{Breakpoints, Extinction, FieldError, Majorant, OpticalThickness};

/// Extinction of N wavelengths along a ray.
///
/// **Law.** `sigma_t(s)` is a function, finite in each wavelength, of any sign. One call is one *look-up*, whatever N: the
/// expensive part of a look-up is to find matter, not to multiply its density by N numbers.
pub trait SpectralExtinction<const N: usize> {
    /// σ_t of each wavelength at the distance `s`, `0 ≤ s ≤ length` \[1/length\].
    fn sigma_t(&self, s: f64) -> [f64; N];

    /// The length of the profile \[length\]: finite, and 0 for a ray that misses its medium.
    fn length(&self) -> f64;
}

/// A field with a known upper bound of all its wavelengths.
pub trait SpectralMajorant<const N: usize>: SpectralExtinction<N> {
    /// A value that no wavelength exceeds anywhere on the profile \[1/length\].
    fn majorant(&self) -> f64;
}

/// A field whose integrals are known in closed form: exact to rounding, without a look-up.
pub trait SpectralOpticalThickness<const N: usize>: SpectralExtinction<N> {
    /// ∫ σ_t(s) ds over `from ≤ s ≤ to` of each wavelength \[1\].
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N];
}

/// A field that says where one of its wavelengths is not smooth.
pub trait SpectralBreakpoints<const N: usize>: SpectralExtinction<N> {
    /// Distances strictly inside the profile, as those of [`Breakpoints`].
    fn breakpoints(&self) -> Vec<f64>;
}

/// σ_t of wavelength l is a coefficient c_l times one gray field: particles of one kind in varying number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled<F, const N: usize> {
    gray: F,
    coefficients: [f64; N],
}

impl<F: Extinction, const N: usize> Scaled<F, N> {
    /// `gray` times one of the `coefficients` \[1\] for each wavelength; 0 is a wavelength that nothing attenuates.
    ///
    /// # Errors
    /// If a coefficient is negative or not finite.
    pub fn new(gray: F, coefficients: [f64; N]) -> Result<Self, FieldError> {
        FieldError::check_all_finite("coefficients", &coefficients)?;
        for found in coefficients {
            FieldError::check_at_least("coefficients", 0.0, found)?;
        }
        Ok(Self { gray, coefficients })
    }
}

impl<F: Extinction, const N: usize> SpectralExtinction<N> for Scaled<F, N> {
    #[inline]
    fn sigma_t(&self, s: f64) -> [f64; N] {
        let gray = self.gray.sigma_t(s);
        self.coefficients.map(|c| c * gray)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.gray.length()
    }
}

impl<F: Majorant, const N: usize> SpectralMajorant<N> for Scaled<F, N> {
    fn majorant(&self) -> f64 {
        let gray = self.gray.majorant();
        self.coefficients.iter().map(|c| c * gray).fold(f64::NEG_INFINITY, f64::max)
    }
}

impl<F: OpticalThickness, const N: usize> SpectralOpticalThickness<N> for Scaled<F, N> {
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N] {
        let gray = self.gray.optical_thickness(from, to);
        self.coefficients.map(|c| c * gray)
    }
}

impl<F: Breakpoints, const N: usize> SpectralBreakpoints<N> for Scaled<F, N> {
    fn breakpoints(&self) -> Vec<f64> {
        self.gray.breakpoints()
    }
}

/// A profile for each wavelength, e.g. a [`crate::PiecewiseConstant`]: particles of several kinds, each in its own places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profiles<F, const N: usize> {
    profiles: [F; N],
}

impl<F: Extinction, const N: usize> Profiles<F, N> {
    /// The spectrum with one of the `profiles` for each wavelength.
    ///
    /// # Errors
    /// If there is none, or they are not all of one length.
    pub fn new(profiles: [F; N]) -> Result<Self, FieldError> {
        let Some(first) = profiles.first() else {
            return Err(FieldError::TooFew { what: "profiles", least: 1, found: 0 });
        };
        let length = first.length();
        match profiles.iter().map(Extinction::length).find(|&found| found != length) {
            Some(found) => Err(FieldError::UnequalLengths { what: "profiles", first: length, found }),
            None => Ok(Self { profiles }),
        }
    }

    /// The profile of each wavelength.
    pub fn profiles(&self) -> &[F; N] {
        &self.profiles
    }
}

impl<F: Extinction, const N: usize> SpectralExtinction<N> for Profiles<F, N> {
    #[inline]
    fn sigma_t(&self, s: f64) -> [f64; N] {
        std::array::from_fn(|l| self.profiles[l].sigma_t(s))
    }
    #[inline]
    fn length(&self) -> f64 {
        self.profiles[0].length()
    }
}

impl<F: Majorant, const N: usize> SpectralMajorant<N> for Profiles<F, N> {
    fn majorant(&self) -> f64 {
        self.profiles.iter().map(Majorant::majorant).fold(f64::NEG_INFINITY, f64::max)
    }
}

impl<F: OpticalThickness, const N: usize> SpectralOpticalThickness<N> for Profiles<F, N> {
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N] {
        std::array::from_fn(|l| self.profiles[l].optical_thickness(from, to))
    }
}

impl<F: Breakpoints, const N: usize> SpectralBreakpoints<N> for Profiles<F, N> {
    fn breakpoints(&self) -> Vec<f64> {
        self.profiles.iter().flat_map(Breakpoints::breakpoints).collect()
    }
}

/// One wavelength of a spectral field: a gray field like any other, whose look-ups evaluate all of them.
///
/// Its breakpoints are those of all wavelengths, for a quadrature that asks the [`spectrum`](Self::spectrum) for the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelength<F, const N: usize> {
    spectrum: F,
    index: usize,
}

impl<F: SpectralExtinction<N>, const N: usize> Wavelength<F, N> {
    /// The wavelength `index` of `spectrum`.
    ///
    /// # Errors
    /// If there is no such wavelength.
    pub fn new(spectrum: F, index: usize) -> Result<Self, FieldError> {
        if index < N {
            Ok(Self { spectrum, index })
        } else {
            Err(FieldError::TooFew { what: "the spectrum", least: index + 1, found: N })
        }
    }

    /// The field of all wavelengths.
    #[inline]
    pub fn spectrum(&self) -> &F {
        &self.spectrum
    }

    /// Index of this wavelength.
    #[inline]
    pub fn index(&self) -> usize {
        self.index
    }
}

impl<F: SpectralExtinction<N>, const N: usize> Extinction for Wavelength<F, N> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.spectrum.sigma_t(s)[self.index]
    }
    #[inline]
    fn length(&self) -> f64 {
        self.spectrum.length()
    }
}

impl<F: SpectralMajorant<N>, const N: usize> Majorant for Wavelength<F, N> {
    fn majorant(&self) -> f64 {
        self.spectrum.majorant()
    }
}

impl<F: SpectralOpticalThickness<N>, const N: usize> OpticalThickness for Wavelength<F, N> {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.spectrum.optical_thickness(from, to)[self.index]
    }
}

impl<F: SpectralBreakpoints<N>, const N: usize> Breakpoints for Wavelength<F, N> {
    fn breakpoints(&self) -> Vec<f64> {
        self.spectrum.breakpoints()
    }
}

impl<F: SpectralExtinction<N> + ?Sized, const N: usize> SpectralExtinction<N> for &F {
    #[inline]
    fn sigma_t(&self, s: f64) -> [f64; N] {
        (**self).sigma_t(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        (**self).length()
    }
}

impl<F: SpectralMajorant<N> + ?Sized, const N: usize> SpectralMajorant<N> for &F {
    fn majorant(&self) -> f64 {
        (**self).majorant()
    }
}

impl<F: SpectralOpticalThickness<N> + ?Sized, const N: usize> SpectralOpticalThickness<N> for &F {
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N] {
        (**self).optical_thickness(from, to)
    }
}

impl<F: SpectralBreakpoints<N> + ?Sized, const N: usize> SpectralBreakpoints<N> for &F {
    fn breakpoints(&self) -> Vec<f64> {
        (**self).breakpoints()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Constant, PiecewiseConstant};

    fn steps(border: f64, values: [f64; 2]) -> PiecewiseConstant {
        PiecewiseConstant::new(vec![0.0, border, 4.0], values.to_vec()).unwrap()
    }

    #[test]
    fn one_look_up_gives_all_wavelengths() {
        let scaled = Scaled::new(steps(1.0, [2.0, 0.5]), [1.0, 0.5, 0.0]).unwrap();
        assert_eq!(scaled.sigma_t(0.5), [2.0, 1.0, 0.0]);
        assert_eq!(scaled.optical_thickness(0.0, 2.0), [2.5, 1.25, 0.0]);
        assert_eq!(scaled.majorant(), 2.0);
        let profiles = Profiles::new([steps(1.0, [2.0, 0.5]), steps(3.0, [0.0, 7.0])]).unwrap();
        assert_eq!(profiles.sigma_t(3.5), [0.5, 7.0]);
        assert_eq!(profiles.majorant(), 7.0);
        assert_eq!(profiles.breakpoints(), [1.0, 3.0]);
    }

    #[test]
    fn a_wavelength_is_a_gray_field() {
        let profiles = Profiles::new([steps(1.0, [2.0, 0.5]), steps(3.0, [0.0, 7.0])]).unwrap();
        let second = Wavelength::new(&profiles, 1).unwrap();
        assert_eq!(
            (second.sigma_t(3.5), second.optical_thickness(2.0, 4.0), second.length()),
            (7.0, 7.0, 4.0)
        );
        assert_eq!(second.breakpoints(), [1.0, 3.0]);
        assert!(matches!(Wavelength::new(&profiles, 2), Err(FieldError::TooFew { .. })));
    }

    #[test]
    fn bad_spectra_are_refused() {
        let gray = Constant::new(1.0, 1.0).unwrap();
        assert!(matches!(Scaled::new(gray, [1.0, -0.5]), Err(FieldError::TooSmall { .. })));
        assert!(matches!(Scaled::new(gray, [f64::NAN]), Err(FieldError::NotFinite { .. })));
        let longer = Constant::new(1.0, 2.0).unwrap();
        assert!(matches!(Profiles::new([gray, longer]), Err(FieldError::UnequalLengths { .. })));
        assert!(matches!(Profiles::<Constant, 0>::new([]), Err(FieldError::TooFew { .. })));
    }
}

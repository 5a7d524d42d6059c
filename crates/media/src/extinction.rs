//! The traits of a field along a ray: the look-up, and each piece of further knowledge by itself.

use fairflight_elementary::lanes::Lanes;

/// Extinction along a ray.
///
/// **Law.** `sigma_t(s)` is a function: the same `s` gives the same value. It may be negative (szirmay-kalos-2017
/// section 3.3); it must be finite. One call is one *look-up*, the unit of cost.
pub trait Extinction {
    /// σ_t at the distance `s` from the start of the profile, `0 ≤ s ≤ length` \[1/length\].
    fn sigma_t(&self, s: f64) -> f64;

    /// σ_t at the distances of all lanes, each with the bits of [`sigma_t`](Self::sigma_t).
    ///
    /// A field whose look-up has branches or calls does better than this loop over it.
    #[inline(always)]
    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        s.map(|s| self.sigma_t(s))
    }

    /// The length of the profile \[length\]: finite, and 0 for a ray that misses its medium.
    fn length(&self) -> f64;
}

/// A field with a known upper bound.
pub trait Majorant: Extinction {
    /// A value that σ_t(s) exceeds nowhere on the profile \[1/length\].
    fn majorant(&self) -> f64;
}

/// A field with a known lower bound.
pub trait Minorant: Extinction {
    /// A value that σ_t(s) falls below nowhere on the profile \[1/length\].
    fn minorant(&self) -> f64;
}

/// A field whose integral is known in closed form: exact to rounding, without a look-up. A *control* is such a field.
pub trait OpticalThickness: Extinction {
    /// ∫ σ_t(s) ds over `from ≤ s ≤ to` within the profile \[1\].
    fn optical_thickness(&self, from: f64, to: f64) -> f64;
}

/// A field of which free flights can be drawn by inversion (szirmay-kalos-2017 eq. 4): a *sampling extinction*.
///
/// Such a field is nowhere negative.
pub trait InvertOpticalThickness: OpticalThickness {
    /// The distance `s ≥ from` with `optical_thickness(from, s) = depth`, or `None` where the profile ends before that
    /// depth is reached. Where a whole stretch without extinction has that depth, its end: there matter begins.
    fn invert(&self, from: f64, depth: f64) -> Option<f64>;

    /// The same in all lanes, ∞ for none.
    #[inline(always)]
    fn invert_lanes(&self, from: &Lanes, depth: &Lanes) -> Lanes {
        std::array::from_fn(|lane| self.invert(from[lane], depth[lane]).unwrap_or(f64::INFINITY))
    }
}

/// A field that says where it is not smooth.
pub trait Breakpoints: Extinction {
    /// Distances strictly inside the profile at which σ_t or a derivative of it jumps, and such between which its features are resolved. In
    /// any order, duplicates allowed; empty for a field that is smooth, or that does not know.
    fn breakpoints(&self) -> Vec<f64>;
}

/// No extinction at all: the control of an estimator that has none. Costs nothing, not even a subtraction of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vacuum {
    length: f64,
}

impl Vacuum {
    /// An empty profile of this length.
    #[must_use]
    pub fn new(length: f64) -> Self {
        Self { length }
    }
}

impl Extinction for Vacuum {
    #[inline]
    fn sigma_t(&self, _s: f64) -> f64 {
        0.0
    }
    #[inline]
    fn length(&self) -> f64 {
        self.length
    }
}

impl OpticalThickness for Vacuum {
    fn optical_thickness(&self, _from: f64, _to: f64) -> f64 {
        0.0
    }
}

impl InvertOpticalThickness for Vacuum {
    #[inline]
    fn invert(&self, _from: f64, _depth: f64) -> Option<f64> {
        None
    }
}

impl Breakpoints for Vacuum {
    fn breakpoints(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl<F: Extinction + ?Sized> Extinction for &F {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        (**self).sigma_t(s)
    }
    #[inline(always)]
    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        (**self).sigma_t_lanes(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        (**self).length()
    }
}

impl<F: Majorant + ?Sized> Majorant for &F {
    #[inline]
    fn majorant(&self) -> f64 {
        (**self).majorant()
    }
}

impl<F: Minorant + ?Sized> Minorant for &F {
    #[inline]
    fn minorant(&self) -> f64 {
        (**self).minorant()
    }
}

impl<F: OpticalThickness + ?Sized> OpticalThickness for &F {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        (**self).optical_thickness(from, to)
    }
}

impl<F: InvertOpticalThickness + ?Sized> InvertOpticalThickness for &F {
    #[inline]
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        (**self).invert(from, depth)
    }
    #[inline(always)]
    fn invert_lanes(&self, from: &Lanes, depth: &Lanes) -> Lanes {
        (**self).invert_lanes(from, depth)
    }
}

impl<F: Breakpoints + ?Sized> Breakpoints for &F {
    fn breakpoints(&self) -> Vec<f64> {
        (**self).breakpoints()
    }
}

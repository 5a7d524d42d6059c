//! Profiles and judgements that the tests of several estimators share.

use crate::{ClosedForm, Theory, TransmittanceEstimator, theory_on};
use fairflight_media::{
    AnalyticCosine, Breakpoints, Counted, Extinction, OpticalThickness, PiecewiseLinear, Ray, RayQuadrature,
    Tolerance,
};
use fairflight_sources::Seeded;
use glam::DVec3;

/// szirmay-kalos-2017 eq. 21 along +z from the origin, length 20, majorant 1.
pub(crate) fn seed_ray() -> Ray<AnalyticCosine> {
    let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
    Ray::new(AnalyticCosine::new(1.0).unwrap(), &clip)
}

/// A medium whose look-ups all give the same value, a number or none; of length 3.
pub(crate) struct Broken(pub(crate) f64);

impl Extinction for Broken {
    fn sigma_t(&self, _: f64) -> f64 {
        self.0
    }
    fn length(&self) -> f64 {
        3.0
    }
}

/// The theory of an estimator on a profile.
pub(crate) fn theory_of<F: OpticalThickness + Breakpoints, E: ClosedForm<F>>(
    field: F,
    estimator: &E,
) -> Theory {
    theory_on(field, estimator, &[])
}

/// The variate whose exponential is `depth`.
pub(crate) fn variate(depth: f64) -> f64 {
    1.0 - (-depth).exp()
}

/// Mean and its standard error of `n` numbers.
pub(crate) fn mean(n: u32, mut draw: impl FnMut() -> f64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..n {
        let x = draw();
        sum += x;
        squares += x * x;
    }
    let n = f64::from(n);
    let mean = sum / n;
    (mean, ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt())
}

/// Asserts that mean, variance and look-ups of `n` estimates are those of the theory, each (where it is known) within
/// five standard errors: a false alarm of 6e-7 each.
pub(crate) fn agrees<F, E>(field: &F, estimator: &E, n: u32, source: &mut Seeded)
where
    F: OpticalThickness + Breakpoints,
    E: for<'f> ClosedForm<&'f F> + for<'f> TransmittanceEstimator<Counted<&'f F>>,
{
    const LEVEL: f64 = 5.0;
    let theory = theory_of(field, estimator);
    let transmittance = (-field.optical_thickness(0.0, field.length())).exp();
    let counted = Counted::new(field);
    let (mut estimates, mut lookups) = (Vec::new(), Vec::new());
    for _ in 0..n {
        let before = counted.lookups();
        estimates.push(estimator.estimate(&counted, source) / transmittance);
        lookups.push((counted.lookups() - before) as f64);
    }
    let judge = |what: &str, values: &mut dyn Iterator<Item = f64>, expected: f64| {
        let (found, error) = mean(n, || values.next().expect("as many as drawn"));
        let deviation = (found - expected).abs();
        assert!(deviation < LEVEL * error + 1e-11, "{what} {found} for {expected}, standard error {error}");
    };
    judge("mean", &mut estimates.iter().copied(), 1.0);
    let variance = theory.relative_central[0];
    if !variance.is_nan() {
        judge("variance", &mut estimates.iter().map(|x| (x - 1.0).powi(2)), variance);
    }
    if !theory.lookups.is_nan() {
        judge("look-ups", &mut lookups.iter().copied(), theory.lookups);
    }
}

/// E[X] and E[X²] of X = S σ_t at a uniform point.
pub(crate) fn mean_and_square<F: OpticalThickness + Breakpoints>(field: &F) -> (f64, f64) {
    let length = field.length();
    let moments = RayQuadrature::new(field, &[])
        .integrate(Tolerance::TIGHT, |_, sigma_t| [sigma_t, length * sigma_t.powi(2)]);
    (moments.value[0], moments.value[1])
}

/// A rise from 0.1 to 1.5 over 1 and a fall to 0.2 over 2.
pub(crate) fn tent() -> PiecewiseLinear {
    PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).unwrap()
}

//! A profile that checks run on, and the law checks of each kind of estimator on it.

use fairflight_collision::CollisionModel;
use fairflight_freeflight::lookups_of_a_walk;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::scores::{self, Interval, Ranged, ratio_range};
use fairflight_laws::transmittance::{Observed, check, check_in_lanes};
use fairflight_laws::{CheckResult, Expectation, Run, Truth, Unit};
use fairflight_media::{
    Breakpoints, Certified, Enclosed, Extinction, InvertOpticalThickness, Majorant, Minorant,
    OpticalThickness, RayQuadrature, Tolerance,
};
use fairflight_stats::Scores;
use fairflight_transmittance::lockstep::{Lockstep, Watched};
use fairflight_transmittance::{
    ClosedForm, LineIntegral, RayMarching, Tracking, TransmittanceEstimator, Woodcock,
};
use std::sync::OnceLock;

/// Knowledge that a profile must have to be a specimen; a bound may be infinite.
pub(crate) trait SpecimenField:
    Extinction + Breakpoints + Majorant + Minorant + Clone + Send + Sync + 'static
{
}
impl<F: Extinction + Breakpoints + Majorant + Minorant + Clone + Send + Sync + 'static> SpecimenField for F {}

/// A named profile with its quadrature, which is sampled once for all checks.
pub(crate) struct Specimen<F> {
    pub(crate) name: &'static str,
    pub(crate) field: F,
    /// Divides the samples where look-ups are expensive.
    pub(crate) frugality: u64,
    truth: fn(&F) -> Truth,
    pub(crate) tolerance: Tolerance,
    quadrature: OnceLock<(RayQuadrature<F>, Truth)>,
}

impl<F: Enclosed> Specimen<Certified<F>>
where
    Certified<F>: SpecimenField,
{
    /// A profile whose optical thickness has a certificate; other integrals are to `tolerance`.
    pub(crate) fn certified(name: &'static str, field: F, tolerance: Tolerance) -> Self {
        Self::known(name, Certified::new(field), |field| Truth::certified(field.certificate()), tolerance)
    }
}

impl<F: SpecimenField> Specimen<F> {
    /// A profile of which the optical thickness has a closed form.
    pub(crate) fn closed(name: &'static str, field: F) -> Self
    where
        F: OpticalThickness,
    {
        Self::known(name, field, Truth::closed_form, Tolerance::TIGHT)
    }

    /// The same, its closed form put aside: the optical thickness is found by quadrature.
    pub(crate) fn integrated(name: &'static str, field: F, tolerance: Tolerance) -> Self {
        let truth = |field: &F| Truth::quadrature(&mut RayQuadrature::new(field, &[]), Tolerance::TIGHT);
        Self::known(name, field, truth, tolerance)
    }

    fn known(name: &'static str, field: F, truth: fn(&F) -> Truth, tolerance: Tolerance) -> Self {
        Self { name, field, frugality: 1, truth, tolerance, quadrature: OnceLock::new() }
    }

    pub(crate) fn prepared(&self) -> (RayQuadrature<F>, Truth) {
        let (quadrature, truth) = self.quadrature.get_or_init(|| {
            let truth = (self.truth)(&self.field);
            (RayQuadrature::new(self.field.clone(), &[]), truth)
        });
        (quadrature.clone(), *truth)
    }

    /// The law of `estimator`, whose own breakpoints are `also`.
    pub(crate) fn examine<'f, E: ClosedForm<F>>(
        &'f self,
        estimator: &E,
        also: &[f64],
        scores: impl Fn(Unit) -> Scores,
        lookups: LookupLaw,
        run: Run,
    ) -> CheckResult
    where
        for<'e> &'e E: TransmittanceEstimator<&'f F> + TransmittanceEstimator<Observed<&'f F, &'e E>>,
    {
        self.examine_with_lookups(estimator, also, scores, |_| lookups, run)
    }

    /// Judges as [`Self::examine`], with a law of look-ups that is an integral along the field.
    ///
    /// N is at least what the closed moments ask for, so that no seed makes the check untestable.
    pub(crate) fn examine_with_lookups<'f, E: ClosedForm<F>>(
        &'f self,
        estimator: &E,
        also: &[f64],
        scores: impl Fn(Unit) -> Scores,
        lookups: impl FnOnce(&mut RayQuadrature<F>) -> LookupLaw,
        run: Run,
    ) -> CheckResult
    where
        for<'e> &'e E: TransmittanceEstimator<&'f F> + TransmittanceEstimator<Observed<&'f F, &'e E>>,
    {
        let expected = self.expected(estimator, also, scores, lookups);
        CheckResult::of_evidence(&check(&self.field, estimator, &expected, expected.sufficient(run)))
    }

    /// Judges as [`Self::examine_with_lookups`] an estimator that runs in lanes: the same numbers.
    pub(crate) fn examine_in_lanes<'f, E>(
        &'f self,
        estimator: &E,
        also: &[f64],
        scores: impl Fn(Unit) -> Scores,
        lookups: impl FnOnce(&mut RayQuadrature<F>) -> LookupLaw,
        run: Run,
    ) -> CheckResult
    where
        E: ClosedForm<F> + Lockstep<F> + for<'a> Lockstep<Watched<'a, F, E>>,
        for<'e> &'e E: TransmittanceEstimator<&'f F> + TransmittanceEstimator<Observed<&'f F, &'e E>>,
    {
        let expected = self.expected(estimator, also, scores, lookups);
        let run = expected.sufficient(run);
        CheckResult::of_evidence(&check_in_lanes(&self.field, estimator, &expected, run))
    }

    fn expected<E: ClosedForm<F>>(
        &self,
        estimator: &E,
        also: &[f64],
        scores: impl Fn(Unit) -> Scores,
        lookups: impl FnOnce(&mut RayQuadrature<F>) -> LookupLaw,
    ) -> Expectation {
        let (mut quadrature, truth) = self.prepared();
        quadrature.split_at(also);
        let lookups = lookups(&mut quadrature);
        let theory = estimator.theory(&mut quadrature, truth.optical_thickness, self.tolerance);
        let scores = scores(Unit::of(truth.optical_thickness));
        Expectation { truth, theory, scores, lookups }
    }

    pub(crate) fn woodcock(&self, run: Run) -> CheckResult {
        self.examine_in_lanes(&Woodcock, &[], scores::woodcock, |quadrature| self.of_flight(quadrature), run)
    }

    /// The look-ups of a Woodcock flight in the field's own majorant: one at each tentative collision, up to the one that is accepted.
    pub(crate) fn of_flight(&self, quadrature: &mut RayQuadrature<F>) -> LookupLaw {
        let majorant = self.field.majorant();
        let rates = |_: f64, sigma_t: f64| [sigma_t, majorant - sigma_t];
        LookupLaw::Moments(lookups_of_a_walk(quadrature, self.tolerance, &rates))
    }

    pub(crate) fn line_integral(&self, splits: u32, run: Run) -> CheckResult {
        let Ok(estimator) = LineIntegral::new(splits) else {
            return CheckResult::exact(false, "refused: no splits");
        };
        let thickness = self.field.majorant() * self.field.length();
        let scores = |unit| scores::line_integral(thickness, unit);
        let lookups = |quadrature: &mut RayQuadrature<F>| match self.of_flight(quadrature) {
            // A single flight, given that it looks up at all: where it does not, its power is 0.
            LookupLaw::Moments(raw) if splits == 1 => {
                LookupLaw::Moments(raw.map(|moment| moment / -(-thickness).exp_m1()))
            }
            _ => LookupLaw::MeanOnly,
        };
        self.examine_with_lookups(&estimator, &[], scores, lookups, run)
    }

    pub(crate) fn ray_marching(&self, estimator: &RayMarching, run: Run) -> CheckResult {
        let range = Interval::bounds_of(&self.field);
        let scores = |unit| scores::ray_marching(range, self.field.length(), unit);
        self.baseline(estimator, self.examine_in_lanes(estimator, &[], scores, |_| LookupLaw::Fixed, run))
    }

    /// The law of a biased `estimator`: the expectation that its theory states. Its bias is told.
    pub(crate) fn baseline<E: ClosedForm<F>>(&self, estimator: &E, result: CheckResult) -> CheckResult {
        let (mut quadrature, truth) = self.prepared();
        let theory = estimator.theory(&mut quadrature, truth.optical_thickness, self.tolerance);
        let bias = theory.relative_mean - 1.0;
        CheckResult {
            reason: format!("relative bias {bias:.3e} against exp(-tau); {}", result.reason),
            ..result
        }
    }

    pub(crate) fn tracking<
        M: CollisionModel,
        C: OpticalThickness + Breakpoints + Ranged,
        R: InvertOpticalThickness + Breakpoints + Ranged,
    >(
        &self,
        tracking: &Tracking<M, C, R>,
        run: Run,
    ) -> CheckResult {
        let (control, sampling) = (tracking.control(), tracking.sampling());
        let mut also = control.breakpoints();
        also.extend(sampling.breakpoints());
        let ratios = ratio_range(Interval::bounds_of(&self.field), control.range(), sampling.range());
        let main = control.optical_thickness(0.0, self.field.length());
        let survives = ratios.is_some_and(|ratios| scores::weights(tracking.model(), ratios).survives);
        let scores = |unit| scores::tracking(tracking.model(), ratios, main, unit);
        // A walk looks up at each collision, up to the one that does not let it pass.
        let rates = |s: f64, sigma_t: f64| {
            let rate = sampling.sigma_t(s);
            let r = if rate > 0.0 { (sigma_t - control.sigma_t(s)) / rate } else { 0.0 };
            let passes = tracking.model().transmitted(r).probability;
            [rate * (1.0 - passes), rate * passes]
        };
        let lookups = |quadrature: &mut RayQuadrature<F>| match survives {
            true => LookupLaw::Poisson,
            false => LookupLaw::Moments(lookups_of_a_walk(quadrature, self.tolerance, &rates)),
        };
        self.examine_in_lanes(tracking, &also, scores, lookups, run)
    }
}

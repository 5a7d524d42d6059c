//! Every estimator on hostile profiles: dense steps, spikes, thin and negative media, eq. 21 at scales from 1e-6 to 1e5. Estimates are
//! finite, laws are numbers (or infinite where the moment is).

use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_media::{
    AnalyticCosine, Bounded, Breakpoints, Constant, InCells, IntervalBounds, Majorant, OpticalThickness,
    PiecewiseConstant, PiecewiseLinear, Ray, RayQuadrature, Tolerance, Vacuum,
};
use fairflight_sources::Seeded;
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, ClosedForm, Comb, CombShape, Experience, Explorers, GeneralisedPoisson,
    Hybrid, Jackknife, JitteredRatio, JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion,
    Offset, PSeries, PSeriesVersion, Pilot, ProgressiveMajorant, RayMarching, Regular, ResidualCells,
    Roulette, Telescoping, Theory, Tracking, TransmittanceEstimator, UnbiasedRayMarching, Unidirectional,
    Woodcock,
};
use glam::DVec3;

/// Demand on the variance: known or open.
#[derive(Clone, Copy, PartialEq)]
enum Law {
    /// A closed form that must be a number.
    Known,
    /// An estimator has none, or the closed form ends (orders without number): what is not known says so by NaN.
    Open,
}

/// One profile, and what went wrong on it.
struct Sweep {
    profile: &'static str,
    failures: Vec<String>,
    estimators: u32,
}

const SEEDS: [u64; 3] = [1, 11, 2026];

impl Sweep {
    fn new(profile: &'static str) -> Self {
        Self { profile, failures: Vec::new(), estimators: 0 }
    }

    /// Draws a few estimates from several seeds (about `lookups` each), and asks for the law. An estimator that does not admit the
    /// profile is left out.
    fn check<G: Breakpoints + OpticalThickness + Copy, E: TransmittanceEstimator<G> + ClosedForm<G>>(
        &mut self,
        kind: &str,
        field: G,
        estimator: &E,
        (law, lookups): (Law, f64),
    ) {
        let length = field.length();
        let places = (0..=400).map(|i| length * f64::from(i) / 400.0);
        if !places.clone().all(|s| estimator.admits(&field, s, field.sigma_t(s))) {
            return;
        }
        self.estimators += 1;
        if lookups > 3e5 {
            return;
        }
        let samples = (3e5 / lookups.max(1.0)).clamp(2.0, 40.0) as u32;
        for seed in SEEDS {
            let mut source = Seeded::new(seed);
            for i in 0..samples {
                let estimate = estimator.estimate(&field, &mut source);
                if !estimate.is_finite() {
                    self.failures.push(format!("{kind}, seed {seed}, sample {i}: {estimate}"));
                    break;
                }
            }
        }
        let tau = field.optical_thickness(0.0, length);
        let tolerance = Tolerance { absolute: 1e-6, relative: 1e-6, most_panels: 1000 };
        let theory = estimator.theory(&mut RayQuadrature::new(field, &[]), tau, tolerance);
        self.judge(kind, &theory, law);
    }

    fn judge(&mut self, kind: &str, theory: &Theory, law: Law) {
        let Theory { relative_mean, relative_central, log_relative_variance, .. } = *theory;
        let mut wrong = |what: &str| self.failures.push(format!("{kind}: {what}: {theory:?}"));
        if relative_mean.is_nan() {
            wrong("no mean");
        }
        if law == Law::Known && (relative_central[0].is_nan() || log_relative_variance.is_nan()) {
            wrong("no variance");
        }
        if relative_central.iter().step_by(2).any(|moment| *moment < 0.0) {
            wrong("a negative even moment");
        }
        if log_relative_variance == f64::INFINITY && relative_central[0].is_finite() {
            wrong("a finite variance of infinite logarithm");
        }
    }

    fn finish(self) {
        assert!(self.failures.is_empty(), "{}:\n{}", self.profile, self.failures.join("\n"));
        assert!(self.estimators >= 20, "{}: only {} estimators", self.profile, self.estimators);
    }
}

/// All estimators that look up, or ask for a majorant, cells or a closed form, on one profile.
fn sweep<F: Breakpoints + OpticalThickness + IntervalBounds>(name: &'static str, field: &F, majorant: f64) {
    let (length, tau) = (field.length(), field.optical_thickness(0.0, field.length()));
    let depth = majorant * length;
    let mut sweep = Sweep::new(name);
    let known = (Law::Known, depth);
    let open = (Law::Open, depth);
    let bounded = Bounded::new(field, majorant).unwrap();

    sweep.check("woodcock", bounded, &Woodcock, known);
    for splits in [1, 8] {
        let estimator = LineIntegral::new(splits).unwrap();
        sweep.check("line_integral", bounded, &estimator, (Law::Known, 8.0 * depth));
    }
    walks(&mut sweep, field, majorant);
    for version in [NextFlightVersion::Delta, NextFlightVersion::Ratio] {
        sweep.check("next_flight", bounded, &NextFlight::new(version), known);
    }
    sweep.check("next_flight unidirectional", bounded, &Unidirectional, known);
    if depth < 3000.0 {
        sweep.check("next_flight bidirectional", bounded, &Bidirectional, (Law::Open, depth * depth));
    }
    for floor in [0.1, 1.0] {
        sweep.check("adaptive_ratio", bounded, &AdaptiveRatio::new(floor).unwrap(), open);
    }
    for epsilon in [1.0, 0.25] {
        let (whole, in_cells) =
            (JitteredRatio::new(epsilon).unwrap(), JitteredRatioInCells::new(epsilon).unwrap());
        if depth < 2e4 {
            sweep.check("jittered_ratio", bounded, &whole, (Law::Known, depth / epsilon));
        }
        let cells = InCells::new(field, field.equal_cells(37)).unwrap();
        let lookups = cells_depth(&cells) / epsilon;
        if lookups < 2e4 {
            sweep.check("jittered_ratio in cells", &cells, &in_cells, (Law::Known, lookups));
        }
        let residual = ResidualCells::new(4.0 * epsilon).unwrap();
        sweep.check("residual_cells", &cells, &residual, (Law::Known, 4.0 * lookups));
    }
    series(&mut sweep, field, (tau, depth));
    combs(&mut sweep, field);
    sweep.check("regular", field, &Regular, known);

    if depth < 2e4 {
        let mut experience = Experience::default();
        (0..8).for_each(|seed| experience.observe(&Pilot::of(&bounded, &mut Seeded::new(seed))));
        for experience in [experience, Experience::default()] {
            let hybrid = Hybrid::choose(&experience, length, depth, Hybrid::USUAL_BUDGET);
            sweep.check("hybrid", bounded, &hybrid, (Law::Open, 6.0 * depth));
        }
    }
    let mut learning = ProgressiveMajorant::new(1e-3 * majorant.max(1e-300)).unwrap();
    let mut source = Seeded::new(5);
    for _ in 0..20 {
        let estimate = learning.estimate(field, &mut source);
        assert!(estimate.is_finite(), "{name}: progressive_majorant: {estimate}");
    }
    sweep.finish();
}

/// Σ range · width.
fn cells_depth<F: fairflight_media::BoundedInCells>(field: &F) -> f64 {
    let mut from = 0.0;
    let depth =
        |cell: &fairflight_media::BoundCell| cell.range() * (cell.to - std::mem::replace(&mut from, cell.to));
    field.bound_cells().iter().map(depth).sum()
}

/// Collision models with controls and sampling extinctions at, above and below the majorant.
fn walks<F: Breakpoints + OpticalThickness>(sweep: &mut Sweep, field: &F, majorant: f64) {
    let length = field.length();
    let constant = |sigma: f64| Constant::new(sigma, length).unwrap();
    for rate in [0.5 * majorant, majorant, 2.5 * majorant, 10.0 / length] {
        let at = (Law::Known, rate * length);
        let double = DoubleParticle { albedo: Albedo::new(0.5).unwrap() };
        sweep.check(
            "double_particle",
            field,
            &Tracking::new(double, Vacuum::new(length), constant(rate)),
            at,
        );
        let half = constant(0.5 * majorant);
        sweep.check("double_particle, control", field, &Tracking::new(double, half, constant(rate)), at);
        let explorers = Explorers::through(field, 9).unwrap();
        let tracking = Tracking::new(double, explorers, constant(rate));
        sweep.check("double_particle, explorers", field, &tracking, at);
        for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
            let single = SingleParticle { version, albedo: Albedo::new(0.7).unwrap() };
            let tracking = Tracking::new(single, Vacuum::new(length), constant(rate));
            sweep.check("single_particle", field, &tracking, at);
        }
    }
}

/// Power series, about pivots at and above the optical thickness.
fn series<F: Breakpoints + OpticalThickness>(sweep: &mut Sweep, field: &F, (tau, depth): (f64, f64)) {
    for pivot in [tau.max(0.0), depth, 1.5 * depth + 1.0] {
        if pivot > 2e5 {
            continue;
        }
        for version in [PSeriesVersion::Cmf, PSeriesVersion::Ratio, PSeriesVersion::NextFlight] {
            let law = if version == PSeriesVersion::Ratio { Law::Known } else { Law::Open };
            sweep.check("p_series", field, &PSeries::new(version, pivot).unwrap(), (law, pivot));
        }
        let cumulative = PSeries::new(PSeriesVersion::Cumulative, pivot).unwrap();
        sweep.check("p_series cumulative", field, &cumulative, (Law::Open, pivot));
        let poisson = GeneralisedPoisson::new(pivot, pivot.max(1e-3)).unwrap();
        sweep.check("generalised_poisson", field, &poisson, (Law::Known, pivot));
    }
}

/// Everything that is made of combs, and the biased baselines.
fn combs<F: Breakpoints + OpticalThickness>(sweep: &mut Sweep, field: &F) {
    for teeth in [1, 3, 5] {
        let at = (Law::Known, 1e4);
        for shape in CombShape::ALL {
            let comb = Comb::new(teeth, shape).unwrap();
            for (segments, stop) in [(1, 0.9), (8, 0.9), (3, 0.1)] {
                let estimator = UnbiasedRayMarching::new(comb, Roulette::new(stop).unwrap());
                let estimator = estimator.in_segments(segments).unwrap();
                sweep.check("unbiased_ray_marching", field, &estimator, (Law::Open, 1e4));
            }
            sweep.check("jackknife", field, &Jackknife::new(comb), at);
        }
        for (shape, ratio) in [(CombShape::Uniform, 0.8), (CombShape::EndpointMatched, 0.9)] {
            let estimator = Telescoping::new(teeth, ratio, shape).unwrap();
            sweep.check("telescoping", field, &estimator, (Law::Open, 1e4));
        }
        for offset in [Offset::Fixed, Offset::Jittered] {
            sweep.check("ray_marching", field, &RayMarching::new(teeth, offset).unwrap(), at);
        }
    }
}

fn steps(edges: &[f64], sigma_t: &[f64]) -> PiecewiseConstant {
    PiecewiseConstant::new(edges.to_vec(), sigma_t.to_vec()).unwrap()
}

fn of_steps(name: &'static str, edges: &[f64], sigma_t: &[f64]) {
    let field = steps(edges, sigma_t);
    let majorant = field.majorant().max(0.0);
    sweep(name, &field, majorant);
}

#[test]
fn a_dense_half() {
    of_steps("dense half", &[0.0, 1.0, 2.0], &[0.1, 4e4]);
    of_steps("dense first half", &[0.0, 1.0, 2.0], &[4e4, 0.0]);
}

#[test]
fn a_narrow_dense_layer() {
    of_steps("narrow layer", &[0.0, 1.0, 1.00001, 2.0], &[0.1, 4e4, 0.1]);
    let spike =
        PiecewiseLinear::new(vec![0.0, 0.5, 0.5 + 5e-7, 0.5 + 1e-6, 1.0], vec![0.1, 0.1, 1e6, 0.1, 0.1]);
    sweep("linear spike", &spike.unwrap(), 1e6);
}

#[test]
fn dense_everywhere() {
    of_steps("constant", &[0.0, 1.0], &[1e5]);
    let edges: Vec<f64> = (0..=10).map(|i| 0.1 * f64::from(i)).collect();
    of_steps("blinds", &edges, &[0.0, 9e4, 0.0, 9e4, 0.0, 9e4, 0.0, 9e4, 0.0, 9e4]);
}

#[test]
fn thin_media() {
    of_steps("1e-300", &[0.0, 1.0, 3.0], &[1e-300, 3e-300]);
    of_steps("1e-300 and 3", &[0.0, 1.0, 3.0], &[1e-300, 3.0]);
    of_steps("nothing", &[0.0, 1.0], &[0.0]);
}

#[test]
fn negative_parts() {
    of_steps("a negative half", &[0.0, 1.0, 2.0], &[3.0, -2.0]);
    of_steps("gain and loss that cancel", &[0.0, 1.0, 2.0, 3.0], &[60.0, -90.0, 40.0]);
    let line = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![-5.0, 8.0, -1.0]).unwrap();
    sweep("a line through zero", &line, 8.0);
}

#[test]
fn eq21_at_every_scale() {
    // Depths of 2e-5, 20, 16 000 and 2e6 in the majorant.
    for scale in [1e-6, 1.0, 800.0, 2000.0, 1e5] {
        let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
        sweep("eq. 21", &Ray::new(AnalyticCosine::new(scale).unwrap(), &clip), scale);
    }
}

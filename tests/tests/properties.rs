//! Random piecewise media, controls, sampling extinctions and albedos: the moment formula gives exp(−τ), and simulation
//! gives the moment formula. Deterministic: proptest's own fixed generator.

use fairflight_catalogue::FAMILY_LEVEL;
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::check;
use fairflight_laws::{Expectation, Run, Truth};
use fairflight_media::{
    Breakpoints, Extinction, OpticalThickness, PiecewiseConstant, RayQuadrature, Tolerance,
};
use fairflight_stats::{Scores, sidak_level};
use fairflight_transmittance::{ClosedForm, Tracking};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;

/// One of the models that admit every r.
#[derive(Clone, Copy, Debug)]
enum AnyModel {
    Double(DoubleParticle),
    Single(SingleParticle),
}

impl CollisionModel for AnyModel {
    fn admits(&self, r: f64) -> bool {
        match self {
            Self::Double(model) => model.admits(r),
            Self::Single(model) => model.admits(r),
        }
    }
    fn scattered(&self, r: f64) -> fairflight_collision::Branch {
        match self {
            Self::Double(model) => model.scattered(r),
            Self::Single(model) => model.scattered(r),
        }
    }
    fn transmitted(&self, r: f64) -> fairflight_collision::Branch {
        match self {
            Self::Double(model) => model.transmitted(r),
            Self::Single(model) => model.transmitted(r),
        }
    }
    fn transmit_by(&self, r: f64, u: f64) -> Option<f64> {
        match self {
            Self::Double(model) => model.transmit_by(r, u),
            Self::Single(model) => model.transmit_by(r, u),
        }
    }
}

/// Cells with their width, σ_t, σ_main and σ_samp.
#[derive(Clone, Debug)]
struct Setup {
    cells: Vec<[f64; 4]>,
    model: AnyModel,
}

impl Setup {
    fn field(&self, component: usize) -> PiecewiseConstant {
        let mut edges = vec![0.0];
        for cell in &self.cells {
            edges.push(edges[edges.len() - 1] + cell[0]);
        }
        PiecewiseConstant::new(edges, self.cells.iter().map(|cell| cell[component]).collect()).unwrap()
    }

    fn sum(&self, term: impl Fn([f64; 4]) -> f64) -> f64 {
        self.cells.iter().map(|&cell| cell[0] * term(cell)).sum()
    }

    fn ratio([_, sigma_t, main, sampling]: [f64; 4]) -> f64 {
        (sigma_t - main) / sampling
    }

    /// ∫ σ_samp E[(W − 1)²]: for the double particle model ∫ σ_diff²/σ_samp.
    fn second_integral(&self) -> f64 {
        self.sum(|cell| cell[3] * self.model.transmitted(Self::ratio(cell)).moment_about_one(2))
    }
}

fn setups(least_sampling: f64) -> impl Strategy<Value = Setup> {
    let cell = (0.1..1.5, -0.5..1.5, -0.5..1.0, least_sampling..(4.0 * least_sampling))
        .prop_map(|(width, sigma_t, main, sampling)| [width, sigma_t, main, sampling]);
    let model = (0..3, 0.0..=1.0).prop_map(|(kind, albedo)| {
        let albedo = Albedo::new(albedo).unwrap();
        match kind {
            0 => AnyModel::Double(DoubleParticle { albedo }),
            1 => AnyModel::Single(SingleParticle { version: Version::NonTerminating, albedo }),
            _ => AnyModel::Single(SingleParticle { version: Version::Adaptive, albedo }),
        }
    });
    (prop::collection::vec(cell, 1..6), model).prop_map(|(cells, model)| Setup { cells, model })
}

fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

#[test]
fn the_first_moment_is_the_transmittance() {
    // E = T_main exp(∫ σ_samp (E[W] − 1)), by exact sums over the cells.
    let law = |setup: Setup| {
        let walk = setup.sum(|cell| cell[3] * (setup.model.transmitted(Setup::ratio(cell)).moment(1) - 1.0));
        let main = setup.sum(|cell| cell[2]);
        let tau = setup.sum(|cell| cell[1]);
        prop_assert!((walk - main + tau).exp_m1().abs() < 1e-10, "{setup:?}");
        // The closed form of the field is the same sum.
        let field = setup.field(1);
        prop_assert!((field.optical_thickness(0.0, field.length()) - tau).abs() < 1e-12);
        Ok(())
    };
    runner(2000).run(&setups(0.2), law).unwrap();
}

#[test]
fn the_theory_is_the_exact_sum() {
    let law = |setup: Setup| {
        let (field, control, sampling) = (setup.field(1), setup.field(2), setup.field(3));
        let estimator = Tracking::new(setup.model, control, sampling);
        let tau = field.optical_thickness(0.0, field.length());
        let mut quadrature = RayQuadrature::new(&field, &[]);
        let theory = estimator.theory(&mut quadrature, tau, Tolerance::TIGHT);
        let j = setup.second_integral();
        prop_assert!((theory.relative_central[0] / j.exp_m1() - 1.0).abs() < 1e-9, "{setup:?}: {theory:?}");
        Ok(())
    };
    runner(200).run(&setups(0.2), law).unwrap();
}

#[test]
fn simulation_has_the_stated_moments() {
    const CASES: u32 = 48;
    const SAMPLES: u64 = 60_000;
    let alpha = sidak_level(FAMILY_LEVEL, CASES as usize);
    let (case, judged, variances) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let law = |setup: Setup| {
        if setup.second_integral() >= 0.5 {
            return Err(TestCaseError::reject("variance too large for this N"));
        }
        let (field, control, sampling) = (setup.field(1), setup.field(2), setup.field(3));
        let also = field.breakpoints();
        let estimator = Tracking::new(setup.model, control, sampling);
        let truth = Truth::closed_form(&field);
        let mut quadrature = RayQuadrature::new(&field, &also);
        let theory = estimator.theory(&mut quadrature, truth.optical_thickness, Tolerance::TIGHT);
        let lookups = LookupLaw::MeanOnly;
        let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups };
        case.set(case.get() + 1);
        let run = Run { samples: SAMPLES, seed: case.get(), alpha };
        let evidence = check(&field, &estimator, &expected, run).unwrap();
        prop_assert!(evidence.holds() != Some(false), "{setup:?}: {evidence:?}");
        judged.set(judged.get() + u32::from(evidence.verdict.sound == Some(true)));
        variances.set(variances.get() + u32::from(evidence.verdict.variance_p.is_some()));
        Ok(())
    };
    runner(CASES).run(&setups(1.0), law).unwrap();
    println!("{} of {CASES} means and {} variances were testable", judged.get(), variances.get());
    assert!(judged.get() > CASES / 2, "only {} of {CASES} means were testable", judged.get());
    assert!(variances.get() > 0, "no variance was testable");
}

//! Rows 17 and 18: distances within a region that is optically next to nothing or opaque, lights next to the point that they light.

use super::{HardCase, LAWFUL, Outcome};
use crate::vpl::local::{Local, estimate};
use crate::vpl::tiny;
use fairflight_collision::Version;
use fairflight_compensation::{
    Compensation, CompensationOptions, LocalMean, Placement, TruncatedExponential,
};
use fairflight_laws::CheckResult;
use fairflight_paths::transport::Lobe;
use fairflight_paths::{Uniform, Walk};
use fairflight_sources::{LARGEST_VARIATE, Scripted, UniformSource};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Connected, Pairing};
use glam::DVec3;
use std::f64::consts::PI;

/// Distances, density and the probability to come further, on d = 0.5, against `exact` (u) for a distance.
fn within(depth: f64, exact: impl Fn(f64) -> f64) -> Outcome {
    const LENGTH: f64 = 0.5;
    let law = TruncatedExponential::new(depth / LENGTH, LENGTH);
    let mut worst = 0.0_f64;
    for u in [0.0, f64::EPSILON, 1e-9, 0.25, 0.5, 0.75, LARGEST_VARIATE] {
        let (distance, right) = (law.sample(u), LENGTH * exact(u));
        let differs = (distance - right).abs() / right.max(f64::MIN_POSITIVE);
        // The mass below a distance is u.
        let mass = (law.probability_beyond(distance) - (1.0 - u)).abs();
        let is_lawful = (0.0..=LENGTH).contains(&distance) && law.pdf_distance(distance) >= 0.0;
        worst = if is_lawful { worst.max(differs).max(mass) } else { f64::NAN };
    }
    Outcome::said(worst <= 4e-15, format!("off by {worst:.1e} at most"))
}

/// A light at a distance from the point that it lights, in a medium or on a floor.
fn next_to(mut scene: Local, distance: f64) -> Local {
    scene.vpls.truncate(1);
    let towards = match scene.y.lobe {
        Lobe::Diffuse { normal, .. } => normal,
        Lobe::Phase { .. } => DVec3::X,
    };
    scene.vpls[0].vertex.position = scene.y.position + distance * towards;
    scene
}

fn walk() -> Walk<Uniform> {
    Walk::new(Version::NonTerminating, Uniform::new(1.5 * tiny::SIGMA_T).expect(LAWFUL))
}

/// A bounded connection is power f f' b, to the transmittance of next to nothing; none at distance 0, where there is no direction.
fn connection(scene: &Local, distance: f64) -> Outcome {
    let mut none = Scripted::new([]);
    let ours = scene.gather(walk(), Regular).connected(&scene.y, Connected::All, &mut none);
    let f = match scene.y.lobe {
        Lobe::Diffuse { .. } => 1.0 / PI,
        Lobe::Phase { .. } => 1.0 / (4.0 * PI),
    };
    let power = scene.vpls[0].power;
    let exact = power * f / (4.0 * PI) * scene.bound * (-tiny::SIGMA_T * distance).exp();
    Outcome::value(ours, if distance == 0.0 { 0.0 } else { exact }, 1e-14)
}

/// Outcome with compensation: judged by its law, and finite for the extreme variates.
fn compensated(scene: &Local, placement: Placement, run: fairflight_laws::Run) -> Outcome {
    let mean = LocalMean::of(&scene.volume.medium, &scene.volume.bounds, [1; 3], 1);
    let options = CompensationOptions { placement, steps: Some(1), ..CompensationOptions::EXACT };
    let correction = Compensation::new(options, &mean);
    for u in [0.0, 0.5, LARGEST_VARIATE] {
        struct Always(f64);
        impl UniformSource for Always {
            fn next_uniform(&mut self) -> f64 {
                self.0
            }
        }
        let (mut gather, mut extreme) = (scene.gather(walk(), Regular), correction.clone());
        let value = estimate(&mut gather, &mut extreme, Pairing::Every, &scene.y, &mut Always(u));
        if !value.is_finite() {
            return Outcome::said(false, format!("{value} for variates of {u}"));
        }
    }
    let reference = scene.reference();
    let verdict = scene.check((walk(), Regular), &correction, &reference, run);
    match verdict {
        Ok(verdict) => Outcome::judged(CheckResult::of_verdict(&verdict, run.samples), reference.mean),
        Err(error) => Outcome::said(false, error.to_string()),
    }
}

pub(super) fn cases() -> Vec<HardCase> {
    type Place = (&'static str, fn() -> Local);
    let mut cases = Vec::new();
    for (depth, exact) in [(0.0, "t = u d"), (1e-18, "t = u d"), (1e3, "-ln(1 - u (1 - e^-1000)) d/1000")] {
        let distance = move |u: f64| if depth < 1.0 { u } else { -(-u).ln_1p() / depth };
        cases.push(HardCase::deterministic(
            17,
            format!("sigma d = {depth:e}: distances within the region"),
            "engelhardt-2013 eq. 4 and 5",
            exact,
            "4e-15",
            move || within(depth, distance),
        ));
    }
    let scenes: [Place; 2] =
        [("in a medium", || tiny::isotropic(1)), ("on a floor", || tiny::isotropic_above_floor())];
    for (place, scene) in scenes {
        for distance in [0.0, 1e-12, 1e-6] {
            cases.push(HardCase::deterministic(
                18,
                format!("a light {distance:e} from a point {place}: bounded"),
                "bounded connection",
                if distance == 0.0 { "0: no direction" } else { "power f f' b" },
                "1e-14 relative",
                move || connection(&next_to(scene(), distance), distance),
            ));
        }
    }
    // At 0 the light still lights the vertices around.
    for (distance, placement) in
        [(0.0, Placement::FreeFlight), (1e-12, Placement::LocallyHomogeneous), (1e-6, Placement::FreeFlight)]
    {
        cases.push(HardCase::statistical(
            18,
            format!("a light {distance:e} from a point in a medium: compensated"),
            "one step of compensation",
            "quadrature",
            300_000,
            move |run| compensated(&next_to(tiny::isotropic(1), distance), placement, run),
        ));
    }
    cases.into_iter().map(|case| case.about(["vpl"])).collect()
}

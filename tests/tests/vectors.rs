//! The committed test vectors: what another implementation made of given variates, replayed by the estimators.

use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_freeflight::spectral::{AverageScheme, SpectralFlight, SpectralFreeFlight, SpectralTracking};
use fairflight_media::phase::{HenyeyGreenstein, PhaseFunction};
use fairflight_media::{Constant, Extinction, Line, Majorant, PiecewiseLinear, Scaled, Vacuum};
use fairflight_paths::single_scattering::SourceDriven;
use fairflight_sources::UniformSource;
use fairflight_tests::repository;
use fairflight_transmittance::{
    Comb, CombShape, JitteredRatio, Roulette, Tracking, TransmittanceEstimator, UnbiasedRayMarching, Woodcock,
};
use glam::DVec3;
use serde_json::Value;
use std::cell::RefCell;
use std::fs;

/// The variates of a case; exponentials are given.
struct Given<'a> {
    draws: &'a [Value],
    drawn: usize,
}

impl Given<'_> {
    fn next(&mut self, used: &str) -> &Value {
        let draw = self.draws.get(self.drawn).expect("no more draws than the case has");
        assert_eq!(draw[0], used, "draw {}", self.drawn);
        self.drawn += 1;
        draw
    }
}

impl UniformSource for Given<'_> {
    fn next_uniform(&mut self) -> f64 {
        self.next("u")[1].as_u64().unwrap() as f64 * 2.0_f64.powi(-53)
    }

    fn next_exponential(&mut self) -> f64 {
        self.next("e")[2].as_f64().unwrap()
    }
}

/// The profile of a case, which remembers where it was looked up.
struct Seen {
    profile: PiecewiseLinear,
    lookups: RefCell<Vec<[f64; 2]>>,
}

impl Seen {
    fn of(case: &Value) -> Self {
        let profile =
            PiecewiseLinear::new(numbers(&case["profile"]["s"]), numbers(&case["profile"]["sigma_t"]));
        Self { profile: profile.unwrap(), lookups: RefCell::default() }
    }
}

impl Extinction for Seen {
    fn sigma_t(&self, s: f64) -> f64 {
        let sigma_t = self.profile.sigma_t(s);
        self.lookups.borrow_mut().push([s, sigma_t]);
        sigma_t
    }
    fn length(&self) -> f64 {
        self.profile.length()
    }
}

impl Majorant for Seen {
    fn majorant(&self) -> f64 {
        self.profile.majorant()
    }
}

/// One number or several.
fn numbers(json: &Value) -> Vec<f64> {
    match json {
        Value::Array(all) => all.iter().map(|number| number.as_f64().unwrap()).collect(),
        one => vec![one.as_f64().unwrap()],
    }
}

/// What an estimator makes of a case: its values, and where a flight ended.
fn replayed(case: &Value, field: Option<&Seen>, source: &mut Given<'_>) -> (Vec<f64>, Option<&'static str>) {
    let of = |key: &str, name: &str| case[key][name].as_f64();
    let length = field.map_or(0.0, Extinction::length);
    let constant = |sigma_t: f64| Constant::new(sigma_t, length).unwrap();
    let kind = ["estimator", "sampler", "phase"].iter().find_map(|key| case[key]["kind"].as_str());
    let estimator = |name: &str| of("estimator", name).unwrap();
    let value = match (kind.unwrap(), field) {
        ("double_particle", Some(field)) => {
            let model = DoubleParticle { albedo: Albedo::new(0.0).unwrap() };
            let sampling = constant(estimator("sigma_samp"));
            match case["estimator"]["control"]["sigma_t"].as_f64() {
                None => Tracking::new(model, Vacuum::new(length), sampling).estimate(field, source),
                Some(control) => Tracking::new(model, constant(control), sampling).estimate(field, source),
            }
        }
        ("woodcock", Some(field)) => Woodcock.estimate(field, source),
        ("jittered_ratio", Some(field)) => {
            JitteredRatio::new(estimator("epsilon")).unwrap().estimate(field, source)
        }
        ("unbiased_ray_marching", Some(field)) => {
            let is_matched = case["estimator"]["endpoint_matching"] == true;
            let shape = if is_matched { CombShape::EndpointMatched } else { CombShape::Uniform };
            let comb = Comb::new(estimator("teeth") as u32, shape).unwrap();
            let roulette = Roulette::new(estimator("roulette")).unwrap();
            UnbiasedRayMarching::new(comb, roulette).estimate(field, source)
        }
        ("spectral_tracking", Some(field)) => {
            let coefficients: [f64; 3] = numbers(&case["coefficients"]).try_into().unwrap();
            let tracking =
                SpectralTracking::new(AverageScheme, constant(of("sampler", "sigma_samp").unwrap()));
            let flight = tracking.sample(&Scaled::new(field, coefficients).unwrap(), source);
            let event = match flight {
                SpectralFlight::Collided { .. } => "collided",
                SpectralFlight::Escaped { .. } => "escaped",
            };
            return (flight.weights().to_vec(), Some(event));
        }
        ("equiangular", None) => {
            let sampler = &case["sampler"];
            let [origin, direction, light] =
                ["origin", "direction", "light"].map(|key| DVec3::from_slice(&numbers(&sampler[key])));
            let length = sampler["length"].as_f64().unwrap();
            let driven = SourceDriven::new(&Line { origin, direction }, length, light);
            let s = driven.sample(source.next_uniform());
            return (vec![s, driven.pdf_distance(s)], None);
        }
        ("henyey_greenstein", None) => {
            let phase = HenyeyGreenstein::new(of("phase", "g").unwrap()).unwrap();
            let cosine = phase.sample_cosine(source.next_uniform());
            return (vec![cosine, phase.eval(cosine)], None);
        }
        (kind, _) => panic!("nobody replays {kind}"),
    };
    (vec![value], None)
}

/// Replays a case; true if every bit is that of the case.
fn has_all_bits(case: &Value) -> bool {
    let id = &case["id"];
    let field = case.get("profile").map(|_| Seen::of(case));
    let mut source = Given { draws: case["draws"].as_array().unwrap(), drawn: 0 };
    let (values, event) = replayed(case, field.as_ref(), &mut source);
    let expect = &case["expect"];
    assert_eq!(source.drawn as u64, expect["draws"], "{id}: draws");
    assert_eq!(event, expect["event"].as_str(), "{id}: event");
    if let Some(field) = field {
        let trace: Vec<[f64; 2]> = case["trace"]
            .as_array()
            .unwrap()
            .iter()
            .map(|step| [0, 1].map(|i| step[i].as_f64().unwrap()))
            .collect();
        assert_eq!(*field.lookups.borrow(), trace, "{id}: look-ups");
        assert_eq!(trace.len() as u64, expect["lookups"], "{id}");
    }
    let expected = numbers(&expect["value"]);
    if case["tolerance"]["exponentials_given"]["binary64"] == 0 {
        assert_eq!(values, expected, "{id}");
    }
    let granted = numbers(&case["tolerance"]["binary64"]["value"]);
    for ((found, expected), granted) in values.iter().zip(&expected).zip(granted) {
        assert!((found - expected).abs() <= granted, "{id}: {found} for {expected}, within {granted}");
    }
    values == expected
}

#[test]
fn estimators_replay_the_vectors() {
    let mut files = 0;
    for path in fairflight_tests::files("tests/vectors") {
        if !fairflight_tests::has_extension(&path, &["jsonl"]) {
            continue;
        }
        files += 1;
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let (header, cases) = lines.split_first().unwrap();
        assert_eq!(header["format"], "fairflight-vectors", "{}", path.display());
        let equal = cases.iter().filter(|case| has_all_bits(case)).count();
        println!("{}: {equal} of {} bit by bit", header["kind"], cases.len());
        // All bits but where a tangent or an angle comes in, which no library that the estimators use rounds correctly.
        let share = if header["kind"] == "equiangular" { 0.95 } else { 0.99 };
        assert!(equal as f64 >= share * cases.len() as f64, "{}: {equal} of {}", path.display(), cases.len());
    }
    assert_eq!(files, fairflight_vectors::KINDS.len());
}

/// What is committed is what the generator writes.
#[test]
fn the_vectors_are_those_of_the_generator() {
    for kind in fairflight_vectors::KINDS {
        let path = repository().join(format!("tests/vectors/{}.jsonl", kind.name));
        let committed = fs::read_to_string(path).unwrap();
        let lines = kind.lines();
        assert_eq!(committed.lines().count(), lines.len(), "{}", kind.name);
        for (found, made) in committed.lines().zip(lines) {
            assert_eq!(found, made.to_string(), "{}: run `harness vectors --out tests/vectors`", kind.name);
        }
    }
}

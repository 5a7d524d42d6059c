//! Answers of this project's estimators, samplers and functions to cases of the test vectors.

use crate::case::numbers;
use fairflight_bidirectional::LogHeuristic;
use fairflight_catalogue::vectors::{Answer, Seen, Vector};
use fairflight_collision::{
    Albedo, CollisionModel, DoubleParticle, Outcome, SingleOutcome, SingleParticle, Version,
    Woodcock as WoodcockCollision,
};
use fairflight_compensation::TruncatedExponential;
use fairflight_freeflight::spectral::{
    AverageScheme, DecompositionTracking, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance,
    SpectralFlight, SpectralFreeFlight, SpectralTracking,
};
use fairflight_freeflight::{self as freeflight, Flight, FreeFlight};
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, PhaseFunction, Rayleigh, Schlick, Tabulated};
use fairflight_media::{
    Bounded, Constant, Extinction, Line, OpticalThickness, PiecewiseConstant, PiecewiseLinear, Scaled, Vacuum,
};
use fairflight_paths::Heuristic;
use fairflight_paths::single_scattering::SourceDriven;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, Comb, CombShape, GeneralisedPoisson, Jackknife, JitteredRatio,
    JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion, Offset, PSeries, PSeriesVersion,
    ProgressiveMajorant, RayMarching, Regular, ResidualCells, Roulette, Telescoping, Tracking,
    TransmittanceEstimator, UnbiasedRayMarching, Unidirectional, Woodcock,
};
use fairflight_vpl::Term;
use glam::{DVec3, dvec3};
use serde_json::Value;

/// Answer of this project to a case.
pub(crate) fn answer(case: &Value, vector: &Vector<'_>, source: &mut impl UniformSource) -> Answer {
    match vector.field {
        Some(field) if case["estimator"].is_object() => estimated(case, vector, field, source),
        Some(field) => flown(case, vector, field, source),
        None => Answer { values: drawn(case, vector, source), collided: None },
    }
}

fn version(word: &str) -> Version {
    match word {
        "terminating" => Version::Terminating,
        "non_terminating" => Version::NonTerminating,
        "adaptive" => Version::Adaptive,
        _ => panic!("no version {word}"),
    }
}

/// Tracking with the sampling extinction and the control of a case.
fn tracked<M: CollisionModel>(case: &Value, model: M, field: &Seen, source: &mut impl UniformSource) -> f64 {
    let length = field.length();
    let constant = |sigma_t: f64| Constant::new(sigma_t, length).unwrap();
    let (sampling, control) = (&case["estimator"]["sigma_samp"], &case["estimator"]["control"]);
    let rates = || PiecewiseConstant::new(numbers(&sampling["edges"]), numbers(&sampling["values"])).unwrap();
    fn by<M: CollisionModel, C: OpticalThickness>(
        (model, control): (M, C),
        (field, source): (&Seen, &mut impl UniformSource),
        sampling: Result<Constant, PiecewiseConstant>,
    ) -> f64 {
        match sampling {
            Ok(constant) => Tracking::new(model, control, constant).estimate(field, source),
            Err(cells) => Tracking::new(model, control, cells).estimate(field, source),
        }
    }
    let sampling = match sampling.as_f64() {
        Some(value) => Ok(constant(value)),
        None => Err(rates()),
    };
    match control["kind"].as_str() {
        None => by((model, Vacuum::new(length)), (field, source), sampling),
        Some("constant") => {
            let value = control.get("sigma_main").unwrap_or(&control["sigma_t"]);
            by((model, constant(value.as_f64().unwrap())), (field, source), sampling)
        }
        Some(_) => {
            let [positions, values] = ["positions", "sigma_main"].map(|key| numbers(&control[key]));
            let control = PiecewiseLinear::new(positions, values).unwrap();
            by((model, control), (field, source), sampling)
        }
    }
}

/// Unbiased ray marching with any comb.
fn marched(case: &Value) -> UnbiasedRayMarching {
    let estimator = &case["estimator"];
    let shape = match (estimator["comb"].as_str(), estimator["order"].as_u64()) {
        (Some("periodised"), _) => CombShape::Periodised,
        (_, Some(2)) => CombShape::Bernoulli2,
        (_, Some(_)) => CombShape::Bernoulli3,
        _ if estimator["endpoint_matching"] == true => CombShape::EndpointMatched,
        _ => CombShape::Uniform,
    };
    let comb = Comb::new(estimator["teeth"].as_u64().unwrap() as u32, shape).unwrap();
    let roulette = Roulette::new(estimator["roulette"].as_f64().unwrap()).unwrap();
    let segments = estimator["segments"].as_u64().unwrap_or(1) as u32;
    UnbiasedRayMarching::new(comb, roulette).in_segments(segments).unwrap()
}

fn estimated(case: &Value, vector: &Vector<'_>, field: &Seen, source: &mut impl UniformSource) -> Answer {
    let of = |key: &str| (vector.number)(&format!("/estimator/{key}"));
    let number = |key: &str| of(key).unwrap_or_else(|| panic!("a number {key}"));
    let whole = |key: &str| number(key) as u32;
    let word = |key: &str| (vector.word)(&format!("/estimator/{key}")).unwrap();
    let bounded = || Bounded::new(field, number("majorant")).unwrap();
    let matched = |is: bool| if is { CombShape::EndpointMatched } else { CombShape::Uniform };
    let value = match vector.kind {
        "double_particle" => tracked(case, DoubleParticle { albedo: Albedo::default() }, field, source),
        "single_particle" => {
            let albedo = Albedo::new(number("albedo")).unwrap();
            tracked(case, SingleParticle { version: version(word("version")), albedo }, field, source)
        }
        "woodcock" => Woodcock.estimate(field, source),
        "jittered_ratio" if case["estimator"]["cells"].is_object() => {
            JitteredRatioInCells::new(number("epsilon")).unwrap().estimate(field, source)
        }
        "jittered_ratio" => JitteredRatio::new(number("epsilon")).unwrap().estimate(field, source),
        "residual_cells" => ResidualCells::new(number("rate")).unwrap().estimate(field, source),
        "unbiased_ray_marching" => marched(case).estimate(field, source),
        "telescoping" => {
            let shape = matched(number("endpoint_matching") == 1.0);
            Telescoping::new(whole("teeth"), number("level_ratio"), shape).unwrap().estimate(field, source)
        }
        "jackknife" => {
            Jackknife::new(Comb::new(whole("teeth"), CombShape::Uniform).unwrap()).estimate(field, source)
        }
        "ray_marching" => {
            let offset = if number("jitter") == 1.0 { Offset::Jittered } else { Offset::Fixed };
            RayMarching::new(whole("steps"), offset).unwrap().estimate(field, source)
        }
        "line_integral" => LineIntegral::new(whole("splits")).unwrap().estimate(&bounded(), source),
        "next_flight" => match word("version") {
            "delta" => NextFlight::new(NextFlightVersion::Delta).estimate(&bounded(), source),
            "ratio" => NextFlight::new(NextFlightVersion::Ratio).estimate(&bounded(), source),
            "unidirectional" => Unidirectional.estimate(&bounded(), source),
            _ => Bidirectional.estimate(&bounded(), source),
        },
        "p_series" => {
            let version = match word("version") {
                "cmf" => PSeriesVersion::Cmf,
                "cumulative" => PSeriesVersion::Cumulative,
                "ratio" => PSeriesVersion::Ratio,
                _ => PSeriesVersion::NextFlight,
            };
            PSeries::new(version, number("pivot")).unwrap().estimate(field, source)
        }
        "generalised_poisson" => {
            GeneralisedPoisson::new(number("pivot"), number("rate")).unwrap().estimate(field, source)
        }
        "adaptive_ratio" => AdaptiveRatio::new(number("floor")).unwrap().estimate(&bounded(), source),
        "regular" => Regular.estimate(field, source),
        "progressive_majorant" => {
            let mut progressive = ProgressiveMajorant::new(number("start")).unwrap();
            let mut values: Vec<f64> = (0..3).map(|_| progressive.estimate(field, source)).collect();
            values.push(progressive.majorant());
            return Answer { values, collided: None };
        }
        kind => panic!("nobody replays {kind}"),
    };
    value.into()
}

fn of_flight(flight: Flight, length: f64) -> Answer {
    let distance = flight.distance();
    let values = vec![distance.unwrap_or(length), flight.weight()];
    Answer { values, collided: Some(distance.is_some()) }
}

/// A flight for several wavelengths: the weights, behind the distance where the kind has it.
fn of_spectral(flight: SpectralFlight<3>, length: Option<f64>) -> Answer {
    let distance = flight.of(0).distance();
    let mut values: Vec<f64> = length.map(|length| distance.unwrap_or(length)).into_iter().collect();
    values.extend(flight.weights());
    Answer { values, collided: Some(distance.is_some()) }
}

fn flown(case: &Value, vector: &Vector<'_>, field: &Seen, source: &mut impl UniformSource) -> Answer {
    let length = field.length();
    let constant = |sigma_t: f64| Constant::new(sigma_t, length).unwrap();
    let number = |key: &str| (vector.number)(&format!("/sampler/{key}")).unwrap();
    let word = |key: &str| (vector.word)(&format!("/sampler/{key}")).unwrap();
    let spectrum = || {
        let coefficients: [f64; 3] = numbers(&case["coefficients"]).try_into().unwrap();
        Scaled::new(field, coefficients).unwrap()
    };
    let flight = match vector.kind {
        "woodcock_flight" => {
            let [edges, values] = ["edges", "values"].map(|key| numbers(&case["sampler"]["majorant"][key]));
            let cells = PiecewiseConstant::new(edges, values).unwrap();
            freeflight::Woodcock::new(cells).sample(field, source)
        }
        "tracking_flight" => {
            let sampling = constant(number("sigma_samp"));
            freeflight::Tracking::new(version(word("version")), sampling).sample(field, source)
        }
        "decomposition_tracking" => {
            let [control, sampling] = ["control", "sigma_samp"].map(|key| constant(number(key)));
            let version = version(word("version"));
            DecompositionTracking::new(version, control, sampling).sample(field, source)
        }
        "inversion_flight" => freeflight::Inversion.sample(field, source),
        "regular_flight" => freeflight::Regular.sample(field, source),
        "jittered_flight" => {
            freeflight::JitteredFlight::new(number("epsilon")).unwrap().sample(field, source)
        }
        "spectral_tracking" if word("scheme") == "average" => {
            let tracking = SpectralTracking::new(AverageScheme, constant(number("sigma_samp")));
            return of_spectral(tracking.sample(&spectrum(), source), None);
        }
        "spectral_tracking" => {
            let sampling = constant(number("sigma_samp"));
            let flight = match (vector.number)("/sampler/control") {
                Some(control) => SpectralTracking::with_control(MaxScheme, constant(control), sampling)
                    .sample(&spectrum(), source),
                None => SpectralTracking::new(MaxScheme, sampling).sample(&spectrum(), source),
            };
            return of_spectral(flight, Some(length));
        }
        "hero_wavelength" => {
            let hero = HeroWavelength::new(constant(number("majorant")));
            return of_spectral(hero.sample(&spectrum(), source), Some(length));
        }
        "separate_solve" => {
            let majorants: [f64; 3] = numbers(&case["sampler"]["majorants"]).try_into().unwrap();
            let separate = SeparateSolve::new(majorants.map(constant));
            return of_spectral(separate.sample(&spectrum(), source), Some(length));
        }
        "shared_distance" => {
            let shared = SharedDistance::new(constant(number("sigma_samp")));
            return of_spectral(shared.sample(&spectrum(), source), Some(length));
        }
        kind => panic!("nobody replays {kind}"),
    };
    of_flight(flight, length)
}

/// Cosine and phase function, or the direction about the incident one.
fn scattered(case: &Value, phase: &impl PhaseFunction, source: &mut impl UniformSource) -> Vec<f64> {
    if case["incident"].is_array() {
        let incident = DVec3::from_slice(&numbers(&case["incident"]));
        let (u, v) = (source.next_uniform(), source.next_uniform());
        let scattered = phase.sample(incident, u, v);
        let direction = scattered.direction;
        return vec![incident.dot(direction), direction.length(), scattered.pdf_solid_angle];
    }
    let cosine = phase.sample_cosine(source.next_uniform());
    vec![cosine, phase.eval(cosine)]
}

fn heuristic(vector: &Vector<'_>) -> Heuristic {
    match (vector.word)("/heuristic").unwrap() {
        "balance" => Heuristic::Balance,
        "power" => Heuristic::Power,
        _ => Heuristic::Maximum,
    }
}

/// The weights of all strategies of a path, in logarithms.
fn strategies(case: &Value, heuristic: Heuristic, source: &mut impl UniformSource) -> Vec<f64> {
    // ln p_(t+1)/p_t of each vertex.
    let mut step = |exponents: &Value| {
        let [forward, backward] =
            [0, 1].map(|i| 2.0_f64.powf(exponents[i].as_f64().unwrap()) * (1.0 + source.next_uniform()));
        (forward / backward).ln()
    };
    let steps: Vec<f64> = case["path"].as_array().unwrap().iter().map(&mut step).collect();
    let sum = |logs: &mut dyn Iterator<Item = f64>| {
        logs.fold(f64::NEG_INFINITY, |sum, ln| heuristic.add(sum, heuristic.scale(ln)))
    };
    let weight = |t: usize| {
        let fewer = sum(&mut (0..t).map(|j| -steps[j..t].iter().sum::<f64>()));
        let more = sum(&mut (t + 1..=steps.len()).map(|j| steps[t..j].iter().sum()));
        heuristic.weight(fewer, more)
    };
    (0..=steps.len()).map(weight).collect()
}

/// Answers that need no profile.
fn drawn(case: &Value, vector: &Vector<'_>, source: &mut impl UniformSource) -> Vec<f64> {
    let number = |path: &str| (vector.number)(path).unwrap();
    let parameter = |key: &str| number(&format!("/phase/{key}"));
    match vector.kind {
        "equiangular" => {
            let sampler = &case["sampler"];
            let [origin, direction, light] =
                ["origin", "direction", "light"].map(|key| DVec3::from_slice(&numbers(&sampler[key])));
            let driven = SourceDriven::new(&Line { origin, direction }, number("/sampler/length"), light);
            let s = driven.sample(source.next_uniform());
            vec![s, driven.pdf_distance(s)]
        }
        "henyey_greenstein" => scattered(case, &HenyeyGreenstein::new(parameter("g")).unwrap(), source),
        "isotropic" => scattered(case, &Isotropic, source),
        "rayleigh" => scattered(case, &Rayleigh, source),
        "schlick" => scattered(case, &Schlick::new(parameter("k")).unwrap(), source),
        "tabulated" => {
            let [cosines, values] = ["cosines", "values"].map(|key| numbers(&case["phase"][key]));
            scattered(case, &Tabulated::new(cosines, values).unwrap(), source)
        }
        "truncated_exponential" => {
            let [rate, length, beyond] =
                ["rate", "length", "beyond"].map(|key| number(&format!("/sampler/{key}")));
            let law = TruncatedExponential::new(rate, length);
            let distance = law.sample(source.next_uniform());
            vec![distance, law.pdf_distance(distance), law.probability_beyond(beyond)]
        }
        "mis_weight" => {
            let heuristic = heuristic(vector);
            let exponents = numbers(&case["exponents"]);
            let [p, q] = [0, 1].map(|i| 2.0_f64.powf(exponents[i]) * (1.0 + source.next_uniform()));
            vec![heuristic.mis_weight(p, q), heuristic.mis_weight(q, p)]
        }
        "path_weights" => strategies(case, heuristic(vector), source),
        "connection" => {
            let scale = 2.0_f64.powf(number("/connection/exponent"));
            let [x, y, z] = [(); 3].map(|()| scale * (source.next_uniform() + 0.25));
            let to = dvec3(x, y, z);
            let mut geometry = 1.0 / to.length_squared();
            if let Some(normal) = case["connection"].get("normal") {
                geometry *= DVec3::from_slice(&numbers(normal)).dot(to).abs() / to.length();
            }
            let bound = number("/connection/bound");
            vec![geometry, Term::Bounded(bound).of(geometry), Term::Excess(bound).of(geometry) / geometry]
        }
        kind => {
            let r = number("/ratio");
            let albedo = Albedo::new(number("/collision/albedo")).unwrap();
            let outcome = match kind {
                "double_particle" => {
                    let model = DoubleParticle { albedo };
                    return vec![model.scattered(r).energy, model.transmitted(r).energy];
                }
                "woodcock" => WoodcockCollision { albedo }.collide(r, source),
                _ => {
                    let version = version((vector.word)("/collision/version").unwrap());
                    SingleParticle { version, albedo }.collide(r, source)
                }
            };
            match outcome {
                Outcome::Scattered(energy) => vec![energy, 0.0],
                Outcome::Transmitted(energy) => vec![0.0, energy],
                Outcome::Absorbed => vec![0.0, 0.0],
            }
        }
    }
}

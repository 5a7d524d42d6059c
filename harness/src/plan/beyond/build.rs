//! From a spec to an estimator behind a pointer.

use super::erased::{ByCells, ByLookups, ByMajorant, Erased};
use super::exact::Exact;
use super::learning::{PILOTS, TUNING, comb_variance, experience};
use super::progressive::Progressive;
use super::range::Bounds;
use super::{Beyond, Facts, cells};
use crate::Failure;
use crate::plan::AnyProfile;
use crate::spec::{BeyondSpec, BoundsSpec, CombKind, NextFlightKind, PSeriesKind, RouletteSpec, TeethSpec};
use fairflight_media::{Bounded, BoundedInCells, Vacuum};
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, Choice, Comb, CombShape, Experience, GeneralisedPoisson, Hybrid, Jackknife,
    JitteredRatio, JitteredRatioInCells, NextFlight, NextFlightVersion, PSeries, PSeriesVersion, Pilot,
    ProgressiveMajorant, RayMarching, ResidualCells, Roulette, Telescoping, UnbiasedRayMarching,
    Unidirectional, teeth_for,
};
use std::sync::{Arc, Mutex};

/// Where the closed form comes from, in words.
const QUADRATURE: &str = "variance: closed form, integrated over the ray";
const COMBS: &str = "variance: closed form in the moments of a comb, integrated over its offset";
const VOLTERRA: &str = "variance: by an integral equation along the ray";
const BOUNDED: &str = "variance: no closed form, but an upper bound";
const UNKNOWN: &str = "variance: no closed form";

/// A power series is drawn to orders about its pivot or rate, which are counted in 32 bits.
const MOST_ORDERS: f64 = 1e9;

/// A pivot, or a rate, up to which orders can be counted.
fn countable(order: f64, key: &str) -> Result<f64, Failure> {
    if order.abs() > MOST_ORDERS {
        return Err(refuse(key, &format!("must be at most {MOST_ORDERS:e}, found {order}")));
    }
    Ok(order)
}

fn refuse(key: &str, error: &dyn std::fmt::Display) -> Failure {
    Failure::refused(format!("{key}: {error}"))
}

/// What is known about the ray while an estimator is built.
#[derive(Clone, Copy)]
enum Ray<'a> {
    /// A profile.
    One(&'a AnyProfile),
    /// Any of a scene; what needs one is refused by the reader already.
    Any,
}

impl Beyond {
    /// The estimator of a spec on a profile.
    ///
    /// # Errors
    /// If a parameter is not lawful, or the profile lacks what the estimator needs to know.
    pub(in crate::plan) fn build(spec: &BeyondSpec, profile: &AnyProfile) -> Result<Self, Failure> {
        build(spec, Ray::One(profile), "estimator")
    }

    /// The estimator of a spec for all rays of a scene, its key as given there.
    ///
    /// # Errors
    /// If a parameter is not lawful, or depends on the ray.
    pub(in crate::plan) fn for_all_rays(spec: &BeyondSpec, key: &str) -> Result<Self, Failure> {
        match spec.needs_one_ray() {
            Some(reason) => Err(refuse(&format!("{key}.kind"), &reason)),
            None => build(spec, Ray::Any, key),
        }
    }

    /// The hybrid that chooses by `experience` for a ray of this length, with its usual budget.
    #[must_use]
    pub fn hybrid(experience: &Experience, length: f64, majorant: f64, budget: f64) -> Self {
        let hybrid = Hybrid::choose(experience, length, majorant * length, budget);
        let facts = Facts {
            chosen: Some(chosen(&hybrid)),
            costly: matches!(hybrid.choice(), Choice::Marching(marching) if marching.segments() > FEW_SEGMENTS),
            ..Facts::claiming("hybrid", majorant, "variance: that of what it chose")
        };
        Self::of(ByMajorant { estimator: hybrid, majorant }, facts)
    }

    fn of(estimator: impl Erased + 'static, facts: Facts) -> Self {
        Self { estimator: Arc::new(estimator), facts }
    }
}

impl Facts {
    fn new(kind: &'static str, variance: &'static str) -> Self {
        Self { kind, variance, ..Self::default() }
    }

    fn claiming(kind: &'static str, majorant: f64, variance: &'static str) -> Self {
        Self { majorant: Some(majorant), ..Self::new(kind, variance) }
    }

    fn within(self, minimum: f64, maximum: f64) -> Self {
        Self { range: Some((minimum, maximum)), ..self }
    }

    fn ranging(self, range: Option<(f64, f64)>) -> Self {
        Self { range, ..self }
    }
}

impl Ray<'_> {
    fn bounds(self) -> Bounds {
        match self {
            Self::One(profile) => Bounds::of(profile),
            Self::Any => Bounds::default(),
        }
    }

    fn length(self) -> f64 {
        match self {
            Self::One(profile) => profile.length(),
            Self::Any => f64::NAN,
        }
    }
}

fn build(spec: &BeyondSpec, ray: Ray<'_>, key: &str) -> Result<Beyond, Failure> {
    let at = |what: &str| format!("{key}.{what}");
    Ok(match spec {
        BeyondSpec::NextFlight { majorant, version } => {
            next_flight(*majorant, *version, ray, &at("majorant"))?
        }
        BeyondSpec::PSeries { version, pivot } => {
            let (version, variance) = match version {
                PSeriesKind::Cmf => (PSeriesVersion::Cmf, QUADRATURE),
                PSeriesKind::Cumulative => (PSeriesVersion::Cumulative, BOUNDED),
                PSeriesKind::Ratio => (PSeriesVersion::Ratio, QUADRATURE),
                PSeriesKind::NextFlight => (PSeriesVersion::NextFlight, QUADRATURE),
            };
            let pivot = match (pivot, ray) {
                (Some(pivot), _) => *pivot,
                (None, Ray::One(profile)) => depth(profile, "p_series needs a pivot; give `pivot`")?,
                (None, Ray::Any) => return Err(refuse(&at("pivot"), &"this key is missing")),
            };
            let pivot = countable(pivot, &at("pivot"))?;
            let estimator = PSeries::new(version, pivot).map_err(|error| refuse(&at("pivot"), &error))?;
            // Factors of t_c − S σ_t.
            let facts = Facts::new("p_series", variance)
                .ranging(ray.bounds().of_null_collisions(pivot / ray.length()));
            Beyond::of(ByLookups(estimator), facts)
        }
        BeyondSpec::GeneralisedPoisson { pivot, rate } => {
            let rate = countable(*rate, &at("rate"))?;
            let estimator = GeneralisedPoisson::new(*pivot, rate).map_err(|error| refuse(key, &error))?;
            Beyond::of(ByLookups(estimator), Facts::new("generalised_poisson", QUADRATURE))
        }
        BeyondSpec::UnbiasedRayMarching { teeth, comb, roulette, segments } => {
            marching((*teeth, *comb, *roulette, *segments), ray, key)?
        }
        BeyondSpec::Telescoping { teeth, level_ratio, endpoint_matching } => {
            let shape = if *endpoint_matching { CombShape::EndpointMatched } else { CombShape::Uniform };
            let estimator = Telescoping::new(*teeth, *level_ratio, shape)
                .map_err(|error| refuse(&at("level_ratio"), &error))?;
            let range = ray.bounds().of_telescoping(ray.length(), *teeth, *endpoint_matching);
            let facts = Facts::new("telescoping", COMBS).ranging(range);
            Beyond::of(ByLookups(estimator), facts)
        }
        BeyondSpec::JitteredRatio { bounds: BoundsSpec::Majorant(majorant), epsilon } => {
            checked(*majorant, &at("majorant"))?;
            let estimator = JitteredRatio::new(*epsilon).map_err(|error| refuse(&at("epsilon"), &error))?;
            let facts = Facts::claiming("jittered_ratio", *majorant, QUADRATURE).within(0.0, 1.0);
            Beyond::of(ByMajorant { estimator, majorant: *majorant }, facts)
        }
        BeyondSpec::JitteredRatio { bounds: BoundsSpec::Cells(cells), epsilon } => {
            let estimator =
                JitteredRatioInCells::new(*epsilon).map_err(|error| refuse(&at("epsilon"), &error))?;
            in_cells("jittered_ratio", estimator, cells, ray)?
        }
        BeyondSpec::ResidualCells { cells, rate } => {
            let estimator = ResidualCells::new(*rate).map_err(|error| refuse(&at("rate"), &error))?;
            let mut beyond = in_cells("residual_cells", estimator, cells, ray)?;
            if *rate < 1.0 {
                beyond.facts.range = None;
            }
            beyond
        }
        BeyondSpec::AdaptiveRatio { majorant, floor } => {
            checked(*majorant, &at("majorant"))?;
            let estimator = AdaptiveRatio::new(*floor).map_err(|error| refuse(&at("floor"), &error))?;
            let facts = Facts::claiming("adaptive_ratio", *majorant, VOLTERRA)
                .ranging(ray.bounds().of_null_collisions(*majorant));
            Beyond::of(ByMajorant { estimator, majorant: *majorant }, facts)
        }
        BeyondSpec::Regular => match ray {
            Ray::One(profile) => {
                let facts = Facts::new("regular", "variance: none").within(0.0, f64::INFINITY);
                Beyond::of(Exact::of(profile)?, facts)
            }
            Ray::Any => return Err(refuse(&at("kind"), &"regular is prepared by the scene")),
        },
        BeyondSpec::Hybrid { majorant } => hybrid(*majorant, ray, key)?,
        BeyondSpec::Jackknife { teeth } => {
            let estimator = Jackknife::new(comb(*teeth, CombShape::Uniform, &at("teeth"))?);
            Beyond::of(
                ByLookups(estimator),
                Facts::new("jackknife", "variance: quadrature over both offsets (a biased baseline)"),
            )
        }
        BeyondSpec::Naive { teeth } => {
            let estimator = RayMarching::new(*teeth, fairflight_transmittance::Offset::Jittered)
                .map_err(|error| refuse(&at("teeth"), &error))?;
            Beyond::of(
                ByLookups(estimator),
                Facts::new("naive", "variance: quadrature over the offset (a biased baseline)"),
            )
        }
        BeyondSpec::ProgressiveMajorant { start } => {
            let learner = ProgressiveMajorant::new(*start).map_err(|error| refuse(&at("start"), &error))?;
            let facts = Facts {
                sequential: true,
                range: ray.bounds().of_clamped_walk(),
                ..Facts::new("progressive_majorant", "variance: no closed form (biased as long as it learns)")
            };
            Beyond::of(Progressive(Mutex::new(learner)), facts)
        }
    })
}

/// A claim that `Bounded` takes.
fn checked(majorant: f64, key: &str) -> Result<f64, Failure> {
    Bounded::new(Vacuum::new(0.0), majorant).map(|_| majorant).map_err(|error| refuse(key, &error))
}

fn next_flight(majorant: f64, version: NextFlightKind, ray: Ray<'_>, key: &str) -> Result<Beyond, Failure> {
    checked(majorant, key)?;
    let range = ray.bounds().of_null_collisions(majorant);
    let facts = |variance| Facts::claiming("next_flight", majorant, variance).ranging(range);
    let known = |version| {
        let estimator = NextFlight::new(version);
        Beyond::of(ByMajorant { estimator, majorant }, facts(QUADRATURE))
    };
    Ok(match version {
        NextFlightKind::Delta => known(NextFlightVersion::Delta),
        NextFlightKind::Ratio => known(NextFlightVersion::Ratio),
        NextFlightKind::Unidirectional => {
            Beyond::of(ByMajorant { estimator: Unidirectional, majorant }, facts(QUADRATURE))
        }
        NextFlightKind::Bidirectional => {
            Beyond::of(ByMajorant { estimator: Bidirectional, majorant }, facts(UNKNOWN))
        }
    })
}

fn in_cells<E>(
    kind: &'static str,
    estimator: E,
    spec: &crate::spec::CellsSpec,
    ray: Ray<'_>,
) -> Result<Beyond, Failure>
where
    ByCells<E>: Erased + 'static,
{
    let Ray::One(profile) = ray else {
        return Err(refuse("cells", &"are given along one ray, but a scene has many"));
    };
    let cells = cells::cells(spec, profile)?;
    let mut from = 0.0;
    let mut minorant_thickness = 0.0;
    for cell in cells.bound_cells() {
        minorant_thickness += cell.minorant * (cell.to - from);
        from = cell.to;
    }
    let facts = Facts::new(kind, QUADRATURE).within(0.0, (-minorant_thickness).exp());
    Ok(Beyond::of(ByCells { estimator, cells }, facts))
}

fn comb(teeth: u32, shape: CombShape, key: &str) -> Result<Comb, Failure> {
    Comb::new(teeth, shape).map_err(|error| refuse(key, &error))
}

fn marching(
    (teeth, kind, roulette, segments): (TeethSpec, CombKind, RouletteSpec, u32),
    ray: Ray<'_>,
    key: &str,
) -> Result<Beyond, Failure> {
    let shape = match kind {
        CombKind::Uniform => CombShape::Uniform,
        CombKind::EndpointMatched => CombShape::EndpointMatched,
        CombKind::Bernoulli2 => CombShape::Bernoulli2,
        CombKind::Bernoulli3 => CombShape::Bernoulli3,
        CombKind::Periodised => CombShape::Periodised,
    };
    let teeth = match (teeth, ray) {
        (TeethSpec::Given(teeth), _) => teeth,
        (TeethSpec::Rule { pivot: Some(pivot) }, _) => teeth_for(pivot),
        (TeethSpec::Rule { pivot: None }, Ray::One(profile)) => teeth_for(depth(
            profile,
            "the rule for the teeth of unbiased_ray_marching needs an optical thickness; give `teeth` or `pivot`",
        )?),
        (TeethSpec::Rule { pivot: None }, Ray::Any) => {
            return Err(refuse(&format!("{key}.teeth"), &"this key is missing"));
        }
    };
    let comb = comb(teeth, shape, &format!("{key}.teeth"))?;
    let mut chosen = None;
    let roulette = match (roulette, ray) {
        (RouletteSpec::Stop(stop), _) => {
            Roulette::new(stop).map_err(|error| refuse(&format!("{key}.roulette"), &error))?
        }
        (RouletteSpec::SelfTuned, Ray::One(profile)) => {
            let k2 = comb_variance(profile, in_segments(comb, always_on()?, segments, key)?);
            let roulette = Roulette::tuned(k2);
            chosen = Some(format!(
                "roulette: P = {:.4} from k2 = {k2:.3e} per segment, found by {TUNING} earlier draws whose look-ups are not charged",
                roulette.going_on()
            ));
            roulette
        }
        (RouletteSpec::SelfTuned, Ray::Any) => {
            return Err(refuse(&format!("{key}.roulette"), &"self_tuned needs one ray"));
        }
    };
    let estimator = in_segments(comb, roulette, segments, key)?;
    Ok(Beyond::of(
        ByLookups(estimator),
        Facts { chosen, costly: segments > FEW_SEGMENTS, ..Facts::new("unbiased_ray_marching", COMBS) },
    ))
}

/// The roulette that never stops at once: each draw then shows a variance.
fn always_on() -> Result<Roulette, Failure> {
    Roulette::new(0.0).map_err(|error| refuse("estimator.roulette", &error))
}

fn in_segments(
    comb: Comb,
    roulette: Roulette,
    segments: u32,
    key: &str,
) -> Result<UnbiasedRayMarching, Failure> {
    UnbiasedRayMarching::new(comb, roulette)
        .in_segments(segments)
        .map_err(|error| refuse(&format!("{key}.segments"), &error))
}

/// More segments than this, and their closed form is costly.
const FEW_SEGMENTS: u32 = 8;

fn hybrid(majorant: Option<f64>, ray: Ray<'_>, key: &str) -> Result<Beyond, Failure> {
    let Ray::One(profile) = ray else {
        return Err(refuse(&format!("{key}.kind"), &"hybrid chooses for one ray, but a scene has many"));
    };
    let majorant = match majorant {
        Some(majorant) => checked(majorant, &format!("{key}.majorant"))?,
        None => declared(profile).ok_or_else(|| {
            Failure::refused(format!(
                "{key}: hybrid needs a majorant; give `majorant` or use unbiased_ray_marching with `teeth`, which needs none"
            ))
        })?,
    };
    let experience = experience(profile, majorant);
    let mut beyond = Beyond::hybrid(&experience, profile.length(), majorant, Hybrid::USUAL_BUDGET);
    if let Some(chosen) = &mut beyond.facts.chosen {
        let lookups = u64::from(PILOTS) * Pilot::lookups(majorant * profile.length());
        chosen
            .push_str(&format!(", by {PILOTS} pilots of {lookups} look-ups together, which are not charged"));
    }
    Ok(beyond)
}

/// What a hybrid chose, in words.
fn chosen(hybrid: &Hybrid) -> String {
    match hybrid.choice() {
        Choice::Marching(marching) => {
            let matched =
                if marching.comb().shape() == CombShape::EndpointMatched { ", ends matched" } else { "" };
            format!(
                "chosen: unbiased ray marching, {} segment(s) of {} teeth{matched}, P = {:.4}",
                marching.segments(),
                marching.comb().teeth(),
                marching.roulette().going_on()
            )
        }
        Choice::Jittered(jittered) => {
            format!("chosen: jittered ratio tracking, epsilon = {}", jittered.epsilon())
        }
    }
}

/// The optical thickness of the majorant that a profile declares.
fn depth(profile: &AnyProfile, needs: &str) -> Result<f64, Failure> {
    declared(profile).map(|majorant| majorant * profile.length()).ok_or_else(|| {
        Failure::refused(format!("estimator: {needs}, or declare the `majorant` of the profile"))
    })
}

fn declared(profile: &AnyProfile) -> Option<f64> {
    Bounds::of(profile).most.map(|bound| bound.max(0.0))
}

//! An estimator as the JSON that reads back as it: what advice is made of.

use super::{
    BeyondSpec, BoundsSpec, CellsSpec, CombKind, ControlSpec, EstimatorSpec, NextFlightKind, PSeriesKind,
    RouletteSpec, SamplingSpec, TeethSpec,
};
use fairflight_collision::Version;
use fairflight_transmittance::Offset;
use serde_json::{Map, Value, json};

/// An object without the keys whose value is null.
fn object(entries: Value) -> Value {
    match entries {
        Value::Object(map) => {
            Value::Object(map.into_iter().filter(|(_, value)| !value.is_null()).collect::<Map<_, _>>())
        }
        other => other,
    }
}

impl EstimatorSpec {
    /// The JSON of which [`EstimatorSpec::read`] makes this spec.
    #[must_use]
    pub fn written(&self) -> Value {
        object(match self {
            Self::Woodcock { majorant } => json!({ "kind": "woodcock", "majorant": majorant }),
            Self::DoubleParticle { sampling, control } => {
                json!({ "kind": "double_particle", "sigma_samp": sampling.written(), "control": control.written() })
            }
            Self::SingleParticle { version, albedo, sampling, control } => json!({
                "kind": "single_particle",
                "version": match version {
                    Version::Terminating => "terminating",
                    Version::NonTerminating => "non_terminating",
                    Version::Adaptive => "adaptive",
                },
                "albedo": albedo.get(),
                "sigma_samp": sampling.written(),
                "control": control.written(),
            }),
            Self::LineIntegral { majorant, splits } => {
                json!({ "kind": "line_integral", "majorant": majorant, "splits": splits })
            }
            Self::RayMarching { steps, offset } => {
                json!({ "kind": "ray_marching", "steps": steps, "jitter": *offset == Offset::Jittered })
            }
            Self::Beyond(beyond) => beyond.written(),
        })
    }
}

impl SamplingSpec {
    fn written(&self) -> Value {
        match self {
            Self::Constant(value) => json!(value),
            Self::PiecewiseConstant { edges, values } => json!({ "edges": edges, "values": values }),
        }
    }
}

impl ControlSpec {
    fn written(&self) -> Value {
        match self {
            Self::None => Value::Null,
            Self::Constant(sigma_main) => json!({ "kind": "constant", "sigma_main": sigma_main }),
            Self::PiecewiseLinear { positions, sigma_main } => {
                json!({ "kind": "piecewise_linear", "positions": positions, "sigma_main": sigma_main })
            }
            Self::Explorers { count } => json!({ "kind": "explorers", "count": count }),
        }
    }
}

impl CellsSpec {
    fn written(&self) -> Value {
        match self {
            Self::Count(count) => json!(count),
            Self::Given { edges, minorants, majorants } => {
                json!({ "edges": edges, "minorants": minorants, "majorants": majorants })
            }
        }
    }
}

impl BeyondSpec {
    fn written(&self) -> Value {
        match self {
            Self::NextFlight { majorant, version } => json!({
                "kind": "next_flight",
                "majorant": majorant,
                "version": match version {
                    NextFlightKind::Delta => "delta",
                    NextFlightKind::Ratio => "ratio",
                    NextFlightKind::Unidirectional => "unidirectional",
                    NextFlightKind::Bidirectional => "bidirectional",
                },
            }),
            Self::PSeries { version, pivot } => json!({
                "kind": "p_series",
                "version": match version {
                    PSeriesKind::Cmf => "cmf",
                    PSeriesKind::Cumulative => "cumulative",
                    PSeriesKind::Ratio => "ratio",
                    PSeriesKind::NextFlight => "next_flight",
                },
                "pivot": pivot,
            }),
            Self::GeneralisedPoisson { pivot, rate } => {
                json!({ "kind": "generalised_poisson", "pivot": pivot, "rate": rate })
            }
            Self::UnbiasedRayMarching { teeth, comb, roulette, segments } => {
                let (teeth, pivot) = match teeth {
                    TeethSpec::Given(teeth) => (Some(teeth), None),
                    TeethSpec::Rule { pivot } => (None, *pivot),
                };
                let (comb, matching, order) = match comb {
                    CombKind::Uniform => ("uniform", Some(false), None),
                    CombKind::EndpointMatched => ("uniform", Some(true), None),
                    CombKind::Bernoulli2 => ("bernoulli", None, Some(2)),
                    CombKind::Bernoulli3 => ("bernoulli", None, Some(3)),
                    CombKind::Periodised => ("periodised", None, None),
                };
                let roulette = match roulette {
                    RouletteSpec::Stop(stop) => json!(stop),
                    RouletteSpec::SelfTuned => json!("self_tuned"),
                };
                json!({
                    "kind": "unbiased_ray_marching", "teeth": teeth, "pivot": pivot, "comb": comb,
                    "endpoint_matching": matching, "order": order, "roulette": roulette, "segments": segments,
                })
            }
            Self::Telescoping { teeth, level_ratio, endpoint_matching } => json!({
                "kind": "telescoping", "teeth": teeth, "level_ratio": level_ratio,
                "endpoint_matching": endpoint_matching,
            }),
            Self::JitteredRatio { bounds, epsilon } => match bounds {
                BoundsSpec::Majorant(majorant) => {
                    json!({ "kind": "jittered_ratio", "majorant": majorant, "epsilon": epsilon })
                }
                BoundsSpec::Cells(cells) => {
                    json!({ "kind": "jittered_ratio", "cells": cells.written(), "epsilon": epsilon })
                }
            },
            Self::ResidualCells { cells, rate } => {
                json!({ "kind": "residual_cells", "cells": cells.written(), "rate": rate })
            }
            Self::AdaptiveRatio { majorant, floor } => {
                json!({ "kind": "adaptive_ratio", "majorant": majorant, "floor": floor })
            }
            Self::Regular => json!({ "kind": "regular" }),
            Self::Hybrid { majorant } => json!({ "kind": "hybrid", "majorant": majorant }),
            Self::Jackknife { teeth } => json!({ "kind": "jackknife", "teeth": teeth }),
            Self::Naive { teeth } => json!({ "kind": "naive", "teeth": teeth }),
            Self::ProgressiveMajorant { start } => json!({ "kind": "progressive_majorant", "start": start }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Node;

    #[test]
    fn what_is_written_reads_back() {
        let comb = |extra: Value| {
            let mut spec = json!({ "kind": "unbiased_ray_marching" });
            let map = spec.as_object_mut().unwrap();
            map.extend(extra.as_object().unwrap().clone());
            spec
        };
        let specs = [
            json!({ "kind": "woodcock", "majorant": 2.0 }),
            json!({ "kind": "double_particle", "sigma_samp": 0.5, "control": { "kind": "constant", "sigma_main": 0.2 } }),
            json!({ "kind": "double_particle", "sigma_samp": { "edges": [0.0, 1.0], "values": [2.0] } }),
            json!({ "kind": "single_particle", "version": "adaptive", "albedo": 0.5, "sigma_samp": 1.0 }),
            json!({ "kind": "line_integral", "majorant": 2.0, "splits": 4 }),
            json!({ "kind": "ray_marching", "steps": 8, "jitter": true }),
            json!({ "kind": "next_flight", "majorant": 2.0, "version": "bidirectional" }),
            json!({ "kind": "p_series", "version": "cmf" }),
            json!({ "kind": "p_series", "version": "next_flight", "pivot": 3.0 }),
            json!({ "kind": "generalised_poisson", "pivot": 3.0, "rate": 0.5 }),
            comb(json!({})),
            comb(json!({ "pivot": 4.0, "roulette": "self_tuned" })),
            comb(json!({ "teeth": 5, "endpoint_matching": false, "segments": 3 })),
            comb(json!({ "teeth": 5, "comb": "bernoulli", "order": 3, "roulette": 0.5 })),
            comb(json!({ "comb": "periodised" })),
            json!({ "kind": "telescoping", "teeth": 5, "level_ratio": 0.8 }),
            json!({ "kind": "jittered_ratio", "majorant": 1.0, "epsilon": 0.5 }),
            json!({ "kind": "jittered_ratio", "cells": 20, "epsilon": 0.5 }),
            json!({ "kind": "residual_cells", "rate": 2.0,
                "cells": { "edges": [0.0, 1.0], "minorants": [0.0], "majorants": [1.0] } }),
            json!({ "kind": "adaptive_ratio", "majorant": 1.0, "floor": 0.1 }),
            json!({ "kind": "regular" }),
            json!({ "kind": "hybrid" }),
            json!({ "kind": "jackknife", "teeth": 8 }),
            json!({ "kind": "naive", "teeth": 8 }),
            json!({ "kind": "progressive_majorant", "start": 0.1 }),
        ];
        for json in specs {
            let spec = EstimatorSpec::read(&Node::root(&json)).unwrap();
            let written = spec.written();
            assert_eq!(EstimatorSpec::read(&Node::root(&written)).unwrap(), spec, "{json} became {written}");
        }
    }
}

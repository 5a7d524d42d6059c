//! Kinds of estimators and what a scene says to each: most agree with regular tracking, others are refused for a reason.

use self::Decision::{Agrees, Refused};
use serde_json::{Value, json};

/// The fate of an estimator in a scene.
#[derive(Clone, Debug)]
pub(super) enum Decision {
    /// The picture of regular tracking.
    Agrees,
    /// A refusal of a key, with its reason.
    Refused(&'static str, &'static str),
}

const OF_ONE_RAY: &str = "is given along one ray, but a scene has many: a number is allowed";
const CONTROL_OF_ONE_RAY: &str =
    "is given along one ray, but a scene has many: none, constant and explorers are allowed";
const CELLS_OF_ONE_RAY: &str = "are given along one ray, but a scene has many: a number of boxes is allowed";

/// Every kind, in all ways in which scenes tell them apart.
pub(super) fn decisions() -> Vec<(Value, Decision)> {
    let edges = json!({ "edges": [0, 1, 9], "minorants": [0, 0], "majorants": [1, 1] });
    vec![
        (json!({ "kind": "woodcock", "majorant": 1 }), Agrees),
        (json!({ "kind": "double_particle", "sigma_samp": 1 }), Agrees),
        (
            json!({ "kind": "double_particle", "sigma_samp": 0.5, "control": { "kind": "constant", "sigma_main": 0.2 } }),
            Agrees,
        ),
        (
            json!({ "kind": "double_particle", "sigma_samp": 0.5, "control": { "kind": "explorers", "count": 4 } }),
            Agrees,
        ),
        (
            json!({ "kind": "double_particle", "sigma_samp": { "edges": [0, 9], "values": [1] } }),
            Refused("sigma_samp", OF_ONE_RAY),
        ),
        (
            json!({ "kind": "double_particle", "sigma_samp": 1,
                "control": { "kind": "piecewise_linear", "positions": [0, 9], "sigma_main": [0.1, 0.1] } }),
            Refused("control.kind", CONTROL_OF_ONE_RAY),
        ),
        (
            json!({ "kind": "single_particle", "version": "adaptive", "albedo": 0.7, "sigma_samp": 0.8 }),
            Agrees,
        ),
        (
            json!({ "kind": "single_particle", "version": "adaptive", "albedo": 0.7, "sigma_samp": { "edges": [0, 9], "values": [1] } }),
            Refused("sigma_samp", OF_ONE_RAY),
        ),
        (json!({ "kind": "line_integral", "majorant": 1, "splits": 4 }), Agrees),
        (json!({ "kind": "ray_marching", "steps": 64, "jitter": true }), Agrees),
        (json!({ "kind": "next_flight", "majorant": 1, "version": "delta" }), Agrees),
        (json!({ "kind": "next_flight", "majorant": 1, "version": "ratio" }), Agrees),
        (json!({ "kind": "next_flight", "majorant": 1, "version": "unidirectional" }), Agrees),
        (json!({ "kind": "next_flight", "majorant": 1, "version": "bidirectional" }), Agrees),
        (json!({ "kind": "p_series", "version": "cmf" }), Agrees),
        (json!({ "kind": "p_series", "version": "cumulative" }), Agrees),
        (json!({ "kind": "p_series", "version": "ratio" }), Agrees),
        (json!({ "kind": "p_series", "version": "next_flight" }), Agrees),
        (json!({ "kind": "p_series", "version": "cmf", "pivot": 1 }), Agrees),
        (json!({ "kind": "generalised_poisson", "pivot": 1, "rate": 2 }), Agrees),
        (json!({ "kind": "unbiased_ray_marching" }), Agrees),
        (json!({ "kind": "unbiased_ray_marching", "pivot": 2, "endpoint_matching": false }), Agrees),
        (json!({ "kind": "unbiased_ray_marching", "teeth": 3, "segments": 2 }), Agrees),
        (json!({ "kind": "unbiased_ray_marching", "teeth": 2, "roulette": "self_tuned" }), Agrees),
        (json!({ "kind": "unbiased_ray_marching", "comb": "periodised", "roulette": "self_tuned" }), Agrees),
        (json!({ "kind": "telescoping", "teeth": 4, "level_ratio": 0.7 }), Agrees),
        (json!({ "kind": "jittered_ratio", "epsilon": 0.5 }), Agrees),
        (json!({ "kind": "jittered_ratio", "majorant": 1, "epsilon": 0.5 }), Agrees),
        (json!({ "kind": "jittered_ratio", "cells": 8, "epsilon": 0.5 }), Agrees),
        (
            json!({ "kind": "jittered_ratio", "cells": edges, "epsilon": 0.5 }),
            Refused("cells", CELLS_OF_ONE_RAY),
        ),
        (json!({ "kind": "residual_cells", "cells": 8 }), Agrees),
        (json!({ "kind": "residual_cells", "cells": 30, "rate": 2 }), Agrees),
        (json!({ "kind": "residual_cells", "cells": edges }), Refused("cells", CELLS_OF_ONE_RAY)),
        (json!({ "kind": "adaptive_ratio", "majorant": 1, "floor": 0.2 }), Agrees),
        (json!({ "kind": "regular" }), Agrees),
        (json!({ "kind": "hybrid" }), Agrees),
        (json!({ "kind": "hybrid", "majorant": 1 }), Agrees),
        (json!({ "kind": "jackknife", "teeth": 8 }), Agrees),
        (json!({ "kind": "naive", "teeth": 64 }), Agrees),
        (
            json!({ "kind": "progressive_majorant", "start": 0.1 }),
            Refused("kind", "progressive_majorant learns along one ray, but a scene has many"),
        ),
    ]
}

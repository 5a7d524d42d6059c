//! Speed against error: all integrators of multiple scattering on one scene.

use super::scenes;
use crate::run::Run;
use crate::speed_against_error::{Speed, compare};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Rays per pixel of the points of a curve.
const RAYS: [u32; 4] = [2, 8, 32, 128];

/// An integrator with its name.
fn integrators() -> Vec<(&'static str, Value)> {
    let tracer = |version: &str, sigma_samp: Value| json!({ "kind": "particle_tracer", "version": version, "sigma_samp": sigma_samp });
    let splitting = |starts: &str| {
        json!({ "kind": "line_splitting", "splits": 4, "majorant": 1.0, "starts": starts,
                                           "version": "adaptive", "sigma_samp": 1.0 })
    };
    vec![
        ("adaptive, σ_samp 0.8", tracer("adaptive", json!(0.8))),
        ("adaptive, σ_samp 1", tracer("adaptive", json!(1.0))),
        ("non-terminating, σ_samp 2", tracer("non_terminating", json!(2.0))),
        ("terminating, σ_samp 1", tracer("terminating", json!(1.0))),
        (
            "adaptive, grid",
            tracer("adaptive", json!({ "cells": [40, 40, 40], "factor": 1.0, "floor": 0.05 })),
        ),
        ("splitting 4, equidistant", splitting("equidistant")),
        ("splitting 4, independent", splitting("independent")),
    ]
}

pub(super) fn steps() -> u64 {
    (integrators().len() * RAYS.len()) as u64
}

pub(super) fn study(run: &Run<'_>) -> Result<Speed, Failure> {
    let subject = scenes::evenly_lit(run.resolution());
    let text = "The scene of fig. 6 in an even environment, by every integrator of multiple scattering. Seconds are CPU seconds over all \
                threads, look-ups counted; the figures of the table are those of the largest number of rays.";
    compare(run, &subject, integrators(), &RAYS, text)
}

//! The naive estimator: ray marching with a random offset, whose law is checked as [`super::ray_marching::jittered`].

use super::Kind;
use super::on_profile::estimator;
use crate::checks::LAWFUL;
use crate::hard_cases::Subject;
use fairflight_transmittance::{Offset, RayMarching};

pub(super) const KIND: Kind = Kind { name: "naive", checks: Vec::new, twins: Vec::new, subjects, spared: &[] };

fn subjects() -> Vec<Subject> {
    vec![estimator!("naive", above: true, below: true, |_| RayMarching::new(7, Offset::Jittered).expect(LAWFUL))]
}

//! Virtual point lights: compensation against quadrature and in rooms, energy, furnaces and lamps of the path tracer, bounds.

mod bounds;
mod ledger;
mod local;
mod rooms;
mod tracer;

use super::paths::{LAWFUL, result};
use super::{Check, Law};
use crate::function::joined;
use fairflight_compensation::Strategy;

/// All strategies by the names of engelhardt-2013.
const STRATEGIES: [(Strategy, &str); 3] =
    [(Strategy::OneToMany, "1-to-N"), (Strategy::ManyToOne, "N-to-1"), (Strategy::OneToOne, "1-to-1")];

/// All checks of virtual point lights and of paths among surfaces.
pub(super) fn checks() -> Vec<Check> {
    let lights = joined!(checks of local, rooms, ledger);
    let of_lights = |check: Check| check.about(["vpl"]);
    let mut checks: Vec<Check> = lights.into_iter().map(of_lights).collect();
    checks.extend(tracer::checks());
    checks.extend(bounds::checks().into_iter().map(of_lights));
    checks
}

//! Balance of the power of light paths.

use fairflight_laws::{NotFinite, Run, measure};
use fairflight_paths::Walk;
use fairflight_paths::transport::{Types, World};
use fairflight_stats::{Reference, Verdict, judge};
use fairflight_vpl::{Emitters, KeepNear, Ledger, LightPaths, Vpl};
use glam::DVec3;

/// **Law.** E\[absorbed + escaped\] of one light path that carries all power is that power, for an albedo that is not 0.
///
/// # Errors
/// If an estimate is no number.
pub fn check<W: Types<Spectrum = f64>>(
    world: World<'_, W>,
    walk: Walk<W::Sampling>,
    power: f64,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let emitters = Emitters::new(world.lights, world.surfaces, world.enclosing_ball(), DVec3::ZERO);
    let paths = LightPaths::new(world, &emitters, walk);
    let measured = measure(run.seed, run.samples, |source| {
        let mut ledger = Ledger::empty();
        paths.trace(1.0, &mut ledger, source, |_| {});
        ledger.absorbed + ledger.escaped
    })?;
    Ok(judge(&measured, &Reference::exact(power).with_mild_tails(), run.alpha))
}

/// **Law.** The sum of power · g(x) over the virtual point lights of a path is `expected`, whether those far away are thinned or not.
///
/// # Errors
/// If an estimate is no number.
pub fn check_scattered<W: Types<Spectrum = f64>>(
    world: World<'_, W>,
    (walk, keep_near): (Walk<W::Sampling>, Option<KeepNear>),
    (g, expected): (impl Fn(&Vpl<f64>) -> f64, f64),
    run: Run,
) -> Result<Verdict, NotFinite> {
    let emitters = Emitters::new(world.lights, world.surfaces, world.enclosing_ball(), DVec3::ZERO);
    let paths = LightPaths::new(world, &emitters, walk).keeping_near(keep_near);
    let measured = measure(run.seed, run.samples, |source| {
        let mut sum = 0.0;
        paths.trace(1.0, &mut Ledger::empty(), source, |vpl| sum += vpl.power * g(&vpl));
        sum
    })?;
    Ok(judge(&measured, &Reference::exact(expected).with_mild_tails(), run.alpha))
}

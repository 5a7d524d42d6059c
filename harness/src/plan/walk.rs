//! Walks through a medium, with their sampling extinction in space.

use crate::Failure;
use crate::field::AnyMedium;
use crate::spec::{SamplingFieldSpec, WalkSpec};
use fairflight_collision::{Albedo, CollisionModel, SingleParticle, Version};
use fairflight_elementary::lanes::Lanes;
use fairflight_media::{Bounds, Line, Medium, PhaseFunction};
use fairflight_paths::{
    Criticality, Grid, SamplingExtinction, Uniform, Walk, grows_nowhere, second_moment_growth,
};
use fairflight_scene::{Spectrum, Volume};
use fairflight_sources::{Seeded, derive_seed};

/// Walks whose parameters are checked.
#[derive(Clone, Debug)]
pub struct WalkPlan {
    version: Version,
    sampling: Field,
    max_collisions: u64,
    allow_supercritical: bool,
}

#[derive(Clone, Debug)]
enum Field {
    Uniform(Uniform),
    Grid(Box<Grid>),
}

/// A sampling extinction in space of any kind.
#[derive(Clone, Copy, Debug)]
pub enum SpaceSampling<'a> {
    /// The same everywhere.
    Uniform(Uniform),
    /// One value per cell.
    Grid(&'a Grid),
}

/// Look-ups along each edge of a cell to choose its value.
const PROBES: u32 = 3;

/// The stream of the check for a second moment: no pixel has this number.
const GROWTH_STREAM: u64 = u64::MAX;

impl WalkPlan {
    /// The walks of a spec; a grid is fitted to the medium.
    ///
    /// # Errors
    /// If a parameter is not lawful.
    pub(super) fn build(spec: &WalkSpec, medium: &AnyMedium, bounds: &Bounds) -> Result<Self, Failure> {
        let refuse =
            |error: &dyn std::fmt::Display| Failure::refused(format!("integrator.sigma_samp: {error}"));
        let sampling = match spec.sigma_samp {
            SamplingFieldSpec::FromMedium => {
                let greatest = medium.greatest_extinction("integrator.sigma_samp")?;
                Field::Uniform(Uniform::new(greatest).map_err(|error| refuse(&error))?)
            }
            SamplingFieldSpec::Uniform(value) => {
                Field::Uniform(Uniform::new(value).map_err(|error| refuse(&error))?)
            }
            SamplingFieldSpec::Grid { cells, factor, floor } => {
                let cells = cells.map(|count| count as usize);
                let grid = Grid::fitted(medium, bounds, cells, (PROBES, factor, floor));
                Field::Grid(Box::new(grid.map_err(|error| refuse(&error))?))
            }
        };
        let WalkSpec { version, max_collisions, allow_supercritical, .. } = *spec;
        Ok(Self { version, sampling, max_collisions, allow_supercritical })
    }

    /// The walk of one worker.
    #[must_use]
    pub fn walk(&self) -> Walk<SpaceSampling<'_>> {
        let sampling = match &self.sampling {
            Field::Uniform(uniform) => SpaceSampling::Uniform(*uniform),
            Field::Grid(grid) => SpaceSampling::Grid(grid),
        };
        Walk::new(self.version, sampling).with_max_collisions(self.max_collisions)
    }

    /// Checks that the walks are defined where σ_t lies in this range.
    pub(super) fn admits(&self, (lowest, highest): (f64, f64), albedo: f64) -> Result<(), Failure> {
        let model = SingleParticle {
            version: self.version,
            albedo: Albedo::new(albedo.min(1.0)).map_err(Failure::refused)?,
        };
        let walk = self.walk();
        // The least rate gives the greatest ratio. For a uniform one that is what happened, for a grid it may be on the safe side.
        let rate = walk.sampling().lowest();
        for sigma_t in [lowest, highest] {
            let r = sigma_t / rate;
            if !model.admits(r) {
                return Err(Failure::refused(format!(
                    "integrator.version: terminating needs 0 <= r <= 2/(1 + albedo), but r = sigma_t/sigma_samp is up to \
                     {r} where sigma_t = {sigma_t}"
                )));
            }
        }
        Ok(())
    }

    /// Checks that the walks have a second moment in a volume; a warning where that is not known.
    ///
    /// # Errors
    /// If they have none, and the spec does not allow that.
    pub fn check_growth<M: Medium, P: PhaseFunction, C: Spectrum>(
        &self,
        volume: &Volume<M, P, C>,
        seed: u64,
    ) -> Result<Option<String>, Failure> {
        if grows_nowhere(volume, &self.walk()) {
            return Ok(None);
        }
        let mut source = Seeded::new(derive_seed(seed, GROWTH_STREAM));
        let Some(growth) = second_moment_growth(volume, &self.walk(), &mut source) else { return Ok(None) };
        let measured = format!(
            "the expected squared energy of walks grows by {:.3} +- {:.3} per collision",
            growth.factor, growth.standard_error
        );
        match growth.criticality() {
            Criticality::Subcritical => Ok(None),
            Criticality::Unclear => {
                Ok(Some(format!("{measured}: they may have no second moment, and errors may be underrated")))
            }
            Criticality::Supercritical if self.allow_supercritical => {
                Ok(Some(format!("{measured}: no second moment exists, errors mean nothing")))
            }
            Criticality::Supercritical => Err(Failure::refused(format!(
                "integrator.sigma_samp: {measured}, so that no second moment exists; allowed are a higher sigma_samp, or \
                 allow_supercritical: true"
            ))),
        }
    }
}

impl SamplingExtinction for SpaceSampling<'_> {
    #[inline]
    fn fly(&self, line: &Line, from: f64, length: f64, depth: f64) -> Option<(f64, f64)> {
        match self {
            Self::Uniform(uniform) => uniform.fly(line, from, length, depth),
            Self::Grid(grid) => grid.fly(line, from, length, depth),
        }
    }
    #[inline(always)]
    fn fly_lanes(&self, line: impl Fn(usize) -> Line, distances: [&Lanes; 3]) -> [Lanes; 2] {
        match self {
            Self::Uniform(uniform) => uniform.fly_lanes(line, distances),
            Self::Grid(grid) => grid.fly_lanes(line, distances),
        }
    }
    fn highest(&self) -> f64 {
        match self {
            Self::Uniform(uniform) => uniform.highest(),
            Self::Grid(grid) => grid.highest(),
        }
    }
    fn lowest(&self) -> f64 {
        match self {
            Self::Uniform(uniform) => uniform.lowest(),
            Self::Grid(grid) => grid.lowest(),
        }
    }
}

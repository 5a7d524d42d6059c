//! Paths among surfaces: how they travel, connect and scatter.

use super::walk::{Collisions, ColourWord, SamplingFieldSpec, WalkSpec};
use crate::estimator::{EstimatorSpec, ForAllRays, VersionWord};
use crate::reader::Object;
use crate::reader::Rule;
use crate::reader::kind::{Among, Key, Keys};
use crate::reader::rule::{Flag, Maybe, Own, Whole};
use crate::{Failure, keys, words};
use fairflight_collision::Version;
use fairflight_paths::Heuristic;
use serde_json::{Map, Value};

words! {
    /// The heuristic that weighs next-event estimation against scattering.
    pub(super) HeuristicWord for Heuristic {
        "balance" => Heuristic::Balance,
        "power" => Heuristic::Power,
        "maximum" => Heuristic::Maximum,
    }
}

keys! {
    /// The flights, connections and weights of paths among surfaces.
    pub TransportSpec {
        /// The walks of paths through the medium.
        walk: WalkSpec as WithDefaults,
        /// Transmittance of connections; by default in closed form in a homogeneous medium, else ratio tracking.
        estimator: Option<EstimatorSpec> as Maybe<ForAllRays> = None,
        /// The heuristic that weighs next-event estimation against scattering.
        heuristic: Heuristic as HeuristicWord = Heuristic::Balance,
    }
}

impl TransportSpec {
    /// True if the transmittance of connections is that of a biased baseline.
    #[must_use]
    pub fn is_biased_baseline(&self) -> bool {
        self.estimator.as_ref().is_some_and(EstimatorSpec::is_biased_baseline)
    }
}

keys! {
    /// A walk whose version and sampling extinction may be left out.
    pub(super) UsualWalk {
        /// The rule of the probabilities of a collision.
        version: Version as VersionWord = Version::NonTerminating,
        /// The sampling extinction \[1/length\], as of other walks; the greatest extinction of the medium by default.
        sigma_samp: SamplingFieldSpec as Own = SamplingFieldSpec::FromMedium,
        /// One walk for all channels of a colour, or one for each.
        colour: Collisions as ColourWord = Collisions::Shared,
        /// More collisions of one particle are cut off, a bias; none are by default.
        max_collisions: u64 as Whole<1, { u64::MAX }> = u64::MAX,
        /// True to run a walk that has no second moment.
        allow_supercritical: bool as Flag = false,
    }
}

/// The keys of a walk, of which some may be left out.
#[derive(Debug)]
pub(super) struct WithDefaults;

impl Rule<WalkSpec> for WithDefaults {
    fn read(node: &crate::reader::Node<'_>) -> Result<WalkSpec, Failure> {
        <Among as Rule<UsualWalk>>::read(node).map(WalkSpec::from)
    }
    fn written(walk: &WalkSpec) -> Value {
        <Among as Rule<WalkSpec>>::written(walk)
    }
    fn schema() -> Value {
        <Among as Rule<UsualWalk>>::schema()
    }
    fn take(
        object: &Object<'_>,
        _name: &'static str,
        _default: Option<fn() -> WalkSpec>,
    ) -> Result<WalkSpec, Failure> {
        UsualWalk::take_from(object).map(WalkSpec::from)
    }
    fn put(walk: &WalkSpec, _name: &'static str, object: &mut Map<String, Value>) {
        walk.write_to(object);
    }
    fn keys(_name: &'static str, _about: &'static str, _optional: bool) -> Vec<Key> {
        UsualWalk::keys()
    }
}

impl From<UsualWalk> for WalkSpec {
    fn from(walk: UsualWalk) -> Self {
        let UsualWalk { version, sigma_samp, colour, max_collisions, allow_supercritical } = walk;
        Self { version, sigma_samp, colour, max_collisions, allow_supercritical }
    }
}

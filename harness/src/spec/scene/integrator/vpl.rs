//! Virtual point lights.

use super::IntegratorKind;
use super::path_tracer::MOST_VERTICES;
use super::transport::TransportSpec;
use crate::reader::kind::Among;
use crate::reader::rule::{Maybe, Nullable, Own, Positive, Rule, Ruled, Whole};
use crate::reader::{Node, Object};
use crate::{Failure, keys, kind, words};
use fairflight_compensation::{CompensationOptions, Placement, Strategy, TransmittanceUse, Visibility};
use serde_json::{Value, json};

kind! {
    /// Virtual point lights with bias compensation (raab-2008 section 4.2, engelhardt-2013), among surfaces.
    VplSpec = "vpl" {
        /// The bound b of the geometric term \[1/length²\]: a number, null (unclamped), or "scene" (raab-2008 section 4.2).
        clamp: ClampSpec as Own,
        /// The compensation of bounding; null for none.
        compensation: Option<CompensationOptions> as CompensationRule = None,
        /// The part of the light that is rendered.
        component: ComponentSpec as ComponentWord = ComponentSpec::All,
        /// The flights, connections and weights of light paths and eye rays.
        transport: TransportSpec as Among,
        /// Light paths per set.
        light_paths: u32 as Whole<1, MOST_LIGHT_PATHS>,
        /// Points along an eye ray.
        eye_samples: u32 as Whole<1, MOST_LIGHT_PATHS> = 1,
        /// Cells along each axis of the local means of the extinction.
        local_mean_cells: u32 as Whole<1, MOST_CELLS> = 16,
        /// The distance from the camera within which all virtual point lights are kept; beyond, roulette keeps (distance/r)² of them \[length\].
        keep_near: Option<f64> as Maybe<Positive> = None,
    }
    check VplSpec::check
}

/// More light paths or points per ray are a slip of the keyboard.
pub(super) const MOST_LIGHT_PATHS: u64 = 10_000_000;
/// More cells take long to fill.
const MOST_CELLS: u64 = 256;

/// A part of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComponentSpec {
    /// The whole light.
    #[default]
    All,
    /// The light of connections with virtual point lights.
    Connections,
    /// The light that the compensation adds.
    Correction,
    /// The light that bounding takes from the connections.
    Lost,
}

words! {
    /// A part of the light.
    pub(super) ComponentWord for ComponentSpec {
        "all" => ComponentSpec::All,
        "connections" => ComponentSpec::Connections,
        "correction" => ComponentSpec::Correction,
        "lost" => ComponentSpec::Lost,
    }
}

/// A bound as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClampSpec {
    /// None.
    Unclamped,
    /// b \[1/length²\].
    Bound(f64),
    /// As raab-2008 section 4.2 proposes.
    Scene,
}

impl Ruled for ClampSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if node.is_null() {
            return Ok(Self::Unclamped);
        }
        if node.text().is_ok_and(|text| text == "scene") {
            return Ok(Self::Scene);
        }
        node.non_negative()
            .map(Self::Bound)
            .map_err(|_| node.refuse("must be a number of at least 0, null (unclamped), or \"scene\""))
    }

    fn written(&self) -> Value {
        match self {
            Self::Unclamped => Value::Null,
            Self::Bound(bound) => json!(bound),
            Self::Scene => json!("scene"),
        }
    }

    fn schema() -> Value {
        json!({ "anyOf": [{ "type": "number", "minimum": 0 }, { "type": "null" }, { "const": "scene" }] })
    }
}

words! {
    /// The strategy by which compensation connects vertices.
    pub(super) StrategyWord for Strategy {
        "one_to_many" => Strategy::OneToMany,
        "many_to_one" => Strategy::ManyToOne,
        "one_to_one" => Strategy::OneToOne,
    }
}

words! {
    /// The law of the distance of a vertex of the compensation.
    pub(super) PlacementWord for Placement {
        "free_flight" => Placement::FreeFlight,
        "locally_homogeneous" => Placement::LocallyHomogeneous,
    }
}

words! {
    /// The transmittance within a step of the compensation.
    pub(super) TransmittanceWord for TransmittanceUse {
        "exact" => TransmittanceUse::Exact,
        "approximate" => TransmittanceUse::Approximate,
    }
}

words! {
    /// The surfaces that block connections of the compensation.
    pub(super) VisibilityWord for Visibility {
        "full" => Visibility::Full,
        "local" => Visibility::Local,
        "ignored" => Visibility::Ignored,
    }
}

keys! {
    /// The compensation of bounding, as given.
    pub(super) CompensationKeys {
        /// The strategy by which vertices are connected.
        strategy: Strategy as StrategyWord,
        /// The law of the distance of a vertex.
        placement: Placement as PlacementWord = Placement::FreeFlight,
        /// The transmittance within a step.
        transmittance: TransmittanceUse as TransmittanceWord = TransmittanceUse::Exact,
        /// Steps; null for unlimited.
        steps: Option<u32> as Nullable<Whole<0, MOST_VERTICES>> = None,
        /// The surfaces that block connections.
        visibility: Visibility as VisibilityWord = Visibility::Full,
    }
}

/// An object of strategy, placement, transmittance, steps and visibility, or null.
#[derive(Debug)]
pub(super) struct CompensationRule;

impl Rule<Option<CompensationOptions>> for CompensationRule {
    fn read(node: &Node<'_>) -> Result<Option<CompensationOptions>, Failure> {
        let Some(keys) = <Nullable<Among> as Rule<Option<CompensationKeys>>>::read(node)? else {
            return Ok(None);
        };
        let CompensationKeys { strategy, placement, transmittance, steps, visibility } = keys;
        let options = CompensationOptions { strategy, placement, transmittance, steps, visibility };
        options.checked().map(Some).map_err(|error| node.reject(error))
    }
    fn written(options: &Option<CompensationOptions>) -> Value {
        let keys = options.as_ref().map(|options| {
            let &CompensationOptions { strategy, placement, transmittance, steps, visibility } = options;
            CompensationKeys { strategy, placement, transmittance, steps, visibility }
        });
        <Nullable<Among> as Rule<Option<CompensationKeys>>>::written(&keys)
    }
    fn schema() -> Value {
        json!({ "anyOf": [crate::reader::kind::group_schema::<CompensationKeys>(), { "type": "null" }] })
    }
}

impl VplSpec {
    /// Look-ups along each edge of a cell for its mean.
    pub const PROBES: u32 = 4;

    /// The look-ups that local means take at most, and how; `None` where vertices are not placed by them.
    #[must_use]
    pub fn means(&self) -> Option<(f64, String)> {
        let (cells, probes) = (self.local_mean_cells, Self::PROBES);
        let how = || {
            format!(
                "{cells} x {cells} x {cells} cells of {probes} x {probes} x {probes}, before the first pixel"
            )
        };
        let placed = self.compensation.filter(|options| options.placement == Placement::LocallyHomogeneous);
        placed.map(|_| (f64::from(cells * probes).powi(3), how()))
    }

    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        if self.component == ComponentSpec::Correction && self.compensation.is_none() {
            return Err(object.required("component")?.refuse("correction needs a compensation"));
        }
        Ok(())
    }
}

impl IntegratorKind for VplSpec {
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.transport)
    }

    fn bias(&self) -> Option<&'static str> {
        if self.component != ComponentSpec::All {
            Some("component: a part of the light only")
        } else if self.transport.is_biased_baseline() {
            Some(super::BASELINE)
        } else if self.clamp == ClampSpec::Unclamped {
            None
        } else {
            match &self.compensation {
                None => Some("connections are clamped and nothing compensates"),
                Some(options) => options.biased_by_design(),
            }
        }
    }
}

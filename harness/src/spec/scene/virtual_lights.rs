//! Path tracing among surfaces, and virtual point lights.

use super::WalkSpec;
use super::integrator::{named, named_or};
use crate::Failure;
use crate::estimator::EstimatorSpec;
use crate::reader::{Node, Object};
use fairflight_compensation::{CompensationOptions, Placement, Strategy, TransmittanceUse, Visibility};
use fairflight_paths::Heuristic;

/// What integrators that know surfaces have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct TransportSpec {
    /// How paths fly through the medium.
    pub walk: WalkSpec,
    /// Transmittance of connections; by default in closed form in a homogeneous medium, else ratio tracking.
    pub estimator: Option<EstimatorSpec>,
    /// How next-event estimation is weighted against scattering.
    pub heuristic: Heuristic,
}

/// A path tracer as given.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTracerSpec {
    /// How it travels.
    pub transport: TransportSpec,
    /// Longer paths are cut, a bias.
    pub max_vertices: u32,
}

/// Virtual point lights as given.
#[derive(Clone, Debug, PartialEq)]
pub struct VplSpec {
    /// How light paths and eye rays travel.
    pub transport: TransportSpec,
    /// Light paths per set.
    pub light_paths: u32,
    /// Points along an eye ray.
    pub eye_samples: u32,
    /// The bound of the geometric term.
    pub clamp: ClampSpec,
    /// What is done about it.
    pub compensation: Option<CompensationOptions>,
    /// Cells along each axis of the local means of the extinction.
    pub local_mean_cells: u32,
    /// Within this distance from the camera all virtual point lights are kept, and further away the fewer the further.
    pub keep_near: Option<f64>,
    /// Which part of the light is rendered.
    pub component: ComponentSpec,
}

/// A part of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComponentSpec {
    /// All of it.
    #[default]
    All,
    /// What connections with virtual point lights add.
    Connections,
    /// What the compensation adds.
    Correction,
    /// What bounding takes from the connections.
    Lost,
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

/// More light paths or points per ray are a slip of the keyboard.
const MOST: u64 = 10_000_000;
/// More vertices are never met but where nothing is absorbed.
const MOST_VERTICES: u64 = 10_000;
/// More cells take long to fill.
const MOST_CELLS: u64 = 256;
/// Cells along each axis of the downsampled medium.
const LOCAL_MEAN_CELLS: u32 = 16;

impl TransportSpec {
    fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let heuristics =
            [("balance", Heuristic::Balance), ("power", Heuristic::Power), ("maximum", Heuristic::Maximum)];
        Ok(Self {
            walk: WalkSpec::take_with_defaults(object)?,
            estimator: object
                .optional("estimator")
                .map(|node| EstimatorSpec::read_for_all_rays(&node))
                .transpose()?,
            heuristic: named_or(object, "heuristic", &heuristics)?,
        })
    }
}

impl PathTracerSpec {
    /// Paths of all lengths that travel like this.
    #[must_use]
    pub fn of_all_lengths(transport: TransportSpec) -> Self {
        Self { transport, max_vertices: MOST_VERTICES as u32 }
    }

    pub(super) fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let most = object.optional("max_vertices");
        let max_vertices = most.map_or(Ok(MOST_VERTICES), |node| node.integer(1, MOST_VERTICES))?;
        Ok(Self { transport: TransportSpec::take_from(object)?, max_vertices: max_vertices as u32 })
    }
}

impl VplSpec {
    pub(super) fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let integer = |key, least, most, default: u32| {
            object
                .optional(key)
                .map_or(Ok(u64::from(default)), |node| node.integer(least, most))
                .map(|n| n as u32)
        };
        let components = [
            ("all", ComponentSpec::All),
            ("connections", ComponentSpec::Connections),
            ("correction", ComponentSpec::Correction),
            ("lost", ComponentSpec::Lost),
        ];
        let clamp = ClampSpec::read(&object.required("clamp")?)?;
        let compensation = object.optional("compensation").filter(|node| !node.is_null());
        let compensation = compensation.map(|node| read_compensation(&node)).transpose()?;
        let component = named_or(object, "component", &components)?;
        if component == ComponentSpec::Correction && compensation.is_none() {
            return Err(object.required("component")?.refuse("correction needs a compensation"));
        }
        Ok(Self {
            transport: TransportSpec::take_from(object)?,
            light_paths: object.required("light_paths")?.integer(1, MOST)? as u32,
            eye_samples: integer("eye_samples", 1, MOST, 1)?,
            clamp,
            compensation,
            local_mean_cells: integer("local_mean_cells", 1, MOST_CELLS, LOCAL_MEAN_CELLS)?,
            keep_near: object.optional("keep_near").map(|node| node.positive()).transpose()?,
            component,
        })
    }
}

impl VplSpec {
    /// What is biased by design, if anything is; `is_biased` tells of an estimator of transmittance.
    #[must_use]
    pub fn biased_by_design(&self, is_biased: impl Fn(&EstimatorSpec) -> bool) -> Option<&'static str> {
        if self.component != ComponentSpec::All {
            Some("component: a part of the light only")
        } else if self.transport.estimator.as_ref().is_some_and(is_biased) {
            Some("its estimator of transmittance is a biased baseline")
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

impl ClampSpec {
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
}

fn read_compensation(node: &Node<'_>) -> Result<CompensationOptions, Failure> {
    let object = node.object()?;
    let strategies = [
        ("one_to_many", Strategy::OneToMany),
        ("many_to_one", Strategy::ManyToOne),
        ("one_to_one", Strategy::OneToOne),
    ];
    let placements =
        [("free_flight", Placement::FreeFlight), ("locally_homogeneous", Placement::LocallyHomogeneous)];
    let transmittances = [("exact", TransmittanceUse::Exact), ("approximate", TransmittanceUse::Approximate)];
    let visibilities =
        [("full", Visibility::Full), ("local", Visibility::Local), ("ignored", Visibility::Ignored)];
    let steps = object.optional("steps").filter(|node| !node.is_null());
    let options = CompensationOptions {
        strategy: named(&object.required("strategy")?, &strategies)?,
        placement: named_or(&object, "placement", &placements)?,
        transmittance: named_or(&object, "transmittance", &transmittances)?,
        steps: steps.map(|node| node.integer(0, MOST_VERTICES)).transpose()?.map(|steps| steps as u32),
        visibility: named_or(&object, "visibility", &visibilities)?,
    };
    object.finish()?;
    options.checked().map_err(|error| node.reject(error))
}

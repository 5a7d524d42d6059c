//! Bounds in cells along a profile.

use super::sampling::clipped_nodes;
use super::{MOST, refuse};
use crate::Failure;
use crate::field::AnyProfile;
use crate::reader::Node;
use crate::reader::rule::Ruled;
use fairflight_media::{BoundCell, BoundedInCells, InCells, IntervalBounds, Vacuum};
use serde_json::{Value, json};

/// Cells with a minorant and a majorant each, as given.
#[derive(Clone, Debug, PartialEq)]
pub enum CellsSpec {
    /// A number of equal cells along the profile, their bounds found from the field.
    Count(u32),
    /// Claimed.
    Given {
        /// Borders \[length\].
        edges: Vec<f64>,
        /// One lower bound per cell \[1/length\].
        minorants: Vec<f64>,
        /// One upper bound per cell \[1/length\].
        majorants: Vec<f64>,
    },
}

impl Ruled for CellsSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        node.bare_or_object(
            "must be a number of cells, or an object of edges, minorants and majorants",
            |bare| bare.integer(1, MOST).map(|count| Self::Count(count as u32)),
            |object| {
                let numbers = |key| object.required(key)?.numbers();
                let (edges, minorants) = (numbers("edges")?, numbers("minorants")?);
                Ok(Self::Given { edges, minorants, majorants: numbers("majorants")? })
            },
        )
    }

    fn written(&self) -> Value {
        match self {
            Self::Count(count) => json!(count),
            Self::Given { edges, minorants, majorants } => {
                json!({ "edges": edges, "minorants": minorants, "majorants": majorants })
            }
        }
    }

    fn schema() -> Value {
        let numbers =
            |least: u32| json!({ "type": "array", "items": { "type": "number" }, "minItems": least });
        json!({ "anyOf": [
            { "type": "integer", "minimum": 1, "maximum": MOST },
            { "type": "object", "required": ["edges", "minorants", "majorants"], "additionalProperties": false,
              "properties": { "edges": numbers(2), "minorants": numbers(1), "majorants": numbers(1) } },
        ] })
    }
}

/// The cells of a spec on a profile.
pub(super) fn cells(
    spec: &CellsSpec,
    profile: &AnyProfile,
) -> Result<InCells<Vacuum, Vec<BoundCell>>, Failure> {
    let cells = match spec {
        CellsSpec::Count(count) => found(*count as usize, profile)?,
        CellsSpec::Given { edges, minorants, majorants } => given(edges, minorants, majorants, profile)?,
    };
    InCells::new(Vacuum::new(profile.length()), cells).map_err(|error| refuse("estimator.cells", error))
}

/// The range of estimates that do not leave [0, 1] times the transmittance of the minorants.
pub(super) fn range(cells: &InCells<Vacuum, Vec<BoundCell>>) -> (f64, f64) {
    let mut from = 0.0;
    let mut minorant_thickness = 0.0;
    for cell in cells.bound_cells() {
        minorant_thickness += cell.minorant * (cell.to - from);
        from = cell.to;
    }
    (0.0, (-minorant_thickness).exp())
}

/// Equal cells whose bounds the field knows.
fn found(count: usize, profile: &AnyProfile) -> Result<Vec<BoundCell>, Failure> {
    Ok(match profile {
        AnyProfile::Constant(field) => field.equal_cells(count),
        AnyProfile::PiecewiseConstant(field) => field.equal_cells(count),
        AnyProfile::PiecewiseLinear(field) => field.equal_cells(count),
        AnyProfile::Homogeneous(ray) => ray.equal_cells(count),
        AnyProfile::AnalyticCosine(ray) => ray.equal_cells(count),
        AnyProfile::Voxels(ray) => ray.equal_cells(count),
        AnyProfile::Expression(field) => bounded(field.equal_cells(count), profile)?,
        AnyProfile::ExpressionMedium(ray) => bounded(ray.equal_cells(count), profile)?,
        AnyProfile::Perlin(_) => {
            return Err(without_bounds("Perlin noise does not know its bounds in cells"));
        }
        AnyProfile::Own(_) => return Err(without_bounds("the profile does not know its bounds in cells")),
    })
}

/// Cells of a formula, unless the arithmetic of intervals finds no bound in one of them.
fn bounded(cells: Vec<BoundCell>, profile: &AnyProfile) -> Result<Vec<BoundCell>, Failure> {
    let mut from = 0.0;
    for cell in &cells {
        if !(cell.minorant.is_finite() && cell.majorant.is_finite()) {
            let (start, end) = (profile.place(from), profile.place(cell.to));
            return Err(without_bounds(&format!("no bounds of sigma_t are found between {start} and {end}")));
        }
        from = cell.to;
    }
    Ok(cells)
}

fn without_bounds(reason: &str) -> Failure {
    Failure::refused(format!(
        "estimator.cells: {reason}; give edges, minorants and majorants, or use jittered_ratio with a majorant"
    ))
}

/// Cells that a person claims, as distances from the ray's origin, cut to the profile.
fn given(
    edges: &[f64],
    minorants: &[f64],
    majorants: &[f64],
    profile: &AnyProfile,
) -> Result<Vec<BoundCell>, Failure> {
    for (name, bounds) in [("minorants", minorants), ("majorants", majorants)] {
        if edges.len() != bounds.len() + 1 {
            return Err(Failure::refused(format!(
                "estimator.cells: edges needs one entry more than {name}, found {} and {}",
                edges.len(),
                bounds.len()
            )));
        }
    }
    let nodes = clipped_nodes("estimator.cells.edges", edges, profile)?;
    let entry = profile.entry_distance();
    Ok(nodes
        .windows(2)
        .filter(|cell| cell[1] > cell[0])
        .map(|cell| {
            // The cell that holds the middle of the clipped one.
            let middle = 0.5 * (cell[0] + cell[1]) + entry;
            let index = edges.partition_point(|&edge| edge <= middle).clamp(1, minorants.len()) - 1;
            BoundCell { to: cell[1], minorant: minorants[index], majorant: majorants[index] }
        })
        .collect())
}

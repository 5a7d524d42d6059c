//! Bounds in cells along a profile.

use crate::Failure;
use crate::plan::AnyProfile;
use crate::plan::sampling::clipped_nodes;
use crate::spec::CellsSpec;
use fairflight_media::{BoundCell, InCells, IntervalBounds, Vacuum};

/// The cells of a spec on a profile.
pub(super) fn cells(
    spec: &CellsSpec,
    profile: &AnyProfile,
) -> Result<InCells<Vacuum, Vec<BoundCell>>, Failure> {
    let cells = match spec {
        CellsSpec::Count(count) => found(*count as usize, profile)?,
        CellsSpec::Given { edges, minorants, majorants } => given(edges, minorants, majorants, profile)?,
    };
    InCells::new(Vacuum::new(profile.length()), cells)
        .map_err(|error| Failure::refused(format!("estimator.cells: {error}")))
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

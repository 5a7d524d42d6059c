//! Look-ups of ratio tracking in several media, over the look-up alone; and what the length of a walk changes.

use super::estimators::{ratio_tracking, row};
use super::in_turn::Row;
use crate::run::Run;
use fairflight_document::{Axis, Chart, Curve, Mark, Table};
use fairflight_elementary::InstructionSet;
use fairflight_harness::Failure;
use fairflight_laws::DenseLattice;
use fairflight_media::{
    AnalyticCosine, Bounds, Constant, ExpressionProfile, Extinction, Medium, Perlin, PerlinParameters, Ray,
    Voxels,
};
use glam::{DAffine3, DVec3, dvec3};

/// Length of the rays, and look-ups of a walk at a sampling extinction of 1.
const LENGTH: f64 = 20.0;
/// Mean look-ups of walks through a constant extinction.
const LENGTHS: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 100.0];

pub(super) const STEPS: u64 = 5 + LENGTHS.len() as u64;

/// A ray through a medium, from near the axis of eq. 21.
pub(super) fn ray<M: Medium>(medium: M) -> Ray<M> {
    let clip = AnalyticCosine::default_bounds().clip(dvec3(0.3, 0.2, 0.0), DVec3::Z, None);
    Ray::new(medium, &clip.expect("finite").expect("the ray meets the ball"))
}

pub(super) fn cosine() -> AnalyticCosine {
    AnalyticCosine::new(1.0).expect("finite")
}

/// Extinctions from 0.05 to 0.3 on 64³ points.
fn voxels() -> Voxels<DenseLattice> {
    let wave = |i: usize| (0.4 * i as f64).cos();
    let value = |[x, y, z]: [usize; 3]| 0.175 + 0.125 * wave(x) * wave(y) * wave(z);
    Voxels::new(DenseLattice::of([64; 3], value), DAffine3::IDENTITY, 1.0).expect("finite")
}

fn voxel_ray(voxels: &Voxels<DenseLattice>) -> Ray<&Voxels<DenseLattice>> {
    let bounds = Bounds::aligned_box(DVec3::ZERO, DVec3::splat(63.0)).expect("ordered");
    let clip = bounds
        .clip(dvec3(-10.0, 20.0, 17.0), dvec3(1.0, 0.3, 0.4), None)
        .expect("finite")
        .expect("the ray meets the box");
    Ray::new(voxels, &clip)
}

/// A look-up in each medium, by ratio tracking at a sampling extinction of 1 (0.35 among voxels, 0.6 of the expression).
pub(super) fn study(run: &Run<'_>) -> Result<Vec<Row>, Failure> {
    let constant = Constant::new(0.5, LENGTH).expect("finite");
    let formula = "0.3 + 0.25*sin(7*s)*exp(-0.2*s)";
    let expression = ExpressionProfile::new(formula, LENGTH, Some(0.6)).expect("a formula");
    let perlin = Perlin::new(PerlinParameters::default()).expect("lawful");
    let voxels = voxels();
    let ratio = |sigma_samp| ratio_tracking(LENGTH, sigma_samp);
    let among_voxels = voxel_ray(&voxels);
    Ok(vec![
        row(run, "constant", &ratio(1.0), &constant)?,
        row(run, "eq. 21 of szirmay-kalos-2017", &ratio(1.0), &ray(cosine()))?,
        row(run, "voxels, 64³", &ratio_tracking(among_voxels.length(), 0.35), &among_voxels)?,
        row(run, "expression", &ratio(0.6), &&expression)?,
        row(run, "Perlin noise of twelve octaves", &ratio(1.0), &ray(&perlin))?,
    ])
}

pub(super) fn table(rows: &[Row]) -> Table {
    let caption =
        "Ratio tracking. Bare parts: one look-up at a random place, one uniform variate, one logarithm.";
    Row::table(["media-table", "A look-up of ratio tracking", caption], ["look-up", "walk"], rows)
}

/// A look-up over the length of walks through a constant extinction.
pub(super) fn lengths(run: &Run<'_>) -> Result<Chart, Failure> {
    let measure = |&length: &f64| {
        let constant = Constant::new(0.5, length).expect("finite");
        row(run, format!("{length}"), &ratio_tracking(length, 1.0), &constant)
    };
    let rows: Vec<Row> = LENGTHS.iter().map(measure).collect::<Result<_, _>>()?;
    let curve = |name: &str, of: &dyn Fn(&Row) -> Mark| Curve::joined(name, rows.iter().map(of));
    let mut curves = vec![
        curve("bare parts", &|row| row.bare.mark(row.per_walk)),
        curve("one after the other", &|row| row.one_by_one.mark(row.per_walk)),
    ];
    for (at, set) in InstructionSet::of_this_machine().enumerate() {
        // The quotient is known better than either time.
        let in_lanes = |row: &Row| row.gains[at].map(|gain| row.one_by_one.value / gain).mark(row.per_walk);
        curves.push(curve(&format!("in lanes, {}", set.name()), &in_lanes));
    }
    let (x, y) =
        (Axis::logarithmic("look-ups per walk [1]"), Axis::logarithmic("CPU time of a look-up [ns]"));
    let caption = "Ratio tracking through a constant extinction, which is the cheapest look-up: what the beginning and the end of a walk cost shows on the left.";
    Ok(Chart::new("length", "A look-up, by the length of walks", x, y)
        .with_curves(curves)
        .with_caption(caption))
}

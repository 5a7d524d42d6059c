//! Trilinear look-ups across leaves, tiles and the grid's border, against the plain definition.

mod common;

use common::grid;
use fairflight_volumes::VoxelGrid;

/// The eight corners weighted one by one.
fn by_definition(grid: &VoxelGrid, point: [f64; 3]) -> f64 {
    let floor = point.map(f64::floor);
    let mut sum = 0.0;
    for corner in 0..8 {
        let step = [corner >> 2 & 1, corner >> 1 & 1, corner & 1];
        let mut weight = 1.0;
        let mut voxel = [0; 3];
        for axis in 0..3 {
            let fraction = point[axis] - floor[axis];
            weight *= if step[axis] == 1 { fraction } else { 1.0 - fraction };
            voxel[axis] = floor[axis] as i32 + step[axis];
        }
        sum += weight * f64::from(grid.value(voxel[0], voxel[1], voxel[2]));
    }
    sum
}

/// Points spread over a box by the additive recurrence of the plastic number's powers.
fn points(count: u32, lowest: f64, size: f64) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |n| {
        [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9]
            .map(|step: f64| lowest + size * (f64::from(n) * step).fract())
    })
}

fn at(grid: &VoxelGrid, [x, y, z]: [f64; 3]) -> f64 {
    grid.trilinear(x, y, z)
}

#[test]
fn look_ups_follow_the_definition() {
    for (file, name, lowest, size) in [
        ("eq21_64_half.vdb", "density", -3.0, 70.0),
        ("tiles.vdb", "density", -3.0, 70.0),
        ("codes.vdb", "tiles", -40.0, 80.0),
        ("codes.vdb", "code6_all_values", -20.0, 40.0),
    ] {
        let grid = grid(file, name);
        for point in points(20_000, lowest, size) {
            let (found, expected) = (at(&grid, point), by_definition(&grid, point));
            assert!((found - expected).abs() < 1e-13, "{file} {name} {point:?}: {found} {expected}");
            assert!(f64::from(grid.minimum()) <= found && found <= f64::from(grid.maximum()));
        }
    }
}

#[test]
fn voxels_are_met_exactly() {
    for (file, name) in [("tiles.vdb", "density"), ("codes.vdb", "tiles"), ("codes.vdb", "linear")] {
        let grid = grid(file, name);
        for (i, j, k) in
            (-10..40).flat_map(|i| (-10..40).flat_map(move |j| (-10..40).map(move |k| (i, j, k))))
        {
            let found = grid.trilinear(f64::from(i), f64::from(j), f64::from(k));
            assert_eq!(found, f64::from(grid.value(i, j, k)), "{file} {name} {i} {j} {k}");
        }
    }
}

#[test]
fn a_linear_field_is_reproduced_on_both_sides_of_zero() {
    // 2 x - 3 y + 5 z over the voxels from -9 to 9, hence over leaf borders at -8, 0 and 8; sixteenths are exact.
    let grid = grid("codes.vdb", "linear");
    for point in points(20_000, -9.0, 18.0) {
        let [x, y, z] = point.map(|coordinate| (coordinate * 16.0).round() / 16.0);
        assert_eq!(grid.trilinear(x, y, z), 2.0 * x - 3.0 * y + 5.0 * z, "{x} {y} {z}");
    }
}

#[test]
fn the_interpolant_is_continuous_at_every_integer() {
    const STEP: f64 = 1e-9;
    for (file, name, lowest, size) in [
        ("eq21_64_half.vdb", "density", -3.0, 70.0),
        ("tiles.vdb", "density", -3.0, 70.0),
        ("codes.vdb", "tiles", -40.0, 80.0),
    ] {
        let grid = grid(file, name);
        // Along one axis the interpolant changes by at most the range of values per unit.
        let slope = f64::from(grid.maximum() - grid.minimum());
        for (n, point) in points(20_000, lowest, size).enumerate() {
            let axis = n % 3;
            let side = |offset: f64| {
                let mut point = point;
                point[axis] = point[axis].round() + offset;
                at(&grid, point)
            };
            assert!(
                (side(STEP) - side(-STEP)).abs() <= 2.1 * STEP * slope,
                "{file} {name} {point:?} axis {axis}"
            );
        }
    }
}

#[test]
fn outside_is_background() {
    let grid = grid("codes.vdb", "code0_background");
    assert_eq!(grid.background(), 0.25);
    for far in [5000.0, 2_147_483_645.5, 2_147_483_647.0, 1e10, f64::MAX, f64::INFINITY] {
        for point in [[far, 0.0, 0.0], [0.0, -far, 0.0], [far, far, -far]] {
            assert_eq!(at(&grid, point), 0.25, "{point:?}");
        }
    }
    for voxel in [i32::MIN, i32::MAX] {
        assert_eq!(grid.value(voxel, voxel, voxel), 0.25);
        assert!(!grid.is_active(voxel, voxel, voxel));
    }
}

#[test]
fn a_coordinate_that_is_no_number_gives_none() {
    let grid = grid("tiles.vdb", "density");
    for point in
        [[f64::NAN, 1.0, 1.0], [1.0, f64::NAN, 1.0], [1.0, 1.0, f64::NAN], [f64::INFINITY, 1.0, f64::NAN]]
    {
        assert!(at(&grid, point).is_nan());
    }
}

//! The fixture files read as OpenVDB reads them: every expected number here was printed by OpenVDB 10.0.1.

mod common;

use common::{fixture, grid};
use fairflight_volumes::{VdbError, VoxelGrid, grids, read_float_grid};

/// A sum or another long number, to the printed digits.
fn printed(value: f64) -> String {
    format!("{value:.6}")
}

fn world(grid: &VoxelGrid, point: [f64; 3]) -> [f64; 3] {
    let world = grid.world_from_index().apply_point(point);
    let back = grid.index_from_world().apply_point(world);
    for axis in 0..3 {
        assert!((back[axis] - point[axis]).abs() < 1e-12, "{point:?} comes back as {back:?}");
    }
    world
}

fn assert_near(found: [f64; 3], expected: [f64; 3]) {
    for axis in 0..3 {
        assert!(
            (found[axis] - expected[axis]).abs() < 1e-14 * (1.0 + expected[axis].abs()),
            "{found:?} {expected:?}"
        );
    }
}

/// The sum of 1000 look-ups around the middle of the active box.
fn sum_of_look_ups(grid: &VoxelGrid) -> f64 {
    let (lowest, highest) = grid.active_bounds().expect("not empty");
    let centre: [f64; 3] =
        std::array::from_fn(|axis| 0.5 * (f64::from(lowest[axis]) + f64::from(highest[axis])));
    let offset =
        |n: i32, factor: i32, modulus: i32, step: f64| f64::from(n * factor % modulus - modulus / 2) * step;
    let look_up = |n| {
        let (x, y, z) = (offset(n, 37, 101, 0.37), offset(n, 53, 103, 0.41), offset(n, 71, 107, 0.29));
        grid.trilinear(centre[0] + x, centre[1] + y, centre[2] + z)
    };
    (0..1000).map(look_up).sum()
}

fn assert_totals(grid: &VoxelGrid, voxels: u64, sum: &str, range: (f32, f32)) {
    assert_eq!((grid.active_voxel_count(), printed(grid.active_sum()).as_str()), (voxels, sum));
    assert_eq!((grid.minimum(), grid.maximum()), range);
}

#[test]
fn eq21_64_also_saved_as_half() {
    for (file, sum, maximum, look_ups, half) in [
        // OpenVDB interpolates with 32 bits.
        ("eq21_64.vdb", "23239.946866", 0.998_223_36, 141.061_325, false),
        ("eq21_64_half.vdb", "23240.027570", 0.998_046_9, 141.061_539, true),
    ] {
        let grid = grid(file, "density");
        assert_totals(&grid, 137_376, sum, (0.0, maximum));
        assert_eq!(grid.active_bounds(), Some(([0; 3], [63; 3])));
        assert_near(world(&grid, [1.0, 2.0, 3.0]), [-9.53125, -9.21875, 1.09375]);
        assert!((sum_of_look_ups(&grid) - look_ups).abs() < 1e-4);
        assert_eq!(grid.info().saved_as_half, half);
        assert_eq!(grid.info().class.as_deref(), Some("fog volume"));
    }
}

#[test]
fn both_grids_of_cloud() {
    let density = grid("cloud.vdb", "density");
    assert_totals(&density, 115_979, "39964.464458", (0.0, 1.0));
    assert_eq!(density.active_bounds(), Some(([1, 0, 0], [119, 71, 95])));
    assert_near(world(&density, [1.0, 2.0, 3.0]), [-2.95, 0.6, -2.25]);
    assert!((sum_of_look_ups(&density) - 122.481_488).abs() < 1e-4);

    let temperature = grid("cloud.vdb", "temperature");
    assert_totals(&temperature, 115_979, "11989339.337580", (0.0, 300.0));
    assert_eq!(world(&temperature, [1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);

    let first = read_float_grid(&fixture("cloud.vdb"), None).expect("a float grid");
    assert_eq!(first.info().name, "density");
}

#[test]
fn active_tiles_stay_tiles_and_count_with_their_volume() {
    let grid = grid("tiles.vdb", "density");
    assert_eq!(grid.active_voxel_count(), 65_536);
    assert_eq!(grid.active_sum(), 32_808.5);
    assert_eq!((grid.minimum(), grid.maximum()), (0.0, 2.0));
    assert_eq!(grid.active_bounds(), Some(([0; 3], [63, 31, 31])));
    assert_near(world(&grid, [1.0, 2.0, 3.0]), [-0.9, 2.2, 3.3]);
    assert_eq!(printed(sum_of_look_ups(&grid)), "378.200000");
    assert!(
        grid.memory_bytes() < 200_000,
        "65536 voxels of four bytes would be more: {}",
        grid.memory_bytes()
    );
}

#[test]
fn files_that_cannot_be_used_say_why() {
    let error = |bytes: &[u8]| read_float_grid(bytes, None).expect_err("unusable");
    let vector = error(&fixture("vec_only.vdb"));
    assert_eq!(vector.to_string(), "no float grid; the file has v (Tree_vec3s_5_4_3)");
    assert_eq!(grids(&fixture("vec_only.vdb")).expect("readable head")[0].value_type, "vec3s");
    let asked = read_float_grid(&fixture("vec_only.vdb"), Some("v")).expect_err("not a float grid");
    assert_eq!(asked.to_string(), "grid \"v\" is a Tree_vec3s_5_4_3, not a Tree_float_5_4_3");

    let truncated = error(&fixture("truncated.vdb"));
    assert_eq!(truncated.to_string(), "the file is cut off: grid \"density\" reaches past byte 150000");
    assert_eq!(error(b""), VdbError::NotOpenVdb);
    assert_eq!(error(b"#usda 1.0, which is another format"), VdbError::NotOpenVdb);

    let missing = read_float_grid(&fixture("cloud.vdb"), Some("smoke")).expect_err("no such grid");
    assert_eq!(missing.to_string(), "no grid named \"smoke\"; the file has density, temperature");
}

//! The ways of writing the same thing that the format has: codes for inactive values, tiles, names, codecs, transforms.
//!
//! The files come from OpenVDB by way of `codes.cc` beside them, and the numbers from reading them with OpenVDB.

mod common;

use common::{fixture, grid};
use fairflight_volumes::{VoxelGrid, grids, read_float_grid};

/// All values around the origin, active or not, with weights that tell neighbours apart.
fn fingerprint(grid: &VoxelGrid) -> f64 {
    let (mut sum, mut n) = (0.0, 0);
    for i in -12..24 {
        for j in -12..24 {
            for k in -12..24 {
                n += 1;
                sum += f64::from(grid.value(i, j, k)) * f64::from(1 + n % 7);
            }
        }
    }
    sum
}

#[test]
fn inactive_values_are_restored_under_every_code() {
    for (file, name, least, expected) in [
        ("codes.vdb", "code0_background", 0.25, 46_927.75),
        ("codes.vdb", "code1_minus_background", -0.25, 45_916.75),
        ("codes.vdb", "code2_one_value", 0.25, 47_938.75),
        ("codes.vdb", "code3_plus_and_minus", -0.25, 46_424.75),
        ("codes.vdb", "code4_background_and_one", 0.25, 47_430.75),
        ("codes.vdb", "code5_two_values", 0.25, 47_684.75),
        ("codes.vdb", "code6_all_values", 0.25, 47_433.0),
        ("codes.vdb", "half", 0.25, 47_684.75),
        // Neither compressed nor are inactive values omitted.
        ("plain.vdb", "half", 0.25, 47_684.75),
    ] {
        let grid = grid(file, name);
        assert_eq!((grid.active_voxel_count(), grid.active_sum()), (12, 78.0), "{file} {name}");
        assert_eq!(grid.active_bounds(), Some(([-6, -3, 5], [5, -3, 5])), "{file} {name}");
        assert_eq!((grid.background(), grid.minimum(), grid.maximum()), (0.25, least, 12.0), "{file} {name}");
        assert_eq!(fingerprint(&grid), expected, "{file} {name}");
        assert_eq!(grid.info().saved_as_half, name == "half");
    }
}

#[test]
fn tiles_of_every_size() {
    let grid = grid("codes.vdb", "tiles");
    assert_eq!(grid.active_voxel_count(), (1 << 36) + (1 << 21) + (1 << 9) + 1);
    assert_eq!(grid.active_sum(), 206_162_625_024.5);
    assert_eq!(grid.active_bounds(), Some(([-8192, -128, -1], [255, 4095, 4095])));
    assert_eq!((grid.minimum(), grid.maximum()), (-2.0, 3.0), "inactive tiles take part");
    assert_eq!(fingerprint(&grid), 23_330.375);
    let at = |i, j, k| (grid.value(i, j, k), grid.is_active(i, j, k));
    assert_eq!(at(-8192, 4095, 0), (3.0, true));
    assert_eq!(at(-8, 23, 31), (1.0, true));
    assert_eq!(at(7, 16, 24), (-1.0, false));
    assert_eq!(at(255, -1, 383), (2.0, true));
    assert_eq!(at(256, -1, 383), (-2.0, false));
    assert_eq!(at(-1, -1, -1), (0.5, true));
    assert_eq!(at(-1, -1, -2), (0.125, false));
}

#[test]
fn a_grid_without_active_voxels() {
    let grid = grid("codes.vdb", "empty");
    assert_eq!((grid.active_voxel_count(), grid.active_sum(), grid.active_bounds()), (0, 0.0, None));
    assert_eq!((grid.minimum(), grid.maximum(), grid.trilinear(1.5, 2.5, 3.5)), (0.5, 0.5, 0.5));
}

#[test]
fn grids_of_one_name_are_told_apart() {
    let bytes = fixture("codes.vdb");
    let names: Vec<String> = grids(&bytes).expect("readable").into_iter().map(|info| info.name).collect();
    assert!(names.contains(&"twin[0]".to_owned()) && names.contains(&"twin[1]".to_owned()), "{names:?}");
    assert_eq!(grid("codes.vdb", "twin[0]").maximum(), 10.0);
    assert_eq!(grid("codes.vdb", "twin[1]").maximum(), 11.0);
    assert_eq!(grid("codes.vdb", "twin").maximum(), 10.0, "without a number it is the first");
}

#[test]
fn of_many_grids_one_must_be_named() {
    let error = read_float_grid(&fixture("codes.vdb"), None).expect_err("none is called density");
    let message = error.to_string();
    assert!(
        message.starts_with("several float grids, of which one must be named: the file has "),
        "{message}"
    );
    assert!(message.contains("tiles") && message.contains("twin[0], twin[1]"), "{message}");
}

#[test]
fn a_grid_without_its_own_tree_is_refused() {
    let error = read_float_grid(&fixture("codes.vdb"), Some("instance")).expect_err("an instance");
    let message = "not supported: grid \"instance\" has no tree of its own, it is an instance of \"twin[0]\"";
    assert_eq!(error.to_string(), message);
}

#[test]
fn zip_and_transforms() {
    for (name, expected) in [
        ("uniform_scale", [0.5, 1.0, 1.5]),
        ("uniform_scale_translate", [1.5, 3.0, 4.5]),
        ("scale", [0.5, 0.5, 6.0]),
        ("scale_translate", [1.5, 2.5, 9.0]),
        ("translation", [2.0, 4.0, 6.0]),
        ("unitary", [-2.0, 1.0, 3.0]),
        ("affine", [-3.5, 4.0, 15.0]),
    ] {
        let grid = grid("zip.vdb", name);
        assert_eq!((grid.active_voxel_count(), grid.active_sum()), (524, 1099.0), "{name}");
        assert_eq!(grid.active_bounds(), Some(([-6, -3, 0], [15, 7, 7])), "{name}");
        assert_eq!(fingerprint(&grid), 4361.0, "{name}");
        let world = grid.world_from_index().apply_point([1.0, 2.0, 3.0]);
        for axis in 0..3 {
            assert!((world[axis] - expected[axis]).abs() < 1e-15, "{name}: {world:?}");
        }
    }
    let error = read_float_grid(&fixture("zip.vdb"), Some("frustum")).expect_err("not affine");
    let message = "transform not supported: NonlinearFrustumMap (a camera frustum) is not affine";
    assert_eq!(error.to_string(), message);
}

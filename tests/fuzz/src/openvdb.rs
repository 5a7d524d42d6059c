//! OpenVDB files.

use fairflight_volumes::{FIXED_ALLOWANCE, MAX_EXPANSION, VdbError, VoxelGrid, grids, read_float_grid};

/// A file is refused in one line, or its grids are listed; each is read or refused in one line; a grid that was read takes no more memory
/// than its file allows, and everything that it returns lies between its least and its greatest value, both finite.
pub fn check(data: &[u8]) {
    let listed = match grids(data) {
        Ok(listed) => listed,
        Err(error) => return one_line(&error),
    };
    read(data, None);
    // Several grids of one name: the file says how many there are, and each costs as much as the file.
    listed.iter().take(3).for_each(|info| read(data, Some(&info.name)));
}

fn read(data: &[u8], name: Option<&str>) {
    match read_float_grid(data, name) {
        Err(error) => one_line(&error),
        Ok(grid) => lawful(&grid, data.len()),
    }
}

fn lawful(grid: &VoxelGrid, length: usize) {
    assert!(grid.memory_bytes() <= MAX_EXPANSION * length + FIXED_ALLOWANCE, "{} bytes", grid.memory_bytes());
    let (least, greatest) = (grid.minimum(), grid.maximum());
    assert!(least.is_finite() && least <= greatest && greatest.is_finite());
    assert!(grid.active_sum().is_finite());
    let Some((lowest, highest)) = grid.active_bounds() else {
        assert_eq!(grid.active_voxel_count(), 0);
        return;
    };
    assert!(grid.active_voxel_count() > 0 && (0..3).all(|axis| lowest[axis] <= highest[axis]));
    for at in [0.0, 0.3, 0.5, 1.0] {
        let [x, y, z] =
            std::array::from_fn(|i| (1.0 - at) * f64::from(lowest[i]) + at * f64::from(highest[i]) - 0.4);
        let value = grid.trilinear(x, y, z);
        assert!((f64::from(least)..=f64::from(greatest)).contains(&value), "{value} at {x}, {y}, {z}");
    }
    for voxel in [lowest, highest] {
        let value = grid.value(voxel[0], voxel[1], voxel[2]);
        assert!((least..=greatest).contains(&value), "{value} at {voxel:?}");
    }
}

fn one_line(error: &VdbError) {
    let text = error.to_string();
    assert!(!text.trim().is_empty() && !text.contains(['\n', '\r']), "{text:?}");
}

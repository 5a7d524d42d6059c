//! `harness info`: what an OpenVDB file holds, and a scene with it.

use crate::cli::InfoArguments;
use crate::field::{glam_affine, grown_bounds};
use crate::{DONE, Failure, print};
use fairflight_media::Bounds;
use fairflight_volumes::{GridInfo, VoxelGrid, grids, read_float_grid};
use glam::DVec3;
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

/// One grid of a file.
#[derive(Debug, Serialize)]
struct Grid {
    name: String,
    class: Option<String>,
    value_type: String,
    /// Voxels that the file states.
    stated_voxels: Option<i64>,
    /// The reason why it is no medium.
    refused: Option<String>,
    #[serde(flatten)]
    volume: Option<Volume>,
}

/// A grid that can be a medium.
#[derive(Debug, Serialize)]
struct Volume {
    /// The box of the active voxels in the world, grown by one.
    min: [f64; 3],
    max: [f64; 3],
    /// The edges of a voxel in the world.
    spacing: [f64; 3],
    active_voxels: u64,
    least: f64,
    greatest: f64,
    /// The mean value over the box, where nothing but active voxels counts.
    mean: f64,
    /// The extent of the box times the mean value: mean free paths across it at scale 1.
    mean_free_paths: [f64; 3],
}

impl Grid {
    fn of(bytes: &[u8], info: GridInfo) -> Self {
        let read = read_float_grid(bytes, Some(&info.name));
        let (volume, refused) = match read.as_ref().map(Volume::of) {
            Ok(Some(volume)) => (Some(volume), None),
            Ok(None) => (None, Some("the grid has no active voxel".to_owned())),
            Err(error) => (None, Some(error.to_string())),
        };
        let GridInfo { name, class, value_type, file_voxel_count, .. } = info;
        Self { name, class, value_type, stated_voxels: file_voxel_count, refused, volume }
    }
}

impl Volume {
    /// `None` for a grid without an active voxel.
    fn of(grid: &VoxelGrid) -> Option<Self> {
        let Bounds::Box { min, max } = grown_bounds(grid)? else { return None };
        let world = glam_affine(&grid.world_from_index());
        let spacing = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| world.transform_vector3(axis).length());
        let extent = max - min;
        let voxel = world.matrix3.determinant().abs();
        let mean = grid.active_sum() * voxel / (extent.x * extent.y * extent.z);
        Some(Self {
            min: min.to_array(),
            max: max.to_array(),
            spacing,
            active_voxels: grid.active_voxel_count(),
            least: f64::from(grid.minimum()),
            greatest: f64::from(grid.maximum()),
            mean,
            mean_free_paths: (mean * extent).to_array(),
        })
    }

    /// A scene in which light crosses about three mean free paths, seen from the side.
    fn scene(&self, file: &Path, grid: &str) -> Value {
        const THICKNESS: f64 = 3.0;
        let (min, max) = (DVec3::from_array(self.min), DVec3::from_array(self.max));
        let (middle, extent) = (0.5 * (min + max), max - min);
        let deep = self.mean_free_paths.into_iter().fold(0.0, f64::max);
        // Two digits are enough, and can be read.
        let scale = if deep > 0.0 { format!("{:.1e}", THICKNESS / deep).parse().unwrap_or(1.0) } else { 1.0 };
        let eye = middle - DVec3::Z * (0.5 * extent.z + 1.6 * extent.max_element());
        json!({
            "camera": { "origin": eye.to_array(), "look_at": middle.to_array(), "up": [0, 1, 0],
                "vertical_fov_degrees": 40, "resolution": [128, 128] },
            "medium": { "kind": "vdb", "file": file, "grid": grid, "scale": scale,
                "albedo": 0.9, "phase": { "kind": "henyey_greenstein", "g": 0.4 } },
            "lights": [
                { "kind": "environment", "radiance": 0.3 },
                { "kind": "directional", "direction": [1, -2, 1], "irradiance": 3 },
            ],
            "integrator": { "kind": "path_tracer" },
            "samples_per_pixel": 64,
            "seed": 1,
        })
    }
}

/// Runs `harness info`; returns the exit code.
///
/// # Errors
/// If the file cannot be read, or the text not be printed.
pub fn run(arguments: &InfoArguments, stdout: &mut dyn Write) -> Result<i32, Failure> {
    let file = &arguments.file;
    let in_file = |error: &dyn std::fmt::Display| Failure::refused(format!("{}: {error}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| in_file(&error))?;
    let found = grids(&bytes).map_err(|error| in_file(&error))?;
    let found: Vec<Grid> = found.into_iter().map(|info| Grid::of(&bytes, info)).collect();
    let text = if arguments.json {
        let json = serde_json::to_string_pretty(&json!({ "file": file, "grids": found }));
        json.map_err(|error| in_file(&error))? + "\n"
    } else {
        described(file, &found)
    };
    print(stdout, &text)?;
    Ok(DONE)
}

/// The grids for a person, and a scene with `density`, or with the first that can be a medium.
fn described(file: &Path, grids: &[Grid]) -> String {
    let mut text = String::new();
    let list = |values: [f64; 3]| values.map(|value| format!("{value:.6}")).join(", ");
    for Grid { name, class, value_type, stated_voxels, refused, volume } in grids {
        let class = class.as_deref().unwrap_or("no class");
        let _ = writeln!(text, "{name}: {value_type}, {class}");
        match volume {
            None => {
                let voxels = stated_voxels.map_or_else(String::new, |voxels| format!("{voxels} voxels; "));
                let _ = writeln!(text, "  {voxels}no medium: {}", refused.as_deref().unwrap_or_default());
            }
            Some(volume) => {
                let _ = writeln!(text, "  box               {} to {}", list(volume.min), list(volume.max));
                let _ = writeln!(text, "  voxel             {}", list(volume.spacing));
                let _ = writeln!(text, "  active voxels     {}", volume.active_voxels);
                let _ = writeln!(
                    text,
                    "  values            {} to {}, mean {:.6}",
                    volume.least, volume.greatest, volume.mean
                );
                let _ = writeln!(
                    text,
                    "  mean free paths   {} across the box, at scale 1",
                    list(volume.mean_free_paths)
                );
            }
        }
    }
    let usual = grids
        .iter()
        .filter(|grid| grid.volume.is_some())
        .min_by_key(|grid| usize::from(grid.name != "density"));
    if let Some((volume, name)) = usual.and_then(|grid| Some((grid.volume.as_ref()?, &grid.name))) {
        let _ =
            writeln!(text, "\nA scene, about three mean free paths deep:\n\n{:#}", volume.scene(file, name));
    }
    text
}

//! The camera of a scene.

use crate::Failure;
use crate::reader::Node;
use fairflight_scene::{Camera, SceneError};

/// A wider or higher image is a slip of the keyboard.
const MOST_PIXELS_ACROSS: u32 = 16_384;

/// Reads `camera`.
pub(super) fn read(node: &Node<'_>) -> Result<Camera, Failure> {
    let object = node.object()?;
    let (origin, look_at, up) =
        (object.required("origin")?, object.required("look_at")?, object.required("up")?);
    let fov = object.required("vertical_fov_degrees")?;
    let resolution = object.required("resolution")?;
    let pixels = resolution.integers::<2>(1, MOST_PIXELS_ACROSS)?;
    let camera = Camera::new(origin.vector()?, look_at.vector()?, up.vector()?, fov.number()?, pixels);
    let camera = camera.map_err(|error| match &error {
        SceneError::Degenerate { what: "look_at", because } => {
            look_at.refuse(format!("must not be {because}"))
        }
        SceneError::Degenerate { what: "up", because } => up.refuse(format!("must not be {because}")),
        SceneError::FieldOfView { .. } => fov.refuse("must lie between 0 and 180"),
        _ => node.reject(error),
    })?;
    object.finish()?;
    Ok(camera)
}

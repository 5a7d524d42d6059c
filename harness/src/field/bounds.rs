//! The bounds of a medium.

use crate::Failure;
use crate::reader::Node;
use crate::reader::rule::{Rule, vector_schema};
use fairflight_media::Bounds;
use serde_json::{Value, json};

/// A sphere or a box along the axes.
#[derive(Debug)]
pub struct BoundsRule;

impl Rule<Bounds> for BoundsRule {
    fn read(node: &Node<'_>) -> Result<Bounds, Failure> {
        let object = node.object()?;
        let bounds = match (object.optional("sphere"), object.optional("box")) {
            (Some(sphere), None) => {
                let object = sphere.object()?;
                let center = object.required("center")?.vector()?;
                let radius = object.required("radius")?.non_negative()?;
                object.finish()?;
                Bounds::sphere(center, radius).map_err(|error| sphere.reject(error))?
            }
            (None, Some(cuboid)) => {
                let object = cuboid.object()?;
                let (min, max) = (object.required("min")?, object.required("max")?);
                let (low, high) = (min.vector()?, max.vector()?);
                if !low.cmple(high).all() {
                    return Err(max.refuse("must not be below min in any coordinate"));
                }
                object.finish()?;
                Bounds::aligned_box(low, high).map_err(|error| cuboid.reject(error))?
            }
            _ => return Err(node.refuse("must hold either sphere or box")),
        };
        object.finish()?;
        Ok(bounds)
    }

    fn written(bounds: &Bounds) -> Value {
        match bounds {
            Bounds::Sphere { center, radius } => {
                json!({ "sphere": { "center": center.to_array(), "radius": radius } })
            }
            Bounds::Box { min, max } => json!({ "box": { "min": min.to_array(), "max": max.to_array() } }),
        }
    }

    fn schema() -> Value {
        let one = |name: &str, keys: Value, required: [&str; 2]| {
            json!({
                "type": "object", "required": [name], "additionalProperties": false,
                "properties": { name: {
                    "type": "object", "required": required, "additionalProperties": false, "properties": keys,
                } },
            })
        };
        let radius = json!({ "type": "number", "minimum": 0 });
        json!({ "oneOf": [
            one("sphere", json!({ "center": vector_schema(), "radius": radius }), ["center", "radius"]),
            one("box", json!({ "min": vector_schema(), "max": vector_schema() }), ["min", "max"]),
        ] })
    }
}

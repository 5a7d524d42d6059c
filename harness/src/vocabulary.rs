//! The vocabulary of experiments and scenes: all kinds of all things, from their registries; `harness list`, `harness schema`, and the
//! tables of docs/SPEC.md.

use crate::estimator::{ControlSpec, EstimatorSpec};
use crate::field::{MediumSpec, ProfileSpec};
use crate::reader::Listed;
use crate::reader::kind::{Key, object_schema, plain};
use crate::reader::rule::{Ruled, vector_schema};
use crate::spec::{ColourSpec, ExtensionSpec, IntegratorSpec, LightSpec, MaterialSpec, PhaseSpec, ShapeSpec};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// All kinds of one thing.
pub struct Things {
    /// The name of the thing, one of them.
    pub name: &'static str,
    /// The same, several.
    pub title: &'static str,
    /// The kinds of the thing.
    pub kinds: Vec<Listed>,
}

/// The things of experiments and scenes, with their kinds.
#[must_use]
pub fn things() -> Vec<Things> {
    let things = |name, title, kinds| Things { name, title, kinds };
    vec![
        things("profile", "profiles", ProfileSpec::listed()),
        things("medium", "media", MediumSpec::listed()),
        things("estimator", "estimators", EstimatorSpec::listed()),
        things("control", "controls", ControlSpec::listed()),
        things("integrator", "integrators", IntegratorSpec::listed()),
        things("extension", "extensions", ExtensionSpec::listed()),
        things("phase", "phases", PhaseSpec::listed()),
        things("light", "lights", LightSpec::listed()),
        things("surface", "surfaces", surfaces()),
        things("material", "materials", MaterialSpec::listed()),
    ]
}

fn defined(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// Shapes with what every surface has.
fn surfaces() -> Vec<Listed> {
    let keys = || {
        vec![
            Key::required("material", "The material.", defined("material")),
            Key::optional(
                "emission",
                "The radiance that it emits from both sides.",
                <ColourSpec as Ruled>::schema(),
            ),
        ]
    };
    ShapeSpec::listed().into_iter().map(|shape| shape.with(keys())).collect()
}

/// Media with what makes them scatter.
fn volumes() -> Vec<Listed> {
    let keys = || {
        vec![
            Key::required(
                "albedo",
                "σ_s/σ_t; above 1 only with `allow_gain`.",
                <ColourSpec as Ruled>::schema(),
            ),
            Key::required("phase", "The phase function.", defined("phase")),
        ]
    };
    MediumSpec::listed().into_iter().map(|medium| medium.with(keys())).collect()
}

/// The JSON Schema of experiments and scenes.
#[must_use]
pub fn schema() -> Value {
    let mut definitions = Map::new();
    let mut one_of = |name: &str, kinds: &[Listed]| {
        let schemas: Vec<Value> = kinds.iter().map(Listed::schema).collect();
        definitions.insert(name.to_owned(), json!({ "oneOf": schemas }));
    };
    for things in things() {
        one_of(things.name, &things.kinds);
    }
    one_of("volume", &volumes());
    definitions.insert("experiment".to_owned(), experiment());
    definitions.insert("scene".to_owned(), scene());
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Experiments and scenes of Fairflight",
        "anyOf": [defined("experiment"), defined("scene")],
        "$defs": definitions,
    })
}

fn whole(least: u64) -> Value {
    json!({ "type": "integer", "minimum": least })
}

/// Keys of an object that is the whole file.
fn root(keys: &[Key]) -> Value {
    let properties = Map::from_iter([("$schema".to_owned(), json!({ "type": "string" }))]);
    object_schema(properties, keys, Vec::new())
}

fn sweep() -> Value {
    object_schema(
        Map::new(),
        &[
            Key::required("path", "The key that is swept, with points between.", json!({ "type": "string" })),
            Key::required("values", "Its values.", json!({ "type": "array", "minItems": 1 })),
        ],
        Vec::new(),
    )
}

fn experiment() -> Value {
    root(&[
        Key::required("profile", "The extinction along the ray.", defined("profile")),
        Key::required("estimator", "The estimator of its transmittance.", defined("estimator")),
        Key::optional("samples", "Estimates; --samples stands for it.", whole(1)),
        Key::optional("seed", "The seed of all variates; --seed stands for it.", whole(0)),
        Key::optional("sweep", "One key, with many values.", sweep()),
    ])
}

fn scene() -> Value {
    let number = json!({ "type": "number" });
    let pixels = json!({ "type": "array", "items": whole(1), "minItems": 2, "maxItems": 2 });
    let camera = object_schema(
        Map::new(),
        &[
            Key::required("origin", "The pinhole.", vector_schema()),
            Key::required("look_at", "A point on the axis.", vector_schema()),
            Key::required("up", "A direction that is up in the image.", vector_schema()),
            Key::required("vertical_fov_degrees", "The vertical field of view.", number),
            Key::required("resolution", "Columns and rows.", pixels),
        ],
        Vec::new(),
    );
    let list = |of: &str| json!({ "type": "array", "items": defined(of) });
    root(&[
        Key::required("camera", "A pinhole camera.", camera),
        Key::optional("medium", "A medium that scatters.", defined("volume")),
        Key::required("lights", "Lights that are no surfaces.", list("light")),
        Key::optional("surfaces", "Surfaces, which may shine.", list("surface")),
        Key::required("integrator", "The estimator of a pixel.", defined("integrator")),
        Key::optional(
            "samples_per_pixel",
            "Estimates per pixel; --samples-per-pixel stands for it.",
            whole(1),
        ),
        Key::optional("seed", "The seed of all variates; --seed stands for it.", whole(0)),
        Key::optional(
            "allow_gain",
            "Whether albedo and reflectance may exceed 1.",
            json!({ "type": "boolean" }),
        ),
        Key::optional("sweep", "One key, with many values: an image for each.", sweep()),
    ])
}

/// The part of docs/SPEC.md that is made from the registries: a section for each thing, a table for each kind.
#[must_use]
pub fn tables() -> String {
    let mut text = String::new();
    for things in things() {
        let _ = writeln!(text, "### {}\n", things.title);
        for kind in things.kinds {
            let _ = writeln!(text, "**`{}`** {}\n", kind.name, plain(kind.about));
            if kind.keys.is_empty() {
                continue;
            }
            let _ = writeln!(text, "| key | |\n|---|---|");
            for key in kind.keys {
                let name =
                    if key.optional { format!("\\[`{}`\\]", key.name) } else { format!("`{}`", key.name) };
                let words = key.words().map_or_else(String::new, |words| format!(" One of {words}."));
                let _ = writeln!(text, "| {name} | {}{words} |", plain(key.about));
            }
            text.push('\n');
        }
    }
    text
}

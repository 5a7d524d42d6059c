//! A number, or one per channel.

use crate::Failure;
use crate::reader::Node;
use crate::reader::rule::Ruled;
use serde_json::{Value, json};

/// A gray or coloured quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColourSpec {
    /// The same in all channels.
    Gray(f64),
    /// Red, green and blue.
    Rgb([f64; 3]),
}

impl ColourSpec {
    /// Reads a number within `[0, most]`, or a list of three of them.
    ///
    /// # Errors
    /// If it is neither.
    pub fn read(node: &Node<'_>, most: f64) -> Result<Self, Failure> {
        let one = |node: &Node<'_>| {
            if most.is_finite() { node.within(0.0, most) } else { node.non_negative() }
        };
        if !node.is_list() {
            return one(node).map(Self::Gray);
        }
        let items = node.items()?;
        match items.as_slice() {
            [r, g, b] => Ok(Self::Rgb([one(r)?, one(g)?, one(b)?])),
            _ => Err(node.refuse("must be a number or a list of three, red, green and blue")),
        }
    }

    /// True if all channels have one value. A list of three equal numbers is gray.
    #[must_use]
    pub fn is_gray(&self) -> bool {
        let [r, g, b] = self.rgb();
        r == g && g == b
    }

    /// Red, green and blue.
    #[must_use]
    pub fn rgb(&self) -> [f64; 3] {
        match *self {
            Self::Gray(value) => [value; 3],
            Self::Rgb(rgb) => rgb,
        }
    }
}

/// A number of at least 0, or three.
impl Ruled for ColourSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        Self::read(node, f64::INFINITY)
    }
    fn written(&self) -> Value {
        match self {
            Self::Gray(value) => json!(value),
            Self::Rgb(values) => json!(values),
        }
    }
    fn schema() -> Value {
        let number = json!({ "type": "number", "minimum": 0 });
        json!({ "anyOf": [number, { "type": "array", "items": number, "minItems": 3, "maxItems": 3 }] })
    }
}

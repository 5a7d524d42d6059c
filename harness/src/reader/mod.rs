//! Reading of JSON: values with the path that leads to them, rules of keys, kinds of things with their keys, lists of kinds.

pub mod json;
pub mod kind;
mod node;
pub mod rule;
pub mod similar;

pub use kind::{Kind, Listed};
pub use node::{Node, Object};
pub use rule::Rule;

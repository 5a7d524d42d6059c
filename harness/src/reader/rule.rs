//! Rules of keys: what a value may be, how it is read, written and described.

use super::kind::Key;
use super::{Node, Object};
use crate::Failure;
use glam::DVec3;
use serde_json::{Map, Value, json};
use std::marker::PhantomData;
use std::num::NonZeroU32;
use std::path::PathBuf;

/// A rule that values of the type `T` keep.
pub trait Rule<T> {
    /// Reads a value.
    ///
    /// # Errors
    /// If it does not keep the rule; the refusal names the key.
    fn read(node: &Node<'_>) -> Result<T, Failure>;

    /// The JSON that reads back as the value; null for what was left out.
    fn written(value: &T) -> Value;

    /// The JSON Schema of all that keeps the rule.
    fn schema() -> Value;

    /// Takes the value of the key `name` from an object.
    ///
    /// # Errors
    /// If the key is missing and has no default, or its value does not keep the rule.
    fn take(object: &Object<'_>, name: &'static str, default: Option<fn() -> T>) -> Result<T, Failure> {
        match (object.optional(name), default) {
            (Some(node), _) => Self::read(&node),
            (None, Some(default)) => Ok(default()),
            (None, None) => object.required(name).and_then(|node| Self::read(&node)),
        }
    }

    /// Adds the key `name` to an object.
    fn put(value: &T, name: &'static str, object: &mut Map<String, Value>) {
        object.insert(name.to_owned(), Self::written(value));
    }

    /// The key as it is listed.
    fn keys(name: &'static str, about: &'static str, optional: bool) -> Vec<Key> {
        vec![Key { name, optional, about, schema: Self::schema() }]
    }
}

/// Defines a rule by how a value is read and by its JSON Schema; the value is written as serde writes it.
macro_rules! rules {
    ($($(#[$doc:meta])* $Rule:ident for $Type:ty { $read:expr, $schema:tt })+) => {
        $(
            $(#[$doc])*
            #[derive(Debug)]
            pub struct $Rule;

            impl Rule<$Type> for $Rule {
                fn read(node: &Node<'_>) -> Result<$Type, Failure> {
                    $read(node)
                }
                fn written(value: &$Type) -> Value {
                    json!(value)
                }
                fn schema() -> Value {
                    json!($schema)
                }
            }
        )+
    };
}

rules! {
    /// A finite number.
    Number for f64 { Node::number, { "type": "number" } }

    /// A number of at least 0.
    NonNegative for f64 { Node::non_negative, { "type": "number", "minimum": 0 } }

    /// A number above 0.
    Positive for f64 { Node::positive, { "type": "number", "exclusiveMinimum": 0 } }

    /// true or false.
    Flag for bool { Node::boolean, { "type": "boolean" } }

    /// A list of finite numbers, not empty.
    Numbers for Vec<f64> { Node::numbers, { "type": "array", "items": { "type": "number" }, "minItems": 1 } }

    /// A string.
    Text for String { |node: &Node<'_>| node.text().map(str::to_owned), { "type": "string" } }

    /// The path of a file, relative to the file in which it stands.
    File for PathBuf { Node::file, { "type": "string" } }
}

/// A whole number from `LEAST` to `MOST`.
#[derive(Debug)]
pub struct Whole<const LEAST: u64, const MOST: u64>;

impl<const LEAST: u64, const MOST: u64> Whole<LEAST, MOST> {
    fn number(node: &Node<'_>) -> Result<u64, Failure> {
        node.integer(LEAST, MOST)
    }
    fn described() -> Value {
        json!({ "type": "integer", "minimum": LEAST, "maximum": MOST })
    }
}

impl<const LEAST: u64, const MOST: u64> Rule<u64> for Whole<LEAST, MOST> {
    fn read(node: &Node<'_>) -> Result<u64, Failure> {
        Self::number(node)
    }
    fn written(value: &u64) -> Value {
        json!(value)
    }
    fn schema() -> Value {
        Self::described()
    }
}

/// `MOST` lies within 32 bits.
impl<const LEAST: u64, const MOST: u64> Rule<u32> for Whole<LEAST, MOST> {
    fn read(node: &Node<'_>) -> Result<u32, Failure> {
        Self::number(node).map(|number| number as u32)
    }
    fn written(value: &u32) -> Value {
        json!(value)
    }
    fn schema() -> Value {
        Self::described()
    }
}

/// `LEAST` is above 0, and `MOST` lies within 32 bits.
impl<const LEAST: u64, const MOST: u64> Rule<NonZeroU32> for Whole<LEAST, MOST> {
    fn read(node: &Node<'_>) -> Result<NonZeroU32, Failure> {
        Self::number(node).map(|number| NonZeroU32::new(number as u32).unwrap_or(NonZeroU32::MIN))
    }
    fn written(value: &NonZeroU32) -> Value {
        json!(value)
    }
    fn schema() -> Value {
        Self::described()
    }
}

/// Three finite numbers.
#[derive(Debug)]
pub struct Vector;

impl Rule<DVec3> for Vector {
    fn read(node: &Node<'_>) -> Result<DVec3, Failure> {
        node.vector()
    }
    fn written(value: &DVec3) -> Value {
        json!(value.to_array())
    }
    fn schema() -> Value {
        vector_schema()
    }
}

/// Three finite numbers that are not all 0.
#[derive(Debug)]
pub struct Direction;

impl Rule<DVec3> for Direction {
    fn read(node: &Node<'_>) -> Result<DVec3, Failure> {
        let vector = node.vector()?;
        if vector == DVec3::ZERO {
            return Err(node.refuse("must not be zero"));
        }
        Ok(vector)
    }
    fn written(value: &DVec3) -> Value {
        json!(value.to_array())
    }
    fn schema() -> Value {
        vector_schema()
    }
}

/// The JSON Schema of three numbers.
#[must_use]
pub fn vector_schema() -> Value {
    json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 })
}

/// An optional value: none, or one that keeps the rule `R`.
#[derive(Debug)]
pub struct Maybe<R>(PhantomData<R>);

impl<T, R: Rule<T>> Rule<Option<T>> for Maybe<R> {
    fn read(node: &Node<'_>) -> Result<Option<T>, Failure> {
        R::read(node).map(Some)
    }
    fn written(value: &Option<T>) -> Value {
        value.as_ref().map_or(Value::Null, R::written)
    }
    fn schema() -> Value {
        R::schema()
    }
}

/// A value that keeps the rule `R`, or null.
#[derive(Debug)]
pub struct Nullable<R>(PhantomData<R>);

impl<T, R: Rule<T>> Rule<Option<T>> for Nullable<R> {
    fn read(node: &Node<'_>) -> Result<Option<T>, Failure> {
        if node.is_null() { Ok(None) } else { R::read(node).map(Some) }
    }
    fn written(value: &Option<T>) -> Value {
        value.as_ref().map_or(Value::Null, R::written)
    }
    fn schema() -> Value {
        json!({ "anyOf": [R::schema(), { "type": "null" }] })
    }
}

/// A type with one rule of its own.
pub trait Ruled: Sized {
    /// See [`Rule::read`].
    ///
    /// # Errors
    /// See [`Rule::read`].
    fn read(node: &Node<'_>) -> Result<Self, Failure>;

    /// See [`Rule::written`].
    fn written(&self) -> Value;

    /// See [`Rule::schema`].
    fn schema() -> Value;
}

/// The rule that a type brings with it.
#[derive(Debug)]
pub struct Own;

impl<T: Ruled> Rule<T> for Own {
    fn read(node: &Node<'_>) -> Result<T, Failure> {
        T::read(node)
    }
    fn written(value: &T) -> Value {
        value.written()
    }
    fn schema() -> Value {
        T::schema()
    }
}

/// Defines a rule: one of some words, each of which stands for a value.
#[macro_export]
macro_rules! words {
    ($(#[$doc:meta])* $vis:vis $Rule:ident for $Type:ty { $($word:literal => $value:expr),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Debug)]
        $vis struct $Rule;

        impl $Rule {
            /// The words, with what they stand for.
            $vis const WORDS: &'static [(&'static str, $Type)] = &[$(($word, $value)),+];
        }

        impl $crate::reader::Rule<$Type> for $Rule {
            fn read(node: &$crate::reader::Node<'_>) -> Result<$Type, $crate::Failure> {
                $crate::reader::rule::word(node, Self::WORDS)
            }
            fn written(value: &$Type) -> serde_json::Value {
                $crate::reader::rule::written_word(value, Self::WORDS)
            }
            fn schema() -> serde_json::Value {
                serde_json::json!({ "enum": [$($word),+] })
            }
        }
    };
}

/// The value of a word.
///
/// # Errors
/// If it is none of the words.
pub fn word<T: Copy>(node: &Node<'_>, words: &[(&str, T)]) -> Result<T, Failure> {
    let text = node.text()?;
    words.iter().find(|(word, _)| *word == text).map(|&(_, value)| value).ok_or_else(|| {
        let words: Vec<&str> = words.iter().map(|&(word, _)| word).collect();
        node.refuse(format!("must be {}", one_of(&words)))
    })
}

/// The word of a value; null where no word stands for it.
pub fn written_word<T: PartialEq>(value: &T, words: &[(&str, T)]) -> Value {
    words.iter().find(|(_, known)| known == value).map_or(Value::Null, |&(word, _)| json!(word))
}

/// `a, b or c`
#[must_use]
pub fn one_of(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

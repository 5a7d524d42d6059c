//! One key of a spec with many values.

use crate::Failure;
use crate::reader::Node;
use crate::reader::rule::one_of;
use serde_json::Value;

/// The request of a file: one thing, or one for each value of a swept key.
#[derive(Clone, Debug, PartialEq)]
pub enum Request<T> {
    /// One thing.
    Single(Box<T>),
    /// One thing per value.
    Sweep(Sweep<T>),
}

/// The points of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep<T> {
    /// The swept key, with points between.
    pub path: String,
    /// The value of the swept key, and what is asked for with it.
    pub points: Vec<(Value, T)>,
}

impl<T> Request<T> {
    /// Reads a spec, one of whose keys in `parts` may be swept.
    ///
    /// # Errors
    /// If the sweep is none, or a point is refused.
    pub(super) fn of(
        spec: &Value,
        parts: &[&str],
        read: impl Fn(&Value) -> Result<T, Failure>,
    ) -> Result<Self, Failure> {
        let root = Node::root(spec).object()?;
        let Some(sweep) = root.optional("sweep") else { return Ok(Self::Single(Box::new(read(spec)?))) };
        let object = sweep.object()?;
        let path_node = object.required("path")?;
        let path = path_node.text()?;
        let values = object.required("values")?;
        let items = values.items()?;
        object.finish()?;
        if items.is_empty() {
            return Err(values.refuse("must be a list of at least one value"));
        }
        let points = items.iter().map(|item| {
            let mut point = spec.clone();
            let target = locate(&mut point, path, parts)
                .ok_or_else(|| path_node.refuse(format!("must name a key of {}", one_of(parts))))?;
            *target = item.value().clone();
            Ok((item.value().clone(), read(&point)?))
        });
        let points = points.collect::<Result<_, Failure>>()?;
        Ok(Self::Sweep(Sweep { path: path.to_owned(), points }))
    }

    /// The swept key, if there is one.
    #[must_use]
    pub fn path(&self) -> Option<&str> {
        match self {
            Self::Single(_) => None,
            Self::Sweep(sweep) => Some(&sweep.path),
        }
    }

    /// The requests one by one, each with the value of the swept key, if there is one.
    #[must_use]
    pub fn points(&self) -> Vec<(Option<&Value>, &T)> {
        match self {
            Self::Single(single) => vec![(None, single)],
            Self::Sweep(sweep) => sweep.points.iter().map(|(value, point)| (Some(value), point)).collect(),
        }
    }
}

/// The place that a dotted path names in one of the `parts`, made if only its last key is missing.
fn locate<'a>(spec: &'a mut Value, path: &str, parts: &[&str]) -> Option<&'a mut Value> {
    let mut keys = path.split('.').peekable();
    if !keys.peek().is_some_and(|first| parts.contains(first)) {
        return None;
    }
    let mut place = spec;
    while let Some(key) = keys.next() {
        let last = keys.peek().is_none();
        place = match place {
            Value::Object(map) => {
                if last && !map.contains_key(key) {
                    map.insert(key.to_owned(), Value::Null);
                }
                map.get_mut(key)?
            }
            Value::Array(items) => items.get_mut(key.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(place)
}

//! A JSON value together with the path that leads to it, so that every refusal names its key.

use super::similar;
use crate::Failure;
use glam::DVec3;
use serde_json::{Map, Value};
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// A value of the spec, and where it stands.
#[derive(Clone, Debug)]
pub struct Node<'a> {
    value: &'a Value,
    path: String,
    /// The folder to which paths of files are relative.
    base: &'a Path,
}

/// An object whose keys are taken one by one; what is left at the end is unknown.
#[derive(Debug)]
pub struct Object<'a> {
    map: &'a Map<String, Value>,
    path: String,
    base: &'a Path,
    taken: RefCell<Vec<&'static str>>,
}

impl<'a> Node<'a> {
    /// The root of a spec: its path is empty. Paths of files are relative to the working directory.
    #[must_use]
    pub fn root(value: &'a Value) -> Self {
        Self::root_in(value, Path::new(""))
    }

    /// The root of a spec whose paths of files are relative to the folder `base`.
    #[must_use]
    pub fn root_in(value: &'a Value, base: &'a Path) -> Self {
        Self { value, path: String::new(), base }
    }

    fn child(&self, key: impl std::fmt::Display, value: &'a Value) -> Self {
        Self { value, path: join(&self.path, key), base: self.base }
    }

    /// A refusal that names this key, what was found and what is allowed.
    pub fn refuse(&self, allowed: impl std::fmt::Display) -> Failure {
        let path = if self.path.is_empty() { "the spec" } else { &self.path };
        Failure::refused(format!("{path}: {allowed}, found {}", excerpt(self.value)))
    }

    /// A refusal of this key for a reason of its own.
    pub fn reject(&self, reason: impl std::fmt::Display) -> Failure {
        Failure::refused(format!("{}: {reason}", self.path))
    }

    /// This value as an object.
    ///
    /// # Errors
    /// If it is none.
    pub fn object(&self) -> Result<Object<'a>, Failure> {
        let map = self.value.as_object().ok_or_else(|| self.refuse("must be an object"))?;
        Ok(Object { map, path: self.path.clone(), base: self.base, taken: RefCell::default() })
    }

    /// The value below this one to which keys lead, with points between them.
    ///
    /// # Errors
    /// If there is none.
    pub fn at(&self, keys: &str) -> Result<Self, Failure> {
        keys.split('.').try_fold(self.clone(), |node, key| {
            let value = node.value.get(key);
            value.map(|value| node.child(key, value)).ok_or_else(|| node.refuse(format!("must have {key}")))
        })
    }

    /// A bare value, or what the keys of an object say; `allowed` names both.
    ///
    /// # Errors
    /// If it is neither, or a key is missing, unknown or wrong.
    pub fn bare_or_object<T>(
        &self,
        allowed: &str,
        bare: impl FnOnce(&Self) -> Result<T, Failure>,
        keys: impl FnOnce(&Object<'a>) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        if !self.is_object() {
            return bare(self).map_err(|_| self.refuse(allowed));
        }
        let object = self.object()?;
        let value = keys(&object)?;
        object.finish()?;
        Ok(value)
    }

    /// True if this value is an object.
    #[must_use]
    pub fn is_object(&self) -> bool {
        self.value.is_object()
    }

    /// True if this value is null.
    #[must_use]
    pub fn is_null(&self) -> bool {
        self.value.is_null()
    }

    /// True if this value is a list.
    #[must_use]
    pub fn is_list(&self) -> bool {
        self.value.is_array()
    }

    /// A finite number.
    ///
    /// # Errors
    /// If it is none.
    pub fn number(&self) -> Result<f64, Failure> {
        match self.value.as_f64() {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.refuse("must be a finite number")),
        }
    }

    /// A finite number of at least 0.
    ///
    /// # Errors
    /// If it is none.
    pub fn non_negative(&self) -> Result<f64, Failure> {
        match self.number() {
            Ok(number) if number >= 0.0 => Ok(number),
            _ => Err(self.refuse("must be a number of at least 0")),
        }
    }

    /// A finite number above 0.
    ///
    /// # Errors
    /// If it is none.
    pub fn positive(&self) -> Result<f64, Failure> {
        match self.number() {
            Ok(number) if number > 0.0 => Ok(number),
            _ => Err(self.refuse("must be a number above 0")),
        }
    }

    /// A number within `[least, most]`.
    ///
    /// # Errors
    /// If it is none.
    pub fn within(&self, least: f64, most: f64) -> Result<f64, Failure> {
        match self.number() {
            Ok(number) if (least..=most).contains(&number) => Ok(number),
            _ => Err(self.refuse(format!("must be a number from {least} to {most}"))),
        }
    }

    /// A whole number within `[least, most]`. Numbers such as 1e6 are whole.
    ///
    /// # Errors
    /// If it is none.
    pub fn integer(&self, least: u64, most: u64) -> Result<u64, Failure> {
        let exact = self.value.as_u64().or_else(|| {
            let number = self.value.as_f64()?;
            // Above 2^53 a double no longer tells neighbouring integers apart.
            (number.fract() == 0.0 && (0.0..=9.007_199_254_740_992e15).contains(&number))
                .then_some(number as u64)
        });
        match exact {
            Some(number) if (least..=most).contains(&number) => Ok(number),
            _ => Err(self.refuse(format!("must be a whole number from {least} to {most}"))),
        }
    }

    /// A string.
    ///
    /// # Errors
    /// If it is none.
    pub fn text(&self) -> Result<&'a str, Failure> {
        self.value.as_str().ok_or_else(|| self.refuse("must be a string"))
    }

    /// The path of a file.
    ///
    /// # Errors
    /// If it is no string.
    pub fn file(&self) -> Result<PathBuf, Failure> {
        self.text().map(|text| self.base.join(text))
    }

    /// true or false.
    ///
    /// # Errors
    /// If it is neither.
    pub fn boolean(&self) -> Result<bool, Failure> {
        self.value.as_bool().ok_or_else(|| self.refuse("must be true or false"))
    }

    /// The items of a list.
    ///
    /// # Errors
    /// If it is no list.
    pub fn items(&self) -> Result<Vec<Node<'a>>, Failure> {
        let items = self.value.as_array().ok_or_else(|| self.refuse("must be a list"))?;
        Ok(items.iter().enumerate().map(|(i, item)| self.child(i, item)).collect())
    }

    /// A list of finite numbers, not empty.
    ///
    /// # Errors
    /// If it is no such list.
    pub fn numbers(&self) -> Result<Vec<f64>, Failure> {
        let items = self.items()?;
        if items.is_empty() {
            return Err(self.refuse("must be a list of at least one number"));
        }
        items.iter().map(Node::number).collect()
    }

    /// Three finite numbers.
    ///
    /// # Errors
    /// If it is no list of three numbers.
    pub fn vector(&self) -> Result<DVec3, Failure> {
        match self.numbers()?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(self.refuse("must be a list of three numbers")),
        }
    }

    /// As many whole numbers within `[least, most]`.
    ///
    /// # Errors
    /// If it is no list of so many of them.
    pub fn integers<const N: usize>(&self, least: u32, most: u32) -> Result<[u32; N], Failure> {
        let items = self.items()?;
        let numbers = items.iter().map(|item| item.integer(u64::from(least), u64::from(most)));
        let numbers = numbers.map(|number| number.map(|number| number as u32));
        let numbers: Vec<u32> = numbers.collect::<Result<_, Failure>>()?;
        numbers.try_into().map_err(|_| self.refuse(format!("must be a list of {N} whole numbers")))
    }

    /// The value as it stands.
    #[must_use]
    pub fn value(&self) -> &'a Value {
        self.value
    }
}

impl<'a> Object<'a> {
    /// True if the object has a key.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.map.contains_key(key)
    }

    /// A refusal of the whole object for a reason.
    pub fn reject(&self, reason: impl std::fmt::Display) -> Failure {
        Failure::refused(format!("{}: {reason}", self.path))
    }

    /// The value of a key that may be absent.
    pub fn optional(&self, key: &'static str) -> Option<Node<'a>> {
        self.taken.borrow_mut().push(key);
        self.map.get(key).map(|value| Node { value, path: join(&self.path, key), base: self.base })
    }

    /// The value of a key.
    ///
    /// # Errors
    /// If the key is missing.
    pub fn required(&self, key: &'static str) -> Result<Node<'a>, Failure> {
        self.optional(key).ok_or_else(|| {
            let taken = self.taken.borrow();
            let others = self.map.keys().map(String::as_str).filter(|other| !taken.contains(other));
            let slip = similar::nearest(key, others)
                .map_or_else(String::new, |other| format!(", but there is {other} (did you mean {key}?)"));
            Failure::refused(format!("{}: this key is missing{slip}", join(&self.path, key)))
        })
    }

    /// Refuses every key that was not taken, but for `$schema`: with it editors check and complete a file.
    ///
    /// # Errors
    /// If there is one.
    pub fn finish_root(self) -> Result<(), Failure> {
        if self.map.contains_key("$schema") {
            self.taken.borrow_mut().push("$schema");
        }
        self.finish()
    }

    /// Refuses every key that was not taken.
    ///
    /// # Errors
    /// If there is one.
    pub fn finish(self) -> Result<(), Failure> {
        let taken = self.taken.into_inner();
        match self.map.keys().find(|key| !taken.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => Err(Failure::refused(format!(
                "{}: unknown key{}, allowed here: {}",
                join(&self.path, key),
                similar::meant(key, taken.iter().copied()),
                taken.join(", ")
            ))),
        }
    }
}

fn join(path: &str, key: impl std::fmt::Display) -> String {
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

/// A value short enough for one line.
fn excerpt(value: &Value) -> String {
    const LONGEST: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        text
    } else {
        format!("{} …", text.chars().take(LONGEST).collect::<String>())
    }
}

//! Kinds: a thing that a spec can ask for, declared once with its keys; lists of kinds.

use super::{Node, Object, Rule, similar};
use crate::Failure;
use serde_json::{Map, Value, json};

/// One key of a kind.
#[derive(Clone, Debug)]
pub struct Key {
    /// The name.
    pub name: &'static str,
    /// True if the key may be left out.
    pub optional: bool,
    /// The quantity, with its unit.
    pub about: &'static str,
    /// The JSON Schema of its values.
    pub schema: Value,
}

impl Key {
    /// A key that must be there.
    #[must_use]
    pub fn required(name: &'static str, about: &'static str, schema: Value) -> Self {
        Self { name, optional: false, about, schema }
    }

    /// A key that may be left out.
    #[must_use]
    pub fn optional(name: &'static str, about: &'static str, schema: Value) -> Self {
        Self { name, optional: true, about, schema }
    }

    /// The words that it takes, where it takes words only.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let words = self.schema.get("enum")?.as_array()?;
        Some(words.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", "))
    }
}

/// A group of keys.
pub trait Keys: Sized {
    /// Takes the keys from an object.
    ///
    /// # Errors
    /// If one is missing or does not keep its rule.
    fn take_from(object: &Object<'_>) -> Result<Self, Failure>;

    /// Adds the keys to an object; those that were left out are null.
    fn write_to(&self, object: &mut Map<String, Value>);

    /// The keys, in the order in which they are read.
    fn keys() -> Vec<Key>;
}

/// A kind of a thing, with its keys.
pub trait Kind: Keys {
    /// The value of `kind`.
    const NAME: &'static str;
    /// The quantity or method, and where it comes from.
    const ABOUT: &'static str;

    /// Refuses keys that do not go together, each of which keeps its rule.
    ///
    /// # Errors
    /// If some do not.
    fn check(&self, _object: &Object<'_>) -> Result<(), Failure> {
        Ok(())
    }
}

/// The rule of a group of keys: they stand among those of the object.
#[derive(Debug)]
pub struct Among;

impl<T: Keys> Rule<T> for Among {
    fn read(node: &Node<'_>) -> Result<T, Failure> {
        let object = node.object()?;
        let group = T::take_from(&object)?;
        object.finish()?;
        Ok(group)
    }
    fn written(group: &T) -> Value {
        let mut object = Map::new();
        group.write_to(&mut object);
        Value::Object(object)
    }
    fn schema() -> Value {
        group_schema::<T>()
    }
    fn take(object: &Object<'_>, _name: &'static str, _default: Option<fn() -> T>) -> Result<T, Failure> {
        T::take_from(object)
    }
    fn put(group: &T, _name: &'static str, object: &mut Map<String, Value>) {
        group.write_to(object);
    }
    fn keys(_name: &'static str, _about: &'static str, _optional: bool) -> Vec<Key> {
        T::keys()
    }
}

/// The JSON Schema of an object that holds a group of keys and no others.
#[must_use]
pub fn group_schema<T: Keys>() -> Value {
    object_schema(Map::new(), &T::keys(), Vec::new())
}

/// The JSON Schema of an object with some properties, and keys beside them.
pub(crate) fn object_schema(
    mut properties: Map<String, Value>,
    keys: &[Key],
    mut required: Vec<&str>,
) -> Value {
    for key in keys {
        let mut schema = key.schema.clone();
        if let Value::Object(map) = &mut schema {
            map.insert("description".to_owned(), json!(plain(key.about)));
        }
        properties.insert(key.name.to_owned(), schema);
        if !key.optional {
            required.push(key.name);
        }
    }
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

/// The text of a doc comment without its escapes.
#[must_use]
pub fn plain(doc: &str) -> String {
    doc.trim().replace("\\[", "[").replace("\\]", "]")
}

/// One kind of a list.
#[derive(Clone, Debug)]
pub struct Listed {
    /// The value of `kind`.
    pub name: &'static str,
    /// The quantity or method, and where it comes from.
    pub about: &'static str,
    /// The keys of the kind.
    pub keys: Vec<Key>,
}

impl Listed {
    /// A kind as it is listed.
    #[must_use]
    pub fn of<K: Kind>() -> Self {
        Self { name: K::NAME, about: K::ABOUT.trim(), keys: K::keys() }
    }

    /// The same kind with keys beside its own.
    #[must_use]
    pub fn with(mut self, keys: Vec<Key>) -> Self {
        self.keys.extend(keys);
        self
    }

    /// The JSON Schema of an object of this kind.
    #[must_use]
    pub fn schema(&self) -> Value {
        let properties = Map::from_iter([("kind".to_owned(), json!({ "const": self.name }))]);
        let mut schema = object_schema(properties, &self.keys, vec!["kind"]);
        schema["description"] = json!(plain(self.about));
        schema
    }
}

/// Reads an object whose key `kind` says what it is.
///
/// # Errors
/// If the kind is none of `names`, or its keys are refused.
pub fn read_listed<T>(
    node: &Node<'_>,
    names: &[&str],
    take: impl FnOnce(&str, &Object<'_>) -> Option<Result<T, Failure>>,
) -> Result<T, Failure> {
    let object = node.object()?;
    let read = take_listed(&object, names, take)?;
    object.finish()?;
    Ok(read)
}

/// Takes from an object whose key `kind` says what it is, and which may have other keys beside those of the kind.
///
/// # Errors
/// If the kind is none of `names`, or its keys are refused.
pub fn take_listed<T>(
    object: &Object<'_>,
    names: &[&str],
    take: impl FnOnce(&str, &Object<'_>) -> Option<Result<T, Failure>>,
) -> Result<T, Failure> {
    let kind = object.required("kind")?;
    let name = kind.text()?;
    take(name, object).unwrap_or_else(|| {
        let meant = similar::meant(name, names.iter().copied());
        Err(kind.refuse(format!("must be {}{meant}", super::rule::one_of(names))))
    })
}

/// Takes a kind and checks which of its keys go together.
///
/// # Errors
/// If a key is refused.
pub fn take<K: Kind>(object: &Object<'_>) -> Result<K, Failure> {
    let kind = K::take_from(object)?;
    kind.check(object)?;
    Ok(kind)
}

/// An object of a kind, without the keys that were left out.
pub fn written<K: Kind>(kind: &K) -> Value {
    let mut object = Map::new();
    object.insert("kind".to_owned(), json!(K::NAME));
    kind.write_to(&mut object);
    object.retain(|_, value| !value.is_null());
    Value::Object(object)
}

/// Defines a group of keys: a struct whose fields are its keys, each with a type, a rule, and `= value` where it may be left out.
#[macro_export]
macro_rules! keys {
    (
        $(#[doc = $about:literal])+
        $vis:vis $Name:ident {
            $($(#[doc = $doc:literal])+ $key:ident : $Type:ty as $Rule:ty $(= $default:expr)?),* $(,)?
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        $vis struct $Name { $($(#[doc = $doc])+ pub $key: $Type),* }

        impl $crate::reader::kind::Keys for $Name {
            fn take_from(object: &$crate::reader::Object<'_>) -> Result<Self, $crate::Failure> {
                let _ = object;
                Ok(Self { $($key: <$Rule as $crate::reader::Rule<$Type>>::take(
                    object,
                    stringify!($key),
                    $crate::keys!(@default $Type $(, $default)?),
                )?),* })
            }

            fn write_to(&self, object: &mut serde_json::Map<String, serde_json::Value>) {
                let _ = &object;
                $(<$Rule as $crate::reader::Rule<$Type>>::put(&self.$key, stringify!($key), object);)*
            }

            fn keys() -> Vec<$crate::reader::kind::Key> {
                let keys: Vec<Vec<$crate::reader::kind::Key>> =
                    vec![$(<$Rule as $crate::reader::Rule<$Type>>::keys(
                        stringify!($key),
                        concat!($($doc),+).trim_ascii(),
                        $crate::keys!(@optional $($default)?),
                    )),*];
                keys.into_iter().flatten().collect()
            }
        }
    };
    (@default $Type:ty) => { None };
    (@default $Type:ty, $default:expr) => { Some(|| $default) };
    (@optional) => { false };
    (@optional $default:expr) => { true };
}

/// Defines a kind: a group of keys with a name. A last line `check function` says which keys go together.
///
/// ```ignore
/// kind! {
///     /// Track length: 1 if a flight escapes, else 0 (raab-2008 algorithm 1).
///     WoodcockSpec = "woodcock" {
///         /// An upper bound of σ_t [1/length].
///         majorant: f64 as NonNegative,
///     }
/// }
/// ```
#[macro_export]
macro_rules! kind {
    (
        $(#[doc = $about:literal])+
        $Name:ident = $name:literal { $($keys:tt)* }
        $(check $check:expr)?
    ) => {
        $crate::keys! { $(#[doc = $about])+ pub $Name { $($keys)* } }

        impl $crate::reader::Kind for $Name {
            const NAME: &'static str = $name;
            const ABOUT: &'static str = concat!($($about),+);

            $(fn check(&self, object: &$crate::reader::Object<'_>) -> Result<(), $crate::Failure> {
                let check: fn(&Self, &$crate::reader::Object<'_>) -> Result<(), $crate::Failure> = $check;
                check(self, object)
            })?
        }
    };
}

/// Defines the list of all kinds of a thing: an enum, its reader and writer, its names.
#[macro_export]
macro_rules! registry {
    ($(#[$doc:meta])* $Name:ident $(: $Trait:path)? $(as $definition:literal)? { $($Variant:ident($Kind:ty)),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $Name { $(#[doc = concat!("`", stringify!($Kind), "`.")] $Variant($Kind)),+ }

        $(impl From<$Kind> for $Name {
            fn from(kind: $Kind) -> Self {
                Self::$Variant(kind)
            }
        })+

        impl $Name {
            /// The values of `kind`.
            pub const NAMES: &'static [&'static str] = &[$(<$Kind as $crate::reader::Kind>::NAME),+];

            /// Reads an object of one of these kinds.
            ///
            /// # Errors
            /// If a key is missing, unknown, or does not keep its rule.
            pub fn read(node: &$crate::reader::Node<'_>) -> Result<Self, $crate::Failure> {
                $crate::reader::kind::read_listed(node, Self::NAMES, Self::take_from)
            }

            /// Takes the keys of the kind `name` from an object; `None` if there is no such kind.
            pub fn take_from(
                name: &str,
                object: &$crate::reader::Object<'_>,
            ) -> Option<Result<Self, $crate::Failure>> {
                $(if name == <$Kind as $crate::reader::Kind>::NAME {
                    return Some($crate::reader::kind::take::<$Kind>(object).map(Self::$Variant));
                })+
                None
            }

            /// Takes one of these kinds from an object that may have other keys as well.
            ///
            /// # Errors
            /// If a key is missing, or does not keep its rule.
            pub fn take(object: &$crate::reader::Object<'_>) -> Result<Self, $crate::Failure> {
                $crate::reader::kind::take_listed(object, Self::NAMES, Self::take_from)
            }

            /// The JSON that reads back as it.
            #[must_use]
            pub fn written(&self) -> serde_json::Value {
                match self { $(Self::$Variant(kind) => $crate::reader::kind::written(kind)),+ }
            }

            /// The value of its key `kind`.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self { $(Self::$Variant(_) => <$Kind as $crate::reader::Kind>::NAME),+ }
            }

            /// All kinds, as they are listed.
            #[must_use]
            pub fn listed() -> Vec<$crate::reader::Listed> {
                vec![$($crate::reader::Listed::of::<$Kind>()),+]
            }
        }

        $crate::registry!(@object $Name { $($Variant),+ } $($Trait)?);

        $(impl $crate::reader::rule::Ruled for $Name {
            fn read(node: &$crate::reader::Node<'_>) -> Result<Self, $crate::Failure> {
                Self::read(node)
            }
            fn written(&self) -> serde_json::Value {
                Self::written(self)
            }
            fn schema() -> serde_json::Value {
                serde_json::json!({ "$ref": concat!("#/$defs/", $definition) })
            }
        })?
    };
    (@object $Name:ident { $($Variant:ident),+ }) => {};
    (@object $Name:ident { $($Variant:ident),+ } $Trait:path) => {
        impl $Name {
            /// The kind itself.
            #[must_use]
            pub fn kind(&self) -> &dyn $Trait {
                match self { $(Self::$Variant(kind) => kind),+ }
            }
        }
    };
}

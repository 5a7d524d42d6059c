//! JSON as a file or a stream gives it: what is not, is named as what it is.

use crate::Failure;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use std::fmt;

/// The value of a text.
///
/// # Errors
/// If the text is no JSON or more than that, or an object has a key twice: the first would be lost without a word.
pub fn parse(text: &str) -> Result<Value, Failure> {
    if text.trim().is_empty() {
        return Err(Failure::refused("not JSON: it is empty"));
    }
    serde_json::from_str::<Strict>(text).map(|strict| strict.0).map_err(|error| {
        let message = error.to_string();
        Failure::refused(match message.strip_prefix("trailing characters") {
            Some(place) => format!("not JSON alone: there is more text after the end of the JSON,{place}"),
            None => format!("not JSON: {message}"),
        })
    })
}

/// The text of bytes.
///
/// # Errors
/// If it is an OpenVDB file, or no text at all.
pub fn text(bytes: Vec<u8>) -> Result<String, Failure> {
    /// The first bytes of an OpenVDB file.
    const OPENVDB: &[u8] = b" BDV";
    if bytes.starts_with(OPENVDB) {
        return Err(Failure::refused(
            "an OpenVDB file, not JSON: name it in a medium, { \"kind\": \"vdb\", \"file\": … }",
        ));
    }
    String::from_utf8(bytes).map_err(|error| Failure::refused(format!("not JSON: {error}")))
}

/// A value whose objects have each key once.
struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader).map(Self)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }
    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Number::from_f64(value).map_or(Value::Null, Value::Number))
    }
    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Strict(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(list.into())
    }
    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format_args!("the key `{key}` stands twice")));
            }
            let Strict(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(object.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reads_what_serde_json_reads() {
        for text in [
            "null",
            "[1, -2, 2.5, 1e300, true, \"a\\u00e9\", {\"b\": [], \"a\": {}}]",
            "18446744073709551615",
        ] {
            assert_eq!(parse(text).unwrap(), serde_json::from_str::<Value>(text).unwrap(), "{text}");
        }
    }

    #[test]
    fn what_is_no_json_is_named() {
        let refused = |text: &str| parse(text).unwrap_err().to_string();
        assert!(
            refused("{\"a\": 1, \"b\": {\"c\": 1, \"c\": 2}}").contains("the key `c` stands twice at line 1")
        );
        assert!(refused("{} {}").contains("more text after the end of the JSON, at line 1 column 4"));
        assert!(refused(" \n").contains("empty"));
        let volume = text(b" BDV\0\0\0\0\xe0\0\0\0".to_vec()).unwrap_err().to_string();
        assert!(volume.contains("OpenVDB") && volume.contains("\"vdb\""), "{volume}");
        assert!(text(vec![0xff, 0xfe]).is_err());
    }
}

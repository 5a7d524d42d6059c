//! Refusals: one line, not empty, with the place in front.

use fairflight_harness::{Failure, REFUSED};

/// Panics unless a refusal has its exit code and is one line of the form `place: reason`.
pub(crate) fn check(failure: &Failure) {
    assert_eq!(failure.code(), REFUSED, "{failure}");
    let text = failure.to_string();
    let reason = text.strip_prefix("refused: ").expect("a refusal says that it is one");
    assert!(!text.chars().any(char::is_control), "more than a line of text: {text:?}");
    let (place, why) = reason.split_once(": ").unwrap_or_else(|| panic!("no place in {text:?}"));
    assert!(!place.is_empty() && !why.trim().is_empty(), "neither place nor reason in {text:?}");
}

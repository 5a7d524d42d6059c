//! Promises of every judgement: its false alarm, its power, and when agreement says something.

/// False alarm of one call that reports promise.
pub const DEFAULT_ALPHA: f64 = 1e-6;

/// Power at which the detectable bias is stated.
pub const POWER: f64 = 0.99;

/// Greatest detectable relative bias at which agreement still says something.
///
/// An error in an estimator's formula (a factor forgotten, a probability inverted) rarely moves the mean by less than
/// half; a run that could not even see half of the mean gone is no evidence.
pub const MAX_DETECTABLE_RELATIVE_BIAS: f64 = 0.5;

/// Outcome of a test: `Some(true)` = agrees, `Some(false)` = differs, `None` = not testable.
pub(crate) type Outcome = Option<bool>;

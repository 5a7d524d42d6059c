//! How a statistical check is run.

/// What a statistical check is given: everything that its numbers depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// How many samples to draw.
    pub samples: u64,
    /// The seed of the check: two checks of one run must not share it ([`fairflight_sources::derive_seed`]).
    pub seed: u64,
    /// The false alarm that the whole check may have. For a family of checks: [`fairflight_stats::sidak_level`].
    pub alpha: f64,
}

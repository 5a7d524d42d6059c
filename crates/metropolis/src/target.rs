//! Targets: what a chain follows.

use fairflight_sources::UniformSource;

/// A function f* ≥ 0 of states x, one of which is present and another proposed, with what each adds to an image.
///
/// **Law.** With W what [`draw`](Self::draw) returns, x the state that it proposes, and h any bounded function of states:
///
/// ```text
/// E[W h(x)] = ∫ f* h                            draw: any density that is positive where f* is, W = f*/density
/// E[W a (h(y) − h(x))] = 0                      propose: y with acceptance a, from the x that was drawn and accepted
/// E[W deposit(x, energy)] = energy · image      deposit: F/f*, of which the expectation over f* is that of F
/// ```
///
/// The second says that a step keeps f* ([`laws`](crate::laws)).
pub trait Target<C> {
    /// Draws a state independently of all before, as the proposal; returns W = f*/density, which is not finite where the contribution is not.
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64;

    /// Draws a proposal from the present state, one for which f* is positive.
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed;

    /// Makes the proposal the present state.
    fn accept(&mut self);

    /// Adds energy · F/f* of a state to the film, pixel by pixel; nothing where f* = 0.
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, C>);

    /// Names of the kinds of proposals.
    fn kinds(&self) -> &[&'static str];

    /// ln f* of the present state up to a constant, by which a chain's [autocorrelation](fairflight_stats::Autocorrelation) is told; NaN where that is not
    /// known. The logarithm, since f* of paths has no variance where they come close to a corner or to each other.
    fn ln_present(&self) -> f64 {
        f64::NAN
    }
}

/// What sees each contribution to an image: the pixel (column, row), and the value.
pub type Film<'f, C> = dyn FnMut([u32; 2], C) + 'f;

/// Either state of a [`Target`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The state of the chain.
    Present,
    /// What was drawn or proposed last.
    Proposed,
}

/// A proposal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposed {
    /// Index into [`Target::kinds`].
    pub kind: usize,
    /// The probability to accept it, min(1, ratio) (antwerpen-2011 eq. 6.2); NaN where f* of the proposal is not finite, which is refused.
    pub acceptance: f64,
}

/// Number of proposals of a kind, and the sum of their acceptances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Acceptance {
    /// Proposals made.
    pub proposed: u64,
    /// Sum of the probabilities to accept them.
    pub accepted: f64,
}

impl Acceptance {
    /// Mean probability to accept a proposal; `None` without any.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.proposed > 0).then(|| self.accepted / self.proposed as f64)
    }

    /// Adds what another replica counted.
    pub fn merge(&mut self, other: &Self) {
        self.proposed += other.proposed;
        self.accepted += other.accepted;
    }
}

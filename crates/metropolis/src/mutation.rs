//! One step of a chain.

use fairflight_elementary::exp;
use fairflight_sources::UniformSource;

/// Proposal of a chain's next state, which a target f gives its acceptance.
///
/// **Law.** With a = min(1, ratio) the step keeps f and is reversible: of any X with density p > 0 where f > 0, and W = f/p,
///
/// ```text
/// E[ W a (g(Y) − g(X)) ] = 0      for every bounded g
/// E[ W a h(X, Y) ] = 0            for every bounded h with h(X, Y) = −h(Y, X)
/// ```
///
/// ([`laws`](crate::laws)). The second is detailed balance (antwerpen-2011 eq. 6.1), and contains the first.
///
/// A mutation that moves symmetrically in coordinates c of its own has the ratio f(Y) J(Y)/(f(X) J(X)) with J = |dx/dc|; one that chooses
/// among kinds or places has the probability of its choice at either state in it as well.
pub trait Mutation<X> {
    /// Draws a proposal into `y`, whatever that was before, and returns ln f(Y) T(X|Y)/(f(X) T(Y|X)) (antwerpen-2011 eq. 6.7); `None` where f(Y) = 0, or
    /// where the mutation does not fit `x`: a rejection.
    fn propose(&mut self, x: &X, y: &mut X, source: &mut dyn UniformSource) -> Option<f64>;
}

/// The probability to accept a proposal: min(1, ratio) (antwerpen-2011 eq. 6.2).
#[inline]
#[must_use]
pub fn acceptance(ln_ratio: Option<f64>) -> f64 {
    ln_ratio.map_or(0.0, |ln| {
        debug_assert!(!ln.is_nan(), "a ratio that is no number");
        exp(ln.min(0.0))
    })
}

#[cfg(test)]
mod tests {
    use super::acceptance;

    #[test]
    fn the_acceptance_is_the_ratio_and_at_most_one() {
        assert_eq!(
            [None, Some(f64::NEG_INFINITY), Some(0.0), Some(3.0)].map(acceptance),
            [0.0, 0.0, 1.0, 1.0]
        );
        assert!((acceptance(Some(-2.0)) - (-2f64).exp()).abs() < 1e-16);
    }
}

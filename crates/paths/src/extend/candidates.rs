//! Importance resampling of the point of a light (antwerpen-2011 section 4.6, talbot-2005).

use fairflight_sources::UniformSource;
use std::num::NonZeroU32;

/// Number of candidates for a sample of which one is kept.
///
/// **Law.** With n candidates X_i of the density p, kept in proportion to w_i ≥ 0, positive where f is not 0,
///
/// > E\[f(X)/p(X) · (1/n) Σ w_i / w_X\] = ∫ f
///
/// for every f: given the candidates, Σ_k (w_k/Σ w) f(X_k)/p(X_k) · (Σ w/n)/w_k is the mean of f/p over them (talbot-2005 eq. 6, with
/// w = q̂/p). The density of what is kept has no closed form; weights against another technique may use any other, here n p.
pub trait LightCandidates: Copy {
    /// The number of candidates, n.
    fn count(self) -> f64;

    /// One of the candidates that `draw` makes, and (1/n) Σ w_i / w_X of it; `None` where all weights are 0.
    fn keep<T, S: UniformSource>(
        self,
        source: &mut S,
        draw: impl FnMut(&mut S) -> Option<T>,
        weigh: impl FnMut(&T) -> f64,
    ) -> Option<(T, f64)>;
}

/// One candidate: what is drawn is kept, and nothing is weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct One;

impl LightCandidates for One {
    #[inline]
    fn count(self) -> f64 {
        1.0
    }

    #[inline]
    fn keep<T, S: UniformSource>(
        self,
        source: &mut S,
        mut draw: impl FnMut(&mut S) -> Option<T>,
        _weigh: impl FnMut(&T) -> f64,
    ) -> Option<(T, f64)> {
        draw(source).map(|drawn| (drawn, 1.0))
    }
}

/// Several candidates, of which one is kept for what it would add were nothing between: one connection, whose noise is that of visibility and of what
/// the mean of the candidates leaves.
///
/// **Cost.** A point of the light and a phase function per candidate, one transmittance in all: worth it where that is dear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Several(pub NonZeroU32);

impl LightCandidates for Several {
    #[inline]
    fn count(self) -> f64 {
        f64::from(self.0.get())
    }

    #[inline]
    fn keep<T, S: UniformSource>(
        self,
        source: &mut S,
        mut draw: impl FnMut(&mut S) -> Option<T>,
        mut weigh: impl FnMut(&T) -> f64,
    ) -> Option<(T, f64)> {
        let (mut sum, mut kept) = (0.0, None);
        for _ in 0..self.0.get() {
            let Some(drawn) = draw(source) else { continue };
            let weight = weigh(&drawn);
            if weight <= 0.0 {
                continue;
            }
            // One in proportion, without storing the others: the k-th takes the place of what was kept with w_k/(w_1 + … + w_k).
            let first = sum == 0.0;
            sum += weight;
            if first || source.next_uniform() * sum < weight {
                kept = Some((drawn, weight));
            }
        }
        kept.map(|(drawn, weight)| (drawn, sum / (self.count() * weight)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::Scripted;

    /// What is kept of values that weigh themselves.
    fn kept(values: &[f64], script: &[f64]) -> Option<(f64, f64)> {
        let mut source = Scripted::new(script.iter().copied());
        let mut left = values.iter();
        let several = Several(NonZeroU32::new(values.len() as u32).unwrap());
        let kept = several.keep(&mut source, |_| left.next().copied(), |&value| value);
        assert_eq!(source.remaining(), 0);
        kept
    }

    #[test]
    fn candidates_are_kept_in_proportion_to_their_weights() {
        // 3 of 1 + 3, and 4 of 8: the borders of the variates are 3/4 and 1/2.
        assert_eq!(kept(&[1.0, 3.0, 4.0], &[0.74, 0.5]), Some((3.0, 8.0 / 9.0)));
        assert_eq!(kept(&[1.0, 3.0, 4.0], &[0.75, 0.5]), Some((1.0, 8.0 / 3.0)));
        assert_eq!(kept(&[1.0, 3.0, 4.0], &[0.75, 0.49]), Some((4.0, 2.0 / 3.0)));
        // Weights of 0 count as candidates.
        assert_eq!(kept(&[0.0, 2.0, 0.0, 0.0], &[]), Some((2.0, 0.25)));
        assert_eq!(kept(&[0.0, 0.0], &[]), None);
        let one = One.keep(&mut Scripted::new([]), |_| Some(7.0), |_| panic!("nothing is weighed"));
        assert_eq!(one, Some((7.0, 1.0)));
    }
}

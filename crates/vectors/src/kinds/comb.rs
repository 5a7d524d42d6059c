//! Combs: quadratures of the optical thickness with one random shift (kettunen-2021), and how a series of them ends.

use crate::{Arithmetic, Number, Run};

/// Placement of the teeth, and what is taken off for the ends.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// Equidistant.
    Uniform,
    /// Less the first term of Euler and Maclaurin, h B_1 \[σ_t\].
    Matched,
    /// Less two terms; slopes by differences over half a tooth.
    Bernoulli2,
    /// Less three terms; slopes and curvatures by differences over one tooth.
    Bernoulli3,
    /// Equidistant in t of s = t² (3 − 2t) length.
    Periodised,
}

/// A comb on a part of the ray, its shared look-ups done.
pub(super) struct Comb<N> {
    teeth: u32,
    shape: Shape,
    from: N,
    to: N,
    step: N,
    at_end: N,
    /// h^k/k! \[σ_t^(k−1)\].
    corrections: Vec<N>,
}

impl<N: Number> Comb<N> {
    /// Looks up `from`, unless it is known, then `to` and what the shape needs inside.
    pub(super) fn prepare<A: Arithmetic<Number = N>>(
        run: &mut Run<'_, A>,
        (teeth, shape): (u32, Shape),
        (from, known): (N, Option<N>),
        to: &N,
    ) -> Self {
        let step = (to.clone() - from.clone()) / N::of(f64::from(teeth));
        let bare = |at_end| Self {
            teeth,
            shape,
            from: from.clone(),
            to: to.clone(),
            step: step.clone(),
            at_end,
            corrections: Vec::new(),
        };
        if matches!(shape, Shape::Uniform | Shape::Periodised) {
            return bare(N::of(0.0));
        }
        let start = known.unwrap_or_else(|| run.look_up(from.clone()));
        let end = run.look_up(to.clone());
        let mut inner = |halves: f64| {
            let reach = N::of(0.5 * halves) * step.clone();
            let after = run.look_up((from.clone() + reach.clone()).min(to.clone()));
            (after, run.look_up((to.clone() - reach).max(from.clone())))
        };
        let mut corrections = vec![step.clone() * (end.clone() - start.clone())];
        match shape {
            Shape::Bernoulli2 => {
                // The slope is a difference over h/2: h²/2 · 2/h is h.
                let (after, before) = inner(1.0);
                let slopes = (end.clone() - before) - (after - start);
                corrections.push(step.clone() * slopes);
            }
            Shape::Bernoulli3 => {
                let ((after, before), (after_2, before_2)) = (inner(1.0), inner(2.0));
                // Three points at the distance h/2: h σ′ = 4 (f_1 − f_0) − (f_2 − f_0), h²/4 σ″ = (f_0 − f_1) + (f_2 − f_1).
                let four = N::of(4.0);
                let at_start =
                    four.clone() * (after.clone() - start.clone()) - (after_2.clone() - start.clone());
                let at_end = four * (end.clone() - before.clone()) - (end.clone() - before_2.clone());
                let curved_start = (start - after.clone()) + (after_2 - after);
                let curved_end = (end.clone() - before.clone()) + (before_2 - before);
                corrections.push(N::of(0.5) * step.clone() * (at_end - at_start));
                let two_thirds = N::of(2.0) / N::of(3.0);
                corrections.push(two_thirds * step.clone() * (curved_end - curved_start));
            }
            _ => {}
        }
        Self { corrections, ..bare(end) }
    }

    /// The next part, which begins where this one ends, by the look-up that was done there.
    pub(super) fn next<A: Arithmetic<Number = N>>(self, run: &mut Run<'_, A>, to: &N) -> Self {
        Self::prepare(run, (self.teeth, self.shape), (self.to, Some(self.at_end)), to)
    }

    /// X(u) = h Σ σ_t − Σ_k h^k/k! B_k(u) \[σ_t^(k−1)\].
    pub(super) fn thickness<A: Arithmetic<Number = N>>(&self, run: &mut Run<'_, A>, u: N) -> N {
        if self.shape == Shape::Periodised {
            return self.periodised(run, &u);
        }
        let first = self.from.clone() + u.clone() * self.step.clone();
        let mut sum = N::of(0.0);
        for tooth in 0..self.teeth {
            let s = first.clone() + N::of(f64::from(tooth)) * self.step.clone();
            sum = sum + run.look_up(s.min(self.to.clone()));
        }
        let thickness = self.step.clone() * sum;
        let below = u.clone() - N::of(1.0);
        let b1 = u.clone() - N::of(0.5);
        let b2 = u.clone() * below.clone() + N::of(1.0) / N::of(6.0);
        let polynomials = [b1.clone(), b2, u * b1 * below];
        let terms = self.corrections.iter().zip(polynomials).map(|(jump, b)| jump.clone() * b);
        match terms.reduce(|sum, term| sum + term) {
            Some(corrections) => thickness - corrections,
            None => thickness,
        }
    }

    fn periodised<A: Arithmetic<Number = N>>(&self, run: &mut Run<'_, A>, u: &N) -> N {
        let (one, length) = (N::of(1.0), self.to.clone() - self.from.clone());
        let scale = one.clone() / N::of(f64::from(self.teeth));
        let mut sum = N::of(0.0);
        for tooth in 0..self.teeth {
            let t = (N::of(f64::from(tooth)) + u.clone()) * scale.clone();
            let share = t.clone() * t.clone() * (N::of(3.0) - N::of(2.0) * t.clone());
            let s = (self.from.clone() + share * length.clone()).min(self.to.clone());
            sum = sum + t.clone() * (one.clone() - t) * run.look_up(s);
        }
        N::of(6.0) * self.step.clone() * sum
    }
}

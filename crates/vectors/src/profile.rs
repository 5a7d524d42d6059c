//! The profile of cases: numbers that every precision holds, so that ports need no tolerance for their nodes.

use crate::Number;
use serde_json::{Value, json};

/// σ_t(s), linear between nodes whose positions and values are dyadic. Widths of pieces are powers of two: the place within a piece is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Positions of the nodes \[length\]; the first is 0.
    pub s: &'static [f64],
    /// σ_t at the nodes \[1/length\].
    pub sigma_t: &'static [f64],
}

impl Profile {
    /// Five nodes on a length of 8, with a point of vacuum; majorant 1, optical thickness 4.5.
    pub const SMOKE: Self = Self { s: &[0.0, 1.0, 2.0, 4.0, 8.0], sigma_t: &[0.25, 1.0, 0.0, 0.75, 0.5] };

    /// Half everywhere, on a length of 4.
    pub const EVEN: Self = Self { s: &[0.0, 4.0], sigma_t: &[0.5, 0.5] };

    /// Two pieces that rise from nothing to 2 and stay there, on a length of 2; optical thickness 3.
    pub const RAMP: Self = Self { s: &[0.0, 1.0, 2.0], sigma_t: &[0.0, 2.0, 2.0] };

    /// Two pieces up to 2 and down to 1, on a length of 1: many walks come through; optical thickness 11/8.
    pub const HILL: Self = Self { s: &[0.0, 0.5, 1.0], sigma_t: &[0.5, 2.0, 1.0] };

    /// The length \[length\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.s[self.s.len() - 1]
    }

    /// The greatest σ_t \[1/length\].
    #[must_use]
    pub fn majorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(0.0, f64::max)
    }

    /// (1 − t) a + t b with t = (s − s_i)/(s_{i+1} − s_i); at a node, the piece behind it.
    #[must_use]
    pub fn at<N: Number>(&self, s: &N) -> N {
        let last = self.s.len() - 2;
        let piece = (0..last).find(|&i| *s < N::of(self.s[i + 1])).unwrap_or(last);
        let t = (s.clone() - N::of(self.s[piece])) / N::of(self.s[piece + 1] - self.s[piece]);
        let t = t.max(N::of(0.0)).min(N::of(1.0));
        (N::of(1.0) - t.clone()) * N::of(self.sigma_t[piece]) + t * N::of(self.sigma_t[piece + 1])
    }

    /// ∫ σ_t from 0 to a distance \[1\]: whole pieces, then a trapezoid.
    #[must_use]
    pub fn thickness<N: Number>(&self, s: &N) -> N {
        let half = N::of(0.5);
        let mut sum = N::of(0.0);
        for i in 0..self.s.len() - 1 {
            if *s < N::of(self.s[i + 1]) {
                let ends = N::of(self.sigma_t[i]) + self.at(s);
                return sum + half * (s.clone() - N::of(self.s[i])) * ends;
            }
            let ends = N::of(self.sigma_t[i] + self.sigma_t[i + 1]);
            sum = sum + half.clone() * N::of(self.s[i + 1] - self.s[i]) * ends;
        }
        sum
    }

    /// As cases state it.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({"kind": "piecewise_linear", "s": self.s, "sigma_t": self.sigma_t})
    }
}

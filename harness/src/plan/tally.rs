//! Light by the strategy that found it.

use fairflight_bidirectional::Strategy;

/// Edges of the longest paths whose strategies are told one by one.
const LONGEST: usize = 10;
/// Strategies of paths of 1 to `LONGEST` edges, k + 1 for k edges.
const TOLD: usize = LONGEST * (LONGEST + 3) / 2;

/// Sums of contributions, one for each strategy; those of longer paths are one.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally(Vec<f64>);

impl Tally {
    /// Sums of 0.
    #[must_use]
    pub fn zero() -> Self {
        Self(vec![0.0; TOLD + 1])
    }

    /// No sums, for an integrator without strategies.
    #[must_use]
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// Adds a contribution; not to none.
    #[inline]
    pub fn add(&mut self, Strategy { light, eye }: Strategy, value: f64) {
        let edges = light as usize + eye as usize - 1;
        let index = if edges > LONGEST { TOLD } else { (edges - 1) * (edges + 2) / 2 + eye as usize - 1 };
        self.0[index] += value;
    }

    /// The sums, in the order of [`strategies`](Self::strategies).
    #[must_use]
    pub fn sums(&self) -> &[f64] {
        &self.0
    }

    /// The strategy of each sum; `None` for that of longer paths.
    pub fn strategies() -> impl Iterator<Item = Option<Strategy>> {
        let of = |edges: usize| {
            (1..=edges + 1)
                .map(move |eye| Some(Strategy { light: (edges + 1 - eye) as u32, eye: eye as u32 }))
        };
        (1..=LONGEST).flat_map(of).chain([None])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_strategy_has_a_sum_of_its_own() {
        let mut tally = Tally::zero();
        for (index, strategy) in Tally::strategies().enumerate() {
            tally.add(strategy.unwrap_or(Strategy { light: 7, eye: 5 }), 1.0 + index as f64);
        }
        let expected: Vec<f64> = (0..=TOLD).map(|index| 1.0 + index as f64).collect();
        assert_eq!(tally.sums(), expected);
    }
}

//! An integral as a function of its upper limit.

use super::panels::Panel;
use super::rule::{Expansion, NODES, RULE, integral_to};

/// The functions `I_k(s) = ∫_0^s f_k`, each a polynomial of degree 16 per panel: exact where quadrature was.
#[derive(Clone, Debug)]
pub struct Cumulative<const K: usize> {
    pieces: Vec<Piece<K>>,
}

#[derive(Clone, Debug)]
struct Piece<const K: usize> {
    from: f64,
    to: f64,
    before: [f64; K],
    expansion: [Expansion; K],
}

impl<const K: usize> Cumulative<K> {
    pub(super) fn of<T>(panels: &[Panel<T>], integrand: &dyn Fn(f64, &T) -> [f64; K]) -> Self {
        let mut before = [0.0; K];
        let pieces = panels
            .iter()
            .map(|panel| {
                let rows = panel.rows(&|_, s, value| integrand(s, value));
                let piece = Piece {
                    from: panel.from,
                    to: panel.to,
                    before,
                    expansion: std::array::from_fn(|k| RULE.expand(&rows[k])),
                };
                for k in 0..K {
                    before[k] += RULE.integrate(&rows[k], panel.half()).value;
                }
                piece
            })
            .collect();
        Self { pieces }
    }

    /// The integrals up to `s`; 0 for an empty profile.
    #[must_use]
    pub fn at(&self, s: f64) -> [f64; K] {
        let after = self.pieces.partition_point(|piece| piece.from <= s);
        let Some(piece) = self.pieces.get(after.saturating_sub(1)) else { return [0.0; K] };
        let half = 0.5 * (piece.to - piece.from);
        let x = ((s - piece.from) / half - 1.0).clamp(-1.0, 1.0);
        std::array::from_fn(|k| piece.before[k] + half * integral_to(&piece.expansion[k], x))
    }
}

/// The running integrals at the nodes of each panel, in order: what a nested integral needs.
pub(super) fn running_at_nodes<T, const K: usize>(
    panels: &[Panel<T>],
    integrand: &dyn Fn(f64, &T) -> [f64; K],
) -> Vec<[[f64; NODES]; K]> {
    let mut before = [0.0; K];
    panels
        .iter()
        .map(|panel| {
            let rows = panel.rows(&|_, s, value| integrand(s, value));
            std::array::from_fn(|k| {
                let start = before[k];
                before[k] += RULE.integrate(&rows[k], panel.half()).value;
                RULE.running(&rows[k], panel.half()).map(|inside| start + inside)
            })
        })
        .collect()
}

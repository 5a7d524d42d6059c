//! Checks certificates of random sums against closed forms: `cargo run --release -p fairflight-media --example certificates [COUNT]`.

#[path = "../tests/sums/mod.rs"]
mod sums;

use fairflight_media::{Certificate, ExpressionProfile, Tolerance};
use sums::Sum;

fn main() {
    let count: u64 = std::env::args().nth(1).map_or(10_000, |count| count.parse().expect("a number"));
    let (mut certified, mut wrong, mut worst, mut borders) = (0, 0, (0.0, 0), 0);
    let mut costs = Vec::new();
    for seed in 0..count {
        let sum = Sum::random(seed);
        let profile = ExpressionProfile::new(&sum.formula, sum.length, None).expect("a formula");
        let found = Certificate::of(&profile, Tolerance::TIGHT);
        let off = (found.thickness - sum.integral).abs();
        match found.doubt() {
            None => {
                certified += 1;
                let share = off / (found.error + sum.rounding);
                if share > worst.0 {
                    worst = (share, seed);
                }
                wrong += u64::from(share > 1.0);
            }
            Some(doubt) => {
                println!("seed {seed}: {doubt}: {}", sum.formula);
                wrong += u64::from(!(found.bounds.0..=found.bounds.1).contains(&sum.integral));
            }
        }
        borders += found.borders.len();
        costs.push(found.cost);
    }
    costs.sort_unstable();
    let quantile = |q: f64| costs[((costs.len() - 1) as f64 * q) as usize];
    println!(
        "{certified} of {count} certified, {wrong} wrong; the worst, seed {}, off by {:.3} of its error",
        worst.1, worst.0
    );
    println!(
        "operations: median {}, 99 % {}, most {}; borders: {:.1} in the mean",
        quantile(0.5),
        quantile(0.99),
        quantile(1.0),
        borders as f64 / count as f64
    );
}

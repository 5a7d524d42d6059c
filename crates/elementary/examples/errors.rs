//! Compares the functions with correctly rounded ones.
//!
//! ```sh
//! cargo run --release -p fairflight-elementary --example errors -- 100000000
//! ```

use fairflight_elementary::{cos, exp, exp_m1, ln, ln_1p, sin};

type Function = fn(f64) -> f64;

/// xorshift64* (vigna-2016): good enough to choose arguments.
struct Arguments(u64);

impl Arguments {
    /// A number in (0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        (bits as f64 + 0.5) * 0.5_f64.powi(53)
    }
}

/// Steps between two numbers of the same sign.
fn steps(a: f64, b: f64) -> u64 {
    a.to_bits().abs_diff(b.to_bits())
}

fn main() {
    let count: u64 = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(1_000_000);
    let functions: [(&str, Function, Function, Function); 6] = [
        ("ln of a variate", ln, pxfm::f_log, |u| u),
        ("ln_1p", ln_1p, pxfm::f_log1p, |u| (-40.0 * u).exp() * if u < 0.5 { 1.0 } else { -1.0 }),
        ("exp", exp, pxfm::f_exp, |u| 1400.0 * (u - 0.5)),
        ("exp_m1", exp_m1, pxfm::f_expm1, |u| 20.0 * (u - 0.5)),
        ("sin", sin, pxfm::f_sin, |u| 200.0 * (u - 0.5)),
        ("cos", cos, pxfm::f_cos, |u| 200.0 * (u - 0.5)),
    ];
    for (name, ours, right, argument) in functions {
        let mut source = Arguments(0x9E37_79B9_7F4A_7C15);
        let (mut other, mut greatest, mut absolute) = (0_u64, 0, 0.0_f64);
        for _ in 0..count {
            let x = argument(source.uniform());
            let (found, right) = (ours(x), right(x));
            other += u64::from(found != right);
            greatest = greatest.max(steps(found, right));
            absolute = absolute.max((found - right).abs());
        }
        let share = 100.0 * other as f64 / count as f64;
        println!(
            "{name:16} {share:8.4} % not correctly rounded, off by at most {greatest} ulp, {absolute:.2e}"
        );
    }
}

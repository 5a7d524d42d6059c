//! The binomial law: probabilities and tails with full relative accuracy for any N and p.
//!
//! The general incomplete beta function at hand (statrs 0.19) takes its prefactor from differences of log-gamma
//! functions, which at N = 1e12 leaves no digit, stops its continued fraction after 140 terms, and gives the small
//! tail of some arguments as one minus the large one. Hence this file; statrs is the second opinion of its tests.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// The number of successes in `trials` independent trials, each of which succeeds with probability `p`.
///
/// `trials` may be zero, p exactly 0 or 1, or as small as f64 goes. Relative errors of probabilities and of the
/// smaller tail stay below about 1e-12 for N up to 1e12 (the products of p and N are rounded to f64).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binomial {
    trials: u64,
    p: f64,
}

/// Error of a [`Binomial`] that was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinomialError {
    /// p is below zero or NaN.
    ProbabilityNotAtLeastZero,
    /// p is above one.
    ProbabilityAboveOne,
}

impl fmt::Display for BinomialError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ProbabilityNotAtLeastZero => "the success probability is not at least zero",
            Self::ProbabilityAboveOne => "the success probability is above one",
        })
    }
}

impl Error for BinomialError {}

impl Binomial {
    /// The law of the successes in `trials` trials.
    ///
    /// # Errors
    /// If p is not in [0, 1].
    pub fn new(trials: u64, p: f64) -> Result<Self, BinomialError> {
        if p > 1.0 {
            return Err(BinomialError::ProbabilityAboveOne);
        }
        if p >= 0.0 { Ok(Self { trials, p }) } else { Err(BinomialError::ProbabilityNotAtLeastZero) }
    }

    /// Number of trials, N.
    #[must_use]
    pub const fn trials(&self) -> u64 {
        self.trials
    }

    /// Probability of success of one trial, p.
    #[must_use]
    pub const fn p(&self) -> f64 {
        self.p
    }

    /// P(X = k), by the saddle-point expansion. Zero for k > N.
    ///
    /// Source: Loader, "Fast and accurate computation of binomial probabilities" (2000): the logarithm is a sum of
    /// small terms of one sign, instead of a difference of huge ones.
    #[must_use]
    pub fn pmf(&self, k: u64) -> f64 {
        let (n, p) = (self.trials as f64, self.p);
        if k > self.trials {
            return 0.0;
        }
        if k == 0 {
            return if self.trials == 0 { 1.0 } else { (n * (-p).ln_1p()).exp() };
        }
        if k == self.trials {
            return (n * p.ln()).exp();
        }
        if p == 0.0 || p == 1.0 {
            return 0.0;
        }
        let (successes, failures) = (k as f64, (self.trials - k) as f64);
        let surplus = (-n).mul_add(p, successes);
        let exponent = stirling_remainder(n)
            - stirling_remainder(successes)
            - stirling_remainder(failures)
            - deviance(successes, n * p, surplus)
            - deviance(failures, n * (1.0 - p), -surplus);
        exponent.exp() * (n / (TAU * successes * failures)).sqrt()
    }

    /// P(X >= k). One for k = 0, zero for k > N.
    #[must_use]
    pub fn upper_tail(&self, k: u64) -> f64 {
        let (n, p, q) = (self.trials as f64, self.p, 1.0 - self.p);
        if k == 0 {
            return 1.0;
        }
        if k > self.trials {
            return 0.0;
        }
        if p == 0.0 || p == 1.0 {
            return p;
        }
        let lambda = (-(n + 1.0)).mul_add(p, k as f64);
        if lambda < 0.0 {
            return 1.0 - self.lower_tail(k - 1);
        }
        // P(X >= k) = I_p(k, N-k+1), whose prefactor p^a q^b / B(a,b) is k q P(X = k).
        let (a, b) = (k as f64, (self.trials - k + 1) as f64);
        self.pmf(k) * a * q * beta_fraction(a, b, p, q, lambda)
    }

    /// P(X <= k). One for k >= N.
    #[must_use]
    pub fn lower_tail(&self, k: u64) -> f64 {
        let (n, p, q) = (self.trials as f64, self.p, 1.0 - self.p);
        if k >= self.trials {
            return 1.0;
        }
        if p == 0.0 || p == 1.0 {
            return q;
        }
        let (a, b) = ((self.trials - k) as f64, (k + 1) as f64);
        let lambda = (n + 1.0).mul_add(p, -b);
        if lambda < 0.0 {
            return 1.0 - self.upper_tail(k + 1);
        }
        // P(X <= k) = I_q(N-k, k+1), whose prefactor is (N-k) p P(X = k).
        self.pmf(k) * a * p * beta_fraction(a, b, q, p, lambda)
    }
}

/// The continued fraction of I_x(a,b) B(a,b) / (x^a y^b), y = 1-x, for lambda = a - (a+b)x >= 0.
///
/// Source: DiDonato and Morris, "Algorithm 708", ACM TOMS 18 (1992), function BFRAC. All terms are positive. Needs some
/// tens of steps five standard deviations out, of the order of the standard deviation near the mean; at integer b it
/// ends after b steps.
fn beta_fraction(a: f64, b: f64, x: f64, y: f64, lambda: f64) -> f64 {
    let c = 1.0 + lambda;
    let (c0, c1) = (b / a, 1.0 + 1.0 / a);
    let (mut p, mut s) = (1.0, a + 1.0);
    let (mut an, mut bn, mut an1, mut bn1) = (0.0, 1.0, 1.0, c / c1);
    let mut ratio = c1 / c;
    let mut n = 0.0;
    while n < b {
        n += 1.0;
        let t = n / a;
        let w = n * (b - n) * x;
        let e = a / s;
        let alpha = (p * (p + c0) * e * e) * (w * x);
        let e = (1.0 + t) / (c1 + t + t);
        let beta = n + w / s + e * (c + n * (1.0 + y));
        p = 1.0 + t;
        s += 2.0;
        (an, an1) = (an1, alpha * an + beta * an1);
        (bn, bn1) = (bn1, alpha * bn + beta * bn1);
        let previous = ratio;
        ratio = an1 / bn1;
        if (ratio - previous).abs() <= 1e-15 * ratio {
            break;
        }
        // Only ratios matter: rescaled, so that nothing overflows.
        (an, bn, an1, bn1) = (an / bn1, bn / bn1, ratio, 1.0);
    }
    ratio
}

/// ln n! - ln(sqrt(2 pi n) (n/e)^n) for n >= 1 (Loader's stirlerr).
fn stirling_remainder(n: f64) -> f64 {
    // The series has an error of 1e-16 from 16 on; below, the factorial is exact.
    if n < 16.0 {
        let factorial: f64 = (2..=n as u32).map(f64::from).product();
        return factorial.ln() - ((n + 0.5) * n.ln() - n + 0.5 * (2.0 * PI).ln());
    }
    let r = 1.0 / (n * n);
    (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r * (1.0 / 1680.0 - r / 1188.0)))) / n
}

/// x ln(x/m) + m - x >= 0 for x > 0, given difference = x - m without cancellation (Loader's bd0).
fn deviance(x: f64, m: f64, difference: f64) -> f64 {
    if difference.abs() >= 0.1 * (x + m) {
        return x * (x.ln() - m.ln()) - difference;
    }
    // ln(x/m) = 2 artanh(v): the first term of the series cancels against `difference`.
    let v = difference / (x + m);
    let mut sum = difference * v;
    let mut term = 2.0 * x * v;
    let mut order = 1.0;
    loop {
        term *= v * v;
        order += 2.0;
        let next = sum + term / order;
        if next == sum {
            return sum;
        }
        sum = next;
    }
}

#[cfg(test)]
#[path = "binomial_tests.rs"]
mod tests;

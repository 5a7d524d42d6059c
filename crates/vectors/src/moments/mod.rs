//! Exact moments of estimates, for statistical tests of ports: by quadrature over the pieces of the profile, from the law of each estimator, and from
//! no estimator.

mod marching;
mod quadrature;
mod walk;

pub(crate) use marching::{Shifts, of_shifts, of_two_shifts, second_moment};
pub(crate) use quadrature::{breaks_at, integrate};
pub(crate) use walk::{Collision, coin, product, strata};

use crate::Profile;
use serde_json::{Value, json};

/// Moments of one score. What is not known is left out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moments {
    /// The score: an output, or for flights `escaped`, the weight of a flight that escaped, 0 of one that collided.
    pub(crate) of: &'static str,
    pub(crate) mean: f64,
    pub(crate) variance: Option<f64>,
    /// The fourth central moment.
    pub(crate) fourth: Option<f64>,
    /// Mean look-ups.
    pub(crate) lookups: Option<f64>,
}

impl Moments {
    /// From E\[x^k\], k = 1 … 4.
    pub(crate) fn of_raw(of: &'static str, raw: [f64; 4], lookups: Option<f64>) -> Self {
        let [mean, second, third, fourth] = raw;
        let square = mean * mean;
        let central = fourth - 4.0 * mean * third + 6.0 * square * second - 3.0 * square * square;
        Self { of, mean, variance: Some(second - square), fourth: Some(central), lookups }
    }

    /// An unbiased estimate of transmittance whose variance has no closed form here.
    pub(crate) fn unbiased(of: &'static str, profile: Profile) -> Self {
        Self { of, mean: transmittance(profile, 1.0), variance: None, fourth: None, lookups: None }
    }

    /// The same with mean look-ups.
    pub(crate) fn looking_up(self, lookups: f64) -> Self {
        Self { lookups: Some(lookups), ..self }
    }

    /// As headers state them.
    pub(crate) fn json(&self) -> Value {
        let mut json = json!({ "of": self.of, "mean": rounded(self.mean) });
        for (key, value) in
            [("variance", self.variance), ("fourth_central", self.fourth), ("lookups", self.lookups)]
        {
            if let Some(value) = value {
                json[key] = json!(rounded(value));
            }
        }
        json
    }
}

/// To twelve digits, which the quadratures have; less than 1e-13 is 0.
fn rounded(x: f64) -> f64 {
    if x.abs() < 1e-13 { 0.0 } else { format!("{x:.11e}").parse().expect("a number that was just written") }
}

/// exp(−c τ) of the whole profile.
pub(crate) fn transmittance(profile: Profile, coefficient: f64) -> f64 {
    libm::exp(-coefficient * profile.thickness(&profile.length()))
}

//! The 21-point Gauss–Kronrod rule, its error estimate, and its running integral inside a panel.

#![expect(clippy::excessive_precision, reason = "QUADPACK's digits, as published")]

use fairflight_elementary::pow;
use std::sync::LazyLock;

/// Nodes per panel.
pub(super) const NODES: usize = 21;

/// The positive nodes of QUADPACK's qk21 in decreasing order, then 0.
const HALF_NODES: [f64; 11] = [
    0.995_657_163_025_808_080_735_527_280_689_003,
    0.973_906_528_517_171_720_077_964_012_084_452,
    0.930_157_491_355_708_226_001_207_180_059_508,
    0.865_063_366_688_984_510_732_096_688_423_493,
    0.780_817_726_586_416_897_063_717_578_345_042,
    0.679_409_568_299_024_406_234_327_365_114_874,
    0.562_757_134_668_604_683_339_000_099_272_694,
    0.433_395_394_129_247_190_799_265_943_165_784,
    0.294_392_862_701_460_198_131_126_603_103_866,
    0.148_874_338_981_631_210_884_826_001_129_720,
    0.0,
];

const HALF_KRONROD: [f64; 11] = [
    0.011_694_638_867_371_874_278_064_396_062_192,
    0.032_558_162_307_964_727_478_818_972_459_390,
    0.054_755_896_574_351_996_031_381_300_244_580,
    0.075_039_674_810_919_952_767_043_140_916_190,
    0.093_125_454_583_697_605_535_065_465_083_366,
    0.109_387_158_802_297_641_899_210_590_325_805,
    0.123_491_976_262_065_851_077_958_109_585_166,
    0.134_709_217_311_473_325_928_054_001_771_707,
    0.142_775_938_577_060_080_797_094_273_138_717,
    0.147_739_104_901_338_491_374_841_515_972_068,
    0.149_445_554_002_916_905_664_936_468_389_821,
];

/// Gauss weights of every second node: nodes 1, 3, 5, 7, 9 and their mirror images.
const HALF_GAUSS: [f64; 5] = [
    0.066_671_344_308_688_137_593_568_809_893_332,
    0.149_451_349_150_580_593_145_863_396_957_658,
    0.219_086_362_515_982_043_995_534_934_228_163,
    0.269_266_719_309_996_355_091_226_921_569_469,
    0.295_524_224_714_752_870_173_815_619_188_769,
];

/// The highest degree of the Legendre expansion of a panel: the Kronrod rule integrates the products of its basis
/// (degree 30) exactly, so that the discrete projection is the exact one.
const DEGREE: usize = 15;

/// Coefficients of a panel's Legendre expansion.
pub(super) type Expansion = [f64; DEGREE + 1];

/// The rule on [−1, 1], nodes in increasing order.
pub(super) struct Rule {
    pub(super) nodes: [f64; NODES],
    kronrod: [f64; NODES],
    gauss: [f64; NODES],
    /// Row i integrates a panel from −1 to node i.
    running: [[f64; NODES]; NODES],
}

/// The integral over one panel, and the estimate of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelIntegral {
    pub(super) value: f64,
    pub(super) error: f64,
    pub(super) magnitude: f64,
}

pub(super) static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);

impl Rule {
    fn new() -> Self {
        let mut rule = Self {
            nodes: [0.0; NODES],
            kronrod: [0.0; NODES],
            gauss: [0.0; NODES],
            running: [[0.0; NODES]; NODES],
        };
        for (i, (&x, &w)) in HALF_NODES.iter().zip(&HALF_KRONROD).enumerate() {
            let mirror = NODES - 1 - i;
            (rule.nodes[i], rule.nodes[mirror]) = (-x, x);
            (rule.kronrod[i], rule.kronrod[mirror]) = (w, w);
            if i % 2 == 1 {
                (rule.gauss[i], rule.gauss[mirror]) = (HALF_GAUSS[i / 2], HALF_GAUSS[i / 2]);
            }
        }
        for m in 0..NODES {
            let mut unit = [0.0; NODES];
            unit[m] = 1.0;
            let expansion = rule.expand(&unit);
            for i in 0..NODES {
                rule.running[i][m] = integral_to(&expansion, rule.nodes[i]);
            }
        }
        rule
    }

    /// The Kronrod value with QUADPACK's error estimate, for values at the nodes of a panel of half width `half`.
    pub(super) fn integrate(&self, values: &[f64; NODES], half: f64) -> PanelIntegral {
        let (mut kronrod, mut gauss, mut magnitude) = (0.0, 0.0, 0.0);
        for (i, &value) in values.iter().enumerate() {
            kronrod += self.kronrod[i] * value;
            gauss += self.gauss[i] * value;
            magnitude += self.kronrod[i] * value.abs();
        }
        let mean = 0.5 * kronrod;
        let spread: f64 = values.iter().zip(&self.kronrod).map(|(v, w)| w * (v - mean).abs()).sum();
        let mut error = (kronrod - gauss).abs();
        if spread > 0.0 && error > 0.0 {
            error = spread * pow(200.0 * error / spread, 1.5).min(1.0);
        }
        let rounding = 10.0 * f64::EPSILON * magnitude;
        PanelIntegral {
            value: kronrod * half,
            error: error.max(rounding) * half,
            magnitude: magnitude * half,
        }
    }

    /// The same, with an error that also covers the running integral inside the panel: an expansion that has not
    /// decayed by its last terms does not follow the function, even where its total happens to be right.
    pub(super) fn integrate_running(&self, values: &[f64; NODES], half: f64) -> PanelIntegral {
        let whole = self.integrate(values, half);
        let expansion = self.expand(values);
        let tail = (expansion[DEGREE - 1].abs() + expansion[DEGREE].abs()) * half / DEGREE as f64;
        PanelIntegral { error: whole.error.max(tail), ..whole }
    }

    /// ∫ from the start of the panel to each of its nodes.
    pub(super) fn running(&self, values: &[f64; NODES], half: f64) -> [f64; NODES] {
        std::array::from_fn(|i| {
            half * self.running[i].iter().zip(values).map(|(weight, value)| weight * value).sum::<f64>()
        })
    }

    /// The Legendre expansion of values at the nodes.
    pub(super) fn expand(&self, values: &[f64; NODES]) -> Expansion {
        let mut expansion = [0.0; DEGREE + 1];
        for ((&x, &w), &value) in self.nodes.iter().zip(&self.kronrod).zip(values) {
            let basis = legendre::<{ DEGREE + 1 }>(x);
            for (j, coefficient) in expansion.iter_mut().enumerate() {
                *coefficient += (j as f64 + 0.5) * w * basis[j] * value;
            }
        }
        expansion
    }
}

/// ∫ of an expansion from −1 to `x`, by ∫ P_j = (P_{j+1} − P_{j−1}) / (2j + 1).
pub(super) fn integral_to(expansion: &Expansion, x: f64) -> f64 {
    let basis = legendre::<{ DEGREE + 2 }>(x);
    let mut integral = expansion[0] * (x + 1.0);
    for j in 1..=DEGREE {
        integral += expansion[j] * (basis[j + 1] - basis[j - 1]) / (2 * j + 1) as f64;
    }
    integral
}

/// An expansion at `x`.
pub(super) fn value_of(expansion: &Expansion, x: f64) -> f64 {
    legendre::<{ DEGREE + 1 }>(x).iter().zip(expansion).map(|(basis, coefficient)| basis * coefficient).sum()
}

/// P_0(x) … P_{N−1}(x) by the three-term recurrence.
fn legendre<const N: usize>(x: f64) -> [f64; N] {
    let mut basis = [1.0; N];
    basis[1] = x;
    for j in 1..N - 1 {
        let n = j as f64;
        basis[j + 1] = ((2.0 * n + 1.0) * x * basis[j] - n * basis[j - 1]) / (n + 1.0);
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kronrod_is_exact_to_degree_31_and_gauss_to_19() {
        for degree in 0..=31 {
            let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
            let sum = |weights: &[f64; NODES]| -> f64 {
                weights.iter().zip(&RULE.nodes).map(|(w, x)| w * x.powi(degree)).sum()
            };
            assert!((sum(&RULE.kronrod) - exact).abs() < 1e-15, "Kronrod, degree {degree}");
            if degree <= 19 {
                assert!((sum(&RULE.gauss) - exact).abs() < 1e-15, "Gauss, degree {degree}");
            }
        }
    }

    #[test]
    fn running_integrals_are_exact_for_polynomials() {
        for degree in 0..=DEGREE as i32 {
            let values = std::array::from_fn(|i| RULE.nodes[i].powi(degree));
            let primitive = |x: f64| x.powi(degree + 1) / f64::from(degree + 1);
            for (i, running) in RULE.running(&values, 1.0).into_iter().enumerate() {
                let exact = primitive(RULE.nodes[i]) - primitive(-1.0);
                assert!((running - exact).abs() < 1e-14, "degree {degree}, node {i}");
            }
        }
    }

    #[test]
    fn the_error_of_a_kink_is_not_underestimated() {
        let values = std::array::from_fn(|i| (RULE.nodes[i] - 0.123).abs());
        let exact = 0.5 * (1.123_f64.powi(2) + 0.877_f64.powi(2));
        let integral = RULE.integrate(&values, 1.0);
        assert!((integral.value - exact).abs() <= integral.error);
    }

    /// QUADPACK's estimate where it is all spread: of values that are 1 at one node of weight w, which the Gauss rule lacks, the mean is
    /// w/2, the spread w (1 − w/2) + (2 − w) w/2, and the difference of the rules w.
    #[test]
    fn the_error_of_one_value_by_hand() {
        for i in (0..NODES).filter(|&i| RULE.gauss[i] == 0.0) {
            let mut values = [0.0; NODES];
            values[i] = 1.0;
            let w = RULE.kronrod[i];
            let found = RULE.integrate(&values, 0.5);
            assert!((found.value - 0.5 * w).abs() < 1e-16);
            assert!((found.error - 0.5 * w * (2.0 - w)).abs() < 1e-15, "{i}: {}", found.error);
        }
    }
}

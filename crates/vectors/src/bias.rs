//! Measured bias of known mistakes.
//!
//! Of a mistaken port with the score Y, the right one with X on the same variates, and the exact mean μ = E\[X\] ([`crate::Kind::moments`]), the relative bias
//! is E\[Y − X\]/μ: the paired difference has the bias of Y − μ for its mean, and next to no noise where both decide alike.

use crate::kinds::{MOST_DRAWS, Model};
use crate::run::Event;
use crate::tolerance::{Finished, rounded_up};
use crate::{Noise, Profile, Script};

/// |z| below which a bias is not seen.
const LEAST_Z: f64 = 4.0;
/// |z| from which a bias is told by two digits.
const TWO_DIGITS: f64 = 20.0;
/// |z| from which a bias counts as certain.
const CERTAIN: f64 = 1000.0;
/// The largest squared difference over the sum of all from which one script decides what is measured.
const MOST_SHARE: f64 = 0.25;
/// Means below are 0 but for rounding: nothing is relative to them.
const LEAST_MEAN: f64 = 1e-12;

/// The bias of a port with a known mistake at one set of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Bias {
    /// Name of the mistake.
    pub mistake: &'static str,
    /// Name of the parameters, as the identifiers of cases have it.
    pub parameters: String,
    /// (Mean score of the mistaken port − exact mean)/exact mean, estimated \[1\]; not finite where some score was not.
    pub relative: f64,
    /// Standard error of that \[1\].
    pub standard_error: f64,
    /// The largest squared difference of a script over the sum of all \[1\]; 0 where scores are equal.
    pub largest_share: f64,
    /// Scripts left out, whose variates did not suffice.
    pub endless: usize,
}

impl Bias {
    /// |bias|/standard error: 0 where scores are equal, infinite where they differ by the same everywhere.
    #[must_use]
    pub fn z(&self) -> f64 {
        if self.relative == 0.0 { 0.0 } else { (self.relative / self.standard_error).abs() }
    }

    /// |bias| with four standard errors more.
    fn bound(&self) -> f64 {
        self.relative.abs() + LEAST_Z * self.standard_error
    }

    /// A sentence on one mistake from its biases at several sets of parameters: that of the largest |z|, of certain ones the largest, with its parameters, by
    /// two digits, or by one where the error exceeds a twentieth; if none is seen, the largest that some set leaves possible; `unbounded` where scores are not
    /// finite, or where that is above 1 and one script alone makes a quarter of it.
    #[must_use]
    pub fn told(sets: &[Self]) -> String {
        let rank = |bias: &&Self| (bias.z().min(CERTAIN), bias.relative.abs());
        let clearest = sets.iter().max_by(|a, b| {
            let ((z, size), (other_z, other_size)) = (rank(a), rank(b));
            z.total_cmp(&other_z).then(size.total_cmp(&other_size))
        });
        let Some(clearest) = clearest else {
            return "-".to_owned();
        };
        let bound = sets.iter().map(Self::bound).fold(0.0, f64::max);
        let is_decided_by_one = |bias: &Self| bias.bound() > 1.0 && bias.largest_share > MOST_SHARE;
        let is_finite = sets.iter().all(|bias| bias.bound().is_finite());
        let told = if !is_finite || clearest.z() < LEAST_Z && sets.iter().any(is_decided_by_one) {
            "unbounded".to_owned()
        } else if clearest.z() >= LEAST_Z {
            let sign = if clearest.relative < 0.0 { '-' } else { '+' };
            let digits = if clearest.z() < TWO_DIGITS { 1 } else { 2 };
            let size = decimal(100.0 * clearest.relative.abs(), digits);
            format!("{sign}{size} % ({})", clearest.parameters)
        } else if bound > 0.0 {
            format!("none seen (< {} %)", decimal(rounded_up(100.0 * bound), 2))
        } else {
            "none: equal scores".to_owned()
        };
        match sets.iter().map(|bias| bias.endless).sum::<usize>() {
            0 => told,
            endless => format!("{told}; {endless} endless"),
        }
    }
}

/// x ≥ 0 by so many digits, without an exponent.
fn decimal(x: f64, digits: usize) -> String {
    let rounded = format!("{x:.*e}", digits - 1);
    let exponent = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    let behind = usize::try_from(digits as i32 - 1 - exponent.unwrap_or(0)).unwrap_or(0);
    format!("{:.behind$}", rounded.parse::<f64>().unwrap_or(x))
}

/// Biases of all mistakes of a kind, as they are measured.
#[derive(Debug)]
pub(crate) struct Biases {
    scripts: usize,
    outputs: &'static [&'static str],
    found: Vec<Bias>,
}

impl Biases {
    /// None yet, of a kind with these outputs, to be measured on so many scripts.
    pub(crate) fn new(scripts: usize, outputs: &'static [&'static str]) -> Self {
        Self { scripts, outputs, found: Vec::new() }
    }

    /// Biases measured so far, in the order of their parameter sets.
    pub(crate) fn found(self) -> Vec<Bias> {
        self.found
    }

    /// Adds those of a model, if it has an exact mean other than 0.
    pub(crate) fn measure(&mut self, name: &str, model: &impl Model, profile: Profile) {
        let Some(moments) = model.moments(profile).filter(|known| known.mean.abs() > LEAST_MEAN) else {
            return;
        };
        // The weight of a flight that escaped, of spectral ones the first; else the first output.
        let output = usize::from(self.outputs[0] == "distance");
        let score =
            |run: &Finished| if run.event == Some(Event::Collided) { 0.0 } else { run.values[output] };
        let mut sums: Vec<(&'static str, Differences)> = Vec::new();
        for number in 0..self.scripts {
            let script = Script::rounded(&format!("{name}/bias/{number}"), MOST_DRAWS);
            let right = Finished::of(model, &Noise::none(), &script, profile);
            assert!(right.uses.len() <= script.len(), "{name}: draws more than it is given");
            for (i, (mistake, run)) in model.mistakes(&script, profile).into_iter().enumerate() {
                if number == 0 {
                    sums.push((mistake, Differences::default()));
                }
                if run.uses.len() > script.len() {
                    sums[i].1.endless += 1;
                } else {
                    sums[i].1.add(score(&run) - score(&right));
                }
            }
        }
        let parameters = name.split_once('/').map_or(name, |(_, parameters)| parameters);
        self.found.extend(sums.iter().map(|(mistake, sums)| sums.bias(mistake, parameters, moments.mean)));
    }
}

/// Sums over paired differences.
#[derive(Debug, Default)]
struct Differences {
    count: f64,
    sum: f64,
    squares: f64,
    largest: f64,
    endless: usize,
}

impl Differences {
    fn add(&mut self, difference: f64) {
        self.count += 1.0;
        self.sum += difference;
        self.squares += difference * difference;
        self.largest = self.largest.max(difference * difference);
    }

    fn bias(&self, mistake: &'static str, parameters: &str, exact: f64) -> Bias {
        let mean = self.sum / self.count;
        let variance = (self.squares / self.count - mean * mean).max(0.0) / (self.count - 1.0);
        Bias {
            mistake,
            parameters: parameters.to_owned(),
            relative: mean / exact,
            standard_error: (variance.sqrt() / exact).abs(),
            largest_share: if self.squares > 0.0 { self.largest / self.squares } else { 0.0 },
            endless: self.endless,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KINDS, Kind};
    use std::collections::BTreeMap;

    /// Scripts of each set of parameters on which the page measures.
    const SCRIPTS: usize = 10_000;

    fn measured(kind: &str, mistake: &str, parameters: &str) -> Bias {
        let kind: &Kind = KINDS.iter().find(|known| known.name == kind).unwrap();
        let found = kind.biases(2_000);
        found.into_iter().find(|bias| bias.mistake == mistake && bias.parameters == parameters).unwrap()
    }

    #[test]
    fn biases_with_a_closed_form_are_measured() {
        // exp(c L) - 1, of weights that vary.
        let found = measured("double_particle", "the control's transmittance left out", "residual-0.5");
        let exact = libm::expm1(4.0);
        assert!((found.relative - exact).abs() < 4.0 * found.standard_error, "{found:?}");
        // -exp(-mu L)/T, the same in every run.
        let found = measured("line_integral", "what passes the majorant's medium left out", "hill-2");
        let exact = -libm::exp(11.0 / 8.0 - 2.0);
        assert!((found.relative / exact - 1.0).abs() < 1e-12 && found.z() > CERTAIN, "{found:?}");
        let found = measured("woodcock", "<= for < in the decision to collide", "smoke");
        assert_eq!([found.relative, found.standard_error, found.largest_share], [0.0; 3]);
    }

    #[test]
    fn the_clearest_set_of_parameters_is_told() {
        let of = |relative: f64, standard_error: f64, parameters: &str| {
            let parameters = parameters.to_owned();
            Bias { mistake: "", parameters, relative, standard_error, largest_share: 0.3, endless: 0 }
        };
        for (sets, told) in [
            (vec![], "-"),
            (vec![of(0.0, 0.0, "a")], "none: equal scores"),
            (vec![of(0.0, 0.0, "a"), of(0.01, 0.01, "b")], "none seen (< 5.0 %)"),
            (vec![of(0.0163, 1e-4, "a"), of(0.5, 0.1, "b")], "+1.6 % (a)"),
            (vec![of(-1.0 / 3.0, 0.02, "a"), of(0.0, 0.0, "b")], "-30 % (a)"),
            (vec![of(-0.5, 0.0, "a"), of(-0.25, 1e-9, "b")], "-50 % (a)"),
            (vec![of(143.6, 1.0, "a")], "+14000 % (a)"),
            (vec![of(3.0, 2.0, "a")], "unbounded"),
            (vec![of(0.5, 0.01, "a"), of(f64::NAN, f64::NAN, "b")], "unbounded"),
        ] {
            assert_eq!(Bias::told(&sets), told);
        }
    }

    /// Words of docs/porting/mistakes.md on the bias of each mistake; none of kinds without exact means.
    #[test]
    fn the_page_tells_the_bias_of_each_mistake() {
        let page = include_str!("../../../docs/porting/mistakes.md");
        let (table, _) = page.split_once("## Wrong twins").unwrap();
        let mut measured: BTreeMap<(&str, &str), Vec<Bias>> = BTreeMap::new();
        for kind in KINDS {
            for bias in kind.biases(SCRIPTS) {
                measured.entry((kind.name, bias.mistake)).or_default().push(bias);
            }
        }
        let mut wrong = Vec::new();
        for row in table.lines().filter(|line| line.contains(" of ") && line.starts_with("| ")) {
            let [kind, mistake, _, bias] =
                *row.trim_matches('|').split(" | ").map(str::trim).collect::<Vec<_>>()
            else {
                continue;
            };
            let told = Bias::told(&measured.remove(&(kind, mistake)).unwrap_or_default());
            if bias != told {
                wrong.push(format!("{kind}, {mistake}: {told}"));
            }
        }
        wrong.extend(
            measured
                .into_iter()
                .map(|((kind, mistake), sets)| format!("{kind}, {mistake}: {}", Bias::told(&sets))),
        );
        assert!(wrong.is_empty(), "docs/porting/mistakes.md is to say\n{}", wrong.join("\n"));
    }
}

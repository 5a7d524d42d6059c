//! The test of a mean: exact binomial, normal where that is adequate, an exponential inequality, or none.

use crate::approximation::LEFT_OF_LEVEL;
use crate::bernstein::Bernstein;
use crate::binomial::Binomial;
use crate::binomial_inference::trials_needed;
use crate::evidence::{Evidence, MeanJudgement, p_value_text, relative};
use crate::inequalities::{Inequality, evidence};
use crate::moments::Moments;
use crate::normal_test::{ZTest, z_test};
use crate::policy::{MAX_DETECTABLE_RELATIVE_BIAS, Outcome, POWER};
use crate::reference::{Certainty, Reference, Scores};
use crate::sample_size::{bernstein_law, bernstein_reach, least_sufficient};
use crate::verdict::MeanTest;

/// Judges the mean of n >= 1 samples. The level is alpha for two-valued samples, which have no other test, else alpha/2.
///
/// The z-test decides alone where variance and shape of the law are known, and no single sample decides it; where one does, an inequality has
/// what that test leaves of the level. Elsewhere nothing is rejected but by an inequality whose level holds for every shape; what a normal approximation says is enough to agree there, and
/// no more than that.
pub(crate) fn judge_mean(measured: &Moments, reference: &Reference, mean: f64, alpha: f64) -> MeanJudgement {
    let n = measured.count() as f64;
    if let Scores::TwoValued { high } = reference.scores {
        return binomial(measured.count(), (n * mean / high).round(), reference, high, alpha);
    }
    let level = 0.5 * alpha;
    let closed_variance = reference.closed_moments().and_then(|moments| moments.variance());
    if closed_variance.is_some_and(|variance| reference.is_rounding(variance)) {
        return rounding(reference, mean, "the law has no variance", Some(false));
    }
    let all_equal = closed_variance.is_none()
        && measured.sample_variance().is_some_and(|variance| reference.is_rounding(variance));
    // Samples that agree among themselves but not with the reference prove nothing: a rare large one may be missing.
    let equal = all_equal.then(|| rounding(reference, mean, "all samples are equal", None));
    if let Some(judgement) = equal.as_ref().filter(|judgement| judgement.outcome.is_some()) {
        return judgement.clone();
    }
    let z = z_test(measured, reference, mean, level);
    if let Ok(z) = &z
        && z.may_reject
    {
        return z.decide(level);
    }

    let bernstein = Bounds::of(reference);
    let by_bernstein = bernstein.map(|bounds| bounds.p_value(reference, mean, n));
    // Which test it is hangs on the sample here, and both together must not exceed the level.
    let left = if z.as_ref().is_ok_and(|z| z.shares_level) { LEFT_OF_LEVEL } else { 1.0 };
    let inequality = strongest(evidence(measured, reference, level), by_bernstein)
        .map(|inequality| Inequality { p: (inequality.p / left).min(1.0), ..inequality });
    if let Some(Inequality { p, name }) = inequality
        && p <= level
    {
        let detectable = z.as_ref().ok().and_then(|z| z.detectable);
        let judgement = Evidence {
            test: MeanTest::Inequality,
            p: Some(p),
            level,
            detectable,
            samples_needed: &|| f64::NAN, // a rejection needs none
            name,
        };
        return judgement.decide();
    }
    match z {
        Ok(z) if z.p > level => z.decide(level),
        Ok(z) => unproved(&z, inequality, level),
        Err(normal) => {
            let Some(bounds) = bernstein else { return equal.unwrap_or(normal) };
            let bounded = bounds.evidence(reference, mean, n, level);
            // Whichever test becomes possible first.
            let samples_needed = bounded
                .samples_needed
                .map(|needed| needed.min(normal.samples_needed.unwrap_or(f64::INFINITY)));
            MeanJudgement { samples_needed, ..bounded }
        }
    }
}

impl ZTest {
    fn decide(&self, level: f64) -> MeanJudgement {
        Evidence {
            test: MeanTest::Normal,
            p: Some(self.p),
            level,
            detectable: self.detectable,
            samples_needed: &|| self.samples_needed,
            name: self.name,
        }
        .decide()
    }
}

/// A deviation that a normal approximation alone calls one.
fn unproved(z: &ZTest, inequality: Option<Inequality>, level: f64) -> MeanJudgement {
    let what = match inequality {
        None => "no bound of the second moment of this law is known, and none of its values".to_owned(),
        Some(Inequality { p, name }) => {
            format!("what is known of the law leaves p = {} ({name})", p_value_text(p))
        }
    };
    let reason = format!(
        "not testable at this N: only a normal approximation says that it differs from the reference, p = {}, level {level:.1e} ({}), \
         and events that the sample lacks, or has one too many of, could make up for that; {what}",
        p_value_text(z.p),
        z.name
    );
    MeanJudgement { detectable_relative_bias: z.detectable, ..MeanJudgement::not_testable(None, reason) }
}

/// The smaller p-value of two tests, twice.
fn strongest(inequality: Option<Inequality>, bernstein: Option<f64>) -> Option<Inequality> {
    let Some(bernstein) = bernstein else { return inequality };
    let other = Inequality { p: bernstein, name: "Bernstein bound" };
    let least = match inequality {
        Some(inequality) if inequality.p < bernstein => inequality,
        _ => other,
    };
    Some(Inequality { p: (2.0 * least.p).min(1.0), ..least })
}

/// Agreement up to the allowance of the reference, where there is no variance to measure a deviation by.
///
/// An allowance as large as the bias that should show accepts nothing.
fn rounding(reference: &Reference, mean: f64, why: &str, otherwise: Outcome) -> MeanJudgement {
    let deviation = (mean - reference.mean).abs();
    let detectable = relative(2.0 * reference.allowance(), reference);
    let outcome = match detectable {
        _ if deviation > reference.allowance() => otherwise,
        Some(detectable) if detectable >= MAX_DETECTABLE_RELATIVE_BIAS => None,
        _ => Some(true),
    };
    let reason = match outcome {
        Some(true) => format!("equals the reference to its error and rounding ({why})"),
        Some(false) => {
            format!("differs from the reference by {deviation:.3e}, more than its error and rounding ({why})")
        }
        None => format!("not testable: {why}, and differs from the reference by {deviation:.3e}"),
    };
    MeanJudgement {
        test: if outcome.is_some() { MeanTest::Rounding } else { MeanTest::NotTestable },
        outcome,
        p: None,
        detectable_relative_bias: detectable.filter(|_| outcome.is_some()),
        samples_needed: None,
        reason,
    }
}

/// The exact test of a number of successes.
///
/// The reference's error widens p to an interval: the p-value is that of the value in it which suits the count best.
fn binomial(n: u64, successes: f64, reference: &Reference, high: f64, level: f64) -> MeanJudgement {
    let p = (reference.mean / high).clamp(0.0, 1.0);
    // Unlike sums of weights, counts are exact: what is granted beyond the error is the rounding of p alone.
    let rounding = if p < 1.0 { 4.0 * f64::EPSILON * (1.0 - p.ln()) * p } else { 0.0 };
    let rounding = if p > 0.0 { rounding } else { 0.0 };
    let (low, most) = match reference.certainty {
        Certainty::Certified => (reference.mean - reference.error, reference.mean + reference.error),
        Certainty::Estimated { low, high } => (low, high),
    };
    let ends = [low / high, most / high];
    let least = (ends[0].min(ends[1]) - rounding).clamp(0.0, 1.0);
    let greatest = (ends[0].max(ends[1]) + rounding).clamp(least, 1.0);
    let slack = reference.uncertainty() / high.abs() + rounding;
    let closest = (successes / n as f64).clamp(least, greatest);
    let p_value = Binomial::new(n, closest).ok().map(|law| law.two_sided_p_value(successes as u64));
    let detectable = Binomial::new(n, p)
        .ok()
        .and_then(|law| law.detectable_relative_deviation(level, POWER))
        .map(|deviation| deviation + 2.0 * slack / p);
    // An error of the reference that hides the bias leaves less to detect, or nothing.
    let room = MAX_DETECTABLE_RELATIVE_BIAS - 2.0 * slack / p;
    let samples_needed = || if room > 0.0 { trials_needed(p, level, POWER, room) } else { f64::INFINITY };
    Evidence {
        test: MeanTest::Binomial,
        p: p_value,
        level,
        detectable,
        samples_needed: &samples_needed,
        name: "exact binomial",
    }
    .decide()
}

/// Facts about bounded samples that Bernstein's inequality needs.
#[derive(Clone, Copy)]
struct Bounds(Bernstein);

impl Bounds {
    fn of(reference: &Reference) -> Option<Self> {
        bernstein_law(reference).map(Self)
    }

    fn p_value(&self, reference: &Reference, mean: f64, n: f64) -> f64 {
        self.0.p_value(((mean - reference.mean).abs() - reference.allowance()).max(0.0), n)
    }

    /// Power of the inequality, where the mean was not rejected.
    fn evidence(&self, reference: &Reference, mean: f64, n: f64, level: f64) -> MeanJudgement {
        let detectable = |n: f64| relative(bernstein_reach(&self.0, reference, level, n), reference);
        let enough = |n: f64| detectable(n).is_some_and(|d| d < MAX_DETECTABLE_RELATIVE_BIAS);
        Evidence {
            test: MeanTest::Bernstein,
            p: Some(self.p_value(reference, mean, n)),
            level,
            detectable: detectable(n),
            samples_needed: &|| least_sufficient(enough),
            name: "Bernstein bound",
        }
        .decide()
    }
}

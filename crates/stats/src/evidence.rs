//! Judgement of the mean from a p-value and a power.

use crate::policy::{MAX_DETECTABLE_RELATIVE_BIAS, Outcome};
use crate::reference::Reference;
use crate::verdict::MeanTest;

/// Result of the test of the mean.
#[derive(Clone)]
pub(crate) struct MeanJudgement {
    pub(crate) test: MeanTest,
    pub(crate) outcome: Outcome,
    pub(crate) p: Option<f64>,
    pub(crate) detectable_relative_bias: Option<f64>,
    pub(crate) samples_needed: Option<f64>,
    pub(crate) reason: String,
}

impl MeanJudgement {
    /// No test, or none that says anything.
    pub(crate) fn not_testable(samples_needed: Option<f64>, reason: String) -> Self {
        Self {
            test: MeanTest::NotTestable,
            outcome: None,
            p: None,
            detectable_relative_bias: None,
            samples_needed,
            reason,
        }
    }
}

/// A test whose level holds, before its decision.
pub(crate) struct Evidence<'a> {
    pub(crate) test: MeanTest,
    pub(crate) p: Option<f64>,
    pub(crate) level: f64,
    pub(crate) detectable: Option<f64>,
    /// Asked only where the test lacks power, as the answer may take a search.
    pub(crate) samples_needed: &'a dyn Fn() -> f64,
    pub(crate) name: &'static str,
}

impl Evidence<'_> {
    /// Rejects on a small p-value alone; accepts only with power.
    ///
    /// Only the z-test accepts against a reference of zero: its standard error says what is detectable in absolute terms,
    /// as for differences whose mean should vanish. For counts and bounds a zero is as good as an underflow.
    pub(crate) fn decide(self) -> MeanJudgement {
        let Evidence { test, p, level, detectable, samples_needed, name } = self;
        let rejected = p.is_some_and(|p| p <= level);
        let powerful = match detectable {
            Some(detectable) => detectable < MAX_DETECTABLE_RELATIVE_BIAS,
            None => test == MeanTest::Normal,
        };
        let outcome = if rejected { Some(false) } else { powerful.then_some(true) };
        let p_text = p.map_or("unknown".to_owned(), p_value_text);
        let power_text = detectable
            .map_or("the reference is zero and no relative bias is defined".to_owned(), |detectable| {
                format!("a relative bias shows from {detectable:.2e} on")
            });
        let reason = match outcome {
            Some(false) => format!("differs from the reference: p = {p_text}, level {level:.1e} ({name})"),
            Some(true) => format!("agrees with the reference: p = {p_text}, {power_text} ({name})"),
            None => format!("not testable at this N: p = {p_text}, but {power_text} ({name})"),
        };
        MeanJudgement {
            test,
            outcome,
            p,
            detectable_relative_bias: detectable,
            samples_needed: outcome.is_none().then(samples_needed),
            reason,
        }
    }
}

/// A deviation in units of the reference; `None` for a reference of zero.
pub(crate) fn relative(deviation: f64, reference: &Reference) -> Option<f64> {
    (reference.mean != 0.0).then(|| deviation / reference.mean.abs())
}

/// A p-value for people: decimals where they tell it, a power of ten where they do not.
pub(crate) fn p_value_text(p: f64) -> String {
    if p >= 0.001 { format!("{p:.3}") } else { format!("{p:.1e}") }
}

//! The ledger of claims.

use serde::Serialize;

/// One line of the ledger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// S1 …
    pub id: String,
    /// The paper's claim, in our words.
    pub claim: String,
    /// Its place in the paper.
    pub source: String,
    /// Our measurement, with its interval.
    pub measured: String,
    /// The verdict.
    pub verdict: ClaimVerdict,
    /// Condition of the verdict, or its reason.
    pub comment: String,
}

impl Claim {
    /// A line of the ledger: its place in it and its source, the claim, the measurement, the verdict and its comment.
    pub fn new(
        (id, source): (&str, &str),
        claim: impl Into<String>,
        measured: String,
        (verdict, comment): (ClaimVerdict, impl Into<String>),
    ) -> Self {
        let (claim, comment) = (claim.into(), comment.into());
        Self { id: id.to_owned(), claim, source: source.to_owned(), measured, verdict, comment }
    }
}

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ClaimVerdict {
    /// As printed.
    Holds,
    /// Under a condition that the comment names.
    HoldsUnder,
    /// Not.
    DoesNotHold,
    /// This N cannot tell.
    NotTestable,
}

impl ClaimVerdict {
    /// Verdicts, from best to worst.
    pub(crate) const ALL: [Self; 4] = [Self::Holds, Self::HoldsUnder, Self::DoesNotHold, Self::NotTestable];

    /// The verdict of a criterion that is met or not.
    #[must_use]
    pub fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }

    /// The verdict of a criterion that each of several cases meets or not.
    #[must_use]
    pub fn of_cases(cases: impl IntoIterator<Item = bool>) -> Self {
        let cases: Vec<bool> = cases.into_iter().collect();
        match [true, false].map(|is_met| cases.contains(&is_met)) {
            [true, false] => Self::Holds,
            [true, true] => Self::HoldsUnder,
            _ => Self::DoesNotHold,
        }
    }

    /// The verdict in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsUnder => "holds under a condition",
            Self::DoesNotHold => "does not hold",
            Self::NotTestable => "not testable",
        }
    }
}

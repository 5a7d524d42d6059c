//! The ledger: claims of szirmay-kalos-2017 on transmittance, measured again. A claim that fails is as valuable as one that
//! holds; the criterion of each verdict stands in its file.

mod band;
mod case;
mod control;
mod formula;
mod images;
mod majorant;
mod versions;

use super::{Effort, Run, Subject};
use crate::standard::result::{ImageStudy, MediumReport};
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::parallel::try_in_parallel;
use std::fmt::Display;

/// All that a claim is judged from.
#[derive(Clone, Copy)]
struct Evidence<'a> {
    run: &'a Run<'a>,
    effort: Effort,
    subjects: &'a [Subject],
    media: &'a [MediumReport],
    images: &'a [ImageStudy],
}

/// Standard errors that a measurement may be off before it counts against a claim: one in 15 000.
const SIGMAS: f64 = 4.0;

type Judge = fn(&Evidence<'_>) -> Result<Claim, Failure>;

const JUDGES: [Judge; 7] =
    [formula::s1, majorant::s2, majorant::s3, versions::s4, images::s7, control::s8, band::s10];

/// Steps of progress of [`ledger`].
pub(super) fn steps() -> u64 {
    JUDGES.len() as u64
}

/// The claims, in the order of the project's ledger.
pub(super) fn ledger(
    run: &Run<'_>,
    subjects: &[Subject],
    media: &[MediumReport],
    images: &[ImageStudy],
) -> Result<Vec<Claim>, Failure> {
    let evidence = Evidence { run, effort: Effort::of(run.options.quick), subjects, media, images };
    try_in_parallel(JUDGES.len(), &|i| {
        let claim = JUDGES[i](&evidence);
        run.advance();
        claim
    })
}

impl Evidence<'_> {
    /// The seed of a measurement, by its name: "claim/case".
    fn seed(&self, name: impl Display) -> u64 {
        self.run.seed(format_args!("claims/{name}"))
    }

    /// The analytic medium is always studied, and first.
    fn analytic(&self) -> &Subject {
        &self.subjects[0]
    }
}

fn claim(id: &str, words: &str, measured: String, verdict: ClaimVerdict, comment: &str) -> Claim {
    let place = match id {
        "S7" => "fig. 9, 10",
        "S10" => "fig. 8",
        _ => "section 3.4",
    };
    let source = format!("szirmay-kalos-2017 {place}");
    Claim::new((id, &source), words, measured, (verdict, comment))
}

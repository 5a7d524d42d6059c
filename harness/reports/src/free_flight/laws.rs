//! Every sampler of distances on every medium, by the law that `harness verify` checks too.

use crate::laws::Laws;
use fairflight_document::{Cell, Section, Table};

/// The part of the catalogue.
pub(super) const CHECKS: &str = "freeflight/";

pub(super) fn section(laws: &Laws) -> Section {
    let text = "Weighted flights integrate any test function against σ_t T, and those that escape weigh T on average. Four test functions and \
         the escaped weight are judged against quadrature, their variances against the closed form, the number of look-ups against its \
         law, and the distances of samplers without weights against their distribution (Kolmogorov and Smirnov). \"Detectable\" is the \
         smallest relative bias that the run would have found with probability 0.99; the false alarm of the whole table is below 10⁻⁶.";
    let table = Table::of(
        ["laws-table", "Laws of free flight", ""],
        &laws.0,
        &[
            ("medium and sampler", "", &|(id, _)| Cell::text(id.as_str())),
            ("verdict", "", &|(_, result)| Cell::text(Laws::verdict(result))),
            ("flights", "1", &|(_, result)| Cell::Count(result.samples)),
            ("largest z of a mean", "1", &|(_, result)| Cell::maybe(result.mean_z)),
            ("z of the look-ups", "1", &|(_, result)| Cell::maybe(result.lookups_z)),
            ("detectable", "1", &|(_, result)| Cell::maybe(result.detectable_relative_bias)),
        ],
    );
    Section::new("laws", "The law of every sampler").with(text).with(table)
}

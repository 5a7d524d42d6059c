//! Looks of estimators: the same label has the same colour, mark and dash in all reports.

use super::standard::Series;
use fairflight_harness::comparison::{entrants, others};

/// Labels with the numbers of their looks: the series of the standard report, then all other entrants of comparisons, in their order.
pub(crate) fn looks() -> Vec<(String, usize)> {
    let mut labels: Vec<&str> = Series::LABELLED.map(|(_, label)| label).to_vec();
    for entrant in entrants().into_iter().chain(others()) {
        if !labels.contains(&entrant.name) {
            labels.push(entrant.name);
        }
    }
    labels.into_iter().zip(0..).map(|(label, number)| (label.to_owned(), number)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_estimator_has_a_look_of_its_own() {
        // As many as there are colours.
        assert!(looks().len() <= 40);
        for (k, (label, number)) in looks().into_iter().enumerate() {
            assert_eq!(k, number, "{label}");
        }
    }
}

//! The look of each label, the same in all charts and heat maps of a document.

use super::super::palette::{Rgb, SERIES, Style, look};
use super::heat_map;
use crate::report::document::{Curve, Document, Role};
use crate::report::result::Series;

/// The order in which labels that are no series of the standard report get looks: neighbours differ in hue as far as they can, and
/// the black of reference lines comes last.
const ORDER: [Series; 10] = [
    Series::DoubleParticle,
    Series::Terminating,
    Series::LineIntegral,
    Series::Adaptive,
    Series::JitteredRayMarching,
    Series::DoubleParticleExplorers,
    Series::NonTerminating,
    Series::DoubleParticleMean,
    Series::RayMarching,
    Series::Woodcock,
];

/// What is compared with, told apart by the dash alone.
const DASHES: [&[f64]; 4] = [&[], &[20.0, 7.0], &[9.0, 6.0], &[4.0, 5.0]];

/// A look per label and role.
pub(super) struct Styles {
    known: Vec<(Role, String, Style)>,
}

impl Styles {
    /// Labels get looks in the order in which they first appear, those of curves before those of heat maps; a label that is the name of
    /// a series of the standard report looks as it does there. Beyond ten labels a colour comes back with another mark and dash.
    pub(super) fn of(document: &Document) -> Self {
        let sections = || document.sections.iter();
        let curves = sections().flat_map(|section| &section.charts).flat_map(|chart| &chart.curves);
        let names = sections().flat_map(|section| &section.heat_maps).flat_map(heat_map::names_in);
        let mut labels: Vec<(Role, &str)> = curves.map(|curve| (curve.role, &*curve.label)).collect();
        labels.extend(names.map(|name| (Role::Method, name)));
        let named = |label: &str| SERIES.into_iter().find(|&series| look(series).name == label);
        let taken: Vec<Series> = labels.iter().filter_map(|label| named(label.1)).collect();
        let free: Vec<Style> = ORDER
            .into_iter()
            .filter(|series| !taken.contains(series))
            .map(|series| look(series).style())
            .collect();
        let mut styles = Self { known: Vec::new() };
        let (mut methods, mut references) = (0, 0);
        for (role, label) in labels {
            if styles.find(role, label).is_some() {
                continue;
            }
            let style = match (role, named(label)) {
                (Role::Method, Some(series)) => look(series).style(),
                (Role::Method, None) => {
                    methods += 1;
                    nth(&free, methods - 1)
                }
                (Role::Reference, _) => {
                    references += 1;
                    let dash = DASHES[(references - 1) % DASHES.len()];
                    Style { dash, ..look(Series::Woodcock).style() }
                }
            };
            styles.known.push((role, label.to_owned(), style));
        }
        styles
    }

    /// The look of a curve of the document.
    pub(super) fn style(&self, curve: &Curve) -> Style {
        self.known_or_black(curve.role, &curve.label)
    }

    /// The colour of a name in the document.
    pub(super) fn colour(&self, name: &str) -> Rgb {
        self.known_or_black(Role::Method, name).colour
    }

    fn known_or_black(&self, role: Role, label: &str) -> Style {
        self.find(role, label).unwrap_or_else(|| look(Series::Woodcock).style())
    }

    fn find(&self, role: Role, label: &str) -> Option<Style> {
        let same = |known: &&(Role, String, Style)| known.0 == role && known.1 == label;
        self.known.iter().find(same).map(|known| known.2)
    }
}

/// The looks in turn; in the next round each colour has the mark and the dash of a neighbour further on.
fn nth(free: &[Style], k: usize) -> Style {
    // If the names of all ten series are taken, others share looks with them.
    let all: Vec<Style>;
    let looks = if free.is_empty() {
        all = ORDER.into_iter().map(|series| look(series).style()).collect();
        &all
    } else {
        free
    };
    let (round, place) = (k / looks.len(), k % looks.len());
    let other = looks[(place + round) % looks.len()];
    Style { colour: looks[place].colour, ..other }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::document::{Axis, Chart, Section};

    fn document(labels: &[String]) -> Document {
        let mut document = super::super::fixture::document();
        let mut chart = Chart::new("a", "", Axis::linear(""), Axis::linear(""));
        chart.curves = labels.iter().map(|label| Curve::method(label)).collect();
        let mut section = Section::new("s", "");
        section.charts.push(chart);
        document.sections = vec![section];
        document
    }

    #[test]
    fn twenty_labels_have_twenty_looks() {
        let labels: Vec<String> = (0..20).map(|k| format!("method {k}")).collect();
        let styles = Styles::of(&document(&labels));
        let looks: Vec<Style> = labels.iter().map(|label| styles.style(&Curve::method(label))).collect();
        for (i, a) in looks.iter().enumerate() {
            assert!(looks[..i].iter().all(|b| a != b), "{i}");
        }
    }

    #[test]
    fn series_of_the_standard_report_keep_their_look_and_nobody_else_has_it() {
        let labels = ["another".to_owned(), "Double particle".to_owned(), "a third".to_owned()];
        let styles = Styles::of(&document(&labels));
        let at = |k: usize| styles.style(&Curve::method(&labels[k]));
        assert_eq!(at(1), look(Series::DoubleParticle).style());
        assert!(at(0) != at(1) && at(2) != at(1) && at(0) != at(2));
    }

    #[test]
    fn a_name_in_a_heat_map_has_the_colour_of_its_curve() {
        let document = super::super::fixture::document();
        let styles = Styles::of(&document);
        assert_eq!(styles.colour("spectral"), styles.style(&Curve::method("spectral")).colour);
        let names = heat_map::names_in(&document.sections[0].heat_maps[1]);
        assert!(names.len() > 3);
        for (k, name) in names.iter().enumerate() {
            assert!(names[..k].iter().all(|other| styles.colour(other) != styles.colour(name)), "{name}");
        }
    }
}

//! The report in words and figures: a document made of its numbers.

mod answer;
mod convergence;
mod pictures;
mod ray;
mod sweeps;
mod tables;

use super::result::{MediumReport, RayFacts, Report};
use fairflight_document::{Block, Document, Section, short};

/// The document of a report; `empty` says where its numbers come from.
pub(super) fn of(report: &Report, empty: Document) -> Document {
    let mut sections: Vec<Section> =
        report.media.iter().flat_map(|medium| [section(medium), details(report, medium)]).collect();
    if !report.stability.is_empty() {
        sections.push(Section::new("hard-cases", "Hard cases").with(tables::hard_cases(&report.stability)));
    }
    Document {
        summary: answer::summary(report),
        hero: report.media.first().map(|medium| sweeps::variance_id(medium, sweeps::middle_albedo(medium))),
        unsound: report.unsound.clone(),
        claims: report.claims.clone(),
        sections,
        ..empty
    }
}

/// The figures of the answer.
fn section(medium: &MediumReport) -> Section {
    let albedo = sweeps::middle_albedo(medium);
    Section::new(&medium.id, &medium.title)
        .with(format!("{}.", medium.description))
        .with(facts(&medium.ray))
        .with(sweeps::variance(medium, albedo))
        .with(sweeps::efficiency_per_lookup(medium))
        .with_all(convergence::charts(medium))
        .with(tables::estimators(medium))
        .with(tables::optima(medium))
}

/// Figures of detail, in a section that the page folds.
fn details(report: &Report, medium: &MediumReport) -> Section {
    let studies: Vec<_> = report.images.iter().filter(|study| study.medium == medium.id).collect();
    let title = format!("{}: albedos, look-ups, the ray, images", medium.title);
    let section = Section::new(&format!("{}-details", medium.id), &title)
        .with_all(sweeps::variance_at_other_albedos(medium))
        .with(sweeps::lookups(medium))
        .with(sweeps::efficiency_per_second(medium))
        .with(ray::anatomy(medium))
        .with(ray::functions(medium))
        .with_all(studies.iter().map(|study| pictures::gallery(study)));
    let section = section.with(tables::limits(medium));
    let section = if studies.is_empty() { section } else { section.with(tables::images(medium, &studies)) };
    section.folded()
}

fn facts(ray: &RayFacts) -> Block {
    let vector = |v: [f64; 3]| format!("({})", v.map(short).join(", "));
    let thickness = format!("{} ± {}", ray.optical_thickness, short(ray.optical_thickness_error));
    let facts = [
        ("entry", vector(ray.entry)),
        ("direction", vector(ray.direction)),
        ("length", short(ray.length)),
        ("optical thickness", thickness),
        ("transmittance T", format!("{}", ray.transmittance)),
        ("greatest σ_t", short(ray.maximum)),
        ("mean σ_t", short(ray.mean)),
    ];
    Block::Facts(facts.map(|(name, value)| (name.to_owned(), value)).to_vec())
}

/// Powers of ten about values that are given as logarithms, within limits that are logarithms too.
fn decades(log10: impl Iterator<Item = f64>, [least, most]: [f64; 2]) -> [f64; 2] {
    let finite = log10.filter(|x| x.is_finite()).map(|x| x.clamp(least, most));
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let (low, high) = if low <= high { (low.floor(), high.ceil()) } else { (0.0, 1.0) };
    [low, high.max(low + 1.0)].map(|exponent| 10_f64.powf(exponent))
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;
    use fairflight_document::{Provenance, Script, files};

    fn document(report: &Report) -> Document {
        of(report, Document::new("standard", "A report", Provenance::default()))
    }

    #[test]
    fn made_up_numbers_make_a_document_with_all_figures() {
        let document = document(&fixture::report());
        let files = files(&document, Script::None).unwrap();
        let has = |name: &str| files.iter().any(|file| file.name == name);
        for figure in [
            "variance-albedo-0",
            "variance-albedo-0.5",
            "variance-albedo-0.9",
            "lookups",
            "efficiency-per-lookup",
            "efficiency-per-second",
            "error-against-lookups",
            "error-against-seconds",
            "anatomy",
            "functions",
        ] {
            for ending in ["svg", "png", "csv"] {
                assert!(has(&format!("eq21-{figure}.{ending}")), "{figure}.{ending}");
            }
        }
        assert!(has("eq21-estimators.csv") && has("eq21-optima.csv") && has("hard-cases-rows.csv"));
        assert!(has("eq21-images-10-exact.png") && has("eq21-images-10-2-error.png"));
        assert_eq!(document.hero.as_deref(), Some("eq21-variance-albedo-0.5"));
        let text = |name: &str| {
            let file = files.iter().find(|file| file.name == name).unwrap();
            String::from_utf8(file.bytes.clone()).unwrap()
        };
        let page = text("index.html");
        assert!(page.contains("1 of 1 right") && page.contains("There is no best"), "the answer is told");
        assert!(!page.contains("<length>"), "text of the report is escaped");
        assert!(!page.contains("NaN"), "a number that does not exist is no number");
    }

    #[test]
    fn a_volume_is_told_apart_from_advice_on_it() {
        let mut report = fixture::report();
        let says = |report: &Report| document(report).summary.concat().contains("harness advise --vdb");
        assert!(!says(&report));
        report.media[0].id = super::super::subject::VOLUME.to_owned();
        assert!(says(&report));
    }

    #[test]
    fn an_empty_report_is_still_a_report() {
        let mut report = fixture::report();
        for medium in &mut report.media {
            (medium.sweeps, medium.convergence) = (Vec::new(), Vec::new());
            (medium.optima, medium.estimators) = (Vec::new(), Vec::new());
            (medium.findings.per_lookup, medium.findings.per_second) = (Vec::new(), Vec::new());
            medium.findings.limits.clear();
        }
        (report.images, report.claims, report.stability) = (Vec::new(), Vec::new(), Vec::new());
        files(&document(&report), Script::None).unwrap();
        report.media.clear();
        files(&document(&report), Script::None).unwrap();
    }

    #[test]
    fn axes_are_whole_decades_within_their_limits() {
        assert_eq!(decades([0.3, 1.2, f64::NEG_INFINITY].into_iter(), [-6.0, 12.0]), [1.0, 100.0]);
        assert_eq!(decades([-9.0, 40.0].into_iter(), [-6.0, 12.0]), [1e-6, 1e12]);
        assert_eq!(decades(std::iter::empty(), [-6.0, 12.0]), [1.0, 10.0]);
    }
}

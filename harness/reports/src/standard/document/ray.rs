//! Figures of the ray itself: its anatomy (szirmay-kalos-2017 fig. 5) and sample transmittance functions (fig. 8).

use super::super::result::{Anatomy, MediumReport, SampleFunctions};
use fairflight_document::{Arrangement, Axis, Chart, Curve, Mark, Panel, short};

const DISTANCE: &str = "distance s along the ray [length]";
const TRANSMITTANCE: &str = "transmittance T(0, s) [1]";
/// A single wild walk must not squeeze all others.
const LIMITS: [f64; 2] = [-1.0, 2.5];

/// Points of a curve that have a place.
fn together<'a>(s: &'a [f64], y: &'a [f64]) -> impl Iterator<Item = (f64, Option<f64>)> + 'a {
    s.iter().zip(y).map(|(&s, &y)| (s, Some(y).filter(|y| y.is_finite())))
}

fn marks(points: &[[f64; 2]]) -> impl Iterator<Item = Mark> + '_ {
    points.iter().map(|&[s, sigma_t]| Mark::at(s, sigma_t))
}

/// An axis that shows values as far as they stay within the limits.
fn within(title: &str, values: impl Iterator<Item = f64>) -> Axis {
    let clamped = values.filter(|x| x.is_finite()).map(|x| x.clamp(LIMITS[0], LIMITS[1]));
    let (low, high) = clamped.fold((0.0_f64, 1.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    Axis::linear(title).within(low, 1.05 * high)
}

fn last(values: &[f64]) -> String {
    values.last().map_or_else(|| "—".to_owned(), |&x| short(x))
}

/// Extinction and control above, transmittance below.
pub(super) fn anatomy(medium: &MediumReport) -> Chart {
    let Anatomy { sigma_samp, s, sigma_t, sigma_main, transmittance, sampled, explorers, interactions } =
        &medium.anatomy;
    let ends = s.first().into_iter().chain(s.last()).map(|&end| (end, *sigma_samp));
    let area = s.iter().zip(sigma_t).map(|(&s, &y)| (s, [y.min(0.0), y.max(0.0)]));
    let upper = vec![
        Curve::method("explorers").with_marks(marks(explorers)),
        Curve::method("interaction points").with_marks(marks(interactions)),
        Curve::method("control σ_main").with_gaps(together(s, sigma_main)),
        Curve::reference("sampling extinction σ_samp", ends),
        Curve::method("extinction σ_t").with_gaps(together(s, sigma_t)).with_area(area),
    ];
    let exact = s.iter().copied().zip(transmittance.iter().copied());
    let lower = vec![
        Curve::reference("exact T(0, s)", exact),
        Curve::method("sampled T(0, s)").with_gaps(together(s, sampled)),
    ];
    let x = || Axis::linear(DISTANCE);
    let panels = vec![
        Panel { curves: upper, ..Panel::new("", x(), Axis::linear("extinction [1/length]")) },
        Panel { curves: lower, ..Panel::new("", x(), within(TRANSMITTANCE, sampled.iter().copied())) },
    ];
    let chart = Chart::of(&format!("{}-anatomy", medium.id), "Anatomy of the ray", panels);
    Chart { arrangement: Arrangement::Column, ..chart }.with_caption(format!(
        "One walk with σ_samp = {} and a control through {} explorers has {} interaction points; at the end of the ray it samples {} \
         where the transmittance is {}.",
        short(*sigma_samp),
        explorers.len(),
        interactions.len(),
        last(sampled),
        last(transmittance)
    ))
}

/// Sampled functions about the exact one.
pub(super) fn functions(medium: &MediumReport) -> Chart {
    let SampleFunctions { s, transmittance, standard_deviation, samples, .. } = &medium.functions;
    let band: Vec<[f64; 2]> =
        transmittance.iter().zip(standard_deviation).map(|(t, sd)| [t - sd, t + sd]).collect();
    let exact = Curve::reference(
        "exact T(0, s) ± one standard deviation (eq. 16)",
        s.iter().copied().zip(transmittance.iter().copied()),
    );
    let mut curves = vec![exact.with_area(s.iter().copied().zip(band.iter().copied()))];
    let end = |sample: &[f64]| Some(Mark::at(*s.last()?, *sample.last()?));
    let sampled = |sample: &Vec<f64>| {
        Curve::method("sampled T(0, s)").with_gaps(together(s, sample)).with_marks(end(sample))
    };
    curves.extend(samples.iter().map(sampled));
    let values = samples.iter().flatten().copied().chain(band.iter().flatten().copied());
    let y = within(TRANSMITTANCE, values);
    let caption = share_within(samples, &band).map_or_else(String::new, |share| {
        format!(
            "{} % of all values of {} sampled functions lie within one standard deviation of T, which at the end of the ray is {} for T = {}.",
            short(100.0 * share),
            samples.len(),
            last(standard_deviation),
            last(transmittance)
        )
    });
    Chart::new(
        &format!("{}-functions", medium.id),
        "Sample transmittance functions",
        Axis::linear(DISTANCE),
        y,
    )
    .with_curves(curves)
    .with_caption(caption)
}

/// The share of all sampled values that lie within the band; T(0, 0) is exact and counts for nothing.
fn share_within(samples: &[Vec<f64>], band: &[[f64; 2]]) -> Option<f64> {
    let pairs = samples.iter().flat_map(|sample| sample.iter().zip(band));
    let counted: Vec<bool> = pairs
        .filter(|(_, [low, high])| high > low)
        .map(|(x, [low, high])| (low..=high).contains(&x))
        .collect();
    let inside = counted.iter().filter(|inside| **inside).count();
    (!counted.is_empty()).then(|| inside as f64 / counted.len() as f64)
}

//! Fig. 12: all methods at equal look-ups per pixel.

use super::methods::{self, Method};
use super::{LIGHTINGS, Lighting, REPLICAS};
use crate::measured::Measured;
use crate::replicas::{Replicas, Subject};
use crate::run::{Part, Run};
use fairflight_document::{Cell, Gallery, Section, Table};
use fairflight_harness::Failure;
use fairflight_sources::named_seed;

/// Look-ups per pixel, averaged over all, as in the paper.
pub(super) const BUDGETS: [f64; 2] = [300.0, 50.0];

pub(super) fn steps() -> u64 {
    (LIGHTINGS.len() * (1 + BUDGETS.len() * methods::all(1.0).len())) as u64
}

/// One method at one budget.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) name: &'static str,
    pub(super) is_baseline: bool,
    pub(super) rmse: Measured,
    image: Replicas,
}

/// All methods at one budget.
#[derive(Debug)]
pub(super) struct Budget {
    pub(super) lookups: f64,
    pub(super) entries: Vec<Entry>,
}

impl Budget {
    /// The unbiased methods, least error first.
    pub(super) fn ranking(&self) -> Vec<&Entry> {
        let mut ranking: Vec<&Entry> = self.entries.iter().filter(|entry| !entry.is_baseline).collect();
        ranking.sort_by(|a, b| a.rmse.value.total_cmp(&b.rmse.value));
        ranking
    }
}

/// What one lighting came to.
#[derive(Debug)]
pub(super) struct Study {
    pub(super) lighting: &'static Lighting,
    pub(super) budgets: Vec<Budget>,
    /// Section, and unbiased methods whose mean image is not that of the closed form.
    pub(super) part: Part,
}

/// The exact image and its mean squared error.
struct Reference {
    pixels: Vec<f64>,
    squared_error: f64,
    shown: Replicas,
}

pub(super) fn study(run: &Run<'_>, lighting: &'static Lighting) -> Result<Study, Failure> {
    let subject = lighting.subject(run.resolution());
    let exact = methods::closed_form("closed form", 32);
    let rays = run.quick_or(8, 64);
    let seed = run.seed(format_args!("equal-cost/{}/closed form", lighting.id));
    let closed = subject.with("integrator", exact.integrator);
    let shown = closed.measure(rays, (seed, REPLICAS), &run.media)?;
    run.advance();
    let (pixels, squared_error) = shown.mean();
    let reference = Reference { pixels, squared_error, shown };
    let (mut budgets, mut unsound) = (Vec::new(), Vec::new());
    for lookups in BUDGETS {
        let mut entries = Vec::new();
        // Rays that miss the medium look nothing up: the others may spend their share.
        let per_ray = lookups / share_that_meets(&reference);
        for method in methods::all(per_ray) {
            let seed = run.seed(format_args!("equal-cost/{}/{lookups}/{}", lighting.id, method.name));
            let entry = entry(run, &subject, method, (lookups, seed), &reference)?;
            unsound.extend(bias(&entry, &reference, lighting));
            entries.push(entry);
            run.advance();
        }
        budgets.push(Budget { lookups, entries });
    }
    let part = Part { section: section(run, lighting, &budgets, &reference), unsound };
    Ok(Study { lighting, budgets, part })
}

/// The share of pixels whose rays look anything up: those of the disc that the sphere of eq. 21 fills, by the look-ups of the exact
/// image, whose explorers are four to each ray that meets it.
fn share_that_meets(reference: &Reference) -> f64 {
    let lit = reference.shown.first().lookups_per_pixel();
    // Sixteen explorers for four rays, and a look-up for each of 64 samples: 68 per ray.
    (lit / (f64::from(reference.shown.rays_per_pixel()) * 68.0)).clamp(1e-3, 1.0)
}

fn entry(
    run: &Run<'_>,
    subject: &Subject,
    method: Method,
    (lookups, seed): (f64, u64),
    reference: &Reference,
) -> Result<Entry, Failure> {
    let subject = subject.with("integrator", method.integrator);
    let rays = if method.is_baseline {
        1
    } else {
        let pilot = subject.render(2, named_seed(seed, "pilot"), &run.media)?;
        (2.0 * lookups / pilot.lookups_per_pixel()).round().max(1.0) as u32
    };
    let image = subject.measure(rays, (seed, REPLICAS), &run.media)?;
    let error = image.squared_difference(&reference.pixels, reference.squared_error);
    Ok(Entry { name: method.name, is_baseline: method.is_baseline, rmse: error.map(f64::sqrt), image })
}

/// Five standard errors between the mean radiances of an unbiased method and of the closed form are one too many.
fn bias(entry: &Entry, reference: &Reference, lighting: &Lighting) -> Option<String> {
    if entry.is_baseline {
        return None;
    }
    let (mean, squared_error) = entry.image.mean();
    let n = mean.len() as f64;
    let difference = mean.iter().zip(&reference.pixels).map(|(found, exact)| found - exact).sum::<f64>() / n;
    // Squared errors of independent pixels, averaged, over their number.
    let (own, of_reference) = match entry.image.variance_is_known() {
        true => (squared_error, reference.squared_error),
        false => (entry.rmse.value.powi(2) / f64::from(REPLICAS), reference.squared_error),
    };
    let standard_error = ((own + of_reference) / n).sqrt();
    (difference.abs() > 5.0 * standard_error).then(|| {
        format!(
            "{} under {}: mean radiance off by {difference:.2e}, {:.1} standard errors",
            entry.name,
            lighting.id,
            difference / standard_error
        )
    })
}

fn section(run: &Run<'_>, lighting: &Lighting, budgets: &[Budget], reference: &Reference) -> Section {
    let text = format!(
        "szirmay-kalos-2017 eq. 21 with albedo 0.7 and Rayleigh scattering, the light in its center, {0} x {0} pixels. Each method spends \
         the same number of look-ups per pixel on average over all pixels, on as many camera rays as that gives. Tracking of the camera \
         ray has σ_samp = 0.5 and 16 explorers, shared by four rays in a row; shadow rays are ratio tracking at 0.8. Ray marching has one ray \
         per pixel, whose equal steps spend the budget on the rays that meet the medium. The error is the root of the mean squared difference \
         from the image in closed form, whose own error ({1:.1e}) is taken off; intervals are 95 %, from {2} independent images.",
        run.resolution(),
        reference.squared_error.sqrt(),
        REPLICAS
    );
    let mut section = Section::new(
        &format!("{}-equal-cost", lighting.id),
        &format!("Fig. 12: equal look-ups per pixel, {}", lighting.words),
    )
    .with(text);
    for budget in budgets {
        let id = format!("{}-{}", lighting.id, budget.lookups);
        section = section.with(table(&id, budget)).with(gallery(&id, lighting, budget, reference));
    }
    section
}

fn table(id: &str, budget: &Budget) -> Table {
    Table::of(
        [&format!("{id}-table"), &format!("{} look-ups per pixel", budget.lookups), ""],
        &budget.entries,
        &[
            ("method", "", &|entry| Cell::text(entry.name)),
            ("camera rays per pixel", "1", &|entry| Cell::Count(entry.image.rays_per_pixel().into())),
            ("look-ups per pixel", "1", &|entry| Cell::Number(entry.image.lookups_per_pixel())),
            ("RMSE", "radiance", &|entry| entry.rmse.cell()),
            ("CPU seconds of an image", "s", &|entry| Cell::Number(entry.image.seconds())),
        ],
    )
}

fn gallery(id: &str, lighting: &Lighting, budget: &Budget, reference: &Reference) -> Gallery {
    let lines = vec![format!("RMSE {:.1e}", reference.squared_error.sqrt())];
    let exact = reference.shown.picture(format!("{id}-exact"), "closed form", lines, lighting.exposure);
    let others = budget.entries.iter().enumerate().map(|(m, entry)| {
        let lines =
            vec![format!("RMSE {:.4}", entry.rmse.value), format!("{} rays", entry.image.rays_per_pixel())];
        entry.image.picture(format!("{id}-{m}"), entry.name, lines, lighting.exposure)
    });
    let pictures = [exact].into_iter().chain(others).collect();
    let title = format!("The images at {} look-ups per pixel", budget.lookups);
    Gallery::of_row(&format!("{id}-images"), &title, pictures)
}

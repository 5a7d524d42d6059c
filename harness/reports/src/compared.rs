//! Methods of rendering one scene against a long image of it: error and CPU time of independent images.

use super::measured::Measured;
use super::replicas::{Replicas, Subject};
use super::run::Run;
use super::scenes::Scene;
use fairflight_document::{Axis, Chart, Curve, Picture};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Independent images per measurement.
pub(super) const REPLICAS: u32 = 8;
/// The points of a curve have so many times the samples of the one before.
const STEP: u32 = 4;
/// Points of a curve of error over time.
pub(super) const POINTS: u32 = 3;

/// A method: its name, its integrator, and the samples per pixel of its longest image.
pub(super) type Method = (&'static str, Value, u32);

/// The image of a scene that all others are judged by.
pub(super) struct Exact {
    subject: Subject,
    pub(super) images: Replicas,
    pixels: Vec<f64>,
    /// Its own, of each pixel.
    squared_errors: Vec<f64>,
}

impl Exact {
    /// The mean of so many images by an integrator, of so many samples per pixel each.
    pub(super) fn of(
        run: &Run<'_>,
        subject: Subject,
        (integrator, samples): (Value, u32),
        (seed, images): (u64, u32),
    ) -> Result<Self, Failure> {
        let long = subject.with("integrator", integrator);
        let images = long.measure(run.samples(samples), (seed, images), &run.media)?;
        run.advance();
        let (pixels, squared_error) = images.mean();
        let squared_errors = vec![squared_error; pixels.len()];
        Ok(Self { subject, images, pixels, squared_errors })
    }

    /// The same image with a pixel for each `block` x `block` of its pixels, whose mean it is; its squared errors by the scatter of its images.
    pub(super) fn coarser(&self, block: u32) -> Self {
        let [columns, rows] = self.images.first().resolution().map(|side| side as u32 / block);
        let (pixels, squared_errors) = self.images.mean_of_blocks(block as usize);
        let subject = self.subject.with("camera.resolution", json!([columns, rows]));
        Self { subject, images: self.images.clone(), pixels, squared_errors }
    }

    /// The root of its own mean squared error.
    pub(super) fn rmse(&self) -> f64 {
        average(self.squared_errors.iter().copied()).sqrt()
    }

    /// So many classes of pixels of like brightness, each as large, the darkest first.
    pub(super) fn classes(&self, count: usize) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.pixels.len()).collect();
        order.sort_by(|&a, &b| self.pixels[a].total_cmp(&self.pixels[b]));
        order.chunks(order.len().div_ceil(count)).map(<[usize]>::to_vec).collect()
    }

    /// The mean radiance of some pixels.
    pub(super) fn mean_of(&self, pixels: &[usize]) -> f64 {
        average(pixels.iter().map(|&pixel| self.pixels[pixel]))
    }

    /// The root of the mean squared error of some pixels, over their mean radiance.
    pub(super) fn relative_error(&self, entry: &Entry, pixels: &[usize]) -> Measured {
        let (mean, own) =
            (self.mean_of(pixels), average(pixels.iter().map(|&pixel| self.squared_errors[pixel])));
        let squares = entry.images.squared_difference_in(pixels, &self.pixels, own);
        squares.map(|square| square.max(0.0).sqrt() / mean)
    }

    /// Images of a method, of so many samples per pixel.
    pub(super) fn entry(
        &self,
        run: &Run<'_>,
        (name, integrator): (&'static str, Value),
        (samples, seed): (u32, u64),
    ) -> Result<Entry, Failure> {
        let images =
            self.subject.with("integrator", integrator).measure(samples, (seed, REPLICAS), &run.media)?;
        run.advance();
        let squares = images.squared_difference(&self.pixels, self.rmse().powi(2));
        let (seconds, rays) = (images.seconds(), f64::from(samples) * self.pixels.len() as f64);
        let [(mean, error), (exact, its_error)] = [&images, &self.images].map(Replicas::mean_of_images);
        Ok(Entry {
            name,
            rmse: squares.map(|square| square.max(0.0).sqrt()),
            variance: squares.map(|square| square * f64::from(samples)),
            cost: squares.map(|square| square * seconds),
            seconds: seconds / rays,
            z: (mean - exact) / error.hypot(its_error),
            images,
        })
    }

    /// Images of a method of growing length: the points of its curve in a scene.
    pub(super) fn points(
        &self,
        run: &Run<'_>,
        scene: &Scene,
        (name, integrator, samples): Method,
    ) -> Result<Vec<Entry>, Failure> {
        let parts = (0..POINTS).rev().map(|point| STEP.pow(point));
        let mut sizes: Vec<(u32, u32)> =
            parts.map(|part| (part, (run.samples(samples) / part).max(2))).collect();
        // Images that cannot be shorter are drawn once.
        sizes.dedup_by_key(|(_, samples)| *samples);
        let entry = |(part, samples): (u32, u32)| {
            let seed = run.seed(format_args!("{}/{name}/samples over {part}", scene.id));
            self.entry(run, (name, integrator.clone()), (samples, seed))
        };
        sizes.into_iter().map(entry).collect()
    }
}

fn average(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// One method in one scene.
pub(super) struct Entry {
    pub(super) name: &'static str,
    pub(super) rmse: Measured,
    /// Mean squared error of one sample \[radiance²\].
    pub(super) variance: Measured,
    /// MSE · CPU seconds \[radiance² s\].
    pub(super) cost: Measured,
    /// CPU seconds of one sample of a pixel.
    pub(super) seconds: f64,
    pub(super) z: f64,
    pub(super) images: Replicas,
}

impl Entry {
    /// A sentence on a mean that is too far from that of the reference, in a case with a name.
    pub(super) fn too_far(&self, case: &str) -> Option<String> {
        // Of so few images the scatter has heavy tails: t of 7 degrees of freedom at 1e-6.
        (self.z.abs() > 14.0).then(|| format!("{} in {case}: z = {:.1}", self.name, self.z))
    }

    /// The same where the mean lies above: below it, images that all miss a rare mode agree with each other.
    pub(super) fn too_bright(&self, case: &str) -> Option<String> {
        self.too_far(case).filter(|_| self.z > 0.0)
    }

    /// The error and the time of its image, below it.
    pub(super) fn lines(&self) -> Vec<String> {
        vec![
            format!("RMSE {:.4}", self.rmse.value),
            format!("{} samples", self.images.rays_per_pixel()),
            format!("{:.1} CPU s", self.images.seconds()),
        ]
    }
}

/// Measurements of one scene: error and CPU time of each method.
pub(super) struct Compared {
    pub(super) scene: &'static Scene,
    /// The longest images of each method.
    pub(super) entries: Vec<Entry>,
    pub(super) exact: Exact,
    pub(super) chart: Chart,
}

impl Compared {
    /// Measures the error and the CPU time of each method in a scene.
    pub(super) fn study(
        run: &Run<'_>,
        scene: &'static Scene,
        exact: Exact,
        methods: impl IntoIterator<Item = Method>,
    ) -> Result<Self, Failure> {
        let (mut entries, mut curves) = (Vec::new(), Vec::new());
        for method in methods {
            let name = method.0;
            let mut points = exact.points(run, scene, method)?;
            curves.push(Curve::joined(
                name,
                points.iter().map(|entry| entry.rmse.mark(entry.images.seconds())),
            ));
            entries.extend(points.pop());
        }
        let (x, y) = (Axis::logarithmic("CPU seconds of an image [s]"), Axis::logarithmic("RMSE [radiance]"));
        let title = format!("Error over time: {}", scene.words);
        let chart = Chart::new(&format!("{}-time", scene.id), &title, x, y).with_curves(curves);
        Ok(Self { scene, entries, exact, chart })
    }

    /// Efficiency, 1/(MSE · CPU seconds), of one method over that of another, by their places.
    pub(super) fn gain(&self, method: usize, other: usize) -> Measured {
        self.entries[other].cost.over(&self.entries[method].cost)
    }

    /// Methods at these places whose mean is too far from that of the reference.
    pub(super) fn unsound(&self, places: impl IntoIterator<Item = usize>) -> Vec<String> {
        places.into_iter().filter_map(|k| self.entries[k].too_far(self.scene.id)).collect()
    }

    /// A row of images: the reference by a method, and the first `count` of the others.
    pub(super) fn row(&self, reference: &str, count: usize) -> (String, Vec<Picture>) {
        let Scene { id, words, exposure, .. } = self.scene;
        let shown = |images: &Replicas, part: &str, label: &str, lines: Vec<String>| {
            images.picture(format!("{id}-{part}"), label, lines, *exposure)
        };
        let exact = shown(&self.exact.images, "reference", "reference", vec![reference.to_owned()]);
        let others = self.entries.iter().take(count).enumerate();
        let others = others.map(|(k, entry)| shown(&entry.images, &k.to_string(), entry.name, entry.lines()));
        ((*words).to_owned(), [exact].into_iter().chain(others).collect())
    }
}

//! The error of a mean of n estimates against what it cost, measured over independent replicas.

use super::interval::chi_square;
use super::laws::SharedLaws;
use super::marching;
use super::preparation::preparation_seconds;
use super::series::{EXPLORERS, Entry, SPLITS};
use super::sweep::log10_relative_mse;
use super::{Effort, Run, Subject};
use crate::Failure;
use crate::estimator::{EstimatorSpec, RayMarchingSpec};
use crate::parallel::try_in_parallel;
use crate::plan::Plan;
use crate::reference::explain;
use crate::report::result::{ConvergenceCurve, ConvergencePoint, Series, SweepCurve};
use cpu_time::ThreadTime;
use fairflight_collision::Albedo;
use fairflight_sources::Seeded;
use fairflight_transmittance::{Offset, Theory};
use std::fmt::Debug;

/// Replicas of one point: enough for an interval, and not more than a cheap point needs.
const REPLICAS: (f64, f64) = (64.0, 1024.0);
/// Replicas of ray marching with one random offset: its estimates are all of one size.
const MARCHES: u64 = 64;

/// An estimator with all its parameters.
struct Line {
    series: Series,
    parameters: String,
    spec: EstimatorSpec,
    law: Theory,
}

/// A point that is to be measured.
enum Task<'a> {
    Mean { line: &'a Line, estimates: u64, replicas: u64 },
    March { offset: Offset, steps: u32 },
}

/// All curves of one subject.
pub(super) fn curves(
    run: &Run<'_>,
    subject: &Subject,
    laws: &SharedLaws,
    sweeps: &[SweepCurve],
) -> Result<Vec<ConvergenceCurve>, Failure> {
    let lines = lines(subject, laws, sweeps)?;
    let marches = [(Series::RayMarching, Offset::Fixed), (Series::JitteredRayMarching, Offset::Jittered)];
    let mut tasks: Vec<(usize, Task<'_>)> = Vec::new();
    for (curve, line) in lines.iter().enumerate() {
        let points = budget(&run.effort, subject, line);
        tasks.extend(points.map(|(estimates, replicas)| (curve, Task::Mean { line, estimates, replicas })));
    }
    for (i, (_, offset)) in marches.into_iter().enumerate() {
        let steps = (1..).map(|k| 1 << k).take_while(|steps| *steps <= run.effort.most_steps);
        tasks.extend(steps.map(|steps| (lines.len() + i, Task::March { offset, steps })));
    }
    let seed =
        |name: &dyn Debug, point: u64| run.seed(format_args!("convergence/{}/{name:?}/{point}", subject.id));
    let points = try_in_parallel(tasks.len(), &|i| {
        let (curve, ref task) = tasks[i];
        let point = match *task {
            Task::Mean { line, estimates, replicas } => {
                mean_point(subject, line, estimates, replicas, seed(&line.series, estimates))
            }
            Task::March { offset, steps } => {
                march_point(subject, offset, steps, seed(&offset, u64::from(steps)))
            }
        };
        Ok((curve, point?))
    })?;
    run.bar.inc(steps(&run.effort));
    let mut curves: Vec<ConvergenceCurve> = lines
        .iter()
        .map(|line| (line.series, line.parameters.clone()))
        .chain([
            (Series::RayMarching, "midpoints, 2 to 4096 steps (biased)".to_owned()),
            (Series::JitteredRayMarching, "one random offset, 2 to 4096 steps (biased)".to_owned()),
        ])
        .map(|(series, parameters)| ConvergenceCurve { series, parameters, points: Vec::new() })
        .collect();
    for (curve, point) in points {
        curves[curve].points.push(point);
    }
    Ok(curves)
}

/// How much [`curves`] reports as progress.
pub(super) fn steps(effort: &Effort) -> u64 {
    effort.sweep_points as u64 * 4
}

/// The representative set; those without a majorant of their own at the sampling extinction of the best closed-form
/// efficiency per look-up.
fn lines(subject: &Subject, laws: &SharedLaws, sweeps: &[SweepCurve]) -> Result<Vec<Line>, Failure> {
    let majorant = subject.majorant;
    let best = |series| best_sampling(sweeps, series).unwrap_or(majorant);
    let mean_best = best(Series::DoubleParticleMean);
    let explorers_best = best(Series::DoubleParticleExplorers);
    let albedo = Albedo::new(0.9).unwrap_or_default();
    let plain = |series| Entry { series, albedo: None };
    let chosen = [
        (plain(Series::Woodcock), majorant, format!("majorant {majorant}")),
        (plain(Series::DoubleParticle), majorant, format!("no control, sigma_samp = majorant = {majorant}")),
        (
            plain(Series::DoubleParticleMean),
            mean_best,
            format!("control = mean of the ray (an oracle), most efficient sigma_samp {mean_best:.3}"),
        ),
        (
            plain(Series::DoubleParticleExplorers),
            explorers_best,
            format!(
                "{EXPLORERS} explorers, looked up once per replica; most efficient sigma_samp {explorers_best:.3}"
            ),
        ),
        (
            Entry { series: Series::Adaptive, albedo: Some(albedo) },
            majorant,
            format!("albedo {albedo}, sigma_samp {majorant}"),
        ),
        (plain(Series::LineIntegral), majorant, format!("{SPLITS} splits, majorant {majorant}")),
    ];
    let mut lines = Vec::new();
    for (entry, sigma_samp, parameters) in chosen {
        let spec = entry.at(subject, sigma_samp);
        let plan = Plan::on(subject.profile.clone(), spec.clone(), 0, 0)?;
        // An estimator that is not defined on this ray (a field below 0) has no curve.
        if let Some(prediction) = laws.law(subject, &plan.estimator)? {
            lines.push(Line { series: entry.series, parameters, spec, law: prediction.theory });
        }
    }
    Ok(lines)
}

fn best_sampling(sweeps: &[SweepCurve], series: Series) -> Option<f64> {
    let points = sweeps.iter().filter(|curve| curve.series == series).flat_map(|curve| &curve.points);
    points
        .filter_map(|point| Some((point.sigma_samp, point.log10_efficiency_per_lookup?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(sigma_samp, _)| sigma_samp)
}

/// (estimates, replicas) of the points of a curve: powers of 4 up to what the budget can replicate.
fn budget(effort: &Effort, subject: &Subject, line: &Line) -> impl Iterator<Item = (u64, u64)> + use<> {
    let estimate = 1e-9 * (line.law.lookups * subject.lookup_nanoseconds + 50.0);
    let within = effort.convergence_seconds / estimate;
    let points = (0..).map(|k| 4_u64.pow(k)).take_while(move |&n| n == 1 || n as f64 * REPLICAS.0 <= within);
    points.map(move |n| (n, (within / n as f64).clamp(REPLICAS.0, REPLICAS.1) as u64))
}

fn mean_point(
    subject: &Subject,
    line: &Line,
    estimates: u64,
    replicas: u64,
    seed: u64,
) -> Result<ConvergencePoint, Failure> {
    let plan = Plan::on(subject.profile.clone(), line.spec.clone(), estimates, seed)?;
    let errors = replicate(&plan, subject, replicas)?;
    let n = estimates as f64;
    let relative_rmse = errors.square.sqrt();
    let preparation = plan.estimator.preparation_lookups as f64;
    // The 4th moment of a mean of n: 3 μ2²/n² + (μ4 − 3 μ2²)/n³.
    let [second, _, fourth, ..] = line.law.relative_central;
    let shape = 3.0 + (fourth / (second * second) - 3.0) / n;
    let shape = if shape.is_finite() { shape } else { errors.fourth / (errors.square * errors.square) };
    Ok(ConvergencePoint {
        estimates,
        replicas,
        lookups: n * line.law.lookups + preparation,
        seconds: errors.seconds / replicas as f64 + preparation_seconds(subject, &plan.estimator),
        relative_rmse,
        interval: chi_square(relative_rmse, replicas as f64, shape),
        relative_bias: 0.0,
        predicted: Some(10f64.powf(0.5 * (log10_relative_mse(&line.law) - n.log10()))),
    })
}

fn march_point(
    subject: &Subject,
    offset: Offset,
    steps: u32,
    seed: u64,
) -> Result<ConvergencePoint, Failure> {
    let law = marching::law(subject, offset, steps)?;
    // A deterministic rule is the same in every replica; it is run often enough to be timed.
    let spec = RayMarchingSpec::at(steps, offset).into();
    let plan = Plan::on(subject.profile.clone(), spec, 1, seed)?;
    let errors = replicate(&plan, subject, MARCHES)?;
    let relative_rmse = errors.square.sqrt();
    let shape = if offset == Offset::Fixed { 1.0 } else { errors.fourth / (errors.square * errors.square) };
    Ok(ConvergencePoint {
        estimates: u64::from(steps),
        replicas: MARCHES,
        lookups: f64::from(steps),
        seconds: errors.seconds / MARCHES as f64,
        relative_rmse,
        interval: chi_square(relative_rmse, MARCHES as f64, shape),
        relative_bias: law.relative_bias,
        predicted: Some(law.relative_rmse),
    })
}

/// Mean square and mean fourth power of the relative errors of the replicas, and what drawing all of them took.
struct Errors {
    square: f64,
    fourth: f64,
    seconds: f64,
}

fn replicate(plan: &Plan, subject: &Subject, replicas: u64) -> Result<Errors, Failure> {
    let unit = subject.truth.transmittance() * plan.samples as f64;
    let mut estimates = vec![0.0; plan.samples as usize];
    let (mut square, mut fourth) = (0.0, 0.0);
    let clock = ThreadTime::now();
    for replica in 0..replicas {
        let drawn = plan.estimator.trial.draw(&mut Seeded::for_batch(plan.seed, replica), &mut estimates);
        drawn.map_err(|violation| explain(&subject.profile, &plan.estimator, &subject.truth, violation))?;
        let error = (estimates.iter().sum::<f64>() / unit - 1.0).powi(2);
        square += error;
        fourth += error * error;
    }
    let seconds = clock.elapsed().as_secs_f64();
    if !square.is_finite() {
        return Err(Failure::refused(format!("report: {}: an estimate is not finite", subject.id)));
    }
    let replicas = replicas as f64;
    Ok(Errors { square: square / replicas, fourth: fourth / replicas, seconds })
}

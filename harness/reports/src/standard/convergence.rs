//! The error of a mean of n estimates against what it cost, measured over independent replicas.

use super::interval::chi_square;
use super::lines::Line;
use super::marching;
use super::preparation::preparation_seconds;
use super::result::{ConvergenceCurve, ConvergencePoint, Series};
use super::sweep::{known_variance, log10_relative_mse};
use super::{Effort, Run, Subject};
use cpu_time::ThreadTime;
use fairflight_harness::Failure;
use fairflight_harness::estimator::RayMarchingSpec;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::explain;
use fairflight_sources::Seeded;
use fairflight_transmittance::Offset;
use std::fmt::Debug;

/// Replicas of one point: enough for an interval, and not more than a cheap point needs.
const REPLICAS: (f64, f64) = (64.0, 1024.0);
/// Replicas of ray marching with one random offset: its estimates are all of one size.
const MARCHES: u64 = 64;

/// A point that is to be measured.
enum Task<'a> {
    Mean { line: &'a Line, estimates: u64, replicas: u64 },
    March { offset: Offset, steps: u32 },
}

/// Curves of one subject.
pub(super) fn curves(
    run: &Run<'_>,
    subject: &Subject,
    lines: &[Line],
) -> Result<Vec<ConvergenceCurve>, Failure> {
    let effort = Effort::of(run.options.quick);
    // Marches of more and more steps have a curve of their own, and the closed form has no error.
    let is_drawn = |line: &&Line| line.series != Series::RayMarching && line.varies();
    let drawn = lines.iter().filter(is_drawn);
    let (papers, others): (Vec<&Line>, Vec<&Line>) = drawn.partition(|line| line.is_of_the_papers);
    let of_marches = |(series, offset, parameters): (Series, Offset, &str)| {
        let steps = (1..).map(|k| 1 << k).take_while(|steps| *steps <= effort.most_steps);
        (series, parameters.to_owned(), steps.map(|steps| Task::March { offset, steps }).collect())
    };
    let marches = [
        (Series::RayMarching, Offset::Fixed, "midpoints, 2 to 4096 steps (biased)"),
        (Series::JitteredRayMarching, Offset::Jittered, "one random offset, 2 to 4096 steps (biased)"),
    ];
    let wanted: Vec<(Series, String, Vec<Task<'_>>)> = papers
        .into_iter()
        .map(|line| means(&effort, subject, line))
        .chain(marches.map(of_marches))
        .chain(others.into_iter().map(|line| means(&effort, subject, line)))
        .collect();
    let tasks: Vec<(usize, &Task<'_>)> = wanted
        .iter()
        .enumerate()
        .flat_map(|(k, (.., tasks))| tasks.iter().map(move |task| (k, task)))
        .collect();
    let seed =
        |name: &dyn Debug, point: u64| run.seed(format_args!("convergence/{}/{name:?}/{point}", subject.id));
    let points = try_in_parallel(tasks.len(), &|i| {
        let (curve, task) = tasks[i];
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
    run.advance();
    let mut curves: Vec<ConvergenceCurve> = wanted
        .iter()
        .map(|(series, parameters, _)| (*series, parameters.clone()))
        .map(|(series, parameters)| ConvergenceCurve { series, parameters, points: Vec::new() })
        .collect();
    for (curve, point) in points {
        curves[curve].points.push(point);
    }
    Ok(curves)
}

/// The points of a curve: powers of 4 up to what the budget can replicate.
fn means<'a>(effort: &Effort, subject: &Subject, line: &'a Line) -> (Series, String, Vec<Task<'a>>) {
    let estimate = 1e-9 * (line.lookups * subject.lookup_nanoseconds + 50.0);
    let seconds =
        if line.is_of_the_papers { effort.convergence_seconds } else { effort.short_convergence_seconds };
    let within = seconds / estimate;
    let points = (0..).map(|k| 4_u64.pow(k)).take_while(|&n| n == 1 || n as f64 * REPLICAS.0 <= within);
    let tasks = points.map(|estimates| {
        let replicas = (within / estimates as f64).clamp(REPLICAS.0, REPLICAS.1) as u64;
        Task::Mean { line, estimates, replicas }
    });
    (line.series, line.parameters.clone(), tasks.collect())
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
    let (n, theory) = (estimates as f64, &line.law.theory);
    let relative_rmse = errors.square.sqrt();
    let preparation = plan.estimator.preparation_lookups as f64;
    // The 4th moment of a mean of n: 3 μ2²/n² + (μ4 − 3 μ2²)/n³.
    let [second, _, fourth, ..] = theory.relative_central;
    let shape = 3.0 + (fourth / (second * second) - 3.0) / n;
    let bias = theory.relative_mean - 1.0;
    let of_sample = errors.fourth / (errors.square * errors.square);
    let shape = if shape.is_finite() && bias == 0.0 { shape } else { of_sample };
    let lookups = if theory.lookups.is_finite() { n * theory.lookups } else { counted(&plan)? };
    // Of n estimates together: Var/n + bias².
    let mean_square = |variance: f64| (variance / n + bias * bias).sqrt();
    let predicted = match known_variance(theory) {
        Some(_) if bias == 0.0 => Some(10f64.powf(0.5 * (log10_relative_mse(theory) - n.log10()))),
        known => known.map(mean_square),
    };
    Ok(ConvergencePoint {
        estimates,
        replicas,
        lookups: lookups + preparation,
        seconds: errors.seconds / replicas as f64 + preparation_seconds(subject, &plan.estimator),
        relative_rmse,
        interval: chi_square(relative_rmse, replicas as f64, shape),
        // That of a baseline without a law is not known.
        relative_bias: if line.spec.is_biased_baseline() && predicted.is_none() {
            f64::NAN
        } else {
            bias.abs()
        },
        predicted,
    })
}

/// Look-ups of one replica, over some of them, where no law tells.
fn counted(plan: &Plan) -> Result<f64, Failure> {
    const COUNTED: u64 = 16;
    let mut lookups = 0;
    for replica in 0..COUNTED {
        let trial = plan.spec.kind().prepare(&plan.profile)?.trial;
        lookups += trial.count(&mut Seeded::for_batch(plan.seed, replica), plan.samples);
    }
    Ok(lookups as f64 / COUNTED as f64)
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
        // One that learns from its estimates begins anew.
        let anew = if plan.estimator.is_sequential {
            Some(plan.spec.kind().prepare(&plan.profile)?.trial)
        } else {
            None
        };
        let trial = anew.as_ref().unwrap_or(&plan.estimator.trial);
        let drawn = trial.draw(&mut Seeded::for_batch(plan.seed, replica), &mut estimates);
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

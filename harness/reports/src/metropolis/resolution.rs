//! Gain of chains over independent samples by the number of pixels.

use super::equal_time::{self, BIDIRECTIONAL, PATH_SPACE, PRIMARY};
use crate::compared::Compared;
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{Axis, Chart, Curve, Panel, Section};
use fairflight_harness::Failure;

/// Scenes.
const SHOWN: [&str; 2] = ["mirror-room", "door"];
/// Pixels of the images above on a side of one of these.
const BLOCKS: [u32; 3] = [6, 3, 2];
/// Chains.
const CHAINS: [usize; 2] = [PRIMARY, PATH_SPACE];
pub(super) const STEPS: u64 = (SHOWN.len() * BLOCKS.len() * (1 + CHAINS.len())) as u64;

/// Gains of each chain by the columns of an image.
pub(super) struct Study {
    scenes: Vec<(&'static str, Vec<Curve>)>,
}

pub(super) fn study(run: &Run<'_>, compared: &[Compared]) -> Result<Study, Failure> {
    let shown = compared.iter().filter(|scene| SHOWN.contains(&scene.scene.id));
    let scenes = shown.map(|scene| Ok((scene.scene.id, of(run, scene)?))).collect::<Result<_, Failure>>()?;
    Ok(Study { scenes })
}

/// Curves of one scene.
fn of(run: &Run<'_>, scene: &Compared) -> Result<Vec<Curve>, Failure> {
    let methods = equal_time::methods();
    let side = equal_time::side(run);
    let mut marks = CHAINS.map(|_| Vec::new());
    let mut add = |columns: u32, variance: &dyn Fn(usize) -> Measured| {
        for (marks, method) in marks.iter_mut().zip(CHAINS) {
            marks.push(variance(BIDIRECTIONAL).over(&variance(method)).mark(columns.into()));
        }
    };
    for block in BLOCKS {
        let exact = scene.exact.coarser(block);
        let mut variances = vec![Measured::normal(f64::NAN, f64::NAN); methods.len()];
        for k in [BIDIRECTIONAL].into_iter().chain(CHAINS) {
            let (name, integrator, samples) = methods[k].clone();
            // As many samples in all: chains of one length. The variance of independent ones does not depend on their number.
            let fewer = if k == BIDIRECTIONAL { 4 } else { 1 };
            let samples = run.samples(samples) * block * block / fewer;
            let seed = run.seed(format_args!("resolution/{}/{block}/{name}", scene.scene.id));
            variances[k] = exact.entry(run, (name, integrator), (samples, seed))?.variance;
        }
        add(side / block, &|k| variances[k]);
    }
    add(side, &|k| scene.entries[k].variance);
    let curves = CHAINS.iter().zip(marks).map(|(&k, marks)| Curve::joined(methods[k].0, marks));
    Ok(curves.collect())
}

pub(super) fn section(study: &Study) -> Section {
    let text = "Variance of one sample of bidirectional path tracing over that of one step of a chain, by the resolution of the image: the same number of steps in \
         all, and the same length of chains, and the reference of above, of which blocks of pixels are put together. A chain finds a mode no faster than \
         independent samples do, but fills it: the more pixels a mode covers, the more a step is worth.";
    let panel = |(id, curves): &(&str, Vec<Curve>)| {
        let y = Axis::logarithmic("variance of bidirectional over that of chains [1]");
        Panel { curves: curves.clone(), ..Panel::new(id, Axis::logarithmic("columns of the image [1]"), y) }
    };
    let chart = Chart::of(
        "resolution-gain",
        "Gain of a step by resolution",
        study.scenes.iter().map(panel).collect(),
    );
    Section::new("resolution", "Gain by resolution").with(text).with(chart)
}

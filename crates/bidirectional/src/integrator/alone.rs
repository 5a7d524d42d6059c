//! One strategy alone.

use super::{Bidirectional, Found, Strategy};
use crate::{Subpath, WeightThickness};
use fairflight_media::Line;
use fairflight_paths::Roulette;
use fairflight_paths::transport::Types;
use fairflight_sources::{PathEnd, Row, UniformSource};

impl<W: Types, K: WeightThickness<W::Medium>> Bidirectional<'_, W, K> {
    /// The same with walks that go on from every vertex ([`Roulette::Never`]), for strategies alone: all strategies at once would walk until
    /// the scene is left.
    #[must_use]
    pub fn without_roulette(mut self) -> Self {
        self.walking.walk = self.walking.walk.with_roulette(Roulette::Never);
        self
    }

    /// What one strategy finds, weighted among all: subpaths that end at the vertices it takes. Along `line`, or, of the light image, in the
    /// pixel that `each` is told. `light` is a buffer.
    ///
    /// **Law.** The expectation of what [`strategies`](Self::strategies) or [`light_image`](Self::light_image) find by it. [Without roulette](Self::without_roulette) neither walks nor the densities in
    /// weights have any: the sum over the strategies of one length has the same expectation.
    pub fn alone(
        &mut self,
        strategy: Strategy,
        line: &Line,
        light: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
        mut each: impl FnMut(Option<[u32; 2]>, Found<W::Spectrum>),
    ) {
        let Strategy { light: s, eye: t } = strategy;
        if s >= 2 {
            self.weigh.exactly_from_light(s - 1, &self.walking, light, source);
            self.truncated += u64::from(light.is_cut);
            if light.steps.len() as u32 != s - 1 {
                return;
            }
        }
        if t == 1 {
            if let Some((pixel, found)) = self.splat(light, s as usize - 2, source) {
                each(Some(pixel), found);
            }
            return;
        }
        let mut eye = std::mem::take(&mut self.eye);
        self.weigh.exactly_from_eye(t - 1, &self.walking, line, &mut eye, source);
        self.truncated += u64::from(eye.is_cut);
        let mut each = |found: Found<W::Spectrum>| each(None, Found { strategy, ..found });
        if eye.steps.len() as u32 == t - 1 {
            let step = &eye.steps[t as usize - 2];
            source.row(Row::connection(PathEnd::Camera, t - 1));
            match s {
                0 => {
                    let previous = eye.steps.len().checked_sub(2).map(|before| &eye.steps[before].node);
                    self.met(step, previous, each);
                }
                1 => self.next_event(step, source, each),
                _ => {
                    let connected = self.connect(step, &light.steps[s as usize - 2], source);
                    if let Some((value, weight)) = connected {
                        each(Found { strategy, value, weight, end: None });
                    }
                }
            }
        } else if let (0, Some(escape)) = (s, eye.escape)
            && eye.steps.len() as u32 == t - 2
        {
            let previous = eye.steps.last().map(|step| &step.node);
            self.background(previous, escape, each);
        }
        self.eye = eye;
    }
}

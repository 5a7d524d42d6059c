//! Metropolis sampling in primary sample space, over any integrator.

use crate::{Film, Integrand, Proposed, Splats, Target, Which};
use fairflight_scene::Spectrum;
use fairflight_sources::{Layout, SmallStep, Step, UniformSource, Variates};

/// States are the variates that an integrand draws (kelemen-2002, antwerpen-2011 section 6.6).
///
/// A large step draws all of them afresh, a small one changes each a little; either is as probable backwards as forwards, so that
///
/// ```text
/// a = min(1, f*(v)/f*(u)),      f* = Σ over contributions of max channel |F|
/// ```
///
/// **Law.** That of [`Target`], for every integrand whose own law holds for any source; contributions may have any sign and colour.
///
/// **Variance.** A chain fills a mode, and finds one no faster than independent samples do: its gain grows with the number of pixels that a
/// mode covers.
pub struct Primary<'i, C> {
    integrand: &'i mut dyn Integrand<C>,
    variates: Variates,
    large_step: f64,
    small_step: SmallStep,
    present: Weighted<C>,
    proposed: Weighted<C>,
}

/// Contributions and their f*.
#[derive(Debug)]
struct Weighted<C> {
    splats: Splats<C>,
    target: f64,
}

impl<C> Default for Weighted<C> {
    fn default() -> Self {
        Self { splats: Splats::default(), target: 0.0 }
    }
}

/// The probability of a large step is not one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the probability of a large step must lie in [0, 1], found {0}")]
pub struct NotAProbability(pub f64);

impl<C> std::fmt::Debug for Primary<'_, C> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { large_step, small_step, .. } = self;
        formatter
            .debug_struct("Primary")
            .field("large_step", large_step)
            .field("small_step", small_step)
            .finish_non_exhaustive()
    }
}

impl<'i, C: Spectrum> Primary<'i, C> {
    const LARGE: usize = 0;
    const SMALL: usize = 1;

    /// Variates of `integrand` by rows, with large steps of the probability 0.3 and small ones as Kelemen has them.
    pub fn new(integrand: &'i mut dyn Integrand<C>) -> Self {
        Self {
            integrand,
            variates: Variates::new(Layout::Rows),
            large_step: 0.3,
            small_step: SmallStep::default(),
            present: Weighted::default(),
            proposed: Weighted::default(),
        }
    }

    /// The same with large steps of another probability: 0 leaves no way to modes that the start is not in, and no bias.
    ///
    /// # Errors
    /// If it lies outside [0, 1].
    pub fn with_large_step(self, probability: f64) -> Result<Self, NotAProbability> {
        if (0.0..=1.0).contains(&probability) {
            Ok(Self { large_step: probability, ..self })
        } else {
            Err(NotAProbability(probability))
        }
    }

    /// The same with other small steps.
    #[must_use]
    pub fn with_small_step(self, small_step: SmallStep) -> Self {
        Self { small_step, ..self }
    }

    /// The same with variates in another order.
    #[must_use]
    pub fn with_layout(self, layout: Layout) -> Self {
        Self { variates: Variates::new(layout), ..self }
    }

    /// Contributions of a state.
    #[must_use]
    pub fn splats(&self, which: Which) -> &Splats<C> {
        &self.weighted(which).splats
    }

    /// f* of a state.
    #[must_use]
    pub fn target(&self, which: Which) -> f64 {
        self.weighted(which).target
    }

    /// Variates of the present state and of the proposal.
    #[must_use]
    pub fn variates(&self) -> &Variates {
        &self.variates
    }

    fn weighted(&self, which: Which) -> &Weighted<C> {
        match which {
            Which::Present => &self.present,
            Which::Proposed => &self.proposed,
        }
    }

    /// Draws a proposal by a step of this kind.
    pub fn sample(&mut self, step: Step, source: &mut dyn UniformSource) {
        let Self { integrand, variates, proposed: Weighted { splats, target }, .. } = self;
        splats.clear();
        integrand.sample(splats, &mut variates.step(step, source));
        *target = splats.magnitude(|_| 1.0);
    }
}

impl<C: Spectrum> Target<C> for Primary<'_, C> {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        self.sample(Step::Large, source);
        self.proposed.target
    }

    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        let (kind, step) = if source.next_uniform() < self.large_step {
            (Self::LARGE, Step::Large)
        } else {
            (Self::SMALL, Step::Small(self.small_step))
        };
        self.sample(step, source);
        let (to, from) = (self.proposed.target, self.present.target);
        let acceptance = if to.is_finite() { (to / from).min(1.0) } else { f64::NAN };
        Proposed { kind, acceptance }
    }

    fn accept(&mut self) {
        self.variates.accept();
        std::mem::swap(&mut self.present, &mut self.proposed);
    }

    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, C>) {
        let Weighted { splats, target } = self.weighted(which);
        if *target > 0.0 {
            splats.deposit(energy / target, film);
        }
    }

    fn kinds(&self) -> &[&'static str] {
        &["large_step", "small_step"]
    }
}

//! Metropolis sampling in primary sample space, over any integrator.

use crate::{Experience, Film, Importance, Integrand, Kernels, Proposed, Splats, Target, Which};
use fairflight_elementary::ln;
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
    steps: SmallSteps<'i>,
    importance: Option<&'i Importance>,
    present: Weighted<C>,
    proposed: Weighted<C>,
}

/// Small steps of one size, or of several that the state chooses by.
enum SmallSteps<'i> {
    Alike(SmallStep),
    Chosen(&'i Kernels, Experience),
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
        let Self { large_step, variates, .. } = self;
        formatter
            .debug_struct("Primary")
            .field("large_step", large_step)
            .field("variates", &variates.len())
            .finish_non_exhaustive()
    }
}

impl<'i, C: Spectrum> Primary<'i, C> {
    /// Names of the kinds: the large step, and the small ones.
    const KINDS: [&'static str; 1 + Kernels::MOST] = [
        "large_step",
        "small_step",
        "small_step_2",
        "small_step_3",
        "small_step_4",
        "small_step_5",
        "small_step_6",
        "small_step_7",
        "small_step_8",
    ];

    /// Variates of `integrand` by rows, with large steps of the probability 0.3 and small ones as Kelemen has them.
    pub fn new(integrand: &'i mut dyn Integrand<C>) -> Self {
        Self {
            integrand,
            variates: Variates::new(Layout::Rows),
            large_step: 0.3,
            steps: SmallSteps::Alike(SmallStep::default()),
            importance: None,
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
        Self { steps: SmallSteps::Alike(small_step), ..self }
    }

    /// The same with small steps of several sizes, chosen by the pixel that a state is brightest in.
    #[must_use]
    pub fn with_kernels(self, kernels: &'i Kernels) -> Self {
        Self { steps: SmallSteps::Chosen(kernels, kernels.experience()), ..self }
    }

    /// What the chains saw of the sizes of steps, which is forgotten here; `None` where there is but one.
    pub fn take_experience(&mut self) -> Option<Experience> {
        match &mut self.steps {
            SmallSteps::Alike(_) => None,
            SmallSteps::Chosen(kernels, experience) => {
                Some(std::mem::replace(experience, kernels.experience()))
            }
        }
    }

    /// The same with a target of brightness · importance of the pixel.
    #[must_use]
    pub fn with_importance(self, importance: &'i Importance) -> Self {
        Self { importance: Some(importance), ..self }
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
        let Self { integrand, variates, importance, proposed: Weighted { splats, target }, .. } = self;
        splats.clear();
        integrand.sample(splats, &mut variates.step(step, source));
        *target = match importance {
            None => splats.magnitude(|_| 1.0),
            Some(importance) => splats.magnitude(|pixel| importance.of(pixel)),
        };
    }
}

impl<C: Spectrum> Target<C> for Primary<'_, C> {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        self.sample(Step::Large, source);
        self.proposed.target
    }

    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        let is_large = source.next_uniform() < self.large_step;
        let pixel = match &self.steps {
            SmallSteps::Alike(_) => [0, 0],
            SmallSteps::Chosen(..) => self.present.splats.brightest().unwrap_or([0, 0]),
        };
        let (kind, step) = match &self.steps {
            _ if is_large => (0, Step::Large),
            SmallSteps::Alike(step) => (1, Step::Small(*step)),
            SmallSteps::Chosen(kernels, _) => {
                let chosen = kernels.choose(pixel, source);
                (1 + chosen, Step::Small(kernels.sizes()[chosen]))
            }
        };
        self.sample(step, source);
        let (to, from) = (self.proposed.target, self.present.target);
        if !to.is_finite() {
            return Proposed { kind, acceptance: f64::NAN };
        }
        let choice = match (&self.steps, self.proposed.splats.brightest()) {
            // α_Y(k)/α_X(k): the step back must be of the same size.
            (SmallSteps::Chosen(kernels, _), Some(other)) if !is_large => {
                kernels.shares(other)[kind - 1] / kernels.shares(pixel)[kind - 1]
            }
            _ => 1.0,
        };
        let acceptance = (to / from * choice).min(1.0);
        if let (SmallSteps::Chosen(kernels, experience), false) = (&mut self.steps, is_large) {
            kernels.count(experience, (pixel, kind - 1), acceptance);
        }
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

    fn ln_present(&self) -> f64 {
        ln(self.present.target)
    }

    fn kinds(&self) -> &[&'static str] {
        let sizes = match &self.steps {
            SmallSteps::Alike(_) => 1,
            SmallSteps::Chosen(kernels, _) => kernels.sizes().len(),
        };
        &Self::KINDS[..1 + sizes]
    }
}

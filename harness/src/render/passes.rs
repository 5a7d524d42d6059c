//! Drawing until all is drawn, the time is up, or somebody interrupts.

use super::painting::Painting;
use crate::Failure;
use crate::interrupt::GentleStop;
use crate::plan::ScenePlan;
use std::time::Instant;

/// Reason why drawing ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// All samples of the plan are drawn.
    Complete,
    /// The time limit \[s\] was reached.
    TimeLimit(f64),
    /// An interrupt came.
    Interrupted,
}

/// Painting with the time that it took, and why it ended.
pub(super) struct Painted<'p> {
    pub painting: Painting<'p>,
    /// Time that drawing took, by the clock on the wall \[s\].
    pub seconds: f64,
    pub end: End,
}

impl End {
    /// Warning about an image that has fewer samples than it was asked for.
    pub(super) fn warning(self, drawn: u32, asked: u32) -> Option<String> {
        let samples = format!("after {drawn} of {asked} samples per pixel");
        match self {
            Self::Complete => None,
            Self::TimeLimit(limit) => Some(format!("the time limit of {limit} s ended the image {samples}")),
            Self::Interrupted => Some(format!("an interrupt ended the image {samples}")),
        }
    }
}

/// Conditions to stop before all is drawn, after a whole pass of one sample per pixel, or a whole replica.
#[derive(Debug)]
pub(super) struct EarlyEnd {
    /// Time limit by the clock on the wall \[s\].
    pub limit: Option<f64>,
    /// The first interrupt, which ends drawing.
    pub stop: GentleStop,
}

/// Draws an image: all of it, or pass by pass until it may end `early`. `after_pass` sees what is done
/// after each but the last, with the seconds that drawing took.
///
/// # Errors
/// If a look-up is not lawful, a sample not finite, or `after_pass` fails.
pub(super) fn paint<'p>(
    plan: &'p ScenePlan,
    early: Option<&EarlyEnd>,
    advance: &(dyn Fn(u64) + Sync),
    mut after_pass: impl FnMut(&Painting<'p>, f64) -> Result<(), Failure>,
) -> Result<Painted<'p>, Failure> {
    let mut painting = Painting::new(plan);
    let start = Instant::now();
    let Some(EarlyEnd { limit, stop }) = early else {
        painting.complete(advance)?;
        return Ok(Painted { painting, seconds: start.elapsed().as_secs_f64(), end: End::Complete });
    };
    let is_over = || limit.is_some_and(|limit| start.elapsed().as_secs_f64() >= limit);
    let mut seconds = 0.0;
    loop {
        let pass = Instant::now();
        match plan.integrator.replicas() {
            None => painting.add_pass(advance)?,
            Some(_) => painting.add_replicas(advance, &|| stop.is_requested() || is_over())?,
        }
        seconds += pass.elapsed().as_secs_f64();
        let end = if painting.is_complete() {
            End::Complete
        } else if stop.is_requested() {
            End::Interrupted
        } else if let Some(limit) = *limit
            && is_over()
        {
            End::TimeLimit(limit)
        } else {
            after_pass(&painting, seconds)?;
            continue;
        };
        return Ok(Painted { painting, seconds, end });
    }
}

/// Something to be done again and again, but not all the time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rhythm {
    /// The least time between two \[s\].
    pause: f64,
    due: f64,
}

/// It takes no more of the time than one part of so many.
const SHARE: f64 = 20.0;

impl Rhythm {
    /// Not before `pause` \[s\].
    pub(super) fn new(pause: f64) -> Self {
        Self { pause, due: pause }
    }

    /// Does it if it is due after so many seconds of work.
    ///
    /// # Errors
    /// If it fails.
    pub(super) fn beat(
        &mut self,
        seconds: f64,
        work: impl FnOnce() -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if seconds < self.due {
            return Ok(());
        }
        let start = Instant::now();
        work()?;
        self.due = seconds + self.pause.max(SHARE * start.elapsed().as_secs_f64());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_beat_waits_for_its_time() {
        let mut rhythm = Rhythm::new(2.0);
        let mut beats = Vec::new();
        for tenth in 0..60 {
            let seconds = f64::from(tenth) / 10.0;
            let work = || {
                beats.push(tenth);
                Ok(())
            };
            rhythm.beat(seconds, work).unwrap();
        }
        assert_eq!(beats, [20, 40]);
        // Slow work comes less often.
        let mut rhythm = Rhythm::new(0.1);
        let slow = || {
            std::thread::sleep(Duration::from_millis(20));
            Ok(())
        };
        rhythm.beat(0.1, slow).unwrap();
        assert!(rhythm.due >= 0.1 + 20.0 * 0.02);
        assert_eq!(rhythm.beat(9.0, || Err(Failure::refused("full"))), Err(Failure::refused("full")));
    }

    #[test]
    fn an_image_that_is_short_of_samples_says_so() {
        assert_eq!(End::Complete.warning(64, 64), None);
        assert_eq!(
            End::TimeLimit(5.0).warning(12, 64).unwrap(),
            "the time limit of 5 s ended the image after 12 of 64 samples per pixel"
        );
        assert!(End::Interrupted.warning(1, 2).unwrap().contains("after 1 of 2"));
    }
}

//! Slices that lanes fill.

use fairflight_elementary::lanes::LANES;

/// Estimates to be drawn, a slice from the stream of each lane, with their look-ups.
#[derive(Debug)]
pub struct Batches<'a, 'b> {
    estimates: &'a mut [&'b mut [f64]; LANES],
    /// The look-ups of each estimate, where they are asked for one by one.
    counts: Option<&'a mut [&'b mut [f64]; LANES]>,
    /// The number of estimates drawn so far.
    drawn: [usize; LANES],
    lookups: [u64; LANES],
    /// Lanes that have estimates to draw.
    open: usize,
}

impl<'a, 'b> Batches<'a, 'b> {
    /// Slices of any lengths to be filled, and of the same lengths for the look-ups of each estimate.
    pub fn new(
        estimates: &'a mut [&'b mut [f64]; LANES],
        counts: Option<&'a mut [&'b mut [f64]; LANES]>,
    ) -> Self {
        let open = estimates.iter().filter(|estimates| !estimates.is_empty()).count();
        Self { estimates, counts, drawn: [0; LANES], lookups: [0; LANES], open }
    }

    /// The look-ups of each lane so far.
    #[must_use]
    pub fn lookups(&self) -> [u64; LANES] {
        self.lookups
    }

    /// True while an estimate is to be drawn.
    #[inline(always)]
    pub(super) fn are_open(&self) -> bool {
        self.open > 0
    }

    /// True while an estimate is to be drawn in this lane.
    #[inline(always)]
    pub(super) fn is_open(&self, lane: usize) -> bool {
        self.drawn[lane] < self.estimates[lane].len()
    }

    /// Takes the next estimate of a lane, and its look-ups; nothing where the lane has none to draw.
    #[inline(always)]
    pub(super) fn take(&mut self, lane: usize, estimate: f64, lookups: u64) {
        let drawn = self.drawn[lane];
        let Some(place) = self.estimates[lane].get_mut(drawn) else { return };
        *place = estimate;
        if let Some(counts) = &mut self.counts {
            counts[lane][drawn] = lookups as f64;
        }
        self.lookups[lane] += lookups;
        self.drawn[lane] = drawn + 1;
        self.open -= usize::from(!self.is_open(lane));
    }
}

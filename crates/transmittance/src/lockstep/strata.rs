//! Jittered ratio tracking in lanes: the twin of `jittered_ratio.rs`.

use super::products::Products;
use super::{Batches, Lockstep};
use crate::jittered_ratio::Strata;
use crate::{JitteredRatio, JitteredRatioInCells};
use fairflight_elementary::lanes::{LANES, Lanes, Mask, lanes_of, mask, select, some};
use fairflight_media::{BoundCell, BoundedInCells, Epsilon, Extinction, Majorant};
use fairflight_sources::SeededLanes;

impl<F: Majorant> Lockstep<F> for JitteredRatio {
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        fill(field, (&[Self::cell(field)], self.epsilon), source, batches);
    }
}

impl<F: BoundedInCells> Lockstep<F> for JitteredRatioInCells {
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        fill(field, (field.bound_cells(), self.epsilon), source, batches);
    }
}

/// The cell that each lane is in.
struct Places {
    index: [usize; LANES],
    from: Lanes,
    /// The last point of the cell, before its end.
    last: Lanes,
    minorant: Lanes,
    range: Lanes,
    count: Lanes,
    width: Lanes,
    thickness: Lanes,
}

impl Places {
    /// Lanes that have not entered a cell.
    const BEFORE: Self = Self {
        index: [0; LANES],
        from: [0.0; LANES],
        last: [0.0; LANES],
        minorant: [0.0; LANES],
        range: [1.0; LANES],
        count: [1.0; LANES],
        width: [0.0; LANES],
        thickness: [0.0; LANES],
    };

    /// Enters the first cell from `index` on that has strata; false if there is none.
    #[inline]
    fn enter(&mut self, lane: usize, index: usize, (cells, epsilon): (&[BoundCell], Epsilon)) -> bool {
        let mut from = if index == 0 { 0.0 } else { cells[index - 1].to };
        for (index, cell) in cells.iter().enumerate().skip(index) {
            let strata = Strata::of(cell, from, epsilon);
            if strata.count > 0.0 {
                (self.index[lane], self.from[lane], self.last[lane]) = (index, from, cell.to.next_down());
                (self.minorant[lane], self.range[lane]) = (cell.minorant, cell.range());
                self.count[lane] = strata.count;
                (self.width[lane], self.thickness[lane]) = (strata.width, strata.thickness);
                return true;
            }
            from = cell.to;
        }
        false
    }
}

/// One look-up of every lane in each step: the next point of its stratum, the innermost bracket first.
#[inline(always)]
fn fill<F: Extinction>(
    field: &F,
    (cells, epsilon): (&[BoundCell], Epsilon),
    source: &mut SeededLanes,
    batches: &mut Batches<'_, '_>,
) {
    let (mut minorant_thickness, mut from) = (0.0, 0.0);
    for cell in cells {
        minorant_thickness += cell.minorant * (cell.to - from);
        from = cell.to;
    }
    let mut products = Products::ONE;
    let mut places = Places::BEFORE;
    if !(0..LANES).all(|lane| places.enter(lane, 0, (cells, epsilon))) {
        // Nothing to look up.
        for lane in 0..LANES {
            while batches.is_open(lane) {
                batches.take(lane, products.get(lane).times_exp(-minorant_thickness), 0);
            }
        }
        return;
    }
    // The stratum of each lane, its points that are left, and its product so far.
    let (mut stratum, mut left) = ([0.0; LANES], [0.0; LANES]);
    let (mut bracket, mut r) = ([1.0; LANES], [0.0; LANES]);
    let mut lookups = [0_u64; LANES];
    let mut begins: Mask = [u64::MAX; LANES];
    while batches.are_open() {
        let orders = orders(&places.thickness, &source.next_uniforms_of(&begins), &begins);
        let points = source.next_uniforms();
        let mut s = [0.0; LANES];
        for i in 0..LANES {
            left[i] = select(begins[i], orders[i], left[i]);
            bracket[i] = select(begins[i], 1.0, 1.0 - r[i] * bracket[i]);
            s[i] = (places.from[i] + (stratum[i] + points[i]) * places.width[i]).min(places.last[i]);
        }
        let sigma_t = field.sigma_t_lanes(&s);
        let (mut factors, mut ended) = ([0.0; LANES], [0; LANES]);
        for i in 0..LANES {
            r[i] = (sigma_t[i] - places.minorant[i]) / places.range[i];
            left[i] -= 1.0;
            lookups[i] += 1;
            begins[i] = mask(left[i] == 0.0);
            factors[i] = select(begins[i], 1.0 - places.thickness[i] * (r[i] * bracket[i]), 1.0);
            stratum[i] += select(begins[i], 1.0, 0.0);
            ended[i] = mask(stratum[i] == places.count[i]);
            stratum[i] = select(ended[i], 0.0, stratum[i]);
        }
        products.multiply(&factors);
        let mut walk_ended = [0; LANES];
        for lane in lanes_of(&ended) {
            if places.enter(lane, places.index[lane] + 1, (cells, epsilon)) {
                continue;
            }
            walk_ended[lane] = u64::MAX;
            batches.take(lane, products.get(lane).times_exp(-minorant_thickness), lookups[lane]);
            lookups[lane] = 0;
            if cells.len() > 1 {
                places.enter(lane, 0, (cells, epsilon));
            }
        }
        products.restart(&walk_ended);
    }
}

/// The orders of strata of this optical thickness that begin, by a variate each.
#[inline(always)]
fn orders(thickness: &Lanes, variates: &Lanes, begins: &Mask) -> Lanes {
    let (mut orders, mut at_least) = ([1.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        at_least[i] = 0.5 * thickness[i];
    }
    loop {
        let mut goes_on = [0; LANES];
        for i in 0..LANES {
            goes_on[i] = mask(variates[i] < at_least[i]) & begins[i];
            orders[i] += select(goes_on[i], 1.0, 0.0);
            at_least[i] *= select(goes_on[i], thickness[i] / (orders[i] + 1.0), 1.0);
        }
        if !some(&goes_on) {
            return orders;
        }
    }
}

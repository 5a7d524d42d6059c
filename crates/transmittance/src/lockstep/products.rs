//! A product in each lane.

use crate::SignedProduct;
use fairflight_elementary::lanes::{LANES, Lanes, Mask, lanes_of, mask, select, some};

/// A [`SignedProduct`] in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Products {
    mantissas: Lanes,
    scales: [i64; LANES],
    /// False while all scales are 0.
    are_scaled: bool,
}

impl Products {
    /// Empty products.
    pub const ONE: Self = Self { mantissas: [1.0; LANES], scales: [0; LANES], are_scaled: false };

    /// [`SignedProduct::multiply`] in each lane.
    #[inline(always)]
    pub fn multiply(&mut self, factors: &Lanes) {
        let (mut products, mut beyond) = ([0.0; LANES], 0);
        for i in 0..LANES {
            products[i] = self.mantissas[i] * factors[i];
            beyond |= SignedProduct::beyond_scale(products[i]);
        }
        if beyond.cast_signed() < 0 {
            let mut leaves = [0; LANES];
            for i in 0..LANES {
                let keeps_scale = SignedProduct::keeps_scale;
                // A zero keeps its scale too, unless a factor is so great or so small that it has one of its own.
                let stays_zero = (products[i] == 0.0) & ((factors[i] == 0.0) | keeps_scale(factors[i]));
                leaves[i] = mask(!(keeps_scale(products[i]) | stays_zero));
            }
            if some(&leaves) {
                return self.multiply_far(factors);
            }
        }
        self.mantissas = products;
    }

    #[cold]
    #[inline(never)]
    fn multiply_far(&mut self, factors: &Lanes) {
        for (lane, &factor) in factors.iter().enumerate() {
            let mut product = self.get(lane);
            product.multiply(factor);
            (self.mantissas[lane], self.scales[lane]) = (product.mantissa, product.scale);
        }
        self.are_scaled = true;
    }

    /// The product of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> SignedProduct {
        SignedProduct { mantissa: self.mantissas[lane], scale: self.scales[lane] }
    }

    /// The product of a lane, which begins anew.
    #[inline]
    #[must_use]
    pub fn take(&mut self, lane: usize) -> SignedProduct {
        let product = self.get(lane);
        (self.mantissas[lane], self.scales[lane]) = (1.0, 0);
        product
    }

    /// The products of these lanes begin anew.
    #[inline(always)]
    pub fn restart(&mut self, lanes: &Mask) {
        for (mantissa, &restarts) in self.mantissas.iter_mut().zip(lanes) {
            *mantissa = select(restarts, 1.0, *mantissa);
        }
        if self.are_scaled {
            self.restart_scales(lanes);
        }
    }

    #[cold]
    #[inline(never)]
    fn restart_scales(&mut self, lanes: &Mask) {
        lanes_of(lanes).for_each(|lane| self.scales[lane] = 0);
        self.are_scaled = self.scales != [0; LANES];
    }
}

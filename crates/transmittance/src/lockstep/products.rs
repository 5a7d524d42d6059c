//! A product in each lane.

use crate::SignedProduct;
use fairflight_elementary::lanes::{LANES, Lanes};

/// A [`SignedProduct`] in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Products {
    mantissas: Lanes,
    scales: [i64; LANES],
}

impl Products {
    /// Empty products: 1 in all lanes.
    pub const ONE: Self = Self { mantissas: [1.0; LANES], scales: [0; LANES] };

    /// [`SignedProduct::multiply`] in each lane.
    #[inline(always)]
    pub fn multiply(&mut self, factors: &Lanes) {
        let mut products = [0.0; LANES];
        let mut all_keep = true;
        for i in 0..LANES {
            let (product, factor) = (self.mantissas[i] * factors[i], factors[i]);
            products[i] = product;
            // A zero keeps its scale too, unless a factor is so great or so small that it has one of its own.
            let stays_zero = (product == 0.0) & ((factor == 0.0) | SignedProduct::keeps_scale(factor));
            all_keep &= SignedProduct::keeps_scale(product) | stays_zero;
        }
        if all_keep {
            self.mantissas = products;
        } else {
            self.multiply_far(factors);
        }
    }

    #[cold]
    #[inline(never)]
    fn multiply_far(&mut self, factors: &Lanes) {
        for (lane, &factor) in factors.iter().enumerate() {
            let mut product = self.get(lane);
            product.multiply(factor);
            (self.mantissas[lane], self.scales[lane]) = (product.mantissa, product.scale);
        }
    }

    fn get(&self, lane: usize) -> SignedProduct {
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
}

//! Gray or coloured: what radiance is made of.

use glam::DVec3;
use std::ops::{Add, AddAssign, Mul};

/// A number per channel. A gray scene uses `f64` and pays for nothing else.
pub trait Spectrum:
    Copy
    + Send
    + Sync
    + PartialEq
    + std::fmt::Debug
    + Add<Output = Self>
    + AddAssign
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
{
    /// The number of channels.
    const CHANNELS: usize;

    /// Zero in all channels.
    const ZERO: Self;

    /// The same in all channels.
    fn splat(value: f64) -> Self;

    /// One channel.
    fn channel(self, index: usize) -> f64;

    /// A function of each channel.
    #[must_use]
    fn map(self, function: impl Fn(f64) -> f64) -> Self;

    /// The greatest channel.
    fn max_channel(self) -> f64;

    /// The greatest absolute value of a channel.
    fn magnitude(self) -> f64;

    /// The mean of the channels: what one number says of a colour.
    fn mean(self) -> f64;

    /// True if every channel is a finite number.
    fn is_finite(self) -> bool;

    /// Red, green and blue; three times the same if gray.
    fn rgb(self) -> [f64; 3];

    /// The spectrum of red, green and blue; a gray one takes their mean.
    fn from_rgb(rgb: [f64; 3]) -> Self;
}

impl Spectrum for f64 {
    const CHANNELS: usize = 1;
    const ZERO: Self = 0.0;

    #[inline]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline]
    fn channel(self, _index: usize) -> f64 {
        self
    }
    #[inline]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }
    #[inline]
    fn max_channel(self) -> f64 {
        self
    }
    #[inline]
    fn magnitude(self) -> f64 {
        self.abs()
    }
    #[inline]
    fn mean(self) -> f64 {
        self
    }
    #[inline]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    fn rgb(self) -> [f64; 3] {
        [self; 3]
    }
    fn from_rgb(rgb: [f64; 3]) -> Self {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] { rgb[0] } else { rgb.iter().sum::<f64>() / 3.0 }
    }
}

impl Spectrum for DVec3 {
    const CHANNELS: usize = 3;
    const ZERO: Self = Self::ZERO;

    #[inline]
    fn splat(value: f64) -> Self {
        Self::splat(value)
    }
    #[inline]
    fn channel(self, index: usize) -> f64 {
        self[index]
    }
    #[inline]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(function(self.x), function(self.y), function(self.z))
    }
    #[inline]
    fn max_channel(self) -> f64 {
        self.max_element()
    }
    #[inline]
    fn magnitude(self) -> f64 {
        self.abs().max_element()
    }
    #[inline]
    fn mean(self) -> f64 {
        self.element_sum() / 3.0
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.is_finite()
    }
    fn rgb(self) -> [f64; 3] {
        self.to_array()
    }
    fn from_rgb(rgb: [f64; 3]) -> Self {
        Self::from_array(rgb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_channels() {
        assert_eq!((2.5.mean(), DVec3::new(1.0, 2.0, 6.0).mean()), (2.5, 3.0));
    }
}

//! The sRGB encoding for transmittance and radiance, a diverging map for errors, a sequential one for heat maps.
//!
//! The diverging map is built in Oklab (Ottosson 2020): lightness falls and chroma grows equally fast on both sides of zero, blue
//! for too dark, orange for too bright. Equal errors of either sign thus stand out equally, and the two hues stay apart in all
//! common colour vision deficiencies.
//!
//! The sequential map rises in lightness alone: its hue turns from violet over blue and green to yellow only to make steps easier to
//! tell, so that it reads the same in grey and for every colour vision.

use super::palette::Rgb;

/// Hue of negative and of positive errors in Oklab \[rad\].
const BLUE: f64 = 4.45;
const ORANGE: f64 = 0.95;
/// Lightness at zero and at the ends.
const LIGHT: f64 = 0.97;
const DARK: f64 = 0.46;
/// Chroma at the ends: the largest that both hues can show.
const CHROMA: f64 = 0.105;

/// The colour of an error as a fraction of the full scale; beyond ±1 the ends of the map.
pub(crate) fn diverging(x: f64) -> Rgb {
    // 127 levels on either side: an image then has at most 255 colours.
    let x = (x.clamp(-1.0, 1.0) * 127.0).round() / 127.0;
    let hue = if x < 0.0 { BLUE } else { ORANGE };
    let lightness = LIGHT + (DARK - LIGHT) * x.abs();
    let chroma = CHROMA * x.abs();
    srgb_of_oklab([lightness, chroma * hue.cos(), chroma * hue.sin()])
}

/// Hues of the sequential map at its ends in Oklab \[rad\]: violet and yellow.
const VIOLET: f64 = 5.15;
const YELLOW: f64 = 1.85;
/// Lightness of the sequential map at its ends.
const LOWEST: f64 = 0.26;
const HIGHEST: f64 = 0.95;
/// Its chroma, which the blues between its ends limit, and how much the yellow end has more.
const EVEN_CHROMA: f64 = 0.095;
const MORE_CHROMA: f64 = 0.06;
/// How many colours it has.
pub(crate) const LEVELS: u16 = 64;

/// The level of a fraction of the full scale; beyond 0 and 1 the ends of the map.
pub(crate) fn level(x: f64) -> u16 {
    // A cast saturates, and a NaN has no place in a map.
    ((x * f64::from(LEVELS)) as u16).min(LEVELS - 1)
}

/// The colour of a level, dark for the lowest.
pub(crate) fn sequential(level: u16) -> Rgb {
    let x = f64::from(level) / f64::from(LEVELS - 1);
    let hue = VIOLET + (YELLOW - VIOLET) * x;
    let chroma = EVEN_CHROMA + MORE_CHROMA * x.powi(3);
    srgb_of_oklab([LOWEST + (HIGHEST - LOWEST) * x, chroma * hue.cos(), chroma * hue.sin()])
}

/// The level of a transmittance, or of a channel of exposed radiance: the sRGB encoding, values outside \[0, 1\] shown as its ends.
pub(crate) fn grey(linear: f64) -> u8 {
    byte(srgb_of_linear(linear.clamp(0.0, 1.0)))
}

fn byte(x: f64) -> u8 {
    // A float-to-integer cast saturates, and NaN becomes black.
    (x * 255.0).round() as u8
}

fn srgb_of_linear(c: f64) -> f64 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

fn srgb_of_oklab([lightness, a, b]: [f64; 3]) -> Rgb {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let r = 4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s;
    let g = -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s;
    let b = -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s;
    (byte(srgb_of_linear(r)), byte(srgb_of_linear(g)), byte(srgb_of_linear(b)))
}

/// The inverse of the sRGB encoding.
#[cfg(test)]
pub(crate) fn linear_of_srgb(c: f64) -> f64 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Oklab of linear RGB.
#[cfg(test)]
pub(crate) fn oklab_of_linear([r, g, b]: [f64; 3]) -> [f64; 3] {
    let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
    let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
    let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_errors_of_either_sign_are_equally_light() {
        for step in 0..=10 {
            let lightness = |x: f64| {
                let (r, g, b) = diverging(x);
                oklab_of_linear([r, g, b].map(|c| linear_of_srgb(f64::from(c) / 255.0)))[0]
            };
            let x = f64::from(step) / 10.0;
            assert!((lightness(x) - lightness(-x)).abs() < 0.01, "at {x}");
            let wanted = LIGHT + (DARK - LIGHT) * x;
            assert!((lightness(x) - wanted).abs() < 0.01, "out of gamut at {x}");
        }
    }

    #[test]
    fn the_sequential_map_rises_evenly_in_lightness() {
        for level in 0..LEVELS {
            let (r, g, b) = sequential(level);
            let lightness = oklab_of_linear([r, g, b].map(|c| linear_of_srgb(f64::from(c) / 255.0)))[0];
            let wanted = LOWEST + (HIGHEST - LOWEST) * f64::from(level) / f64::from(LEVELS - 1);
            assert!((lightness - wanted).abs() < 0.006, "out of gamut at {level}: {lightness} for {wanted}");
        }
        assert_eq!([-1.0, 0.0, 0.5, 1.0, f64::INFINITY].map(level), [0, 0, 32, 63, 63]);
    }

    #[test]
    fn the_grey_of_an_estimate_is_defined_everywhere() {
        assert_eq!([grey(-3.0), grey(0.0), grey(1.0), grey(7.0)], [0, 0, 255, 255]);
        assert_eq!(grey(f64::NAN), 0);
    }
}

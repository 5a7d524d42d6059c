//! A palette for pictures of many colours, by median cut (Heckbert 1982): the box of colours with the longest side is halved at the
//! median of its pixels until there are enough boxes. Deterministic, and exact where the colours are few.

/// At most `count` colours that stand for these pixels.
pub(super) fn palette(pixels: &[[u8; 3]], count: usize) -> Vec<[u8; 3]> {
    let mut distinct = pixels.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    if distinct.len() <= count {
        return distinct;
    }
    let mut boxes = vec![pixels.to_vec()];
    while boxes.len() < count {
        // The first of equally long ones: the order of boxes depends on the pixels alone.
        let Some((at, channel, _)) = boxes
            .iter()
            .enumerate()
            .map(|(k, colours)| {
                let (channel, length) = longest_side(colours);
                (k, channel, length)
            })
            .filter(|&(_, _, length)| length > 0)
            .reduce(|best, other| if other.2 > best.2 { other } else { best })
        else {
            break;
        };
        let mut colours = boxes.swap_remove(at);
        colours.sort_unstable_by_key(|colour| (colour[channel], *colour));
        // Both halves must have something: equal colours stay together.
        let middle = colours[colours.len() / 2][channel];
        let first = colours[0][channel];
        let cut = colours
            .partition_point(|c| if middle > first { c[channel] < middle } else { c[channel] <= middle });
        let upper = colours.split_off(cut);
        boxes.push(colours);
        boxes.push(upper);
    }
    boxes.iter().map(|colours| mean(colours)).collect()
}

fn longest_side(colours: &[[u8; 3]]) -> (usize, u8) {
    (0..3)
        .map(|channel| {
            let values = || colours.iter().map(|colour| colour[channel]);
            (channel, values().max().unwrap_or(0) - values().min().unwrap_or(0))
        })
        .reduce(|best, other| if other.1 > best.1 { other } else { best })
        .unwrap_or((0, 0))
}

fn mean(colours: &[[u8; 3]]) -> [u8; 3] {
    [0, 1, 2].map(|channel| {
        let sum: usize = colours.iter().map(|colour| usize::from(colour[channel])).sum();
        let n = colours.len().max(1);
        u8::try_from((sum + n / 2) / n).unwrap_or(u8::MAX)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept() {
        let pixels = [[3, 2, 1], [0, 0, 0], [3, 2, 1]];
        assert_eq!(palette(&pixels, 2), [[0, 0, 0], [3, 2, 1]]);
    }

    #[test]
    fn a_gradient_is_cut_evenly() {
        let pixels: Vec<[u8; 3]> = (0..=255).map(|k| [k, 0, 255 - k]).collect();
        let palette = palette(&pixels, 16);
        assert_eq!(palette.len(), 16);
        for pixel in pixels {
            let nearest = palette.iter().map(|c| c[0].abs_diff(pixel[0])).min().unwrap();
            assert!(nearest <= 8, "{pixel:?}: {nearest}");
        }
    }

    #[test]
    fn one_colour_almost_everywhere_leaves_room_for_the_others() {
        let mut pixels = vec![[10, 10, 10]; 10_000];
        pixels.extend((0..40).map(|k| [200, 5 * k, 30]));
        assert_eq!(palette(&pixels, 8).len(), 8);
    }
}

//! Pictures of half-block characters: two pixels a character, one above the other.

use crate::show::image::Image;
use std::fmt::Write;

/// The colours of a terminal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Palette {
    /// 24 bits.
    True,
    /// The 256 colours of xterm: 16 that users choose, a cube of 6 × 6 × 6, and 24 greys.
    Indexed,
}

/// Returns the image as lines of characters. Where a pixel is less than half opaque, the terminal's own
/// background stays.
pub fn text(image: &Image, palette: Palette) -> String {
    let mut text = String::new();
    let row = |y: usize| image.pixels.get(y * image.width..(y + 1) * image.width);
    for y in (0..image.height).step_by(2) {
        // The terminal's present foreground and background.
        let mut state = [None; 2];
        for x in 0..image.width {
            let colour = |y: usize| {
                row(y).map(|row| row[x]).filter(|pixel| pixel[3] >= 128).map(|[r, g, b, _]| [r, g, b])
            };
            let (character, wanted) = match [colour(y), colour(y + 1)] {
                [None, None] => (' ', [state[0], None]),
                [None, below] => ('▄', [below, None]),
                [above, below] => ('▀', [above, below]),
            };
            for (layer, (is, wanted)) in state.iter_mut().zip(wanted).enumerate() {
                if *is != wanted {
                    select(&mut text, layer, wanted, palette);
                    *is = wanted;
                }
            }
            text.push(character);
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// Selects the colour of the foreground (0) or the background (1) for the characters that follow.
fn select(text: &mut String, layer: usize, colour: Option<[u8; 3]>, palette: Palette) {
    let code = [38, 48][layer];
    // Writing to a string does not fail.
    let _ = match (colour, palette) {
        (None, _) => write!(text, "\x1b[{}m", code + 1),
        (Some([r, g, b]), Palette::True) => write!(text, "\x1b[{code};2;{r};{g};{b}m"),
        (Some(colour), Palette::Indexed) => write!(text, "\x1b[{code};5;{}m", nearest(colour)),
    };
}

/// Values of the cube's colours.
const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// Returns the number of the nearest of the 240 colours that are the same on every terminal.
fn nearest(colour: [u8; 3]) -> u8 {
    let distance = |other: [u8; 3]| -> u32 {
        colour.iter().zip(other).map(|(&a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
    };
    let [r, g, b] = colour.map(|value| (0..6).min_by_key(|&i| STEPS[i].abs_diff(value)).unwrap_or(0));
    let mean = colour.iter().map(|&value| u32::from(value)).sum::<u32>() / 3;
    // Greys are 8, 18, …, 238.
    let grey = (mean.saturating_sub(3) / 10).min(23) as u8;
    if distance([8 + 10 * grey; 3]) < distance([r, g, b].map(|i| STEPS[i])) {
        232 + grey
    } else {
        (16 + 36 * r + 6 * g + b) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_240_colours() {
        let colours: Vec<[u8; 3]> = (0..216)
            .map(|i| [i / 36, i / 6 % 6, i % 6].map(|step| STEPS[step]))
            .chain((0..24).map(|i| [8 + 10 * i; 3]))
            .collect();
        let distance = |a: [u8; 3], b: [u8; 3]| -> u32 {
            (0..3).map(|k| (i32::from(a[k]) - i32::from(b[k])).pow(2) as u32).sum()
        };
        for i in 0..16 * 16 * 16u32 {
            let colour = [i >> 8, i >> 4 & 15, i & 15].map(|value| (value * 17) as u8);
            let least = colours.iter().map(|&other| distance(colour, other)).min().unwrap();
            let found = colours[usize::from(nearest(colour)) - 16];
            assert_eq!(distance(colour, found), least, "{colour:?}");
        }
    }
}

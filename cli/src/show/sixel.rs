//! Pictures as sixels: columns of six pixels in the colours of a palette, for terminals that descend from the
//! VT340.

use crate::show::image::Image;
use color_quant::NeuQuant;
use std::collections::HashMap;
use std::fmt::Write;

/// Number of colours that a terminal of any age has.
pub const FEWEST: usize = 16;
pub const MOST: usize = 256;

/// Returns the image in at most `colours` colours. Pixels that are less than half opaque stay as the terminal
/// has them.
pub fn text(image: &Image, colours: usize) -> String {
    let pixels: Vec<Option<[u8; 3]>> = image.pixels.iter().map(percent).collect();
    let palette = Palette::of(&pixels, colours.clamp(FEWEST, MOST));
    // Square pixels (7); pixels without a colour stay as they are (1).
    let mut text = format!("\x1bP7;1q\"1;1;{};{}", image.width, image.height);
    for (i, [r, g, b]) in palette.colours.iter().enumerate() {
        put(&mut text, format_args!("#{i};2;{r};{g};{b}"));
    }
    // For each colour, the pixels of a band of six rows that have it.
    let mut sixels = vec![0u8; palette.colours.len() * image.width];
    for (number, band) in pixels.chunks(6 * image.width.max(1)).enumerate() {
        if number > 0 {
            text.push('-');
        }
        sixels.fill(0);
        for (i, colour) in band.iter().enumerate() {
            if let Some(index) = colour.and_then(|colour| palette.indices.get(&colour)) {
                sixels[index * image.width + i % image.width] |= 1 << (i / image.width);
            }
        }
        let mut is_first = true;
        for (index, row) in sixels.chunks(image.width.max(1)).enumerate() {
            let Some(last) = row.iter().rposition(|&sixel| sixel != 0) else { continue };
            if !is_first {
                text.push('$');
            }
            is_first = false;
            put(&mut text, format_args!("#{index}"));
            for run in row[..=last].chunk_by(|a, b| a == b) {
                let character = char::from(b'?' + run[0]);
                match run.len() {
                    n @ 4.. => put(&mut text, format_args!("!{n}{character}")),
                    n => text.extend(std::iter::repeat_n(character, n)),
                }
            }
        }
    }
    text.push_str("\x1b\\");
    text
}

fn put(text: &mut String, what: std::fmt::Arguments) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(what);
}

/// Returns a colour in the unit of sixels, hundredths, unless it is less than half opaque.
fn percent(&[r, g, b, a]: &[u8; 4]) -> Option<[u8; 3]> {
    (a >= 128).then(|| [r, g, b].map(hundredth))
}

fn hundredth(byte: u8) -> u8 {
    ((u32::from(byte) * 100 + 127) / 255) as u8
}

fn byte(hundredth: u8) -> u8 {
    ((u32::from(hundredth) * 255 + 50) / 100) as u8
}

/// The colours of an image, and the colour of each pixel among them.
struct Palette {
    /// In hundredths.
    colours: Vec<[u8; 3]>,
    /// The index in `colours` that stands for a pixel's colour.
    indices: HashMap<[u8; 3], usize>,
}

impl Palette {
    fn of(pixels: &[Option<[u8; 3]>], most: usize) -> Palette {
        let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
        for colour in pixels.iter().flatten() {
            *counts.entry(*colour).or_default() += 1;
        }
        let mut counts: Vec<([u8; 3], usize)> = counts.into_iter().collect();
        // The order must not depend on the order of the map.
        counts.sort_unstable_by_key(|&(colour, count)| (std::cmp::Reverse(count), colour));
        let mut colours: Vec<[u8; 3]> = counts.iter().map(|&(colour, _)| colour).collect();
        if colours.len() > most {
            // The most frequent colours stay exact, so that flat areas do; the others are approximated.
            colours.truncate(most / 4);
            let others: Vec<u8> = pixels
                .iter()
                .flatten()
                .filter(|colour| !colours.contains(colour))
                .flat_map(|&[r, g, b]| [byte(r), byte(g), byte(b), 255])
                .collect();
            // One of this many pixels is examined.
            let part = if others.len() > 400_000 { 10 } else { 1 };
            let network = NeuQuant::new(part, most - colours.len(), &others);
            let found = network.color_map_rgb();
            colours.extend(found.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]].map(hundredth)));
        }
        let nearest = |colour: [u8; 3]| {
            let distance = |other: &[u8; 3]| -> u32 {
                colour.iter().zip(other).map(|(&a, &b)| u32::from(a.abs_diff(b)).pow(2)).sum()
            };
            (0..colours.len()).min_by_key(|&i| distance(&colours[i])).unwrap_or(0)
        };
        let indices = counts.iter().map(|&(colour, _)| (colour, nearest(colour))).collect();
        Palette { colours, indices }
    }
}

//! Legends on finished pictures: colour bars, names of colours, and scale bars.

use super::picture::Picture;
use crate::error::Error;
use crate::lattice::Each;
use core::convert::Infallible;
use core::fmt::Write;
use embedded_graphics::mono_font::iso_8859_1::{FONT_5X8, FONT_6X10, FONT_8X13, FONT_10X20};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, Point, RgbColor, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};

/// The side of a picture on which a legend lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LegendSide {
    /// In the middle of the right side, at most a third of the width.
    #[default]
    Right,
    /// In the middle of the lower side, at most a third of the height.
    Bottom,
}

/// A part of a picture in pixels: its left and upper side, its width and its height.
pub type LegendBox = [u32; 4];

/// The smallest picture that has room for a legend.
const SMALLEST: [u32; 2] = [160, 120];

/// The colour of the panel behind a legend, and its share (of 255) when it is mixed with the picture.
const PANEL: [u8; 3] = [255; 3];
const PANEL_SHARE: u32 = 220;

const INK: Rgb888 = Rgb888::new(20, 20, 20);

/// The greatest length of labels and titles, in characters.
const LONGEST: usize = 64;

/// Draws a bar of the colours of the values in a range, with a title and numbers at intervals of 1, 2 or 5
/// times a power of ten. The legend is drawn on a light panel. It covers at most a third of the picture along
/// one axis. Titles that are too long are cut.
///
/// Returns the box that the legend covers; `None` if the picture is smaller than 160 × 120 pixels, because it
/// then gets no legend.
///
/// # Errors
/// [`Error::Argument`] if the range is not two finite numbers in ascending order.
pub fn draw_colour_bar(
    picture: &mut Picture,
    title: &str,
    range: [f64; 2],
    colour: &dyn Fn(f64) -> [u8; 4],
    side: LegendSide,
) -> Result<Option<LegendBox>, Error> {
    let [low, high] = range;
    let is_range = low <= high && (high - low).is_finite();
    if !is_range {
        return Err(Error::Argument { name: "range", problem: "must be finite numbers in ascending order" });
    }
    let Some((mut canvas, limit)) = Canvas::new(picture, side) else { return Ok(None) };
    let (line, pad) = (canvas.line(), canvas.pad());
    let longest = |ticks: &Ticks| ticks.labels().map(|(_, label)| label.as_str().chars().count()).max();
    let covered = match side {
        LegendSide::Right => {
            let height = canvas.size[1] - canvas.size[1] / 5;
            let top = (canvas.size[1] - height) / 2;
            let bar_height = height.saturating_sub(3 * pad + 2 * line);
            let ticks = Ticks::new(range, (bar_height / (2 * line)).max(2));
            let bar_width = line;
            let labels = canvas.width_of(longest(&ticks).unwrap_or(0));
            let rest = canvas.width_of(title.chars().count().min(LONGEST));
            let width = (3 * pad + pad / 2 + bar_width + labels).max(2 * pad + rest).min(limit);
            let covered = [canvas.size[0] - width, top, width, height];
            canvas.panel(covered);
            let left = covered[0] + pad;
            canvas.text(title, [left, top + pad]);
            let bar_top = top + 2 * pad + line + line / 2;
            for y in 0..bar_height {
                // The greatest value is on top.
                let share = 1.0 - (f64::from(y) + 0.5) / f64::from(bar_height);
                let shade = colour(low + (high - low) * share);
                canvas.fill([left, bar_top + y, bar_width, 1], shade);
            }
            canvas.frame([left, bar_top, bar_width, bar_height]);
            for (value, label) in ticks.labels() {
                let y = (1.0 - share_of(value, range)) * f64::from(bar_height - 1);
                let y = bar_top + (y + 0.5) as u32;
                canvas.fill([left + bar_width, y, pad, canvas.thin()], INK_BYTES);
                let place = [left + bar_width + pad + pad / 2, y.saturating_sub(line / 2)];
                canvas.text(label.as_str(), place);
            }
            covered
        }
        LegendSide::Bottom => {
            let width = canvas.size[0] - canvas.size[0] / 5;
            let left = (canvas.size[0] - width) / 2;
            let height = (4 * pad + 3 * line).min(limit);
            let covered = [left, canvas.size[1] - height, width, height];
            canvas.panel(covered);
            canvas.text(title, [left + pad, covered[1] + pad]);
            // Half a label on each side.
            let label = canvas.width_of(longest(&Ticks::new(range, 2)).unwrap_or(0)).max(canvas.width_of(5));
            let margin = (label / 2 + pad).min(width / 4);
            let (bar_left, bar_width) = (left + margin, width - 2 * margin);
            let bar_top = covered[1] + pad + line + pad / 2;
            for x in 0..bar_width {
                let share = (f64::from(x) + 0.5) / f64::from(bar_width);
                let shade = colour(low + (high - low) * share);
                canvas.fill([bar_left + x, bar_top, 1, line], shade);
            }
            canvas.frame([bar_left, bar_top, bar_width, line]);
            // More numbers may have longer labels, so search from the greatest number down.
            let most = (2..=(bar_width / canvas.width_of(3)).max(2)).rev().find(|&most| {
                let ticks = Ticks::new(range, most);
                let width = canvas.width_of(longest(&ticks).unwrap_or(0) + 2);
                ticks.count() * u64::from(width) <= u64::from(bar_width)
            });
            for (value, label) in Ticks::new(range, most.unwrap_or(2)).labels() {
                let x = share_of(value, range) * f64::from(bar_width - 1);
                let x = bar_left + (x + 0.5) as u32;
                canvas.fill([x, bar_top + line, canvas.thin(), pad], INK_BYTES);
                let half = canvas.width_of(label.as_str().chars().count()) / 2;
                canvas.text(label.as_str(), [x.saturating_sub(half), bar_top + line + pad + pad / 2]);
            }
            covered
        }
    };
    Ok(Some(covered))
}

/// Draws a title, unless it is empty, and boxes of colours with their names, on a light panel. The legend
/// covers at most a third of the picture along one axis. Names that do not fit are left out, or cut.
///
/// Returns the box that the legend covers; `None` if the picture is smaller than 160 × 120 pixels, because it
/// then gets no legend, or if there is nothing to draw.
pub fn draw_names(
    picture: &mut Picture,
    title: &str,
    names: &[(&str, [u8; 4])],
    side: LegendSide,
) -> Option<LegendBox> {
    if title.is_empty() && names.is_empty() {
        return None;
    }
    let (mut canvas, limit) = Canvas::new(picture, side)?;
    let (line, pad) = (canvas.line(), canvas.pad());
    let row = line + pad;
    let heading = if title.is_empty() { 0 } else { row };
    let letter = canvas.width_of(1);
    let width_of = |text: &str| text.chars().count().min(LONGEST) as u32 * letter;
    // A box, a gap, the name, and a gap to the next one.
    let entry = |name: &str| line + pad + width_of(name) + 2 * pad;
    let (most, room) = match side {
        LegendSide::Right => (limit, canvas.size[1]),
        LegendSide::Bottom => (canvas.size[0], limit),
    };
    // The place of each entry in the panel: side by side below, one under another on the right. Entries
    // beyond its end are not visited.
    let place_all = |visit: Visit<'_>| {
        let [mut x, mut y] = [pad, pad + heading];
        for &(name, colour) in names {
            if x > pad && (side == LegendSide::Right || x + entry(name) > most) {
                (x, y) = (pad, y + row);
            }
            if y + row > room {
                break;
            }
            visit(name, colour, [x, y]);
            x += entry(name);
        }
    };
    let (mut width, mut height) = (2 * pad + width_of(title), pad + heading);
    place_all(&mut |name, _, [x, y]| {
        width = width.max(x + entry(name));
        height = height.max(y + row);
    });
    let (width, height) = (width.min(most), height.min(room));
    let [left, top] = match side {
        LegendSide::Right => [canvas.size[0] - width, (canvas.size[1] - height) / 2],
        LegendSide::Bottom => [(canvas.size[0] - width) / 2, canvas.size[1] - height],
    };
    canvas.panel([left, top, width, height]);
    canvas.text(title, [left + pad, top + pad]);
    place_all(&mut |name, colour, [x, y]| {
        let square = [left + x, top + y, line, line];
        canvas.fill(square, colour);
        canvas.frame(square);
        canvas.text(name, [left + x + line + pad, top + y]);
    });
    Some([left, top, width, height])
}

/// Draws a bar in the lower left corner whose length is a round number of model units, with the number, and a
/// note above it unless the note is empty. The legend is drawn on a light panel of at most half the width and
/// a third of the height. A picture of a plane that is seen along its normal through a
/// [`Parallel`](super::Lens::Parallel) lens has one scale everywhere: its height in model units, divided by
/// its height in pixels.
///
/// Returns the box that the legend covers; `None` if the picture is smaller than 160 × 120 pixels, because it
/// then gets no legend.
///
/// # Errors
/// [`Error::Argument`] unless `units_per_pixel` lies between 1e-250 and 1e250.
pub fn draw_scale_bar(
    picture: &mut Picture,
    units_per_pixel: f64,
    note: &str,
) -> Result<Option<LegendBox>, Error> {
    if !(1e-250..=1e250).contains(&units_per_pixel) {
        return Err(Error::Argument {
            name: "units_per_pixel",
            problem: "must lie between 1e-250 and 1e250",
        });
    }
    let Some((mut canvas, limit)) = Canvas::new(picture, LegendSide::Bottom) else { return Ok(None) };
    let (line, pad) = (canvas.line(), canvas.pad());
    let (step, exponent) = round_below(f64::from(canvas.size[0]) * 0.25 * units_per_pixel);
    let label = Label::new(step, exponent);
    let length = ((Ticks::value_of(step, exponent) / units_per_pixel + 0.5) as u32).max(1);
    let width_of = |text: &str| text.chars().count().min(LONGEST) as u32 * canvas.width_of(1);
    let width =
        (2 * pad + (length + pad + width_of(label.as_str())).max(width_of(note))).min(canvas.size[0] / 2);
    let note_height = if note.is_empty() { 0 } else { line + pad };
    let height = (2 * pad + note_height + line).min(limit);
    let covered = [0, canvas.size[1] - height, width, height];
    canvas.panel(covered);
    canvas.text(note, [pad, covered[1] + pad]);
    let (top, tick) = (covered[1] + pad + note_height, line / 2);
    let thick = 2 * canvas.thin();
    canvas.fill([pad, top + line / 2 - thick / 2, length, thick], INK_BYTES);
    for left in [pad, pad + length - thick.min(length)] {
        canvas.fill([left, top + (line - tick) / 2, thick, tick], INK_BYTES);
    }
    canvas.text(label.as_str(), [2 * pad + length, top]);
    Ok(Some(covered))
}

/// The greatest number that is 1, 2 or 5 times a power of ten and not above a given number: the factor, and
/// the exponent.
fn round_below(most: f64) -> (i64, i32) {
    let exponent = libm::floor(libm::log10(most)) as i32;
    let mut found = (1, exponent - 1);
    for (step, exponent) in
        [(5, exponent - 1), (1, exponent), (2, exponent), (5, exponent), (1, exponent + 1)]
    {
        // (A number that is round up to rounding errors counts as round.)
        if Ticks::value_of(step, exponent) <= most * (1.0 + 1e-9) {
            found = (step, exponent);
        }
    }
    found
}

/// A callback for a name, its colour, and the place of its entry.
type Visit<'v> = &'v mut dyn FnMut(&str, [u8; 4], [u32; 2]);

const INK_BYTES: [u8; 4] = [20, 20, 20, 255];

/// The place of a value in a range: 0 to 1.
fn share_of(value: f64, [low, high]: [f64; 2]) -> f64 {
    if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
}

/// A picture on which a legend is drawn, or a part of it.
struct Canvas<'p> {
    picture: &'p mut Picture,
    size: [u32; 2],
    font: &'static MonoFont<'static>,
    /// The number of picture pixels per font pixel.
    scale: u32,
    /// The part that may be changed: left, top, right and bottom.
    within: [u32; 4],
}

impl<'p> Canvas<'p> {
    /// Also returns the greatest width of a legend on the right, or the greatest height of one below.
    fn new(picture: &'p mut Picture, side: LegendSide) -> Option<(Canvas<'p>, u32)> {
        let size = [picture.width, picture.height];
        if size[0] < SMALLEST[0] || size[1] < SMALLEST[1] {
            return None;
        }
        // Wide pictures that are not high have a smaller font, and so have high ones that are not wide.
        let (font, scale) = match size[1].min(size[0] * 3 / 4) {
            ..200 => (&FONT_5X8, 1),
            200..400 => (&FONT_6X10, 1),
            400..800 => (&FONT_8X13, 1),
            side => (&FONT_10X20, (side / 900).max(1)),
        };
        let limit = match side {
            LegendSide::Right => size[0] / 3,
            LegendSide::Bottom => size[1] / 3,
        };
        Some((Canvas { picture, size, font, scale, within: [0; 4] }, limit))
    }

    /// The height of a line.
    fn line(&self) -> u32 {
        self.font.character_size.height * self.scale
    }

    fn pad(&self) -> u32 {
        (self.line() / 3).max(2)
    }

    /// The width of thin lines.
    fn thin(&self) -> u32 {
        self.scale
    }

    fn width_of(&self, characters: usize) -> u32 {
        characters.min(LONGEST) as u32 * self.font.character_size.width * self.scale
    }

    /// Lightens a box, and limits the following drawing to it.
    fn panel(&mut self, [left, top, width, height]: LegendBox) {
        self.within = [left, top, left + width, top + height];
        self.blend([left, top, width, height], PANEL, PANEL_SHARE);
    }

    /// Fills a box with a colour.
    fn fill(&mut self, at: LegendBox, [r, g, b, opacity]: [u8; 4]) {
        self.blend(at, [r, g, b], opacity.into());
    }

    /// Draws a thin line around a box.
    fn frame(&mut self, [left, top, width, height]: LegendBox) {
        let thin = self.thin();
        let (right, bottom) = ((left + width).saturating_sub(thin), (top + height).saturating_sub(thin));
        for at in [
            [left, top, width, thin],
            [left, bottom, width, thin],
            [left, top, thin, height],
            [right, top, thin, height],
        ] {
            self.fill(at, INK_BYTES);
        }
    }

    /// Mixes a colour into a box; 255 parts of it hide the old colour.
    fn blend(&mut self, [left, top, width, height]: LegendBox, colour: [u8; 3], parts: u32) {
        let [from_x, from_y, to_x, to_y] = self.within;
        let columns = left.max(from_x)..left.saturating_add(width).min(to_x);
        for y in top.max(from_y)..top.saturating_add(height).min(to_y) {
            for x in columns.clone() {
                let pixel = &mut self.picture.colours[y as usize * self.size[0] as usize + x as usize];
                let opacity = u32::from(pixel[3]);
                let below = opacity * (255 - parts) / 255;
                let sum = (parts + below).max(1);
                for (channel, over) in pixel.iter_mut().zip(colour) {
                    *channel =
                        ((u32::from(over) * parts + u32::from(*channel) * below + sum / 2) / sum) as u8;
                }
                pixel[3] = sum.min(255) as u8;
            }
        }
    }

    /// Draws a line of text from its upper left corner. Text that is too long is cut.
    fn text(&mut self, text: &str, [left, top]: [u32; 2]) {
        let end = text.char_indices().nth(LONGEST).map_or(text.len(), |(end, _)| end);
        // Only whole letters are drawn.
        let width = self.font.character_size.width * self.scale;
        let room = self.within[2].saturating_sub(left) / width.max(1);
        let end = text.char_indices().nth(room as usize).map_or(text.len(), |(cut, _)| cut).min(end);
        // A line break would lead out of the line.
        let shown = text[..end].lines().next().unwrap_or("");
        let style = MonoTextStyle::new(self.font, INK);
        let scale = self.scale;
        let mut pen = Pen { canvas: self, at: [left, top], scale };
        let Ok(_) = Text::with_baseline(shown, Point::zero(), style, Baseline::Top).draw(&mut pen);
    }
}

/// A drawing target for letters on a canvas, with each of their pixels as a square.
struct Pen<'c, 'p> {
    canvas: &'c mut Canvas<'p>,
    at: [u32; 2],
    scale: u32,
}

impl Dimensions for Pen<'_, '_> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new(self.canvas.size[0], self.canvas.size[1]))
    }
}

impl DrawTarget for Pen<'_, '_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics::Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for embedded_graphics::Pixel(Point { x, y }, colour) in pixels {
            let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { continue };
            let corner = [self.at[0] + x * self.scale, self.at[1] + y * self.scale];
            let square = [corner[0], corner[1], self.scale, self.scale];
            self.canvas.fill(square, [colour.r(), colour.g(), colour.b(), 255]);
        }
        Ok(())
    }
}

/// Round numbers in a range: the multiples of 1, 2 or 5 times a power of ten.
struct Ticks {
    /// The least and the greatest number, as multiples of 10^exponent, and the interval.
    first: i64,
    last: i64,
    step: i64,
    exponent: i32,
}

impl Ticks {
    /// At most `most` numbers in a range, at least 2. There are none if the range is so narrow, or so small,
    /// that its numbers cannot be distinguished.
    fn new([low, high]: [f64; 2], most: u32) -> Ticks {
        let none = Ticks { first: 0, last: -1, step: 1, exponent: 0 };
        let extent = high - low;
        let reach = low.abs().max(high.abs());
        // Beyond ±290 a power of ten is not a normal double.
        if !(extent > reach * 1e-12 && extent > 1e-290 && reach < 1e290) {
            return none;
        }
        let lowest = libm::floor(libm::log10(extent / f64::from(most))) as i32;
        let candidates = (lowest..lowest + 3).flat_map(|exponent| [1, 2, 5].each(|step| (step, exponent)));
        for (step, exponent) in candidates {
            let unit = Ticks::value_of(step, exponent);
            // A number that is a multiple up to rounding errors counts as one.
            let first = libm::ceil(low / unit - 1e-9) as i64;
            let last = libm::floor(high / unit + 1e-9) as i64;
            if last - first < i64::from(most) {
                return Ticks { first: first * step, last: last * step, step, exponent };
            }
        }
        none
    }

    fn count(&self) -> u64 {
        ((self.last - self.first) / self.step + 1).max(0) as u64
    }

    /// A multiple of a power of ten, rounded once as far as the power is exact.
    fn value_of(multiple: i64, exponent: i32) -> f64 {
        let power = libm::pow(10.0, f64::from(exponent.abs()));
        if exponent < 0 { multiple as f64 / power } else { multiple as f64 * power }
    }

    /// The numbers and their labels.
    fn labels(&self) -> impl Iterator<Item = (f64, Label)> + '_ {
        (0..self.count() as i64).map(|i| {
            let multiple = self.first + i * self.step;
            (Ticks::value_of(multiple, self.exponent), Label::new(multiple, self.exponent))
        })
    }
}

/// A number as text.
struct Label {
    bytes: [u8; 32],
    count: usize,
}

impl Label {
    fn new(mut multiple: i64, mut exponent: i32) -> Label {
        let mut label = Label { bytes: [0; 32], count: 0 };
        // The buffer is large enough for all possible labels.
        let _ = match exponent {
            _ if multiple == 0 => label.write_str("0"),
            -4..0 => {
                let digits = exponent.unsigned_abs() as usize;
                let unit = 10_u64.pow(digits as u32);
                let (sign, size) = (if multiple < 0 { "-" } else { "" }, multiple.unsigned_abs());
                write!(label, "{sign}{}.{:0digits$}", size / unit, size % unit)
            }
            0..5 => write!(label, "{}", multiple.saturating_mul(10_i64.pow(exponent as u32))),
            _ => {
                while multiple % 10 == 0 {
                    (multiple, exponent) = (multiple / 10, exponent + 1);
                }
                write!(label, "{multiple}e{exponent}")
            }
        };
        label
    }

    fn as_str(&self) -> &str {
        core::str::from_utf8(&self.bytes[..self.count]).unwrap_or("")
    }
}

impl Write for Label {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let end = self.count + text.len();
        let room = self.bytes.get_mut(self.count..end).ok_or(core::fmt::Error)?;
        room.copy_from_slice(text.as_bytes());
        self.count = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::{String, ToString};
    use alloc::vec::Vec;

    fn labels(range: [f64; 2], most: u32) -> Vec<String> {
        Ticks::new(range, most).labels().map(|(_, label)| label.as_str().to_string()).collect()
    }

    #[test]
    fn scale_bars_are_as_long_as_they_say() {
        for (most, round) in
            [(1.0, (1, 0)), (4.99, (2, 0)), (0.3, (2, -1)), (75.0, (5, 1)), (0.1, (1, -1)), (9.9e12, (5, 12))]
        {
            assert_eq!(round_below(most), round, "{most}");
        }
        let blank = alloc::vec![[255; 4]; 400 * 300];
        let mut picture = Picture::of_colours([400, 300], blank).unwrap();
        let covered = draw_scale_bar(&mut picture, 0.25, "30 x 20").unwrap().unwrap();
        assert!(covered[0] == 0 && covered[1] + covered[3] == 300 && covered[2] <= 200);
        // A quarter of the width is 25 units; the bar is 20 units long, or 80 pixels.
        let is_ink = |pixel: &[u8; 4]| *pixel == INK_BYTES;
        let row = |y: usize| picture.colours()[400 * y..400 * y + 400].iter();
        let run = |y: usize| {
            row(y).fold((0, 0), |(most, now), p| {
                let now = if is_ink(p) { now + 1 } else { 0 };
                (most.max(now), now)
            })
        };
        assert_eq!((0..300).map(|y| run(y).0).max(), Some(80));
        assert!(
            draw_scale_bar(&mut picture, 0.0, "").is_err()
                && draw_scale_bar(&mut picture, f64::NAN, "").is_err()
        );
        let mut tiny = Picture::of_colours([8, 8], alloc::vec![[255; 4]; 64]).unwrap();
        assert_eq!(draw_scale_bar(&mut tiny, 1.0, "").unwrap(), None);
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            labels([0.0, 1.0], 6),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"].map(|t| if t == "0.0" { "0" } else { t })
        );
        assert_eq!(labels([0.0, 1.0], 3), ["0", "0.5", "1.0"]);
        assert_eq!(labels([-3.0, 12.0], 4), ["0", "5", "10"]);
        assert_eq!(labels([0.0, 2.5e7], 4), ["0", "1e7", "2e7"]);
        assert_eq!(labels([-1e-7, 1e-7], 3), ["-1e-7", "0", "1e-7"]);
        assert_eq!(labels([20.0, 1180.0], 7), ["200", "400", "600", "800", "1000"]);
        assert!(labels([1.0, 1.0], 5).is_empty() && labels([0.0, 1e300], 5).is_empty());
    }

    #[test]
    fn ticks_lie_in_the_range_and_are_as_many_as_fit() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..2000 {
            let size = libm::pow(10.0, 40.0 * random() - 20.0);
            let low = (random() - 0.5) * size;
            let high = low + random() * size;
            for most in [2, 3, 5, 11] {
                let ticks = Ticks::new([low, high], most);
                assert!(ticks.count() <= u64::from(most), "{low} {high} {most}");
                for (value, label) in ticks.labels() {
                    let slack = 1e-6 * (high - low);
                    assert!(value >= low - slack && value <= high + slack);
                    let read: f64 = label.as_str().parse().unwrap();
                    assert!((read - value).abs() <= 1e-12 * value.abs(), "{read} {value}");
                }
                // One more number would not fit.
                assert!(
                    most < 5 || ticks.count() as u32 * 5 + 5 >= 2 * most,
                    "{low} {high} {most} {}",
                    ticks.count()
                );
            }
        }
    }
}

//! Pictures on the terminal.

mod blocks;
mod image;
mod sixel;
mod terminal;

use crate::failure::{Failure, Of};
use crate::signals;
use crate::sink;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use blocks::Palette;
use clap::ValueEnum;
use image::{Image, fitted};
use leafless::render::Picture;
use std::borrow::Cow;
use std::io::IsTerminal;
use terminal::{Terminal, terminal};

/// A protocol that puts pictures on a terminal.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum Protocol {
    /// The best of the others that the terminal says it understands
    Auto,
    /// The protocol of kitty; also of Ghostty, Konsole and WezTerm
    Kitty,
    /// The protocol of iTerm2
    Iterm,
    /// Sixels, up to 256 colours: foot, mlterm, Windows Terminal, xterm and others
    Sixel,
    /// Half-block characters, two pixels each: every terminal with colours
    Blocks,
}

/// The place where pictures are shown: a protocol, and the size that fits.
pub struct Screen {
    protocol: Protocol,
    /// Pixels that fit, if there are limits.
    area: Option<[usize; 2]>,
    /// Number of colours of sixels.
    colours: usize,
}

/// Returns the columns of the terminal that standard output goes to, if they are known.
pub fn columns() -> Option<usize> {
    terminal(false).cells.map(|[columns, _]| columns)
}

/// Cells of a terminal of unknown size.
const CELLS: [usize; 2] = [80, 24];
/// Width and height of a cell in pixels, if they are unknown.
const CELL: [usize; 2] = [8, 16];
/// Rows that stay free: for the command, the report on the picture, and the next prompt.
const FREE_ROWS: usize = 3;
/// The largest picture that is made for a terminal unless --size asks for more.
const LARGEST: [usize; 2] = [1600, 1200];

impl Screen {
    /// Returns the terminal of standard output. If a protocol is named, standard output may be something
    /// else: a pipe, or a file that is shown later.
    pub fn of(wanted: Protocol) -> Result<Screen, Failure> {
        let is_terminal = std::io::stdout().is_terminal();
        if wanted == Protocol::Auto {
            let problem = if !is_terminal {
                "is no terminal"
            } else if terminal::is_dumb() {
                "is a terminal without colours (TERM=dumb)"
            } else {
                ""
            };
            if !problem.is_empty() {
                let remedy = "name a protocol, as in --show=blocks or --show=sixel, or a file with -o";
                return Err(Failure::of("standard output", format_args!("{problem}; {remedy}")));
            }
        }
        let is_asked = wanted != Protocol::Blocks;
        let known = if is_terminal { terminal(is_asked) } else { Terminal::default() };
        Ok(Screen::new(wanted, is_terminal, &known))
    }

    fn new(wanted: Protocol, is_terminal: bool, known: &Terminal) -> Screen {
        let answer = known.answer.clone();
        let protocol = match (wanted, &answer) {
            (Protocol::Auto, Some(answer)) if answer.kitty => Protocol::Kitty,
            (Protocol::Auto, None) if terminal::is_kitty_by_name() => Protocol::Kitty,
            (Protocol::Auto, _) if terminal::is_iterm_by_name() => Protocol::Iterm,
            (Protocol::Auto, Some(answer)) if answer.sixel => Protocol::Sixel,
            (Protocol::Auto, _) => Protocol::Blocks,
            (named, _) => named,
        };
        let [columns, rows] = known.cells.or_else(terminal::cells_by_environment).unwrap_or(CELLS);
        let (rows, used) = (rows.max(1), rows.saturating_sub(FREE_ROWS).max(1));
        let answer = answer.unwrap_or_default();
        let area = match protocol {
            Protocol::Blocks => Some([columns, 2 * used]),
            _ if !is_terminal => None,
            _ => {
                let [width, height] = known.pixels.unwrap_or([columns * CELL[0], rows * CELL[1]]);
                let limits = answer.largest_sixels.filter(|_| protocol == Protocol::Sixel);
                let [most_wide, most_high] = limits.unwrap_or([usize::MAX; 2]);
                Some([width.min(most_wide), (height * used / rows).min(most_high)])
            }
        };
        Screen { protocol, area, colours: answer.colours.unwrap_or(sixel::MOST) }
    }

    /// Returns the best size of a picture that is made only to be shown here, if there is one.
    pub fn size(&self) -> Option<[u32; 2]> {
        let area = self.area?;
        Some([0, 1].map(|axis| area[axis].clamp(1, LARGEST[axis]) as u32))
    }

    /// Returns the way of showing, in words.
    pub fn way(&self) -> &'static str {
        match self.protocol {
            Protocol::Kitty => "by kitty's protocol",
            Protocol::Iterm => "by iTerm2's protocol",
            Protocol::Sixel => "as sixels",
            Protocol::Auto | Protocol::Blocks => "in half blocks",
        }
    }

    /// Shows the picture, whose PNG file has these bytes, smaller if it does not fit.
    pub fn show(&self, picture: &Picture, file: &[u8]) -> Result<(), Failure> {
        let image = Image::from(picture);
        let size = [image.width, image.height];
        let fitting = self.area.map_or(size, |area| fitted(size, area));
        let image = image.shrunk(fitting);
        let file = || if fitting == size { Ok(Cow::Borrowed(file)) } else { png(&image).map(Cow::Owned) };
        let text = match self.protocol {
            Protocol::Kitty => kitty(&file()?),
            Protocol::Iterm => iterm(&file()?),
            Protocol::Sixel => sixel::text(&image, self.colours) + "\n",
            Protocol::Auto | Protocol::Blocks => {
                let palette = if terminal::has_true_colours() { Palette::True } else { Palette::Indexed };
                blocks::text(&image, palette)
            }
        };
        // A half sequence would make the terminal wait for the rest: this ends every sequence, and resets
        // colours.
        signals::write_whole(text.as_bytes(), b"\x1b\\\x1b[0m\n", sink::print)
    }
}

/// Returns a PNG file in kitty's protocol, in pieces of at most 4096 characters; the terminal does not answer
/// (q=2).
fn kitty(file: &[u8]) -> String {
    let data = BASE64_STANDARD.encode(file);
    let mut text = String::with_capacity(data.len() + data.len() / 100 + 64);
    let mut rest = data.as_str();
    let mut keys = "a=T,f=100,q=2,";
    while !rest.is_empty() {
        let (piece, further) = rest.split_at(rest.len().min(4096));
        let more = u8::from(!further.is_empty());
        text.push_str(&format!("\x1b_G{keys}m={more};{piece}\x1b\\"));
        (rest, keys) = (further, "");
    }
    text + "\n"
}

/// Returns a PNG file in iTerm2's protocol.
fn iterm(file: &[u8]) -> String {
    let data = BASE64_STANDARD.encode(file);
    format!("\x1b]1337;File=inline=1;size={}:{data}\x07\n", file.len())
}

/// Returns the image as a PNG file.
fn png(image: &Image) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width as u32, image.height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let write = || {
        let mut writer = encoder.write_header()?;
        writer.write_image_data(image.pixels.as_flattened())?;
        writer.finish()
    };
    write().map_err(|error: png::EncodingError| error.to_string()).of("the picture")?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::show::terminal::Answer;

    #[test]
    fn what_fits_a_terminal() {
        let known = Terminal { cells: Some([100, 40]), pixels: Some([1000, 800]), answer: None };
        let area = |protocol, is_terminal, known| Screen::new(protocol, is_terminal, known).area;
        assert_eq!(area(Protocol::Blocks, true, &known), Some([100, 74]));
        assert_eq!(area(Protocol::Kitty, true, &known), Some([1000, 740]));
        let narrow = Answer { sixel: true, largest_sixels: Some([640, 4000]), ..Answer::default() };
        let narrow = Terminal { answer: Some(narrow), ..known.clone() };
        assert_eq!(area(Protocol::Sixel, true, &narrow), Some([640, 740]));
        assert_eq!(area(Protocol::Kitty, true, &narrow), Some([1000, 740]));
        let tiny = Terminal { cells: Some([1, 1]), ..Terminal::default() };
        assert_eq!(area(Protocol::Blocks, true, &tiny), Some([1, 2]));
        assert_eq!(area(Protocol::Sixel, true, &tiny), Some([8, 16]));
        assert_eq!(area(Protocol::Sixel, false, &Terminal::default()), None);
        let huge = Terminal { pixels: Some([5000, 4000]), ..known };
        assert_eq!(Screen::new(Protocol::Iterm, true, &huge).size(), Some(LARGEST.map(|side| side as u32)));
    }

    #[test]
    fn what_a_terminal_says_decides() {
        let of = |answer| {
            let known = Terminal { answer: Some(answer), ..Terminal::default() };
            [Protocol::Auto, Protocol::Blocks].map(|wanted| Screen::new(wanted, true, &known).protocol)
        };
        let both = Answer { kitty: true, sixel: true, ..Answer::default() };
        assert_eq!(of(both.clone()), [Protocol::Kitty, Protocol::Blocks]);
    }
}

//! The terminal of standard output: its size, and the protocols for pictures that it understands.

use std::env;

/// The known properties of a terminal.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Terminal {
    /// Columns and rows.
    pub cells: Option<[usize; 2]>,
    /// Width and height in pixels.
    pub pixels: Option<[usize; 2]>,
    /// Its answer, if it was queried and answered.
    pub answer: Option<Answer>,
}

/// The answer of a terminal about itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// True if it shows pictures by kitty's protocol.
    pub kitty: bool,
    /// True if it shows sixels.
    pub sixel: bool,
    /// Number of colours of sixels.
    pub colours: Option<usize>,
    /// Greatest width and height of sixels.
    pub largest_sixels: Option<[usize; 2]>,
    /// Width and height of the terminal in pixels.
    pub pixels: Option<[usize; 2]>,
}

/// True if pictures pass through a program that understands only some protocols, while the environment
/// variables may describe the terminal outside it.
pub fn is_multiplexed() -> bool {
    let term = env::var("TERM").unwrap_or_default();
    env::var_os("TMUX").is_some() || ["screen", "tmux"].iter().any(|name| term.starts_with(name))
}

/// True if the terminal shows 24-bit colours, according to the environment.
pub fn has_true_colours() -> bool {
    let said = env::var("COLORTERM").unwrap_or_default();
    // Windows says nothing, and has had them since 2017.
    cfg!(windows) || ["truecolor", "24bit"].iter().any(|name| said.contains(name))
}

/// True if the environment names a terminal that understands kitty's protocol.
pub fn is_kitty_by_name() -> bool {
    !is_multiplexed()
        && (is_one_of("TERM", &["xterm-kitty", "xterm-ghostty"])
            || is_one_of("TERM_PROGRAM", &["WezTerm", "ghostty"]))
}

/// True if the environment names iTerm2, which has its own protocol. (`LC_TERMINAL` survives `ssh`.)
pub fn is_iterm_by_name() -> bool {
    !is_multiplexed() && (is_one_of("TERM_PROGRAM", &["iTerm.app"]) || is_one_of("LC_TERMINAL", &["iTerm2"]))
}

/// True if the terminal shows text only, according to the environment.
pub fn is_dumb() -> bool {
    is_one_of("TERM", &["dumb"])
}

fn is_one_of(variable: &str, names: &[&str]) -> bool {
    env::var(variable).is_ok_and(|value| names.contains(&value.as_str()))
}

/// Returns columns and rows from the environment: users may export them.
pub fn cells_by_environment() -> Option<[usize; 2]> {
    let number = |name| env::var(name).ok()?.parse::<u16>().ok().filter(|&number| number > 0);
    Some([number("COLUMNS")?, number("LINES")?].map(usize::from))
}

#[cfg(unix)]
pub use unix::terminal;

#[cfg(unix)]
mod unix {
    use super::{Answer, Terminal, is_one_of, parse};
    use crate::signals::Change;
    use rustix::fs::{Mode, OFlags, open};
    use rustix::process::getpgrp;
    use rustix::termios::{
        LocalModes, OptionalActions, SpecialCodeIndex, tcgetattr, tcgetpgrp, tcgetwinsize, tcsetattr, ttyname,
    };
    use std::env;
    use std::fs::File;
    use std::io::{Read, Write};
    use std::time::{Duration, Instant};

    /// Queries kitty's protocol, the size in pixels, the colours and the size of sixels, and at last the type
    /// of terminal, which every terminal answers. Any characters that an old terminal shows instead are
    /// erased.
    const QUESTION: &[u8] =
        b"\x1b7\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\\x1b[14t\x1b[?1;1;0S\x1b[?2;1;0S\x1b[c\x1b8\x1b[K";

    /// The time to wait for an answer; a distant terminal needs longer.
    const PATIENCE: Duration = Duration::from_millis(200);
    const PATIENCE_FAR: Duration = Duration::from_millis(1500);

    /// Returns the terminal of standard output, with its answer if `is_asked`.
    pub fn terminal(is_asked: bool) -> Terminal {
        let out = std::io::stdout();
        let size = tcgetwinsize(&out).ok();
        let pair = |a: u16, b: u16| (a > 0 && b > 0).then(|| [usize::from(a), usize::from(b)]);
        let answer = if is_asked { ask() } else { None };
        let said = answer.as_ref().and_then(|answer| answer.pixels);
        Terminal {
            cells: size.and_then(|size| pair(size.ws_col, size.ws_row)),
            pixels: size.and_then(|size| pair(size.ws_xpixel, size.ws_ypixel)).or(said),
            answer,
        }
    }

    /// Returns the terminal's answer; `None` if it cannot be queried, or does not answer in time.
    fn ask() -> Option<Answer> {
        // These print queries that they do not understand as text.
        if is_one_of("TERM", &["linux"]) || is_one_of("TERM_PROGRAM", &["Apple_Terminal"]) {
            return None;
        }
        // Standard input may be a file: the query goes to the terminal of standard output.
        let name = ttyname(std::io::stdout(), Vec::new()).ok()?;
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        let terminal = File::from(open(&name, flags, Mode::empty()).ok()?);
        // A process in the background that changes the mode is stopped. (If the terminal does not control
        // this process, there is no group, and no process is stopped.)
        if tcgetpgrp(&terminal).is_ok_and(|group| group != getpgrp()) {
            return None;
        }
        let mode = tcgetattr(&terminal).ok()?;
        let mut other = mode.clone();
        // Answers come without a line end, and must not be visible.
        other.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO);
        // Reading ends after a tenth of a second without input. (Not all systems can wait for terminals by
        // `poll`.)
        other.special_codes[SpecialCodeIndex::VMIN] = 0;
        other.special_codes[SpecialCodeIndex::VTIME] = 1;
        let mut out = terminal.try_clone().ok()?;
        // The mode is also restored when a signal ends the program meanwhile. If that fails, the terminal is
        // gone.
        let again = terminal.try_clone().ok()?;
        let undone = move || {
            let _ = tcsetattr(&again, OptionalActions::Now, &mode);
        };
        let change = Change::make(|| tcsetattr(&terminal, OptionalActions::Now, &other).ok(), undone)?;
        let answer = exchange(&mut out);
        drop(change);
        answer
    }

    fn exchange(terminal: &mut File) -> Option<Answer> {
        terminal.write_all(QUESTION).ok()?;
        let is_far = ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| env::var_os(name).is_some());
        let end = Instant::now() + if is_far { PATIENCE_FAR } else { PATIENCE };
        let (mut bytes, mut buffer) = (Vec::new(), [0; 256]);
        while Instant::now() < end && bytes.len() < 1 << 16 {
            match terminal.read(&mut buffer) {
                Ok(count) => bytes.extend_from_slice(&buffer[..count]),
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(_) => return None,
            }
            let answer = parse(&bytes);
            if answer.is_some() {
                return answer;
            }
        }
        None
    }
}

/// Returns the properties that are known without a query.
#[cfg(not(unix))]
pub fn terminal(_is_asked: bool) -> Terminal {
    #[cfg(windows)]
    {
        // Old consoles must be told to interpret control sequences.
        let _ = anstyle_query::windows::enable_ansi_colors();
        let cells = console::Term::stdout().size_checked();
        Terminal {
            cells: cells.map(|(rows, columns)| [columns, rows].map(usize::from)),
            ..Terminal::default()
        }
    }
    #[cfg(not(windows))]
    Terminal::default()
}

/// Parses the terminal's answers, once the last query, the type of terminal, is answered.
#[cfg(any(unix, test))]
fn parse(bytes: &[u8]) -> Option<Answer> {
    let mut answer = Answer::default();
    let mut is_whole = false;
    for sequence in bytes.split(|&byte| byte == 0x1b).skip(1) {
        match sequence {
            [b'_', b'G', text @ ..] => {
                let text = String::from_utf8_lossy(text);
                answer.kitty |=
                    text.split_once(';').is_some_and(|(keys, said)| keys.contains("i=31") && said == "OK");
            }
            [b'[', text @ ..] => {
                let Some(end) = text.iter().position(|byte| (0x40..0x7f).contains(byte)) else { continue };
                let (text, last) = (String::from_utf8_lossy(&text[..end]), text[end]);
                let private = text.strip_prefix('?');
                let number = |text: &str| text.parse::<u16>().map_or(0, usize::from);
                let numbers: Vec<usize> = private.unwrap_or(&text).split(';').map(number).collect();
                match (private.is_some(), last, &numbers[..]) {
                    // The first number is a class of terminals.
                    (true, b'c', [_, parts @ ..]) => {
                        answer.sixel = parts.contains(&4);
                        is_whole = true;
                    }
                    (true, b'S', &[1, 0, colours]) if colours > 0 => answer.colours = Some(colours),
                    (true, b'S', &[2, 0, width, height]) if width.min(height) > 0 => {
                        answer.largest_sixels = Some([width, height]);
                    }
                    (false, b't', &[4, height, width]) if width.min(height) > 0 => {
                        answer.pixels = Some([width, height]);
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
    is_whole.then_some(answer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_of_terminals() {
        let none = Answer::default();
        let sixel = Answer { sixel: true, ..none.clone() };
        for (bytes, expected) in [
            // kitty, with keys that were typed meanwhile
            (
                &b"ls\x1b_Gi=31;OK\x1b\\\x1b[4;600;800t\x1b[?62;c"[..],
                Some(Answer { kitty: true, pixels: Some([800, 600]), ..none.clone() }),
            ),
            // xterm as a VT340
            (
                b"\x1b[4;316;484t\x1b[?1;0;16S\x1b[?2;0;1000;1000S\x1b[?63;1;2;4;6c",
                Some(Answer {
                    colours: Some(16),
                    largest_sixels: Some([1000, 1000]),
                    pixels: Some([484, 316]),
                    ..sixel.clone()
                }),
            ),
            // 42 is no 4, and the class 4 tells of a VT132
            (b"\x1b[?62;22;42c", Some(none.clone())),
            (b"\x1b[?4;6c", Some(none.clone())),
            (b"\x1b[?12;4c", Some(sixel)),
            // A refusal of kitty's protocol, and sizes that are errors
            (b"\x1b_Gi=31;EINVAL:no\x1b\\\x1b[?1;3;0S\x1b[4;0;0t\x1b[?62c", Some(none)),
            (b"\x1b_Gi=31;OK\x1b\\\x1b[?62;4", None),
            (b"", None),
            (b"no terminal", None),
        ] {
            assert_eq!(parse(bytes), expected, "{}", String::from_utf8_lossy(bytes));
        }
    }
}

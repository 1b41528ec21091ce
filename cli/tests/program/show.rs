//! Pictures on terminals: the output of `render --show`, decoded.

use crate::place::{Place, Run, block, stl};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::collections::HashMap;
use std::io::Cursor;
use std::process::Command;

/// An image with red, green and blue for each pixel that is not empty.
#[derive(PartialEq)]
struct Image {
    width: usize,
    pixels: Vec<Option<[u8; 3]>>,
}

impl Image {
    fn size(&self) -> [usize; 2] {
        [self.width, self.pixels.len() / self.width]
    }

    /// Returns the greatest and the mean difference of the two images; `None` if they do not show the same
    /// pixels.
    fn difference(&self, other: &Image) -> Option<(u8, f64)> {
        assert_eq!(self.size(), other.size());
        let (mut greatest, mut sum) = (0, 0.0);
        for (a, b) in self.pixels.iter().zip(&other.pixels) {
            match (a, b) {
                (None, None) => {}
                (Some(a), Some(b)) => {
                    for (a, b) in a.iter().zip(b) {
                        greatest = greatest.max(a.abs_diff(*b));
                        sum += f64::from(a.abs_diff(*b)) / 3.0;
                    }
                }
                _ => return None,
            }
        }
        Some((greatest, sum / self.pixels.len() as f64))
    }
}

fn rgba(png: &[u8]) -> (usize, Vec<[u8; 4]>) {
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.bit_depth, png::BitDepth::Eight);
    let pixels = bytes.chunks_exact(info.color_type.samples());
    let pixels = pixels.map(|pixel| [pixel[0], pixel[1], pixel[2], *pixel.get(3).unwrap_or(&255)]);
    (info.width as usize, pixels.collect())
}

fn opaque([r, g, b, a]: [u8; 4]) -> Option<[u8; 3]> {
    (a >= 128).then_some([r, g, b])
}

/// Decodes a picture that a terminal shows in its own size.
fn image(png: &[u8]) -> Image {
    let (width, pixels) = rgba(png);
    Image { width, pixels: pixels.into_iter().map(opaque).collect() }
}

/// Returns the picture at 3/8 of its size: each pixel is repeated three times in each direction, and blocks
/// of 8 × 8 are averaged.
fn three_eighths(png: &[u8]) -> Vec<[f64; 4]> {
    let (width, pixels) = rgba(png);
    let height = pixels.len() / width;
    assert!(width % 8 == 0 && height % 8 == 0);
    let linear = |byte: u8| match f64::from(byte) / 255.0 {
        x if x <= 0.04045 => x / 12.92,
        x => ((x + 0.055) / 1.055).powf(2.4),
    };
    let encoded = |x: f64| match x {
        x if x <= 0.0031308 => 255.0 * 12.92 * x,
        x => 255.0 * (1.055 * x.powf(1.0 / 2.4) - 0.055),
    };
    let mut found = Vec::new();
    for y in 0..height * 3 / 8 {
        for x in 0..width * 3 / 8 {
            let mut sum = [0.0; 4];
            for i in 0..64 {
                let [r, g, b, a] = pixels[(8 * y + i / 8) / 3 * width + (8 * x + i % 8) / 3];
                let a = f64::from(a) / 255.0;
                let part = [linear(r) * a, linear(g) * a, linear(b) * a, a];
                sum = [0, 1, 2, 3].map(|k| sum[k] + part[k] / 64.0);
            }
            let [r, g, b, a] = sum;
            found.push([encoded(r / a), encoded(g / a), encoded(b / a), 255.0 * a]);
        }
    }
    found
}

/// Decodes half blocks. Numbers of 256 colours are returned as grey values.
fn blocks(text: &str) -> Image {
    let (mut width, mut pixels) = (0, Vec::new());
    for line in text.lines() {
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        let mut colours = [None; 2];
        let mut rest = line.chars();
        while let Some(character) = rest.next() {
            match character {
                '▀' => (upper.push(colours[0]), lower.push(colours[1])),
                '▄' => (upper.push(colours[1]), lower.push(colours[0])),
                ' ' => (upper.push(colours[1]), lower.push(colours[1])),
                '\x1b' => {
                    assert_eq!(rest.next(), Some('['));
                    let text: String = rest.by_ref().take_while(|&c| c != 'm').collect();
                    let numbers: Vec<u8> = text.split(';').map(|number| number.parse().unwrap()).collect();
                    match numbers[..] {
                        [0] => colours = [None; 2],
                        [39] => colours[0] = None,
                        [49] => colours[1] = None,
                        [layer @ (38 | 48), 2, r, g, b] => {
                            colours[usize::from(layer / 10 - 3)] = Some([r, g, b])
                        }
                        [layer @ (38 | 48), 5, n] => colours[usize::from(layer / 10 - 3)] = Some([n; 3]),
                        _ => panic!("{text}"),
                    }
                    continue;
                }
                other => panic!("{other:?} in {line:?}"),
            };
        }
        assert_eq!(colours, [None; 2], "a line leaves its colours behind");
        width = upper.len();
        pixels.append(&mut upper);
        pixels.append(&mut lower);
    }
    Image { width, pixels }
}

/// Decodes sixels. Returns the number of their colours, too.
fn sixels(text: &str) -> (Image, usize) {
    let body = text.strip_prefix("\x1bP7;1q\"1;1;").and_then(|body| body.strip_suffix("\x1b\\\n")).unwrap();
    let mut rest = body.as_bytes();
    fn numbers(rest: &mut &[u8]) -> Vec<usize> {
        let end = rest.iter().position(|byte| !byte.is_ascii_digit() && *byte != b';').unwrap_or(rest.len());
        let (text, further) = rest.split_at(end);
        *rest = further;
        text.split(|&byte| byte == b';').map(|n| std::str::from_utf8(n).unwrap().parse().unwrap()).collect()
    }
    let size = numbers(&mut rest);
    let (width, height) = (size[0], size[1]);
    let mut pixels = vec![None; width * height];
    let (mut palette, mut colour) = (HashMap::new(), None);
    let (mut x, mut y, mut repeat) = (0, 0, 1);
    while let Some((&byte, further)) = rest.split_first() {
        rest = further;
        match byte {
            b'#' => match numbers(&mut rest)[..] {
                [n] => colour = Some(palette[&n]),
                [n, 2, r, g, b] => {
                    palette.insert(n, [r, g, b].map(|part| ((part * 255) as f64 / 100.0).round() as u8));
                }
                _ => panic!(),
            },
            b'!' => repeat = numbers(&mut rest)[0],
            b'$' => x = 0,
            b'-' => (x, y) = (0, y + 6),
            b'?'..=b'~' => {
                for _ in 0..std::mem::replace(&mut repeat, 1) {
                    for row in (0..6).filter(|row| (byte - b'?') >> row & 1 == 1) {
                        assert!(x < width && y + row < height);
                        pixels[(y + row) * width + x] = colour;
                    }
                    x += 1;
                }
            }
            _ => panic!("{byte}"),
        }
    }
    (Image { width, pixels }, palette.len())
}

/// Returns the file that was sent by kitty's protocol.
fn kitty(text: &str) -> Vec<u8> {
    let pieces: Vec<&str> = text.strip_suffix('\n').unwrap().split_inclusive("\x1b\\").collect();
    let mut data = String::new();
    for (i, piece) in pieces.iter().enumerate() {
        let piece = piece.strip_prefix("\x1b_G").and_then(|piece| piece.strip_suffix("\x1b\\")).unwrap();
        let (keys, piece) = piece.split_once(';').unwrap();
        let is_last = i + 1 == pieces.len();
        let first = if i == 0 { "a=T,f=100,q=2," } else { "" };
        assert_eq!(keys, format!("{first}m={}", u8::from(!is_last)));
        assert!(piece.len() <= 4096 && (is_last || piece.len() % 4 == 0));
        data += piece;
    }
    BASE64_STANDARD.decode(data).unwrap()
}

fn part() -> Place {
    let place = Place::new();
    place.write("part.stl", stl(&block([1.0; 3], [7.0; 3])));
    place.run("voxelize part.stl -o part.lfl --depth 5 --bounds 0,0,0,8").good();
    place.run("attribute part.lfl --name heat --expr 20+3*x+y*y").good();
    place.write("ball.csg", b"difference() { sphere(r=10, $fn=90); cube(size=[4,40,4], center=true); }");
    place
}

/// Returns the program with an environment that describes the terminal only by `environment`.
fn command(place: &Place, line: &str, environment: &[(&str, &str)]) -> Command {
    let mut command = place.command(line.split_whitespace());
    command.args(["--samples", "1"]);
    for name in
        ["COLORTERM", "COLUMNS", "KITTY_WINDOW_ID", "LC_TERMINAL", "LINES", "SSH_CONNECTION", "SSH_TTY"]
    {
        command.env_remove(name);
    }
    command.env_remove("TERM_PROGRAM").env_remove("TMUX").env("TERM", "xterm");
    command.envs(environment.iter().copied());
    command
}

/// Returns the output of a successful run to a pipe. Messages go to standard error.
fn shown(place: &Place, line: &str, environment: &[(&str, &str)]) -> String {
    let run = Run::new(line, command(place, line, environment).output().unwrap());
    assert!(run.code == Some(0) && run.errors.contains("shown"), "{run:?}");
    run.text().to_owned()
}

const TRUE: (&str, &str) = ("COLORTERM", "truecolor");

#[test]
fn half_blocks_have_the_colours_of_the_picture() {
    let place = part();
    for looks in ["", "--background none", "--background none --view volume", "--view slice"] {
        let line = format!("render ball.csg -o out.png --depth 5 --show=blocks {looks}");
        // At its own size, with an odd number of rows: the last line shows only one row.
        let text = shown(&place, &format!("{line} --size 70x41"), &[TRUE]);
        let mut found = blocks(&text);
        assert_eq!(found.size(), [70, 42]);
        assert!(found.pixels.drain(70 * 41..).all(|pixel| pixel.is_none()));
        assert!(found == image(&place.bytes("out.png")), "{looks}");
        // Smaller, because the terminal has 63 columns; 60 of them make the picture as high as 25 rows.
        let environment = [TRUE, ("COLUMNS", "63"), ("LINES", "28")];
        let found = blocks(&shown(&place, &format!("{line} --size 160x136"), &environment));
        assert_eq!(found.size(), [59, 50]);
        let found = blocks(&shown(
            &place,
            &format!("{line} --size 160x128"),
            &[TRUE, ("COLUMNS", "60"), ("LINES", "28")],
        ));
        assert_eq!(found.size(), [60, 48]);
        let expected = three_eighths(&place.bytes("out.png"));
        for (found, expected) in found.pixels.iter().zip(expected) {
            match found {
                None => assert!(expected[3] < 128.0),
                Some(found) => {
                    assert!(expected[3] > 127.0);
                    let off = (0..3).map(|k| (f64::from(found[k]) - expected[k]).abs()).fold(0.0, f64::max);
                    assert!(off < 0.51, "{found:?} {expected:?}");
                }
            }
        }
    }
}

#[test]
fn terminals_without_24_bits_get_one_of_240_colours() {
    let place = part();
    let line = "render ball.csg -o out.png --show=blocks --size 60x40 --colour #b04040";
    let text = shown(&place, line, &[]);
    let found = blocks(&text);
    let expected = image(&place.bytes("out.png"));
    for (found, expected) in found.pixels.iter().zip(&expected.pixels) {
        let (n, expected) = (i32::from(found.unwrap()[0]), expected.unwrap());
        let steps = [0, 95, 135, 175, 215, 255];
        let colour = match n {
            16..232 => [36, 6, 1].map(|unit| steps[((n - 16) / unit % 6) as usize]),
            232.. => [8 + 10 * (n - 232); 3],
            _ => panic!("{n}"),
        };
        // Half of the widest step.
        assert!((0..3).all(|k| (colour[k] - i32::from(expected[k])).abs() <= 48), "{colour:?} {expected:?}");
    }
    let colours: std::collections::HashSet<_> = found.pixels.iter().collect();
    assert!(colours.len() > 5);
}

#[test]
fn kitty_and_iterm_get_the_file() {
    let place = part();
    let file = |name: &str, line: &str| {
        let text = shown(&place, &format!("render ball.csg --show={name} {line}"), &[]);
        if name == "kitty" {
            return kitty(&text);
        }
        let (head, data) = text.split_once(':').unwrap();
        let data = BASE64_STANDARD.decode(data.strip_suffix("\x07\n").unwrap()).unwrap();
        assert_eq!(head, format!("\x1b]1337;File=inline=1;size={}", data.len()));
        data
    };
    for name in ["kitty", "iterm"] {
        let found = file(name, "-o out.png");
        assert!(found.len() > 8192, "one piece only");
        assert!(found == place.bytes("out.png"));
        // Without a file the output is the same: a pipe has no size.
        assert!(file(name, "") == found);
        assert_eq!(image(&file(name, "--size 30x20")).size(), [30, 20]);
    }
}

#[test]
fn sixels_show_nearly_the_same() {
    let place = part();
    // Colours of sixels are hundredths. More than 256 of them are approximated.
    for (what, is_exact) in [
        ("ball.csg --size 200x151", true),
        ("ball.csg --size 201x100 --background none --colour #b04040", true),
        ("ball.csg --size 300x200 --view slice --depth 5", true),
        ("ball.csg --size 90x67 --view volume --background none", true),
        ("ball.csg --size 1x1", true),
        ("part.lfl --size 400x303 --view slice --background none", true),
        ("part.lfl --size 400x300", false),
    ] {
        let text = shown(&place, &format!("render {what} -o out.png --show=sixel"), &[]);
        let (found, colours) = sixels(&text);
        let difference = found.difference(&image(&place.bytes("out.png")));
        let (greatest, mean) = difference.unwrap_or_else(|| panic!("{what}: other pixels"));
        if is_exact {
            assert!(colours < 256 && greatest <= 1, "{what}: {greatest}, {colours} colours");
        } else {
            assert!(colours == 256 && greatest <= 40 && mean < 1.0, "{what}: {greatest}, {mean}");
        }
    }
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let place = part();
    // Standard output of a test is a pipe.
    for line in ["render part.lfl --show", "render part.lfl -o out.png --show=auto"] {
        place.run(line).bad(1, &["standard output: is no terminal", "--show=sixel", "-o"]);
    }
    for (line, problem) in [
        ("render part.lfl", "--output"),
        ("render part.lfl -o - --show=blocks", "both -o - and --show"),
        ("render part.lfl --show=blocks --json", "--json"),
        ("render part.lfl --show=ascii", "[possible values: auto, kitty, iterm, sixel, blocks]"),
        ("render part.lfl --show blocks", "unexpected argument 'blocks'"),
    ] {
        place.run(line).bad(2, &[problem]);
    }
    assert!(!place.path("out.png").exists());
}

/// Terminals as the program meets them.
#[cfg(target_os = "linux")]
mod terminal {
    use super::*;
    use rustix::fs::{Mode, OFlags, open};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use rustix::termios::{
        LocalModes, OptionalActions, SpecialCodeIndex, Termios, Winsize, tcgetattr, tcsetattr, tcsetwinsize,
    };
    use std::fs::File;
    use std::io::{Read, Write};
    use std::process::Stdio;

    /// The output of a run on a terminal.
    struct Session {
        code: Option<i32>,
        text: String,
        errors: String,
    }

    /// Runs the program on a terminal of 100 × 30 cells of 8 × 16 pixels. The terminal sends `answer` when
    /// the program queries its kind.
    fn session(place: &Place, line: &str, environment: &[(&str, &str)], answer: &str) -> Session {
        let mut master = File::from(openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap());
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap();
        let slave = File::from(open(&name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap());
        let size = Winsize { ws_col: 100, ws_row: 30, ws_xpixel: 800, ws_ypixel: 480 };
        tcsetwinsize(&slave, size).unwrap();
        let before = tcgetattr(&slave).unwrap();
        assert!(before.local_modes.contains(LocalModes::ECHO | LocalModes::ICANON));
        let mut command = command(place, line, environment);
        if !answer.is_empty() {
            // The program waits longer for distant terminals. This terminal may be slow on a busy machine.
            command.env("SSH_TTY", "/dev/pts/0");
        }
        // (A progress bar would come in between.)
        command.stdout(slave.try_clone().unwrap()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(command);
        let waiter = std::thread::spawn(move || {
            let mut errors = String::new();
            child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
            let code = child.wait().unwrap().code();
            let after = tcgetattr(&slave).unwrap();
            assert_eq!(modes(&before), modes(&after), "the terminal's mode was changed");
            // Input without a line's end is readable only in this mode.
            let mut raw = after.clone();
            raw.local_modes.remove(LocalModes::ICANON);
            tcsetattr(&slave, OptionalActions::Now, &raw).unwrap();
            assert_eq!(rustix::io::ioctl_fionread(&slave).unwrap(), 0, "the next program reads an answer");
            (code, errors)
        });
        let (mut bytes, mut buffer) = (Vec::new(), [0; 4096]);
        let mut is_asked = false;
        // This fails when no process holds the terminal any more.
        while let Ok(count @ 1..) = master.read(&mut buffer) {
            bytes.extend_from_slice(&buffer[..count]);
            if !is_asked && bytes.windows(3).any(|window| window == b"\x1b[c") {
                is_asked = true;
                master.write_all(answer.as_bytes()).unwrap();
            }
        }
        let (code, errors) = waiter.join().unwrap();
        Session { code, text: String::from_utf8(bytes).unwrap().replace("\r\n", "\n"), errors }
    }

    fn modes(termios: &Termios) -> (u32, u32, u32, u32, u8, u8) {
        (
            termios.local_modes.bits(),
            termios.input_modes.bits(),
            termios.output_modes.bits(),
            termios.control_modes.bits(),
            termios.special_codes[SpecialCodeIndex::VMIN],
            termios.special_codes[SpecialCodeIndex::VTIME],
        )
    }

    /// Returns the picture without the query before it.
    fn picture(session: &Session) -> &str {
        assert!(session.code == Some(0) && session.errors.contains("shown"), "{}", session.errors);
        let wipe = "\x1b8\x1b[K";
        session.text.split_once(wipe).map_or(&session.text, |parts| parts.1)
    }

    #[test]
    fn a_silent_terminal_gets_half_blocks_that_fit() {
        let place = part();
        let run = session(&place, "render ball.csg --show", &[TRUE], "");
        assert_eq!(blocks(picture(&run)).size(), [100, 54]);
        let run = session(&place, "render ball.csg --show --size 400x100", &[TRUE], "");
        assert_eq!(blocks(picture(&run)).size(), [100, 26]);
        let run = session(&place, "render ball.csg --show --size 50x20 -o out.png", &[TRUE], "");
        assert!(blocks(picture(&run)) == image(&place.bytes("out.png")));
        // The file does not depend on the terminal.
        session(&place, "render ball.csg --show -o out.png", &[TRUE], "");
        assert_eq!(image(&place.bytes("out.png")).size(), [1024, 768]);
    }

    #[test]
    fn a_terminal_with_sixels_gets_them() {
        let place = part();
        let run = session(&place, "render ball.csg --show", &[], "\x1b[?62;4;22c");
        let (found, colours) = sixels(picture(&run));
        assert_eq!(found.size(), [800, 432]);
        assert!(colours > 20);
        assert!(!run.text.contains("62;4;22"), "the answer was shown");
        // A terminal with few colours, and little space for them.
        let answer = "\x1b[4;480;800t\x1b[?1;0;16S\x1b[?2;0;300;400S\x1b[?63;1;2;4;6c";
        let run = session(&place, "render ball.csg --show --size 600x200 -o out.png", &[], answer);
        let (found, colours) = sixels(picture(&run));
        assert_eq!((found.size(), colours), ([300, 100], 16));
        let run = session(&place, "render ball.csg --show --size 300x100 -o out.png", &[], answer);
        let (found, colours) = sixels(picture(&run));
        let (greatest, mean) = found.difference(&image(&place.bytes("out.png"))).unwrap();
        assert!(colours == 16 && greatest < 40 && mean < 3.0, "{greatest} {mean}");
        // A named protocol needs no query.
        let run = session(&place, "render ball.csg --show=blocks", &[TRUE], "\x1b[?62;4;22c");
        assert!(!run.text.contains("\x1b[c"));
        assert_eq!(blocks(picture(&run)).size(), [100, 54]);
    }

    #[test]
    fn a_terminal_with_the_protocol_of_kitty_gets_a_file() {
        let place = part();
        let run = session(&place, "render ball.csg --show", &[], "\x1b_Gi=31;OK\x1b\\\x1b[?62;4c");
        assert_eq!(image(&kitty(picture(&run))).size(), [800, 432]);
        // Larger pictures are made smaller.
        let run = session(
            &place,
            "render ball.csg --show --size 1600x160 -o out.png",
            &[],
            "\x1b_Gi=31;OK\x1b\\\x1b[?62c",
        );
        assert_eq!(image(&kitty(picture(&run))).size(), [800, 80]);
        // If the terminal does not answer, its name decides; inside tmux, the name does not count.
        for (environment, is_kitty) in [
            (&[("TERM", "xterm-kitty")][..], true),
            (&[("TERM_PROGRAM", "WezTerm")], true),
            (&[("TERM_PROGRAM", "WezTerm"), ("TMUX", "/tmp/tmux,1,0")], false),
        ] {
            let run = session(&place, "render ball.csg --show --size 40x20", environment, "");
            assert_eq!(picture(&run).starts_with("\x1b_Ga=T"), is_kitty, "{environment:?}");
        }
        let run = session(
            &place,
            "render ball.csg --show --size 40x20",
            &[("LC_TERMINAL", "iTerm2")],
            "\x1b[?62;4c",
        );
        assert!(picture(&run).starts_with("\x1b]1337;File="));
    }

    #[test]
    fn terminals_that_would_print_the_question_are_not_asked() {
        let place = part();
        let run = session(&place, "render ball.csg --show", &[("TERM", "linux")], "\x1b[?6c");
        assert!(!run.text.contains("\x1b[c") && run.code == Some(0));
        assert_eq!(blocks(picture(&run)).size(), [100, 54]);
        let run = session(&place, "render ball.csg --show", &[("TERM", "dumb")], "");
        assert_eq!(run.code, Some(1));
        assert!(run.errors.contains("TERM=dumb") && run.errors.contains("--show=blocks"), "{}", run.errors);
        assert_eq!(run.text, "");
    }
}

//! Signals and limits of the system. Wherever the program waits, the signal ends it, and nothing is left
//! behind.
#![cfg(unix)]

use crate::place::{Place, Run, solids};
use nix::sys::signal::{SaFlags, SigAction, SigHandler, SigSet, Signal, kill, sigaction};
use nix::unistd::Pid;
use std::fs::OpenOptions;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The time that the program may take to end on a busy machine.
const BOUND: Duration = Duration::from_secs(10);
/// The time after which the program normally waits. If it does not wait yet, it ends all the same.
const SOON: Duration = Duration::from_millis(300);
const SIGNALS: [Signal; 3] = [Signal::SIGHUP, Signal::SIGINT, Signal::SIGTERM];

/// A process that does not outlive the test.
struct Running(Child);

impl Running {
    fn signal(&self, signal: Signal) {
        kill(Pid::from_raw(self.0.id() as i32), signal).unwrap();
    }

    /// Waits for the end. It must come soon.
    #[track_caller]
    fn end(&mut self) -> ExitStatus {
        let start = Instant::now();
        loop {
            if let Some(status) = self.0.try_wait().unwrap() {
                return status;
            }
            assert!(start.elapsed() < BOUND, "the program does not end");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts the program with the default handling of signals, except for one ignored signal. (A shell may
/// ignore some signals for background processes, such as the tests.)
fn start(mut command: Command, ignored: Option<Signal>) -> Running {
    // SAFETY: between fork and exec only `sigaction` is called, which is allowed there.
    unsafe {
        command.pre_exec(move || {
            for signal in SIGNALS {
                let does = if ignored == Some(signal) { SigHandler::SigIgn } else { SigHandler::SigDfl };
                sigaction(signal, &SigAction::new(does, SaFlags::empty(), SigSet::empty()))?;
            }
            Ok(())
        });
    }
    Running(command.spawn().unwrap())
}

/// Returns the program with endless standard input, and with standard output that nobody reads.
fn waiting(place: &Place, line: &str) -> Command {
    let mut command = place.command(line.split_whitespace());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    command
}

fn make_pipe(place: &Place, name: &str) {
    assert!(Command::new("mkfifo").arg(place.path(name)).status().unwrap().success());
}

/// `cube.lfl` and others, a scene, and an old file.
fn place() -> Place {
    let place = solids();
    place.write("ball.csg", "difference() { sphere(r=10, $fn=90); sphere(r=7); }");
    place.run("csg ball.csg -o ball.lfl --depth 7 --rule sampled").good();
    for name in ["out.lfl", "out.stl"] {
        place.write(name, "old");
    }
    place
}

/// Runs a command line that waits for ever, and ends it by each signal. The program waits for standard input
/// or output, or for a pipe of this name. A reader may have the pipe open without reading.
fn ends_by_signals(line: &str, pipe: Option<&str>, is_read: bool) {
    let place = place();
    pipe.into_iter().for_each(|name| make_pipe(&place, name));
    let files = place.files();
    for signal in SIGNALS {
        let reader = pipe.filter(|_| is_read).map(|name| {
            // For reading alone, opening waits for a writer.
            OpenOptions::new().read(true).write(true).open(place.path(name)).unwrap()
        });
        let mut running = start(waiting(&place, line), None);
        std::thread::sleep(SOON);
        assert!(running.0.try_wait().unwrap().is_none(), "{line} does not wait");
        running.signal(signal);
        let status = running.end();
        assert_eq!(status.signal(), Some(signal as i32), "{line}: {signal}: {status}");
        assert_eq!(place.files(), files, "{line}: {signal}");
        for name in ["out.lfl", "out.stl"] {
            assert_eq!(place.bytes(name), b"old", "{line}: {signal}");
        }
        drop(reader);
    }
}

#[test]
fn signals_end_the_program_where_it_reads() {
    std::thread::scope(|scope| {
        for (line, pipe) in [
            ("info pipe.lfl", Some("pipe.lfl")),
            ("voxelize pipe.stl -o out.lfl --depth 5", Some("pipe.stl")),
            ("csg pipe.csg -o out.lfl --depth 5", Some("pipe.csg")),
            ("union cube.lfl pipe.lfl -o out.lfl", Some("pipe.lfl")),
            ("voxelize - -o out.lfl --depth 5", None),
            ("contains cube.lfl", None),
        ] {
            scope.spawn(move || ends_by_signals(line, pipe, false));
        }
    });
}

#[test]
fn signals_end_the_program_where_it_writes() {
    std::thread::scope(|scope| {
        for (line, pipe, is_read) in [
            ("voxelize cube.stl -o pipe.lfl --depth 5", Some("pipe.lfl"), false),
            ("dexelize cube.stl -o pipe.lfl --resolution 16", Some("pipe.lfl"), false),
            ("mesh cube.lfl -o pipe.stl", Some("pipe.stl"), false),
            ("render cube.lfl -o pipe.png", Some("pipe.png"), false),
            ("csg ball.csg -o pipe.lfl --depth 8", Some("pipe.lfl"), true),
            ("mesh ball.lfl -o pipe.stl", Some("pipe.stl"), true),
            ("csg ball.csg -o - --depth 8", None, false),
            ("mesh ball.lfl -o - --write stl", None, false),
        ] {
            scope.spawn(move || ends_by_signals(line, pipe, is_read));
        }
    });
}

#[test]
fn signals_end_the_program_at_work() {
    ends_by_signals("csg ball.csg -o out.lfl --depth 14", None, false);
}

/// At every moment of a save, either the old file or the new one exists, and no other.
#[test]
fn signals_while_the_program_saves() {
    let place = Place::new();
    place.run("demo .").good();
    for name in ["cutter.stl", "drilled.lfl"] {
        std::fs::remove_file(place.path(name)).unwrap();
    }
    let line = "voxelize flange.stl -o out.lfl --depth 8";
    let began = Instant::now();
    place.run(line).good();
    let (whole, new) = (began.elapsed(), place.bytes("out.lfl"));
    place.write("out.lfl", "old");
    let mut stopped = 0;
    for attempt in 0..30 {
        let signal = SIGNALS[attempt as usize % 3];
        let mut running = start(waiting(&place, line), None);
        // Mostly near the end, during the save.
        std::thread::sleep(whole * (attempt % 10 + 2) / 12);
        // The program may have ended by itself in the meantime.
        running.signal(signal);
        let status = running.end();
        assert_eq!(place.files(), ["flange.stl", "out.lfl"], "{status}");
        let found = place.bytes("out.lfl");
        assert!(found == b"old" || found == new, "{status}");
        assert!(status.success() || status.signal() == Some(signal as i32), "{status}");
        stopped += u32::from(status.signal().is_some());
        place.write("out.lfl", "old");
    }
    assert!(stopped > 0, "no attempt met the program at work");
}

/// `nohup` ignores the signal that a closing terminal sends.
#[test]
fn signals_that_are_ignored_stay_so() {
    for ignored in SIGNALS {
        let place = solids();
        let mut running = start(waiting(&place, "contains cube.lfl"), Some(ignored));
        for _ in 0..2 {
            std::thread::sleep(SOON);
            running.signal(ignored);
        }
        std::thread::sleep(SOON);
        assert!(running.0.try_wait().unwrap().is_none(), "{ignored}");
        let other = if ignored == Signal::SIGTERM { Signal::SIGINT } else { Signal::SIGTERM };
        running.signal(other);
        assert_eq!(running.end().signal(), Some(other as i32));
    }
}

/// The program reports the limit on the size of files. It is not ended by the limit's signal.
#[test]
fn files_beyond_the_limit_are_refused() {
    let place = place();
    let files = place.files();
    let limited = |line: &str, end: &str| {
        let script =
            format!("ulimit -c 0; ulimit -f 4; exec '{}' {line} {end}", env!("CARGO_BIN_EXE_leafless"));
        let mut command = Command::new("sh");
        command.args(["-c", &script]).current_dir(place.0.path()).stdin(Stdio::null());
        Run::new(line, command.output().unwrap())
    };
    for (line, output) in [
        ("csg ball.csg -o out.lfl --depth 8", "out.lfl"),
        ("dexelize ball.lfl -o out.lfl", "out.lfl"),
        ("mesh ball.lfl -o out.stl", "out.stl"),
        ("bitmap ball.lfl -o new.nrrd", "new.nrrd"),
        ("voxels ball.lfl -o new.csv", "new.csv"),
        ("render ball.lfl -o new.png", "new.png"),
    ] {
        limited(line, "").bad(1, &[output, "File too large"]);
        assert_eq!(place.files(), files, "{line}");
        for name in ["out.lfl", "out.stl"] {
            assert_eq!(place.bytes(name), b"old", "{line}");
        }
    }
    limited("csg ball.csg -o - --depth 8", "> new").bad(1, &["standard output", "File too large\n"]);
    limited("voxels ball.lfl -o - --write csv", "> new").bad(1, &["standard output", "File too large\n"]);
}

/// Files of all kinds keep their permissions and links when they are replaced.
#[test]
fn files_of_all_kinds_are_replaced_alike() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = place();
    for (line, name) in
        [("complement cube.lfl -o link", "out.lfl"), ("mesh cube.lfl -o link --write stl", "out.stl")]
    {
        let mode = |mode| std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(place.path(name), mode(0o640)).unwrap();
        symlink(name, place.path("link")).unwrap();
        place.run(line).good();
        assert!(place.bytes(name) != b"old" && place.path("link").is_symlink(), "{line}");
        let found = std::fs::metadata(place.path(name)).unwrap().permissions().mode();
        assert_eq!(found & 0o777, 0o640, "{line}");
        std::fs::remove_file(place.path("link")).unwrap();
    }
}

/// Signals while the program queries a terminal, or shows a picture on it.
#[cfg(target_os = "linux")]
mod terminal {
    use super::*;
    use rustix::fs::{Mode, OFlags, open};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use rustix::termios::{SpecialCodeIndex, Termios, Winsize, tcgetattr, tcsetwinsize};
    use std::fs::File;
    use std::io::Read;

    /// Returns both ends of a terminal of 100 × 30 cells.
    fn terminal() -> [File; 2] {
        let master = File::from(openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap());
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap();
        let slave = File::from(open(&name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap());
        let size = Winsize { ws_col: 100, ws_row: 30, ws_xpixel: 800, ws_ypixel: 480 };
        tcsetwinsize(&slave, size).unwrap();
        [master, slave]
    }

    fn modes(termios: &Termios) -> (u32, u32, u8, u8) {
        let code = |index| termios.special_codes[index];
        let [least, time] = [code(SpecialCodeIndex::VMIN), code(SpecialCodeIndex::VTIME)];
        (termios.local_modes.bits(), termios.input_modes.bits(), least, time)
    }

    fn render(place: &Place, protocol: &str, slave: &File) -> Running {
        let mut command = waiting(place, "render ball.lfl --samples 1");
        command.arg(format!("--show={protocol}")).stdout(slave.try_clone().unwrap());
        for name in ["TMUX", "TERM_PROGRAM", "LC_TERMINAL", "COLORTERM"] {
            command.env_remove(name);
        }
        // The program waits longer for a distant terminal.
        start(
            {
                command.env("TERM", "xterm").env("SSH_TTY", "/dev/pts/0");
                command
            },
            None,
        )
    }

    #[test]
    fn a_terminal_that_is_asked_gets_its_mode_back() {
        let place = place();
        for signal in SIGNALS {
            let [mut master, slave] = terminal();
            let before = modes(&tcgetattr(&slave).unwrap());
            let mut running = render(&place, "auto", &slave);
            let (mut asked, mut buffer) = (Vec::new(), [0; 256]);
            while !asked.ends_with(b"\x1b[c\x1b8\x1b[K") {
                let count = master.read(&mut buffer).unwrap();
                asked.extend_from_slice(&buffer[..count]);
            }
            assert_ne!(modes(&tcgetattr(&slave).unwrap()), before);
            running.signal(signal);
            assert_eq!(running.end().signal(), Some(signal as i32));
            assert_eq!(modes(&tcgetattr(&slave).unwrap()), before, "{signal}");
        }
    }

    #[test]
    fn a_terminal_that_stands_still_is_not_waited_for() {
        let place = place();
        for signal in SIGNALS {
            let [_master, slave] = terminal();
            let mut running = render(&place, "sixel", &slave);
            std::thread::sleep(3 * SOON);
            running.signal(signal);
            assert_eq!(running.end().signal(), Some(signal as i32));
        }
    }

    /// Half of a sequence would swallow the next prompt.
    #[test]
    fn a_picture_that_is_cut_off_ends_its_sequence() {
        let place = place();
        let cut = |signal: Signal| {
            let [mut master, slave] = terminal();
            let mut running = render(&place, "sixel", &slave);
            drop(slave);
            let (mut text, mut buffer) = (Vec::new(), [0; 256]);
            while !text
                .windows(4)
                .any(|window| window == b"\x1bP0;" || window == b"\x1bPq\"" || window == b"#1;2")
            {
                let count = master.read(&mut buffer).unwrap();
                text.extend_from_slice(&buffer[..count]);
            }
            running.signal(signal);
            while let Ok(count @ 1..) = master.read(&mut buffer) {
                text.extend_from_slice(&buffer[..count]);
            }
            let is_ended = text.ends_with(b"\x1b\\\x1b[0m\r\n");
            running.end().signal() == Some(signal as i32) && is_ended
        };
        // On a busy machine, the program may wait longer for this reader.
        assert!(SIGNALS.into_iter().any(cut));
    }
}

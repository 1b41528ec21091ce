//! The program `leafless`. The library `leafless_cli` is all of it, because a library compiles beside the
//! kernel, and a program waits for the kernel's machine code.

use std::process::ExitCode;

fn main() -> ExitCode {
    leafless_cli::main()
}

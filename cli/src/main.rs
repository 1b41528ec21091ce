//! The program `leafless`. The library `leafless_cli` is all of it: a library compiles beside the kernel, and a
//! program would wait for the kernel's machine code.

use std::process::ExitCode;

fn main() -> ExitCode {
    leafless_cli::main()
}

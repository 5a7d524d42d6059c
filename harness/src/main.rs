//! The program: everything is in the library, so that tests drive it as a user would.

use fairflight_harness::Terminal;
use std::io::{self, IsTerminal};

fn main() -> std::process::ExitCode {
    // Without the handler the program does its work all the same; only an interrupt would leave a temporary folder behind.
    let _ = fairflight_harness::interrupt::install();
    let code = fairflight_harness::run(
        std::env::args_os(),
        &mut io::stdin().lock(),
        &mut io::stdout().lock(),
        &mut io::stderr(),
        Terminal { progress: io::stderr().is_terminal() },
    );
    std::process::ExitCode::from(u8::try_from(code).unwrap_or(u8::MAX))
}

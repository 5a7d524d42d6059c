//! The program: everything is in the library, so that tests drive it as a user would. Only the program knows its revision: after a
//! commit nothing else is compiled again.

use fairflight_harness::Host;
use std::io::{self, IsTerminal, Write};

fn main() -> std::process::ExitCode {
    if let Err(error) = fairflight_harness::interrupt::install() {
        // The program does its work all the same.
        let _ = writeln!(io::stderr(), "warning: an interrupt may leave temporary files behind: {error}");
    }
    let code = fairflight_program::run(
        std::env::args_os(),
        &mut io::stdin().lock(),
        &mut io::stdout().lock(),
        &mut io::stderr(),
        Host {
            progress: io::stderr().is_terminal(),
            tables: io::stdout().is_terminal(),
            revision: env!("FAIRFLIGHT_REVISION"),
        },
    );
    std::process::ExitCode::from(u8::try_from(code).unwrap_or(u8::MAX))
}

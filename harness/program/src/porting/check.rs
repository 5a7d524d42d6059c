//! `harness check-port`: somebody's program, asked every case.

use super::chosen;
use super::verdict::Verdict;
use clap::{Args, ValueEnum};
use fairflight_harness::{DONE, Failure, UNSOUND, print};
use fairflight_vectors::{Case, Layer, Precision, ask_statistics, asked, judge};
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};

/// Arguments of `check-port`.
#[derive(Clone, Debug, Args)]
pub(crate) struct CheckPortArguments {
    /// Kinds that the port has, separated by commas; all by default
    #[arg(long, value_name = "KINDS", value_delimiter = ',')]
    pub kinds: Vec<String>,
    /// The precision of the port
    #[arg(long, value_enum, default_value_t)]
    pub precision: PrecisionWord,
    /// The layers that the port can be asked, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [LayerWord::Field, LayerWord::Exponentials, LayerWord::Uniforms])]
    pub layers: Vec<LayerWord>,
    /// So many estimates of each set of parameters whose exact moments are known, from the port's own generator, instead of the layers
    #[arg(long, value_name = "ESTIMATES", value_parser = clap::value_parser!(u64).range(2..))]
    pub statistics: Option<u64>,
    /// The program and its arguments: cases on its standard input, an answer a line on its standard output (docs/PORTING.md)
    #[arg(value_name = "COMMAND", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    pub command: Vec<String>,
}

/// A word for a [`Precision`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum PrecisionWord {
    /// Doubles
    #[default]
    Binary64,
    /// Single precision
    Binary32,
}

/// A word for a [`Layer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LayerWord {
    /// The extinction of each look-up is given, and exponentials
    Field,
    /// Exponentials are given
    Exponentials,
    /// Exponentials are the port's own, from uniform variates
    Uniforms,
}

impl From<PrecisionWord> for Precision {
    fn from(word: PrecisionWord) -> Self {
        match word {
            PrecisionWord::Binary64 => Self::Binary64,
            PrecisionWord::Binary32 => Self::Binary32,
        }
    }
}

impl From<LayerWord> for Layer {
    fn from(word: LayerWord) -> Self {
        match word {
            LayerWord::Field => Self::Field,
            LayerWord::Exponentials => Self::Exponentials,
            LayerWord::Uniforms => Self::Uniforms,
        }
    }
}

/// Runs `harness check-port`; returns the exit code.
pub(crate) fn check_port(arguments: &CheckPortArguments, stdout: &mut dyn Write) -> Result<i32, Failure> {
    let precision = Precision::from(arguments.precision);
    let kinds = chosen(&arguments.kinds)?;
    let mut port = Port::start(&arguments.command)?;
    let mut sound = true;
    for kind in kinds {
        if let Some(samples) = arguments.statistics {
            let answer = |id: &str, asked: &str| port.answer(id, asked);
            let (text, holds) = ask_statistics(kind, samples, answer)?;
            print(stdout, &text)?;
            sound &= holds;
            continue;
        }
        let cases = kind.cases();
        for layer in
            Layer::ALL.into_iter().filter(|&layer| arguments.layers.iter().any(|&word| layer == word.into()))
        {
            let verdict = ask(&mut port, &cases, layer, precision)?;
            if verdict.is_empty() {
                continue;
            }
            print(stdout, &verdict.text(kind.name))?;
            if !verdict.holds() {
                sound = false;
                // What lies further out would only repeat it.
                break;
            }
        }
    }
    port.end()?;
    Ok(if sound { DONE } else { UNSOUND })
}

/// Asks a port all cases of one kind.
fn ask(port: &mut Port, cases: &[Case], layer: Layer, precision: Precision) -> Result<Verdict, Failure> {
    let mut verdict = Verdict::new(layer, precision);
    for case in cases {
        let Some(line) = asked(&case.json, layer, precision) else { continue };
        let answer = port.answer(&case.id, &line.to_string())?;
        let said = judge(&case.json, &answer, precision);
        verdict.add(case, &answer, said);
    }
    Ok(verdict)
}

/// A running port.
struct Port {
    child: Child,
    answers: BufReader<std::process::ChildStdout>,
    name: String,
}

impl Port {
    fn start(command: &[String]) -> Result<Self, Failure> {
        let name = command.join(" ");
        let started = Command::new(&command[0])
            .args(&command[1..])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = started.map_err(|error| Failure::refused(format!("cannot start {name}: {error}")))?;
        let answers = BufReader::new(child.stdout.take().expect("a pipe was asked for"));
        Ok(Self { child, answers, name })
    }

    /// One case, one answer: neither side waits for the other with a full pipe.
    fn answer(&mut self, id: &str, case: &str) -> Result<serde_json::Value, Failure> {
        let input = self.child.stdin.as_mut().expect("a pipe was asked for");
        let sent = writeln!(input, "{case}").and_then(|()| input.flush());
        let mut line = String::new();
        let read = sent.and_then(|()| self.answers.read_line(&mut line));
        let failed = |reason: String| Failure::refused(format!("{}, asked {id}: {reason}", self.name));
        match read {
            Ok(0) => Err(failed("the program ended without an answer".to_owned())),
            Err(error) => Err(failed(error.to_string())),
            Ok(_) => {
                let answer: serde_json::Value = serde_json::from_str(&line)
                    .map_err(|error| failed(format!("the answer is no JSON ({error}): {line}")))?;
                if answer["id"] == id {
                    Ok(answer)
                } else {
                    Err(failed(format!("the answer has another id: {line}")))
                }
            }
        }
    }

    /// Closes its input, and waits until it ends.
    fn end(mut self) -> Result<(), Failure> {
        drop(self.child.stdin.take());
        let ended = self.child.wait().map_err(|error| Failure::refused(format!("{}: {error}", self.name)))?;
        if ended.success() { Ok(()) } else { Err(Failure::refused(format!("{}: {ended}", self.name))) }
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        // Of a port that was refused; one that has ended is not there any more.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

//! Statistics of the results of `harness verify --json` on many seeds: alarms, checks that could not be tested, power, and the share of
//! p-values below 0.01. Reads the files that it is given; `tests/verify-seeds` makes them.
//!
//! ```sh
//! cargo run -p fairflight-tests --example verify_seeds -- verify-*.json
//! ```
//!
//! Exit code 1 if a check raised an alarm or was not testable, or if a share is above what 0.01 allows (below it too for exact
//! p-values).

use fairflight_stats::Binomial;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::process::ExitCode;

/// The p-values that are counted lie below this.
const SMALL: f64 = 0.01;

/// A share is called off where its exact binomial p-value is below this: 95 % intervals, as they are reported.
const OFF: f64 = 0.05;

/// p-values of one sort.
#[derive(Clone, Copy, Default)]
struct Count {
    all: u64,
    small: u64,
}

impl Count {
    fn observe(&mut self, p: f64) {
        self.all += 1;
        self.small += u64::from(p < SMALL);
    }

    /// The counts of small ones that 0.01 allows at 95 %, and whether this one is among them: for exact p-values on both sides.
    fn judge(self, is_exact: bool) -> (u64, u64, bool) {
        let law = Binomial::new(self.all, SMALL).expect("a probability");
        let within = |k: u64| law.two_sided_p_value(k) > OFF;
        let mean = (self.all as f64 * SMALL) as u64;
        let low = (0..=mean).find(|&k| within(k)).unwrap_or(mean);
        let high = (mean..=self.all).take_while(|&k| within(k)).last().unwrap_or(mean);
        (low, high, self.small <= high && (!is_exact || self.small >= low))
    }
}

/// The logarithms of a check's shares of N that normal approximations asked for.
#[derive(Clone, Default)]
struct Shares(Vec<f64>);

impl Shares {
    fn greatest(&self) -> f64 {
        self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max).exp()
    }

    /// Number of standard deviations of the logarithm over the seeds by which the mean stays below 1, where a check stops being testable.
    fn margin(&self) -> f64 {
        let n = self.0.len() as f64;
        let mean = self.0.iter().sum::<f64>() / n;
        let variance = self.0.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0).max(1.0);
        -mean / variance.sqrt()
    }
}

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    match summarise(&files, &mut std::io::stdout().lock()) {
        Ok(true) => ExitCode::SUCCESS,
        // Whoever reads it may close the pipe early: no verdict is known then.
        Ok(false) | Err(_) => ExitCode::FAILURE,
    }
}

/// Writes what the files say; whether no check raised an alarm, all were testable, and no share is off.
///
/// # Errors
/// If it cannot be written.
fn summarise(files: &[String], out: &mut impl Write) -> io::Result<bool> {
    let (mut alarms, mut untestable, mut runs, mut checks) = (Vec::new(), Vec::new(), 0, 0);
    let mut weakest: BTreeMap<String, f64> = BTreeMap::new();
    let mut shares: BTreeMap<String, Shares> = BTreeMap::new();
    let mut counts: BTreeMap<(String, String), Count> = BTreeMap::new();
    for file in files {
        let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        let run: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let seed = &run["provenance"]["seed"];
        runs += 1;
        for check in run["checks"].as_array().unwrap_or_else(|| panic!("{file}: no checks")) {
            checks += 1;
            let id = check["id"].as_str().unwrap_or_default().to_owned();
            let line = || format!("seed {seed}: {id}: {}", check["reason"].as_str().unwrap_or_default());
            match check["holds"].as_bool() {
                Some(true) => {}
                Some(false) => alarms.push(line()),
                None => untestable.push(line()),
            }
            if let Some(bias) = check["detectable_relative_bias"].as_f64() {
                let worst = weakest.entry(id.clone()).or_default();
                *worst = worst.max(bias);
            }
            if let Some(share) = check["normal_share"].as_f64().filter(|&share| share > 0.0) {
                shares.entry(id.clone()).or_default().0.push(share.ln());
            }
            for p_value in check["p_values"].as_array().into_iter().flatten() {
                let level = p_value["level"].as_str().unwrap_or_default().to_owned();
                let of = p_value["of"].as_str().unwrap_or_default();
                let of = of.rsplit(": ").next().unwrap_or(of).to_owned();
                let Some(p) = p_value["p"].as_f64() else { panic!("{file}: {id}: no p-value") };
                counts.entry((level.clone(), of)).or_default().observe(p);
                counts.entry((level, "all".to_owned())).or_default().observe(p);
            }
        }
    }
    writeln!(
        out,
        "{runs} runs, {checks} checks: {} alarms, {} not testable",
        alarms.len(),
        untestable.len()
    )?;
    for line in alarms.iter().chain(&untestable) {
        writeln!(out, "  {line}")?;
    }
    writeln!(out, "\nleast powerful:")?;
    for (bias, id) in greatest(weakest.iter().map(|(id, bias)| (*bias, id))) {
        writeln!(out, "  {bias:.3}  {id}")?;
    }
    writeln!(
        out,
        "\nnearest to untestable (greatest share of N that a normal approximation asked for; standard deviations to 1):"
    )?;
    for (share, id) in greatest(shares.iter().map(|(id, shares)| (shares.greatest(), id))) {
        writeln!(out, "  {share:.3}  {:6.1}  {id}", shares[id].margin())?;
    }
    writeln!(
        out,
        "\n| level | of | p-values | below {SMALL} | share | 95 % of {SMALL} |\n|---|---|---|---|---|---|"
    )?;
    let mut off = false;
    for ((level, of), count) in &counts {
        let (low, high, is_within) = count.judge(level == "exact");
        // Kinds of quantity are told; their union is judged.
        off |= of == "all" && !is_within && level != "studentised";
        let share = count.small as f64 / count.all as f64;
        let mark = if is_within { "" } else { " *" };
        writeln!(
            out,
            "| {level} | {of} | {} | {} | {share:.4}{mark} | {low} to {high} |",
            count.all, count.small
        )?;
    }
    Ok(alarms.is_empty() && untestable.is_empty() && !off)
}

/// The ten greatest, in order.
fn greatest<'a>(values: impl Iterator<Item = (f64, &'a String)>) -> Vec<(f64, &'a String)> {
    let mut values: Vec<_> = values.collect();
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    values.truncate(10);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_pipe_is_no_panic() {
        struct Closed;
        impl Write for Closed {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::BrokenPipe.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        assert_eq!(summarise(&[], &mut Closed).unwrap_err().kind(), io::ErrorKind::BrokenPipe);
        let mut text = Vec::new();
        assert!(summarise(&[], &mut text).unwrap());
        assert!(String::from_utf8(text).unwrap().starts_with("0 runs"));
    }
}

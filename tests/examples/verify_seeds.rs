//! Statistics of the results of `harness verify --json` on many seeds: alarms, checks that could not be tested, power, and the share of
//! p-values below 0.01. Reads the files that it is given; `tests/verify-seeds` makes them.
//!
//! ```sh
//! cargo run -p fairflight-tests --example verify_seeds -- verify-*.json
//! ```
//!
//! Exit code 1 if a check raised an alarm or was not testable, if a share is above what 0.01 allows (below it too for exact p-values), or
//! if one p-value of one check is small on more seeds than chance explains.

use fairflight_stats::Binomial;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::process::ExitCode;

/// The p-values that are counted lie below this.
const SMALL: f64 = 0.01;

/// A share is called off where its binomial p-value is below this: 95 % intervals, as they are reported.
const OFF: f64 = 0.05;

/// p-values, and how many of them are small.
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
}

/// p-values of one sort: of each check on each seed a count of its own.
#[derive(Clone, Default)]
struct Counts(Vec<Count>);

impl Counts {
    /// Takes the p-values of the next check.
    fn observe(&mut self, p_values: impl Iterator<Item = f64>) {
        let mut count = Count::default();
        p_values.for_each(|p| count.observe(p));
        self.0.push(count);
    }

    fn total(&self) -> Count {
        let sum = |of: fn(&Count) -> u64| self.0.iter().map(of).sum();
        Count { all: sum(|count| count.all), small: sum(|count| count.small) }
    }

    /// Variance of the number of small ones over that of independent p-values, at least 1: a check's p-values come from the same draws (who
    /// collides does not escape), so that they are small together.
    fn design_effect(&self) -> f64 {
        let Count { all, small } = self.total();
        let share = small as f64 / all as f64;
        let deviation = |count: &Count| count.small as f64 - share * count.all as f64;
        let variance: f64 = self.0.iter().map(|count| deviation(count).powi(2)).sum();
        (variance / (all as f64 * SMALL * (1.0 - SMALL))).max(1.0)
    }

    /// The counts of small ones that 0.01 allows at 95 %, and whether this one is among them: for exact p-values on both sides. The binomial
    /// interval, widened by the root of the design effect.
    fn judge(&self, is_exact: bool) -> (f64, f64, bool) {
        let Count { all, small } = self.total();
        let law = Binomial::new(all, SMALL).expect("a probability");
        let within = |k: u64| law.two_sided_p_value(k) > OFF;
        let mean = all as f64 * SMALL;
        let low = (0..=mean as u64).find(|&k| within(k)).unwrap_or(mean as u64) as f64;
        let high = (mean as u64..=all).take_while(|&k| within(k)).last().unwrap_or(mean as u64) as f64;
        let wider = self.design_effect().sqrt();
        let (low, high) = ((mean - wider * (mean - low)).max(0.0), mean + wider * (high - mean));
        (low, high, small as f64 <= high && (!is_exact || small as f64 >= low))
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
    let mut counts: BTreeMap<(String, String), Counts> = BTreeMap::new();
    let mut repeated: BTreeMap<String, Count> = BTreeMap::new();
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
            let mut found: BTreeMap<(String, String), Vec<f64>> = BTreeMap::new();
            for p_value in check["p_values"].as_array().into_iter().flatten() {
                let level = p_value["level"].as_str().unwrap_or_default().to_owned();
                let of = p_value["of"].as_str().unwrap_or_default();
                let Some(p) = p_value["p"].as_f64() else { panic!("{file}: {id}: no p-value") };
                repeated.entry(format!("{id}: {of}")).or_default().observe(p);
                let of = of.rsplit(": ").next().unwrap_or(of).to_owned();
                found.entry((level.clone(), of)).or_default().push(p);
                found.entry((level, "all".to_owned())).or_default().push(p);
            }
            for (sort, p_values) in found {
                counts.entry(sort).or_default().observe(p_values.into_iter());
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
    let mut off = false;
    writeln!(out, "\nmost often below {SMALL} (chance of as many, times the number of p-values; seeds):")?;
    let chances = repeated.iter().filter(|(_, count)| count.small > 0).map(|(of, count)| {
        let law = Binomial::new(count.all, SMALL).expect("a probability");
        (-law.upper_tail(count.small) * repeated.len() as f64, of)
    });
    for (chance, of) in greatest(chances) {
        off |= -chance < OFF;
        writeln!(out, "  {:.3}  {} of {}  {of}", -chance, repeated[of].small, repeated[of].all)?;
    }
    writeln!(
        out,
        "\n| level | of | p-values | below {SMALL} | share | design effect | 95 % of {SMALL} |\n|---|---|---|---|---|---|---|"
    )?;
    for ((level, of), count) in &counts {
        let (low, high, is_within) = count.judge(level == "exact");
        // Kinds of quantity are told; their union is judged.
        off |= of == "all" && !is_within && level != "studentised";
        let Count { all, small } = count.total();
        let (share, effect) = (small as f64 / all as f64, count.design_effect());
        let mark = if is_within { "" } else { " *" };
        writeln!(
            out,
            "| {level} | {of} | {all} | {small} | {share:.4}{mark} | {effect:.2} | {low:.0} to {high:.0} |"
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
    fn p_values_of_the_same_draws_widen_the_interval() {
        // One small one in each of the first checks, or all of a few checks: as many, and no alarm only where they come together.
        let of = |checks: &[(usize, f64)]| {
            let mut counts = Counts::default();
            for &(times, p) in checks {
                (0..times).for_each(|_| counts.observe([p; 10].into_iter()));
            }
            counts
        };
        let mut apart = of(&[(837, 0.5)]);
        (0..163)
            .for_each(|_| apart.observe([0.001, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5].into_iter()));
        let together = of(&[(16, 0.001), (984, 0.5)]);
        assert_eq!((apart.total().small, together.total().small), (163, 160));
        assert!(!apart.judge(true).2 && together.judge(true).2);
        assert!((together.design_effect() - 16.0 * 10.0 * 9.84 / 99.0).abs() < 0.2);
        assert!(!of(&[(60, 0.001), (940, 0.5)]).judge(true).2);
    }

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

//! A recorded test of a million rows, imported as `phea identify` imports it: `cargo bench -p
//! phea-workbench --bench import`.
//!
//! Six columns (time, command, supply pressure, both port pressures, leakage) as text with commas
//! and as Parquet, in the folder for temporary files. Each is read by a separate process, from the
//! file to numbers in SI with every check of the reader. The output has the size of the file, the
//! best and the median time of several processes, and the largest memory of one of them (`VmHWM`,
//! the file's own bytes included). Times are printed and never asserted; the bench fails if a
//! number differs between both files, or if more than 200 MB were needed.
//!
//! Its arguments are `read FILE`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use phea_engineering::identify::{Known, recordings};
use phea_engineering::number_table::{NumberTable, TableFormat};
use phea_workbench::project::RecordedTest;
use phea_workbench::quantity::DisplayUnit;
use phea_workbench::source::{Source, SourceError};

const ROWS: u32 = 1_000_000;
const PROCESSES: usize = 7;
const MOST_MEGABYTES: f64 = 200.0;

const COLUMNS: [&str; 6] =
    ["time_s", "command_v", "supply_pressure_bar", "pressure_a_bar", "pressure_b_bar", "leak_flow_l_per_min"];

type Fault = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let done = match words.as_slice() {
        [verb, file] if verb == "read" => read(file),
        _ => measured(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

/// Writes both files and starts a process that reads each.
fn measured() -> Result<(), Fault> {
    let folder = std::env::temp_dir().join(format!("phea-import-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let found = [TableFormat::Csv, TableFormat::Parquet].map(|format| of_format(&folder, format));
    std::fs::remove_dir_all(&folder)?;
    let [text, parquet] = found;
    if text? != parquet? {
        return Err("text and Parquet give different numbers".into());
    }
    Ok(())
}

/// The sums of the columns as read from a file of this format, as bits.
fn of_format(folder: &Path, format: TableFormat) -> Result<String, Fault> {
    let file = folder.join(format!("leakage.{}", format.ending()));
    written(&file, format)?;
    let (mut times, mut most, mut sums) = (Vec::new(), 0.0_f64, String::new());
    for _ in 0..PROCESSES {
        let output = Command::new(std::env::current_exe()?).arg("read").arg(&file).output()?;
        let text = String::from_utf8(output.stdout)?;
        let mut words = text.split_whitespace();
        let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
        let (Some(seconds), Some(megabytes)) = (number(), number()) else {
            return Err(String::from_utf8_lossy(&output.stderr).into());
        };
        times.push(seconds);
        most = most.max(megabytes);
        sums = words.collect::<Vec<_>>().join(" ");
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{:8} {:6.1} MB   best {:.3} s   median {:.3} s   at most {most:.0} MB of memory",
        format.ending(),
        std::fs::metadata(&file)?.len() as f64 / 1e6,
        times.first().copied().unwrap_or(f64::NAN),
        times.get(PROCESSES / 2).copied().unwrap_or(f64::NAN),
    );
    if most > MOST_MEGABYTES {
        return Err(format!("{most:.0} MB are more than {MOST_MEGABYTES} MB").into());
    }
    Ok(sums)
}

/// A leakage test with noise, with its numbers as the bench writes them: with all their digits.
fn written(file: &PathBuf, format: TableFormat) -> Result<(), Fault> {
    let sink = BufWriter::new(File::create(file)?);
    let mut table = NumberTable::new(sink, format, &COLUMNS)?;
    let (bar, litres) = (DisplayUnit::BAR, DisplayUnit::LITRE_PER_MINUTE);
    let mut state = phea_dynamics::random::stream(1, 0);
    let mut noise = |size: f64| size * phea_dynamics::random::normal(&mut state);
    for row in 0..ROWS {
        let turn = 2.0 * std::f64::consts::PI * f64::from(row) / f64::from(ROWS);
        let fraction = phea_dynamics::portable::sin(turn);
        let pressure = |fraction: f64| 35e5 + 30e5 * fraction;
        table.row(&[
            f64::from(row) * 2.4e-4,
            3.0 * fraction,
            bar.of(70e5 + noise(5e3)),
            bar.of(pressure(fraction) + noise(5e3)),
            bar.of(pressure(-fraction) + noise(5e3)),
            litres.of(2e-5 * (1.2 - fraction * fraction) + noise(1e-7)),
        ])?;
    }
    table.finish()?.flush()?;
    Ok(())
}

/// Source that reads files from the disk unchanged.
struct Disk;

impl Source for Disk {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        std::fs::read(path).map_err(|error| SourceError { path: path.to_string(), reason: error.to_string() })
    }

    fn list(&self, _path: &str) -> Result<Option<Vec<String>>, SourceError> {
        Ok(None)
    }
}

/// Imports a file and prints seconds, megabytes and the sums of its columns.
fn read(file: &str) -> Result<(), Fault> {
    let begun = Instant::now();
    let files = recordings(&Disk, &[RecordedTest::of(file)], &Known::default())?;
    let seconds = begun.elapsed().as_secs_f64();
    let recording = files.recordings.first().ok_or("no recording")?;
    if recording.inputs.len() != ROWS as usize {
        return Err(format!("{} rows", recording.inputs.len()).into());
    }
    let sums = recording.signals.iter().map(|signal| signal.values.iter().flatten().sum::<f64>().to_bits());
    let sums: Vec<String> = sums.map(|sum| sum.to_string()).collect();
    println!("{seconds} {} {}", peak_megabytes()?, sums.join(" "));
    Ok(())
}

/// The largest memory of this process, as reported by Linux.
fn peak_megabytes() -> Result<f64, Fault> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM")?;
    let kibibytes: f64 = line.trim().trim_end_matches("kB").trim().parse()?;
    Ok(kibibytes * 1024.0 / 1e6)
}

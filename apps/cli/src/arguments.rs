use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use phea_workbench::answer::TableFormat;

use crate::changes::Changes;

/// Hydraulic force control through added compliance: size the hose, see the models, audit, shape or
/// design the controller, simulate the machine, get the report.
#[derive(Debug, Parser)]
#[command(name = "phea", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 done, 1 the answer is no or not proven, 2 the input is wrong, 3 something could not be written."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a commented starter project into a new folder
    New {
        /// Folder to create; it must be empty or absent
        folder: PathBuf,
    },
    /// Print the JSON Schema of the project file, with which editors of TOML check it and complete
    /// its keys
    Schema {
        /// Print the JSON Schema of the answers of all commands with --json instead, with a
        /// description of each key
        #[arg(long)]
        answers: bool,
        /// Write it into this folder, as phea.schema.json or phea.answers.schema.json, instead of
        /// printing it
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Validate a project and print every derived quantity with its equation
    Check(Common),
    /// Size the hose over the catalogue, by gain and by length, with the reason for every decision
    Size {
        #[command(flatten)]
        common: Common,
        /// Proportional gain K_p, V/N where no unit is given: size every hose for this gain
        #[arg(long, value_name = "K_P", conflicts_with = "length", allow_hyphen_values = true)]
        gain: Option<String>,
        /// Hose length per line ("1.5 m"): find the gain every hose needs at this length
        #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
        length: Option<String>,
    },
    /// Linear models: poles, differences, stiffness over the stroke, driving-point impedance,
    /// passivity
    Linearize {
        #[command(flatten)]
        common: Common,
        /// A number of the project that goes from one end to another, such as "line.length=0.5 m..3
        /// m": poles, K_H and bandwidth over it
        #[arg(long, value_name = "KEY=FROM..TO", allow_hyphen_values = true)]
        sweep: Option<String>,
        /// Values of the sweep, both ends among them (11)
        #[arg(long, value_name = "N", requires = "sweep")]
        points: Option<usize>,
    },
    /// Audit the given controller and prefilter: every plant of the family, every specification,
    /// its whole band
    Verify {
        #[command(flatten)]
        common: Common,
        /// Try the verdict on the nonlinear machine: a step of the rig, of its worst plants, and
        /// with waves in its lines
        #[arg(long)]
        on_machine: bool,
        /// Prove or refute the verdict: for every plant of the box and every frequency of the band
        #[arg(long)]
        prove: bool,
        /// The same, with the proof as a file that `phea check-certificate` checks again
        #[arg(long, value_name = "FILE")]
        certificate: Option<PathBuf>,
    },
    /// Check a certificate of `verify --certificate` again: every claim in it, with rounding
    /// outwards
    CheckCertificate(Certified),
    /// Shape the controller by hand: change its elements in the order given, see every margin at
    /// the design frequencies
    Shape {
        #[command(flatten)]
        common: Common,
        #[command(flatten)]
        changes: Changes,
        /// Change the prefilter instead of the controller
        #[arg(long)]
        prefilter: bool,
        /// Write the project with the changed elements to this file; all else of it stays byte for
        /// byte
        #[arg(long, value_name = "FILE")]
        save: Option<PathBuf>,
    },
    /// Find a controller and prefilter that satisfy every specification, for every plant; Ctrl-C
    /// gives the best so far
    Design {
        #[command(flatten)]
        common: Common,
        /// Seed of the random starting points, in place of the project's
        #[arg(long, value_name = "N")]
        seed: Option<u32>,
        /// Write the project with the designed controller and prefilter in it to this file
        #[arg(long, value_name = "FILE")]
        save: Option<PathBuf>,
        /// Leave it at a verdict that the machine contradicts, and do not design again with the
        /// plant that does
        #[arg(long)]
        no_repair: bool,
    },
    /// The nonlinear machine under its controller, through every scenario; Ctrl-C ends it with what
    /// there is
    Simulate {
        #[command(flatten)]
        common: Common,
        /// How tables are written: csv or parquet
        #[arg(long, value_name = "FORMAT", requires = "out")]
        table: Option<TableFormat>,
        /// Write no figures with the tables: they take most of the time of a short run
        #[arg(long, requires = "out")]
        no_figures: bool,
        /// Instead of the scenarios, the machine's response to sines around its operating point,
        /// compared with the linear plant
        #[arg(long)]
        frequency_response: bool,
        /// Frequencies of the sines, such as "1, 10, 100 rad/s"; a unit holds for the numbers
        /// before it
        #[arg(long, value_name = "LIST", requires = "frequency_response", allow_hyphen_values = true)]
        frequencies: Option<String>,
        /// Amplitude of the command of the open loop ("0.1 V")
        #[arg(long, value_name = "VOLTAGE", requires = "frequency_response", allow_hyphen_values = true)]
        amplitude: Option<String>,
        /// Amplitude of the reference of the closed loop ("100 N"; of a motor a torque, "40 N.m")
        #[arg(long, value_name = "FORCE", requires = "frequency_response", allow_hyphen_values = true)]
        reference_amplitude: Option<String>,
        /// Run each scenario a second time at a tenth of the tolerance: how far the two differ
        /// estimates the error
        #[arg(long, conflicts_with = "frequency_response")]
        check: bool,
    },
    /// The same scenarios of several projects side by side
    Compare(Several),
    /// The project and each of its alternatives: sized, designed, audited, driven and compared;
    /// Ctrl-C keeps those that are finished
    Alternatives {
        #[command(flatten)]
        common: Common,
        /// Two or three columns of a front, separated by commas, such as
        /// "disturbance_peak_n,swept"; `:less` or `:more` after one says what is better
        #[arg(long, value_name = "COLUMN,COLUMN", requires = "sweep")]
        front: Option<String>,
        /// The number over which the front is drawn, such as "line.length=0.5 m..3 m"; every value
        /// of every alternative is a design
        #[arg(long, value_name = "KEY=FROM..TO", requires = "front", allow_hyphen_values = true)]
        sweep: Option<String>,
        /// Values of the sweep, both ends among them (5)
        #[arg(long, value_name = "N", requires = "sweep")]
        points: Option<usize>,
        /// Frequencies at which the impedance at the load is printed ("1, 10, 100 rad/s")
        #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
        frequencies: Option<String>,
    },
    /// Monte Carlo: the nonlinear machine with drawn numbers, many times; Ctrl-C keeps what is
    /// done, and the same command goes on
    Campaign {
        #[command(flatten)]
        common: Common,
        /// How many runs
        #[arg(long, value_name = "N", required_unless_present = "run", value_parser = clap::value_parser!(u64).range(1..))]
        runs: Option<u64>,
        /// Seed of all random numbers: with a run's index it gives its numbers
        #[arg(long, value_name = "S", default_value_t = 1)]
        seed: u32,
        /// A part of the runs, such as 2/4; the tables of all parts, one after the other, are the
        /// table of the whole
        #[arg(long, value_name = "I/N")]
        shard: Option<String>,
        /// One run again, by its index: its numbers as --set, and all that happened
        #[arg(long, value_name = "INDEX", conflicts_with_all = ["runs", "shard"])]
        run: Option<u64>,
        /// Threads; the rows do not depend on it
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        threads: Option<u16>,
    },
    /// Virtual tests of the servovalve, as instruments would record them: internal leakage,
    /// metering and pressure gain (ISO 10770-1)
    Bench(Common),
    /// Coefficients of a servovalve (or frequency responses, or the friction of the cylinder) from
    /// recorded tests, with confidence intervals and what the data do not determine
    Identify(IdentifyArguments),
    /// All results as one self-contained HTML page; a controller is designed where the project
    /// has a design section or gives no law
    Report {
        #[command(flatten)]
        common: Common,
        /// With a chapter on the alternatives of the project: a controller is designed for each
        #[arg(long)]
        alternatives: bool,
    },
}

/// What a command on several projects takes.
#[derive(Args, Debug)]
pub(crate) struct Several {
    /// The project files
    #[arg(required = true, num_args = 1..)]
    pub(crate) projects: Vec<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Write figures with all projects in them into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Override a value of every project, e.g. --set "supply.pressure=80 bar"; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// A catalogue file or folder of your own, searched before the built-in one; may be repeated
    #[arg(long = "catalogue", value_name = "PATH")]
    pub(crate) catalogues: Vec<String>,
}

/// A certificate, and the project that it must be of.
#[derive(Debug, Args)]
pub(crate) struct Certified {
    /// The certificate
    pub(crate) file: PathBuf,
    /// The project that it must be of: plant, box, laws and specifications are compared
    pub(crate) project: Option<PathBuf>,
    /// Set one value of the project, as `path=value`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// What every command on a project takes.
#[derive(Args, Debug)]
pub(crate) struct Common {
    /// The project file
    pub(crate) project: PathBuf,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Write files (tables, figures, pages) into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Override a value of the project, e.g. --set "line.length=2 m"; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// A catalogue file or folder of your own, searched before the built-in one; may be repeated
    #[arg(long = "catalogue", value_name = "PATH")]
    pub(crate) catalogues: Vec<String>,
}

/// What `identify` takes.
#[derive(Args, Debug)]
pub(crate) struct IdentifyArguments {
    /// What is identified
    #[arg(long, value_name = "WHAT", default_value = "valve")]
    pub(crate) of: SubjectWord,
    /// Recorded tests, tables as text or Parquet; or the project whose `[[identify.recording]]`
    /// names them
    #[arg(required_unless_present = "project", num_args = 1.., value_name = "PROJECT.toml|TABLE")]
    pub(crate) files: Vec<String>,
    /// The project of the valve: nominal voltage, and pressures that the files lack
    #[arg(long, value_name = "PROJECT.toml")]
    pub(crate) project: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Write the identified table of the valve into this folder, as valve.toml, and the figures of
    /// the tests
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Override a value of the project, e.g. --set "valve.nominal_voltage=5 V"; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// Starting points of the search (6)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) starts: Option<u16>,
    /// Seed of the starting points and of the bootstrap (1)
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u32>,
    /// Intervals by a bootstrap of this many repetitions too, 50 or more
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(50..=1_000_000))]
    pub(crate) bootstrap: Option<u32>,
    /// The model of the leakage, in place of the one that the recordings prefer
    #[arg(long, value_name = "MODEL")]
    pub(crate) leakage_model: Option<LeakageWord>,
    /// For a response: the period of the input ("2 s"), in place of the one that is found
    #[arg(long, value_name = "TIME")]
    pub(crate) period: Option<String>,
    /// For a response: time discarded at the beginning ("1 s"); absent: one period of a periodic
    /// input
    #[arg(long, value_name = "TIME")]
    pub(crate) settling: Option<String>,
    /// For a response: length of a segment ("4 s"), of an input that is not periodic
    #[arg(long, value_name = "TIME", conflicts_with = "period")]
    pub(crate) segment: Option<String>,
    /// For a response: squared coherence below which a frequency is left out (0.8)
    #[arg(long, value_name = "NUMBER")]
    pub(crate) coherence: Option<f64>,
    /// Of a line: the one to chamber A or to chamber B; absent: `bench.line.side` of the project,
    /// or A
    #[arg(long, value_name = "CHAMBER", ignore_case = true)]
    pub(crate) side: Option<ChamberWord>,
}

/// A chamber of the cylinder.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum ChamberWord {
    /// On the side of the piston without a rod
    A,
    /// On the side of the rod
    B,
}

/// What recorded tests are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum SubjectWord {
    /// Coefficients of the servovalve, from static tests
    Valve,
    /// Frequency responses, from a command (or input) and a force (or output) over time
    Response,
    /// Bulk modulus, stiffening and wave speed of a line, from its pressure while its far end is
    /// blocked
    Line,
    /// Friction of the cylinder, from runs at constant velocities and from breakaway
    Friction,
}

impl SubjectWord {
    /// As it is written on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            SubjectWord::Valve => "valve",
            SubjectWord::Response => "response",
            SubjectWord::Line => "line",
            SubjectWord::Friction => "friction",
        }
    }
}

/// A model of the leakage, as the project file calls it.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum LeakageWord {
    /// One secant for each edge
    #[value(name = "each_edge")]
    EachEdge,
    /// One curve for the whole valve
    #[value(name = "one_curve")]
    OneCurve,
}

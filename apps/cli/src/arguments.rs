use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use phea_workbench::answer::TableFormat;
use phea_workbench::command::IdentifiedPart;
use phea_workbench::export::ExportKind;

use crate::changes::Changes;

/// Design of hydraulic force control through added compliance: size the hose, print the models,
/// audit, shape or design the controller, simulate the machine, write the report.
#[derive(Debug, Parser)]
#[command(name = "phea", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 done, 1 the answer is no or not proven, 2 the input is wrong, 3 an output could not be written."
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
    /// Print the linear models: poles, differences, stiffness over the stroke, driving-point
    /// impedance, passivity
    Linearize {
        #[command(flatten)]
        common: Common,
        /// Vary a number of the project between two values, such as "line.length=0.5 m..3 m", and
        /// print poles, K_H and bandwidth over it
        #[arg(long, value_name = "KEY=FROM..TO", allow_hyphen_values = true)]
        sweep: Option<String>,
        /// Number of values of the sweep, both ends included (default 11)
        #[arg(long, value_name = "N", requires = "sweep")]
        points: Option<usize>,
    },
    /// Audit the given controller and prefilter: every plant of the family, every specification,
    /// its whole band
    Verify {
        #[command(flatten)]
        common: Common,
        /// Test the verdict in nonlinear simulation: a step of the rig, of its worst plants, and
        /// with waves in its lines
        #[arg(long)]
        on_machine: bool,
        /// Prove or refute the verdict: for every plant of the box and every frequency of the band
        #[arg(long)]
        prove: bool,
        /// Prove or refute the verdict, and write the proof to this file, which `phea
        /// check-certificate` checks
        #[arg(long, value_name = "FILE")]
        certificate: Option<PathBuf>,
    },
    /// Check every claim of a certificate that `verify --certificate` wrote, with outward rounding
    CheckCertificate(Certified),
    /// Shape the controller by hand: change its elements in the given order, and print every
    /// margin at the design frequencies
    Shape {
        #[command(flatten)]
        common: Common,
        #[command(flatten)]
        changes: Changes,
        /// Change the prefilter instead of the controller
        #[arg(long)]
        prefilter: bool,
        /// Write the project with the changed elements to this file; the rest of it is unchanged,
        /// byte for byte
        #[arg(long, value_name = "FILE")]
        save: Option<PathBuf>,
    },
    /// Design a controller and prefilter that satisfy every specification for every plant; Ctrl-C
    /// returns the best so far
    Design {
        #[command(flatten)]
        common: Common,
        /// Seed of the random starting points, instead of that of the project
        #[arg(long, value_name = "N")]
        seed: Option<u32>,
        /// Write the project with the designed controller and prefilter to this file
        #[arg(long, value_name = "FILE")]
        save: Option<PathBuf>,
        /// Do not design again with the plant that contradicts the verdict in nonlinear simulation
        #[arg(long)]
        no_repair: bool,
    },
    /// Simulate the nonlinear machine with its controller in every scenario; Ctrl-C returns the
    /// results so far
    Simulate {
        #[command(flatten)]
        common: Common,
        /// Format of the tables: csv or parquet
        #[arg(long, value_name = "FORMAT", requires = "out")]
        table: Option<TableFormat>,
        /// Write no figures with the tables; figures take most of the time of a short run
        #[arg(long, requires = "out")]
        no_figures: bool,
        /// Simulate the response to sines around the operating point instead of the scenarios, and
        /// compare it with the linear plant
        #[arg(long)]
        frequency_response: bool,
        /// Frequencies of the sines, such as "1, 10, 100 rad/s"; a unit applies to the numbers
        /// before it
        #[arg(long, value_name = "LIST", requires = "frequency_response", allow_hyphen_values = true)]
        frequencies: Option<String>,
        /// Amplitude of the command of the open loop ("0.1 V")
        #[arg(long, value_name = "VOLTAGE", requires = "frequency_response", allow_hyphen_values = true)]
        amplitude: Option<String>,
        /// Amplitude of the reference of the closed loop ("100 N"; for a motor a torque, "40 N.m")
        #[arg(long, value_name = "FORCE", requires = "frequency_response", allow_hyphen_values = true)]
        reference_amplitude: Option<String>,
        /// Simulate each scenario a second time at a tenth of the tolerance; the difference
        /// estimates the error
        #[arg(long, conflicts_with = "frequency_response")]
        check: bool,
    },
    /// Simulate the scenarios of several projects and compare the results
    Compare(Several),
    /// Size, design, audit, simulate and compare the project and each of its alternatives; Ctrl-C
    /// returns the finished ones
    Alternatives {
        #[command(flatten)]
        common: Common,
        /// Two or three columns of a Pareto front, separated by commas, such as
        /// "disturbance_peak_n,swept"; append `:less` or `:more` to state which is better
        #[arg(long, value_name = "COLUMN,COLUMN", requires = "sweep")]
        front: Option<String>,
        /// Number of the project to vary for the front, such as "line.length=0.5 m..3 m"; a
        /// controller is designed for every value of every alternative
        #[arg(long, value_name = "KEY=FROM..TO", requires = "front", allow_hyphen_values = true)]
        sweep: Option<String>,
        /// Number of values of the sweep, both ends included (default 5)
        #[arg(long, value_name = "N", requires = "sweep")]
        points: Option<usize>,
        /// Frequencies at which the impedance at the load is printed ("1, 10, 100 rad/s")
        #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
        frequencies: Option<String>,
    },
    /// Simulate the nonlinear machine many times with random parameters (Monte Carlo); after
    /// Ctrl-C the same command continues with the remaining runs
    Campaign {
        #[command(flatten)]
        common: Common,
        /// Number of runs
        #[arg(long, value_name = "N", required_unless_present = "run", value_parser = clap::value_parser!(u64).range(1..))]
        runs: Option<u64>,
        /// Seed of all random numbers; the seed and the index of a run determine its parameters
        #[arg(long, value_name = "S", default_value_t = 1)]
        seed: u32,
        /// Index of a single run to repeat; prints its parameters as --set, and its events
        #[arg(long, value_name = "INDEX", conflicts_with = "runs")]
        run: Option<u64>,
        /// Number of threads; the rows do not depend on it
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        threads: Option<u16>,
    },
    /// Simulate tests of the servovalve as instruments would record them: internal leakage,
    /// metering and pressure gain (ISO 10770-1)
    Bench(Common),
    /// Identify the coefficients of a servovalve (or frequency responses, a line, or the friction
    /// of the cylinder) from recorded tests, with confidence intervals
    Identify(IdentifyArguments),
    /// Write the controller, as it was verified, as source for the computer that runs it; an audit
    /// comes first, and its verdict is stated in every file
    #[command(mut_arg("out", |out| out.required(true)))]
    Export {
        /// Language of the files
        kind: ExportWord,
        #[command(flatten)]
        common: Common,
    },
    /// Write all results as one self-contained HTML page; a controller is designed if the project
    /// has a design section or gives no controller
    Report {
        #[command(flatten)]
        common: Common,
        /// Add a chapter on the alternatives of the project; a controller is designed for each
        #[arg(long)]
        alternatives: bool,
    },
    /// Print the script by which a shell completes commands and options
    Completions {
        /// Shell that reads the script
        shell: Shell,
    },
    /// Print the manual page of phea
    Man {
        /// Write the manual page of phea, and of each of its commands, into this folder
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Arguments of a command on several projects.
#[derive(Args, Debug)]
pub(crate) struct Several {
    /// Project files
    #[arg(required = true, num_args = 1..)]
    pub(crate) projects: Vec<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Write figures that compare the projects into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Override a value of every project, e.g. --set "supply.pressure=80 bar"; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// Catalogue file or folder to search before the built-in catalogue; may be repeated
    #[arg(long = "catalogue", value_name = "PATH")]
    pub(crate) catalogues: Vec<String>,
}

/// Certificate, and the project to compare it with.
#[derive(Debug, Args)]
pub(crate) struct Certified {
    /// Certificate to check
    pub(crate) file: PathBuf,
    /// Project to compare with the certificate: plant, box, laws and specifications must agree
    pub(crate) project: Option<PathBuf>,
    /// Override a value of the project, as `path=value`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) settings: Vec<String>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of every command on a project.
#[derive(Args, Debug)]
pub(crate) struct Common {
    /// Project file
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
    /// Catalogue file or folder to search before the built-in catalogue; may be repeated
    #[arg(long = "catalogue", value_name = "PATH")]
    pub(crate) catalogues: Vec<String>,
}

/// Arguments of `identify`.
#[derive(Args, Debug)]
pub(crate) struct IdentifyArguments {
    /// Part to identify
    #[arg(long, value_name = "WHAT", default_value = "valve")]
    pub(crate) of: SubjectWord,
    /// Tables of recorded tests, as text or Parquet; or a project whose `[[identify.recording]]`
    /// names them
    #[arg(required_unless_present = "project", num_args = 1.., value_name = "PROJECT.toml|TABLE")]
    pub(crate) files: Vec<String>,
    /// Project of the valve, with the nominal voltage and the pressures that the files lack
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
    /// Number of starting points of the search (default 6)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) starts: Option<u16>,
    /// Seed of the starting points and of the bootstrap (default 1)
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u32>,
    /// Compute intervals by a bootstrap in addition, with this number of repetitions, at least 50
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(50..=1_000_000))]
    pub(crate) bootstrap: Option<u32>,
    /// Model of the leakage, instead of the one that the recordings prefer
    #[arg(long, value_name = "MODEL")]
    pub(crate) leakage_model: Option<LeakageWord>,
    /// Period of the input of a response ("2 s"), instead of the one that is found
    #[arg(long, value_name = "TIME")]
    pub(crate) period: Option<String>,
    /// Time to discard at the beginning of a response ("1 s"); default: one period of a periodic
    /// input
    #[arg(long, value_name = "TIME")]
    pub(crate) settling: Option<String>,
    /// Length of a segment of a response ("4 s"), if its input is not periodic
    #[arg(long, value_name = "TIME", conflicts_with = "period")]
    pub(crate) segment: Option<String>,
    /// Squared coherence of a response below which a frequency is omitted (default 0.8)
    #[arg(long, value_name = "NUMBER")]
    pub(crate) coherence: Option<f64>,
    /// Chamber to which an identified line leads, A or B; default: `bench.line.side` of the
    /// project, or A
    #[arg(long, value_name = "CHAMBER", ignore_case = true)]
    pub(crate) side: Option<ChamberWord>,
}

/// A chamber of the cylinder.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum ChamberWord {
    /// Chamber at the piston side without a rod
    A,
    /// Chamber at the rod side
    B,
}

/// Subject of recorded tests.
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
    /// The part that it names.
    pub(crate) fn part(self) -> IdentifiedPart {
        match self {
            SubjectWord::Valve => IdentifiedPart::Valve,
            SubjectWord::Response => IdentifiedPart::Response,
            SubjectWord::Line => IdentifiedPart::Line,
            SubjectWord::Friction => IdentifiedPart::Friction,
        }
    }
}

/// Language of exported files.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum ExportWord {
    /// C99 with a self test
    C,
    /// Structured Text of IEC 61131-3 with a test block, portable and for TwinCAT
    St,
    /// Package of ros2_control around the C functions
    Ros2,
    /// Script for MATLAB and Octave with the plants of the family
    Matlab,
    /// Python with a self test and the plants of the family
    Python,
}

impl ExportWord {
    /// The language that it names.
    pub(crate) fn kind(self) -> ExportKind {
        match self {
            ExportWord::C => ExportKind::C,
            ExportWord::St => ExportKind::StructuredText,
            ExportWord::Ros2 => ExportKind::Ros2,
            ExportWord::Matlab => ExportKind::Matlab,
            ExportWord::Python => ExportKind::Python,
        }
    }
}

/// Model of the leakage, named as in the project file.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum LeakageWord {
    /// One secant for each edge
    #[value(name = "each_edge")]
    EachEdge,
    /// One curve for the whole valve
    #[value(name = "one_curve")]
    OneCurve,
}

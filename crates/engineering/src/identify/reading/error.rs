//! Errors of recorded tests and remarks on them, with their hints.

use crate::project::TestSignal;
use crate::quantity::{display, significant};

/// Error of a recorded test, or remark on it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum RecordedTestError {
    /// Fewer rows than a test has.
    #[error("{0} rows are too few for a test")]
    TooFewRows(usize),
    /// The file contains flows of both circuits of the ports.
    #[error("`leak_flow` is of blocked ports, `flow` of joined ones: one file holds one test")]
    TwoTests,
    /// Rows whose supply pressure is not above the tank pressure.
    #[error("the tank pressure is not below the supply pressure in {count} of {rows} rows")]
    TankAboveSupply { count: usize, rows: usize },
    /// The file contains no output of the valve.
    #[error("there is nothing but inputs: neither a flow nor the pressure of a port")]
    OnlyInputs,
    /// Joined ports lack pressures, by the names of the absent ones.
    #[error(
        "without {absent} the drop from port to port is not known and counts as zero: the flow coefficients come out too small by what the meter takes"
    )]
    UnknownDrop { absent: String },
    /// A constant command.
    #[error("the command never moves: this is not a test of a valve")]
    CommandNeverMoves,
    /// A single value is beyond the range of a test, as written.
    #[error("{written} is not a plausible {signal} of a valve test")]
    ImplausibleValue { written: String, signal: SignalInWords },
    /// The duration is longer than that of any test, s.
    #[error("`{heading}` lasts {}: no test of a valve takes that long", shown(*duration, TestSignal::Time))]
    ImplausibleDuration { heading: String, duration: f64 },
    /// Commands are beyond the nominal voltage, or far below it, V.
    #[error(
        "`{heading}` reaches {}, the nominal voltage is {}",
        shown(*reached, TestSignal::Command),
        shown(*nominal, TestSignal::Command)
    )]
    ImplausibleCommand { heading: String, reached: f64, nominal: f64 },
    /// Pressures of a port are beyond the supply, or far below it, Pa.
    #[error(
        "`{heading}` reaches {}, the supply pressure {}",
        shown(*reached, TestSignal::PressureA),
        shown(*supply, TestSignal::PressureA)
    )]
    ImplausiblePort { heading: String, reached: f64, supply: f64 },
    /// A column has values that no test reaches, SI.
    #[error(
        "`{heading}` reaches {}: that is not a plausible {} of a valve test",
        shown(*reached, *signal),
        SignalInWords::from(*signal)
    )]
    ImplausibleColumn { heading: String, reached: f64, signal: TestSignal },
    /// Flow differs from that of the declared valve: ratio of the medians.
    #[error(
        "`{heading}` is {} times the flow that the declared valve passes at these commands and pressures",
        significant(*ratio, 2)
    )]
    FlowOfOtherValve { heading: String, ratio: f64 },
    /// Negative leakage.
    #[error("{name} is negative in {count} of {rows} rows")]
    NegativeLeakage { name: String, count: usize, rows: usize },
    /// The last row ends early.
    #[error("the last row is not whole: it is left out")]
    LastRowCutOff,
    /// A row that is neither names, nor units, nor numbers.
    #[error("a row below the headings without numbers or units: it is left out")]
    RowWithoutNumbers,
    /// A column with hardly any value.
    #[error("`{heading}` has no value in {gaps} of {rows} rows")]
    MostlyGaps { heading: String, gaps: usize, rows: usize },
    /// Gaps of an input.
    #[error("`{0}` has gaps, and these rows are left out")]
    GapsLeftOut(String),
    /// Gaps of an output.
    #[error("`{0}` has gaps, where it is taken as not read")]
    GapsNotRead(String),
    /// Single rows far from their neighbours.
    #[error("`{0}` stands out of the rows before and after, and these rows are left out")]
    Outlier(String),
    /// Rows repeat others.
    #[error("rows that repeat the row before are left out")]
    Repeated,
}

/// Value of a signal, SI, with three digits.
fn shown(value: f64, signal: TestSignal) -> String {
    display(value, signal.dimension(), 3)
}

/// Name of a signal in sentences.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(super) enum SignalInWords {
    /// Pressure of the first port.
    #[error("pressure at port A")]
    PressureA,
    /// Pressure of the second port.
    #[error("pressure at port B")]
    PressureB,
    /// Flow of joined ports.
    #[error("flow between the ports")]
    PortFlow,
    /// Signal that its key names.
    #[error("{}", .0.name().replace('_', " "))]
    ByKey(TestSignal),
}

impl From<TestSignal> for SignalInWords {
    fn from(signal: TestSignal) -> SignalInWords {
        match signal {
            TestSignal::PressureA => SignalInWords::PressureA,
            TestSignal::PressureB => SignalInWords::PressureB,
            TestSignal::Flow => SignalInWords::PortFlow,
            signal => SignalInWords::ByKey(signal),
        }
    }
}

/// A signal that falls while another rises.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{signal} falls while {other} rises (correlation {correlation:.2} over {rows} rows)")]
pub(super) struct OppositeSignals {
    pub(super) signal: String,
    pub(super) other: String,
    pub(super) correlation: f64,
    pub(super) rows: usize,
}

/// Signal that may have the wrong sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum TurnedSignal {
    /// The command.
    #[error("the command is reversed")]
    Command,
    /// The flow.
    #[error("the flow meter is reversed")]
    Flow,
    /// The pressures of both ports.
    #[error("the pressures of the ports are exchanged")]
    Ports,
}

/// Setting of a column in a project.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{key} = {{ column = \"{heading}\", unit = \"{unit}\" }}`")]
pub(super) struct ColumnSetting {
    pub(super) key: &'static str,
    pub(super) heading: String,
    pub(super) unit: String,
}

/// Change of a project that reverses a signal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum SignRemedy {
    /// A signal that a project reverses.
    #[error("remove `reversed = true` of `{0}` in its `[[identify.recording]]` of a project")]
    RemoveReversed(&'static str),
    /// A signal that no project reverses.
    #[error("state `{0} = {{ reversed = true }}` in its `[[identify.recording]]` of a project")]
    StateReversed(&'static str),
    /// Exchange of the columns of the ports.
    #[error("state {} in its `[[identify.recording]]` of a project", joined(.0))]
    Exchange(Vec<ColumnSetting>),
}

fn joined(settings: &[ColumnSetting]) -> String {
    settings.iter().map(ToString::to_string).collect::<Vec<_>>().join(" and ")
}

/// Expectation or remedy next to an error of a recorded test.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum RecordedTestHint {
    /// Expectation of a file: fewest rows.
    #[error("at least {0} rows below the names of the columns")]
    AtLeastRows(usize),
    /// Remedy of two tests in a file.
    #[error("`test` in `[[identify.recording]]` of a project says which it is")]
    TestOfProject,
    /// Remedy of pressures in the wrong order.
    #[error("are the columns exchanged, or in other units than their headings say?")]
    ExchangedColumns,
    /// Remedy of an unknown drop.
    #[error(
        "record both pressures; a meter that takes a tenth of the drop makes the coefficients 5 % too small"
    )]
    BothPressures,
    /// Remedy of a command in proportion to another nominal voltage.
    #[error("state the `nominal_voltage` of the valve in a project")]
    NominalVoltage,
    /// Remedy of numbers that no unit makes plausible.
    #[error("is it the right column? `[[identify.recording]]` of a project can name another")]
    OtherColumn,
    /// Units that make the numbers plausible.
    #[error(
        "these numbers would be plausible in {units}: correct the heading, or state the unit in `[[identify.recording]]` of a project, such as {setting}"
    )]
    PlausibleUnits { units: String, setting: ColumnSetting },
    /// Unit in which the declared valve has this flow.
    #[error(
        "these numbers would fit in {}: correct the heading, or state {setting} in `[[identify.recording]]` of a project",
        setting.unit
    )]
    UnitOfDeclaredValve { setting: ColumnSetting },
    /// Remedy of a flow that no unit explains.
    #[error("is it the declared valve, with its `nominal_voltage`, and are these its units?")]
    DeclaredValve,
    /// Expectation of a leakage.
    #[error("a leakage from the supply, which is positive")]
    PositiveLeakage,
    /// Remedy of a negative leakage.
    #[error("the meter is reversed: {0}")]
    MeterReversed(SignRemedy),
    /// Expectation of blocked ports.
    #[error("a positive command opens the supply to port A, whose pressure rises")]
    RisingPressure,
    /// Expectation of joined ports.
    #[error("flow from port A to port B, and the drop across the meter, that rise with the command")]
    RisingFlowAndDrop,
    /// Expectation of joined ports without a flow that has a sign.
    #[error("a drop from port A to port B across the meter that rises with the command")]
    RisingDrop,
    /// Remedy of a column with hardly any value.
    #[error("leave the column out where nothing was recorded")]
    LeaveColumnOut,
}

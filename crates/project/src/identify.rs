//! Table `[identify]`: recorded static tests of the servovalve and the contents of their columns;
//! recordings of a line and of the cylinder.

use phea_hydraulics::servovalve::{OilLaw, PortCircuit};
use phea_quantity::{
    self as quantity, Dimension, FLOW, FORCE, PRESSURE, RATIO, TEMPERATURE, TEMPERATURE_COEFFICIENT, TIME,
    VOLTAGE,
};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Static test of ISO 10770-1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StaticTest {
    /// Ports blocked: leakage and port pressures over the command.
    Leakage,
    /// Ports joined through a meter: flow over the command.
    Metering,
    /// Ports blocked, a small command: port pressures around null.
    PressureGain,
}

impl StaticTest {
    /// All tests, in the order of ISO 10770-1.
    pub const ALL: [StaticTest; 3] = [StaticTest::Leakage, StaticTest::Metering, StaticTest::PressureGain];

    /// Name in file names.
    pub fn name(self) -> &'static str {
        match self {
            StaticTest::Leakage => "leakage",
            StaticTest::Metering => "metering",
            StaticTest::PressureGain => "pressure_gain",
        }
    }

    /// Piping of the ports.
    pub fn circuit(self) -> PortCircuit {
        match self {
            StaticTest::Leakage | StaticTest::PressureGain => PortCircuit::Blocked,
            StaticTest::Metering => PortCircuit::Connected,
        }
    }

    /// Flags for a measured leakage, and for a measured flow between the ports.
    pub fn measures_flow(self) -> [bool; 2] {
        [self == StaticTest::Leakage, self == StaticTest::Metering]
    }
}

/// Content of a column of a recorded test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestSignal {
    /// Time, s.
    Time,
    /// Command, V.
    Command,
    /// Supply pressure p_S, Pa.
    SupplyPressure,
    /// Tank pressure p_T, Pa.
    TankPressure,
    /// Pressure p_A, Pa.
    PressureA,
    /// Pressure p_B, Pa.
    PressureB,
    /// Flow from the supply with blocked ports, m³/s.
    LeakFlow,
    /// Flow from port A to port B, m³/s.
    Flow,
    /// Oil temperature, degC.
    OilTemperature,
}

impl TestSignal {
    /// All signals, in the order of columns.
    pub const ALL: [TestSignal; 9] = [
        TestSignal::Time,
        TestSignal::Command,
        TestSignal::SupplyPressure,
        TestSignal::TankPressure,
        TestSignal::PressureA,
        TestSignal::PressureB,
        TestSignal::LeakFlow,
        TestSignal::Flow,
        TestSignal::OilTemperature,
    ];

    /// Name of columns and keys.
    pub const fn name(self) -> &'static str {
        match self {
            TestSignal::Time => "time",
            TestSignal::Command => "command",
            TestSignal::SupplyPressure => "supply_pressure",
            TestSignal::TankPressure => "tank_pressure",
            TestSignal::PressureA => "pressure_a",
            TestSignal::PressureB => "pressure_b",
            TestSignal::LeakFlow => "leak_flow",
            TestSignal::Flow => "flow",
            TestSignal::OilTemperature => "oil_temperature",
        }
    }

    /// Dimension of the signal.
    pub const fn dimension(self) -> &'static Dimension {
        match self {
            TestSignal::Time => &TIME,
            TestSignal::Command => &VOLTAGE,
            TestSignal::LeakFlow | TestSignal::Flow => &FLOW,
            TestSignal::OilTemperature => &TEMPERATURE,
            _ => &PRESSURE,
        }
    }

    const fn doc(self) -> &'static str {
        match self {
            TestSignal::Time => "Column of the time.",
            TestSignal::Command => "Column of the command of the valve.",
            TestSignal::SupplyPressure => "Column of the supply pressure.",
            TestSignal::TankPressure => "Column of the tank pressure.",
            TestSignal::PressureA => "Column of the pressure at port A.",
            TestSignal::PressureB => "Column of the pressure at port B.",
            TestSignal::LeakFlow => "Column of the flow from the supply while the ports are blocked.",
            TestSignal::Flow => "Column of the flow from port A to port B.",
            TestSignal::OilTemperature => {
                "Column of the temperature of the oil, with which flow and leakage change."
            }
        }
    }
}

/// Content of a column of a record for a frequency response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResponseSignal {
    /// Time, s.
    Time,
    /// Exciting command, V.
    Command,
    /// Resulting force, N.
    Force,
    /// Reference of a closed loop, N.
    Reference,
    /// Signal added to the command of a closed loop, V.
    Excitation,
}

impl ResponseSignal {
    /// All signals, in the order of columns.
    pub const ALL: [ResponseSignal; 5] = [
        ResponseSignal::Time,
        ResponseSignal::Command,
        ResponseSignal::Force,
        ResponseSignal::Reference,
        ResponseSignal::Excitation,
    ];

    /// Name of columns and keys.
    pub const fn name(self) -> &'static str {
        match self {
            ResponseSignal::Time => "time",
            ResponseSignal::Command => "command",
            ResponseSignal::Force => "force",
            ResponseSignal::Reference => "reference",
            ResponseSignal::Excitation => "excitation",
        }
    }

    /// Dimension of the signal.
    pub const fn dimension(self) -> &'static Dimension {
        match self {
            ResponseSignal::Time => &TIME,
            ResponseSignal::Command | ResponseSignal::Excitation => &VOLTAGE,
            ResponseSignal::Force | ResponseSignal::Reference => &FORCE,
        }
    }

    const fn doc(self) -> &'static str {
        match self {
            ResponseSignal::Time => "Column of the time.",
            ResponseSignal::Command => "Column of the command that excites.",
            ResponseSignal::Force => "Column of the force that follows.",
            ResponseSignal::Reference => "Column of the reference, of a record of a closed loop.",
            ResponseSignal::Excitation => "Column of what is added to the command of a closed loop.",
        }
    }
}

/// Identified values of a valve that every command uses in place of the declared ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IdentifiedUse {
    /// No identified values: the valve is as declared.
    #[default]
    Nothing,
    /// Identified coefficients.
    Valve,
    /// Identified coefficients, and the family of their remaining uncertainty.
    ValveAndUncertainty,
}

/// Recordings from which a valve is identified.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Identify {
    /// Identified values that replace declared ones.
    pub takes: IdentifiedUse,
    /// Recorded tests, one per file.
    pub recordings: Vec<RecordedTest>,
    /// Records for frequency responses, one per file.
    pub responses: Vec<RecordedResponse>,
    /// Recordings of a blocked line, as paths relative to the project file.
    pub line: Vec<String>,
    /// Recorded runs of the cylinder, as paths relative to the project file.
    pub friction: Vec<String>,
    /// Temperature dependence of the oil in the valve's tests.
    pub oil_temperature: TestOilTemperature,
}

/// Properties of oil with recorded temperature. Units: degC, 1/degC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOilTemperature {
    /// Temperature for which the coefficients are stated; if absent, the mean of the recordings.
    pub reference: Option<f64>,
    /// Relative decrease of the dynamic viscosity per degree.
    pub viscosity_slope: f64,
    /// Relative decrease of the density per degree.
    pub density_slope: f64,
}

impl Default for TestOilTemperature {
    fn default() -> TestOilTemperature {
        let OilLaw { viscosity_slope, density_slope } = OilLaw::default();
        TestOilTemperature { reference: None, viscosity_slope, density_slope }
    }
}

impl TestOilTemperature {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let usual = TestOilTemperature::default();
        let doc = "Temperature that the coefficients are stated at; absent: the mean of the recordings.";
        v.optional(key("reference", &TEMPERATURE, doc).above(-50.0).at_most(150.0), &mut self.reference);
        let doc = "Share by which the dynamic viscosity falls with each degree.";
        let k = key("viscosity_slope", &TEMPERATURE_COEFFICIENT, doc).not_negative().at_most(0.2);
        v.quantity(k.or(usual.viscosity_slope), &mut self.viscosity_slope);
        let doc = "Share by which the density falls with each degree.";
        let k = key("density_slope", &TEMPERATURE_COEFFICIENT, doc).not_negative().at_most(0.004);
        v.quantity(k.or(usual.density_slope), &mut self.density_slope);
    }
}

/// File with a recorded test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedTest {
    /// Path of a table as text or Parquet, relative to the project.
    pub file: String,
    /// Test; if absent, determined by the columns.
    pub test: Option<StaticTest>,
    /// Separator of the values of a text; detected if absent.
    pub separator: Option<String>,
    /// Information that the headings lack, in the order of [`TestSignal::ALL`].
    pub columns: [Option<RecordedColumn>; 9],
}

/// File with a record for a frequency response.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedResponse {
    /// Path of a table as text or Parquet, relative to the project.
    pub file: String,
    /// Separator of the values of a text; detected if absent.
    pub separator: Option<String>,
    /// Information that the headings lack, in the order of [`ResponseSignal::ALL`].
    pub columns: [Option<RecordedColumn>; 5],
    /// Loop during the test; if absent, it is tested for feedback.
    pub recorded_loop: Option<RecordedLoop>,
    /// Controller of a closed loop; unknown if absent.
    pub recorded_controller: Option<RecordedController>,
    /// Name of the operating point; if absent, the record is not compared with others.
    pub operating_point: Option<String>,
}

/// Controller that acted during a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedController {
    /// Controller of `[controller]`.
    Declared,
}

/// Loop around the plant during a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedLoop {
    /// Open loop: no controller acted on the output.
    Open,
    /// Closed loop.
    Closed,
}

/// Column of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedColumn {
    /// Heading; if absent, the name of the signal.
    pub column: Option<String>,
    /// Unit; if absent, that of the heading.
    pub unit: Option<String>,
    /// True if the signal is the column with the opposite sign.
    pub reversed: bool,
    /// Accuracy of the instrument as written; exact if absent.
    pub accuracy: Option<String>,
}

/// Possible constant error of an instrument during a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// Fraction of the reading.
    OfReading(f64),
    /// Error in the unit of the signal: at zero, and again at its greatest reading.
    OfRange(f64),
}

impl RecordedColumn {
    /// Accuracy of the instrument; `None` if none is stated, or none that can be read.
    pub fn stated_accuracy(&self, dimension: &Dimension) -> Option<Accuracy> {
        let text = self.accuracy.as_ref()?;
        let fraction = || quantity::parse(text, &RATIO).ok().map(Accuracy::OfReading);
        if text.trim_end().ends_with('%') {
            return fraction();
        }
        quantity::parse(text, dimension).ok().map(Accuracy::OfRange).or_else(fraction)
    }
}

impl Identify {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[
            ("nothing", IdentifiedUse::Nothing),
            ("valve", IdentifiedUse::Valve),
            ("valve_and_uncertainty", IdentifiedUse::ValveAndUncertainty),
        ];
        let doc =
            "What every command takes from the recordings in place of what is declared; absent: nothing.";
        v.choice(plain("use", doc), words, &mut self.takes, false);
        let k = plain("recording", "Recorded static tests of the servovalve, one in a file.");
        v.tables(k, &mut self.recordings, RecordedTest::visit);
        let k = plain("response", "Records for frequency responses, one in a file, for `--of response`.");
        v.tables(k, &mut self.responses, RecordedResponse::visit);
        let k = plain("line", "Recordings of a line whose far end is blocked, for `--of line`.");
        v.texts(k, &mut self.line);
        let k = plain("friction", "Recorded runs of the cylinder, for `--of friction`.");
        v.texts(k, &mut self.friction);
        let k = plain("oil_temperature", "How the oil of the valve's tests changes with its temperature.");
        v.table_or_default(k, &mut self.oil_temperature, TestOilTemperature::visit);
    }
}

impl RecordedTest {
    /// File with complete headings.
    pub fn of(file: &str) -> RecordedTest {
        RecordedTest { file: file.to_string(), ..RecordedTest::default() }
    }

    /// Declared properties of a signal's column.
    pub fn column(&self, signal: TestSignal) -> Option<&RecordedColumn> {
        let all = TestSignal::ALL.iter().zip(&self.columns);
        all.filter(|(one, _)| **one == signal).find_map(|(_, column)| column.as_ref())
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut file = Some(std::mem::take(&mut self.file));
        v.text(plain("file", "A table as text or Parquet, relative to this file."), &mut file, true);
        self.file = file.unwrap_or_default();
        let words = &[
            ("leakage", Some(StaticTest::Leakage)),
            ("metering", Some(StaticTest::Metering)),
            ("pressure_gain", Some(StaticTest::PressureGain)),
        ];
        v.choice(plain("test", "Which test; absent: as the columns say."), words, &mut self.test, false);
        let k = plain("separator", "What separates the values of a text; absent: it is found.");
        v.text(k, &mut self.separator, false);
        for (signal, column) in TestSignal::ALL.into_iter().zip(&mut self.columns) {
            v.table(plain(signal.name(), signal.doc()), column, RecordedColumn::visit);
        }
    }
}

impl RecordedResponse {
    /// File with complete headings.
    pub fn of(file: &str) -> RecordedResponse {
        RecordedResponse { file: file.to_string(), ..RecordedResponse::default() }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut file = Some(std::mem::take(&mut self.file));
        v.text(plain("file", "A table as text or Parquet, relative to this file."), &mut file, true);
        self.file = file.unwrap_or_default();
        let k = plain("separator", "What separates the values of a text; absent: it is found.");
        v.text(k, &mut self.separator, false);
        let words = &[("open", Some(RecordedLoop::Open)), ("closed", Some(RecordedLoop::Closed))];
        let doc = "The loop while the record was made; absent: closed where the file has a reference, otherwise tested for feedback.";
        v.choice(plain("loop", doc), words, &mut self.recorded_loop, false);
        let words = &[("declared", Some(RecordedController::Declared))];
        let doc = "The controller of a closed loop whose reference was not recorded: `declared`, that of [controller]; absent: not known.";
        v.choice(plain("controller", doc), words, &mut self.recorded_controller, false);
        let doc = "A name of the operating point, such as \"70 bar, middle of the stroke\": records of one name that differ in amplitude are compared; absent: not compared.";
        v.text(plain("operating_point", doc), &mut self.operating_point, false);
        for (signal, column) in ResponseSignal::ALL.into_iter().zip(&mut self.columns) {
            v.table(plain(signal.name(), signal.doc()), column, RecordedColumn::visit);
        }
    }
}

impl RecordedColumn {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.text(plain("column", "Its heading; absent: the name of the signal."), &mut self.column, false);
        v.text(plain("unit", "Its unit; absent: as the heading says."), &mut self.unit, false);
        let k = plain("reversed", "Read with the opposite sign; absent: as written.");
        v.flag(k, &mut self.reversed);
        let doc = "What the instrument may be wrong by, of its reading or in its unit; absent: nothing.";
        v.text(plain("accuracy", doc), &mut self.accuracy, false);
    }
}

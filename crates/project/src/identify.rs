//! `[identify]`: recorded static tests of the servovalve and what their columns hold; recordings of
//! a line and of the cylinder.

use super::key::{key, plain};
use super::visitor::Visitor;
use phea_hydraulics::servovalve::{OilLaw, PortCircuit};
use phea_quantity::{
    self as quantity, Dimension, FLOW, FORCE, PRESSURE, RATIO, TEMPERATURE, TEMPERATURE_COEFFICIENT, TIME,
    VOLTAGE,
};

/// One of the static tests of ISO 10770-1.
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
    /// All, in the order of ISO 10770-1.
    pub const ALL: [StaticTest; 3] = [StaticTest::Leakage, StaticTest::Metering, StaticTest::PressureGain];

    /// As files are called.
    pub fn name(self) -> &'static str {
        match self {
            StaticTest::Leakage => "leakage",
            StaticTest::Metering => "metering",
            StaticTest::PressureGain => "pressure_gain",
        }
    }

    /// How the ports are piped.
    pub fn circuit(self) -> PortCircuit {
        match self {
            StaticTest::Leakage | StaticTest::PressureGain => PortCircuit::Blocked,
            StaticTest::Metering => PortCircuit::Connected,
        }
    }

    /// True if the leakage is measured, and the flow between the ports.
    pub fn measures_flow(self) -> [bool; 2] {
        [self == StaticTest::Leakage, self == StaticTest::Metering]
    }
}

/// What a column of a recorded test holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestSignal {
    /// s.
    Time,
    /// V.
    Command,
    /// Pa, p_S.
    SupplyPressure,
    /// Pa, p_T.
    TankPressure,
    /// Pa, p_A.
    PressureA,
    /// Pa, p_B.
    PressureB,
    /// m³/s, from the supply, ports blocked.
    LeakFlow,
    /// m³/s, from port A to port B.
    Flow,
    /// degC, of the oil.
    OilTemperature,
}

impl TestSignal {
    /// All, in the order of columns.
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

    /// As columns and keys call it.
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

    /// What it measures.
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

/// What a column of a record for a frequency response holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResponseSignal {
    /// s.
    Time,
    /// V, what excites.
    Command,
    /// N, what follows.
    Force,
    /// N, what a closed loop is to follow.
    Reference,
    /// V, what is added to the command of a closed loop.
    Excitation,
}

impl ResponseSignal {
    /// All, in the order of columns.
    pub const ALL: [ResponseSignal; 5] = [
        ResponseSignal::Time,
        ResponseSignal::Command,
        ResponseSignal::Force,
        ResponseSignal::Reference,
        ResponseSignal::Excitation,
    ];

    /// As columns and keys call it.
    pub const fn name(self) -> &'static str {
        match self {
            ResponseSignal::Time => "time",
            ResponseSignal::Command => "command",
            ResponseSignal::Force => "force",
            ResponseSignal::Reference => "reference",
            ResponseSignal::Excitation => "excitation",
        }
    }

    /// What it measures.
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

/// What of an identified valve every command takes in place of what the project declares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IdentifiedUse {
    /// Nothing: the valve is as declared.
    #[default]
    Nothing,
    /// Its coefficients.
    Valve,
    /// Its coefficients, and the family of what the recordings leave uncertain of them.
    ValveAndUncertainty,
}

/// What a valve is identified from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Identify {
    /// What takes the place of what is declared.
    pub takes: IdentifiedUse,
    /// Recorded tests, one in a file.
    pub recordings: Vec<RecordedTest>,
    /// Records for frequency responses, one in a file.
    pub responses: Vec<RecordedResponse>,
    /// Recordings of a blocked line, as paths relative to the project file.
    pub line: Vec<String>,
    /// Recorded runs of the cylinder, as paths relative to the project file.
    pub friction: Vec<String>,
    /// How the oil of the valve's tests changes with its temperature.
    pub oil_temperature: TestOilTemperature,
}

/// What is known of the oil whose temperature is recorded. Units: degC, 1/degC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOilTemperature {
    /// That the coefficients are to be stated at; absent: the mean of the recordings.
    pub reference: Option<f64>,
    /// Share by which the dynamic viscosity falls with each degree.
    pub viscosity_slope: f64,
    /// Share by which the density falls with each degree.
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

/// A file with a recorded test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedTest {
    /// A table as text or Parquet, relative to the project.
    pub file: String,
    /// Which test; absent: as the columns say.
    pub test: Option<StaticTest>,
    /// What separates the values of a text; absent: it is found.
    pub separator: Option<String>,
    /// What the headings do not say, in the order of [`TestSignal::ALL`].
    pub columns: [Option<RecordedColumn>; 9],
}

/// A file with a record for a frequency response.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedResponse {
    /// A table as text or Parquet, relative to the project.
    pub file: String,
    /// What separates the values of a text; absent: it is found.
    pub separator: Option<String>,
    /// What the headings do not say, in the order of [`ResponseSignal::ALL`].
    pub columns: [Option<RecordedColumn>; 5],
    /// The loop during the test; absent: it is tested for feedback.
    pub recorded_loop: Option<RecordedLoop>,
    /// The controller of a closed loop; absent: it is not known.
    pub recorded_controller: Option<RecordedController>,
    /// Name of the operating point; absent: the record is not compared with others.
    pub operating_point: Option<String>,
}

/// The controller that acted while a record was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedController {
    /// The one of `[controller]`.
    Declared,
}

/// The loop around the plant while a record was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedLoop {
    /// No controller acted on the output.
    Open,
    /// A controller did.
    Closed,
}

/// A column of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedColumn {
    /// Its heading; absent: the name of the signal.
    pub column: Option<String>,
    /// Its unit; absent: as the heading says.
    pub unit: Option<String>,
    /// The signal is its numbers with the opposite sign.
    pub reversed: bool,
    /// What the instrument may be wrong by, as it was written; absent: nothing.
    pub accuracy: Option<String>,
}

/// What an instrument may be wrong by throughout a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// A share of what it reads.
    OfReading(f64),
    /// In the unit of the signal: at zero, and again at its greatest reading.
    OfRange(f64),
}

impl RecordedColumn {
    /// What the instrument may be wrong by; `None` where nothing is said, or nothing that can be
    /// read.
    pub fn stated_accuracy(&self, dimension: &Dimension) -> Option<Accuracy> {
        let text = self.accuracy.as_ref()?;
        let share = || quantity::parse(text, &RATIO).ok().map(Accuracy::OfReading);
        if text.trim_end().ends_with('%') {
            return share();
        }
        quantity::parse(text, dimension).ok().map(Accuracy::OfRange).or_else(share)
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
    /// A file whose headings say everything.
    pub fn of(file: &str) -> RecordedTest {
        RecordedTest { file: file.to_string(), ..RecordedTest::default() }
    }

    /// What the project says of a signal's column.
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
    /// A file whose headings say everything.
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

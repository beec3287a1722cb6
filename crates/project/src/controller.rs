//! Tables `[controller]` and `[prefilter]`.

mod element;
mod impedance;
mod pressure_feedback;
mod rational_function;

pub use element::{DeclaredElement, ElementKind};
pub use impedance::{DeclaredImpedance, ImpedanceForm};
pub(crate) use pressure_feedback::GAIN as GAIN_OF_PRESSURES;
pub use pressure_feedback::{DeclaredPressureFeedback, PressureSignal};
pub use rational_function::RationalFunction;

use super::reader::Reader;
use super::text::Findings;
use super::tree::TreeNode;
use crate::catalogue_entry::Catalogue;
use phea_dynamics::controller::{AntiWindup, CoefficientFormat};
use phea_dynamics::linear::Discretization;
use phea_quantity::{ANGULAR_FREQUENCY, FORCE, RATIO, TIME, VOLTAGE, VOLTAGE_PER_VELOCITY};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Transfer function: a ratio of polynomials, or elements in series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transfer {
    /// Ratio; empty if it has elements.
    pub ratio: RationalFunction,
    /// Elements in series.
    pub elements: Vec<DeclaredElement>,
}

impl Transfer {
    /// Transfer function as elements in series: a ratio is one general element, with every number
    /// as written.
    ///
    /// # Example
    /// ```
    /// use phea_project::{ElementKind, RationalFunction, Transfer};
    /// let ratio = RationalFunction { gain: Some(2.0), poles: vec![[-3.0, 0.0]], ..RationalFunction::default() };
    /// let transfer = Transfer { ratio: ratio.clone(), ..Transfer::default() };
    /// let [general] = &transfer.as_elements()[..] else { panic!() };
    /// assert_eq!(general.kind, ElementKind::General(ratio));
    /// assert!(Transfer::default().as_elements().is_empty());
    /// ```
    pub fn as_elements(&self) -> Vec<DeclaredElement> {
        match self.ratio.is_stated() {
            false => self.elements.clone(),
            true => vec![DeclaredElement::new(ElementKind::General(self.ratio.clone()))],
        }
    }

    /// Transfer function in a table; other keys are ignored.
    pub fn read(table: &TreeNode, findings: &mut Findings) -> Transfer {
        let catalogue = Catalogue::default();
        let mut transfer = Transfer::default();
        transfer.visit(&mut Reader::new(table, table.place.text, &catalogue, findings));
        transfer
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.ratio.visit(v);
        v.tables(plain("elements", "Elements in series."), &mut self.elements, DeclaredElement::visit);
    }
}

/// Declared controller.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredController {
    /// Transfer function from force error to command.
    pub transfer: Transfer,
    /// Limit of the command, V (or the plant's input unit).
    pub saturation: Option<f64>,
    /// Behaviour of the integrator at the limit.
    pub anti_windup: AntiWindup,
    /// Sample time, s; continuous if absent.
    pub sample_time: Option<f64>,
    /// Computation and transport delay of the loop, s.
    pub delay: f64,
    /// Method that discretises a continuous controller.
    pub discretization: Discretization,
    /// Frequency at which Tustin's rule is exact, rad/s; if absent, zero.
    pub discretization_frequency: Option<f64>,
    /// Rounding in its computer; none if absent.
    pub quantization: Option<DeclaredQuantization>,
    /// Feed-forward of the load velocity; none if absent.
    pub load_velocity_feed_forward: Option<FeedForward>,
    /// Virtual impedance; none if absent.
    pub impedance: Option<DeclaredImpedance>,
    /// Feedback of the chambers' pressures; none if absent.
    pub pressure_feedback: Option<DeclaredPressureFeedback>,
}

/// Addition to the command for a measured velocity of the load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeedForward {
    /// Gain, V·s/m; if absent, the piston area over the flow gain of the linear model, which
    /// supplies the flow that the motion needs.
    pub gain: Option<f64>,
}

impl FeedForward {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key(
            "gain",
            &VOLTAGE_PER_VELOCITY,
            "Command per velocity of the load; absent: area over flow gain.",
        )
        .of_motion();
        v.optional(k, &mut self.gain);
    }
}

/// Rounding in the computer of a sampled controller.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredQuantization {
    /// Bits of the command converter; 0 for no rounding.
    pub command_bits: u32,
    /// Range of the command converter, V (or the plant's input unit).
    pub command_range: Option<[f64; 2]>,
    /// Bits of the measurement converter; 0 for no rounding.
    pub measurement_bits: u32,
    /// Range of the measurement converter, N (or the plant's output unit).
    pub measurement_range: Option<[f64; 2]>,
    /// Format of the coefficients.
    pub coefficients: CoefficientFormat,
    /// Allowed rms error of the force due to the rounded command, N (or the plant's output unit).
    pub allowed_force_error: Option<f64>,
    /// Allowed rms error of the command due to the rounded measurement, V (or the plant's input
    /// unit).
    pub allowed_command_error: Option<f64>,
}

impl DeclaredQuantization {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let bits = |name, doc| key(name, &RATIO, doc).not_negative().at_most(32.0).or(0.0);
        let k = bits("command_bits", "Bits of the command's converter; 0: it does not round.");
        v.count(k, &mut self.command_bits);
        v.pair(key("command_range", &VOLTAGE, "From and to."), &mut self.command_range);
        let k = bits("measurement_bits", "Bits of the measurement's converter; 0: it does not round.");
        v.count(k, &mut self.measurement_bits);
        v.pair(key("measurement_range", &FORCE, "From and to.").of_motion(), &mut self.measurement_range);
        let words = &[("f64", CoefficientFormat::Double), ("f32", CoefficientFormat::Single)];
        let k = plain("coefficients", "How the coefficients are kept.");
        v.choice(k, words, &mut self.coefficients, false);
        let doc = "What the rounded command may do to the force, rms: a specification.";
        v.optional(
            key("allowed_force_error", &FORCE, doc).of_motion().positive(),
            &mut self.allowed_force_error,
        );
        let doc = "What the rounded measurement may do to the command, rms: a specification.";
        v.optional(key("allowed_command_error", &VOLTAGE, doc).positive(), &mut self.allowed_command_error);
    }
}

impl DeclaredController {
    /// Discretisation rule, with the frequency at which it is exact.
    pub fn sampling_rule(&self) -> Discretization {
        match (self.discretization, self.discretization_frequency) {
            (Discretization::Tustin, Some(frequency_rad_per_s)) => {
                Discretization::PrewarpedTustin { frequency_rad_per_s }
            }
            (method, _) => method,
        }
    }

    /// True if it states a transfer function, and not only its timing: otherwise the controller
    /// must be designed.
    pub fn has_law(&self) -> bool {
        !self.transfer.as_elements().is_empty()
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("saturation", &VOLTAGE, "Limit of the command.").positive();
        v.optional(k, &mut self.saturation);
        let words = &[
            ("none", AntiWindup::None),
            ("back_calculation", AntiWindup::BackCalculation),
            ("clamping", AntiWindup::Clamping),
        ];
        let k = plain("anti_windup", "What happens to the integrator at the limit.");
        v.choice(k, words, &mut self.anti_windup, false);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
        let k = key("delay", &TIME, "Computation and transport delay of the loop, part of every verdict.");
        v.quantity(k.not_negative().or(0.0), &mut self.delay);
        let words = &[
            ("tustin", Discretization::Tustin),
            ("zero_order_hold", Discretization::ZeroOrderHold),
            ("matched", Discretization::Matched),
        ];
        let k = plain("discretization", "How a continuous controller becomes a sampled one.");
        v.choice(k, words, &mut self.discretization, false);
        let doc = "Frequency at which `tustin` keeps the controller's response; absent: zero.";
        let k = key("discretization_frequency", &ANGULAR_FREQUENCY, doc).positive();
        v.optional(k, &mut self.discretization_frequency);
        let k = plain("quantization", "What the computer of a sampled controller rounds.");
        v.table(k, &mut self.quantization, DeclaredQuantization::visit);
        let k = plain("load_velocity_feed_forward", "What is added to the command for a load that moves.");
        v.table(k, &mut self.load_velocity_feed_forward, FeedForward::visit);
        let k = plain("impedance", "The impedance that the loop gives the load.");
        v.table(k, &mut self.impedance, DeclaredImpedance::visit);
        let k = plain("pressure_feedback", "What is subtracted from the command for the pressures: damping.");
        v.table(k, &mut self.pressure_feedback, DeclaredPressureFeedback::visit);
    }
}

/// Declared prefilter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prefilter {
    /// Transfer function from reference to filtered reference.
    pub transfer: Transfer,
    /// Sample time, s; continuous if absent.
    pub sample_time: Option<f64>,
    /// True if it acts in continuous time although the controller is sampled.
    pub continuous: bool,
}

impl Prefilter {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
        let k = plain(
            "continuous",
            "Whether it acts in continuous time, on the reference before a sampled controller takes it.",
        );
        v.flag(k, &mut self.continuous);
    }
}

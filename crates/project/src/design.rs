//! Table `[design]`: the design of a controller.

use super::controller::DeclaredElement;
use phea_dynamics::controller::{NamedStructure, Objective};
use phea_quantity::{ANGULAR_FREQUENCY, GAIN, RATIO, TIME};
use phea_table::{Variants, Visitor};
use phea_table::{key, plain};

/// Objective of a design, and the set of controllers.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredDesign {
    /// Quantity that is minimised or maximised.
    pub objective: Objective,
    /// Largest number of poles of the controller.
    pub maximum_order: u32,
    /// Largest number of poles of the prefilter; 0 for no prefilter design.
    pub prefilter_maximum_order: u32,
    /// Seed of the random starting points.
    pub seed: u32,
    /// Defaults of limits that are not stated.
    pub limits: UnstatedLimits,
    /// Delay that every plant must tolerate in addition to that of the loop, s; if absent, for a
    /// rig one sample, or half a millisecond in a continuous loop.
    pub minimum_delay_margin: Option<f64>,
    /// Least distance |1 + L| of every plant; if absent, 0.5 for a rig.
    pub modulus_margin: Option<f64>,
    /// Frequency from which |L/(1+L)| is at most -3 dB, rad/s; if absent, for a rig the least of
    /// the limits from quarter wave, servovalve and sampling.
    pub highest_bandwidth: Option<f64>,
    /// Largest root mean square of the command from the noise of the force sensor, over the valve's
    /// nominal voltage; if absent, 1 %.
    pub noise_to_command: Option<f64>,
    /// Least damping ratio of the controller's poles; if absent, 0.3 for a rig.
    pub pole_damping_ratio: Option<f64>,
    /// Largest |F| of the designed prefilter; if absent, 2 for a rig.
    pub prefilter_gain: Option<f64>,
    /// Largest command for a reference step of a scenario, over the valve's nominal voltage; if
    /// absent, 1 for a rig.
    pub command_of_steps: Option<f64>,
    /// Factor of reserve for every limit, in addition to the tolerance; if absent, the uncertainty
    /// from the recordings of an identified valve.
    pub reserve: Option<f64>,
    /// Least and greatest gain of `structure`; both negative for a controller of negative sign.
    pub gain: Option<[f64; 2]>,
    /// Structures that are tested, unless `structure` contains factors.
    pub structure_choice: StructureChoice,
    /// Factors of the controller.
    pub structure: Vec<StructurePart>,
    /// Source of the feedback of the chambers' pressures.
    pub pressure_feedback: FeedbackChoice,
    /// Factor by which each further pole must reduce the noise of the command, or the objective,
    /// for a longer structure to replace a feasible one; if absent, 2, which is 6 dB.
    pub earned_per_pole: Option<f64>,
}

/// Limits on the controller in effect if the project states none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnstatedLimits {
    /// Default limits of a rig.
    #[default]
    Default,
    /// No limits: a design has only its specifications.
    None,
}

/// Source of the feedback of the chambers' pressures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FeedbackChoice {
    /// Feedback of the declared controller, if it has one.
    #[default]
    AsDeclared,
    /// Feedback whose gain and high-pass corner are found before the loop.
    Free,
}

/// Structures that are tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StructureChoice {
    /// Named structures, the shortest first, then structures of growing order.
    #[default]
    Any,
    /// Structures of growing order only.
    Free,
    /// Single named structure.
    Named(NamedStructure),
}

/// Words of `structure`.
pub static STRUCTURES: [(&str, StructureChoice); 11] = [
    ("any", StructureChoice::Any),
    ("p", StructureChoice::Named(NamedStructure::Proportional)),
    ("i", StructureChoice::Named(NamedStructure::Integral)),
    ("pi", StructureChoice::Named(NamedStructure::ProportionalIntegral)),
    ("pi_low_pass", StructureChoice::Named(NamedStructure::PiLowPass)),
    ("pid", StructureChoice::Named(NamedStructure::Pid)),
    ("pi_notch", StructureChoice::Named(NamedStructure::PiNotch)),
    ("pi_notch_low_pass", StructureChoice::Named(NamedStructure::PiNotchLowPass)),
    ("pi_notch_lead", StructureChoice::Named(NamedStructure::PiNotchLead)),
    ("pi_two_notches", StructureChoice::Named(NamedStructure::PiTwoNotches)),
    ("free", StructureChoice::Free),
];

/// Words of `objective`.
pub static DESIGN_OBJECTIVES: [(&str, Objective); 3] = [
    ("least_high_frequency_gain", Objective::LeastHighFrequencyGain),
    ("least_bandwidth", Objective::LeastBandwidth),
    ("best_worst_margin", Objective::BestWorstMargin),
];

/// Factor of a structure. Every free number has its least and greatest value, frequencies in rad/s;
/// if absent, a wide range around the design frequencies.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StructurePart {
    /// 1/s.
    #[default]
    Integrator,
    /// s/z + 1.
    Zero {
        /// z.
        frequency: Option<[f64; 2]>,
    },
    /// 1/(s/p + 1).
    Pole {
        /// p.
        frequency: Option<[f64; 2]>,
    },
    /// s²/ω² + 2ζs/ω + 1.
    ZeroPair {
        /// ω.
        frequency: Option<[f64; 2]>,
        /// ζ, two real roots from 1 on.
        damping_ratio: Option<[f64; 2]>,
    },
    /// 1/(s²/ω² + 2ζs/ω + 1).
    PolePair {
        /// ω.
        frequency: Option<[f64; 2]>,
        /// ζ, two real roots from 1 on.
        damping_ratio: Option<[f64; 2]>,
    },
    /// An element without free numbers.
    Fixed {
        /// Element as in a controller.
        element: DeclaredElement,
    },
}

/// Largest number of poles that are tested.
const MAXIMUM_ORDER: f64 = 20.0;

impl Default for DeclaredDesign {
    fn default() -> DeclaredDesign {
        DeclaredDesign {
            objective: Objective::default(),
            maximum_order: 4,
            prefilter_maximum_order: 3,
            seed: 1,
            limits: UnstatedLimits::Default,
            minimum_delay_margin: None,
            modulus_margin: None,
            highest_bandwidth: None,
            noise_to_command: None,
            pole_damping_ratio: None,
            prefilter_gain: None,
            command_of_steps: None,
            reserve: None,
            gain: None,
            structure_choice: StructureChoice::Any,
            structure: vec![],
            pressure_feedback: FeedbackChoice::AsDeclared,
            earned_per_pole: None,
        }
    }
}

impl DeclaredDesign {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("objective", "What is minimised or maximised.");
        v.choice(k, &DESIGN_OBJECTIVES, &mut self.objective, false);
        let k = key("maximum_order", &RATIO, "Most poles of the controller.").not_negative();
        v.count(k.at_most(MAXIMUM_ORDER).or(4.0), &mut self.maximum_order);
        let k = key(
            "prefilter_maximum_order",
            &RATIO,
            "Largest number of poles of the prefilter; 0: none is designed.",
        );
        v.count(k.not_negative().at_most(MAXIMUM_ORDER).or(3.0), &mut self.prefilter_maximum_order);
        let k = key("seed", &RATIO, "The seed of the random starting points.").not_negative();
        v.count(k.or(1.0), &mut self.seed);
        let words = &[("default", UnstatedLimits::Default), ("none", UnstatedLimits::None)];
        let k = plain("limits", "Whether limits that are not stated have their defaults, or none.");
        v.choice(k, words, &mut self.limits, false);
        let doc = "Delay beyond that of the loop that every plant must tolerate.";
        v.optional(key("minimum_delay_margin", &TIME, doc).not_negative(), &mut self.minimum_delay_margin);
        let k = key("modulus_margin", &RATIO, "Least |1 + L| of every plant; absent: of a rig 0.5.");
        v.optional(k.not_negative().below(1.0), &mut self.modulus_margin);
        let doc = "Where |L/(1+L)| has fallen to -3 dB; absent: what waves, valve and sampling leave.";
        let k = key("highest_bandwidth", &ANGULAR_FREQUENCY, doc).positive().or_infinite();
        v.optional(k, &mut self.highest_bandwidth);
        let doc = "Command from the sensor's noise, rms over the nominal voltage; absent: 1 %.";
        let k = key("noise_to_command", &RATIO, doc).positive().or_infinite();
        v.optional(k, &mut self.noise_to_command);
        let doc = "Least damping ratio of the controller's poles; absent: of a rig 0.3.";
        let k = key("pole_damping_ratio", &RATIO, doc).not_negative().at_most(1.0);
        v.optional(k, &mut self.pole_damping_ratio);
        let doc = "Largest gain of the designed prefilter; absent: of a rig 2.";
        let k = key("prefilter_gain", &GAIN, doc).at_least(1.0).or_infinite();
        v.optional(k, &mut self.prefilter_gain);
        let doc = "Command of the scenarios' steps over the nominal voltage; absent: of a rig 1.";
        let k = key("command_of_steps", &RATIO, doc).positive().or_infinite();
        v.optional(k, &mut self.command_of_steps);
        let doc = "Margin that the design keeps to every limit; absent: what recordings leave open.";
        v.optional(key("reserve", &GAIN, doc).at_least(1.0).at_most(2.0), &mut self.reserve);
        v.pair(key("gain", &RATIO, "Least and greatest gain of `structure`."), &mut self.gain);
        let k = plain("structure", "Which controllers are tried, by a name, or factors of one.");
        let help = "write a name, such as \"pi\", or a list of factors, such as [{ kind = \"integrator\" }]";
        let words = (&STRUCTURES[..], "a name or a list of factors", help);
        v.word_or_tables(k, words, &mut self.structure_choice, &mut self.structure, |one, v| {
            v.variant(plain("kind", "Which factor."), one, true);
        });
        let words = &[("as_declared", FeedbackChoice::AsDeclared), ("free", FeedbackChoice::Free)];
        let doc = "The controller's pressure feedback, or gain and high pass found before the loop.";
        v.choice(plain("pressure_feedback", doc), words, &mut self.pressure_feedback, false);
        let doc = "What a further pole must gain in place of a shorter structure that is met; absent: 6 dB.";
        let k = key("earned_per_pole", &GAIN, doc).at_least(1.0).or_infinite();
        v.optional(k, &mut self.earned_per_pole);
    }
}

impl Variants for StructurePart {
    const STRICT: bool = true;

    fn all(&self) -> Vec<StructurePart> {
        let (frequency, damping_ratio) = (None, None);
        vec![
            StructurePart::Integrator,
            StructurePart::Zero { frequency },
            StructurePart::Pole { frequency },
            StructurePart::ZeroPair { frequency, damping_ratio },
            StructurePart::PolePair { frequency, damping_ratio },
            StructurePart::Fixed { element: DeclaredElement::default() },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            StructurePart::Integrator => "integrator",
            StructurePart::Zero { .. } => "zero",
            StructurePart::Pole { .. } => "pole",
            StructurePart::ZeroPair { .. } => "zero_pair",
            StructurePart::PolePair { .. } => "pole_pair",
            StructurePart::Fixed { .. } => "fixed",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let corner = key("frequency", &ANGULAR_FREQUENCY, "Least and greatest corner or natural frequency.");
        match self {
            StructurePart::Integrator => {}
            StructurePart::Zero { frequency } | StructurePart::Pole { frequency } => {
                v.pair(corner.positive(), frequency);
            }
            StructurePart::ZeroPair { frequency, damping_ratio }
            | StructurePart::PolePair { frequency, damping_ratio } => {
                v.pair(corner.positive(), frequency);
                let k =
                    key("damping_ratio", &RATIO, "Least and greatest damping ratio of a pair.").positive();
                v.pair(k, damping_ratio);
            }
            StructurePart::Fixed { element } => {
                let k = plain("element", "Of a fixed factor: an element as in [controller].");
                v.needed_table(k, element, DeclaredElement::visit);
            }
        }
    }
}

//! `[design]`: how a controller is designed.

use super::controller::DeclaredElement;
use super::key::{key, plain};
use super::visitor::{Variants, Visitor};
use phea_dynamics::controller::Objective;
use phea_quantity::{ANGULAR_FREQUENCY, GAIN, RATIO, TIME};

/// What is optimised, and among which controllers.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredDesign {
    /// What is minimised or maximised.
    pub objective: Objective,
    /// Most poles of the controller.
    pub maximum_order: u32,
    /// Largest number of poles of the prefilter; 0: none is designed.
    pub prefilter_maximum_order: u32,
    /// The seed of the random starting points.
    pub seed: u32,
    /// s, which every plant must tolerate in addition to the delay of the loop.
    pub minimum_delay_margin: f64,
    /// Factor by which every limit is kept, above what counts as met; absent: what the recordings
    /// of an identified valve leave open.
    pub reserve: Option<f64>,
    /// Least and greatest gain of `structure`; both negative for a controller of negative sign.
    pub gain: Option<[f64; 2]>,
    /// The controller's factors; empty: structures of growing order are tried.
    pub structure: Vec<StructurePart>,
}

/// The words of `objective`.
pub static DESIGN_OBJECTIVES: [(&str, Objective); 3] = [
    ("least_high_frequency_gain", Objective::LeastHighFrequencyGain),
    ("least_bandwidth", Objective::LeastBandwidth),
    ("best_worst_margin", Objective::BestWorstMargin),
];

/// One factor of a structure. Every free number has its least and greatest value, frequencies in
/// rad/s; absent: wide around the design frequencies.
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
        /// As in a controller.
        element: DeclaredElement,
    },
}

/// Most poles that are tried.
const MAXIMUM_ORDER: f64 = 20.0;

impl Default for DeclaredDesign {
    fn default() -> DeclaredDesign {
        DeclaredDesign {
            objective: Objective::default(),
            maximum_order: 4,
            prefilter_maximum_order: 3,
            seed: 1,
            minimum_delay_margin: 0.0,
            reserve: None,
            gain: None,
            structure: vec![],
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
        let doc = "Delay beyond that of the loop that every plant must tolerate.";
        let k = key("minimum_delay_margin", &TIME, doc).not_negative().or(0.0);
        v.quantity(k, &mut self.minimum_delay_margin);
        let doc = "Margin that the design keeps to every limit; absent: what recordings leave open.";
        v.optional(key("reserve", &GAIN, doc).at_least(1.0).at_most(2.0), &mut self.reserve);
        v.pair(key("gain", &RATIO, "Least and greatest gain of `structure`."), &mut self.gain);
        let k = plain("structure", "Factors of the controller; absent: structures of growing order.");
        v.tables(k, &mut self.structure, |one, v| v.variant(plain("kind", "Which factor."), one, true));
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

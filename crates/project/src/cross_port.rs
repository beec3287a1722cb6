//! Table `[cross_port]`: a valve between the chambers.

use super::cost::PartCost;
use phea_quantity::{CAPACITY, FLOW, FLOW_PRESSURE_COEFFICIENT, LENGTH, PRESSURE, RATIO, STIFFNESS};
use phea_table::{Key, key, plain};
use phea_table::{Variants, Visitor};

/// Valve between the chambers, at the cylinder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredCrossPort {
    /// Kind of valve.
    pub kind: CrossPortKind,
    /// Cost and mass.
    pub cost: PartCost,
}

/// Kinds of valves between the chambers.
#[derive(Clone, Debug, PartialEq)]
pub enum CrossPortKind {
    /// Laminar: flow proportional to the pressure difference.
    Laminar {
        /// Conductance, m³/(s·Pa).
        conductance: f64,
    },
    /// Sharp edge.
    Orifice(DeclaredOrifice),
    /// Restrictor in series with a capacity.
    DynamicPressureFeedback {
        /// Restrictor.
        restrictor: DeclaredRestrictor,
        /// Capacity.
        capacity: DeclaredCapacity,
    },
}

/// Restrictor of dynamic pressure feedback.
#[derive(Clone, Debug, PartialEq)]
pub enum DeclaredRestrictor {
    /// Laminar: flow proportional to the drop.
    Laminar {
        /// Conductance, m³/(s·Pa).
        conductance: f64,
    },
    /// Sharp edge.
    Orifice(DeclaredOrifice),
}

/// Sharp edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeclaredOrifice {
    /// Size.
    pub size: OrificeSize,
    /// Pressure drop below which the square root is regularised, Pa.
    pub transition_pressure: f64,
}

/// Size of an orifice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrificeSize {
    /// Size by diameter.
    Diameter {
        /// Diameter, m.
        diameter: f64,
        /// Discharge coefficient C_d.
        discharge_coefficient: f64,
    },
    /// Size by flow.
    Flow {
        /// Flow, m³/s.
        flow: f64,
        /// Pressure drop at this flow, Pa.
        pressure_drop: f64,
    },
}

/// Capacity of dynamic pressure feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeclaredCapacity {
    /// Stated capacity, m³/Pa.
    Stated(f64),
    /// Piston between springs.
    Piston {
        /// Diameter of the piston, m.
        diameter: f64,
        /// Stiffness of all springs together, N/m.
        stiffness: f64,
    },
}

/// Discharge coefficient of a sharp edge.
const DISCHARGE_COEFFICIENT: f64 = 0.6;
/// Transition pressure as of the edges of a servovalve, Pa.
const TRANSITION_PRESSURE: f64 = 1e3;

impl Default for CrossPortKind {
    fn default() -> Self {
        CrossPortKind::Laminar { conductance: 0.0 }
    }
}

impl Default for DeclaredOrifice {
    fn default() -> Self {
        let size = OrificeSize::Diameter { diameter: 0.0, discharge_coefficient: DISCHARGE_COEFFICIENT };
        DeclaredOrifice { size, transition_pressure: TRANSITION_PRESSURE }
    }
}

impl DeclaredOrifice {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.one_of(&["diameter", "flow"], true);
        let mut parts = OrificeParts::of(Some(self));
        parts.visit(v);
        *self = parts.orifice(v).unwrap_or_default();
    }
}

impl DeclaredCrossPort {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.variant(plain("kind", "What lies between the chambers."), &mut self.kind, true);
        self.cost.visit(v);
    }

    /// Orifice of the valve, if it has one.
    pub fn orifice(&self) -> Option<&DeclaredOrifice> {
        match &self.kind {
            CrossPortKind::Orifice(orifice)
            | CrossPortKind::DynamicPressureFeedback {
                restrictor: DeclaredRestrictor::Orifice(orifice),
                ..
            } => Some(orifice),
            _ => None,
        }
    }
}

impl Variants for CrossPortKind {
    fn all(&self) -> Vec<CrossPortKind> {
        vec![
            CrossPortKind::default(),
            CrossPortKind::Orifice(DeclaredOrifice::default()),
            CrossPortKind::DynamicPressureFeedback {
                restrictor: DeclaredRestrictor::Laminar { conductance: 0.0 },
                capacity: DeclaredCapacity::Stated(0.0),
            },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            CrossPortKind::Laminar { .. } => "laminar",
            CrossPortKind::Orifice(_) => "orifice",
            CrossPortKind::DynamicPressureFeedback { .. } => "dynamic_pressure_feedback",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        match self {
            CrossPortKind::Laminar { conductance } => v.quantity(conductance_key(), conductance),
            CrossPortKind::Orifice(orifice) => {
                orifice.visit(v);
            }
            CrossPortKind::DynamicPressureFeedback { restrictor, capacity } => {
                v.one_of(&["conductance", "diameter", "flow"], true);
                restrictor.visit(v);
                v.one_of(&["piston_diameter", "capacity"], true);
                capacity.visit(v);
            }
        }
    }
}

fn conductance_key() -> Key {
    key("conductance", &FLOW_PRESSURE_COEFFICIENT, "Of a laminar restrictor: flow over the drop.").positive()
}

impl DeclaredRestrictor {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        // a conductance is positive, unless it is not read yet
        let (mut conductance, orifice) = match self {
            DeclaredRestrictor::Laminar { conductance } => {
                (Some(*conductance).filter(|value| *value > 0.0), None)
            }
            DeclaredRestrictor::Orifice(orifice) => (None, Some(&*orifice)),
        };
        let mut parts = OrificeParts::of(orifice);
        v.optional(conductance_key(), &mut conductance);
        parts.visit(v);
        *self = match (conductance, parts.orifice(v)) {
            (None, Some(orifice)) => DeclaredRestrictor::Orifice(orifice),
            (conductance, _) => DeclaredRestrictor::Laminar { conductance: conductance.unwrap_or_default() },
        };
    }
}

impl DeclaredCapacity {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let (mut capacity, mut diameter, mut stiffness) = match *self {
            DeclaredCapacity::Stated(capacity) => (Some(capacity).filter(|value| *value > 0.0), None, None),
            DeclaredCapacity::Piston { diameter, stiffness } => (None, Some(diameter), Some(stiffness)),
        };
        let k = key("piston_diameter", &LENGTH, "Of the piston between springs that takes the oil.");
        v.optional(k.positive(), &mut diameter);
        let k = key("spring_stiffness", &STIFFNESS, "Of all springs of that piston together.").positive();
        v.optional(k, &mut stiffness);
        let k = key("capacity", &CAPACITY, "Volume that it takes over its pressure difference.").positive();
        v.optional(k, &mut capacity);
        *self = match (capacity, diameter, stiffness) {
            (None, Some(diameter), Some(stiffness)) => DeclaredCapacity::Piston { diameter, stiffness },
            (None, Some(_), None) => {
                let ways = [&["piston_diameter", "spring_stiffness"][..], &["capacity"]];
                v.lacks(&ways, "`spring_stiffness`, which goes with `piston_diameter`,");
                DeclaredCapacity::Stated(0.0)
            }
            (capacity, ..) => DeclaredCapacity::Stated(capacity.unwrap_or_default()),
        };
    }
}

/// Keys of an orifice.
#[derive(Default)]
struct OrificeParts {
    diameter: Option<f64>,
    discharge_coefficient: Option<f64>,
    flow: Option<f64>,
    pressure_drop: Option<f64>,
    transition_pressure: Option<f64>,
}

impl OrificeParts {
    fn of(orifice: Option<&DeclaredOrifice>) -> OrificeParts {
        let Some(DeclaredOrifice { size, transition_pressure }) = orifice.copied() else {
            return OrificeParts::default();
        };
        let parts =
            OrificeParts { transition_pressure: Some(transition_pressure), ..OrificeParts::default() };
        match size {
            OrificeSize::Diameter { diameter: 0.0, .. } => OrificeParts::default(),
            OrificeSize::Diameter { diameter, discharge_coefficient } => OrificeParts {
                diameter: Some(diameter),
                discharge_coefficient: Some(discharge_coefficient),
                ..parts
            },
            OrificeSize::Flow { flow, pressure_drop } => {
                OrificeParts { flow: Some(flow), pressure_drop: Some(pressure_drop), ..parts }
            }
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("diameter", &LENGTH, "Diameter of the orifice.").positive();
        v.optional(k, &mut self.diameter);
        let k = key("discharge_coefficient", &RATIO, "C_d, with `diameter`; absent: 0.6, of a sharp edge.");
        v.optional(k.positive().at_most(1.0), &mut self.discharge_coefficient);
        let k = key("flow", &FLOW, "What the orifice passes at `pressure_drop`.").positive();
        v.optional(k, &mut self.flow);
        let k = key("pressure_drop", &PRESSURE, "Drop over the orifice at `flow`.").positive();
        v.optional(k, &mut self.pressure_drop);
        let k = key(
            "transition_pressure",
            &PRESSURE,
            "Drop below which the orifice is laminar, which makes its root regular; absent: 1 kPa.",
        );
        v.optional(k.positive(), &mut self.transition_pressure);
    }

    /// Orifice; `None` if nothing states its size.
    fn orifice<V: Visitor>(&self, v: &mut V) -> Option<DeclaredOrifice> {
        let size = match *self {
            OrificeParts { diameter: Some(diameter), discharge_coefficient, .. } => OrificeSize::Diameter {
                diameter,
                discharge_coefficient: discharge_coefficient.unwrap_or(DISCHARGE_COEFFICIENT),
            },
            OrificeParts { flow: Some(flow), pressure_drop: Some(pressure_drop), .. } => {
                OrificeSize::Flow { flow, pressure_drop }
            }
            OrificeParts { flow: Some(_), .. } => {
                v.lacks(
                    &[&["flow", "pressure_drop"], &["diameter"]],
                    "`pressure_drop`, at which `flow` flows,",
                );
                return None;
            }
            _ => return None,
        };
        let transition_pressure = self.transition_pressure.unwrap_or(TRANSITION_PRESSURE);
        Some(DeclaredOrifice { size, transition_pressure })
    }
}

//! Table `[cross_port]`: a valve between the chambers.

use phea_quantity::{CAPACITY, FLOW, FLOW_PRESSURE_COEFFICIENT, LENGTH, PRESSURE, RATIO, STIFFNESS};
use phea_table::{Key, PartCost, TableNumber, Variants, Visitor, key, once_read, plain};

pub(super) const CONDUCTANCE_KEY: Key =
    key("conductance", &FLOW_PRESSURE_COEFFICIENT, "Of a laminar restrictor: flow over the drop.").positive();
pub(crate) const TRANSITION_PRESSURE_KEY: Key = key(
    "transition_pressure",
    &PRESSURE,
    "Drop below which the orifice is laminar, which makes its root regular; absent: 1 kPa.",
)
.positive();
pub(super) const CAPACITY_KEY: Key =
    key("capacity", &CAPACITY, "Volume that it takes over its pressure difference.").positive();

/// Valve between the chambers, at the cylinder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredCrossPort<S = f64> {
    /// Kind of valve.
    pub kind: CrossPortKind<S>,
    /// Cost and mass.
    pub cost: PartCost<S>,
}

/// Kinds of valves between the chambers.
#[derive(Clone, Debug, PartialEq)]
pub enum CrossPortKind<S = f64> {
    /// Laminar: flow proportional to the pressure difference.
    Laminar {
        /// Conductance, m³/(s·Pa).
        conductance: S,
    },
    /// Sharp edge.
    Orifice(DeclaredOrifice<S>),
    /// Restrictor in series with a capacity.
    DynamicPressureFeedback {
        /// Restrictor.
        restrictor: DeclaredRestrictor<S>,
        /// Capacity.
        capacity: DeclaredCapacity<S>,
    },
}

/// Restrictor of dynamic pressure feedback.
#[derive(Clone, Debug, PartialEq)]
pub enum DeclaredRestrictor<S = f64> {
    /// Laminar: flow proportional to the drop.
    Laminar {
        /// Conductance, m³/(s·Pa).
        conductance: S,
    },
    /// Sharp edge.
    Orifice(DeclaredOrifice<S>),
}

/// Sharp edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredOrifice<S = f64> {
    /// Size.
    pub size: OrificeSize<S>,
    /// Pressure drop below which the square root is regularised, Pa.
    pub transition_pressure: S,
}

/// Size of an orifice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrificeSize<S = f64> {
    /// Size by diameter.
    Diameter {
        /// Diameter, m.
        diameter: S,
        /// Discharge coefficient C_d.
        discharge_coefficient: S,
    },
    /// Size by flow.
    Flow {
        /// Flow, m³/s.
        flow: S,
        /// Pressure drop at this flow, Pa.
        pressure_drop: S,
    },
}

/// Capacity of dynamic pressure feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeclaredCapacity<S = f64> {
    /// Stated capacity, m³/Pa.
    Stated(S),
    /// Piston between springs.
    Piston {
        /// Diameter of the piston, m.
        diameter: S,
        /// Stiffness of all springs together, N/m.
        stiffness: S,
    },
}

/// Discharge coefficient of a sharp edge.
const DISCHARGE_COEFFICIENT: f64 = 0.6;
/// Transition pressure as of the edges of a servovalve, Pa.
const TRANSITION_PRESSURE: f64 = 1e3;

impl<S: Default> Default for CrossPortKind<S> {
    fn default() -> Self {
        CrossPortKind::Laminar { conductance: S::default() }
    }
}

impl<S: Default> Default for OrificeSize<S> {
    fn default() -> Self {
        OrificeSize::Diameter { diameter: S::default(), discharge_coefficient: S::default() }
    }
}

impl<S: TableNumber> DeclaredOrifice<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.one_of(&["diameter", "flow"], true);
        let mut parts = OrificeParts::of(Some(self));
        parts.visit(v);
        *self = parts.orifice(v).unwrap_or_default();
    }
}

impl DeclaredCrossPort {
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

impl<S: TableNumber> DeclaredCrossPort<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("kind", "What lies between the chambers."), &mut self.kind, true);
        self.cost.visit(v);
    }
}

impl<S: TableNumber> Variants<S> for CrossPortKind<S> {
    fn all(&self) -> Vec<CrossPortKind<S>> {
        vec![
            CrossPortKind::default(),
            CrossPortKind::Orifice(DeclaredOrifice::default()),
            CrossPortKind::DynamicPressureFeedback {
                restrictor: DeclaredRestrictor::Laminar { conductance: S::default() },
                capacity: DeclaredCapacity::Stated(S::default()),
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

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            CrossPortKind::Laminar { conductance } => v.quantity(CONDUCTANCE_KEY, conductance),
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

impl<S: TableNumber> DeclaredRestrictor<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let (mut conductance, orifice) = match self {
            DeclaredRestrictor::Laminar { conductance } => (once_read(*conductance), None),
            DeclaredRestrictor::Orifice(orifice) => (None, Some(&*orifice)),
        };
        let mut parts = OrificeParts::of(orifice);
        v.optional(CONDUCTANCE_KEY, &mut conductance);
        parts.visit(v);
        *self = match (conductance, parts.orifice(v)) {
            (None, Some(orifice)) => DeclaredRestrictor::Orifice(orifice),
            (conductance, _) => DeclaredRestrictor::Laminar { conductance: conductance.unwrap_or_default() },
        };
    }
}

impl<S: TableNumber> DeclaredCapacity<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let (mut capacity, mut diameter, mut stiffness) = match *self {
            DeclaredCapacity::Stated(capacity) => (once_read(capacity), None, None),
            DeclaredCapacity::Piston { diameter, stiffness } => (None, Some(diameter), Some(stiffness)),
        };
        let k = key("piston_diameter", &LENGTH, "Of the piston between springs that takes the oil.");
        v.optional(k.positive(), &mut diameter);
        let k = key("spring_stiffness", &STIFFNESS, "Of all springs of that piston together.").positive();
        v.optional(k, &mut stiffness);
        v.optional(CAPACITY_KEY, &mut capacity);
        *self = match (capacity, diameter, stiffness) {
            (None, Some(diameter), Some(stiffness)) => DeclaredCapacity::Piston { diameter, stiffness },
            (None, Some(_), None) => {
                let ways = [&["piston_diameter", "spring_stiffness"][..], &["capacity"]];
                v.lacks(&ways, "`spring_stiffness`, which goes with `piston_diameter`,");
                DeclaredCapacity::Stated(S::default())
            }
            (capacity, ..) => DeclaredCapacity::Stated(capacity.unwrap_or_default()),
        };
    }
}

/// Keys of an orifice.
#[derive(Default)]
struct OrificeParts<S = f64> {
    diameter: Option<S>,
    discharge_coefficient: Option<S>,
    flow: Option<S>,
    pressure_drop: Option<S>,
    transition_pressure: Option<S>,
}

impl<S: TableNumber> OrificeParts<S> {
    fn of(orifice: Option<&DeclaredOrifice<S>>) -> OrificeParts<S> {
        let Some(DeclaredOrifice { size, transition_pressure }) = orifice.copied() else {
            return OrificeParts::default();
        };
        let parts =
            OrificeParts { transition_pressure: Some(transition_pressure), ..OrificeParts::default() };
        match size {
            OrificeSize::Diameter { diameter, .. } if once_read(diameter).is_none() => {
                OrificeParts::default()
            }
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
}

impl<S: TableNumber> OrificeParts<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("diameter", &LENGTH, "Diameter of the orifice.").positive();
        v.optional(k, &mut self.diameter);
        let k = key("discharge_coefficient", &RATIO, "C_d, with `diameter`; absent: 0.6, of a sharp edge.");
        v.optional(k.positive().at_most(1.0), &mut self.discharge_coefficient);
        let k = key("flow", &FLOW, "What the orifice passes at `pressure_drop`.").positive();
        v.optional(k, &mut self.flow);
        let k = key("pressure_drop", &PRESSURE, "Drop over the orifice at `flow`.").positive();
        v.optional(k, &mut self.pressure_drop);
        v.optional(TRANSITION_PRESSURE_KEY, &mut self.transition_pressure);
    }

    /// Orifice; `None` if nothing states its size.
    fn orifice<V: Visitor<S>>(&self, v: &mut V) -> Option<DeclaredOrifice<S>> {
        let size = match *self {
            OrificeParts { diameter: Some(diameter), discharge_coefficient, .. } => OrificeSize::Diameter {
                diameter,
                discharge_coefficient: discharge_coefficient.unwrap_or(S::from(DISCHARGE_COEFFICIENT)),
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
        let transition_pressure = self.transition_pressure.unwrap_or(S::from(TRANSITION_PRESSURE));
        Some(DeclaredOrifice { size, transition_pressure })
    }
}

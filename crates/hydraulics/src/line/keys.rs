//! Tables `[line]`, `[line.a]` and `[line.b]`.

use super::motion_keys::LineMotion;
use crate::accumulator::DeclaredAccumulator;
use crate::line::Stiffening;
use phea_quantity::{DENSITY, EXPANSION_SLOPE, LENGTH, PRESSURE, RATIO, VOLUME, VOLUME_PER_LENGTH};
use phea_table::{CatalogueKind, DeclaredMisfit, Key, Kinds, LineCost, TableNumber, Visitor, key, plain};

pub(super) const HOSE_BORE: Key =
    key("bore", &LENGTH, "Inner diameter of the hose.").positive().usual(0.003, 0.08, "hoses");
pub(super) const PIPE_BORE: Key = key("bore", &LENGTH, "Inner diameter of the pipe.").positive();
pub(super) const EXPANSION_SLOPE_KEY: Key =
    key("volumetric_expansion_slope", &EXPANSION_SLOPE, "Slope of the expansion over pressure.").positive();
pub(super) const WALL_THICKNESS_KEY: Key =
    key("wall_thickness", &LENGTH, "Thickness of the wall; absent: the wall is rigid.").positive();
pub(super) const YOUNGS_MODULUS_KEY: Key =
    key("youngs_modulus", &PRESSURE, "Young's modulus of the wall.").positive();
pub(super) const POISSON_RATIO_KEY: Key =
    key("poisson_ratio", &RATIO, "Poisson's ratio of the wall.").not_negative().below(0.5).or(0.3);
pub(super) const VOLUME_KEY: Key = key(
    "volume",
    &VOLUME,
    "Volume of the line, instead of a hose or pipe; zero: the valve is on the chamber.",
)
.not_negative()
.usual(1e-6, 0.05, "lines");
pub(super) const EFFECTIVE_BULK_MODULUS_KEY: Key =
    key("effective_bulk_modulus", &PRESSURE, "Effective bulk modulus that goes with `volume`.").positive();

/// Modulus of the fluid in the cylinder's chambers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StiffnessModel {
    /// Effective modulus of the line for both line and chamber (the thesis).
    Uniform,
    /// Modulus of the fluid for the chamber, and the line's compliance by its data sheet.
    #[default]
    ByVolume,
}

/// Lines between the valve and the chambers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredLines<S = f64> {
    /// Volume to which the line's effective bulk modulus applies.
    pub compliance: StiffnessModel,
    /// Line to chamber A.
    pub a: DeclaredLine<S>,
    /// Line to chamber B.
    pub b: DeclaredLine<S>,
}

/// Single line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredLine<S = f64> {
    /// Component of the line.
    pub component: Component<S>,
    /// Ratio r_β of dynamic to static modulus of the hose.
    pub dynamic_stiffening: Option<Stiffening<S>>,
    /// Dynamic model.
    pub motion: LineMotion<S>,
    /// Accumulator at its chamber end.
    pub accumulator: Option<DeclaredAccumulator<S>>,
    /// Residual of the recordings from which it was identified.
    pub misfit: Option<DeclaredMisfit<S>>,
}

/// Component of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Component<S = f64> {
    /// Hose with volumetric expansion.
    Hose {
        /// Name of the catalogue's hose, if it is from there.
        name: Option<String>,
        /// Data of the hose, from the catalogue or stated here.
        properties: HoseProperties<S>,
        /// Length of this one line, m.
        length: S,
    },
    /// Pipe.
    Pipe {
        /// Dimensions and wall.
        pipe: DeclaredPipe<S>,
        /// Length of this one line, m.
        length: S,
    },
    /// Volume stated directly.
    Volume(LineVolume<S>),
}

/// Volume with its modulus.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineVolume<S = f64> {
    /// Volume, m³.
    pub volume: S,
    /// Effective bulk modulus, Pa.
    pub effective_bulk_modulus: S,
}

/// Data of a hose.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HoseProperties<S = f64> {
    /// Inner diameter of the hose, m.
    pub bore: S,
    /// Volumetric expansion under pressure.
    pub expansion: HoseExpansion<S>,
    /// Minimum bend radius, m.
    pub minimum_bend_radius: Option<S>,
    /// Working pressure, Pa.
    pub working_pressure: Option<S>,
    /// Burst pressure, Pa.
    pub burst_pressure: Option<S>,
    /// Cost and mass.
    pub cost: LineCost<S>,
}

/// Volumetric expansion of a hose under pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HoseExpansion<S = f64> {
    /// Expansion by its slope.
    Slope {
        /// Slope, m³/(m·Pa).
        slope: S,
        /// Measured value, if stated, m³/m.
        measured: Option<S>,
        /// Pressure of the measurement, Pa.
        pressure: Option<S>,
    },
    /// Expansion from the measured value, on a straight line through zero.
    Measured {
        /// Measured value, m³/m.
        measured: S,
        /// Pressure of the measurement, Pa.
        pressure: S,
    },
}

/// Pipe with an elastic wall.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredPipe<S = f64> {
    /// Name of the catalogue's pipe, if it is from there.
    pub model: Option<String>,
    /// Inner diameter, m.
    pub bore: S,
    /// Data of the wall; rigid if absent.
    pub wall: Option<ElasticWall<S>>,
    /// Poisson's ratio of the wall.
    pub poisson_ratio: S,
    /// Outer diameter, m.
    pub outer_diameter: Option<S>,
    /// Working pressure, Pa.
    pub working_pressure: Option<S>,
    /// Burst pressure, Pa.
    pub burst_pressure: Option<S>,
    /// Cost and mass.
    pub cost: LineCost<S>,
}

/// Elastic wall of a pipe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElasticWall<S = f64> {
    /// Thickness, m.
    pub thickness: S,
    /// Young's modulus, Pa.
    pub youngs_modulus: S,
    /// Density, from which the mass follows, kg/m³.
    pub density: Option<S>,
}

impl<S: Default> Default for Component<S> {
    fn default() -> Self {
        Component::Volume(LineVolume::default())
    }
}

impl<S: Default> Default for HoseExpansion<S> {
    fn default() -> Self {
        HoseExpansion::Slope { slope: S::default(), measured: None, pressure: None }
    }
}

impl DeclaredLine {
    /// Possible components of a line.
    const COMPONENTS: Kinds = Kinds {
        chosen_by: &["hose", "pipe", "volume"],
        keys: &[
            "hose",
            "bore",
            "volumetric_expansion",
            "volumetric_expansion_pressure",
            "volumetric_expansion_slope",
            "minimum_bend_radius",
            "working_pressure",
            "burst_pressure",
            "price",
            "price_per_length",
            "mass",
            "mass_per_length",
            "pipe",
            "volume",
            "effective_bulk_modulus",
        ],
    };
    /// Kinds that a side may choose for itself.
    const KINDS: &[Kinds] = &[DeclaredLine::COMPONENTS, LineMotion::MODELS];

    /// Hose of the line, if it is one.
    pub fn hose(&self) -> Option<&HoseProperties> {
        if let Component::Hose { properties, .. } = &self.component { Some(properties) } else { None }
    }

    /// Name of its hose in the catalogue.
    pub fn hose_name(&self) -> Option<&str> {
        if let Component::Hose { name, .. } = &self.component { name.as_deref() } else { None }
    }

    /// Pipe of the line, if it is one.
    pub fn pipe(&self) -> Option<&DeclaredPipe> {
        if let Component::Pipe { pipe, .. } = &self.component { Some(pipe) } else { None }
    }

    /// Bore of a hose or pipe, m.
    pub fn bore(&self) -> Option<f64> {
        match &self.component {
            Component::Hose { properties, .. } => Some(properties.bore),
            Component::Pipe { pipe, .. } => Some(pipe.bore),
            Component::Volume(_) => None,
        }
    }

    /// Length of a hose or pipe, m.
    pub fn length(&self) -> Option<f64> {
        match self.component {
            Component::Hose { length, .. } | Component::Pipe { length, .. } => Some(length),
            Component::Volume(_) => None,
        }
    }

    /// Pressure up to which the expansion of a hose was measured, if stated, Pa.
    pub fn expansion_stated_at(&self) -> Option<f64> {
        self.hose().and_then(|hose| hose.expansion.pressure())
    }
}

impl<S: TableNumber> DeclaredLine<S> {
    /// Visits a hose or pipe that ends at no chamber.
    pub fn visit_unconnected<V: Visitor<S>>(&mut self, v: &mut V) {
        self.component.visit(false, v);
        self.visit_stiffening(v);
    }

    fn visit_stiffening<V: Visitor<S>>(&mut self, v: &mut V) {
        Stiffening::visit(&mut self.dynamic_stiffening, v);
    }

    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        self.component.visit(true, v);
        self.visit_stiffening(v);
        v.variant(plain("model", "What of the line moves."), &mut self.motion, false);
        let k = plain("accumulator", "A gas-charged accumulator at the chamber's end of the line.");
        v.table(k, &mut self.accumulator, DeclaredAccumulator::visit_at_chamber);
        DeclaredMisfit::visit(&mut self.misfit, v);
    }
}

impl Component {
    /// Keys any of which makes the line a hose.
    pub const HOSE: [&'static str; 4] =
        ["hose", "bore", "volumetric_expansion", "volumetric_expansion_slope"];
    /// Keys any of which makes the line a directly stated volume.
    pub const VOLUME: [&'static str; 2] = ["volume", "effective_bulk_modulus"];
}

impl<S: TableNumber> Component<S> {
    /// Visits the line, also as a directly stated volume if `or_volume`.
    fn visit<V: Visitor<S>>(&mut self, or_volume: bool, v: &mut V) {
        let (mut name, mut hose, mut pipe, mut volume, mut length) = (None, None, None, None, S::default());
        match std::mem::take(self) {
            Component::Hose { name: of, properties, length: m } => {
                (name, hose, length) = (of, Some(properties), m);
            }
            Component::Pipe { pipe: of, length: m } => (pipe, length) = (Some(of), m),
            Component::Volume(of) => volume = Some(of),
        }
        v.catalogue(plain("hose", "Name of a hose of the catalogue."), CatalogueKind::Hose, &mut name);
        v.way(&Component::HOSE, &mut hose, HoseProperties::visit);
        v.table(plain("pipe", "A pipe instead of a hose."), &mut pipe, DeclaredPipe::visit);
        if or_volume {
            v.way(&Component::VOLUME, &mut volume, LineVolume::visit);
        }
        let words = if or_volume { "Length of the line to one chamber." } else { "Length of the line." };
        let k = key("length", &LENGTH, words).positive().usual(0.05, 30.0, "lines");
        match (hose, pipe, volume) {
            (Some(properties), _, _) => {
                v.quantity(k, &mut length);
                *self = Component::Hose { name, properties, length };
            }
            (None, Some(pipe), _) => {
                v.quantity(k, &mut length);
                *self = Component::Pipe { pipe, length };
            }
            (None, None, volume) => {
                v.optional(k, &mut None);
                *self = Component::Volume(volume.unwrap_or_default());
            }
        }
    }
}

impl<S: TableNumber> LineVolume<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(VOLUME_KEY, &mut self.volume);
        v.quantity(EFFECTIVE_BULK_MODULUS_KEY, &mut self.effective_bulk_modulus);
    }
}

impl<S: TableNumber> HoseExpansion<S> {
    /// Measured value, if stated, m³/m.
    pub fn measured(&self) -> Option<S> {
        match *self {
            HoseExpansion::Slope { measured, .. } => measured,
            HoseExpansion::Measured { measured, .. } => Some(measured),
        }
    }

    /// Pressure of the measurement, Pa.
    pub fn pressure(&self) -> Option<S> {
        match *self {
            HoseExpansion::Slope { pressure, .. } => pressure,
            HoseExpansion::Measured { pressure, .. } => Some(pressure),
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let (mut measured, mut pressure) = (self.measured(), self.pressure());
        // a slope is positive, unless an expansion is not read yet
        let mut slope = match *self {
            HoseExpansion::Slope { slope, .. } if slope != S::default() => Some(slope),
            HoseExpansion::Slope { .. } | HoseExpansion::Measured { .. } => None,
        };
        let k = key("volumetric_expansion", &VOLUME_PER_LENGTH, "Volume gained by a metre of hose.");
        v.optional(k.positive(), &mut measured);
        let k = key("volumetric_expansion_pressure", &PRESSURE, "Pressure the expansion was measured at.");
        v.optional(k.positive(), &mut pressure);
        v.optional(EXPANSION_SLOPE_KEY, &mut slope);
        *self = match (slope, measured, pressure) {
            (Some(slope), ..) => HoseExpansion::Slope { slope, measured, pressure },
            (None, Some(measured), Some(pressure)) => HoseExpansion::Measured { measured, pressure },
            _ => {
                let what = "`volumetric_expansion` with `volumetric_expansion_pressure`, or `volumetric_expansion_slope`,";
                let measured = &["volumetric_expansion", "volumetric_expansion_pressure"];
                v.lacks(&[measured, &["volumetric_expansion_slope"]], what);
                HoseExpansion::default()
            }
        };
    }
}

impl<S: TableNumber> HoseProperties<S> {
    /// Visits the keys of a hose in the catalogue.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(HOSE_BORE, &mut self.bore);
        self.expansion.visit(v);
        let k = key("minimum_bend_radius", &LENGTH, "Smallest permitted bend radius.").positive();
        v.optional(k, &mut self.minimum_bend_radius);
        let k = key("working_pressure", &PRESSURE, "Highest permitted working pressure.").positive();
        v.optional(k, &mut self.working_pressure);
        let k = key("burst_pressure", &PRESSURE, "Pressure at which it may burst.").positive();
        v.optional(k, &mut self.burst_pressure);
        self.cost.visit(v);
    }
}

impl<S: TableNumber> DeclaredPipe<S> {
    /// Visits the keys of a pipe, also in the catalogue.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("model", "Name of a pipe of the catalogue.");
        v.catalogue(k, CatalogueKind::Pipe, &mut self.model);
        v.quantity(PIPE_BORE, &mut self.bore);
        v.way(&["wall_thickness", "youngs_modulus"], &mut self.wall, ElasticWall::visit);
        v.quantity(POISSON_RATIO_KEY, &mut self.poisson_ratio);
        let k = key("outer_diameter", &LENGTH, "Outer diameter of the pipe.").positive();
        v.optional(k, &mut self.outer_diameter);
        let k = key("working_pressure", &PRESSURE, "Highest permitted working pressure.").positive();
        v.optional(k, &mut self.working_pressure);
        let k = key("burst_pressure", &PRESSURE, "Pressure at which it may burst.").positive();
        v.optional(k, &mut self.burst_pressure);
        self.cost.visit(v);
    }
}

impl<S: TableNumber> ElasticWall<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(WALL_THICKNESS_KEY, &mut self.thickness);
        v.quantity(YOUNGS_MODULUS_KEY, &mut self.youngs_modulus);
        let k = key("wall_density", &DENSITY, "Density of the wall, from which its mass follows.").positive();
        v.optional(k, &mut self.density);
    }
}

impl<S: TableNumber> DeclaredLines<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("compliance", "To which volume the line's effective bulk modulus applies.");
        let words = &[("by_volume", StiffnessModel::ByVolume), ("uniform", StiffnessModel::Uniform)];
        v.choice(k, words, &mut self.compliance, false);
        let keys = [plain("a", "The line to chamber A."), plain("b", "The line to chamber B.")];
        let mut sides = [std::mem::take(&mut self.a), std::mem::take(&mut self.b)];
        v.sides(keys, DeclaredLine::KINDS, &mut sides, DeclaredLine::visit);
        [self.a, self.b] = sides;
    }
}

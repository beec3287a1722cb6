//! `[line]`, `[line.a]` and `[line.b]`.

use super::interval::Interval;
use super::key::{key, plain};
use super::line_motion::LineMotion;
use super::visitor::{Kinds, Visitor};
use crate::catalogue::Kind;
use phea_quantity::{EXPANSION_SLOPE, LENGTH, PRESSURE, RATIO, VOLUME, VOLUME_PER_LENGTH};

/// The lines between the valve and the chambers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// Which volume the line's effective bulk modulus holds for.
    pub compliance: Compliance,
    /// The line to chamber A.
    pub a: Line,
    /// The line to chamber B.
    pub b: Line,
}

/// Which volume the line's effective bulk modulus holds for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compliance {
    /// Each volume has its own: the chamber keeps the fluid's.
    #[default]
    ByVolume,
    /// Line and chamber together, as in Ledezma (2019).
    Uniform,
}

/// One line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Name of the catalogue's hose; with it, or with `bore` and an expansion, the line is a hose.
    pub hose: Option<String>,
    /// What is known of the hose, from the catalogue or written here.
    pub hose_properties: HoseProperties,
    /// A pipe instead of a hose.
    pub pipe: Option<Pipe>,
    /// m³, a line given outright, with `effective_bulk_modulus`.
    pub volume: Option<f64>,
    /// Pa, of the volume given outright.
    pub effective_bulk_modulus: Option<f64>,
    /// m, of this one line.
    pub length: Option<f64>,
    /// r_β, dynamic over static modulus of the hose.
    pub dynamic_stiffening: Option<Interval>,
    /// How it moves.
    pub motion: LineMotion,
}

impl Line {
    /// Pa, the pressure up to which the expansion of a hose was measured, where it is stated.
    pub fn expansion_stated_at(&self) -> Option<f64> {
        self.hose_properties.volumetric_expansion_pressure
    }
}

/// What is known of a hose; what is absent is unknown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HoseProperties {
    /// m, inner diameter of the hose.
    pub bore: Option<f64>,
    /// m³/m gained at `volumetric_expansion_pressure`.
    pub volumetric_expansion: Option<f64>,
    /// Pa, pressure the volumetric expansion was measured at.
    pub volumetric_expansion_pressure: Option<f64>,
    /// m³/(m·Pa), slope of the expansion over pressure; absent: expansion over its pressure.
    pub volumetric_expansion_slope: Option<f64>,
    /// m.
    pub minimum_bend_radius: Option<f64>,
    /// Pa.
    pub working_pressure: Option<f64>,
    /// Pa.
    pub burst_pressure: Option<f64>,
}

/// A pipe with an elastic wall.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pipe {
    /// m, inner diameter.
    pub bore: f64,
    /// m; absent: the wall is rigid.
    pub wall_thickness: Option<f64>,
    /// Pa, of the wall.
    pub youngs_modulus: Option<f64>,
    /// Of the wall.
    pub poisson_ratio: f64,
}

/// What a line is made of, as one value.
#[derive(Clone, Debug, PartialEq)]
pub enum Component<'a> {
    /// A hose with volumetric expansion.
    Hose {
        /// Catalogue name, if it came from there.
        name: Option<&'a str>,
        /// m.
        bore: f64,
        /// m³/m at `expansion_pressure`, where declared.
        expansion: Option<f64>,
        /// Pa, where declared.
        expansion_pressure: Option<f64>,
        /// m³/(m·Pa).
        expansion_slope: f64,
        /// m.
        length: f64,
    },
    /// A pipe.
    Pipe {
        /// Its dimensions and wall.
        pipe: &'a Pipe,
        /// m.
        length: f64,
    },
    /// A volume with the modulus it has.
    Volume {
        /// m³.
        volume: f64,
        /// Pa.
        effective_bulk_modulus: f64,
    },
}

impl Line {
    /// What a line can be.
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
            "pipe",
            "volume",
            "effective_bulk_modulus",
        ],
    };
    /// What a side may choose for itself.
    const KINDS: &[Kinds] = &[Line::COMPONENTS, LineMotion::MODELS];

    /// What the line is made of; `None` only for a line that was not read from a valid project.
    pub fn component(&self) -> Option<Component<'_>> {
        if let (Some(volume), Some(effective_bulk_modulus)) = (self.volume, self.effective_bulk_modulus) {
            return Some(Component::Volume { volume, effective_bulk_modulus });
        }
        let length = self.length?;
        if let Some(pipe) = &self.pipe {
            return Some(Component::Pipe { pipe, length });
        }
        Some(Component::Hose {
            name: self.hose.as_deref(),
            bore: self.hose_properties.bore?,
            expansion: self.hose_properties.volumetric_expansion,
            expansion_pressure: self.hose_properties.volumetric_expansion_pressure,
            expansion_slope: self.hose_properties.expansion_slope()?,
            length,
        })
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.catalogue(plain("hose", "Name of a hose of the catalogue."), Kind::Hose, &mut self.hose);
        self.hose_properties.visit(v);
        v.table(plain("pipe", "A pipe instead of a hose."), &mut self.pipe, Pipe::visit);
        let k = key("volume", &VOLUME, "Volume of the line, instead of a hose or pipe.").positive();
        v.optional(k, &mut self.volume);
        let k = key("effective_bulk_modulus", &PRESSURE, "Effective bulk modulus that goes with `volume`.");
        v.optional(k.positive(), &mut self.effective_bulk_modulus);
        let k = key("length", &LENGTH, "Length of the line to one chamber.").positive();
        v.optional(k, &mut self.length);
        let k = key("dynamic_stiffening", &RATIO, "r_β, the hose's dynamic over its static modulus.");
        Interval::visit(v, k.at_least(1.0), &mut self.dynamic_stiffening);
        self.motion.visit(v);
    }
}

impl HoseProperties {
    /// m³/(m·Pa): the declared slope, or the expansion over the pressure it was measured at.
    pub fn expansion_slope(&self) -> Option<f64> {
        let secant = match (self.volumetric_expansion, self.volumetric_expansion_pressure) {
            (Some(expansion), Some(pressure)) => Some(expansion / pressure),
            _ => None,
        };
        self.volumetric_expansion_slope.or(secant)
    }

    /// The keys a catalogue's hose has.
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("bore", &LENGTH, "Inner diameter of the hose.").positive();
        v.optional(k, &mut self.bore);
        let k = key("volumetric_expansion", &VOLUME_PER_LENGTH, "Volume gained by a metre of hose.");
        v.optional(k.positive(), &mut self.volumetric_expansion);
        let k = key("volumetric_expansion_pressure", &PRESSURE, "Pressure the expansion was measured at.");
        v.optional(k.positive(), &mut self.volumetric_expansion_pressure);
        let k = key("volumetric_expansion_slope", &EXPANSION_SLOPE, "Slope of the expansion over pressure.");
        v.optional(k.positive(), &mut self.volumetric_expansion_slope);
        let k = key("minimum_bend_radius", &LENGTH, "Smallest permitted bend radius.").positive();
        v.optional(k, &mut self.minimum_bend_radius);
        let k = key("working_pressure", &PRESSURE, "Highest permitted working pressure.").positive();
        v.optional(k, &mut self.working_pressure);
        let k = key("burst_pressure", &PRESSURE, "Pressure at which it may burst.").positive();
        v.optional(k, &mut self.burst_pressure);
    }
}

impl Pipe {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.quantity(key("bore", &LENGTH, "Inner diameter of the pipe.").positive(), &mut self.bore);
        let k = key("wall_thickness", &LENGTH, "Thickness of the wall; absent: the wall is rigid.");
        v.optional(k.positive(), &mut self.wall_thickness);
        let k = key("youngs_modulus", &PRESSURE, "Young's modulus of the wall.").positive();
        v.optional(k, &mut self.youngs_modulus);
        let k =
            key("poisson_ratio", &RATIO, "Poisson's ratio of the wall.").not_negative().below(0.5).or(0.3);
        v.quantity(k, &mut self.poisson_ratio);
    }
}

impl Lines {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("compliance", "Which volume the line's effective bulk modulus holds for.");
        let words = &[("by_volume", Compliance::ByVolume), ("uniform", Compliance::Uniform)];
        v.choice(k, words, &mut self.compliance, false);
        let keys = [plain("a", "The line to chamber A."), plain("b", "The line to chamber B.")];
        let mut sides = [std::mem::take(&mut self.a), std::mem::take(&mut self.b)];
        v.sides(keys, Line::KINDS, &mut sides, Line::visit);
        [self.a, self.b] = sides;
    }
}

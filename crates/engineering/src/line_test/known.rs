use std::f64::consts::FRAC_PI_4;

use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::line::{Conduit, LaminarFriction, Line, LineModel};

use super::rise_air::AeratedOil;
use crate::identify_error::KnownLineError;
use crate::project::{LineMotion, LineSegments, LineSide};
use crate::setup::Setup;

/// Facts that a project states about a line, in addition to the identified ones.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownLine {
    /// Side of the line.
    pub side: LineSide,
    /// True if the project declares the line to the other chamber differently.
    pub differs_from_other: bool,
    /// Line as declared.
    pub line: Line,
    /// Oil in the line.
    pub fluid: Fluid,
    /// Pressure midway between supply and tank, Pa, for which a hose's bore is stated.
    pub pressure: f64,
    /// Declared model of the line's motion.
    pub motion: LineMotion,
    /// Area of the piston that displaces a recorded volume, if there is one, m2.
    pub piston_area: f64,
    /// True if the line ends at an accumulator, which is not part of it while that end is blocked.
    pub leaves_accumulator: bool,
}

/// `end_share` of the exact line, to which lines with end volumes tend: at the antinodes of the
/// pressure a volume counts twice as much as an equal compliance along the line, so that end
/// volumes of 1 % make a resonance 1 % slower.
pub(super) const EXACT: f64 = 0.0;
/// `end_share` of the line on the virtual stand if none is stated: it shifts a resonance by less
/// than 1e-4.
const ON_THE_STAND: f64 = 1e-4;
/// Polytropic index of bubbles that are compressed slowly: the oil around them has a
/// constant temperature.
const ISOTHERMAL: f64 = 1.0;
/// Greatest modulus of any liquid, Pa.
const MOST_MODULUS: f64 = 1e11;
/// Number of bisections of an interval, down to the last digit.
const HALVINGS: usize = 60;

impl KnownLine {
    /// Line of a project.
    ///
    /// # Errors
    /// [`KnownLineError`] without an actuator, with impossible parameters, and for a line without
    /// volume.
    pub fn of(setup: &Setup<'_>, side: LineSide) -> Result<KnownLine, KnownLineError> {
        let rig = setup.rig()?;
        let declared = setup.project.actuator.as_ref().ok_or(KnownLineError::NoLine)?;
        let components = rig.actuator.components();
        if components.cylinder.stroke.telescope().is_some() {
            return Err(KnownLineError::Telescopic);
        }
        let lines = &declared.line;
        let (line, declared, piston_area) = match side {
            LineSide::A => (components.line_a, &lines.a, components.cylinder.area_a),
            LineSide::B => (components.line_b, &lines.b, components.cylinder.area_b),
        };
        let known = KnownLine {
            side,
            differs_from_other: lines.a != lines.b,
            line,
            fluid: components.fluid,
            pressure: rig.actuator.mean_pressure(),
            motion: declared.motion.clone(),
            piston_area,
            leaves_accumulator: declared.accumulator.is_some(),
        };
        if known.volume() > 0.0 { Ok(known) } else { Err(KnownLineError::NoOil) }
    }

    /// Volume of the oil that it contains at the operating pressure, m3: its moduli refer to it.
    pub fn volume(&self) -> f64 {
        self.line.filled().volume()
    }

    /// Length and bore, m, as filled; absent for a plain volume.
    pub fn dimensions(&self) -> Option<[f64; 2]> {
        match self.line.filled() {
            Line::Hose { hose, length } => Some([length, hose.bore]),
            Line::Pipe { pipe, length } => Some([length, pipe.bore]),
            Line::Volume { .. } => None,
        }
    }

    /// Compliance of the oil without wall at a pressure, Pa, in m3/Pa; absent for a plain volume,
    /// whose modulus includes oil and wall.
    pub fn fluid_compliance(&self, pressure: f64) -> Option<f64> {
        self.dimensions().map(|_| self.volume() / self.fluid.modulus_at(pressure))
    }

    /// Inertance of the oil in it, Pa s2/m3; absent for a plain volume.
    pub fn inertance(&self) -> Option<f64> {
        let [length, bore] = self.dimensions()?;
        Some(self.fluid.density * length / (FRAC_PI_4 * bore * bore))
    }

    /// Model of its motion as declared.
    pub(crate) fn declared_model(&self) -> LineModel {
        self.motion.component()
    }

    /// Model of its motion with nearly exact waves if no volume at the ends is stated: the end
    /// volumes of a machine separate its valve from the waves, whereas a line has none.
    pub(crate) fn stand_model(&self) -> LineModel {
        match (&self.motion, self.declared_model()) {
            (LineMotion::TransmissionLine { end_share: None }, _) => {
                LineModel::TransmissionLine { end_share: ON_THE_STAND }
            }
            (_, declared) => declared,
        }
    }

    /// Model in which its response is identified: as declared, and if that has no waves, with them,
    /// so that they are found if they exist. Waves are exact unless a volume at the ends is stated.
    pub(crate) fn sought_model(&self) -> LineModel {
        let exact = LineModel::TransmissionLine { end_share: EXACT };
        match (self.dimensions(), self.declared_model()) {
            (None, _) => LineModel::Lumped,
            (Some(_), LineModel::Lumped | LineModel::TwoWave { .. }) => exact,
            (Some(_), LineModel::Creeping { relaxation_time }) => LineModel::Segments {
                count: LineSegments::COUNT as usize,
                friction: LaminarFriction::FrequencyDependent,
                relaxation_time: Some(relaxation_time),
            },
            (Some(_), LineModel::TransmissionLine { .. })
                if self.motion == (LineMotion::TransmissionLine { end_share: None }) =>
            {
                exact
            }
            (Some(_), declared) => declared,
        }
    }

    /// Oil in which a slow pressure rise may show air: compressed at constant temperature if the
    /// project states no index. Absent for a plain volume, whose modulus includes oil and wall.
    pub(super) fn aerated_oil(&self) -> Option<AeratedOil> {
        let exponent = self.fluid.entrained_air.map_or(ISOTHERMAL, |air| air.polytropic_exponent);
        let fluid = Fluid { entrained_air: None, ..self.fluid };
        self.dimensions().map(|_| AeratedOil { volume: self.volume(), fluid, exponent })
    }

    /// The line with this air in its oil.
    pub(super) fn with_air(self, air: EntrainedAir) -> KnownLine {
        KnownLine { fluid: Fluid { entrained_air: Some(air), ..self.fluid }, ..self }
    }

    /// Modulus of the oil without its air, Pa, for a modulus with it, at a pressure; absent if the
    /// air without liquid is softer.
    ///
    /// # Example
    /// See [`super::identify_line`]; without air, the result is the modulus itself.
    pub fn liquid_modulus(&self, modulus: f64, pressure: f64) -> Option<f64> {
        if self.fluid.entrained_air.is_none() {
            return (modulus > 0.0).then_some(modulus);
        }
        let of = |liquid: f64| Fluid { bulk_modulus: liquid, ..self.fluid }.modulus_at(pressure);
        let [mut low, mut high] = [modulus, MOST_MODULUS];
        if !(modulus > 0.0 && of(high) > modulus) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if of(middle) < modulus {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(f64::midpoint(low, high))
    }

    /// Oil column of this compliance, m3/Pa, and inertance, Pa s2/m3.
    pub(super) fn conduit(&self, compliance: f64, inertance: f64) -> Option<Conduit> {
        let [length, bore] = self.dimensions()?;
        let area = FRAC_PI_4 * bore * bore;
        Some(Conduit {
            length,
            bore,
            density: inertance * area / length,
            kinematic_viscosity: self.fluid.kinematic_viscosity,
            effective_bulk_modulus: area * length / compliance,
        })
    }
}

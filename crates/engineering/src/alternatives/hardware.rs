//! Hardware of an alternative: stiffness, lengths, masses, volumes, and consumption at rest.

use phea_hydraulics::cylinder::chamber_volumes;
use phea_hydraulics::line::Line;
use phea_hydraulics::plant::LinearElement;
use phea_hydraulics::series::{LEAST_ACTIVE_COILS, SeriesElement};

use super::columns::{AlternativeColumn, column};
use super::{ColumnKey, JudgedAlternative, LengthUnknown, NoNumber, no_rig};
use crate::parts::{self, parts, transmission};
use crate::project::{DeclaredActuator, DeclaredSeries};
use crate::quantity::{DisplayUnit, MASS, MotionKind, VOLUME, fitting};
use crate::rig::{Rig, power_at_rest, series_coil};

impl JudgedAlternative {
    pub(super) fn rig_columns(&self) -> Vec<AlternativeColumn> {
        let stiffness = |end: usize| -> Result<f64, NoNumber> {
            let found = self.linearization.as_ref().map_err(Clone::clone)?;
            Ok([found.stiffness[0].minimum, found.stiffness[0].maximum][end])
        };
        let rig = self.rig.as_ref().map_err(|reason| NoNumber::from(reason.clone()));
        let equivalent = rig.map(|rig| rig.against_load().equivalent_stiffness());
        let motion = self.loaded.project.motion();
        let stiff = motion.unit(DisplayUnit::MEGANEWTON_PER_METRE);
        let mut columns = vec![
            column(ColumnKey::StiffnessMinimum, stiff, 3, stiffness(0)),
            column(ColumnKey::StiffnessMaximum, stiff, 3, stiffness(1)),
            column(ColumnKey::EquivalentStiffness, stiff, 3, equivalent),
        ];
        columns.extend(self.made_of(motion));
        columns.extend(self.parts());
        columns.extend(self.sized_columns());
        columns
    }

    fn made_of(&self, motion: MotionKind) -> [AlternativeColumn; 8] {
        let declared = self.loaded.project.actuator.as_ref();
        let of = |value: fn(&DeclaredActuator, &Rig) -> Result<f64, NoNumber>| {
            let rig = self.rig.as_ref().map_err(Clone::clone)?;
            value(declared.ok_or_else(no_rig)?, rig)
        };
        let (metre, litre) = (DisplayUnit::METRE, |value: &Result<f64, NoNumber>| {
            fitting(value.clone().unwrap_or_default(), &VOLUME)
        });
        let [in_lines, oil, gas] = [of(lines_volume), of(oil_volume), of(gas_volume)];
        let oil_mass =
            of(|declared, rig| Ok(oil_volume(declared, rig)? * rig.actuator.components().fluid.density));
        let kilogram = fitting(1.0, &MASS);
        let inertia = fitting(1.0, motion.dimension(&MASS));
        let length = of(|declared, rig| retracted_length(declared, rig).map_err(NoNumber::Length));
        let power = of(|_, rig| Ok(power_at_rest(rig)));
        [
            column(ColumnKey::ActuatorLength, metre, 3, length),
            column(ColumnKey::LinesLength, metre, 3, of(lines_length)),
            column(ColumnKey::MovingMass, inertia, 3, of(moving_mass)),
            column(ColumnKey::LinesVolume, litre(&in_lines), 3, in_lines),
            column(ColumnKey::OilVolume, litre(&oil), 3, oil),
            column(ColumnKey::OilMass, kilogram, 3, oil_mass),
            column(ColumnKey::GasVolume, litre(&gas), 3, gas),
            column(ColumnKey::PowerAtRest, DisplayUnit::WATT, 3, power),
        ]
    }

    /// Price and mass of its parts.
    fn parts(&self) -> [AlternativeColumn; 2] {
        let counted = self.counted;
        let declared = self.loaded.project.actuator.as_ref().ok_or_else(no_rig);
        let rig = self.rig.as_ref().map_err(|reason| NoNumber::from(reason.clone()));
        let all = rig.and_then(|rig| Ok((parts(declared?, rig), rig)));
        let price = all.clone().and_then(|(all, _)| parts::price(&all, counted).map_err(NoNumber::Parts));
        let mass = all.and_then(|(all, rig)| parts::mass(&all, rig, counted).map_err(NoNumber::Parts));
        let currency = counted
            .currency
            .map_or(DisplayUnit::ONE, |currency| DisplayUnit { symbol: currency.code(), in_si: 1.0 });
        let kilogram = fitting(1.0, &MASS);
        [column(ColumnKey::PartsPrice, currency, 4, price), column(ColumnKey::PartsMass, kilogram, 3, mass)]
    }

    /// Result of `[sizing]` for it, whether the alternative takes that hose or not.
    fn sized_columns(&self) -> [AlternativeColumn; 2] {
        let sizing = self.sizing.as_ref().map_err(|reason| NoNumber::from(reason.clone()));
        let best = sizing.and_then(|sizing| sizing.best().ok_or(NoNumber::NoHose));
        let length = best.clone().map(|best| best.length_m());
        let gain = best.map(|best| best.branch.gain_v_per_n);
        [
            column(ColumnKey::SizedLength, DisplayUnit::METRE, 3, length),
            column(ColumnKey::SizedGain, DisplayUnit::MILLIVOLT_PER_NEWTON, 3, gain),
        ]
    }
}

/// Length of an actuator from mount to mount with the rod in, m.
///
/// ```text
/// stroke + cylinder.dead_length + installed length of the coil springs on the rod
///                               + both cylinders of a transmission, wherever that of the load is
/// ```
///
/// # Errors
/// [`LengthUnknown`] if something is not stated, or the spring has no length.
pub fn retracted_length(declared: &DeclaredActuator, rig: &Rig) -> Result<f64, LengthUnknown> {
    if declared.motor.is_some() {
        return Err(LengthUnknown::Motor);
    }
    let cylinder = &declared.cylinder;
    let dead = cylinder.dead_length.ok_or(LengthUnknown::NoDeadLength)?;
    let series = match &declared.series {
        None => 0.0,
        Some(DeclaredSeries::Spring(_)) => match series_coil(declared, rig) {
            Some(pair) if pair.active_coils < LEAST_ACTIVE_COILS => {
                return Err(LengthUnknown::TooFewCoils);
            }
            Some(pair) => pair.installed_length,
            None => return Err(LengthUnknown::NoCoil),
        },
        Some(DeclaredSeries::Transmission(transmission)) => {
            2.0 * transmission.cylinder_length.ok_or(LengthUnknown::NoSeriesCylinderLength)?
        }
    };
    Ok(cylinder.longest_stage_m() + dead + series)
}

/// Moving mass of the rod, and of the parts between force sensor and load, kg: the oil of a
/// transmission is referred to its pistons.
fn moving_mass(_: &DeclaredActuator, rig: &Rig) -> Result<f64, NoNumber> {
    let on_rod = match (rig.plant.series.map(|series| series.element), rig.actuator.components().series) {
        (Some(LinearElement::Oil(column)), _) => column.mass * column.segments as f64,
        (_, Some(SeriesElement::Spring(spring))) => spring.mass.unwrap_or(0.0),
        _ => 0.0,
    };
    Ok(rig.linear.moving_mass + on_rod)
}

fn lines(rig: &Rig) -> [&Line; 2] {
    let components = rig.actuator.components();
    [&components.line_a, &components.line_b]
}

fn lines_length(_: &DeclaredActuator, rig: &Rig) -> Result<f64, NoNumber> {
    let length = |line: &Line| match line {
        Line::Hose { length, .. } | Line::Pipe { length, .. } => Ok(*length),
        Line::Volume { .. } => Err(NoNumber::LineIsVolume),
    };
    let [a, b] = lines(rig);
    Ok(length(a)? + length(b)?)
}

fn lines_volume(_: &DeclaredActuator, rig: &Rig) -> Result<f64, NoNumber> {
    Ok(lines(rig).into_iter().map(Line::volume).sum())
}

/// Volume of oil in lines, chambers at the operating point, dead volumes, accumulators at that
/// point, and a transmission, m3.
fn oil_volume(declared: &DeclaredActuator, rig: &Rig) -> Result<f64, NoNumber> {
    let components = rig.actuator.components();
    let (cylinder, point) = (&components.cylinder, &rig.point);
    let [chamber_a, chamber_b] = chamber_volumes(cylinder, point.position);
    let pressures = [point.pressure_a, point.pressure_b];
    let held = components.gas.iter().zip(pressures);
    let held: f64 = held.filter_map(|(gas, pressure)| Some(gas.as_ref()?.at_rest().oil(pressure))).sum();
    let closed = transmission(rig).map_or(0.0, |transmission| transmission.oil_volume());
    Ok(lines_volume(declared, rig)? + chamber_a + chamber_b + held + closed)
}

/// Gas volume of the accumulators at the chambers, at their precharge, m3.
fn gas_volume(_: &DeclaredActuator, rig: &Rig) -> Result<f64, NoNumber> {
    let gas = rig.actuator.components().gas;
    if gas.iter().all(Option::is_none) {
        return Err(NoNumber::NoAccumulator);
    }
    Ok(gas.iter().flatten().map(|gas| gas.at_rest().gas_volume).sum())
}

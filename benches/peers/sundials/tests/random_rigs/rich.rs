//! Additional parts of a richer rig: lines with dynamics, walls, memories of the spool, ends that
//! are reached.

use phea_hydraulics::actuator::Components;
use phea_hydraulics::contact::Contact;
use phea_hydraulics::line::{
    Anchoring, END_SHARE, Hose, LaminarFriction, Line, LineModel, LineWall, Pipe, PipeWall, Stiffening,
};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Accumulator, PowerUnit};

use crate::rig::Chance;

/// Makes both lines equal, hoses or pipes, and sets them in motion.
pub(crate) fn lines(chance: &mut Chance, components: &mut Components) {
    let is_hose = chance.happens(0.6);
    let bore = 12.7e-3 * (components.cylinder.area_a / 1.6e-3).sqrt() * chance.between(0.5, 1.5);
    // Waves to and fro along shorter lines take CVODE minutes.
    let length = chance.decades(1.5, 10.0);
    let pressure = 0.5 * components.supply.pressure;
    let line = if is_hose { hose(chance, bore, length, pressure) } else { pipe(chance, bore, length) };
    (components.line_a, components.line_b) = (line, line);
    let relaxation_time = chance.decades(1e-2, 1.0);
    let kind = chance.between(0.0, 1.0);
    let model = if is_hose && kind < 0.2 {
        LineModel::Creeping { relaxation_time }
    } else if kind < 0.6 {
        let friction =
            if chance.happens(0.3) { LaminarFriction::FrequencyDependent } else { LaminarFriction::Steady };
        let creeps = is_hose && chance.happens(0.3);
        let count = chance.between(1.0, 5.0) as usize;
        LineModel::Segments { count, friction, relaxation_time: creeps.then_some(relaxation_time) }
    } else if kind < 0.85 || !is_hose {
        LineModel::TransmissionLine { end_share: END_SHARE }
    } else {
        LineModel::TwoWave { end_share: END_SHARE, wall: LineWall::default() }
    };
    components.line_models = [model; 2];
}

fn hose(chance: &mut Chance, bore: f64, length: f64, pressure: f64) -> Line {
    let expansion_slope = std::f64::consts::FRAC_PI_4 * bore * bore / chance.decades(3e7, 1e9);
    let hose = Hose {
        bore,
        volumetric_expansion: pressure * expansion_slope,
        operating_expansion: 0.5 * pressure * expansion_slope,
        expansion_slope,
        dynamic_stiffening: Stiffening::certain(chance.between(1.0, 5.0)),
    };
    Line::Hose { hose, length }
}

fn pipe(chance: &mut Chance, bore: f64, length: f64) -> Line {
    let wall = PipeWall::Elastic {
        thickness: bore * chance.between(0.08, 0.2),
        youngs_modulus: 2.1e11,
        poisson_ratio: 0.3,
        anchoring: Anchoring::Throughout,
        thick: true,
    };
    Line::Pipe { pipe: Pipe { bore, wall }, length }
}

/// Adds to these components what makes a machine rich.
pub(crate) fn enrich(chance: &mut Chance, components: &mut Components) {
    let Components { supply, cylinder, force_sensor, .. } = *components;
    let most_force = supply.pressure * cylinder.area_a;
    let width = chance.happens(0.5).then(|| 10.0 * chance.decades(1e-3, 3e-2));
    components.valve.spool.hysteresis_width = width;
    components.valve.spool.threshold = chance
        .happens(0.5)
        .then(|| width.map_or(10.0 * chance.decades(3e-4, 1e-2), |width| width * chance.between(0.05, 0.9)));
    components.cylinder.end_stops = chance
        .happens(0.6)
        .then(|| Contact { stiffness: most_force / chance.decades(1e-6, 1e-3), relative_damping: 1.0 });
    if let PowerUnit::PumpLimited(pump) = &mut components.power_unit {
        pump.accumulator = chance.happens(0.5).then(|| Accumulator {
            gas_volume: pump.volume * chance.decades(0.1, 10.0),
            precharge_pressure: supply.pressure * chance.between(0.3, 1.1),
            polytropic_exponent: chance.between(1.0, 1.4),
        });
    }
    if chance.happens(0.4) {
        components.load = Load::Wall {
            mass: Some(cylinder.moving_mass * chance.decades(0.1, 10.0)),
            damping: most_force * chance.decades(1e-3, 0.3),
            gap: 2.0 * cylinder.stroke.middle() * chance.decades(1e-4, 1e-2),
            stiffness: force_sensor.stiffness * chance.decades(0.1, 10.0),
            relative_damping: chance.decades(0.1, 10.0),
        };
    }
}

//! Check for signals of a run with opposite signs.
//!
//! Friction takes energy from the mass: the driving force, A_A p_A - A_B p_B - F_e, acts in the
//! direction of the motion, over both directions whatever the zero error of the instruments is.

use phea_dynamics::order;

use super::sign_error::{SignError, SignHint};
use crate::project::{Findings, RawFinding};
use crate::table::{Column, MeasuredTable};
use crate::tendency::Tendency;

/// Largest number of blocks of rows over which a run is averaged.
const BLOCKS: usize = 1000;
/// Ratio of the path to the distance between its ends beyond which a run moves in both directions.
const BOTH_WAYS: f64 = 3.0;
/// Shortest distance between the ends of a sliding run, m. Less is a piston on its bristles, whose
/// elastic force is in phase with the position, not the velocity.
const SLIDING: f64 = 2e-4;

/// Rejects a run in which the recorded velocity is opposite to the slope of the position.
pub(super) fn velocity_along_position(
    table: &MeasuredTable,
    position: Option<&Column>,
    velocity: Option<&Column>,
    positions: &[f64],
    findings: &mut Findings,
) {
    let (Some(position), Some(velocity)) = (position, velocity) else { return };
    let numbers = table.numbers(&[velocity], findings);
    let velocities = numbers.columns.first().map(Vec::as_slice).unwrap_or_default();
    let [distances, means] = [moved(positions), averaged(velocities)];
    let opposite = Tendency::about_zero(&means, &distances).filter(Tendency::is_opposite);
    let Some(tendency) = opposite else { return };
    let [position, name] = [position, velocity].map(|column| table.heading(column).to_string());
    let hint = SignHint::ChangeOneSign { velocity: name.clone(), position: position.clone() };
    let message = SignError::Velocity { velocity: name, position, tendency };
    let place = table.headings.get(velocity.index).map(|heading| heading.place).unwrap_or_default();
    let found = RawFinding::error(place, message.to_string());
    let found = found.expected(SignHint::VelocityOfPosition.to_string());
    findings.push(found.help(hint.to_string()));
}

/// Rejects a run in which the force that drives the mass is opposite to its motion.
pub(super) fn force_along_motion(
    table: &MeasuredTable,
    motion: &Column,
    pushing: [Option<&Column>; 3],
    [positions, forces]: [&[f64]; 2],
    findings: &mut Findings,
) {
    let [least, most] = order::ends(positions.iter().copied());
    if most - least < SLIDING {
        return;
    }
    let [distances, means] = [moved(positions), averaged(forces)];
    let path: f64 = distances.iter().map(|distance| distance.abs()).sum();
    let goes_both_ways = path > BOTH_WAYS * distances.iter().sum::<f64>().abs();
    let tendency = match goes_both_ways {
        true => Tendency::of(&means, &distances),
        false => Tendency::about_zero(&means, &distances),
    };
    let Some(tendency) = tendency.filter(Tendency::is_opposite) else { return };
    let quoted = |column: &&Column| format!("`{}`", table.heading(column));
    let names: Vec<String> = pushing.iter().flatten().map(quoted).collect();
    let hint =
        SignHint::OtherSign { motion: quoted(&motion), exchanged: names.len() > 1, shifted: !goes_both_ways };
    let message = SignError::Force { columns: names.join(", "), motion: quoted(&motion), tendency };
    let place = table.headings.get(motion.index).map(|heading| heading.place).unwrap_or_default();
    let found = RawFinding::error(place, message.to_string());
    let found = found.expected(SignHint::ForceAlongMotion.to_string());
    findings.push(found.help(hint.to_string()));
}

/// Number of rows of a block.
fn width(values: &[f64]) -> usize {
    values.len().div_ceil(BLOCKS).max(1)
}

/// Distance moved from block to block.
fn moved(positions: &[f64]) -> Vec<f64> {
    let width = width(positions);
    let end = positions.last().copied();
    let starts: Vec<f64> = positions.iter().step_by(width).copied().chain(end).collect();
    starts.windows(2).filter_map(|pair| Some(pair.last()? - pair.first()?)).collect()
}

/// Mean of each block.
fn averaged(values: &[f64]) -> Vec<f64> {
    values.chunks(width(values)).map(|block| block.iter().sum::<f64>() / block.len() as f64).collect()
}

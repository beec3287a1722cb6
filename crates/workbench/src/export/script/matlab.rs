//! The script for MATLAB and Octave.

use std::fmt::Write;

use super::{anti_windup, number, numbers, row, series};
use crate::export::ExportedController;

/// A structure with the name of the controller: sections, transfer functions in z, and plants.
pub(super) fn script(exported: &ExportedController) -> String {
    let name = &exported.name;
    let controller = &exported.deployed.controller;
    let limit = controller.command_limit();
    let limit = if limit.is_finite() { number(limit) } else { "Inf".to_string() };
    let mut text = format!(
        "if exist('OCTAVE_VERSION', 'builtin')
    pkg load control
end

clear {name}
{name}.sample_time = {};
{name}.command_limit = {limit};
{name}.anti_windup = '{}';
{name}.feed_forward = {};

% Sections in series, a row each: b0 b1 b2 1 a1 a2, in powers of 1/z.
",
        number(controller.sample_time_s()),
        anti_windup(exported),
        number(exported.deployed.feed_forward)
    );
    for (series, sections) in series(exported) {
        let rows: Vec<String> = sections.iter().map(|section| numbers(row(section))).collect();
        let matrix = match rows.as_slice() {
            [] => "zeros(0, 6)".to_string(),
            rows => format!("[ ...\n    {}]", rows.join("; ...\n    ")),
        };
        let _ = writeln!(text, "{name}.{series}.sections = {matrix};");
    }
    let _ = write!(
        text,
        "
% Response of sections at a frequency in rad/s. With d = exp(-i w T) - 1 nothing cancels where w T is
% small: b0 + b1/z + b2/z^2 = (b0 + b1 + b2) + (b1 + 2 b2) d + b2 d^2.
polynomial = @(c, d) ((c(:, 1) + c(:, 2)) + c(:, 3)) + d * ((c(:, 2) + 2 * c(:, 3)) + d * c(:, 3));
change = @(angle) -2 * sin(angle / 2)^2 - 1i * sin(angle);
{name}.response = @(sections, frequency) prod( ...
    polynomial(sections(:, 1:3), change(frequency * {name}.sample_time)) ./ ...
    polynomial(sections(:, 4:6), change(frequency * {name}.sample_time)), 1);
clear polynomial change

% Transfer functions in z.
for series = {{'prefilter', 'feedback', 'inner'}}
    sections = {name}.(series{{1}}).sections;
    {name}.(series{{1}}).tf = tf(1, 1, {name}.sample_time);
    for place = 1:size(sections, 1)
        {name}.(series{{1}}).tf = {name}.(series{{1}}).tf * ...
            tf(sections(place, 1:3), sections(place, 4:6), {name}.sample_time);
    end
end
clear series sections place
"
    );
    text.push_str(&family(exported));
    text
}

/// Plants as an array of structures.
fn family(exported: &ExportedController) -> String {
    let name = &exported.name;
    let names: Vec<String> =
        exported.parameters.iter().map(|one| format!("'{}'", one.replace('\'', "''"))).collect();
    let mut text = format!(
        "
% Plants of the family from command to measured quantity, without delay and sensor of the loop; the
% first is the nominal one: zpk(plant.zeros, plant.poles, plant.gain, 'InputDelay', plant.dead_time)
{name}.parameters = {{{}}};
{name}.plants = struct('values', {{}}, 'zeros', {{}}, 'poles', {{}}, 'gain', {{}}, 'dead_time', {{}});
",
        names.join(", ")
    );
    let roots = |pairs: &[[f64; 2]]| {
        let one = |&[re, im]: &[f64; 2]| format!("complex({}, {})", number(re), number(im));
        pairs.iter().map(one).collect::<Vec<_>>().join("; ")
    };
    for (index, plant) in exported.plants.iter().enumerate() {
        let factors = &plant.factors;
        let _ = writeln!(
            text,
            "{name}.plants({}) = struct('values', [{}], 'zeros', [{}], 'poles', [{}], 'gain', {}, 'dead_time', {});",
            index + 1,
            numbers(plant.values.iter().copied()),
            roots(&factors.zeros),
            roots(&factors.poles),
            number(factors.gain),
            number(factors.dead_time_s),
        );
    }
    text
}

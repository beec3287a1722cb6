//! An identified valve for people.

use phea_engineering::identify::{
    Bootstrap, COEFFICIENT_NAMES, DECISIVE, Identification, NotIdentifiableCombination, SignalFit,
    TermEvidence, TestOil, ValveTerm,
};
use phea_hydraulics::servovalve::{LeakageModel, STATIC_COEFFICIENTS};

use super::Read;
use super::answer::{EITHER_SIGN, correlations};
use super::misfit::misfit_in_words;
use super::numbers;
use super::region::{self, FoundRegion};
use crate::answer::{Word, significant};
use crate::document::{Cell, Document, Table};
use crate::quantity::{DisplayUnit, PRESSURE, display};

/// Model of the leakage, coefficients with their intervals, contents of the files, fit of the
/// signals, and combinations that the data do not determine.
pub(crate) fn document(
    found: &Identification,
    of_thesis: bool,
    read: &Read,
    region: Option<&FoundRegion>,
) -> Document {
    let mut out = Document::default();
    write_coefficients(found, &mut out);
    numbers::write(found, of_thesis, &mut out);
    read.write(&mut out);
    write_signals(found, &mut out);
    if let Some(region) = region {
        region::chapter(&mut out, found, region);
    }
    out
}

/// Model of the leakage, coefficients with their intervals, and those computed by hand.
pub(crate) fn write_coefficients(found: &Identification, out: &mut Document) {
    out.heading("Model of the leakage");
    out.sentences(leakage(found));
    out.sentences(terms(found));
    let mut headings = vec!["coefficient", "identified", "95 % from", "to"];
    if found.bootstrap.is_some() {
        headings.extend(["bootstrap from", "to"]);
    }
    headings.extend(["by hand", "unit"]);
    out.section("Coefficients of the valve", Table::new(headings).with(coefficients(found)));
    out.sentences([
        "By hand: the calculations of Ledezma (2019), section 5.2, which take the edges as equal."
            .to_string(),
    ]);
    let tare_pressure = display(found.tested.tare_reference_drop, &PRESSURE, 4);
    out.sentences([format!("`tare_flow` is that at {tare_pressure} from supply to tank (`tare_pressure`).")]);
    out.sentences(found.bootstrap.as_ref().map(bootstrap));
    out.sentences(found.oil.as_ref().map(warm_oil));
}

/// The temperature at which the coefficients are stated.
fn warm_oil(oil: &TestOil) -> String {
    let [from, to, reference] =
        [oil.range[0], oil.range[1], oil.reference].map(|temperature| significant(temperature, 4));
    let [viscosity, density] =
        [oil.law.viscosity_slope, oil.law.density_slope].map(|slope| significant(100.0 * slope, 3));
    format!(
        "The coefficients are those at {reference} degC; the oil was recorded from {from} to {to} degC, and its viscosity is taken to fall by {viscosity} % for each degree and its density by {density} % (`[identify.oil_temperature]`)."
    )
}

/// Fit of the signals, and combinations that the data do not determine.
pub(crate) fn write_signals(found: &Identification, out: &mut Document) {
    let headings = [
        "file",
        "signal",
        "rows",
        "rms of residuals",
        "by hand",
        "range",
        "unit",
        "correlation of neighbours",
    ];
    out.section(
        "How well the recordings are explained",
        Table::new(headings).with(found.signals.iter().map(|one| signal(found, one))),
    );
    out.sentences(remarks(found));
    let together = correlations(found);
    if !together.is_empty() {
        out.heading("Coefficients that the data determine only together");
        out.sentences(together.into_iter().map(|([first, second], correlation)| {
            format!("{first} and {second}: correlation {}.", significant(correlation, 3))
        }));
    }
    if !found.not_identifiable.is_empty() {
        out.heading("What the data cannot distinguish");
        out.sentences(found.not_identifiable.iter().map(not_identifiable));
    }
}

/// The model that the recordings support, and the model of the numbers.
fn leakage(found: &Identification) -> Vec<String> {
    let (used, evidence) = (found.tested.leakage_model, &found.evidence);
    let [better, worse] = &evidence.models;
    let by = significant(evidence.difference(), 3);
    let first = match evidence.preferred() {
        Some(model) => format!(
            "The recordings favour {} (`{}`) rather than {}: the information criterion of Schwarz is lower by {by}, where {DECISIVE} is decisive.",
            described(model),
            model.word(),
            described(worse.model)
        ),
        None => format!(
            "The recordings do not decide between {} and {}: the information criterion of Schwarz differs by {by}, where {DECISIVE} would be decisive.",
            described(better.model),
            described(worse.model)
        ),
    };
    let agrees = evidence.preferred().is_none_or(|preferred| preferred == used);
    let but = if agrees { "" } else { ", against the recordings" };
    vec![
        first,
        format!("The numbers below, and the fragment, are for `leakage_model = \"{}\"`{but}.", used.word()),
    ]
}

/// Terms of the valve in addition to edges that open in proportion, and terms that could be added.
fn terms(found: &Identification) -> Vec<String> {
    let named = |one: &TermEvidence| match one.term {
        ValveTerm::Lap => "lap of the edges (`lap`)",
        ValveTerm::Saturation => "openings that saturate (`saturation`)",
        ValveTerm::LeakageByEdge => "leakage with a shape of its own at each edge (`leakage_shapes`)",
    };
    let taken = found.terms.iter().filter(|one| one.taken).map(|one| {
        format!(
            "The recordings ask for {}: with it the criterion is lower by {}.",
            named(one),
            significant(one.gain, 3)
        )
    });
    let left: Vec<String> = found
        .terms
        .iter()
        .filter(|one| !one.taken)
        .map(|one| match one.gain > 0.0 {
            true => format!("{} (lower by {})", named(one), significant(one.gain, 2)),
            false => format!("{} (higher by {})", named(one), significant(-one.gain, 2)),
        })
        .collect();
    let left = (!left.is_empty()).then(|| {
        format!("They do not ask for {}: only a fall of {DECISIVE} is decisive.", left.join(", nor for "))
    });
    let is_doubtful = found.terms.iter().any(|one| one.taken) && !found.misfits().is_empty();
    let doubt = is_doubtful.then(|| {
        "The model does not explain these recordings: what they ask for may stand for something that the model has not, with intervals that \
         do not hold."
            .to_string()
    });
    let has_lap = found.terms.iter().any(|one| one.taken && one.term == ValveTerm::Lap);
    let uneven = (is_doubtful && has_lap).then(|| {
        "The model has one lap for the two edges that a command opens. With blocked ports each port shows its own edges: where the pressures of A \
         and B change at different commands, the laps of the two differ, and no lap of the model is right; state the valve yourself then, with \
         `identify.use = \"nothing\"` and an uncertainty that covers both laps."
            .to_string()
    });
    taken.chain(left).chain(doubt).chain(uneven).collect()
}

fn described(model: LeakageModel) -> &'static str {
    match model {
        LeakageModel::EachEdge => "one secant for each edge",
        LeakageModel::OneCurve => "one curve for the whole valve",
    }
}

fn bootstrap(found: &Bootstrap) -> String {
    let failed = match found.failed {
        0 => String::new(),
        failed => format!(", {failed} of which did not converge and are left out"),
    };
    let rows = if found.block_rows == 1 { "row" } else { "rows" };
    format!("Bootstrap: {} repetitions{failed}, in blocks of {} {rows}.", found.repetitions, found.block_rows)
}

fn coefficients(found: &Identification) -> Vec<Vec<Cell>> {
    let by_hand = by_hand(found);
    let all = COEFFICIENT_NAMES.iter().zip(found.estimates).zip(by_hand).enumerate();
    let in_model: Vec<usize> = found.in_model().collect();
    all.filter(|(index, _)| in_model.contains(index))
        .map(|(index, (((name, unit), estimate), by_hand))| {
            let number = |value: Option<f64>| value.map_or(Cell::Missing, |value| Cell::number(value, 4));
            let ends = |interval: Option<[f64; 2]>| match interval {
                Some([low, high]) => [Some(low), Some(high)].map(number),
                None => [Cell::Missing, Cell::Missing],
            };
            let path = found.path(name);
            let name = path.strip_prefix("valve.").unwrap_or(name);
            let mut row = vec![Cell::Code(name.to_string()), number(estimate.map(|one| one.value))];
            row.extend(ends(estimate.map(|one| one.interval)));
            if let Some(bootstrap) = &found.bootstrap {
                row.extend(ends(estimate.and(bootstrap.intervals.get(index).copied())));
            }
            row.extend([number(by_hand), Cell::unit(*unit)]);
            row
        })
        .collect()
}

/// The simple calculations in the order of the coefficients. The tare flow is at the pressure of
/// the identified one.
///
/// ```text
/// q_tare sqrt(dp_identified/dp_read)
/// ```
fn by_hand(found: &Identification) -> [Option<f64>; STATIC_COEFFICIENTS] {
    let simple = &found.simple;
    let [extending, retracting] = simple.flow_coefficients.map(|one| one.map(|one| one.value));
    let leak = simple.leakage_coefficient().map(|one| one.value);
    let shape = simple.leakage_shape;
    let [tare, bias, width] =
        [simple.tare_flow, simple.null_bias(), simple.hysteresis()].map(|one| one.map(|one| one.value));
    let read_at = simple.leakage_pressure.unwrap_or(found.tested.tare_reference_drop);
    let tare = tare.map(|tare| tare * (found.tested.tare_reference_drop / read_at).sqrt());
    let read =
        [extending, retracting, retracting, extending, leak, leak, leak, leak, shape, tare, bias, width];
    let mut all = [None; STATIC_COEFFICIENTS];
    all.iter_mut().zip(read).for_each(|(one, read)| *one = read);
    all
}

fn signal(found: &Identification, signal: &SignalFit) -> [Cell; 8] {
    let unit = if signal.kind.is_pressure() { DisplayUnit::BAR } else { DisplayUnit::LITRE_PER_MINUTE };
    let file = found.recordings.get(signal.recording).map_or(String::new(), |one| one.file.clone());
    [
        Cell::from(file),
        Cell::from(signal.kind.name().replace('_', " ")),
        Cell::count(signal.rows),
        Cell::number_in(signal.rms, 3, unit),
        Cell::number_in(found.residual_rms_of(signal, &found.first_guess), 3, unit),
        Cell::number_in(signal.range, 4, unit),
        Cell::unit(unit.symbol),
        Cell::decimal(signal.correlation, 2, DisplayUnit::ONE),
    ]
}

/// Remarks on the use of the numbers.
fn remarks(found: &Identification) -> Vec<String> {
    let mut remarks = Vec::new();
    let [starts, agreeing] = found.starts;
    if starts > 1 {
        remarks.push(format!("{agreeing} of {starts} starting points lead to these coefficients."));
    }
    if !found.has_converged() {
        remarks.push("The search did not converge: the numbers are its best so far.".to_string());
    }
    if !found.at_bounds.is_empty() {
        remarks.push(format!("At a bound of the search: {}.", found.at_bounds.join(", ")));
    }
    let zero = COEFFICIENT_NAMES.iter().zip(found.estimates).filter_map(|((name, unit), estimate)| {
        let [least, most] = estimate?.interval;
        let may_vanish = !EITHER_SIGN.contains(name) && least == 0.0;
        may_vanish.then(|| format!("{name}, at most {} {unit}", significant(most, 3)))
    });
    let zero: Vec<String> = zero.collect();
    if !zero.is_empty() {
        remarks.push(format!("These may be zero: {}; the bounds from above have 95 %.", zero.join("; ")));
    }
    remarks.extend(remembered(found));
    let misfits = found.misfits();
    remarks.extend(misfits.iter().map(|one| format!("Misfit: {}.", misfit_in_words(found, one))));
    if !misfits.is_empty() {
        remarks.push("The intervals, those of a bootstrap too, count noise alone: they do not cover what the model does not explain.".to_string());
        remarks.push("Before these numbers are used, look for what is not in the model: a supply pressure that is not recorded, an instrument that reads late (repeat the test at half the speed), an external leak, a transducer with an error of its gain, a column with wrong values.".to_string());
    }
    remarks
}

/// The tests that begin with the memory of earlier cycles.
fn remembered(found: &Identification) -> Option<String> {
    let begun = found.recordings.iter().filter(|one| one.memory_at_start() != 0.0);
    let begun: Vec<String> = begun
        .map(|one| {
            let millivolts = 1e3 * one.memory_at_start();
            format!("{} ({} mV)", one.file, significant(millivolts, 2))
        })
        .collect();
    (!begun.is_empty()).then(|| {
        format!(
            "These tests begin with the memory of earlier cycles, the lag of the spool behind its command: {}.",
            begun.join(", ")
        )
    })
}

fn not_identifiable(found: &NotIdentifiableCombination) -> String {
    let names: Vec<&str> = found.components.iter().map(|(name, _)| *name).collect();
    let first = match names.as_slice() {
        [only] => format!("The data do not determine {only}"),
        several => format!("The data cannot distinguish {}", several.join(", ")),
    };
    let tests: Vec<String> = found.identifiable_by.iter().map(|test| test.name().replace('_', " ")).collect();
    match tests.as_slice() {
        [] => format!("{first}, nor would any of the static tests at 30 % of the command."),
        tests => format!("{first}; a test of {} with all its columns would.", tests.join(" or ")),
    }
}

use phea_dynamics::portable::{argument, log10, magnitude};
use phea_engineering::response::{Averaging, ReferenceSource};

use super::Compared;
use crate::answer::{Csv, OutputFile, significant};
use crate::quantity::DisplayUnit;

/// A table for each member, in the form read by `[family] measured`, and the fragment that names
/// them.
pub fn files(found: &[Compared]) -> Vec<OutputFile> {
    let names: Vec<String> =
        (0..found.len()).map(|index| format!("{}.response.csv", stem(found, index))).collect();
    let mut files: Vec<OutputFile> = found
        .iter()
        .zip(&names)
        .map(|(compared, name)| OutputFile::new(name.clone(), table(compared).text()))
        .collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("    \"{name}\",\n")).collect();
    let fragment = format!(
        "# Measured frequency responses, identified by phea. The first is the nominal plant.\n[family]\nmeasured = [\n{}]\n",
        quoted.concat()
    );
    files.push(OutputFile::new("measured.toml", fragment));
    files
}

/// The file's name without folder and ending; with its number if another file has an equal name.
pub(super) fn stem(found: &[Compared], index: usize) -> String {
    let of = |compared: &Compared| {
        let name = compared.member.file.rsplit(['/', '\\']).next().unwrap_or_default().to_string();
        name.rsplit_once('.').map_or(name.clone(), |(stem, _)| stem.to_string())
    };
    let Some(own) = found.get(index).map(of) else { return String::new() };
    let is_taken = found.iter().take(index).any(|earlier| of(earlier) == own);
    if is_taken { format!("{own}-{}", index + 1) } else { own }
}

fn table(compared: &Compared) -> Csv {
    let member = &compared.member;
    let [input, output] = member.signals;
    let [below, above] = member.units;
    let method = match member.method {
        Averaging::Periods { period, count } => format!("{count} periods of {} s", significant(period, 6)),
        Averaging::LocalPolynomials { length, bands } => {
            let from = match member.reference {
                Some(ReferenceSource::Column(name)) => format!(", from the {name}"),
                Some(ReferenceSource::Controller) => {
                    ", from the reference by the declared controller".to_string()
                }
                None => String::new(),
            };
            format!("local polynomials over {bands} bands of {} s{from}", significant(length, 6))
        }
        Averaging::Segments { length, count, .. } => {
            format!("{count} segments of {} s, Hann window, overlapping by half", significant(length, 6))
        }
    };
    let comment = format!(
        "# Identified by phea from {}: {output} over {input}, 0 dB is 1 {above}/{below}.\n# {method}; frequencies with a squared coherence below {} are left out.\n# standard_deviation and confidence_95 (radius of the disc) in {above}/{below}.",
        member.file,
        significant(member.least_coherence, 3)
    );
    let headings = "frequency_hz,magnitude_db,phase_deg,coherence,standard_deviation,confidence_95";
    let mut csv = Csv::new(&format!("{comment}\n{headings}"));
    for point in &member.points {
        csv.row(&[
            &DisplayUnit::HERTZ.of(point.frequency),
            &(20.0 * log10(magnitude(point.response))),
            &argument(point.response).to_degrees(),
            &point.coherence,
            &point.deviation,
            &point.radius,
        ]);
    }
    csv
}

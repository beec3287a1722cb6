//! The recorded temperature of the oil in the tests.

use phea_dynamics::order::ends;
use phea_hydraulics::servovalve::OilLaw;

use super::recording::Recording;

/// The oil of the tests, against which the coefficients are stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOil {
    /// Its change with the temperature.
    pub law: OilLaw,
    /// degC, that the coefficients are stated at.
    pub reference: f64,
    /// degC, the lowest and the highest of all recordings.
    pub range: [f64; 2],
}

/// Gives each row the oil of its recorded temperature. The coefficients are stated at this
/// temperature, or that which all rows have on average; a test without the column has it
/// throughout. `None` where no test has the column.
pub(super) fn warm(recordings: &mut [Recording], law: OilLaw, stated_at: Option<f64>) -> Option<TestOil> {
    let columns = || recordings.iter().filter_map(|one| one.oil_temperature.as_ref());
    let all = || columns().flatten().copied().filter(|temperature| temperature.is_finite());
    let count = all().count();
    let reference = stated_at.unwrap_or(all().sum::<f64>() / count as f64);
    let range = ends(all());
    for recording in recordings.iter_mut() {
        let Some(temperatures) = &recording.oil_temperature else { continue };
        let read = recording.inputs.iter_mut().zip(temperatures).filter(|(_, one)| one.is_finite());
        for (input, temperature) in read {
            input.oil = law.warmer(temperature - reference);
        }
    }
    (count > 0).then_some(TestOil { law, reference, range })
}

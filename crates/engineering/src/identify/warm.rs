//! The recorded temperature of the oil in the tests.

use phea_dynamics::order::ends;
use phea_hydraulics::servovalve::OilLaw;

use super::recording::Recording;

/// Oil of the tests, to which the coefficients refer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOil {
    /// Variation of the oil with the temperature.
    pub law: OilLaw,
    /// Temperature to which the coefficients refer, degC.
    pub reference: f64,
    /// Lowest and highest temperature of all recordings, degC.
    pub range: [f64; 2],
}

/// Gives each row the oil of its recorded temperature. The coefficients refer to this temperature,
/// or to the average of all rows; a test without the column has this temperature throughout. `None`
/// if no test has the column.
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

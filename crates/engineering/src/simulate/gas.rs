//! How far a run compresses and heats the gas at the chambers.

use phea_dynamics::simulation::Stretch;
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

use super::bench::ControlledMachine;
use super::sum::SignalSum;

/// What became of the gas at a chamber over a run, of the solution itself, between its rows too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasRange {
    /// `a` or `b`.
    pub chamber: char,
    /// Its highest pressure, Pa gauge.
    pub peak_pa: f64,
    /// Its lowest and its highest absolute temperature over that of its wall; `None` of gas that
    /// exchanges no heat, whose exponent says nothing of temperatures.
    pub temperature_ratios: Option<[f64; 2]>,
    /// degC, of its wall, if that is stated.
    pub wall_celsius: Option<f64>,
}

/// Watches the gas at one chamber.
pub(super) struct GasWatch {
    pressure: SignalSum<'static>,
    /// theta - 1 of gas that exchanges heat.
    warming: Option<SignalSum<'static>>,
    range: GasRange,
    warmings: [f64; 2],
}

impl GasWatch {
    /// Of the gas at either chamber that has some.
    pub(super) fn of(bench: &ControlledMachine, wanted: &[usize]) -> Vec<GasWatch> {
        let names = bench.machine.state_names();
        let place = |name: &str| names.iter().position(|known| known == name);
        let one = |place: usize| SignalSum::of(wanted, bench.control.size(), move |state, _| state[place]);
        let gas = bench.rig.actuator.components().gas;
        let watch = |(side, chamber): (usize, char)| {
            gas[side]?;
            let pressure = place(&format!("gas_pressure_{chamber}_pa"))
                .or_else(|| place(&format!("pressure_{chamber}_pa")))?;
            let heated = bench.machine.has_heated_gas()[side];
            let range = GasRange {
                chamber,
                peak_pa: f64::NEG_INFINITY,
                temperature_ratios: None,
                wall_celsius: bench.gas_wall_celsius[side].filter(|_| heated),
            };
            Some(GasWatch {
                pressure: one(pressure),
                warming: place(&format!("gas_warming_{chamber}")).map(one),
                range,
                warmings: [f64::INFINITY, f64::NEG_INFINITY],
            })
        };
        [(0, 'a'), (1, 'b')].into_iter().filter_map(watch).collect()
    }

    pub(super) fn follow(&mut self, stretch: &Stretch<'_>) {
        let pressure = self.pressure.over(stretch.states);
        if pressure.bounds()[1] > self.range.peak_pa {
            self.range.peak_pa = self.range.peak_pa.max(pressure.extremes([0.0, 1.0])[1]);
        }
        let Some(warming) = &self.warming else { return };
        let warming = warming.over(stretch.states);
        let ([low, high], [least, most]) = (warming.bounds(), self.warmings);
        if low < least || high > most {
            let [low, high] = warming.extremes([0.0, 1.0]);
            self.warmings = [least.min(low), most.max(high)];
        }
    }

    /// What became of it; `None` of a run without a step.
    pub(super) fn finish(self) -> Option<GasRange> {
        let ratios = self.warming.map(|_| self.warmings.map(|warming| 1.0 + warming));
        (self.range.peak_pa > -ATMOSPHERIC_PRESSURE_ABSOLUTE)
            .then_some(GasRange { temperature_ratios: ratios, ..self.range })
    }
}

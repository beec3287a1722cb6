//! The record of a run: samples of the machine and its controller, evenly spaced in time.

use phea_hydraulics::machine::MachineSignals;
use phea_hydraulics::signal::Signal;

use super::columns::SignalParts;
use phea_quantity::Units;

/// Largest number of samples of a run that its record stores.
const MOST_KEPT: usize = 100_000;

/// The machine and its controller at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Reference, N; at a step, the value after it. `None` in an open loop.
    pub reference_n: Option<f64>,
    /// Reference after the prefilter, N. `None` in an open loop.
    pub filtered_reference_n: Option<f64>,
    /// Output of the controller, or the command of an open loop, V.
    pub control_v: f64,
    /// External force on the load, if there is one, N.
    pub external_force_n: Option<f64>,
    /// The signals of the machine.
    pub machine: MachineSignals,
    /// The signals of the controller.
    pub control: ControlSignals,
}

/// Signals of a controller in addition to reference and output; for an open loop the command,
/// without an integral part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControlSignals {
    /// Command as it reaches the valve, after the delay of the loop, V.
    pub command_v: f64,
    /// Command of the controller before its limit, V.
    pub unlimited_v: f64,
    /// Integral part of the command, V.
    pub integral_v: f64,
    /// Measured force, after the sensor, with the contribution of a virtual impedance, N.
    pub measurement_n: f64,
    /// Contribution of a virtual impedance to the force before the sensor, N.
    pub virtual_force_n: f64,
}

/// Samples over time: every one or, in a long run, every second, fourth, eighth and so on, so that
/// at most a hundred thousand are stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Reference, N; at a step, the value after it. Empty in an open loop.
    pub reference_n: Vec<f64>,
    /// The samples.
    pub samples: Vec<Sample>,
    /// Number of samples of the run between two of these.
    pub stride: u64,
    /// Units of display, and the motion of the rig: if it turns, positions are in rad and forces in
    /// N m.
    pub units: Units,
    /// Parts of the rig that determine its signals.
    pub parts: SignalParts,
}

impl Default for Record {
    fn default() -> Record {
        Record {
            times_s: Vec::new(),
            reference_n: Vec::new(),
            samples: Vec::new(),
            stride: 1,
            units: Units::default(),
            parts: SignalParts::default(),
        }
    }
}

impl Record {
    /// A signal over time; empty if the rig lacks it, and for the reference of an open loop.
    pub fn signal(&self, signal: Signal) -> Vec<f64> {
        let is_reference = matches!(signal, Signal::Reference | Signal::FilteredReference);
        if !self.parts.have(signal) || (is_reference && self.reference_n.is_empty()) {
            return Vec::new();
        }
        self.samples.iter().map(|sample| self.parts.value(signal, sample)).collect()
    }

    /// Allocates memory for this many samples at once, but at most for those that a long run
    /// stores.
    pub(super) fn reserve(&mut self, samples: usize) {
        let samples = samples.min(MOST_KEPT + 1);
        self.times_s.reserve(samples);
        self.samples.reserve(samples);
    }

    /// Stores the sample with this index, counted from zero, or omits it.
    pub(super) fn take(&mut self, number: u64, sample: &Sample) {
        if !number.is_multiple_of(self.stride) {
            return;
        }
        self.times_s.push(sample.time_s);
        self.reference_n.extend(sample.reference_n);
        self.samples.push(*sample);
        if self.times_s.len() > MOST_KEPT {
            self.halve();
        }
    }

    fn halve(&mut self) {
        every_second(&mut self.times_s);
        every_second(&mut self.reference_n);
        every_second(&mut self.samples);
        self.stride *= 2;
    }
}

/// Reduces to the first value, the third and so on.
fn every_second<T>(values: &mut Vec<T>) {
    let mut kept = false;
    values.retain(|_| {
        kept = !kept;
        kept
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record of a run of any length is short, evenly spaced, and begins with the first sample.
    #[test]
    fn a_record_is_even_and_never_long() {
        let parts = SignalParts { external_force: true, ..SignalParts::default() };
        let mut record = Record { parts, ..Record::default() };
        let samples = 7 * MOST_KEPT as u64 / 2;
        for number in 0..samples {
            let time_s = number as f64;
            record.take(
                number,
                &Sample {
                    time_s,
                    reference_n: Some(time_s),
                    filtered_reference_n: Some(time_s),
                    control_v: time_s,
                    external_force_n: Some(time_s),
                    machine: MachineSignals { force: time_s, ..MachineSignals::default() },
                    control: ControlSignals { integral_v: time_s, ..ControlSignals::default() },
                },
            );
            assert!(record.times_s.len() <= MOST_KEPT);
        }
        assert_eq!(record.stride, 4);
        let expected: Vec<f64> = (0..samples).step_by(4).map(|number| number as f64).collect();
        assert!(record.times_s == expected && record.reference_n == expected);
        for signal in [
            Signal::Time,
            Signal::Reference,
            Signal::FilteredReference,
            Signal::Control,
            Signal::ExternalForce,
            Signal::Force,
            Signal::Integral,
        ] {
            assert!(record.signal(signal) == expected, "{signal:?}");
        }
        assert!(record.signal(Signal::ExternalTorque).is_empty());
    }
}

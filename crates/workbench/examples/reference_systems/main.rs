//! Random linear systems with everything phea computes of them, as JSON, for comparison with other
//! tools: `cargo run --example reference_systems`.
#![allow(clippy::print_stdout, reason = "an example talks to the person who started it")]

mod generator;

use num_complex::Complex64;
use phea_dynamics::frequency::{logarithmic_grid, margins};
use phea_dynamics::linear::{Discretization, LinearError, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_dynamics::time_response::{
    SampledSignal, StepBaseline, TimeResponseError, forced_response_of_states, step_metrics, step_response,
};
use serde_json::{Value, json};

use generator::{Form, ReferenceSystem, reference_systems};

/// Settling band of the step metrics, percent.
const SETTLING_BAND_PERCENT: f64 = 2.0;

/// Prints one JSON array.
fn main() -> Result<(), TimeResponseError> {
    let systems = reference_systems()?;
    let described: Result<Vec<Value>, TimeResponseError> =
        systems.iter().enumerate().map(|(index, system)| described(index, system)).collect();
    println!("{}", Value::Array(described?));
    Ok(())
}

fn described(index: usize, system: &ReferenceSystem) -> Result<Value, TimeResponseError> {
    let factors = system.factors()?;
    let (low, high) = band(&factors);
    let frequencies = logarithmic_grid(low, high, 25)?;
    let sample_time_s = match factors.domain() {
        TimeDomain::Continuous => Value::Null,
        TimeDomain::Discrete { sample_time_s } => json!(sample_time_s),
    };
    let mut value = json!({
        "index": index,
        "sample_time_s": sample_time_s,
        "form": form(system),
        "factors_found": factors_as_json(&factors),
        "poles": complex(&system.poles()?),
        "response": response(&frequencies, |w| system.at_frequency(w))?,
        "margins": margins_as_json(&factors),
        "step": step(system, &factors)?,
    });
    if factors.domain() == TimeDomain::Continuous {
        let step = sampling_time(&factors);
        for (name, method) in
            [("tustin", Discretization::Tustin), ("zero_order_hold", Discretization::ZeroOrderHold)]
        {
            value[name] = sampled(&system.discretized(step, method)?, step)?;
        }
    }
    Ok(value)
}

fn form(system: &ReferenceSystem) -> Value {
    match &system.form {
        Form::Factored(factors) => factors_as_json(factors),
        Form::States(states) => {
            let rows = |matrix: &nalgebra::DMatrix<f64>| -> Vec<Vec<f64>> {
                matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
            };
            json!({ "a": rows(states.a()), "b": rows(states.b()), "c": rows(states.c()), "d": rows(states.d()) })
        }
    }
}

fn factors_as_json(factors: &TransferFunction) -> Value {
    json!({
        "gain": factors.gain(),
        "zeros": complex(factors.zeros()),
        "poles": complex(factors.poles()),
    })
}

fn complex(values: &[Complex64]) -> Vec<[f64; 2]> {
    values.iter().map(|value| [value.re, value.im]).collect()
}

fn response(
    frequencies: &[f64],
    at_frequency: impl Fn(f64) -> Result<Complex64, LinearError>,
) -> Result<Value, LinearError> {
    let values: Result<Vec<Complex64>, LinearError> = frequencies.iter().map(|&w| at_frequency(w)).collect();
    Ok(json!({ "frequencies_rad_per_s": frequencies, "values": complex(&values?) }))
}

fn margins_as_json(factors: &TransferFunction) -> Value {
    let found = margins(factors);
    // an end of the axis that is infinite is named as text
    let number = |value: f64| if value.is_finite() { json!(value) } else { json!("inf") };
    let gain =
        found.gain_margins.iter().map(|margin| [number(margin.frequency_rad_per_s), number(margin.factor)]);
    let phase = found.phase_margins.iter().map(|margin| {
        json!({
            "frequency_rad_per_s": margin.frequency_rad_per_s,
            "phase_deg": margin.phase_deg,
            "delay_s": margin.delay_s,
        })
    });
    json!({
        "gain": gain.collect::<Vec<_>>(),
        "phase": phase.collect::<Vec<_>>(),
        "modulus": found.modulus_margin.distance,
        "modulus_frequency_rad_per_s": number(found.modulus_margin.frequency_rad_per_s),
        "delay_s": number(found.delay_margin_s()),
    })
}

/// Frequencies of interest: a decade beyond the slowest and the fastest root, or up to the last
/// sampled one.
fn band(factors: &TransferFunction) -> (f64, f64) {
    let roots = factors.poles().iter().chain(factors.zeros());
    match factors.domain() {
        TimeDomain::Continuous => {
            let sizes: Vec<f64> = roots.map(|root| magnitude(*root)).filter(|size| *size > 0.0).collect();
            let low = sizes.iter().copied().fold(1e6, f64::min);
            (0.1 * low, 10.0 * sizes.iter().copied().fold(low, f64::max))
        }
        TimeDomain::Discrete { sample_time_s } => {
            let nyquist = std::f64::consts::PI / sample_time_s;
            (1e-3 * nyquist, 0.99 * nyquist)
        }
    }
}

/// Three samples in a radian of the fastest pole.
fn sampling_time(factors: &TransferFunction) -> f64 {
    0.3 / factors.poles().iter().map(|pole| magnitude(*pole)).fold(1e-3, f64::max)
}

fn sampled(system: &ReferenceSystem, sample_time_s: f64) -> Result<Value, LinearError> {
    let nyquist = std::f64::consts::PI / sample_time_s;
    let mut frequencies = logarithmic_grid(1e-4 * nyquist, 0.99 * nyquist, 25)?;
    if matches!(system.form, Form::States(_)) {
        // what the rounding of dense sampled matrices covers up no computation can bring back
        let size = |w: f64| system.at_frequency(w).map_or(0.0, magnitude);
        let largest = frequencies.iter().map(|&w| size(w)).fold(0.0, f64::max);
        frequencies.retain(|&w| size(w) > 1e-5 * largest);
    }
    Ok(json!({
        "sample_time_s": sample_time_s,
        "poles": complex(&system.poles()?),
        "response": response(&frequencies, |w| system.at_frequency(w))?,
    }))
}

/// Samples of the step response over five slowest time constants, and the metrics read off these
/// samples.
fn step(system: &ReferenceSystem, factors: &TransferFunction) -> Result<Value, TimeResponseError> {
    if !factors.is_stable() || factors.dc_gain() == 0.0 {
        return Ok(Value::Null);
    }
    let times: Vec<f64> = match factors.domain() {
        TimeDomain::Continuous => {
            let slowest = factors.poles().iter().map(|pole| -pole.re).fold(f64::INFINITY, f64::min);
            (0..=1000).map(|k| f64::from(k) * (5.0 / slowest / 1000.0)).collect()
        }
        TimeDomain::Discrete { sample_time_s } => (0..=1000).map(|k| f64::from(k) * sample_time_s).collect(),
    };
    let values = match &system.form {
        Form::Factored(factors) => step_response(factors, &times)?,
        Form::States(states) => {
            let rest = nalgebra::DVector::zeros(states.order());
            let outputs = forced_response_of_states(states, &rest, &[SampledSignal::step(1.0)], &times)?;
            outputs.iter().map(|output| output[0]).collect()
        }
    };
    let final_value = factors.dc_gain();
    let metrics = step_metrics(&times, &values, StepBaseline::to_value(final_value), SETTLING_BAND_PERCENT)?;
    Ok(json!({
        "times_s": times,
        "values": values,
        "final_value": final_value,
        "settling_band_percent": SETTLING_BAND_PERCENT,
        "rise_time_10_90_s": metrics.rise_time_10_90_s,
        "peak_time_s": metrics.peak_time_s,
        "peak_value": metrics.peak_value,
        "overshoot_percent": metrics.overshoot_percent,
        "settling_time_s": metrics.settling.time_s(),
    }))
}

impl ReferenceSystem {
    fn factors(&self) -> Result<TransferFunction, LinearError> {
        match &self.form {
            Form::Factored(factors) => Ok(factors.clone()),
            Form::States(states) => states.to_transfer_function(0, 0),
        }
    }

    fn poles(&self) -> Result<Vec<Complex64>, LinearError> {
        match &self.form {
            Form::Factored(factors) => Ok(factors.poles().to_vec()),
            Form::States(states) => states.poles(),
        }
    }

    fn at_frequency(&self, frequency: f64) -> Result<Complex64, LinearError> {
        match &self.form {
            Form::Factored(factors) => Ok(factors.at_frequency(frequency)),
            Form::States(states) => states.at_frequency(frequency, 0, 0),
        }
    }

    fn discretized(&self, sample_time_s: f64, method: Discretization) -> Result<Self, LinearError> {
        let form = match &self.form {
            Form::Factored(factors) => Form::Factored(factors.discretized(sample_time_s, method)?),
            Form::States(states) => Form::States(StateSpace::discretized(states, sample_time_s, method)?),
        };
        Ok(ReferenceSystem { form })
    }
}

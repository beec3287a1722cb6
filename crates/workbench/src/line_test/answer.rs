use super::{
    LineIdentification, NotIdentifiableLine, ResponseFit, RiseFit, VolumeSource, because, misfit_in_words,
    numbers, remark,
};
use crate::answer::{self, Object};
use crate::estimate::Estimate;
use crate::project::{LineSide, Loaded};

/// The JSON object of `identify --of line`.
pub fn json(loaded: &Loaded, found: &LineIdentification) -> String {
    let mut line = Object::new();
    for (key, _, number) in numbers(found) {
        line = line.with(key, estimate(number));
    }
    let chamber = match found.known.side {
        LineSide::A => "a",
        LineSide::B => "b",
    };
    let line = line
        .with("chamber", chamber)
        .with("pressure_pa", found.pressure)
        .with("volume_m3", found.known.volume())
        .each("misfits", found.misfits(), |one| {
            Object::new()
                .with("file", one.file.as_str())
                .with("signal", one.signal)
                .with("share", one.fraction)
                .with("neighbour_correlation", one.correlation)
        })
        .each("warnings", found.misfits(), |one| {
            Object::new().with("message", misfit_in_words(&one)).with("file", one.file.as_str())
        })
        .maybe("remark", remark(&found.known))
        .with("pressure_rise", found.rise.as_ref().map(rise))
        .with("frequency_response", found.response.as_ref().map(|fit| response(found, fit)));
    Object::new()
        .with("schema", answer::SCHEMA)
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("command", "identify")
        .with("project_sha256", loaded.sha256.as_str())
        .with("line", line)
        .print(loaded.project.motion())
}

fn estimate(number: &Result<Estimate, NotIdentifiableLine>) -> Object {
    let object = Object::new();
    match number {
        Ok(Estimate { value, interval }) => object
            .with("value", *value)
            .with("confidence_95", interval.to_vec())
            .with("reason", None::<String>),
        Err(reason) => object
            .with("value", None::<f64>)
            .with("confidence_95", None::<f64>)
            .with("reason", because(*reason)),
    }
}

fn rise(fit: &RiseFit) -> Object {
    let [low, high] = fit.pressures;
    let tangent = |pressure: f64| {
        let [value, deviation] = fit.compliance(pressure);
        Object::new()
            .with("pressure_pa", pressure)
            .with("compliance_m3_per_pa", value)
            .with("standard_deviation", deviation)
    };
    Object::new()
        .with("file", fit.record.file.as_str())
        .with("rows", fit.record.pressures.len())
        .with("volume_from", source(fit.record.source))
        .with("pressures_pa", [low, high])
        .with("terms", fit.terms())
        .each("compliance", [low, f64::midpoint(low, high), high], tangent)
        .known(
            "drift_m3_per_s",
            fit.drift,
            "the record has no standstill that separates it from the compliance",
        )
        .with("volume_noise_m3", fit.white_noise)
        .with("volume_walk_m3", fit.walk)
}

/// As a column is called.
fn source(source: VolumeSource) -> &'static str {
    match source {
        VolumeSource::Flow => "flow",
        VolumeSource::Volume => "volume",
        VolumeSource::Position => "position",
    }
}

fn response(found: &LineIdentification, fit: &ResponseFit) -> Object {
    let [misfit, freedom] = fit.misfit;
    let points = fit.compliances(&found.known);
    Object::new()
        .with("file", fit.member.file.as_str())
        .with("rows", fit.member.rows)
        .with("pressure_pa", fit.pressure)
        .with("misfit", misfit)
        .with("degrees_of_freedom", freedom)
        .with("explained", fit.is_explained())
        .each("compliance", points, |point| {
            Object::new()
                .with("frequency_rad_per_s", point.frequency)
                .with("compliance_m3_per_pa", point.measured)
                .with("confidence_95", point.edge)
                .with("model_m3_per_pa", point.model)
                .with("coherence", point.coherence)
        })
}

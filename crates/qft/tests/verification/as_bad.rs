//! Two equally bad plants at different frequencies.

use phea_dynamics::controller::Timing;
use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::verification::{PlantPoint, TrackingJudgement};

use super::plants::{audited, compensation, parameter, rational, specification};

/// Plant a^2/(s (s + a)): P(s/a) for P = 1/(s (s + 1)).
fn scaled<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[0]],
            denominator: vec![1.0.into(), p[0], 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    }
}

/// A plant whose frequencies are those of another times 10 has an equal peak of |S| there.
#[test]
fn a_plant_scaled_in_frequency_is_as_bad() {
    let plant = UncertainPlant::record(vec![parameter("a", 1.0, 1.0, 10.0)], scaled).unwrap();
    let members = vec![vec![1.0], vec![10.0]];
    let family = Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members).unwrap());
    let around = compensation(rational(&[1.0], &[1.0]), rational(&[1.0], &[1.0]), Timing::default());
    let limit = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0));
    let limit = specification(limit, &[1.0], [0.0, f64::INFINITY]);
    let (findings, _) = audited(&family, &around, &[limit], TrackingJudgement::Magnitude);
    let worst = findings[0].worst.as_ref().unwrap();
    let [other] = findings[0].as_bad.as_slice() else { panic!("{:?}", findings[0].as_bad) };
    assert!((worst.margin_db - other.margin_db).abs() < 1e-6);
    let ratio = worst.frequency_rad_per_s / other.frequency_rad_per_s;
    assert!((ratio - 10.0).abs() < 1e-3 || (ratio - 0.1).abs() < 1e-5, "{ratio}");
    let scale = |plant: &PlantPoint| match plant {
        PlantPoint::Parameters(values) => values[0],
        _ => f64::NAN,
    };
    assert!((scale(&worst.plant) / scale(&other.plant) - ratio).abs() < 1e-3 * ratio);
}

//! The rig of the thesis as numbers, for tests of a crate without hydraulics.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::RationalCoefficients;

/// Command to force by equation 6.7 with A = 1.58336e-3 m2; parameters f_v, K_qU, K_c, K_H, w_nv,
/// xi_v, then M and K_S, by default 13.1 kg and 2e7 N/m.
pub(crate) fn force<S: Scalar>(p: &[S]) -> RationalCoefficients<S> {
    let &[friction, flow_gain, leakage, stiffness, w, damping, ref others @ ..] = p else {
        panic!("six parameters or eight")
    };
    let (mass, sensor) = match *others {
        [] => (S::from(13.1), S::from(2e7)),
        [mass, sensor] => (mass, sensor),
        _ => panic!("six parameters or eight"),
    };
    let area = S::from(1.58336e-3);
    let (area2, w2, spool) = (area * area, w * w, S::from(2.0) * damping * w);
    let (leak, springs) = (leakage * stiffness, stiffness + sensor);
    let denominator = vec![
        area2 * mass,
        spool * area2 * mass + area2 * friction + leak * mass,
        spool * area2 * friction + w2 * area2 * mass + leak * (spool * mass + friction) + area2 * springs,
        spool * area2 * springs + w2 * area2 * friction + leak * (spool * friction + w2 * mass + sensor),
        w2 * area2 * springs + leak * (spool * sensor + w2 * friction),
        w2 * leak * sensor,
    ];
    RationalCoefficients { numerator: vec![area * stiffness * flow_gain * sensor * w2], denominator }
}

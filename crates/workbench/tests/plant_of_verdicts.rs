//! The plant of every verdict, for tests of the effects of accumulators.

use num_complex::Complex64;
use phea_qft::family::Family;
use phea_workbench::engineering::family::family;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::Project;
use phea_workbench::source::Memory;

/// Responses F_e/U_C and F_e/X_0 at a frequency in rad/s.
pub(crate) fn responses(project: &Project, frequency: f64) -> [Complex64; 2] {
    let setup = Setup::new(project).unwrap();
    let rig = setup.rig().unwrap();
    if let Some(moving) = &rig.in_motion {
        return moving.response(Complex64::new(0.0, frequency));
    }
    let coefficients = rig.plant.coefficients();
    [Some(coefficients.command), coefficients.disturbance].map(|path| path.unwrap().at_frequency(frequency))
}

/// Fails unless the nominal member of the recorded family is the rig itself.
pub(crate) fn assert_nominal_is_the_rig(project: &Project, what: &[&str]) {
    let setup = Setup::new(project).unwrap();
    let Family::Uncertain(family) = family(&setup, &Memory::default()).unwrap() else { panic!("a box") };
    let nominal: Vec<f64> = family.plant().parameters().iter().map(|one| one.nominal).collect();
    let paths = family.plant().coefficients(&nominal).unwrap();
    for frequency in [0.1, 10.0, 400.0, 640.0, 1300.0] {
        let of_family = [Some(&paths.command), paths.disturbance.as_ref()]
            .map(|path| path.unwrap().at_frequency(frequency));
        for (own, paths) in responses(project, frequency).into_iter().zip(of_family) {
            assert!((own / paths - 1.0).norm_sqr() < 1e-20, "{what:?}: {own} {paths}");
        }
    }
}

/// A project without its ranges of uncertainty.
pub(crate) fn without_uncertainty(text: &str) -> String {
    let before = text.split("[uncertainty]").next().unwrap();
    let after = text.split_once("[[specification]]").unwrap().1;
    format!("{before}[[specification]]{after}")
}

//! The reserve of a design is satisfied by every plant of the family, not only by those of its
//! samples.

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable::{log10, magnitude};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::DesignOptions;
use phea_qft::family::Family;
use phea_qft::verification::TrackingJudgement;

use super::problems::{assert_met, audited, designed, example_d, least_gain, structure};

/// Number of plants along each parameter, and of frequencies, of the dense check.
const ALONG: usize = 17;
const FREQUENCIES: usize = 600;
/// Accuracy to which a reserve is satisfied, dB.
const WITHIN_DB: f64 = 1e-3;

#[test]
fn every_plant_satisfies_the_reserve() {
    let problem = example_d();
    for reserve_db in [0.5, 0.2] {
        let structure = structure("Z PP", [1e-2, 1e4], [0.1, 1e5], [0.1, 5.0]);
        let design = designed(&problem, DesignOptions { reserve_db, ..least_gain(structure, 1) });
        assert_met(&problem, &design, TrackingJudgement::Spread);
        let around = Compensation::new(&design.controller, problem.sensor.clone()).unwrap();
        let Family::Uncertain(family) = &problem.family else { panic!("a box") };
        let count = family.coordinates().len();
        let plants: Vec<Vec<f64>> = (0..ALONG.pow(count as u32))
            .map(|number| {
                let fraction =
                    |axis: usize| (number / ALONG.pow(axis as u32) % ALONG) as f64 / (ALONG - 1) as f64;
                family.values(&(0..count).map(fraction).collect::<Vec<f64>>())
            })
            .collect();
        let mut least_db = [f64::INFINITY; 2];
        for frequency in logarithmic_grid(0.1, 1e4, FREQUENCIES).unwrap() {
            let feedback = around.feedback().at_frequency(frequency);
            let sizes = plants.iter().map(|plant| {
                let open = family.plant().response(plant, frequency).unwrap() * feedback;
                magnitude(open / (1.0 + open))
            });
            let [low, high] =
                sizes.fold([f64::INFINITY, 0.0_f64], |[low, high], size| [low.min(size), high.max(size)]);
            let stability_db = 20.0 * log10(1.2 / high);
            least_db[0] = least_db[0].min(stability_db - reserve_db);
            if frequency <= 15.0 {
                let (lower, upper) = problem.specifications[1].requirement.limits();
                let lower = lower.unwrap().magnitude(frequency).unwrap();
                let room_db = 20.0 * log10(upper.magnitude(frequency).unwrap() / lower);
                let spread_db = room_db - 20.0 * log10(high / low);
                let reserved = (room_db / (4.0 * reserve_db).max(1.0)).clamp(0.0, 1.0);
                least_db[1] = least_db[1].min(spread_db - 2.0 * reserve_db * reserved);
            }
        }
        assert!(least_db.iter().all(|least| *least > -WITHIN_DB), "{reserve_db} dB: {least_db:?}");
        // the limits are reached except for the reserve
        let audit = audited(&problem, &design, TrackingJudgement::Spread);
        let worst_db = audit.specifications[0].worst.as_ref().unwrap().margin_db;
        assert!(worst_db > reserve_db - WITHIN_DB && worst_db < reserve_db + 0.01, "{worst_db}");
    }
}

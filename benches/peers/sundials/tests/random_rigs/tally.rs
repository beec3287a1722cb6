//! Results over all rigs of a family.

use std::collections::BTreeMap;

use phea_dynamics::simulation::Status;

use crate::compare::{Compared, Ours, TOLERANCE};
use crate::repeated::Judged;
use crate::roughness::Roughness;
use crate::{Described, FINER, LARGEST_ERROR, Outcome};

/// Largest difference between the machine and `closed_loop.h`, fraction of the peak.
const LARGEST_DIFFERENCE: f64 = 1e-4;

#[derive(Default)]
pub(crate) struct Tally {
    run: usize,
    refused: BTreeMap<String, usize>,
    without_reference: usize,
    /// Number of rigs on which phea stops because a chamber has emptied.
    without_model: usize,
    features: BTreeMap<&'static str, usize>,
    hunting: usize,
    rough: usize,
    /// Fractions of compared rows, for rigs whose trajectories separate.
    separating: Vec<f64>,
    errors: Vec<f64>,
    /// Number of rigs whose error exceeds the largest in any row, separated or not.
    exceeding: usize,
    beyond: Vec<f64>,
    /// Rigs and windows that ring, windows in which the strength is known, and ratios to CVODE's
    /// ringing.
    ringing: [usize; 3],
    least: Vec<f64>,
    most: Vec<f64>,
    steps: u64,
    evaluations: u64,
    /// Runs at the default tolerance: errors, and descriptions of those that would be failures.
    default_errors: Vec<f64>,
    default_faults: Vec<String>,
    default_steps: u64,
    checks: Checks,
    projects: Projects,
    twins: Vec<f64>,
    /// Ratios of CVODE's seconds and evaluations to phea's: with its stability limit, and by Adams'
    /// method.
    ratios: [[Vec<f64>; 2]; 2],
    /// Ill-posed rigs that fail at the tolerance at which they are judged, but not at a finer one.
    ill_posed: Vec<String>,
    failures: Vec<String>,
}

/// Results of runs in the form of a project's.
#[derive(Default)]
struct Projects {
    /// Outcomes of their repetitions, with their counts and that of the runs made once.
    agreements: BTreeMap<String, usize>,
    of_rows: Vec<f64>,
    of_metrics: Vec<f64>,
    /// Numbers of rigs whose rows, and whose metrics, CVODE does not determine to the largest
    /// error.
    unknown: [usize; 2],
    steps: u64,
}

impl Projects {
    fn take(&mut self, judged: &Judged) {
        let word = judged.repetition.as_ref().map_or("made once".to_string(), |repetition| {
            format!("{:?}", repetition.agreement).to_lowercase()
        });
        *self.agreements.entry(word).or_default() += 1;
        self.of_rows.push(judged.of_rows);
        self.of_metrics.push(judged.of_metrics.map_or(0.0, |spread| spread.part));
        for (count, part) in self.unknown.iter_mut().zip(judged.of_truth) {
            *count += usize::from(part >= LARGEST_ERROR);
        }
        self.steps += judged.steps;
    }

    fn print(&mut self) {
        if self.of_rows.is_empty() {
            return;
        }
        let [rows, metrics] = self.unknown;
        println!("as projects: {:?}, {} steps", self.agreements, self.steps);
        println!("CVODE differs from itself in the rows of {rows} rigs, in metrics of {metrics}");
        spread("error of rows, part of the peak", &mut self.of_rows);
        spread("error of metrics, part of their size", &mut self.of_metrics);
    }
}

/// Error at the default tolerance as estimated by a run at a tenth of it.
#[derive(Default)]
struct Checks {
    well_posed: usize,
    /// Errors over all rows of well-posed rigs.
    errors: Vec<f64>,
    /// Rigs whose error at the default tolerance exceeds the largest, and rigs whose error does
    /// not: their number, and those with the report that errors may be visible, with a check that
    /// shows them, and with either.
    reported: [[usize; 4]; 2],
    /// Ratio of the true error to the checked one, if either exceeds the largest: for well-posed
    /// rigs, and for the others.
    factors: [Vec<f64>; 2],
}

impl Tally {
    pub(crate) fn take(&mut self, number: u64, outcome: &Outcome, print_each: bool) {
        self.run += 1;
        match outcome {
            Ok((described, compared)) => {
                if print_each {
                    print_comparison(described, compared);
                }
                for feature in &described.features {
                    *self.features.entry(feature).or_default() += 1;
                }
                self.judge(number, described, compared);
            }
            Err(refusal) => {
                println!("rig {number}: refused: {refusal}");
                let kind = refusal.split(' ').filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
                *self.refused.entry(kind.collect::<Vec<_>>().join(" ")).or_default() += 1;
            }
        }
    }

    pub(crate) fn passes(&self) -> bool {
        self.failures.is_empty()
    }

    fn judge(&mut self, number: u64, described: &Described, compared: &Compared) {
        let Some(ours) = compared.ours else { return };
        if let Some(reason) = &compared.without_reference {
            self.without_reference += 1;
            println!("rig {number}: {reason}; phea: {:?}", ours.status);
            return;
        }
        self.hunting += usize::from(compared.hunts);
        self.rough += usize::from(compared.rough);
        self.exceeding += usize::from(ours.error_of_all >= LARGEST_ERROR);
        if compared.separates() {
            self.separate(number, compared, &ours);
        }
        if compared.leaves_the_model() {
            println!("rig {number}: {:?}, where a chamber has no fluid any more", ours.status);
            self.without_model += 1;
        } else {
            match (ours.fault(), &described.at_finer) {
                (None, _) => {}
                (Some(fault), None) => self.failures.push(format!("rig {number}: {fault}")),
                (Some(fault), Some(Ok(()))) => {
                    self.ill_posed.push(format!("rig {number}, ill posed: {fault}; none at {FINER:e}"));
                }
                (Some(fault), Some(Err(finer))) => {
                    self.failures.push(format!("rig {number}: {fault}; at {FINER:e} {finer}"));
                }
            }
            self.take_default(number, compared);
        }
        if let Some(twin) = compared.twin {
            self.twins.push(twin);
            if twin >= LARGEST_DIFFERENCE {
                self.failures.push(format!("rig {number}: {twin:.1e} of the peak from closed_loop.h"));
            }
        }
        self.errors.push(ours.error);
        self.steps += ours.work.steps + ours.work.rejected;
        self.evaluations += ours.work.evaluations;
        for (ratios, cost) in self.ratios.iter_mut().zip(compared.costs_of_cvode) {
            let Some(cost) = cost else { continue };
            let parts = [cost.seconds / ours.seconds, cost.evaluations / ours.work.evaluations as f64];
            ratios.iter_mut().zip(parts).for_each(|(ratios, part)| ratios.push(part));
        }
    }

    /// Adds the reports on a rig whose trajectories separate.
    fn separate(&mut self, number: u64, compared: &Compared, ours: &Ours) {
        let (rows, of) = (compared.rows, compared.growth.len());
        self.separating.push(rows as f64 / of as f64);
        self.beyond.push(ours.beyond);
        let growth = compared.growth.last().copied().unwrap_or_default();
        let mut ringing = "does not ring".to_string();
        if let Some(roughness) = ours.roughness.filter(|roughness| roughness.windows > 0) {
            let Roughness { windows, known, .. } = roughness;
            self.ringing = [self.ringing[0] + 1, self.ringing[1] + windows, self.ringing[2] + known];
            self.least.push(roughness.least);
            self.most.push(roughness.most);
            ringing = format!(
                "rings with {:.2} of the least, {:.2} of the most that CVODE finds, {} windows",
                roughness.least, roughness.most, roughness.windows
            );
        }
        println!(
            "rig {number}: separates after {rows} of {of} rows, growth {growth:.1e}; error {:.1e} until then, {:.1e} in all, \
             {:.1} times the growth of one tolerance; {ringing}",
            ours.error, ours.error_of_all, ours.beyond
        );
    }

    fn take_default(&mut self, number: u64, compared: &Compared) {
        let Some(run) = compared.by_default else { return };
        self.default_errors.push(run.error);
        self.default_steps += run.work.steps + run.work.rejected;
        if let Some(fault) = run.fault() {
            let finding = format!("rig {number}, at {TOLERANCE:e}: {fault}");
            let list =
                if run.status == Status::Completed { &mut self.default_faults } else { &mut self.failures };
            list.push(finding);
        }
        if let Some(judged) = &compared.repeated {
            self.projects.take(judged);
            let fault = judged.fault();
            self.failures.extend(fault.map(|fault| format!("rig {number}, as a project: {fault}")));
        }
        if run.status == Status::Completed {
            self.checks.take(number, compared, &run);
        }
    }

    pub(crate) fn print(&mut self) {
        let refused: usize = self.refused.values().sum();
        println!(
            "{} rigs: {refused} refused {:?}, {} without reference, {} end where a chamber has emptied",
            self.run, self.refused, self.without_reference, self.without_model
        );
        println!("of the others have: {:?}", self.features);
        println!("hunting at the end: {}; ringing somewhere: {}", self.hunting, self.rough);
        println!("separate before the end: {}", self.separating.len());
        let [rigs, windows, known] = self.ringing;
        println!(
            "ringing there: {rigs} rigs, {windows} windows, of which CVODE knows how strongly in {known}"
        );
        println!("error above {LARGEST_ERROR:e} in any row: {}", self.exceeding);
        let [[limited, of_limited], [adams, of_adams]] = &mut self.ratios;
        for (name, values) in [
            ("part of the rows before those separate", &mut self.separating),
            ("error, part of the peak", &mut self.errors),
            ("the same at the default tolerance", &mut self.default_errors),
            ("error after separation over the growth of one tolerance", &mut self.beyond),
            ("ringing over the least of CVODE's", &mut self.least),
            ("ringing over the most of CVODE's", &mut self.most),
            ("difference to closed_loop.h, part of the peak", &mut self.twins),
            ("time of CVODE with stability limit over phea's at equal error", limited),
            ("evaluations, likewise", of_limited),
            ("time of CVODE by Adams' method over phea's at equal error", adams),
            ("evaluations, likewise", of_adams),
        ] {
            spread(name, values);
        }
        self.checks.print();
        self.projects.print();
        println!("steps of the run that is judged: {}, evaluations {}", self.steps, self.evaluations);
        println!("steps at {TOLERANCE:e}: {}", self.default_steps);
        for fault in &self.default_faults {
            println!("{fault}");
        }
        for agreed in &self.ill_posed {
            println!("{agreed}");
        }
        for failure in &self.failures {
            println!("FAILED {failure}");
        }
    }
}

impl Checks {
    /// Adds a rig; `run` is that at the default tolerance.
    fn take(&mut self, number: u64, compared: &Compared, run: &Ours) {
        let (error, estimate) = (run.error_of_all, compared.estimate);
        if compared.well_posed {
            self.well_posed += 1;
            self.errors.push(error);
        }
        let larger = error >= LARGEST_ERROR;
        let (grown, checked) = (run.may_show_errors(), estimate >= LARGEST_ERROR);
        let counts = &mut self.reported[usize::from(!larger)];
        for (count, counted) in counts.iter_mut().zip([true, grown, checked, grown || checked]) {
            *count += usize::from(counted);
        }
        if larger && compared.well_posed {
            println!(
                "rig {number}: well posed, errs by {error:.1e} at {TOLERANCE:e}; a check says {estimate:.1e}"
            );
        }
        if larger || estimate >= LARGEST_ERROR {
            let list = usize::from(!compared.well_posed);
            self.factors[list].push(error / estimate);
        }
    }

    fn print(&mut self) {
        println!("well posed: {}", self.well_posed);
        let beyond = self.errors.iter().filter(|error| **error >= LARGEST_ERROR).count();
        println!("of those, error at {TOLERANCE:e} of {LARGEST_ERROR:e} or more in any row: {beyond}");
        for (name, [all, grown, checked, either]) in ["exceeds it", "does not"].iter().zip(self.reported) {
            println!(
                "error at {TOLERANCE:e} {name}: {all} rigs, {grown} report that errors may be visible, a check shows it of {checked}, either of {either}"
            );
        }
        let [well, ill] = &mut self.factors;
        spread("error of well-posed rigs at the default tolerance, all rows", &mut self.errors);
        spread("where error or check exceed it: error over check, well posed", well);
        spread("likewise, the others", ill);
    }
}

pub(crate) fn spread(name: &str, values: &mut [f64]) {
    values.sort_by(f64::total_cmp);
    let at = |fraction: f64| values.get((fraction * values.len().saturating_sub(1) as f64) as usize);
    let (Some(least), Some(tenth), Some(middle), Some(ninetieth), Some(most)) =
        (at(0.0), at(0.1), at(0.5), at(0.9), at(1.0))
    else {
        return;
    };
    println!(
        "{name}: least {least:.2e}, tenth {tenth:.2e}, median {middle:.2e}, ninetieth {ninetieth:.2e}, most {most:.2e} ({})",
        values.len()
    );
}

fn print_comparison(described: &Described, compared: &Compared) {
    println!("{:?}\n{:?}\npeak {} N", described.features, described.control, compared.peak);
    if let Some(ours) = compared.ours {
        println!("{ours:?}\n{:?}", compared.by_default);
    }
}

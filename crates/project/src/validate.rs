//! Conditions between the values of a project, in addition to the range of each.

mod adjustment;
mod alternative;
mod cost;
mod design;
mod direction;
mod family;
mod ideal;
mod identify;
mod impedance;
mod input_signal;
mod linear_loop;
mod linkage;
mod measured;
mod motor;
mod order;
mod plausible;
mod precharge;
mod pressure_feedback;
mod requirements;
mod rig;
mod series;
mod specification;

use super::catalogue_entry::Catalogue;
use super::reader::Reader;
use super::text::{Findings, Place, RawFinding};
use super::tree::{Entry, TreeNode, Value};
use super::{DeclaredActuator, DeclaredElement, LINEAR_PARAMETERS, LateError, Project};
use phea_quantity::MotionKind;
use phea_table::{TableCheck, TableFinding, Visitor, plain};

/// Reports all contradictions between values.
pub(super) fn project(project: &Project, reader: &mut Reader<'_>) {
    let mut check = Check { reader };
    if let Some(actuator) = &project.actuator {
        rig::parts(actuator, &mut check);
        precharge::ranges(project, actuator, &mut check);
        match actuator.motor {
            Some(_) => motor::motor(project, actuator, &mut check),
            None => series::spring(project, actuator, &mut check),
        }
        tests_of_one_stage(actuator, &mut check);
        linkage::linkage(project, actuator, &mut check);
        ideal::limits(project, actuator, &mut check);
        cost::prices(actuator, &mut check);
        requirements::with_actuator(project, actuator, &mut check);
    }
    if let Some(plant) = &project.plant {
        requirements::with_plant(project, plant, &mut check);
    }
    if project.actuator.is_none() {
        requirements::without_actuator(project, &mut check);
    }
    plausible::numbers(project, &mut check);
    requirements::uncertainty(project, &mut check);
    direction::directions(project, &mut check);
    family::family(project, &mut check);
    linear_loop::sensor(project, &mut check);
    specification::specifications(project, &mut check);
    linear_loop::controllers(project, &mut check);
    impedance::impedance(project, &mut check);
    pressure_feedback::pressure_feedback(project, &mut check);
    design::design(project, &mut check);
    order::bench(&project.bench, &mut check);
    if let Some(identified) = &project.identify {
        identify::identify(identified, &mut check);
        identify::in_use(project, identified, &mut check);
        identify::controllers_of_tests(project, identified, &mut check);
    }
    alternative::alternatives(&project.alternatives, &mut check);
    alternative::load_cases(project, &mut check);
}

/// Rejects tests with a telescopic piston.
fn tests_of_one_stage(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    for test in ["bench.friction", "bench.line"] {
        if !actuator.cylinder.stages.is_empty() && check.declared(test) {
            let message = "tests with the piston are made with one pair of areas, and those of a telescopic piston change";
            let help = format!("remove [{test}], or [[cylinder.stage]] to test one stage");
            check.error_with_help(test, message, help);
        }
    }
}

/// Reports an error that was found later. An absent table would be at the end of the file.
pub(super) fn late(late: &LateError, reader: &mut Reader<'_>) {
    let mut check = Check { reader };
    let place = if check.has_table(&late.path) { check.place(&late.path) } else { check.reader.end_place() };
    let help = Some(late.help.clone()).filter(|help| !help.is_empty());
    check.push_error(&late.path, RawFinding::error(place, &late.message).maybe_help(help));
}

impl DeclaredElement {
    /// Element described by a table; its errors are added to the findings. `sample_time` in s is
    /// that of the controller.
    pub fn read(
        node: &TreeNode,
        sample_time: Option<f64>,
        findings: &mut Findings,
    ) -> Option<DeclaredElement> {
        let errors = findings.error_count();
        let place = node.place;
        let entry = Entry { key: "elements".to_string(), key_place: place, node: node.clone() };
        let root = TreeNode { place, value: Value::Table(vec![entry]) };
        let catalogue = Catalogue::default();
        let mut reader = Reader::new(&root, place.text, &catalogue, findings);
        let mut element: Option<DeclaredElement> = None;
        reader.table(plain("elements", "An element."), &mut element, DeclaredElement::visit);
        if let Some(element) = &element {
            let mut check = Check { reader: &mut reader };
            linear_loop::one_element(element, "elements", sample_time, &mut check);
        }
        element.filter(|_| findings.error_count() == errors)
    }
}

/// Reports findings at the places of values.
struct Check<'r, 'a> {
    reader: &'r mut Reader<'a>,
}

impl Check<'_, '_> {
    /// Motion of the rig.
    fn motion(&self) -> MotionKind {
        self.reader.motion()
    }

    /// Place of the value of a path, or of the nearest table around it.
    fn place(&self, path: &str) -> Place {
        let mut path = path;
        loop {
            let known = self.reader.places.get(path).or_else(|| self.reader.item_places.get(path));
            if let Some(place) = known {
                return *place;
            }
            match path.rfind(['.', '[']) {
                Some(cut) => path = &path[..cut],
                None => return self.reader.root_place(),
            }
        }
    }

    /// True if a path was written in the project or set.
    fn declared(&self, path: &str) -> bool {
        self.reader.places.contains_key(path)
    }

    /// True if the value of a path was already rejected, so that nothing follows from it.
    fn refused(&self, path: &str) -> bool {
        self.reader.places.get(path).is_some_and(|place| self.reader.findings.has_error_within(*place))
    }

    fn error(&mut self, path: &str, message: impl Into<String>) {
        self.push_error(path, RawFinding::error(self.place(path), message));
    }

    fn error_with_help(&mut self, path: &str, message: impl Into<String>, help: impl Into<String>) {
        self.push_error(path, RawFinding::error(self.place(path), message).help(help));
    }

    /// True if a path is in a table whose kind is misspelt or missing, or contains one, so that
    /// nothing follows from its keys.
    fn is_unclear(&self, path: &str) -> bool {
        let within = |inner: &str, outer: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        self.reader.unclear.iter().any(|table| within(path, table) || within(table, path))
    }

    fn push_error(&mut self, path: &str, found: RawFinding) {
        if !self.refused(path) && !self.is_unclear(path) {
            self.reader.findings.push(found);
        }
    }

    /// True if the first table of a path is present at all.
    fn has_table(&self, path: &str) -> bool {
        self.reader.root_entry(path.split(['.', '[']).next().unwrap_or(path)).is_some()
    }

    fn warning(&mut self, path: &str, message: impl Into<String>) {
        let place = self.place(path);
        self.push_warning(path, RawFinding::warning(place, message));
    }

    fn warning_with_help(&mut self, path: &str, message: impl Into<String>, help: impl Into<String>) {
        let place = self.place(path);
        self.push_warning(path, RawFinding::warning(place, message).help(help));
    }

    fn push_warning(&mut self, path: &str, found: RawFinding) {
        if !self.is_unclear(path) {
            self.reader.findings.push(found);
        }
    }

    /// Reports a value missing from the table at `path`, perhaps because it was rejected.
    fn missing(&mut self, path: &str, name: &str, message: impl Into<String>) {
        if self.declared(&format!("{path}.{name}")) || !self.has_table(path) || self.is_unclear(path) {
            return;
        }
        let place = self.place(path);
        self.reader.findings.push(RawFinding::error(place, message).consequence());
    }

    /// Checks that numbers increase from one to the next.
    fn increasing(&mut self, path: &str, values: &[f64]) {
        if values.windows(2).any(|pair| pair[0] >= pair[1]) {
            self.error(path, format!("`{}` must increase from each to the next", last(path)));
        }
    }
}

impl TableCheck for Check<'_, '_> {
    fn motion(&self) -> MotionKind {
        self.motion()
    }

    fn declared(&self, path: &str) -> bool {
        self.declared(path)
    }

    fn refused(&self, path: &str) -> bool {
        self.refused(path)
    }

    fn report(&mut self, path: &str, TableFinding { is_error, message, help }: TableFinding) {
        let place = self.place(path);
        match is_error {
            true => self.push_error(path, RawFinding::error(place, message).maybe_help(help)),
            false => self.push_warning(path, RawFinding::warning(place, message).maybe_help(help)),
        }
    }

    fn report_missing(&mut self, table: &str, name: &str, message: String) {
        self.missing(table, name, message);
    }

    fn in_order(&mut self, paths: [&str; 2], numbers: [f64; 2]) {
        self.in_order(paths, numbers);
    }

    fn bounds(&mut self, path: &str, numbers: [f64; 3]) {
        self.bounds(path, numbers);
    }
}

/// Last part of a path.
fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Linear parameter of that name.
fn linear_parameter(name: &str) -> Option<&'static super::LinearParameter> {
    LINEAR_PARAMETERS.iter().find(|parameter| parameter.key.name == name)
}

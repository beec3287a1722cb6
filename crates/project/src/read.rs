//! From the bytes of a file to a project: settings, tables, then the conditions between them.

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};

use super::diagnostic::{LateError, Refusal, Severity};
use super::linear::LINEAR_PARAMETERS;
use super::listing::{KeyEntry, Listing};
use super::operating_point::operating_numbers;
use super::printer::Printer;
use super::reader::Reader;
use super::text::{Findings, Place, RawFinding};
use super::tree::{self, TreeNode};
use super::{
    DIRECTION, DeclaredActuator, Loaded, Project, UncertaintyDirection, WrittenUnits, setting, validate,
};
use crate::catalogue_entry::Catalogue;
use crate::source::Source;
use phea_quantity::spelling::nearest;
use phea_quantity::{Dimension, MotionKind, RATIO, display};
use phea_table::{Key, Motions, key};

/// Reads a project file, applies `path=value` settings, and finds names in the catalogue, to which
/// the given files and folders are added.
///
/// # Errors
/// [`Refusal`] with all errors, each with file, line and column.
///
/// # Example
/// ```
/// use phea_project::{self as project, STARTER};
/// use phea_project::source::Memory;
/// let source = Memory::default().with("rig.toml", STARTER);
/// let loaded = project::read(&source, "rig.toml", &["supply.pressure=80 bar".to_string()], &[])?;
/// assert_eq!(loaded.project.actuator.map(|actuator| actuator.supply.pressure), Some(80e5));
/// let refused = project::read(&source, "rig.toml", &["supply.pressure=80 mm".to_string()], &[]).unwrap_err();
/// assert_eq!(refused.diagnostics[0].message, "expected a pressure, found a length");
/// # Ok::<(), phea_project::Refusal>(())
/// ```
pub fn read(
    source: &dyn Source,
    path: &str,
    settings: &[String],
    catalogues: &[String],
) -> Result<Loaded, Refusal> {
    read_bytes(
        (source, path),
        source.read(path).map_err(|error| error.to_string()),
        settings,
        (catalogues, None),
        None,
    )
}

/// Part whose settings a project is read again with, by its index.
#[derive(Clone, Copy)]
pub(super) enum OwnSettings {
    Alternative(usize),
    LoadCase(usize),
}

impl OwnSettings {
    /// Table that contains it, and its words for messages.
    pub(super) fn table(self) -> (&'static str, &'static str, usize) {
        match self {
            OwnSettings::Alternative(index) => ("alternative", "alternative", index),
            OwnSettings::LoadCase(index) => ("load_case", "load case", index),
        }
    }

    /// The table `set`.
    fn set_of(self, root: &TreeNode) -> Option<TreeNode> {
        let (table, _, index) = self.table();
        let tree::Value::List(listed) = &root.get(table)?.node.value else { return None };
        Some(listed.get(index)?.get("set")?.node.clone())
    }

    fn settings(self, project: &Project) -> Vec<String> {
        match self {
            OwnSettings::Alternative(index) => {
                project.alternatives.get(index).map_or(vec![], |one| one.settings().collect())
            }
            OwnSettings::LoadCase(index) => {
                project.load_cases.get(index).map_or(vec![], |one| one.settings().collect())
            }
        }
    }
}

/// Project from bytes with settings, then with those of a part of it, and with an error found
/// later.
pub(super) fn read_bytes(
    (source, path): (&dyn Source, &str),
    bytes: Result<Vec<u8>, String>,
    settings: &[String],
    (catalogues, late): (&[String], Option<&LateError>),
    own: Option<OwnSettings>,
) -> Result<Loaded, Refusal> {
    let mut findings = Findings::default();
    let catalogue = Catalogue::gather(source, catalogues, &mut findings);
    let bytes = match bytes {
        Ok(bytes) => bytes,
        Err(error) => {
            findings.unread(source, path, &error);
            return Err(findings.report());
        }
    };
    let Some(mut root) = tree::read(path, &bytes, &mut findings) else { return Err(findings.report()) };
    let project_text = findings.last_text();
    root.place.text = project_text;
    for text in settings {
        setting::apply(&mut root, text, &mut findings);
    }
    if let Some(table) = own.and_then(|own| own.set_of(&root)) {
        setting::apply_table(&mut root, &table, &mut findings);
    }
    let mut reader = Reader::new(&root, project_text, &catalogue, &mut findings).knowing(keys);
    let folder = path.rfind(['/', '\\']).map_or(String::new(), |last| path[..=last].to_string());
    let project = project(&mut reader, &root);
    let units = WrittenUnits::written(&bytes, settings).units(project.motion());
    let project = Project { folder, units, ..project };
    if let Some(late) = late {
        validate::late(late, &mut reader);
    }
    let (mut provenance, catalogue_files) = (reader.provenance, reader.catalogue_files);
    provenance.sort_by(|a, b| a.path.cmp(&b.path));
    provenance.dedup_by(|a, b| a.path == b.path);
    let report = findings.report();
    if report.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        return Err(report);
    }
    let sha256 = sha256(&bytes);
    let warnings = report.diagnostics;
    let texts = report.texts;
    let own = own.map_or(vec![], |own| own.settings(&project));
    let settings = settings.iter().cloned().chain(own).collect();
    let path = path.to_string();
    let catalogues = catalogues.to_vec();
    Ok(Loaded {
        project,
        warnings,
        texts,
        path,
        bytes,
        sha256,
        settings,
        catalogue_files,
        provenance,
        catalogues,
        recorded: None,
        lines: None,
    })
}

/// Hash by which results identify a project.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn project(reader: &mut Reader<'_>, root: &TreeNode) -> Project {
    let mut project = Project::default();
    reader.parameters = parameters(root);
    let is_measured = measured(root).is_some();
    let is_plant = root.get("plant").is_some() && !is_measured;
    refuse_mixture(reader, root, is_plant, is_measured);
    project.visit_system(reader);
    if is_plant || is_measured {
        project.actuator = None;
    }
    if !is_plant {
        project.plant = None;
    }
    (reader.named, reader.counts) = numbers(&mut project);
    if is_plant || is_measured {
        let parameter = key("parameter", &RATIO, "A parameter of the plant.");
        reader.named = reader.parameters.iter().map(|name| (name.clone(), parameter)).collect();
    }
    let directions = directions(root);
    reader.named.extend(directions.map(|name| (name.to_string(), DIRECTION)));
    project.visit_requirements(reader);
    reader.close();
    validate::project(&project, reader);
    project
}

/// Key that names measured plants.
fn measured(root: &TreeNode) -> Option<&tree::Entry> {
    root.get("family")?.node.get("measured")
}

/// Names that formulas of the plant may contain: those that receive values from `[uncertainty]` and
/// `[family]`.
fn parameters(root: &TreeNode) -> Vec<String> {
    let names = |node: &TreeNode| node.entries().iter().map(|entry| entry.key.clone()).collect::<Vec<_>>();
    let mut parameters = root.get("uncertainty").map(|entry| names(&entry.node)).unwrap_or_default();
    let cases = root.get("family").and_then(|entry| entry.node.get("cases"));
    if let Some(tree::Value::List(cases)) = cases.map(|entry| &entry.node.value) {
        parameters.extend(cases.iter().take(1).flat_map(names));
    }
    parameters.sort();
    parameters.dedup();
    parameters
}

/// Names of `[[uncertainty_direction]]`, to which other tables may refer.
fn directions(root: &TreeNode) -> impl Iterator<Item = &str> {
    let tables = match root.get("uncertainty_direction").map(|entry| &entry.node.value) {
        Some(tree::Value::List(tables)) => tables.as_slice(),
        _ => &[],
    };
    tables.iter().filter_map(|table| match &table.get("name")?.node.value {
        tree::Value::Text(name) => Some(name.as_str()),
        _ => None,
    })
}

/// Tables that an actuator requires, each with keys that suffice.
const LEAST: [(&str, &str); 5] = [
    ("fluid", "bulk_modulus = \"1.45 GPa\", density = \"870 kg/m3\", kinematic_viscosity = \"46 cSt\""),
    ("supply", "pressure = \"70 bar\", and `flow` where the pump is small"),
    ("valve", "model = \"moog_760_c263a\" or another of the catalogue, or the numbers of a data sheet"),
    ("line", "hose = \"eaton_synflex_3130_08\" with length = \"1.5 m\", or a `pipe`, or volume = \"50 mL\""),
    ("force_sensor", "stiffness = \"20 MN/m\", and `capacity`; 1e9 N/m where nothing gives way"),
];

/// Rejects a project that is not a complete actuator, or a plant, or measured plants.
fn refuse_mixture(reader: &mut Reader<'_>, root: &TreeNode, is_plant: bool, is_measured: bool) {
    let tables = DeclaredActuator::tables();
    let present: Vec<_> = tables.clone().filter_map(|name| root.get(name)).collect();
    if is_measured {
        for entry in
            present.into_iter().chain(["plant", "uncertainty"].iter().filter_map(|name| root.get(name)))
        {
            let message =
                format!("[{}] describes a plant, but [family] `measured` gives measured ones", entry.key);
            reader.findings.push(RawFinding::error(entry.key_place, message).help("remove one of the two"));
        }
        reader.parts = false;
        tables.for_each(|name| reader.know(name));
        return;
    }
    if is_plant {
        for entry in present {
            let message = format!("[{}] describes an actuator, but [plant] replaces it", entry.key);
            reader.findings.push(RawFinding::error(entry.key_place, message).help("remove one of the two"));
        }
        reader.parts = false;
        tables.for_each(|name| reader.know(name));
        return;
    }
    if present.is_empty() {
        reader.parts = false;
        let message = "nothing is described: neither an actuator nor a plant";
        let found = RawFinding::error(root.place, message).consequence();
        let expected = "[fluid], [supply], [valve], [cylinder], [line] and [force_sensor], or [plant], or [family] `measured`";
        return reader.findings.push(found.expected(expected));
    }
    for name in DeclaredActuator::REQUIRED.iter().filter(|name| root.get(name).is_none()) {
        let found = RawFinding::error(root.place, format!("missing table [{name}]")).consequence();
        let least = LEAST.iter().find(|(table, _)| table == name);
        reader.lack(name, found.maybe_help(least.map(|(table, keys)| format!("add [{table}]: {keys}"))));
    }
    match (root.get("cylinder"), root.get("motor")) {
        (None, None) => {
            let found = RawFinding::error(root.place, "missing table [cylinder]").consequence();
            let help = "add [cylinder]: piston_diameter = \"50 mm\", rod_diameter = \"22 mm\", stroke = \"500 mm\", moving_mass = \"13 kg\"; \
                        or [motor], for a rotary actuator";
            reader.lack("cylinder", found.help(help));
        }
        (Some(cylinder), Some(_)) => {
            reader.know("cylinder");
            let message = "[cylinder] describes what moves, and [motor] does so too";
            let found = RawFinding::error(cylinder.key_place, message);
            reader.findings.push(found.help("remove one of the two"));
        }
        _ => {}
    }
}

/// All numbers of the project that can be named, and the parameters of its linear model; and its
/// whole numbers, which cannot vary.
fn numbers(project: &mut Project) -> (BTreeMap<String, Key>, Vec<String>) {
    let mut listing = Listing::default();
    project.visit_system(&mut listing);
    let mut named: BTreeMap<String, Key> =
        listing.numbers.into_iter().map(|(path, (key, _))| (path, key)).collect();
    named.remove("schema");
    if let Some(actuator) = &project.actuator {
        let linear =
            LINEAR_PARAMETERS.iter().map(|parameter| (parameter.key.name.to_string(), parameter.key));
        let others = linear.chain(super::scenario::start_numbers()).chain(operating_numbers());
        named.extend(others.map(|(path, key)| (path, key.in_motion(actuator.motions()))));
    }
    named.extend(project.directions.iter().map(|direction| (direction.name.clone(), DIRECTION)));
    (named, listing.counts)
}

/// Project as TOML: [`read`] gives an equal project, if an equal catalogue is available.
pub fn print(project: &Project) -> String {
    let mut project = project.clone();
    let (mut named, _) = numbers(&mut project);
    let parameter = key("parameter", &RATIO, "A parameter of the plant.");
    let missing = project.uncertainty.iter().filter(|uncertain| !named.contains_key(&uncertain.name));
    let missing: Vec<String> = missing.map(|uncertain| uncertain.name.clone()).collect();
    named.extend(missing.into_iter().map(|name| (name, parameter)));
    let mut printer = Printer::new(named);
    project.visit_system(&mut printer);
    project.visit_requirements(&mut printer);
    printer.finish()
}

/// All possible keys of a project file, in the order of the tables.
pub fn keys() -> Vec<KeyEntry> {
    let mut listing = Listing::of_everything();
    let mut project = Project::default();
    project.visit_system(&mut listing);
    project.visit_requirements(&mut listing);
    listing.keys
}

impl Project {
    /// Path of a file that the project names, for [`Source`]: relative paths start at the project
    /// file.
    ///
    /// # Example
    /// ```
    /// let project = phea_project::Project { folder: "rigs/".to_string(), ..Default::default() };
    /// assert_eq!(project.path_of("bench 1.csv"), "rigs/bench 1.csv");
    /// assert_eq!(project.path_of("/data/bench 1.csv"), "/data/bench 1.csv");
    /// ```
    pub fn path_of(&self, name: &str) -> String {
        let drive = name.chars().nth(1) == Some(':');
        if drive || name.starts_with(['/', '\\']) {
            name.to_string()
        } else {
            format!("{}{name}", self.folder)
        }
    }

    /// Motion of the rig; linear for a project without a rig.
    pub fn motion(&self) -> MotionKind {
        self.actuator.as_ref().map_or(MotionKind::Linear, DeclaredActuator::motion)
    }

    /// Motions of rig and load.
    pub fn motions(&self) -> Motions {
        self.actuator.as_ref().map(DeclaredActuator::motions).unwrap_or_default()
    }

    /// Number at a dotted path such as `supply.pressure`, SI.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.number_among(path, &self.system_numbers())
    }

    /// Number among those of [`Project::system_numbers`]: listing them takes longer than one
    /// lookup.
    pub(crate) fn number_among(&self, path: &str, numbers: &BTreeMap<String, f64>) -> Option<f64> {
        match self.operating_point.clone().at_path(path) {
            Some(number) => *number,
            None => numbers.get(path).copied(),
        }
    }

    /// All numbers of the system by their dotted paths, SI.
    pub(crate) fn system_numbers(&self) -> BTreeMap<String, f64> {
        let mut listing = Listing::default();
        self.clone().visit_system(&mut listing);
        listing.numbers.into_iter().map(|(path, (_, value))| (path, value)).collect()
    }

    /// Dimension of each number, by its path or its name in the linear model.
    pub fn dimensions(&self) -> BTreeMap<String, &'static Dimension> {
        let (named, _) = numbers(&mut self.clone());
        named.into_iter().map(|(path, key)| (path, key.dimension)).collect()
    }

    /// Value of the number at a path, in a unit of its dimension.
    pub fn in_words(&self, path: &str, value: f64) -> String {
        let (named, _) = numbers(&mut self.clone());
        named.get(path).map_or_else(|| value.to_string(), |key| display(value, key.dimension, 4))
    }

    /// Project with another number at a path; `None` if there is no number. Those of the operating
    /// point always exist.
    #[must_use]
    pub fn with_number(&self, path: &str, value: f64) -> Option<Project> {
        self.with_numbers(&[(path, value)])
    }

    /// Project with other numbers at several paths; `None` if one of them leads to no number. The
    /// value of a direction moves the numbers of that direction from their present values.
    ///
    /// # Example
    /// ```
    /// use phea_project::{STARTER, read};
    /// use phea_project::source::Memory;
    /// let project = read(&Memory::default().with("p.toml", STARTER), "p.toml", &[], &[])?.project;
    /// let other = project.with_numbers(&[("supply.pressure", 6e6), ("cylinder.moving_mass", 20.0)]);
    /// assert_eq!(other.and_then(|other| other.number("supply.pressure")), Some(6e6));
    /// assert_eq!(project.with_numbers(&[("supply.pressure", 6e6), ("supply.colour", 1.0)]), None);
    /// # Ok::<(), phea_project::Refusal>(())
    /// ```
    #[must_use]
    pub fn with_numbers(&self, numbers: &[(&str, f64)]) -> Option<Project> {
        let mut project = self.clone();
        let mut assign: BTreeMap<String, f64> = BTreeMap::new();
        let mut displaced: Vec<(&UncertaintyDirection, f64)> = Vec::new();
        for (path, value) in numbers {
            let direction = self.directions.iter().find(|direction| direction.name == *path);
            match (project.operating_point.at_path(path), direction) {
                (Some(number), _) => *number = Some(*value),
                (None, Some(direction)) => displaced.push((direction, *value)),
                (None, None) => drop(assign.insert((*path).to_string(), *value)),
            }
        }
        for (direction, deviations) in displaced {
            for (path, change) in &direction.changes.numbers {
                let before = assign.get(path).copied().or_else(|| self.number(path))?;
                assign.insert(path.clone(), before + deviations * change);
            }
        }
        let wanted = assign.len();
        let mut listing = Listing::assigning(assign);
        if wanted > 0 {
            project.visit_system(&mut listing);
        }
        (listing.assigned == wanted).then_some(project)
    }

    /// Project with all numbers known: without `[uncertainty]`, its directions and `[family]`.
    #[must_use]
    pub fn without_uncertainty(&self) -> Project {
        Project { uncertainty: Vec::new(), directions: Vec::new(), family: None, ..self.clone() }
    }

    /// Keys of all numbers that a campaign may vary, and their values if stated; those of the start
    /// have none here.
    pub fn listed_numbers(&self) -> BTreeMap<String, (Key, Option<f64>)> {
        let mut listing = Listing::default();
        self.clone().visit_system(&mut listing);
        let numbers = listing.numbers.into_iter().map(|(path, (key, value))| (path, (key, Some(value))));
        let motion = self.motions();
        let start = super::scenario::start_numbers().into_iter();
        let start = start.map(|(path, key)| (path, (key.in_motion(motion), None)));
        numbers.chain(start).collect()
    }
}

impl Findings {
    /// Bytes of a file; `None`, with a finding, if it cannot be read.
    pub fn bytes_of(&mut self, source: &dyn Source, path: &str) -> Option<Vec<u8>> {
        source.read(path).map_err(|error| self.unread(source, path, &error.to_string())).ok()
    }

    /// Reports a file that could not be read, and a similar name if the file does not exist.
    fn unread(&mut self, source: &dyn Source, path: &str, reason: &str) {
        let help = source.list(path).is_err().then(|| meant(source, path)).flatten();
        let place = self.whole_file(path);
        self.push(RawFinding::error(place, reason.to_string()).syntax().maybe_help(help));
    }

    /// Reports a file that could not be read at all.
    pub fn unreadable(&mut self, path: &str, reason: &str) {
        let place = self.whole_file(path);
        self.push(RawFinding::error(place, reason.to_string()).syntax());
    }

    fn whole_file(&mut self, path: &str) -> Place {
        Place { text: self.add_text(path, "", 0), start: 0, end: 0 }
    }
}

/// Remedy for a missing file: the nearest name in its folder, or a note that the folder is missing
/// too.
fn meant(source: &dyn Source, path: &str) -> Option<String> {
    let (folder, name) = path.rsplit_once('/').unwrap_or((".", path));
    let Ok(files) = source.list(folder) else {
        return (folder != ".").then(|| format!("there is no folder `{folder}` either"));
    };
    let files = files.unwrap_or_default();
    let names = files.iter().map(|file| file.rsplit_once('/').map_or(file.as_str(), |(_, name)| name));
    let near = nearest(name, names).filter(|near| *near != name)?;
    let beside = path.strip_suffix(name).unwrap_or_default();
    Some(format!("did you mean `{beside}{near}`?"))
}

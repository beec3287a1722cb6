//! Names of compared projects: title and path, and the difference between variants of one file.

use crate::project::Loaded;

/// Digits of the hash that distinguishes two texts under one path.
const HASH_DIGITS: usize = 8;

/// Heading of each project: its title and, in brackets, its path. Projects with one title and one
/// path also have the settings in which they differ; those with equal settings, the hash of their
/// text.
pub(super) fn compared_headings(projects: &[&Loaded]) -> Vec<String> {
    projects.iter().map(|loaded| heading(loaded, projects)).collect()
}

/// Name of each project in the legend of a figure: its title; its heading if several projects have
/// that title.
pub(super) fn compared_titles(projects: &[&Loaded]) -> Vec<String> {
    let title = |loaded: &&Loaded| match projects.iter().filter(|other| has_title_of(other, loaded)).count() {
        0 | 1 => loaded.project.title.clone(),
        _ => heading(loaded, projects),
    };
    projects.iter().map(title).collect()
}

fn heading(loaded: &Loaded, projects: &[&Loaded]) -> String {
    let is_alike = |other: &&&Loaded| has_title_of(other, loaded) && other.path == loaded.path;
    let alike: Vec<&&Loaded> = projects.iter().filter(is_alike).collect();
    let own = &loaded.settings;
    let is_common = |setting: &&String| alike.iter().all(|other| other.settings.contains(setting));
    let mut words = vec![loaded.path.clone()];
    words.extend(own.iter().filter(|setting| !is_common(setting)).cloned());
    if words.len() == 1 && alike.iter().any(|other| other.settings != *own) {
        words.push("without these settings".to_string());
    }
    if alike.iter().any(|other| other.settings == *own && other.sha256 != loaded.sha256) {
        let digits: String = loaded.sha256.chars().take(HASH_DIGITS).collect();
        words.push(format!("SHA-256 {digits}"));
    }
    format!("{} ({})", loaded.project.title, words.join(", "))
}

fn has_title_of(other: &Loaded, loaded: &Loaded) -> bool {
    other.project.title == loaded.project.title
}

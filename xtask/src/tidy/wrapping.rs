//! Comments of Rust and prose of Markdown are at most 100 columns wide, if they can be broken.

use super::Violation;
use crate::repository::Repository;

const WIDTH: usize = 100;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for file in &repository.rust_files {
        let comments = file.lines.iter().filter(|line| !line.is_continued).filter_map(|line| {
            let comment = line.text.trim_start().strip_prefix("//")?;
            Some((line.number, line.text.as_str(), comment.trim_start_matches(['/', '!'])))
        });
        let message = "a comment of more than 100 columns";
        found.extend(wide(comments).map(|line| Violation::new(&file.path, line, message)));
    }
    for (path, text) in repository.texts("", ".md") {
        let prose = text.lines().enumerate().map(|(index, line)| (index + 1, line, line));
        found.extend(wide(prose).map(|line| Violation::new(path, line, "a line of more than 100 columns")));
    }
    found
}

/// Numbers of the lines that are too wide, from lines with their number, their text and their
/// prose: not in fences, tables, headings and code, without a link, and with a space at which they
/// can be broken.
fn wide<'a>(lines: impl Iterator<Item = (usize, &'a str, &'a str)>) -> impl Iterator<Item = usize> {
    let mut fence: Option<String> = None;
    let mut before = 0;
    lines.filter_map(move |(number, line, content)| {
        let bare = content.trim();
        if number != before + 1 {
            fence = None;
        }
        before = number;
        let mark: String = bare.chars().take_while(|c| matches!(c, '`' | '~')).collect();
        if mark.len() >= 3 {
            match &fence {
                None => fence = Some(mark),
                Some(open) if bare.starts_with(open.as_str()) => fence = None,
                Some(_) => {}
            }
            return None;
        }
        // columns that are set with spaces are not prose
        let is_prose = !bare.starts_with(['|', '#', '<', '>', '$']) && !bare.contains("   ");
        (fence.is_none() && is_prose && is_wide(line, bare)).then_some(number)
    })
}

fn is_wide(line: &str, bare: &str) -> bool {
    let columns = line.chars().count();
    let item = bare.trim_start_matches(|c: char| c.is_ascii_digit() || "-*+. ".contains(c));
    let start = columns - item.chars().count();
    let has_link = line.contains("](") || line.contains("://");
    let can_break = line.chars().take(WIDTH + 1).skip(start).any(|c| c == ' ');
    columns > WIDTH && !has_link && can_break
}

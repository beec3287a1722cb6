//! Lines of a Rust source file as `cargo fmt` leaves them: the code in each, and a mark if the line
//! is compiled for tests only.

/// A line of a Rust file.
pub(crate) struct Line {
    /// Number of the line, from 1.
    pub(crate) number: usize,
    /// The whole line.
    pub(crate) text: String,
    /// The line without comments and without the contents of string literals.
    pub(crate) code: String,
    /// Contents of the string literals in the line, with a null character after each.
    pub(crate) texts: String,
    /// True if the line begins inside a string literal.
    pub(crate) is_continued: bool,
    /// True if the line is compiled for tests only: `#[test]`, `#[cfg(test)]`.
    pub(crate) is_test: bool,
}

/// A Rust source file.
pub(crate) struct RustFile {
    /// Path from the repository's root.
    pub(crate) path: String,
    /// Lines of the file.
    pub(crate) lines: Vec<Line>,
}

impl RustFile {
    pub(crate) fn new(path: &str, text: &str) -> RustFile {
        let mut file = RustFile { path: path.to_string(), lines: lines(text) };
        let mut index = 0;
        while index < file.lines.len() {
            if is_test_attribute(file.lines[index].code.trim()) {
                let last = file.end_of_item(index);
                file.lines[index..=last].iter_mut().for_each(|line| line.is_test = true);
                index = last;
            }
            index += 1;
        }
        file
    }

    /// Returns true if the whole file is test code, or an example, by its folder.
    pub(crate) fn is_test_file(&self) -> bool {
        let folder = |name: &str| self.path.contains(&format!("/{name}/"));
        ["tests", "benches", "fuzz", "examples"].into_iter().any(folder) || self.path.ends_with("/tests.rs")
    }

    /// Returns true if the file belongs to a library or an application, tests excluded.
    pub(crate) fn is_shipped(&self) -> bool {
        ["crates/", "apps/"].iter().any(|folder| self.path.starts_with(folder)) && !self.is_test_file()
    }

    /// The lines that are not compiled for tests only.
    pub(crate) fn shipped(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().filter(|line| !line.is_test && !self.is_test_file())
    }

    /// The index of the line at which the item or statement that begins at this index ends.
    pub(crate) fn end_of_item(&self, start: usize) -> usize {
        let mut depth = 0;
        for (index, line) in self.lines.iter().enumerate().skip(start) {
            for c in line.code.chars() {
                match c {
                    '(' | '[' | '{' => depth += 1,
                    ')' | ']' | '}' => depth -= 1,
                    _ => {}
                }
            }
            if depth < 0 {
                return index.max(start + 1) - 1;
            }
            if depth == 0 && line.code.trim_end().ends_with([';', '}']) {
                return index;
            }
        }
        self.lines.len() - 1
    }
}

fn is_test_attribute(code: &str) -> bool {
    let is_cfg = code.starts_with("#[cfg(") && code.contains("test") && !code.contains("not(");
    code.starts_with("#[test]") || is_cfg
}

/// State of the scanner of [`lines`].
#[derive(Clone, Copy, PartialEq)]
enum Inside {
    Code,
    Comment,
    Text,
    /// A raw string literal, with the number of its `#`.
    RawText(usize),
}

fn lines(text: &str) -> Vec<Line> {
    let mut inside = Inside::Code;
    let line = |(index, text): (usize, &str)| {
        let is_continued = inside != Inside::Code;
        let (code, texts) = code_and_texts_of(text, &mut inside);
        Line { number: index + 1, text: text.to_string(), code, texts, is_continued, is_test: false }
    };
    text.lines().enumerate().map(line).collect()
}

/// The code and the string literals of a line that begins in this state.
fn code_and_texts_of(line: &str, inside: &mut Inside) -> (String, String) {
    let chars: Vec<char> = line.chars().collect();
    let (mut code, mut texts) = (String::new(), String::new());
    let mut index = 0;
    while index < chars.len() {
        let mut length = 1;
        match (*inside, &chars[index..]) {
            (Inside::Comment, _) => {}
            (Inside::Code, ['/', '/', ..]) => *inside = Inside::Comment,
            (Inside::Code, ['\'', '\\', _, rest @ ..]) => {
                length = 4 + rest.iter().position(|c| *c == '\'').unwrap_or(rest.len());
            }
            (Inside::Code, ['\'', _, '\'', ..]) => length = 3,
            (Inside::Code, ['"', ..]) => {
                let hashes = code.len() - code.trim_end_matches('#').len();
                let is_raw = code.trim_end_matches('#').ends_with('r');
                *inside = if is_raw { Inside::RawText(hashes) } else { Inside::Text };
                code.push('"');
            }
            (Inside::Code, [c, ..]) => code.push(*c),
            (Inside::Text, ['\\', _, ..]) => length = 2,
            (Inside::Text, ['"', ..]) => {
                *inside = Inside::Code;
                texts.push('\0');
            }
            (Inside::RawText(hashes), ['"', rest @ ..])
                if rest.iter().take_while(|c| **c == '#').count() >= hashes =>
            {
                (*inside, length) = (Inside::Code, 1 + hashes);
                texts.push('\0');
            }
            (Inside::Text | Inside::RawText(_), [c, ..]) => texts.push(*c),
            _ => {}
        }
        index += length;
    }
    if *inside == Inside::Comment {
        *inside = Inside::Code;
    }
    (code, texts)
}

/// The words of a line of code.
pub(crate) fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}

/// Paths such as `std::fs::read` with their line numbers; groups of `use` are expanded.
pub(crate) fn paths<'a>(lines: impl Iterator<Item = &'a Line>) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    let mut prefixes: Vec<String> = Vec::new();
    let mut word = String::new();
    for line in lines {
        for c in line.code.chars().chain([' ']) {
            if c.is_alphanumeric() || matches!(c, '_' | ':') {
                word.push(c);
                continue;
            }
            let path = prefixes.last().cloned().unwrap_or_default() + &word;
            if c == '{' {
                prefixes.push(if word.ends_with("::") { path } else { String::new() });
            } else if !word.is_empty() {
                found.push((path.trim_matches(':').to_string(), line.number));
            }
            if c == '}' {
                prefixes.pop();
            }
            word.clear();
        }
    }
    found
}

/// The numbers of a line of code, as written.
pub(crate) fn numbers(code: &str) -> impl Iterator<Item = &str> {
    let words = code.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.')));
    let words = words.flat_map(|word| word.split(".."));
    words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_texts_are_no_code() {
        let code = |text| lines(text).into_iter().map(|line| line.code).collect::<Vec<String>>();
        assert_eq!(code("let a = \"// no\"; // f(\"x"), ["let a = \"; "]);
        assert_eq!(code("f(r#\"a\"b\"#, 'c', '\\'', '\"') -> &'a B"), ["f(r#\", , , ) -> &'a B"]);
        assert_eq!(code("f(\"one \\\" {\n  two }\", 3);"), ["f(\"", ", 3);"]);
        assert!(lines("f(\"one\n// two\");")[1].is_continued);
    }

    #[test]
    fn groups_are_expanded() {
        let text = "use std::{\n    fs,\n    time::{Instant as Now, Duration},\n};\nfn f() { g::h(x) }\n";
        let found = paths(RustFile::new("crates/a/src/lib.rs", text).shipped());
        for (path, line) in
            [("std::fs", 2), ("std::time::Instant", 3), ("std::time::Duration", 3), ("g::h", 5)]
        {
            assert!(found.contains(&(path.to_string(), line)), "{path}: {found:?}");
        }
    }

    #[test]
    fn tests_are_marked_to_their_end() {
        let text = "#[cfg(test)]\nmod tests {\n    use a;\n}\nfn f() {}\n#[test]\nfn g() {\n    h();\n}\n";
        let marked = RustFile::new("crates/a/src/lib.rs", text).lines;
        let tests: Vec<usize> = marked.iter().filter(|line| line.is_test).map(|line| line.number).collect();
        assert_eq!(tests, [1, 2, 3, 4, 6, 7, 8, 9]);
    }

    #[test]
    fn numbers_are_found_in_calls_ranges_and_fields() {
        let found: Vec<&str> = numbers("a1.b.0 + f(-25.4, 6_894.7e0) + x[0..10]").collect();
        assert_eq!(found, ["25.4", "6_894.7e0", "0", "10"]);
    }
}

//! Removal of keys of one table of a text, and insertion of lines in their place. Comments on
//! removed keys are removed too: they would describe the replacement.

use super::statement::{Statement, StatementContent, entries, statements};

/// Keys with their values as TOML.
pub(super) type KeyValues = Vec<(String, String)>;

/// Text with these keys of a top-level table removed and these lines in their place.
pub(super) fn replaced(text: &str, table: &str, keys: &[&str], lines: &[(String, String)]) -> String {
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut surgery = Surgery {
        table,
        keys,
        lines,
        end,
        out: String::new(),
        inserted: false,
        section: vec![],
        removes: false,
        comments: None,
    };
    let all = statements(text);
    surgery.removes = surgery.removes_any(&all);
    for statement in all {
        surgery.take(text.get(statement.range.clone()).unwrap_or_default(), &statement);
    }
    if !surgery.inserted {
        surgery.end_line();
        surgery.out.push_str(&format!("{end}[{table}]{end}"));
        surgery.insert("");
    }
    surgery.out
}

/// Text that is processed statement by statement.
struct Surgery<'a> {
    table: &'a str,
    /// Removed keys.
    keys: &'a [&'a str],
    lines: &'a [(String, String)],
    /// Line ending.
    end: &'static str,
    out: String,
    inserted: bool,
    /// Path of the current table.
    section: Vec<String>,
    /// True if the text states any key that is removed.
    removes: bool,
    /// Beginning of the comment lines before the current statement.
    comments: Option<usize>,
}

impl Surgery<'_> {
    fn removes_any(&self, all: &[Statement]) -> bool {
        let mut section: &[String] = &[];
        all.iter().any(|statement| match &statement.content {
            StatementContent::Nothing => false,
            StatementContent::Header(path) => {
                section = path;
                self.is_replaced(path)
            }
            StatementContent::Value { path, .. } => self.is_replaced(&[section, path].concat()),
        })
    }

    fn take(&mut self, written: &str, statement: &Statement) {
        let before = self.comments.take();
        match &statement.content {
            StatementContent::Nothing => {
                if written.trim_start().starts_with('#') {
                    self.comments = before.or(Some(self.out.len()));
                }
                self.out.push_str(written);
            }
            StatementContent::Header(path) => {
                self.section = path.clone();
                let is_own = path.len() == 1 && path.first().is_some_and(|first| first == self.table);
                if !self.is_replaced(path) {
                    self.out.push_str(if is_own && self.removes {
                        without_comment(written)
                    } else {
                        written
                    });
                } else if let Some(start) = before {
                    self.out.truncate(start);
                }
                if is_own {
                    self.end_line();
                    self.insert("");
                }
            }
            StatementContent::Value { path, value } => {
                let whole = [self.section.as_slice(), path].concat();
                let is_table = whole.len() == 1 && whole.first().is_some_and(|first| first == self.table);
                if is_table {
                    return self.inline(written, value.clone());
                }
                // dotted keys above every header
                let dotted =
                    self.section.is_empty() && whole.first().is_some_and(|first| first == self.table);
                if dotted && !self.inserted {
                    self.insert(&format!("{}.", self.table));
                }
                if !self.is_replaced(&whole) {
                    self.out.push_str(written);
                } else if let Some(start) = before {
                    self.out.truncate(start);
                }
            }
        }
    }

    /// True if the key or table is replaced.
    fn is_replaced(&self, path: &[String]) -> bool {
        matches!(path, [table, key, ..] if table == self.table && self.keys.contains(&key.as_str()))
    }

    fn insert(&mut self, prefix: &str) {
        self.inserted = true;
        for (key, value) in self.lines {
            self.out.push_str(&format!("{prefix}{key} = {value}{}", self.end));
        }
    }

    /// Inline table `controller = { ... }`: the remaining and the new entries, in one line.
    fn inline(&mut self, written: &str, value: std::ops::Range<usize>) {
        self.inserted = true;
        let kept = entries(written.get(value.clone()).unwrap_or_default());
        let kept =
            kept.into_iter().filter(|(key, _)| !self.keys.contains(&key.as_str())).map(|(_, text)| text);
        let new = self.lines.iter().map(|(key, value)| format!("{key} = {value}"));
        let all: Vec<String> = new.chain(kept).collect();
        let (before, after) = (written.get(..value.start), written.get(value.end..));
        let text = format!("{}{{ {} }}", before.unwrap_or_default(), all.join(", "));
        self.out.push_str(&text);
        self.out.push_str(without_comment(after.unwrap_or_default()));
        self.end_line();
    }

    fn end_line(&mut self) {
        if !self.out.is_empty() && !self.out.ends_with('\n') {
            self.out.push_str(self.end);
        }
    }
}

/// Line up to its comment.
fn without_comment(line: &str) -> &str {
    line.split_once('#').map_or(line, |(before, _)| before.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> KeyValues {
        [("gain", "2"), ("poles", "[0]")].map(|(key, value)| (key.to_string(), value.to_string())).to_vec()
    }

    fn rewritten(text: &str) -> String {
        let keys = ["numerator", "denominator", "gain", "zeros", "poles", "domain", "elements"];
        replaced(text, "controller", &keys, &law())
    }

    #[test]
    fn a_table_keeps_its_other_keys_and_comments() {
        let text = "a = \"[controller]\"\n[controller]  # G\n# the old law\nnumerator = \"s\"  # old\n# why\ndelay = \"1 ms\"\ndenominator = '''\ns'''\n\n[x]\ngain = 1\n";
        let expected = "a = \"[controller]\"\n[controller]\ngain = 2\npoles = [0]\n# why\ndelay = \"1 ms\"\n\n[x]\ngain = 1\n";
        assert_eq!(rewritten(text), expected);
    }

    #[test]
    fn elements_go_in_every_form() {
        let expected = "[controller]\ngain = 2\npoles = [0]\ndelay = 1\n[x]\nelements = 1\n";
        for elements in
            ["elements = [\n  { kind = \"gain\", value = 1 }, # one\n  { kind = \"integrator\" },\n]\n", ""]
        {
            let text = format!("[controller]\n{elements}delay = 1\n[x]\nelements = 1\n");
            assert_eq!(rewritten(&text), expected);
        }
        let tables = "[controller]\ndelay = 1\n[[controller.elements]]\nkind = \"gain\"\nvalue = 1\n[[controller . \"elements\"]]\nkind = \"integrator\"\n[x]\nelements = 1\n";
        assert_eq!(rewritten(tables), expected);
    }

    #[test]
    fn dotted_inline_and_absent_tables() {
        assert_eq!(
            rewritten("controller.numerator = \"1\"\ncontroller.delay = 1\n[x]\n"),
            "controller.gain = 2\ncontroller.poles = [0]\ncontroller.delay = 1\n[x]\n"
        );
        assert_eq!(
            rewritten("controller = { numerator = \"1, 2\", delay = 1, zeros = [1, [2, 3]] } # c\n[x]\n"),
            "controller = { gain = 2, poles = [0], delay = 1 }\n[x]\n"
        );
        assert_eq!(rewritten("[x]\ny = 1"), "[x]\ny = 1\n\n[controller]\ngain = 2\npoles = [0]\n");
        assert_eq!(
            rewritten("[x]\r\ny = 1\r\n"),
            "[x]\r\ny = 1\r\n\r\n[controller]\r\ngain = 2\r\npoles = [0]\r\n"
        );
        // a comment on the table of a controller without a law belongs to the table
        assert_eq!(
            rewritten("[controller] # sampled\ndelay = 1\n"),
            "[controller] # sampled\ngain = 2\npoles = [0]\ndelay = 1\n"
        );
        // a table inside it stays
        assert_eq!(
            rewritten("[controller.q]\ngain = 1\n"),
            "[controller.q]\ngain = 1\n\n[controller]\ngain = 2\npoles = [0]\n"
        );
    }
}

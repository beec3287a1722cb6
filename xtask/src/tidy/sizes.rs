//! A file stays below 500 lines, a function fits on a screen, and the overview on a few pages.

use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use super::Violation;
use crate::repository::Repository;

const LARGEST_FILE: usize = 500;
const LONGEST_FUNCTION: usize = 60;
/// Documents that are read as a whole, with the lines that they may have.
const DOCUMENTS: [(&str, usize); 1] = [("ARCHITECTURE.md", 120)];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found: Vec<Violation> = repository
        .texts(|path| path.ends_with(".rs") || path.ends_with(".py"))
        .filter_map(|(path, text)| check_file(path, text))
        .collect();
    for file in repository.rust_files() {
        let mut functions = RustFunctions::default();
        functions.visit_file(&file.syntax);
        found.extend(functions.sizes.iter().filter_map(|function| check_function(&file.path, function)));
    }
    for (path, text) in repository.texts(|path| path.ends_with(".py")) {
        found.extend(python_functions(text).iter().filter_map(|function| check_function(path, function)));
    }
    found.extend(DOCUMENTS.iter().filter_map(|document| check_document(repository, *document)));
    found
}

fn check_document(repository: &Repository, (path, most): (&str, usize)) -> Option<Violation> {
    let lines = repository.text(path)?.lines().count();
    (lines > most).then(|| Violation::new(path, 0, format!("{lines} lines, {most} are allowed: shorten it")))
}

fn check_file(path: &str, text: &str) -> Option<Violation> {
    let lines = text.lines().count();
    (lines > LARGEST_FILE).then(|| {
        Violation::new(path, 0, format!("{lines} lines, {LARGEST_FILE} are allowed: split it by concept"))
    })
}

/// A function: its name, the line it starts at and the lines of its body.
struct FunctionSize {
    name: String,
    line: usize,
    body: usize,
}

fn check_function(path: &str, function: &FunctionSize) -> Option<Violation> {
    (function.body > LONGEST_FUNCTION).then(|| {
        let FunctionSize { name, line, body } = function;
        Violation::new(
            path,
            *line,
            format!("the body of `{name}` has {body} lines, {LONGEST_FUNCTION} are allowed"),
        )
    })
}

#[derive(Default)]
struct RustFunctions {
    sizes: Vec<FunctionSize>,
}

impl RustFunctions {
    fn add(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let braces = block.span();
        let body = (braces.end().line - braces.start().line).saturating_sub(1);
        self.sizes.push(FunctionSize {
            name: signature.ident.to_string(),
            line: signature.span().start().line,
            body,
        });
    }
}

impl<'ast> Visit<'ast> for RustFunctions {
    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        self.add(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        self.add(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.add(&function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
    }
}

/// Python's functions: a `def` reaches to the last line that is indented further.
fn python_functions(text: &str) -> Vec<FunctionSize> {
    let indentation = |line: &str| line.len() - line.trim_start().len();
    let lines: Vec<&str> = text.lines().collect();
    let mut functions = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let Some(rest) = line.trim_start().strip_prefix("def ") else { continue };
        let body: Vec<&str> = lines[start + 1..]
            .iter()
            .take_while(|next| {
                next.trim().is_empty() || indentation(next) > indentation(line) || next.trim() == "):"
            })
            .copied()
            .collect();
        let used = body.iter().rposition(|next| !next.trim().is_empty()).map_or(0, |last| last + 1);
        let name = rest.split('(').next().unwrap_or(rest).to_string();
        functions.push(FunctionSize { name, line: start + 1, body: used });
    }
    functions
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(path: &str, text: &str) -> Vec<String> {
        check(&Repository::from_texts(&[(path, text)])).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn a_file_of_501_lines_is_too_long_and_one_of_500_is_not() {
        assert!(messages("a.rs", &"// a\n".repeat(500)).is_empty());
        assert_eq!(messages("a.rs", &"// a\n".repeat(501)).len(), 1);
        assert_eq!(messages("a.py", &"# a\n".repeat(501)).len(), 1);
    }

    #[test]
    fn the_overview_has_at_most_120_lines_and_other_documents_any() {
        assert!(messages("ARCHITECTURE.md", &"line\n".repeat(120)).is_empty());
        let longer = "line\n".repeat(121);
        let found = messages("ARCHITECTURE.md", &longer);
        assert_eq!(found, ["ARCHITECTURE.md: 121 lines, 120 are allowed: shorten it"]);
        assert!(messages("CONTRIBUTING.md", &longer).is_empty());
    }

    #[test]
    fn functions_methods_and_defaults_are_measured() {
        let body = "    work();\n".repeat(61);
        let free = format!("/// doc\nfn f() {{\n{body}}}\n");
        assert_eq!(messages("a.rs", &free), ["a.rs:2: the body of `f` has 61 lines, 60 are allowed"]);
        assert_eq!(messages("a.rs", &format!("impl A {{ fn f() {{\n{body}}} }}")).len(), 1);
        assert_eq!(messages("a.rs", &format!("trait A {{ fn f() {{\n{body}}} }}")).len(), 1);
        let shorter = "    work();\n".repeat(60);
        assert!(messages("a.rs", &format!("fn f() {{\n{shorter}}}\n")).is_empty());
    }

    #[test]
    fn python_is_measured_too() {
        let body = "    work()\n".repeat(61);
        let text = format!("def short():\n    work()\n\n\ndef long():\n{body}\n\ndone = 1\n");
        assert_eq!(messages("a.py", &text), ["a.py:5: the body of `long` has 61 lines, 60 are allowed"]);
    }
}

//! Tests that every check reports violations of its rule, and nothing else.

use std::collections::BTreeMap;

use super::CHECKS;
use crate::repository::Repository;

/// Violations that a check reports of these files, each as "path:line: message".
fn found(check: &str, files: &[(&str, &str)]) -> Vec<String> {
    let texts: BTreeMap<String, String> =
        files.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect();
    let (_, function) = CHECKS.iter().find(|(name, _)| *name == check).unwrap();
    function(&Repository::new(texts)).into_iter().map(|violation| violation.0).collect()
}

/// Checks that the first file breaks the rule once, and the second does not; further files are
/// present in both cases.
fn breaks(check: &str, broken: (&str, &str), fine: (&str, &str), others: &[(&str, &str)]) {
    let with = |file| [&[file][..], others].concat();
    let reported = found(check, &with(broken));
    assert_eq!(reported.len(), 1, "{check}: {broken:?}: {reported:?}");
    assert_eq!(found(check, &with(fine)), [""; 0], "{check}: {fine:?}");
}

/// Checks two texts at one path: the first breaks the rule once, the second does not.
fn breaks_at(check: &str, path: &str, broken: &str, fine: &str) {
    breaks(check, (path, broken), (path, fine), &[]);
}

#[test]
fn a_violation_has_its_place() {
    let test = "#[test]\nfn f() {\n    assert!(g() < 2.233e6);\n}\n";
    let reported = found("golden", &[("crates/a/tests/b.rs", test)]);
    assert_eq!(reported, ["crates/a/tests/b.rs:2: golden numbers without an ORIGIN"]);
}

#[test]
fn pages_and_stories_are_listed() {
    let others = [("book/src/theory/errata.md", ""), ("README.md", "[a](examples/a.md)")];
    let contents = "book/src/SUMMARY.md";
    breaks("book", (contents, ""), (contents, "- [Errata](theory/errata.md)"), &others);
    let story = "```console\n$ phea size\n```\n";
    let listed = [(contents, "[Errata](theory/errata.md)"), others[0], others[1]];
    breaks("book", ("examples/b.md", story), ("examples/a.md", story), &listed);
}

#[test]
fn a_product_has_its_name_its_sources_and_a_line() {
    let path = "crates/project/catalogue/hoses/a.toml";
    let others = [("crates/project/src/catalogue/built_in.rs", "\"../../catalogue/hoses/a.toml\"")];
    let fine = "name = \"a\"\nbore = 1.0\nsource = \"Eaton (2008), page 12\"";
    let own = "name = \"a\"\nbore = 1.0\n[sources]\nbore = \"Eaton (2008), page 12\"";
    breaks("catalogue", (path, "name = \"a\"\nbore = 1.0"), (path, fine), &others);
    breaks("catalogue", (path, "name = \"a\"\nbore = 1.0\nsource = \"a book\""), (path, own), &others);
    breaks("catalogue", (path, "name = \"b\""), (path, "name = \"a\""), &others);
    breaks("catalogue", ("crates/project/catalogue/b.toml", "name = \"b\""), (path, fine), &others);
}

#[test]
fn modules_do_not_use_each_other_in_a_circle() {
    let others = [
        ("crates/x/src/a.rs", "use crate::b::B;"),
        ("crates/x/src/b/deep.rs", "use super::super::c::f;"),
        ("crates/x/src/b.rs", "pub struct B;"),
        ("crates/x/src/a/own.rs", "pub struct A;"),
        ("crates/x/src/d.rs", "use crate::a::A;"),
    ];
    let path = "crates/x/src/c.rs";
    breaks("circles", (path, "use super::A;"), (path, "#[cfg(test)]\nuse super::A;"), &others);
    breaks("circles", (path, "use crate::{a::own, e};"), (path, "use super::e;"), &others);
}

#[test]
fn packages_depend_on_what_the_table_allows() {
    let qft = "crates/qft/Cargo.toml";
    breaks_at("dependencies", qft, "[dependencies]\nphea-hydraulics.workspace = true", "");
    breaks_at("dependencies", qft, "[dev-dependencies]\nserde = \"1\"", "[dependencies]\nlibm = \"1\"");
    let renamed = "[target.'cfg(unix)'.dependencies]\nq = { package = \"phea-qft\", path = \"../qft\" }";
    breaks_at("dependencies", "crates/hydraulics/Cargo.toml", renamed, "");
    let both = "[dependencies]\nphea-workbench = \"1\"\nphea-qft = \"1\"";
    breaks_at("dependencies", "apps/cli/Cargo.toml", both, "[dependencies]\nphea-workbench = \"1\"");
    breaks("dependencies", ("crates/extra/Cargo.toml", ""), (qft, ""), &[]);
}

#[test]
fn equations_are_listed_and_where_the_index_says() {
    let code = "/// ```text\n/// B = 1     thesis (6.18), (6.20)\n/// ```\npub fn modulus() {}\n";
    let others = [("crates/hydraulics/src/line.rs", code)];
    let index = "book/src/theory/equations.md";
    let head = "| equation | gives | implemented by | in |\n|---|---|---|---|\n";
    let row = |numbers: &str, code: &str, file: &str| {
        format!("{head}| {numbers} | modulus | `{code}` | `hydraulics/{file}.rs` |")
    };
    let fine = row("6.18, 6.20", "modulus", "line");
    for broken in [
        row("6.20", "modulus", "line"),
        row("6.18 to 6.20", "modulus", "line"),
        row("6.18, 6.20", "lost", "line"),
        row("6.18, 6.20", "modulus", "line.rs`, `hydraulics/lost"),
    ] {
        breaks("equations", (index, &broken), (index, &fine), &others);
    }
    let formula =
        |text: &str| format!("{fine}\n\n| formula | in |\n|---|---|\n| `{text}` | `hydraulics/line.rs` |");
    breaks("equations", (index, &formula("B = 2")), (index, &formula("B = 1 thesis")), &others);
}

#[test]
fn a_file_with_a_public_function_has_an_example_that_asserts() {
    let path = "crates/qft/src/bound.rs";
    let example = "/// ```\n/// assert!(true);\n/// ```\npub fn bound() {}";
    breaks_at("examples", path, "/// Bare.\npub fn bound() {}", example);
    breaks_at("examples", path, &example.replacen("```", "```no_run", 1), "pub(crate) fn bound() {}");
    let tested = format!("pub fn bound() {{}}\n#[cfg(test)]\nmod tests {{\n{example}\n}}\n");
    breaks("examples", (path, &tested), ("crates/engineering/src/a.rs", "pub fn a() {}"), &[]);
}

#[test]
fn golden_numbers_have_an_origin() {
    let test = "#[test]\nfn f() {\n    assert!(\n        g() < 2.233e6,\n    );\n}\n";
    let input = "#[test]\nfn f() {\n    let x = 2.233e6;\n    assert!(g(x) < 1e-9);\n}\n";
    let path = "crates/a/tests/b.rs";
    breaks_at("golden", path, test, &format!("// ORIGIN: thesis Table 6.2\n{test}"));
    breaks_at("golden", path, test, input);
    breaks("golden", ("crates/a/tests/golden.rs", input), (path, input), &[]);
    breaks("golden", ("crates/a/src/b.rs", test), ("crates/a/src/b.rs", &test[8..]), &[]);
    let origin = |origin: &str| format!("// ORIGIN: {origin}\nconst K: f64 = 2.233e6;");
    breaks_at("golden", path, &origin("as it was printed"), &origin("Merritt (1967)"));
    let others = [("comparisons/a.py", "")];
    let [lost, fine] = ["b.py", "a.py"].map(|file| origin(&format!("recomputed by comparisons/{file}.")));
    breaks("golden", (path, &lost), (path, &fine), &others);
}

#[test]
fn an_invariant_names_what_enforces_it() {
    let item =
        |item: &str| format!("# Architecture\n\n1. not one\n\n## Invariants\n\n{item}\n\n## After\n\n1. x\n");
    let path = "ARCHITECTURE.md";
    let fine = item("1. `qft` is alone. Enforced by the check\n   `purity` and the stage `wasm32`.");
    breaks_at("invariants", path, &item("1. Nothing leaks, we hope."), &fine);
    breaks_at("invariants", path, &item("1. Nothing leaks. Enforced by `goodwill`."), &fine);
}

#[test]
fn files_are_named_and_tests_are_built() {
    for path in ["crates/a/src/b/mod.rs", "crates/a/src/utils.rs", "crates/a/src/common/line.rs"] {
        breaks("layout", (path, ""), ("crates/a/src/modulus.rs", ""), &[]);
    }
    let others = [("crates/a/tests/all.rs", "mod laws;\n"), ("crates/a/tests/laws.rs", "mod limits;\n")];
    let [lost, fine] = ["crates/a/tests/laws/lost.rs", "crates/a/tests/laws/limits.rs"];
    breaks("layout", (lost, ""), (fine, ""), &others);
    let unbuilt = "[package]\nname = \"a\"\n\n[lib]\ntest = false\n";
    let others = [("crates/a/src/limit.rs", "#[cfg(test)]\nmod tests {}\n")];
    let path = "crates/a/Cargo.toml";
    breaks("layout", (path, unbuilt), (path, &unbuilt.replace("test = false", "")), &others);
}

#[test]
fn links_and_paths_exist() {
    let path = "book/src/guide/units.md";
    let others = [("README.md", "# Two words, here\n"), ("crates/a/src/b.rs", "")];
    let [run, quoted] = ["console\n$ phea size", "text\n[a](lost.md)\n$ phea size"]
        .map(|block| format!("```{block} crates/lost\n```\n"));
    for (broken, fine) in [
        ("[a](README.md)", "[a](../../../README.md) [b](units.md) [c](https://example.org/x) [d](../guide)"),
        ("[a](../../../README.md#three-words)", "[a](../../../README.md#two-words-here)"),
        ("`crates/a/src/c.rs`", "`crates/a/src/b.rs`, `crates/a/*/golden.rs`, `crates/NAME/src`"),
        (&run, &quoted),
    ] {
        breaks("links", (path, broken), (path, fine), &others);
    }
}

#[test]
fn every_package_has_the_lints_of_the_workspace() {
    breaks_at("lints", "crates/a/Cargo.toml", "[lints]\nworkspace = false", "[lints]\nworkspace = true");
    breaks_at("lints", "fuzz/Cargo.toml", "[package]\nname = \"fuzz\"", "[package]\n[workspace]");
}

#[test]
fn no_two_types_have_one_name() {
    let path = "crates/b/src/two.rs";
    let others = [("crates/a/src/one.rs", "pub struct Side;")];
    breaks("names", (path, "pub(super) enum Side {}"), (path, "trait Has {\n    type Side;\n}"), &others);
    breaks("names", (path, "type Side = u8;"), (path, "#[cfg(test)]\nstruct Side;"), &others);
}

#[test]
fn notation_lists_identifiers_and_every_parameter() {
    let code = "pub struct Fluid<S = f64> {\n    pub bulk_modulus: S,\n    pub kind: Option<Air>,\n}\n\
                impl<S: Scalar> Fluid<S> {\n    pub fn problems(&self) {}\n}\n\
                pub enum Air {\n    Free { fraction: f64 },\n}\n\
                pub struct Answer {\n    pub stiffness: f64,\n}\n";
    let others = [("crates/hydraulics/src/lib.rs", code)];
    let document = |row: &str| {
        format!("| identifier | SI unit |\n|---|---|\n| `Fluid::bulk_modulus` | Pa |\n{row}\n\n`anything`\n")
    };
    let path = "NOTATION.md";
    let fine = document("| `fraction` | 1 |");
    for rows in ["| `fraction` | 1 |\n| `x_p` | m |", "| `fraction` | |", "| `fraction` | 1 |\n| x | m |", ""]
    {
        breaks("notation", (path, &document(rows)), (path, &fine), &others);
    }
}

#[test]
fn lower_crates_touch_neither_files_nor_clocks_nor_threads() {
    let path = "crates/qft/src/lib.rs";
    for broken in [
        "use std::fs;",
        "use std::{time::Instant, fmt};",
        "fn f() {\n    std::thread::spawn(g);\n}",
        "use std::collections::{BTreeMap, HashMap};",
        "#[derive(Clone, Serialize)]\nstruct A;",
        "fn f() -> u8 {\n    rand::random()\n}",
    ] {
        breaks_at("purity", path, broken, "use std::sync::Arc;\n#[cfg(test)]\nuse std::fs;\n// std::fs");
    }
    let workbench = "crates/workbench/src/a.rs";
    breaks_at("purity", workbench, "fn f() {\n    std::fs::read(p);\n}", "use serde::Serialize;");
}

#[test]
fn facts_are_no_sentences() {
    let path = "crates/engineering/src/a.rs";
    let broken = "fn f() -> String {\n    format!(\"the force of {} \\\n        settles\", 3)\n}\n";
    let fine = "/// the force does not settle\n#[error(\n    \"the force does not settle\"\n)]\nstruct A;\nconst B: &str = \"line.a model\";\n#[test]\nfn t() {\n    f(\"the force does not settle\");\n}\n";
    breaks("facts", (path, broken), (path, fine), &[]);
    breaks("facts", (path, broken), ("crates/workbench/src/a.rs", broken), &[]);
    breaks("facts", (path, broken), ("crates/hydraulics/src/a/checks.rs", broken), &[]);
}

#[test]
fn files_functions_and_the_overview_have_a_size() {
    breaks_at("sizes", "a.rs", &"// a\n".repeat(501), &"// a\n".repeat(500));
    breaks_at("sizes", "ARCHITECTURE.md", &"a\n".repeat(121), &"a\n".repeat(120));
    let function = |lines: usize| format!("def f():\n{}\n\nx = 1\n", "    work()\n".repeat(lines));
    breaks_at("sizes", "a.py", &function(61), &function(60));
}

#[test]
fn conversions_have_a_home() {
    let path = "crates/hydraulics/src/line.rs";
    for factor in ["6894.757293168", "6.8948e3", "0.3048", "4.4482216", "57.29577951308232", "6.30902e-5"] {
        let code = format!("const A: f64 = {factor};");
        breaks("units", (path, &code), ("crates/quantity/src/unit.rs", &code), &[]);
        breaks_at("units", path, &code, "const A: [f64; 4] = [0.3, 6.9, 3.785, 0.0]; // 6894.757");
    }
}

#[test]
fn comments_and_prose_are_wrapped() {
    let words = "word ".repeat(24);
    let fine = format!("```text\n{words}\n```\n| {words} |\n# {words}");
    breaks_at("wrapping", "a.md", &format!("- {words}"), &fine);
    breaks_at("wrapping", "a.md", &words, &format!("[a](b) {words}\n{}", "w".repeat(121)));
    let code = format!("const A: &str = \"\n// {words}\n\"; // {words}\n");
    breaks_at("wrapping", "a.rs", &format!("/// {words}\nfn f() {{}}\n"), &code);
}

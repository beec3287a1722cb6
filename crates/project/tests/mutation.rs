//! Texts spliced and mutated from the corpora: no input makes the reader panic, hang or contradict
//! itself.
//!
//! The sequence is fixed by its seed. Every input is at most a few kilobytes, so the work for each
//! is bounded; the limits that bound it for any size (bytes, nesting, listed findings) are checked
//! separately below.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use std::path::Path;
use std::thread;

use phea_project::source::Memory;
use phea_project::{self as project, STARTER};

/// Number of inputs in the test command; the stage `mutation` of `cargo xtask ci` reads twenty
/// times as many.
const INPUTS: u64 = 10_000;
const THREADS: u64 = 2;

/// Marsaglia's xorshift with 64 bits.
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }
}

/// Pieces that matter to one grammar or another.
const TOKENS: &[&str] = &[
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "#",
    "\n",
    "\r\n",
    "\r",
    "\\",
    "\\u0000",
    "inf",
    "-inf",
    "nan",
    "1e999",
    "-1e-999",
    "0x",
    "0xffffffffffffffffff",
    "1_000",
    "1979-05-27T07:32:00Z",
    "true",
    "\" bar\"",
    "\"1 mm^\"",
    "\"1 m/s.Pa\"",
    "\"dB\"",
    "s^",
    "(((((",
    "/0",
    "*z",
    "+-",
    "a.b.c.d.e.f",
    "[line.a]",
    "[line.b]",
    "[[specification]]",
    "[[scenario]]",
    "[plant]",
    "[family]",
    "cases = [{}]",
    "elements = [{}]",
    "\u{feff}",
    "\u{0}",
    "é",
    "µ",
    "²",
    "\u{202e}",
    "\u{1f600}",
    "schema = 1\n",
    "limit = ",
    "band = [0, inf]",
    "9999999999999999999",
];

/// Files of some folders below the package, in a fixed order.
fn corpus(folders: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> = folders
        .iter()
        .flat_map(|name| std::fs::read_dir(folder.join(name)).expect("a folder"))
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    files.iter().map(|path| std::fs::read(path).expect("readable")).collect()
}

/// Random part of a text, of whole lines half of the time.
fn part(text: &[u8], random: &mut Sequence) -> (usize, usize) {
    let mut from = random.below(text.len() + 1);
    let mut to = (from + random.below(60)).min(text.len());
    if random.below(2) == 0 {
        from = text[..from].iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        to = text[to..].iter().position(|byte| *byte == b'\n').map_or(text.len(), |at| to + at + 1);
    }
    (from, to)
}

fn mutate(text: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut Sequence) {
    let (from, to) = part(text, random);
    match random.below(8) {
        0 => drop(text.drain(from..to)),
        1 | 2 => drop(text.splice(from..from, random.pick(TOKENS).bytes())),
        3 => drop(text.splice(from..to, random.pick(TOKENS).bytes())),
        4 => {
            let other = random.pick(corpus);
            let (other_from, other_to) = part(other, random);
            drop(text.splice(from..to, other[other_from..other_to].iter().copied()));
        }
        5 => {
            let copy = text[from..to].to_vec();
            let at = random.below(text.len() + 1);
            drop(text.splice(at..at, copy));
        }
        6 => {
            if let Some(byte) = text.get_mut(from) {
                *byte = (random.next() & 0xff) as u8;
            }
        }
        _ => {
            let digit = text.iter().skip(from).position(u8::is_ascii_digit);
            if let Some(byte) = digit.and_then(|at| text.get_mut(from + at)) {
                *byte = b"0123456789-.e"[random.below(13)];
            }
        }
    }
}

/// Reads one input and checks the properties that hold for any input. Returns true if it was
/// accepted.
fn check(input: &[u8], settings: &[String]) -> bool {
    let source = Memory::default().with("x.toml", input);
    match project::read(&source, "x.toml", settings, &[]) {
        Ok(loaded) => {
            let text = project::print(&loaded.project);
            let again = project::read(&Memory::default().with("y.toml", text.as_str()), "y.toml", &[], &[]);
            let again = again.unwrap_or_else(|report| panic!("{report}\n{text}"));
            assert!(again.project == loaded.project, "{text}");
            true
        }
        Err(report) => {
            assert!(!report.diagnostics.is_empty() && report.diagnostics.len() <= 200);
            for found in report.diagnostics.iter().filter(|found| found.file == "x.toml") {
                assert!(found.span.start <= found.span.end && !found.message.is_empty());
                assert!(found.span.end <= input.len() + 8, "{found:?}");
            }
            if report.diagnostics.len() < 4 {
                assert!(!report.to_string().is_empty());
            }
            false
        }
    }
}

/// Returns the number of accepted mutations. Every other input starts from a valid project.
fn run(seed: u64, inputs: u64, valid: &[Vec<u8>], all: &[Vec<u8>]) -> u64 {
    let mut random = Sequence(seed);
    let mut accepted = 0;
    for index in 0..inputs {
        let mut text = random.pick(if index % 2 == 0 { valid } else { all }).clone();
        for _ in 0..=random.below(3) {
            mutate(&mut text, all, &mut random);
        }
        text.truncate(8192);
        let setting = (random.below(8) == 0).then(|| {
            let (from, to) = part(&text, &mut random);
            String::from_utf8_lossy(&text[from..to]).into_owned()
        });
        accepted += u64::from(check(&text, &setting.into_iter().collect::<Vec<_>>()));
    }
    accepted
}

/// Reads this number of inputs, split between the threads.
fn neither_panic_nor_hang(inputs: u64) {
    let mut valid = corpus(&["tests/valid", "../../examples/ybitu"]);
    valid.push(STARTER.as_bytes().to_vec());
    let all: Vec<_> =
        corpus(&["tests/malformed", "catalogue/hoses"]).into_iter().chain(valid.clone()).collect();
    let accepted: u64 = thread::scope(|scope| {
        let one = |seed| {
            let (valid, all) = (&valid, &all);
            scope.spawn(move || run(seed, inputs / THREADS, valid, all))
        };
        let threads = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03].map(one);
        threads.into_iter().map(|thread| thread.join().expect("no panic")).sum()
    });
    // mutations that leave a project valid make the test reach past the reader; most do not
    assert!(accepted > inputs / 100 && accepted < inputs, "{accepted}");
}

#[test]
fn mutated_projects_neither_panic_nor_hang() {
    neither_panic_nor_hang(INPUTS);
}

#[test]
#[ignore = "long: `cargo xtask ci mutation` runs it"]
fn many_mutated_projects_neither_panic_nor_hang() {
    neither_panic_nor_hang(20 * INPUTS);
}

#[test]
fn size_and_nesting_are_bounded() {
    for (input, message) in [
        ("#".repeat((1 << 20) + 1), "the file has 1048577 bytes; at most 1048576 are read"),
        (format!("a = {}", "[".repeat(100_000)), "nested deeper than 16"),
        (format!("a = {}", "{a=".repeat(100_000)), "nested deeper than 16"),
        (format!("[{}]", vec!["a"; 100_000].join(".")), "nested deeper than 16"),
        (format!("{} = 1", vec!["\"a\""; 100_000].join(" . ")), "nested deeper than 16"),
    ] {
        let source = Memory::default().with("x.toml", input);
        let report = project::read(&source, "x.toml", &[], &[]).expect_err("refused");
        assert_eq!(report.diagnostics[0].message, message);
    }
    work_is_bounded();
    let many = (0..50_000).map(|index| format!("k{index} = 1\n")).collect::<String>();
    let report =
        project::read(&Memory::default().with("x.toml", many), "x.toml", &[], &[]).expect_err("refused");
    assert_eq!((report.diagnostics.len(), report.more > 45_000), (200, true));
}

/// Files of a megabyte, each constructed to be slow if work could grow with the square of its size.
fn work_is_bounded() {
    let plant = "schema = 1\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n";
    let names =
        |count: usize, text: &str| (0..count).map(|i| text.replace('#', &i.to_string())).collect::<String>();
    let long = names(180, "name_# + ");
    let specification = "[[specification]]\nkind = \"sensitivity\"\nlimit = 1\nfrequencies = ";
    let inputs = [
        format!("{plant}{specification}[{}]", "-1,".repeat(300_000)),
        format!("{plant}{specification}[{}]", "\"1 bar\",".repeat(100_000)),
        format!("{plant}[controller]\ngain = 1\nzeros = [{}]", "[1, 2], [1, -2],".repeat(60_000)),
        format!("{plant}[controller]\nelements = [{}]", "{ kind = \"pole\" },".repeat(50_000)),
        format!(
            "{plant}[uncertainty]\n{}",
            names(15_000, "k# = { nominal = 1, minimum = 1, maximum = 1 }\n")
        ),
        format!(
            "{}[uncertainty]\n{}",
            plant.replace("\"k\"", &format!("\"{long}1\"")),
            names(60_000, "nome_# = 1\n")
        ),
        format!("{plant}[family]\ncases = [{{ {} }}]", names(60_000, "k# = 1, ")),
        format!("{plant}[family]\ncases = [{}]", "{ k = 1 },".repeat(90_000)),
        names(40_000, "[[scenario]]\nname = \"a\"\n"),
        names(40_000, "[a#.b]\nc = \"1\"\n"),
        format!("title = \"{}\"", "\\u0041".repeat(150_000)),
        format!("{plant}{specification}[1]\n\n{}", "[[specification]]\n".repeat(50_000)),
        "\n".repeat(1_000_000),
        "[".repeat(1_000_000),
        "\"\"\"".repeat(300_000),
        "a.".repeat(500_000),
    ];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for some in inputs.chunks(inputs.len().div_ceil(threads)) {
            scope.spawn(move || some.iter().for_each(|input| reads(input)));
        }
    });
}

/// Checks that a file of at most a megabyte is read, or rejected.
fn reads(input: &str) {
    assert!(input.len() <= 1 << 20, "{}", input.len());
    let source = Memory::default().with("x.toml", input);
    let _ = project::read(&source, "x.toml", &[], &[]).map_err(|report| report.to_string());
}

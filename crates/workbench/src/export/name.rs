//! Identifier of exported files.

/// Longest identifier: linkers of small targets distinguish 31 characters, and names end in
/// `_self_test`.
const LONGEST: usize = 20;

/// Words that C99, C++ or Structured Text reserve, among those that a title could give.
const RESERVED: [&str; 26] = [
    "action",
    "auto",
    "break",
    "case",
    "char",
    "class",
    "continue",
    "default",
    "double",
    "else",
    "float",
    "for",
    "if",
    "int",
    "long",
    "main",
    "new",
    "reference",
    "register",
    "return",
    "short",
    "signed",
    "static",
    "switch",
    "void",
    "while",
];

/// Identifier of a title: its letters and digits in lower case, joined by underscores; whole words
/// of at most twenty characters. `None` if the title begins with no letter of A to Z or gives a
/// reserved word.
///
/// # Example
/// ```
/// use phea_workbench::export::identifier;
/// assert_eq!(identifier("Ybitu rig, 1.5 m of HVE hose").as_deref(), Some("ybitu_rig_1_5_m_of"));
/// assert_eq!([identifier("Ωmega"), identifier("2 rigs"), identifier("Reference")], [None, None, None]);
/// ```
pub fn identifier(title: &str) -> Option<String> {
    let words = title.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let mut name = String::new();
    for word in words {
        if !name.is_empty() && name.len() + 1 + word.len() > LONGEST {
            break;
        }
        if !name.is_empty() {
            name.push('_');
        }
        name.push_str(&word.to_ascii_lowercase());
    }
    name.truncate(LONGEST);
    let begins = title.starts_with(|letter: char| letter.is_ascii_alphabetic());
    (begins && !RESERVED.contains(&name.as_str())).then_some(name)
}

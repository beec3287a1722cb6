//! Names of the files of scenarios.

/// Names of the files with the states of these scenarios.
pub fn state_names<'a>(scenarios: impl Iterator<Item = &'a str>) -> Vec<String> {
    file_names(scenarios).into_iter().map(|name| format!("{name}.state.toml")).collect()
}

/// Names of the tables of these scenarios, each derived from the scenario's name, and all
/// different.
pub(crate) fn table_names<'a>(scenarios: impl Iterator<Item = &'a str>, ending: &str) -> Vec<String> {
    file_names(scenarios).into_iter().map(|name| format!("{name}.{ending}")).collect()
}

/// Names of files without their ending, each derived from its name, and all different.
pub fn file_names<'a>(scenarios: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for scenario in scenarios {
        let plain = file_name(scenario);
        let numbered = (2..).map(|number| format!("{plain} {number}"));
        let taken = |name: &String| names.iter().any(|known| known.eq_ignore_ascii_case(name));
        let name =
            std::iter::once(plain.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(plain.clone());
        names.push(name);
    }
    names
}

/// File name in which characters that file systems do not accept are replaced by underscores.
fn file_name(name: &str) -> String {
    let plain =
        |letter: char| if letter.is_control() || "/\\:*?\"<>|".contains(letter) { '_' } else { letter };
    let name: String = name.chars().map(plain).collect();
    match name.trim_matches([' ', '.']) {
        "" => "scenario".to_string(),
        name => name.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_names_everywhere() {
        let name = |text: &str| file_name(text);
        assert_eq!(name("step and load motion"), "step and load motion");
        assert_eq!(
            (name("a/b\\c:d"), name(" .. "), name("1 ms.")),
            ("a_b_c_d".into(), "scenario".into(), "1 ms".into())
        );
    }

    #[test]
    fn tables_of_scenarios_with_like_names_have_names_of_their_own() {
        let names = table_names(["step", "Step", "a/b", "step"].into_iter(), "csv");
        assert_eq!(names, ["step.csv", "Step 2.csv", "a_b.csv", "step 3.csv"]);
    }
}

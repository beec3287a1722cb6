use comfy_table::{Table, presets};

/// An empty table with these headings, aligned with spaces so that it can be read, searched and pasted anywhere.
///
/// # Example
/// ```
/// let mut table = phea_workbench::answer::table(&["quantity", "value"]);
/// table.add_row(["stiffness", "2.233e6 N/m"]);
/// assert_eq!(table.trim_fmt().lines().last(), Some(" stiffness  2.233e6 N/m"));
/// ```
pub fn table(headings: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(headings);
    table
}

//! Equations of plain text as set on a page.

use phea_workbench::document::typeset;

#[test]
fn text_is_escaped_and_scripts_end_correctly() {
    let check = |equation: &str, expected: &str| {
        assert_eq!(typeset(equation).into_string(), format!("<span class=\"equation\">{expected}</span>"));
    };
    check("a < b", "<i>a</i> &lt; <i>b</i>");
    check("V_{A0}^2", "<i>V</i><sub>A0</sub><sup>2</sup>");
    check("s^-1", "<i>s</i><sup>-1</sup>");
    check("sqrt(p_S)", "sqrt(<i>p</i><sub>S</sub>)");
    check("β_e_", "<i>β</i><sub>e</sub>_");
    check("x^{", "<i>x</i>^{");
}

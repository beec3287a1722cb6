//! Concrete figures with numbers of the example rig: well formed, legible, and reproducible.

use crate::gallery;
use crate::legibility::check;
use phea_figure::scene::Text;
use phea_figure::{Curve, CurveChart, CurvePanel, CurveStyle, Figure, FigureError, Theme, Words};
use resvg::usvg::{self, roxmltree};

#[test]
fn figures_are_well_formed_legible_and_finite() {
    for figure in gallery::all() {
        check(&figure);
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<String> = gallery::all().into_iter().map(|figure| figure.name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), gallery::all().len());
}

#[test]
fn the_same_numbers_give_the_same_bytes() {
    for (a, b) in gallery::all().into_iter().zip(gallery::all()) {
        assert_eq!(a.to_svg_inline(), b.to_svg_inline());
        assert_eq!(a.to_svg_standalone(), b.to_svg_standalone());
        assert_eq!(a.to_png(1.0).unwrap(), b.to_png(1.0).unwrap());
    }
}

#[test]
fn a_page_gets_classes_and_a_file_gets_colours() {
    for figure in gallery::all() {
        let (page, file) = (figure.to_svg_inline(), figure.to_svg_standalone());
        assert!(page.contains("class=\"phea-figure\"") && page.contains("class=\"s-"));
        assert!(!file.contains("class=") && file.contains("#ffffff"));
        assert!(figure.to_svg_themed(Theme::Dark).contains("#16191d"));
        for svg in [&page, &file] {
            let document = roxmltree::Document::parse(svg).unwrap();
            let root = document.root_element();
            assert_eq!(root.attribute("role"), Some("img"));
            for child in ["title", "desc"] {
                let node = root.children().find(|n| n.has_tag_name(("http://www.w3.org/2000/svg", child)));
                let id = node.and_then(|n| n.attribute("id")).unwrap();
                assert!(root.attribute("aria-labelledby").unwrap().split(' ').any(|name| name == id));
            }
        }
    }
}

fn texts<'a>(group: &'a usvg::Group, found: &mut Vec<&'a usvg::Text>) {
    for node in group.children() {
        match node {
            usvg::Node::Text(text) => found.push(text),
            usvg::Node::Group(group) => texts(group, found),
            _ => {}
        }
    }
}

#[test]
fn text_is_as_wide_as_the_rasteriser_sets_it() {
    // two independent ways: our sum of advances, and the shaping of the rasteriser with the
    // embedded font only
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_font_data(phea_figure::typeset::FONT.to_vec());
    for figure in gallery::all() {
        let tree = usvg::Tree::from_str(&figure.to_svg_standalone(), &options).unwrap();
        let mut set = Vec::new();
        texts(tree.root(), &mut set);
        // a text of several pieces is drawn again over its halo
        let times = |text: &Text| if text.halo && text.content.contains(['_', '^']) { 2 } else { 1 };
        let drawn = || figure.scene.texts().flat_map(|text| std::iter::repeat_n(text, times(text)));
        assert_eq!(set.len(), drawn().count(), "{}: a text got lost", figure.name);
        for (ours, theirs) in drawn().zip(set) {
            let (a, b) = (ours.bounds(), theirs.abs_bounding_box());
            let x = [a.left - f64::from(b.left()), a.right - f64::from(b.right())];
            let y = [a.top - f64::from(b.top()), a.bottom - f64::from(b.bottom())];
            let along = if ours.rotation_degrees == 0.0 { x } else { y };
            assert!(along.iter().all(|d| d.abs() < 0.6), "{}: {} by {along:?}", figure.name, ours.content);
        }
    }
}

#[test]
fn pictures_have_the_requested_size() {
    let figure = gallery::stiffness();
    let size = |bytes: &[u8]| -> (u32, u32) {
        let read = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        (read(16), read(20))
    };
    let png = figure.to_png(2.0).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let height = (2.0 * figure.scene.height) as u32;
    assert_eq!(size(&png), (1120, height));
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9, 1e-9 - 1.0] {
        assert!(matches!(figure.to_png(scale), Err(FigureError::ScaleOutOfRange { .. })), "{scale}");
    }
}

fn notes(figure: &Figure) -> String {
    figure.to_svg_inline()
}

#[test]
fn the_nomograph_shows_the_velocities_of_the_thesis() {
    // ORIGIN: analytic, v = 4 q/(pi d^2) with 9.8 L/min: 1.29 m/s in 12.7 mm; 2.1 to 4.6 m/s need
    // 9.95 to 6.72 mm.
    let svg = notes(&gallery::commercial_bores());
    for text in ["12.7 mm: 1.29 m/s", ">6.72 mm<", ">9.95 mm<", ">design flow 9.8 L/min<"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn the_softest_point_is_marked() {
    // ORIGIN: recomputed from Ledezma (2019), equations 6.19 to 6.24: 2.233 MN/m in mid stroke, by
    // volume 5.01.
    let svg = notes(&gallery::stiffness());
    assert!(svg.contains(">2.23 MN/m<") && svg.contains(">5.01 MN/m<"));
}

#[test]
fn poles_show_their_value() {
    let svg = notes(&gallery::circuit());
    assert!(svg.contains("50/22 mm, stroke 500 mm"));
    let svg = notes(&gallery::poles(phea_figure::PoleMapScale::SignedLogarithmic));
    assert!(svg.contains("pole at \u{2212}11.6 + 2938j rad/s"));
}

/// Names of a panel's curves are above its own frame and below the frame before it, each once.
#[test]
fn names_of_curves_are_at_their_own_panel() {
    let line = |value: f64, series| Curve::line([(0.0, value), (1.0, value + 1.0)], series);
    let panel = |title: &str, names: [&str; 2]| CurvePanel {
        named: names.iter().enumerate().map(|(i, name)| (name.to_string(), CurveStyle::Line(i))).collect(),
        ..CurvePanel::new(title, 90.0, vec![line(0.0, 0), line(2.0, 1)])
    };
    let panels = vec![panel("Voltage (V)", ["command", "spool"]), panel("Pressure (bar)", ["p_A", "p_B"])];
    let chart = CurveChart { x_title: "Time (s)".into(), x_range: [0.0, 1.0], panels, legend: vec![] };
    let figure = chart.draw(&Words::new("names", "names", "names"));
    check(&figure);
    let at = |content: &str| {
        let mut found = figure.scene.texts().filter(|text| text.content == content);
        let text = found.next().unwrap_or_else(|| panic!("no {content}"));
        assert!(found.next().is_none(), "{content} twice");
        text.position.y
    };
    let [voltage, pressure] = ["Voltage (V)", "Pressure (bar)"].map(at);
    for name in ["command", "spool"] {
        assert!(at(name) < voltage, "{name}");
    }
    for name in ["p_A", "p_B"] {
        assert!((voltage..pressure).contains(&at(name)), "{name}");
    }
}

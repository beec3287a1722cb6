//! Rules for every figure, for any content.

use phea_figure::scene::{Item, PathStep, Point, Rectangle, Shape};
use phea_figure::{Figure, SMALL_SIZE};
use resvg::usvg::roxmltree;

/// Checks that the figure is well formed, finite and inside its box, without overlapping or too
/// small texts.
pub(crate) fn check(figure: &Figure) {
    let name = &figure.name;
    let scene = &figure.scene;
    let page = Rectangle { left: 0.0, top: 0.0, right: scene.width, bottom: scene.height };
    for svg in [figure.to_svg_inline(), figure.to_svg_standalone()] {
        let parsed = roxmltree::Document::parse(&svg);
        assert!(parsed.is_ok(), "{name}: {parsed:?}");
        let Ok(document) = parsed else { continue };
        for node in document.descendants().filter(roxmltree::Node::is_element) {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{name}: {value}");
            }
        }
    }
    for item in &scene.items {
        for p in points(item) {
            assert!(page.contains_point(p), "{name}: {p:?} of {item:?} is outside");
        }
    }
    let texts: Vec<_> = scene.texts().map(|text| (text, text.bounds())).collect();
    for (index, (text, bounds)) in texts.iter().enumerate() {
        assert!(page.contains(bounds), "{name}: {:?} is outside: {bounds:?}", text.content);
        assert!(text.size >= SMALL_SIZE, "{name}: {:?} is too small", text.content);
        for (other, of_other) in texts.iter().take(index) {
            assert!(
                !bounds.overlaps(of_other),
                "{name}: {:?} lies upon {:?}: {bounds:?} and {of_other:?}",
                text.content,
                other.content,
            );
        }
    }
}

fn points(item: &Item) -> Vec<Point> {
    match item {
        Item::Text(text) => vec![text.position],
        Item::Drawing { shape: Shape::Circle(centre, _), .. } => vec![*centre],
        Item::Drawing { shape: Shape::Rectangle(r, _), .. } => {
            vec![Point { x: r.left, y: r.top }, Point { x: r.right, y: r.bottom }]
        }
        Item::Drawing { shape: Shape::Path(steps), .. } => steps
            .iter()
            .flat_map(|step| match step {
                PathStep::Move(p) | PathStep::Line(p) => vec![*p],
                PathStep::Curve(_, _, p) => vec![*p],
                PathStep::Close => vec![],
            })
            .collect(),
    }
}

//! Scene as SVG text.
//!
//! Numbers have two decimals at most, so the text is identical on every computer. Colours are
//! written as attributes resolved for a theme; on a page the classes of the style sheet override
//! them.

use super::colour::{Role, Theme};
use super::scene::{Anchor, Item, PathStep, Point, Scene, Shape, Stroke, Text};
use super::typeset::{FONT_FAMILY, drop_to_letters, pieces};

/// Destination of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SvgDestination {
    /// Page that includes the style sheet.
    Page,
    /// Separate file.
    File(Theme),
}

/// Names for readers and screen readers.
#[derive(Clone, Copy, Debug)]
pub struct SvgNames<'a> {
    /// Identifier, unique on a page; only letters, digits and hyphens are kept.
    pub identifier: &'a str,
    /// Short title.
    pub title: &'a str,
    /// Description of the picture.
    pub description: &'a str,
}

/// Writes a scene.
pub fn write(scene: &Scene, names: SvgNames<'_>, destination: SvgDestination) -> String {
    let mut out = String::with_capacity(64 * scene.items.len() + 512);
    let identifier = slug(names.identifier);
    let (width, height) = (number(scene.width), number(scene.height));
    let size = match destination {
        SvgDestination::Page => " class=\"phea-figure\"".to_string(),
        SvgDestination::File(_) => format!(" width=\"{width}\" height=\"{height}\""),
    };
    out.push_str(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\"{size} viewBox=\"0 0 {width} {height}\" role=\"img\" \
         aria-labelledby=\"{identifier}-title {identifier}-description\" font-family=\"{FONT_FAMILY}\" fill=\"none\">\n\
         <title id=\"{identifier}-title\">{}</title>\n<desc id=\"{identifier}-description\">{}</desc>\n",
        escaped(names.title),
        escaped(names.description)
    ));
    let writer = SvgWriter { destination };
    if let SvgDestination::File(_) = destination {
        let fill = writer.paint("fill", Role::Background);
        out.push_str(&format!("<rect width=\"{width}\" height=\"{height}\"{fill}/>\n"));
    }
    for item in &scene.items {
        writer.item(item, &mut out);
    }
    out.push_str("</svg>\n");
    out
}

struct SvgWriter {
    destination: SvgDestination,
}

impl SvgWriter {
    /// Attribute with the resolved colour.
    fn paint(&self, attribute: &str, role: Role) -> String {
        let theme = match self.destination {
            SvgDestination::Page => Theme::Light,
            SvgDestination::File(theme) => theme,
        };
        format!(" {attribute}=\"{}\"", role.colour(theme))
    }

    fn classes(&self, stroke: Option<Role>, fill: Option<Role>) -> String {
        if self.destination != SvgDestination::Page {
            return String::new();
        }
        let names: Vec<String> = stroke
            .map(|role| format!("s-{}", role.name()))
            .into_iter()
            .chain(fill.map(|role| format!("f-{}", role.name())))
            .collect();
        if names.is_empty() { String::new() } else { format!(" class=\"{}\"", names.join(" ")) }
    }

    fn item(&self, item: &Item, out: &mut String) {
        match item {
            Item::Text(text) => self.text(text, out),
            Item::Drawing { shape, stroke, fill, note } => {
                let Some(geometry) = geometry(shape) else { return };
                out.push_str(&geometry);
                out.push_str(&self.classes(stroke.map(|s| s.role), fill.map(|f| f.role)));
                if let Some(stroke) = stroke {
                    out.push_str(&self.outline(stroke));
                }
                if let Some(fill) = fill {
                    out.push_str(&self.paint("fill", fill.role));
                    if fill.opacity < 1.0 {
                        out.push_str(&format!(" fill-opacity=\"{}\"", number(fill.opacity)));
                    }
                }
                match note {
                    Some(note) => {
                        out.push_str(&format!("><title>{}</title></{}>\n", escaped(note), element(shape)))
                    }
                    None => out.push_str("/>\n"),
                }
            }
        }
    }

    fn outline(&self, stroke: &Stroke) -> String {
        let mut result = self.paint("stroke", stroke.role);
        result.push_str(&format!(" stroke-width=\"{}\"", number(stroke.width)));
        let lengths = stroke.dash.lengths();
        if lengths.is_empty() {
            result.push_str(" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
        } else {
            let scale = (stroke.width / 1.5).max(0.8);
            let pattern: Vec<String> = lengths.iter().map(|length| number(length * scale)).collect();
            result
                .push_str(&format!(" stroke-linejoin=\"round\" stroke-dasharray=\"{}\"", pattern.join(" ")));
        }
        result
    }

    fn text(&self, text: &Text, out: &mut String) {
        let Point { x, y } = text.position;
        if !(x.is_finite() && y.is_finite() && text.size.is_finite() && text.rotation_degrees.is_finite()) {
            return;
        }
        let anchor = match text.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let letters = drop_to_letters(text);
        let rotation = if text.rotation_degrees == 0.0 {
            String::new()
        } else {
            format!(" transform=\"rotate({} {} {})\"", number(text.rotation_degrees), number(x), number(y))
        };
        let spans = spans(text);
        let placed = format!(
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{anchor}{rotation}",
            number(x),
            number(y + letters),
            number(text.size)
        );
        let mut letter = |halo: Option<Role>, hidden: &str| {
            let classes = self.classes(halo, Some(text.role));
            out.push_str(&format!("{placed}{hidden}{classes}{}", self.paint("fill", text.role)));
            if let Some(role) = halo {
                out.push_str(&self.paint("stroke", role));
                out.push_str(" stroke-width=\"3.5\" stroke-linejoin=\"round\" paint-order=\"stroke\"");
            }
            out.push_str(&format!(">{spans}</text>\n"));
        };
        letter(text.halo.then_some(Role::Background), "");
        // the halo of one piece covers the piece before it
        if text.halo && spans.contains("<tspan") {
            letter(None, " aria-hidden=\"true\"");
        }
    }
}

/// Pieces of a line; a change of level is a relative move, since browsers disagree on
/// `baseline-shift`.
fn spans(text: &Text) -> String {
    let mut result = String::new();
    let mut rise = 0.0;
    for (piece, level) in pieces(&text.content) {
        let shift = (rise - level.rise()) * text.size;
        rise = level.rise();
        if shift == 0.0 && level.scale() == 1.0 {
            result.push_str(&escaped(&piece));
        } else {
            result.push_str(&format!(
                "<tspan dy=\"{}\" font-size=\"{}\">{}</tspan>",
                number(shift),
                number(level.scale() * text.size),
                escaped(&piece)
            ));
        }
    }
    result
}

fn element(shape: &Shape) -> &'static str {
    match shape {
        Shape::Path(_) => "path",
        Shape::Rectangle(..) => "rect",
        Shape::Circle(..) => "circle",
    }
}

/// Opening of the element; `None` if a number is not finite or nothing would be drawn.
fn geometry(shape: &Shape) -> Option<String> {
    match shape {
        Shape::Path(steps) => {
            let data = path_data(steps)?;
            Some(format!("<path d=\"{data}\""))
        }
        Shape::Rectangle(r, radius) => {
            let finite = [r.left, r.top, r.right, r.bottom, *radius].iter().all(|v| v.is_finite());
            let corner = if *radius > 0.0 { format!(" rx=\"{}\"", number(*radius)) } else { String::new() };
            finite.then(|| {
                format!(
                    "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{corner}",
                    number(r.left),
                    number(r.top),
                    number(r.width().max(0.0)),
                    number(r.height().max(0.0))
                )
            })
        }
        Shape::Circle(c, radius) => {
            let finite = c.x.is_finite() && c.y.is_finite() && radius.is_finite();
            finite.then(|| {
                format!(
                    "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"",
                    number(c.x),
                    number(c.y),
                    number(radius.max(0.0))
                )
            })
        }
    }
}

fn path_data(steps: &[PathStep]) -> Option<String> {
    let mut data = String::with_capacity(12 * steps.len());
    for step in steps {
        let (letter, points): (char, &[Point]) = match step {
            PathStep::Move(p) => ('M', std::slice::from_ref(p)),
            PathStep::Line(p) => ('L', std::slice::from_ref(p)),
            PathStep::Curve(a, b, c) => ('C', &[*a, *b, *c]),
            PathStep::Close => ('Z', &[]),
        };
        data.push(letter);
        for (index, p) in points.iter().enumerate() {
            if !(p.x.is_finite() && p.y.is_finite()) {
                return None;
            }
            if index > 0 {
                data.push(' ');
            }
            data.push_str(&number(p.x));
            data.push(' ');
            data.push_str(&number(p.y));
        }
    }
    (steps.len() > 1).then_some(data)
}

/// Finite number with two decimals at most, without a negative zero; any other number as 0.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_string();
    }
    let fixed = format!("{value:.2}");
    let short = if fixed.contains('.') { fixed.trim_end_matches('0').trim_end_matches('.') } else { &fixed };
    if short == "-0" { "0".to_string() } else { short.to_string() }
}

/// Text for XML: markup characters as entities, characters that XML forbids omitted.
pub fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => result.push_str("&amp;"),
            '<' => result.push_str("&lt;"),
            '>' => result.push_str("&gt;"),
            '"' => result.push_str("&quot;"),
            '\t' | '\n' => result.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => result.push(c),
        }
    }
    result
}

/// Name usable as an identifier.
fn slug(name: &str) -> String {
    let body: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    format!("figure-{body}")
}

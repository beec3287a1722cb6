//! Contrast and colour blindness: guarantees of the palette.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use phea_dynamics::portable::{cbrt, pow};
use phea_figure::Theme;
use phea_figure::colour::{RAMP_COUNT, ROLES, Role, SERIES_COUNT, style_sheet};
use phea_figure::series::series_stroke;

type Rgb = [f64; 3];

/// Linear components of an sRGB colour (IEC 61966-2-1).
fn linear(hex: &str) -> Rgb {
    [1, 3, 5].map(|start| {
        let byte = u8::from_str_radix(&hex[start..start + 2], 16).unwrap();
        let v = f64::from(byte) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { pow((v + 0.055) / 1.055, 2.4) }
    })
}

fn luminance(c: Rgb) -> f64 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

/// WCAG 2 contrast ratio.
fn contrast(a: Rgb, b: Rgb) -> f64 {
    let (high, low) = (luminance(a).max(luminance(b)), luminance(a).min(luminance(b)));
    (high + 0.05) / (low + 0.05)
}

fn of(role: Role, theme: Theme) -> Rgb {
    linear(role.colour(theme))
}

const THEMES: [Theme; 2] = [Theme::Light, Theme::Dark];

#[test]
fn text_and_lines_have_more_contrast_than_decoration() {
    for theme in THEMES {
        let page = of(Role::Background, theme);
        for role in ROLES {
            let ratio = contrast(of(role, theme), page);
            let (least, most) = match role {
                Role::Text | Role::Muted | Role::Accent | Role::Good | Role::Warning | Role::Bad => {
                    (4.5, 21.1)
                }
                Role::Axis | Role::Series(_) | Role::Ramp(_) => (3.0, 21.1),
                Role::Grid => (1.3, 2.0),
                Role::MinorGrid => (1.1, 1.4),
                Role::Surface => (1.02, 1.3),
                Role::Background => (1.0, 1.0),
            };
            assert!((least..=most).contains(&ratio), "{role:?} in {theme:?}: {ratio:.2}");
        }
        for role in [Role::Text, Role::Muted] {
            assert!(
                contrast(of(role, theme), of(Role::Surface, theme)) >= 4.5,
                "{role:?} on a block, {theme:?}"
            );
        }
    }
}

/// Full dichromacy as matrices on linear sRGB. ORIGIN: paper, Machado, Oliveira and Fernandes
/// (2009), severity 1.0.
const SIGHT: [(&str, [Rgb; 3]); 4] = [
    ("normal", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    (
        "protanopia",
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    ),
    (
        "deuteranopia",
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    ),
    (
        "tritanopia",
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ),
];

fn product(matrix: &[Rgb; 3], v: Rgb) -> Rgb {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Oklab coordinates of linear sRGB. ORIGIN: paper, Ottosson (2020), A perceptual color space for
/// image processing.
fn oklab(c: Rgb) -> Rgb {
    let cone = product(
        &[
            [0.4122214708, 0.5363325363, 0.0514459929],
            [0.2119034982, 0.6806995451, 0.1073969566],
            [0.0883024619, 0.2817188376, 0.6299787005],
        ],
        c,
    );
    product(
        &[
            [0.2104542553, 0.7936177850, -0.0040720468],
            [1.9779984951, -2.4285922050, 0.4505937099],
            [0.0259040371, 0.7827717662, -0.8086757660],
        ],
        cone.map(cbrt),
    )
}

fn seen_distance(a: Role, b: Role, theme: Theme, matrix: &[Rgb; 3]) -> f64 {
    let seen = |role| oklab(product(matrix, of(role, theme)).map(|v: f64| v.clamp(0.0, 1.0)));
    let (p, q) = (seen(a), seen(b));
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Distance in Oklab (black to white is 1) below which two series could be confused.
const APART: f64 = 0.08;
/// Distance for the first four series, which suffice for most figures.
const FIRST_APART: f64 = 0.12;

#[test]
fn series_are_distinguishable_for_every_kind_of_sight() {
    for theme in THEMES {
        for (sight, matrix) in &SIGHT {
            for i in 0..SERIES_COUNT {
                for j in 0..i {
                    let distance = seen_distance(Role::Series(i), Role::Series(j), theme, matrix);
                    let least = if i < 4 { FIRST_APART } else { APART };
                    assert!(distance >= least, "{i} and {j}, {sight}, {theme:?}: {distance:.4}");
                }
            }
        }
    }
}

#[test]
fn steps_of_the_ramp_grow_lighter_and_are_distinguishable() {
    for theme in THEMES {
        for i in 1..RAMP_COUNT {
            let (below, above) = (Role::Ramp(i - 1), Role::Ramp(i));
            let [dark, light] = [below, above].map(|role| oklab(of(role, theme))[0]);
            assert!(light > dark + 0.05, "{i}, {theme:?}: {dark:.3} {light:.3}");
            for (sight, matrix) in &SIGHT {
                let distance = seen_distance(below, above, theme, matrix);
                assert!(distance >= 0.05, "{i}, {sight}, {theme:?}: {distance:.4}");
            }
        }
    }
}

#[test]
fn series_differ_without_colour() {
    for i in 0..usize::from(SERIES_COUNT) {
        for j in 0..i {
            assert_ne!(series_stroke(i).dash, series_stroke(j).dash, "{i} and {j}");
        }
    }
}

#[test]
fn the_style_sheet_names_every_role_for_both_themes() {
    let css = style_sheet();
    let (light, rest) = css.split_once("@media screen and (prefers-color-scheme:dark)").unwrap();
    for role in ROLES {
        assert!(light.contains(&format!("--figure-{}:{};", role.name(), role.colour(Theme::Light))));
        assert!(rest.contains(&format!("--figure-{}:{};", role.name(), role.colour(Theme::Dark))));
        assert!(rest.contains(&format!(".s-{0}{{stroke:var(--figure-{0})}}", role.name())));
        assert!(rest.contains(&format!(".f-{0}{{fill:var(--figure-{0})}}", role.name())));
    }
    assert_eq!(css.matches('{').count(), css.matches('}').count());
}

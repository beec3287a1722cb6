//! Colours by role, for a light and a dark page.
//!
//! A scene names roles; a theme gives each role its colour. On a page the style sheet
//! ([`style_sheet`]) sets one custom property per role, so that the reader's preference chooses the
//! theme and print is always light; a standalone file carries the resolved light colours.
//!
//! Guarantees, asserted by tests: text has a contrast of 4.5 or more against the background of its
//! theme, lines and series 3 or more. Grid lines and surfaces are decoration: visible, and well
//! below the data. The eight series start from the hues of Okabe and Ito (2008), adjusted until
//! every pair is distinguishable for normal, protanope, deuteranope and tritanope sight (simulated
//! after Machado, Oliveira and Fernandes 2009, distance in Oklab). Dash patterns and markers carry
//! the same distinction into a grey print. The eight steps of the ramp, for curves that have an
//! order, change their hue and grow lighter in equal steps, so neighbours are distinguishable for
//! all of these and in grey.

/// Purpose of a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Page background.
    Background,
    /// Interior of blocks and components.
    Surface,
    /// Frames, ticks and the outlines of components.
    Axis,
    /// Grid lines.
    Grid,
    /// Grid lines between those with a label.
    MinorGrid,
    /// Ordinary text.
    Text,
    /// Text and lines of less emphasis.
    Muted,
    /// Data series, counted from 0; the colours repeat after eight.
    Series(u8),
    /// Members of an ordered set such as frequencies, counted from 0, dark to light; the colours
    /// repeat after eight.
    Ramp(u8),
    /// Design value, operating point: the first thing to find in a figure.
    Accent,
    /// Accepted.
    Good,
    /// Warning.
    Warning,
    /// Rejected or violated.
    Bad,
}

/// Light or dark page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Dark on white: also for print and for files.
    Light,
    /// Light on near black.
    Dark,
}

/// Number of distinct series colours.
pub const SERIES_COUNT: u8 = 8;

/// Number of steps of the ramp.
pub const RAMP_COUNT: u8 = 8;

/// All roles, in a fixed order.
pub const ROLES: [Role; 27] = [
    Role::Background,
    Role::Surface,
    Role::Axis,
    Role::Grid,
    Role::MinorGrid,
    Role::Text,
    Role::Muted,
    Role::Series(0),
    Role::Series(1),
    Role::Series(2),
    Role::Series(3),
    Role::Series(4),
    Role::Series(5),
    Role::Series(6),
    Role::Series(7),
    Role::Ramp(0),
    Role::Ramp(1),
    Role::Ramp(2),
    Role::Ramp(3),
    Role::Ramp(4),
    Role::Ramp(5),
    Role::Ramp(6),
    Role::Ramp(7),
    Role::Accent,
    Role::Good,
    Role::Warning,
    Role::Bad,
];

impl Role {
    /// Name of the role in class names and custom properties.
    pub const fn name(self) -> &'static str {
        match self {
            Role::Background => "background",
            Role::Surface => "surface",
            Role::Axis => "axis",
            Role::Grid => "grid",
            Role::MinorGrid => "minor-grid",
            Role::Text => "text",
            Role::Muted => "muted",
            Role::Series(index) => match index % SERIES_COUNT {
                0 => "series-1",
                1 => "series-2",
                2 => "series-3",
                3 => "series-4",
                4 => "series-5",
                5 => "series-6",
                6 => "series-7",
                _ => "series-8",
            },
            Role::Ramp(index) => match index % RAMP_COUNT {
                0 => "ramp-1",
                1 => "ramp-2",
                2 => "ramp-3",
                3 => "ramp-4",
                4 => "ramp-5",
                5 => "ramp-6",
                6 => "ramp-7",
                _ => "ramp-8",
            },
            Role::Accent => "accent",
            Role::Good => "good",
            Role::Warning => "warning",
            Role::Bad => "bad",
        }
    }

    /// Colour of the role in a theme, as `#rrggbb`.
    pub const fn colour(self, theme: Theme) -> &'static str {
        let (light, dark) = match self {
            Role::Background => ("#ffffff", "#16191d"),
            Role::Surface => ("#f2f5f9", "#22282f"),
            Role::Axis => ("#46515f", "#a7b2bf"),
            Role::Grid => ("#d5dbe3", "#363f49"),
            Role::MinorGrid => ("#e9edf2", "#262d35"),
            Role::Text => ("#1a222c", "#e8ecf1"),
            Role::Muted => ("#5a6675", "#9ca8b5"),
            Role::Series(index) => match index % SERIES_COUNT {
                0 => ("#045dfb", "#58b6ff"),
                1 => ("#dc6115", "#ff8a3d"),
                2 => ("#036553", "#469d95"),
                3 => ("#7a3aaa", "#a06aff"),
                4 => ("#bd4685", "#ff9cc4"),
                5 => ("#8b5b00", "#f5dc70"),
                6 => ("#20293a", "#ffffff"),
                _ => ("#3c96c4", "#6d7cae"),
            },
            Role::Ramp(index) => match index % RAMP_COUNT {
                0 => ("#330044", "#983dbc"),
                1 => ("#59012e", "#cc409e"),
                2 => ("#6b2200", "#f34f71"),
                3 => ("#644902", "#ff7743"),
                4 => ("#4d6b00", "#fda102"),
                5 => ("#048466", "#eacb02"),
                6 => ("#0b92a6", "#bdf64e"),
                _ => ("#3c95fe", "#d8ffe4"),
            },
            Role::Accent => ("#b3136f", "#ff7ac6"),
            Role::Good => ("#187a3c", "#58d08a"),
            Role::Warning => ("#96570a", "#ffb84d"),
            Role::Bad => ("#b3261e", "#ff8a80"),
        };
        match theme {
            Theme::Light => light,
            Theme::Dark => dark,
        }
    }
}

/// Colour of member `index` of an ordered set of `count`: spread over the ramp, repeated if there
/// are more members than steps.
///
/// # Example
/// ```
/// use phea_figure::colour::{Role, ramp_role};
/// assert_eq!([0, 1, 2].map(|index| ramp_role(index, 3)), [Role::Ramp(0), Role::Ramp(3), Role::Ramp(7)]);
/// assert_eq!(ramp_role(8, 9), Role::Ramp(0));
/// ```
pub const fn ramp_role(index: usize, count: usize) -> Role {
    let steps = RAMP_COUNT as usize;
    let step = if count > 1 && count <= steps { index * (steps - 1) / (count - 1) } else { index };
    Role::Ramp((step % steps) as u8)
}

/// Colour of the series with this index.
pub const fn series_role(index: usize) -> Role {
    Role::Series((index % SERIES_COUNT as usize) as u8)
}

/// Style sheet for figures on a page: custom properties `--figure-ROLE` on the root element, one
/// class per role for strokes (`s-ROLE`) and one for interiors (`f-ROLE`). Dark follows the
/// reader's preference on screens; print is light.
///
/// # Example
/// ```
/// let css = phea_figure::style_sheet();
/// assert!(css.contains("--figure-background:#ffffff"));
/// assert!(css.contains("@media screen and (prefers-color-scheme:dark)"));
/// ```
pub fn style_sheet() -> String {
    let properties = |theme: Theme| -> String {
        ROLES.iter().map(|role| format!("--figure-{}:{};", role.name(), role.colour(theme))).collect()
    };
    let classes: String = ROLES
        .iter()
        .map(|role| {
            let name = role.name();
            format!(
                ".phea-figure .s-{name}{{stroke:var(--figure-{name})}}\
                 .phea-figure .f-{name}{{fill:var(--figure-{name})}}\n"
            )
        })
        .collect();
    format!(
        ":root{{{}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n\
         .phea-figure{{display:block;width:100%;max-width:680px;height:auto;background:var(--figure-background);\
         break-inside:avoid}}\n{}",
        properties(Theme::Light),
        properties(Theme::Dark),
        classes
    )
}

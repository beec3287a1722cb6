//! The files that come with the workbench.

/// Path below `catalogue/` and content.
pub(super) static BUILT_IN: &[(&str, &str)] = &[
    ("hoses/eaton_synflex_3130_08.toml", include_str!("../../catalogue/hoses/eaton_synflex_3130_08.toml")),
    ("valves/moog_760_c263a.toml", include_str!("../../catalogue/valves/moog_760_c263a.toml")),
    ("valves/moog_760_c263a_ybitu.toml", include_str!("../../catalogue/valves/moog_760_c263a_ybitu.toml")),
    ("valves/moog_d661_5628c.toml", include_str!("../../catalogue/valves/moog_d661_5628c.toml")),
    ("valves/moog_g761_3001b.toml", include_str!("../../catalogue/valves/moog_g761_3001b.toml")),
    ("valves/moog_g771_10.toml", include_str!("../../catalogue/valves/moog_g771_10.toml")),
    ("valves/moog_g771_4.toml", include_str!("../../catalogue/valves/moog_g771_4.toml")),
    ("valves/moog_g772_10.toml", include_str!("../../catalogue/valves/moog_g772_10.toml")),
    ("valves/moog_g772_19.toml", include_str!("../../catalogue/valves/moog_g772_19.toml")),
    ("valves/moog_g772_38.toml", include_str!("../../catalogue/valves/moog_g772_38.toml")),
    ("valves/moog_g773_38.toml", include_str!("../../catalogue/valves/moog_g773_38.toml")),
    ("valves/moog_g773_57.toml", include_str!("../../catalogue/valves/moog_g773_57.toml")),
];

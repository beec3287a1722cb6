//! Changes of a controller, in the order in which they are given on the command line.

use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};
use phea_workbench::engineering::shaping::{Change, RequestedChange};

/// Requested changes, in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes(pub(crate) Vec<RequestedChange>);

fn described(change: Change) -> (&'static str, &'static str) {
    match change {
        Change::Add => (
            "ELEMENT",
            "Add an element at the end: '{ kind = \"lead\", zero_frequency = 5, pole_frequency = 50 }'",
        ),
        Change::Remove => ("N", "Remove element N, counted from 1"),
        Change::Replace => ("N=ELEMENT", "Put another element in place of element N"),
        Change::Enable => ("N", "Let element N act"),
        Change::Disable => ("N", "Keep element N without letting it act"),
        Change::Move => ("N=M", "Move element N to place M"),
        Change::Pass => (
            "[N=]KIND through POINT",
            "Solve an element so that the loop passes a point of the chart, and add it or put it in place of N: 'lead through -6 dB, -130 deg at 20 rad/s'",
        ),
    }
}

impl Args for Changes {
    fn augment_args(command: Command) -> Command {
        Change::ALL.into_iter().fold(command, |command, change| {
            let (value, help) = described(change);
            let option = Arg::new(change.option()).long(change.option()).value_name(value).help(help);
            command.arg(option.action(ArgAction::Append).allow_hyphen_values(true))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Changes::augment_args(command)
    }
}

impl FromArgMatches for Changes {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Changes, Error> {
        let mut found: Vec<(usize, RequestedChange)> = Vec::new();
        for change in Change::ALL {
            let places = matches.indices_of(change.option()).into_iter().flatten();
            let texts = matches.get_many::<String>(change.option()).into_iter().flatten();
            found.extend(
                places
                    .zip(texts)
                    .map(|(place, text)| (place, RequestedChange { change, text: text.clone() })),
            );
        }
        found.sort_by_key(|(place, _)| *place);
        Ok(Changes(found.into_iter().map(|(_, change)| change).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Changes::from_arg_matches(matches)?;
        Ok(())
    }
}

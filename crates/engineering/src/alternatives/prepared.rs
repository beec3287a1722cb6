//! The alternatives of a project as projects, ready to be judged: with their settings, with the
//! hose that `[sizing]` finds if the alternative requests one, and with the ranges that follow
//! their rig.

use super::by_other_means::OtherPart;
use super::error::{AlternativesError, NoHose, PrepareError};
use super::recentred::{self, MovedRange};
use crate::catalogue::{self, Catalogue, CatalogueKind};
use crate::line_choice::{LoopInQuestion, with_chosen_lines};
use crate::parts::PartsCounted;
use crate::project::{
    self, AS_DECLARED, Alternative, Component, DeclaredLine, Loaded, read_alternative, refused_alternative,
};
use crate::rig::{OutsideParameter, Rig, RigError, outside};
use crate::setup::Setup;
use crate::sizing::{Candidate, HoseName, Question, own_hoses, size, sizing_problem};
use crate::source::Source;

/// An alternative, ready to be judged.
#[derive(Clone, Debug)]
pub struct PreparedAlternative {
    /// Name of the alternative.
    pub name: String,
    /// The project with the settings of the alternative, and with the part that was found for it.
    pub loaded: Loaded,
    /// The rig of that project.
    pub rig: Result<Rig, RigError>,
    /// Reason why `[sizing]` finds no hose, if one is requested.
    pub no_hose: Option<NoHose>,
    /// Ranges of `[uncertainty]` that were moved.
    pub moved: Vec<MovedRange>,
}

impl PreparedAlternative {
    pub(super) fn new(name: &str, loaded: Loaded, no_hose: Option<NoHose>) -> PreparedAlternative {
        let rig = Setup::rig_of(&loaded.project);
        PreparedAlternative { name: name.to_string(), loaded, rig, no_hose, moved: vec![] }
    }

    /// The alternative with a model for each line without a stated one, by its own loop and
    /// lengths.
    fn with_lines(self, source: &dyn Source) -> PreparedAlternative {
        match with_chosen_lines(source, &self.loaded, LoopInQuestion::Designed) {
            Some(loaded) => PreparedAlternative { rig: Setup::rig_of(&loaded.project), loaded, ..self },
            None => self,
        }
    }

    /// Parameters of the rig outside their ranges in `[uncertainty]`; `None` if they are those of
    /// the project as declared, the first of all.
    pub fn outside(&self, all: &[PreparedAlternative]) -> Option<Vec<OutsideParameter>> {
        let of = |one: &PreparedAlternative| {
            let rig = one.rig.as_ref().ok()?;
            outside(&one.loaded.project, rig).map(|(_, parameters)| parameters)
        };
        of(self).filter(|own| all.first().and_then(of).as_ref() != Some(own))
    }

    /// The alternative with its ranges moved from those of the rig of another project.
    ///
    /// # Errors
    /// [`AlternativesError`] for a range that cannot be moved.
    pub(super) fn recentred(
        self,
        again: &ReadingAgain<'_>,
        base: &PreparedAlternative,
    ) -> Result<PreparedAlternative, AlternativesError> {
        let moved = recentred::moved(base, &self)
            .map_err(|reason| AlternativesError::Alternative { name: self.name.clone(), reason })?;
        let loaded = again.with(&self.loaded, &recentred::settings(&moved))?;
        Ok(PreparedAlternative { moved, ..PreparedAlternative::new(&self.name, loaded, self.no_hose) })
    }
}

/// Source and catalogue for reading a project again.
#[derive(Clone, Copy)]
pub(super) struct ReadingAgain<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) catalogues: &'a [String],
}

impl ReadingAgain<'_> {
    /// The project with further settings.
    pub(super) fn with(&self, loaded: &Loaded, further: &[String]) -> Result<Loaded, AlternativesError> {
        let settings = [loaded.all_settings().as_slice(), further].concat();
        project::read(self.source, &loaded.path, &settings, self.catalogues)
            .map_err(AlternativesError::Refused)
    }
}

/// The project as declared, and its alternatives in file order.
///
/// # Errors
/// [`AlternativesError::Refused`] for an alternative that is not a valid project, or whose gas is
/// shut off, [`AlternativesError::Alternative`] for one that cannot be sized or whose ranges cannot
/// be moved.
pub fn prepared(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
) -> Result<(Vec<PreparedAlternative>, PartsCounted), AlternativesError> {
    let catalogue = catalogue::load(source, catalogues).map_err(AlternativesError::Refused)?;
    let again = ReadingAgain { source, catalogues };
    let itself = PreparedAlternative::new(AS_DECLARED, loaded.clone(), None);
    let mut found = vec![];
    for (index, alternative) in loaded.project.alternatives.iter().enumerate() {
        let other =
            read_alternative(source, loaded, catalogues, index).map_err(AlternativesError::Refused)?;
        let mut one = sized(&again, alternative, (&itself, other), &catalogue)?;
        if let Err(RigError::Accumulator(empty)) = &one.rig {
            let refusal = refused_alternative(source, loaded, index, &empty.at());
            return Err(AlternativesError::Refused(refusal));
        }
        if alternative.recentre {
            one = one.recentred(&again, &itself)?;
        }
        found.push(one.with_lines(source));
    }
    found.insert(0, itself.with_lines(source));
    let counted = counted(&found)?;
    Ok((found, counted))
}

/// Attributes of parts that are counted in all alternatives.
///
/// # Errors
/// [`AlternativesError::Alternative`] for an alternative whose prices are in another currency than
/// those before it.
fn counted(all: &[PreparedAlternative]) -> Result<PartsCounted, AlternativesError> {
    let projects = |count: usize| all.iter().take(count).map(|one| &one.loaded.project);
    for (index, one) in all.iter().enumerate() {
        if let Err([first, other]) = PartsCounted::of(projects(index + 1)) {
            let reason = PrepareError::TwoCurrencies { first, other };
            return Err(AlternativesError::Alternative { name: one.name.clone(), reason });
        }
    }
    Ok(PartsCounted::of(projects(all.len())).unwrap_or_default())
}

/// The alternative with the hose that `[sizing]` finds, or with another part for its stiffness, if
/// requested.
fn sized(
    again: &ReadingAgain<'_>,
    alternative: &Alternative,
    (declared, other): (&PreparedAlternative, Loaded),
    catalogue: &Catalogue,
) -> Result<PreparedAlternative, AlternativesError> {
    let name = alternative.name.clone();
    let one = |loaded, no_hose| PreparedAlternative::new(&name, loaded, no_hose);
    if !alternative.size {
        return Ok(one(other, None));
    }
    let wrong = |reason: PrepareError| AlternativesError::Alternative { name: name.clone(), reason };
    let is_hose = |line: &DeclaredLine| matches!(line.component, Component::Hose { .. });
    let lines = other.project.actuator.as_ref().map(|actuator| [&actuator.line.a, &actuator.line.b]);
    let Some(lines) = lines.filter(|lines| lines.iter().all(|line| is_hose(line))) else {
        let actuators = declared.loaded.project.actuator.as_ref().zip(other.project.actuator.as_ref());
        let part = actuators.and_then(|(one, two)| Some((OtherPart::of(one, two)?, two)));
        let Some((part, actuator)) = part else {
            return Err(wrong(PrepareError::NoHoses));
        };
        let settings = part.settings(declared, actuator, catalogue).map_err(wrong)?;
        return Ok(one(again.with(&other, &settings)?, None));
    };
    let alike = lines[0] == lines[1];
    let named = lines[0].hose_name().map(str::to_string);
    let setup = Setup::new(&other.project).map_err(|error| wrong(error.into()))?;
    let problem = sizing_problem(&setup, catalogue).map_err(|error| wrong(error.into()))?;
    let sizing = size(&problem, Question::Both);
    // for unequal lines, the lengths of their own hoses
    let own = other.project.actuator.as_ref().filter(|_| !alike).and_then(own_hoses);
    let of_own = |candidate: &&Candidate| {
        let accepted = candidate.fits() && candidate.branch.model == sizing.model;
        accepted && own.as_ref().is_none_or(|own| candidate.option.name == *own)
    };
    let Some(best) = sizing.candidates.iter().find(of_own) else {
        return Ok(one(other, Some(NoHose::NoneAccepted)));
    };
    if best.length_m() == 0.0 {
        return Ok(one(other, Some(NoHose::NoneNeeded)));
    }
    let [length_a, length_b] = best.branch.lengths_m;
    let mut settings = match alike {
        true => vec![format!("line.length={length_a:e}")],
        false => vec![format!("line.a.length={length_a:e}"), format!("line.b.length={length_b:e}")],
    };
    let best_name = match &best.option.name {
        HoseName::Both(name) => name.as_deref(),
        HoseName::Each(_) => None,
    };
    let of_catalogue = best_name.filter(|name| alike && catalogue.find(CatalogueKind::Hose, name).is_some());
    if let Some(name) = of_catalogue {
        settings.insert(0, format!("line.hose=\"{name}\""));
    }
    let found = one(again.with(&other, &settings)?, None);
    let components = found.rig.as_ref().map(|rig| rig.actuator.components());
    let has = components.map(|components| [components.line_a, components.line_b]);
    let same = has.is_ok_and(|lines| lines == best.option.lines(best.branch.lengths_m));
    if !same && (!alike || named.is_none() || named.as_deref() != best_name) {
        return Err(wrong(PrepareError::OwnHose));
    }
    Ok(found)
}

//! The exploration of a box: edges, faces, growth, witnesses.

use std::collections::BTreeSet;

use super::cell::{BoxEdges, walks};
use super::growth::grow;
use super::plants::{BoxLine, PlantPosition, Plants, Stop};
use super::region::{Corner, Region};
use super::witness::{Outside, outside, probes, take_in};

/// Known image of a box.
pub(super) struct Exploration {
    witnesses: Vec<usize>,
    edges: Option<BoxEdges>,
    /// Lines to witnesses away from the edges, for a template without area.
    branches: Vec<BoxLine>,
    walks: Vec<Vec<usize>>,
    region: Option<Region>,
    /// The witness farthest outside the region, if any.
    pub(super) outside: Option<Outside>,
}

impl Exploration {
    /// An exploration with only witnesses.
    pub(super) fn new(witnesses: Vec<usize>) -> Exploration {
        Exploration { witnesses, edges: None, branches: vec![], walks: vec![], region: None, outside: None }
    }

    /// Polygons with corners no farther apart than the tolerance: pieces of the region, or lines
    /// traversed in both directions if the template has no area.
    pub(super) fn outlines(&self, plants: &Plants) -> Vec<Vec<Corner>> {
        match &self.region {
            Some(region) if region.has_area() => {
                region.pieces().iter().map(|piece| divided(plants, piece)).collect()
            }
            _ => self.lines(plants),
        }
    }

    fn lines(&self, plants: &Plants) -> Vec<Vec<Corner>> {
        let mut lines = vec![];
        for line in self.edges.iter().flat_map(BoxEdges::iter).chain(&self.branches) {
            for part in plants.unbroken(&line.plants) {
                let corner = |&plant: &usize| Corner { place: plants.place(plant), plant: Some(plant) };
                let there = part.iter().map(corner);
                let back = part.iter().rev().skip(1).take(part.len().saturating_sub(2)).map(corner);
                let length: f64 = part.windows(2).map(|pair| plants.apart(pair[0], pair[1])).sum();
                if length > LENGTH_MINIMUM {
                    lines.push(there.chain(back).collect());
                }
            }
        }
        lines
    }
}

/// Rounds of growth for a family with a gap that does not close.
const ROUNDS_BESIDE_A_GAP: usize = 1;

/// Shortest line, in tolerances, that is not a rounding error.
const LENGTH_MINIMUM: f64 = 1e-9;

/// Explores until nothing moves and all witnesses are inside, or until plants or rounds are used
/// up; the results until then are retained.
pub(super) fn explore(plants: &mut Plants, found: &mut Exploration) -> Result<(), Stop> {
    let dimension = plants.family.coordinates().len();
    if dimension == 0 {
        return Ok(());
    }
    found.edges = Some(BoxEdges::new(plants, dimension)?);
    let faces: Vec<_> = found.edges.iter().flat_map(BoxEdges::faces).collect();
    let mut outcome = Ok(());
    for face in faces {
        outcome = walks(plants, face, &mut found.walks);
        if outcome.is_err() {
            break;
        }
    }
    let mut region = empty_region(plants);
    let closed: Vec<_> = found.walks.iter().filter_map(|walk| plants.closed_walk(walk)).collect();
    region.fill(&closed);
    let has_area = region.has_area();
    let region = found.region.insert(region);
    outcome?;
    for fractions in probes(dimension, plants.options.probes) {
        let probe = plants.at(fractions)?;
        if plants.is_finite(probe) {
            found.witnesses.push(probe);
        }
    }
    if has_area {
        refine(plants, region, &found.witnesses, &mut found.outside)
    } else {
        branch(plants, found)
    }
}

/// Joins witnesses to a template without area, which is a line, by lines of the box.
fn branch(plants: &mut Plants, found: &mut Exploration) -> Result<(), Stop> {
    for _ in 0..plants.options.rounds_maximum {
        let Some(beyond) = outside(plants, &found.lines(plants), &found.witnesses).into_iter().next() else {
            return Ok(());
        };
        let Some(start) = beyond.beside.map(|[start, _]| start) else { break };
        found.branches.push(plants.line(start, beyond.plant, 1)?);
    }
    found.outside = outside(plants, &found.lines(plants), &found.witnesses).into_iter().next();
    Err(Stop::Exhausted)
}

/// Performs rounds of growth; once nothing moves any more, adds the witnesses outside.
fn refine(
    plants: &mut Plants,
    region: &mut Region,
    witnesses: &[usize],
    farthest: &mut Option<Outside>,
) -> Result<(), Stop> {
    let mut tried = BTreeSet::new();
    // towards a pole of the family, growth would never end
    let rounds = match plants.gap {
        Some(_) => plants.options.rounds_maximum.min(ROUNDS_BESIDE_A_GAP),
        None => plants.options.rounds_maximum,
    };
    for _ in 0..rounds {
        if grow(plants, region, &mut tried)? {
            continue;
        }
        let beyond = outside(plants, &region.contours(), witnesses);
        if beyond.is_empty() {
            return Ok(());
        }
        take_in(plants, region, &beyond)?;
    }
    *farthest = outside(plants, &region.contours(), witnesses).into_iter().next();
    Err(Stop::Exhausted)
}

/// A region large enough for the places found.
fn empty_region(plants: &Plants) -> Region {
    let places = || plants.list.iter().map(|plant| plant.place).filter(|place| place.is_finite());
    let corner = |start: f64, choose: fn(f64, f64) -> f64| PlantPosition {
        phase_deg: places().map(|place| place.phase_deg).fold(start, choose),
        magnitude_db: places().map(|place| place.magnitude_db).fold(start, choose),
    };
    let tolerance = [plants.options.phase_deg, plants.options.magnitude_db];
    Region::new(corner(f64::INFINITY, f64::min), corner(f64::NEG_INFINITY, f64::max), tolerance)
}

/// Polygon with places added between corners farther apart than the tolerance: seams along which a
/// piece was cut.
fn divided(plants: &Plants, piece: &[Corner]) -> Vec<Corner> {
    let mut corners = vec![];
    for (from, to) in piece.iter().zip(piece.iter().cycle().skip(1)) {
        corners.push(*from);
        let [phase, magnitude] = plants.steps(from.place, to.place);
        let parts = phase.abs().max(magnitude.abs()).ceil();
        let mut part = 1.0;
        while part < parts {
            let between = |from: f64, to: f64| from + part / parts * (to - from);
            let place = PlantPosition {
                phase_deg: between(from.place.phase_deg, to.place.phase_deg),
                magnitude_db: between(from.place.magnitude_db, to.place.magnitude_db),
            };
            corners.push(Corner { place, plant: None });
            part += 1.0;
        }
    }
    corners
}

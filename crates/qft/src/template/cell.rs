//! Two-dimensional faces of the box: the region that their edges enclose is filled.
//!
//! A closed curve in the box can be contracted to a point within the box, so that every response
//! that its image winds around is the image of a plant. The image of a face without folds is the
//! interior of the image of its four edges; a face that folds, or contains a resonance, is divided.

use super::plants::{BoxLine, Plants, Stop};

/// A part of a face: its sides, each beginning where the previous one ends.
pub(super) struct FaceCell {
    pub(super) sides: [BoxLine; 4],
    depth: usize,
}

/// Number of times a face is divided, by the dimension of the box: if it folds, and if a loop does
/// not close.
fn depth_maximum(dimension: usize) -> (usize, usize) {
    match dimension {
        2 => (4, 6),
        3 => (2, 3),
        _ => (1, 1),
    }
}

/// Initial divisions of an edge of the box: a narrower excursion may be missed.
const PARTS: usize = 4;

/// The edges of the box: line `axis` from each corner with that coordinate at 0.
pub(super) struct BoxEdges {
    lines: Vec<Vec<Option<BoxLine>>>,
}

impl BoxEdges {
    /// Lines along all edges of the box; corners are reached along edges, so that their phases
    /// belong together.
    pub(super) fn new(plants: &mut Plants, dimension: usize) -> Result<BoxEdges, Stop> {
        let mut corners = vec![plants.at(vec![0.0; dimension])?];
        let mut lines: Vec<Vec<Option<BoxLine>>> = vec![vec![None; dimension]];
        for corner in 1..1_usize << dimension {
            let fractions = (0..dimension).map(|axis| (corner >> axis & 1) as f64).collect();
            corners.push(plants.at(fractions)?);
            lines.push(vec![None; dimension]);
            for axis in (0..dimension).filter(|axis| corner >> axis & 1 == 1) {
                let from = corner ^ (1 << axis);
                let line = plants.line(corners[from], corners[corner], PARTS)?;
                lines[from][axis] = Some(line);
            }
        }
        Ok(BoxEdges { lines })
    }

    /// All lines.
    pub(super) fn iter(&self) -> impl Iterator<Item = &BoxLine> {
        self.lines.iter().flatten().flatten()
    }

    /// All two-dimensional faces.
    pub(super) fn faces(&self) -> impl Iterator<Item = FaceCell> {
        let dimension = self.lines.first().map_or(0, Vec::len);
        let pairs =
            (0..dimension).flat_map(move |first| (first + 1..dimension).map(move |second| (first, second)));
        pairs.flat_map(move |(first, second)| {
            (0..self.lines.len()).filter_map(move |corner| {
                let side = |corner: usize, axis: usize| self.lines.get(corner)?.get(axis)?.as_ref();
                if corner >> first & 1 == 1 || corner >> second & 1 == 1 {
                    return None;
                }
                let sides = [
                    side(corner, first)?.clone(),
                    side(corner | 1 << first, second)?.clone(),
                    side(corner | 1 << second, first)?.reversed(),
                    side(corner, second)?.reversed(),
                ];
                Some(FaceCell { sides, depth: 0 })
            })
        })
    }
}

impl FaceCell {
    /// Closed walk around the cell.
    fn walk(&self) -> Vec<usize> {
        let start = self.sides[0].plants.first().copied();
        let sides = self.sides.iter().flat_map(|side| side.plants.iter().skip(1).copied());
        start.into_iter().chain(sides).collect()
    }

    fn corner(&self, side: usize) -> usize {
        self.sides[side % 4].plants[0]
    }
}

/// Closed walks whose images enclose the region covered by the face.
pub(super) fn walks(plants: &mut Plants, face: FaceCell, found: &mut Vec<Vec<usize>>) -> Result<(), Stop> {
    let (folded_maximum, open_maximum) = depth_maximum(plants.family.coordinates().len());
    let mut pending = vec![face];
    while let Some(cell) = pending.pop() {
        let walk = cell.walk();
        let closed = plants.closed_walk(&walk).is_some();
        let depth_maximum = if closed { folded_maximum } else { open_maximum };
        let mut centre = None;
        if cell.depth < depth_maximum {
            let middle = plants.between(cell.corner(0), cell.corner(2), 0.5)?;
            if !closed || is_folded(plants, &cell, middle) {
                centre = Some(middle);
            }
        }
        match centre {
            Some(centre) => pending.extend(divided(plants, &cell, centre)?),
            None if closed => found.push(walk),
            None => remember_open(plants, &walk),
        }
    }
    Ok(())
}

/// Records a walk without a gap that does not close: it encircles a pole or a zero, to which its
/// most extreme plant is close.
fn remember_open(plants: &mut Plants, walk: &[usize]) {
    if plants.unbroken(walk).len() > 1 {
        return;
    }
    let magnitude = |plant: usize| plants.place(plant).magnitude_db;
    let mean = walk.iter().map(|&plant| magnitude(plant)).sum::<f64>() / walk.len() as f64;
    let distance = |plant: usize| (magnitude(plant) - mean).abs();
    let farthest = walk.iter().copied().max_by(|&one, &other| distance(one).total_cmp(&distance(other)));
    if let Some(farthest) = farthest {
        plants.remember_pole(farthest);
    }
}

/// True if the quarters of a cell have different orientations, according to their corners.
fn is_folded(plants: &Plants, cell: &FaceCell, centre: usize) -> bool {
    let middles: Vec<usize> = cell
        .sides
        .iter()
        .map(|side| {
            let at = side.positions.partition_point(|&position| position < 0.5);
            side.plants[at.min(side.plants.len() - 1)]
        })
        .collect();
    let (mut left, mut right) = (false, false);
    for quarter in 0..4 {
        let ring = [cell.corner(quarter), middles[quarter], centre, middles[(quarter + 3) % 4]];
        for corner in 0..4 {
            let ahead = plants.step(ring[corner], ring[(corner + 1) % 4]);
            let behind = plants.step(ring[corner], ring[(corner + 3) % 4]);
            let area = ahead[0] * behind[1] - ahead[1] * behind[0];
            let size = (ahead[0].abs() + ahead[1].abs()) * (behind[0].abs() + behind[1].abs());
            left |= area > 1e-6 * size;
            right |= area < -1e-6 * size;
        }
    }
    left && right
}

/// The four quarters of a cell.
fn divided(plants: &mut Plants, cell: &FaceCell, centre: usize) -> Result<Vec<FaceCell>, Stop> {
    let mut halves = vec![];
    let mut spokes = vec![];
    for side in &cell.sides {
        let [first, second] = plants.halves(side)?;
        spokes.push(plants.line(second.plants[0], centre, 2)?);
        halves.push([first, second]);
    }
    let quarters = (0..4).map(|quarter| {
        let before = (quarter + 3) % 4;
        FaceCell {
            sides: [
                halves[quarter][0].clone(),
                spokes[quarter].clone(),
                spokes[before].reversed(),
                halves[before][1].clone(),
            ],
            depth: cell.depth + 1,
        }
    });
    Ok(quarters.collect())
}

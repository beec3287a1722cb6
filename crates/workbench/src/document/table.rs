//! A table of typed cells, with or without groups of rows.

use super::Cell;

/// A table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    /// The heading of the groups; without one, the rows form no groups.
    pub(super) grouped_by: Option<String>,
    pub(super) headings: Vec<String>,
    pub(super) groups: Vec<RowGroup>,
    /// Number of columns, in addition to the first, in each part of the table on a page; `None` if
    /// it is not divided.
    pub(super) columns_of_part: Option<usize>,
}

/// Rows that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RowGroup {
    pub(super) name: Cell,
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// An empty table with these headings.
    pub(crate) fn new<Heading: Into<String>>(headings: impl IntoIterator<Item = Heading>) -> Table {
        Table { headings: headings.into_iter().map(Into::into).collect(), ..Table::default() }
    }

    /// An empty table with groups, whose names also have a heading: a terminal shows it, and the
    /// name next to the first row.
    pub(crate) fn grouped_by<Heading: Into<String>>(
        groups: &str,
        headings: impl IntoIterator<Item = Heading>,
    ) -> Table {
        Table { grouped_by: Some(groups.to_string()), ..Table::new(headings) }
    }

    /// Begins a group with the rows that follow.
    pub(crate) fn group(&mut self, name: impl Into<Cell>) {
        self.groups.push(RowGroup { name: name.into(), rows: vec![] });
    }

    /// A row.
    pub(crate) fn row<Item: Into<Cell>>(&mut self, cells: impl IntoIterator<Item = Item>) {
        let row = cells.into_iter().map(Into::into).collect();
        match self.groups.last_mut() {
            Some(group) => group.rows.push(row),
            None => self.groups.push(RowGroup { rows: vec![row], ..RowGroup::default() }),
        }
    }

    /// The table with these rows.
    pub(crate) fn with<Item: Into<Cell>, Row: IntoIterator<Item = Item>>(
        mut self,
        rows: impl IntoIterator<Item = Row>,
    ) -> Table {
        for row in rows {
            self.row(row);
        }
        self
    }

    /// The table divided on a page into parts of at most this number of columns, in addition to the
    /// first, which each part repeats.
    pub(crate) fn in_parts_of(self, columns: usize) -> Table {
        Table { columns_of_part: Some(columns), ..self }
    }

    /// The indices of the columns of each part: all columns if the table is not divided.
    pub(super) fn parts(&self) -> Vec<Vec<usize>> {
        let columns: Vec<usize> = (1..self.headings.len()).collect();
        let most = self.columns_of_part.filter(|most| *most < columns.len());
        let Some(most) = most else { return vec![(0..self.headings.len()).collect()] };
        let even = columns.len().div_ceil(columns.len().div_ceil(most));
        columns.chunks(even).map(|part| std::iter::once(0).chain(part.iter().copied()).collect()).collect()
    }

    /// True if the table has no row.
    pub(crate) fn is_empty(&self) -> bool {
        self.groups.iter().all(|group| group.rows.is_empty())
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &Vec<Cell>> {
        self.groups.iter().flat_map(|group| &group.rows)
    }

    /// True if most cells of a column are numbers.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        let cells = self.rows().filter_map(|row| row.get(column));
        let filled = cells.filter(|cell| **cell != Cell::Missing && **cell != Cell::empty());
        let [numbers, words] = filled.fold([0, 0], |[numbers, words], cell| match cell.is_numeric() {
            true => [numbers + 1, words],
            false => [numbers, words + 1],
        });
        numbers > words
    }
}

//! A table of typed cells, in groups of rows where it has such.

use super::Cell;

/// A table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    /// The heading of the groups; without one, the rows form no groups.
    pub(super) grouped_by: Option<String>,
    pub(super) headings: Vec<String>,
    pub(super) groups: Vec<RowGroup>,
    /// Columns besides the first that one part of it has on a page; `None`: it is whole.
    pub(super) columns_of_part: Option<usize>,
}

/// Rows that belong together.
#[derive(Clone, Debug, Default)]
pub(super) struct RowGroup {
    pub(super) name: String,
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// An empty table with these headings.
    pub(crate) fn new<Heading: Into<String>>(headings: impl IntoIterator<Item = Heading>) -> Table {
        Table { headings: headings.into_iter().map(Into::into).collect(), ..Table::default() }
    }

    /// The same in groups, whose names also have a heading: a terminal shows it, and the name next
    /// to the first row.
    pub(crate) fn grouped_by<Heading: Into<String>>(
        groups: &str,
        headings: impl IntoIterator<Item = Heading>,
    ) -> Table {
        Table { grouped_by: Some(groups.to_string()), ..Table::new(headings) }
    }

    /// The rows that follow belong together.
    pub(crate) fn group(&mut self, name: impl Into<String>) {
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

    /// With these rows.
    pub(crate) fn with<Item: Into<Cell>, Row: IntoIterator<Item = Item>>(
        mut self,
        rows: impl IntoIterator<Item = Row>,
    ) -> Table {
        for row in rows {
            self.row(row);
        }
        self
    }

    /// On a page in parts of at most this number of columns besides the first, which each part
    /// repeats.
    pub(crate) fn in_parts_of(self, columns: usize) -> Table {
        Table { columns_of_part: Some(columns), ..self }
    }

    /// The places of the columns of each part: all of them where it is whole.
    pub(super) fn parts(&self) -> Vec<Vec<usize>> {
        let columns: Vec<usize> = (1..self.headings.len()).collect();
        let most = self.columns_of_part.filter(|most| *most < columns.len());
        let Some(most) = most else { return vec![(0..self.headings.len()).collect()] };
        let even = columns.len().div_ceil(columns.len().div_ceil(most));
        columns.chunks(even).map(|part| std::iter::once(0).chain(part.iter().copied()).collect()).collect()
    }

    /// Whether it has no row.
    pub(crate) fn is_empty(&self) -> bool {
        self.groups.iter().all(|group| group.rows.is_empty())
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &Vec<Cell>> {
        self.groups.iter().flat_map(|group| &group.rows)
    }

    /// Whether most of what a column holds is numbers.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        let cells = self.rows().filter_map(|row| row.get(column));
        let told = cells.filter(|cell| **cell != Cell::Missing && **cell != Cell::empty());
        let [numbers, words] = told.fold([0, 0], |[numbers, words], cell| match cell.is_numeric() {
            true => [numbers + 1, words],
            false => [numbers, words + 1],
        });
        numbers > words
    }
}

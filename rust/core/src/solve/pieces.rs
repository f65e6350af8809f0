//! The connected pieces of an operator: problems of their own, each with its own end.

use crate::block_rows::{BlockRows, BLOCK};
use crate::error::SolveError;
use crate::linear::Columns;
use crate::memory;
use crate::mesh::partition::Partition;

/// The rows of `u` and the blocks of the operator that belong together, piece by piece in the order of their
/// first rows. Where no block has an entry but 0 there is no piece.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pieces {
    rows: Grouped,
    blocks: Grouped,
    /// The place of each row and each block within its piece.
    place_of_row: Vec<u32>,
    place_of_block: Vec<u32>,
}

/// Elements, group by group.
#[derive(Debug, Clone, PartialEq)]
struct Grouped {
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Pieces {
    /// The pieces of `operator`, where the three `corners` of a block belong to it as well, whether it sees
    /// them or not; nothing if there is but one.
    ///
    /// # Errors
    /// [`SolveError::Memory`], here and below.
    pub(crate) fn of(operator: &BlockRows, corners: Option<&[[u32; 3]]>) -> Result<Option<Self>, SolveError> {
        let n = operator.n_columns;
        let mut sets = Partition::new(n)?;
        let mut is_seen = memory::repeated(false, n)?;
        let rows_of = |b: usize| {
            let corners = corners.map_or(&[][..], |corners| &corners[b]);
            corners.iter().chain(operator.block(b).0)
        };
        for b in 0..operator.n_blocks() {
            rows_of(b).zip(rows_of(b).skip(1)).for_each(|(&row, &next)| sets.unite(row, next));
            let (rows, values) = operator.block(b);
            let seen = rows.iter().zip(values).filter(|(_, value)| **value != [0.0; BLOCK]);
            seen.for_each(|(&row, _)| is_seen[row as usize] = true);
        }
        // A set has the number of its piece at its root as soon as a row of it is seen.
        let mut numbers = memory::repeated(u32::MAX, n)?;
        let mut count = 0;
        for row in (0..n as u32).filter(|&row| is_seen[row as usize]) {
            let number = &mut numbers[sets.root(row) as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
        }
        if count < 2 {
            return Ok(None);
        }
        let of_rows = memory::gathered((0..n as u32).map(|row| numbers[sets.root(row) as usize]))?;
        let of_block = |b| rows_of(b).next().map_or(u32::MAX, |&row| of_rows[row as usize]);
        let of_blocks = memory::gathered((0..operator.n_blocks()).map(of_block))?;
        let (rows, place_of_row) = Grouped::new(&of_rows, count as usize)?;
        let (blocks, place_of_block) = Grouped::new(&of_blocks, count as usize)?;
        Ok(Some(Self { rows, blocks, place_of_row, place_of_block }))
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.rows.starts.len() - 1
    }

    /// The rows of piece `p`, in their order.
    pub(crate) fn rows(&self, p: usize) -> &[u32] {
        self.rows.group(p)
    }

    /// The blocks of piece `p`, in their order.
    pub(crate) fn blocks(&self, p: usize) -> &[u32] {
        self.blocks.group(p)
    }

    /// The place of each block within its piece.
    pub(crate) fn places_of_blocks(&self) -> &[u32] {
        &self.place_of_block
    }

    /// Rows in pieces.
    pub(crate) fn n_rows(&self) -> usize {
        self.rows.members.len()
    }

    /// The part of `operator` that is piece `p`.
    pub(crate) fn operator(&self, operator: &BlockRows, p: usize) -> Result<BlockRows, SolveError> {
        let blocks = || self.blocks(p).iter().map(|&b| operator.block(b as usize));
        let n_entries = blocks().map(|(columns, _)| columns.len()).sum();
        let mut starts = memory::room(self.blocks(p).len() + 1)?;
        let (mut columns, mut values) = (memory::room(n_entries)?, memory::room(n_entries)?);
        starts.push(0);
        for (of_block, entries) in blocks() {
            columns.extend(of_block.iter().map(|&row| self.place_of_row[row as usize]));
            values.extend_from_slice(entries);
            starts.push(columns.len());
        }
        Ok(BlockRows { n_columns: self.rows(p).len(), starts, columns, values })
    }

    /// The rows of piece `p` of several columns.
    pub(crate) fn columns(&self, columns: &Columns, p: usize) -> Result<Columns, SolveError> {
        let rows = self.rows(p);
        let mut data = memory::room(rows.len() * columns.n_columns)?;
        for c in 0..columns.n_columns {
            let column = columns.column(c);
            data.extend(rows.iter().map(|&row| column[row as usize]));
        }
        Ok(Columns { n_rows: rows.len(), n_columns: columns.n_columns, data })
    }

    /// Puts the rows of piece `p` where they belong.
    pub(crate) fn put(&self, of_piece: &Columns, p: usize, whole: &mut Columns) {
        for c in 0..whole.n_columns {
            let column = whole.column_mut(c);
            for (&row, x) in self.rows(p).iter().zip(of_piece.column(c)) {
                column[row as usize] = *x;
            }
        }
    }
}

impl Grouped {
    /// The elements of groups `0..count`, by the group of each, and the place of each in its group.
    fn new(group_of: &[u32], count: usize) -> Result<(Self, Vec<u32>), SolveError> {
        let mut sizes = memory::repeated(0, count)?;
        let mut places = memory::repeated(0, group_of.len())?;
        let is_in_any = |group: u32| (group as usize) < count;
        for (place, &group) in places.iter_mut().zip(group_of).filter(|(_, &group)| is_in_any(group)) {
            let size: &mut u32 = &mut sizes[group as usize];
            *place = *size;
            *size += 1;
        }
        let mut starts = memory::room(count + 1)?;
        starts.push(0);
        for (g, &size) in sizes.iter().enumerate() {
            starts.push(starts[g] + size as usize);
        }
        let mut members = memory::repeated(0, starts[count])?;
        for (element, (&group, &place)) in (0..).zip(group_of.iter().zip(&places)) {
            if is_in_any(group) {
                members[starts[group as usize] + place as usize] = element;
            }
        }
        Ok((Self { starts, members }, places))
    }

    fn group(&self, g: usize) -> &[u32] {
        &self.members[self.starts[g]..self.starts[g + 1]]
    }
}

/// The entries of `values` at `places`.
pub(crate) fn at<T: Copy>(values: &[T], places: &[u32]) -> Result<Vec<T>, SolveError> {
    memory::gathered(places.iter().map(|&i| values[i as usize]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn operator() -> BlockRows {
        // Rows 0, 2, 4 and 1, 5 belong together, 3 is seen by none; the third block sees nothing.
        let mut rows = BlockRows::empty(6);
        let entry = |row: u32| (row, [1.0 + f64::from(row); 3]);
        rows.push_block([entry(2), entry(0)]);
        rows.push_block([entry(1), entry(5)]);
        rows.push_block([]);
        rows.push_block([entry(4), entry(2)]);
        rows
    }

    #[test]
    fn rows_and_blocks_come_together_and_go_back() {
        let operator = operator();
        let pieces = Pieces::of(&operator, None).unwrap().unwrap();
        assert_eq!((pieces.count(), pieces.n_rows()), (2, 5));
        assert_eq!((pieces.rows(0), pieces.blocks(0)), (&[0, 2, 4][..], &[0, 3][..]));
        assert_eq!((pieces.rows(1), pieces.blocks(1)), (&[1, 5][..], &[1][..]));
        assert_eq!(pieces.places_of_blocks(), [0, 0, 0, 1]);
        let first = pieces.operator(&operator, 0).unwrap();
        assert_eq!((first.block(0).0, first.block(1).0), (&[0, 1][..], &[1, 2][..]));
        assert_eq!(first.block(1).1, operator.block(3).1);
        let values = Columns { n_rows: 6, n_columns: 2, data: (0..12).map(f64::from).collect() };
        let mut back = Columns::zeros(6, 2);
        for p in 0..2 {
            pieces.put(&pieces.columns(&values, p).unwrap(), p, &mut back);
        }
        assert_eq!(back.data, [0.0, 1.0, 2.0, 0.0, 4.0, 5.0, 6.0, 7.0, 8.0, 0.0, 10.0, 11.0]);
    }

    #[test]
    fn a_block_that_sees_nothing_is_with_its_corners() {
        let corners = |third| [[0, 2, 4], [1, 5, 1], third, [2, 4, 2]];
        let pieces = Pieces::of(&operator(), Some(&corners([1, 3, 3]))).unwrap().unwrap();
        assert_eq!((pieces.rows(1), pieces.blocks(1)), (&[1, 3, 5][..], &[1, 2][..]));
        let pieces = Pieces::of(&operator(), Some(&corners([3, 3, 3]))).unwrap().unwrap();
        assert_eq!((pieces.rows(1), pieces.blocks(1)), (&[1, 5][..], &[1][..]));
    }

    #[test]
    fn one_piece_is_nothing_to_divide() {
        let corners = [[0, 1, 2]; 4];
        assert!(Pieces::of(&operator(), Some(&corners)).unwrap().is_none());
        assert!(Pieces::of(&BlockRows::empty(3), None).unwrap().is_none());
    }
}

//! The rows of the operator that no fixed value stands for.

use std::borrow::Cow;

use crate::block_rows::BlockRows;
use crate::error::SolveError;
use crate::memory;

/// The free rows of the operator, shared by all columns of a problem, and the blocks that see one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeOperator<'o> {
    /// `H` on the free rows of `u`, without blocks that see fixed rows only.
    pub operator: Cow<'o, BlockRows>,
    /// Which blocks are left; `None` where all are.
    pub(super) blocks: Option<Vec<u32>>,
    /// Per row of the whole `u`, its place among the free ones.
    pub place: Vec<Option<u32>>,
    /// The free rows.
    pub free: Vec<u32>,
}

impl<'o> FreeOperator<'o> {
    /// Drops the columns of `operator` whose rows of `u` are fixed, and the blocks that have no other.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give what it takes.
    pub fn new(operator: &'o BlockRows, fixed: &[bool]) -> Result<Self, SolveError> {
        let mut free: Vec<u32> = memory::room(fixed.iter().filter(|&&fixed| !fixed).count())?;
        free.extend((0..operator.n_columns as u32).filter(|&i| !fixed[i as usize]));
        let mut place = memory::repeated(None, operator.n_columns)?;
        for (k, &i) in free.iter().enumerate() {
            place[i as usize] = Some(k as u32);
        }
        if free.len() == operator.n_columns {
            return Ok(Self { operator: Cow::Borrowed(operator), blocks: None, place, free });
        }
        let mut kept = BlockRows::empty(free.len());
        let n_entries = operator.columns.iter().filter(|&&column| place[column as usize].is_some()).count();
        (kept.columns, kept.values) = (memory::room(n_entries)?, memory::room(n_entries)?);
        let mut blocks = memory::room(operator.n_blocks())?;
        kept.starts.try_reserve_exact(operator.n_blocks()).map_err(|_| SolveError::Memory {
            needed: size_of::<usize>() * operator.n_blocks(),
            limit: None,
        })?;
        for b in 0..operator.n_blocks() {
            let (columns, values) = operator.block(b);
            for (&column, value) in columns.iter().zip(values) {
                if let Some(k) = place[column as usize] {
                    kept.columns.push(k);
                    kept.values.push(*value);
                }
            }
            if kept.columns.len() > kept.starts[kept.n_blocks()] {
                kept.starts.push(kept.columns.len());
                blocks.push(b as u32);
            }
        }
        Ok(Self { operator: Cow::Owned(kept), blocks: Some(blocks), place, free })
    }

    /// What belongs to the blocks that are left, of something per block.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give what it takes.
    pub fn of_blocks<'v>(&self, values: &'v [f64]) -> Result<Cow<'v, [f64]>, SolveError> {
        Ok(match &self.blocks {
            None => Cow::Borrowed(values),
            Some(blocks) => Cow::Owned(memory::gathered(blocks.iter().map(|&b| values[b as usize]))?),
        })
    }
}

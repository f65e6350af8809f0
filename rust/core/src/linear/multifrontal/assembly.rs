//! Adding what is left of a child to the front of its parent (extend-add; Duff and Reid 1983).

use super::padded::{stride_of, Padded};
use crate::linear::real::Real;

/// Adds the columns that belong to the panel: `relative` are the places of the rows of `from` in the front,
/// whose first `n_columns` are the panel's.
pub(super) fn add_to_panel<R: Real>(relative: &[u32], from: &[R], n_columns: usize, panel: &mut Padded<R>) {
    let stride = stride_of(relative.len());
    let run = run(relative);
    for (j, &column) in relative.iter().enumerate() {
        let column = column as usize;
        if column >= n_columns {
            break;
        }
        let to = &mut panel.values[column * panel.stride..(column + 1) * panel.stride];
        add(&relative[j..], &from[j * stride + j..j * stride + relative.len()], run.saturating_sub(j), 0, to);
    }
}

/// Adds the other columns to what will be left of the parent.
pub(super) fn add_to_update<R: Real>(
    relative: &[u32],
    from: &[R],
    n_columns: usize,
    update: &mut [R],
    stride: usize,
) {
    let own = stride_of(relative.len());
    let run = run(relative);
    let first = relative.partition_point(|&row| (row as usize) < n_columns);
    for (j, &column) in relative.iter().enumerate().skip(first) {
        let column = column as usize - n_columns;
        let to = &mut update[column * stride..(column + 1) * stride];
        add(
            &relative[j..],
            &from[j * own + j..j * own + relative.len()],
            run.saturating_sub(j),
            n_columns,
            to,
        );
    }
}

/// From here on the rows follow each other in the parent, too.
fn run(relative: &[u32]) -> usize {
    relative.windows(2).rposition(|pair| pair[1] != pair[0] + 1).map_or(0, |i| i + 1)
}

/// Adds one column; its first `scattered` rows are spread in the parent.
#[inline(always)]
fn add<R: Real>(relative: &[u32], from: &[R], scattered: usize, shift: usize, to: &mut [R]) {
    for (&row, &x) in relative.iter().zip(&from[..scattered]) {
        to[row as usize - shift] += x;
    }
    if let Some(&row) = relative.get(scattered) {
        to[row as usize - shift..].iter_mut().zip(&from[scattered..]).for_each(|(to, &x)| *to += x);
    }
}

//! Nested dissection: an order of rows that leaves fewer entries in the factor of a large matrix than minimum
//! degree does.
//!
//! A small separator cuts the graph of the matrix in two, its rows come last, and each half is ordered in the
//! same way (George 1973), down to parts that minimum degree orders as well.

use super::graph::Graph;
use super::minimum_degree::minimum_degree;
use super::separator::{separator, SEPARATOR};
use crate::linear::pattern::LowerPattern;
use crate::random::Random;
use crate::{Progress, Result};

/// Parts of at most so many rows are left to minimum degree: with 200 one factor entry in twenty goes,
/// for twice the time.
const LEAF: usize = 1000;

/// Parts of at least so many rows are ordered by threads of their own.
const GRAIN: usize = 4096;

/// The rows of a symmetric matrix in the order of their elimination.
///
/// # Errors
/// [`crate::error::SolveError`] when the ordering of a part fails, [`crate::Error::Cancelled`].
pub fn nested_dissection(pattern: &LowerPattern, progress: &Progress) -> Result<Vec<u32>> {
    let mut order: Vec<u32> = (0..pattern.n as u32).collect();
    dissect(&Graph::new(pattern)?, &mut order, progress)?;
    Ok(order)
}

/// Puts `order`, the rows that the vertices of `graph` stand for, into the order of elimination.
fn dissect(graph: &Graph, order: &mut [u32], progress: &Progress) -> Result<()> {
    progress.check()?;
    let rows = order.to_vec();
    let place = |order: &mut [u32], members: &[u32]| {
        for (o, &v) in order.iter_mut().zip(members) {
            *o = rows[v as usize];
        }
    };
    if graph.n() <= LEAF {
        place(order, &minimum_degree(&pattern_of(graph))?);
        return Ok(());
    }
    let side = separator(graph, &mut Random::new(graph.n() as u64), progress)?;
    let parts = [graph.part(&side, 0), graph.part(&side, 1)];
    let between: Vec<u32> = (0..graph.n() as u32).filter(|&v| side[v as usize] == SEPARATOR).collect();
    if parts.iter().any(|(part, _)| part.n() == graph.n()) {
        // Nothing can be cut off, as in a graph where all are neighbors.
        place(order, &minimum_degree(&pattern_of(graph))?);
        return Ok(());
    }
    let [(first, first_members), (second, second_members)] = parts;
    let (head, tail) = order.split_at_mut(first.n());
    let (middle, tail) = tail.split_at_mut(second.n());
    place(head, &first_members);
    place(middle, &second_members);
    place(tail, &between);
    if graph.n() < GRAIN {
        dissect(&first, head, progress)?;
        return dissect(&second, middle, progress);
    }
    let (one, other) = rayon::join(|| dissect(&first, head, progress), || dissect(&second, middle, progress));
    one.and(other)
}

fn pattern_of(graph: &Graph) -> LowerPattern {
    let mut pattern = LowerPattern { n: graph.n(), starts: vec![0], rows: Vec::new() };
    for v in 0..graph.n() {
        let first = pattern.rows.len();
        pattern.rows.push(v);
        pattern.rows.extend(graph.around(v).iter().map(|&u| u as usize).filter(|&u| u > v));
        pattern.rows[first..].sort_unstable();
        pattern.starts.push(pattern.rows.len());
    }
    pattern
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// The matrix of a grid of `side × side` points with eight neighbors each, and a lone point.
    fn grid(side: usize) -> LowerPattern {
        let mut pattern = LowerPattern { n: side * side + 1, starts: vec![0], rows: Vec::new() };
        for v in 0..side * side {
            let (x, y) = (v % side, v / side);
            pattern.rows.push(v);
            for (dx, dy) in [(1, 0), (-1, 1), (0, 1), (1, 1)] {
                let (x, y) = (x as isize + dx, y + dy);
                if (0..side as isize).contains(&x) && y < side {
                    pattern.rows.push(y * side + x as usize);
                }
            }
            pattern.starts.push(pattern.rows.len());
        }
        pattern.rows.push(side * side);
        pattern.starts.push(pattern.rows.len());
        pattern
    }

    /// Entries of the factor in this order, by elimination of sets.
    fn fill(pattern: &LowerPattern, place: &[usize]) -> usize {
        let mut columns: Vec<Vec<usize>> = vec![Vec::new(); pattern.n];
        for j in 0..pattern.n {
            for &i in &pattern.rows[pattern.starts[j]..pattern.starts[j + 1]] {
                columns[place[i].min(place[j])].push(place[i].max(place[j]));
            }
        }
        let mut entries = 0;
        for k in 0..pattern.n {
            columns[k].sort_unstable();
            columns[k].dedup();
            entries += columns[k].len();
            let below: Vec<usize> = columns[k].iter().copied().filter(|&i| i > k).collect();
            if let Some(&next) = below.first() {
                columns[next].extend(below);
            }
        }
        entries
    }

    #[test]
    fn orders_every_row_once_and_the_same_way_each_time() {
        let pattern = grid(70);
        let order = nested_dissection(&pattern, &Progress::new()).unwrap();
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..pattern.n as u32));
        assert_eq!(nested_dissection(&pattern, &Progress::new()).unwrap(), order);
    }

    #[test]
    fn leaves_a_fraction_of_the_entries_that_the_given_order_leaves() {
        let pattern = grid(70);
        let given: Vec<usize> = (0..pattern.n).collect();
        let mut place = vec![0; pattern.n];
        for (k, &i) in nested_dissection(&pattern, &Progress::new()).unwrap().iter().enumerate() {
            place[i as usize] = k;
        }
        let (natural, dissected) = (fill(&pattern, &given), fill(&pattern, &place));
        assert!(2 * dissected < natural, "{dissected} of {natural}");
    }

    #[test]
    fn separators_separate() {
        let graph = Graph::new(&grid(60)).unwrap();
        let side = separator(&graph, &mut Random::new(1), &Progress::new()).unwrap();
        let count = |s: u8| side.iter().filter(|&&x| x == s).count();
        assert!(count(0) > graph.n() / 4 && count(1) > graph.n() / 4, "{} and {}", count(0), count(1));
        assert!(count(SEPARATOR) <= 100, "{}", count(SEPARATOR));
        for v in 0..graph.n() {
            assert!(
                graph.around(v).iter().all(|&u| side[v] + side[u as usize] != 1),
                "an edge joins the sides"
            );
        }
    }

    #[test]
    fn a_graph_without_separators_is_left_to_minimum_degree() {
        let n = 1200;
        let mut pattern = LowerPattern { n, starts: vec![0], rows: Vec::new() };
        for j in 0..n {
            pattern.rows.extend(j..n);
            pattern.starts.push(pattern.rows.len());
        }
        assert_eq!(nested_dissection(&pattern, &Progress::new()).unwrap().len(), n);
    }
}

//! How many parts there are.

use super::constants::PLAY;

/// The number of parts at a limit: of all divisions, by ascending costs, that cost less, but not between two
/// that cost about the same.
pub(super) fn count(costs: &[f64], limit: f64) -> usize {
    let [least, most] = [limit / PLAY, limit * PLAY];
    let first = costs.partition_point(|cost| *cost <= least);
    let last = costs.partition_point(|cost| *cost <= most);
    // The rise after taking `taken` divisions, within the play.
    let rise = |taken: usize| {
        let before = if taken > first { costs[taken - 1] } else { least };
        let after = costs.get(taken).map_or(most, |cost| cost.min(most));
        after / before
    };
    let best = (first..=last).max_by(|&a, &b| rise(a).total_cmp(&rise(b)).then(b.cmp(&a)));
    1 + best.unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(costs: &[f64]) -> usize {
        count(costs, 1.0)
    }

    #[test]
    fn counts_the_cuts_below_the_limit() {
        assert_eq!(counted(&[]), 1);
        assert_eq!(counted(&[0.1, 0.2, 0.5]), 4);
        assert_eq!(counted(&[0.1, 0.2, 1.5, 2.0]), 3);
    }

    #[test]
    fn never_parts_what_costs_about_the_same() {
        assert_eq!(counted(&[0.1, 0.97, 0.99, 1.01, 1.02, 3.0]), 6);
        assert_eq!(counted(&[0.1, 0.6, 1.05, 1.06]), 3);
    }
}

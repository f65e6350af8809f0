//! How many parts there are: as many as leave the fewest pairs of points on the wrong side, as expected.
//!
//! A merge joins as many pairs as the product of both areas. The cheaper the cut that goes, the likelier
//! people see two parts, and all these pairs are wrong: with the odds of limit over price, squared. Merge
//! after merge the expected number of wrong pairs falls and rises again, and where it is least is the count.
//! So a few cuts that divide much decide, not the many that divide little.

use super::constants::{PLAY, PLAY_STEPS, UNSEEN_BORDER, UNSEEN_COST, WHOLE_POWER};
use super::merging::Merge;

/// The number of parts, given all `merges` from the finest parts on, and what a cut of the whole shape may
/// cost: of all limits within the play the count that most of them give, the fewest parts where counts tie.
pub(super) fn count(merges: &[Merge], limit: f64) -> usize {
    let mut counts: Vec<usize> = (0..=2 * PLAY_STEPS)
        .map(|step| limit * PLAY.powf(step as f64 / PLAY_STEPS as f64 - 1.0))
        .map(|limit| count_at(merges, limit))
        .collect();
    counts.sort_unstable();
    let runs = counts.chunk_by(|a, b| a == b).map(|run| (run.len(), run[0]));
    runs.rev().max_by_key(|(length, _)| *length).map_or(1, |(_, count)| count)
}

fn count_at(merges: &[Merge], limit: f64) -> usize {
    let (mut wrong, mut least, mut taken) = (0.0, 0.0, 0);
    for (done, merge) in (1..).zip(merges) {
        wrong += merge.areas[0] * merge.areas[1] * belief(merge, limit);
        if wrong < least {
            (least, taken) = (wrong, done);
        }
    }
    merges.len() + 1 - taken
}

/// How much likelier people see two parts than one, from −1 to 1. A part of a small part needs a better
/// reason, and so does a border that follows nothing.
fn belief(merge: &Merge, limit: f64) -> f64 {
    let unseen = merge.price > UNSEEN_BORDER * merge.plain_price;
    let price = if unseen { UNSEEN_COST * merge.price } else { merge.price };
    let whole = merge.areas[0] + merge.areas[1];
    let odds = (limit * whole.powf(WHOLE_POWER) / price.max(f64::MIN_POSITIVE)).powi(2);
    1.0 - 2.0 / (1.0 + odds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merge(areas: [f64; 2], price: f64) -> Merge {
        Merge { pair: [0, 1], price, plain_price: 10.0 * price, areas }
    }

    #[test]
    fn counts_the_cuts_that_are_cheap() {
        assert_eq!(count(&[], 1.0), 1);
        assert_eq!(count(&[merge([0.1, 0.2], 3.0), merge([0.7, 0.3], 0.2)], 1.0), 2);
        assert_eq!(count(&[merge([0.1, 0.2], 0.1), merge([0.7, 0.3], 0.2)], 1.0), 3);
        assert_eq!(count(&[merge([0.7, 0.3], 4.0)], 1.0), 1);
    }

    #[test]
    fn much_that_is_parted_outweighs_a_little_that_is_not() {
        // The halves are two for people; what lies between them and the finest parts is not.
        let merges = [merge([0.02, 0.01], 0.1), merge([0.25, 0.25], 5.0), merge([0.5, 0.5], 0.1)];
        assert_eq!(count(&merges, 1.0), 2);
    }

    #[test]
    fn a_part_of_a_small_part_needs_a_better_reason() {
        assert_eq!(count(&[merge([0.5, 0.5], 0.8)], 1.0), 2);
        assert_eq!(count(&[merge([0.005, 0.005], 0.8), merge([0.99, 0.01], 0.1)], 1.0), 2);
    }

    #[test]
    fn a_border_through_no_hollow_needs_a_better_reason() {
        let plain = [Merge { plain_price: 0.5, ..merge([0.5, 0.5], 0.5) }];
        assert_eq!([count(&plain, 1.0), count(&plain, 2.0)], [1, 2]);
    }

    #[test]
    fn cuts_of_about_the_same_cost_are_made_all_or_none() {
        let alike = |price: f64| [merge([0.1, 0.9], 1.02 * price), merge([0.1, 0.8], 0.98 * price)];
        assert_eq!(count(&alike(1.0), 1.0), 1);
        assert_eq!(count(&alike(0.95), 1.0), 3);
    }
}

//! Which of many points lie near another: a k-d tree [Bentley 1975].

use crate::mesh::vector::Point;

/// Points with a number each, so ordered that every range is divided in its middle, by coordinates in turn.
pub(super) struct Places(Vec<(Point, usize)>);

impl Places {
    /// A tree of these.
    pub(super) fn new(mut points: Vec<(Point, usize)>) -> Self {
        let mut ranges = vec![(0, points.len(), 0)];
        while let Some((begin, end, axis)) = ranges.pop() {
            if end - begin < 2 {
                continue;
            }
            let middle = (begin + end) / 2;
            points[begin..end].select_nth_unstable_by(middle - begin, |a, b| a.0[axis].total_cmp(&b.0[axis]));
            ranges.extend([(begin, middle, (axis + 1) % 3), (middle + 1, end, (axis + 1) % 3)]);
        }
        Self(points)
    }

    /// The numbers of those in the cube of half side `radius` around `center`, ascending.
    pub(super) fn within(&self, center: Point, radius: f64) -> Vec<usize> {
        let mut found = Vec::new();
        let mut ranges = vec![(0, self.0.len(), 0)];
        while let Some((begin, end, axis)) = ranges.pop() {
            if begin == end {
                continue;
            }
            let middle = (begin + end) / 2;
            let (point, number) = self.0[middle];
            if (0..3).all(|k| (point[k] - center[k]).abs() <= radius) {
                found.push(number);
            }
            if point[axis] >= center[axis] - radius {
                ranges.push((begin, middle, (axis + 1) % 3));
            }
            if point[axis] <= center[axis] + radius {
                ranges.push((middle + 1, end, (axis + 1) % 3));
            }
        }
        found.sort_unstable();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn all_points_in_a_cube_are_found_and_no_others() {
        let mut random = Random::new(1);
        for n in [0, 1, 2, 3, 50, 300] {
            // Many in the same place, and many with the same coordinate.
            let mut coordinate = || (random.uniform() * 6.0).floor();
            let points: Vec<(Point, usize)> =
                (0..n).map(|i| ([coordinate(), coordinate(), coordinate()], i)).collect();
            let tree = Places::new(points.clone());
            for radius in [0.0, 1.0, 2.5, 100.0] {
                for center in [[0.0; 3], [3.0, 2.0, 4.0], [-2.0, 3.5, 3.0]] {
                    let is_in = |p: Point| (0..3).all(|k| (p[k] - center[k]).abs() <= radius);
                    let expected: Vec<usize> =
                        points.iter().filter(|(p, _)| is_in(*p)).map(|&(_, i)| i).collect();
                    assert_eq!(tree.within(center, radius), expected);
                }
            }
        }
    }
}

//! A power of two as the unit of very large and very small numbers, so that their products are numbers too.
//!
//! The operators multiply up to eight lengths, and a fourth power of 1e80 is past the largest `f64`. Every
//! tool measures its mesh and its values in a unit that makes the largest of them about 1, and hands back
//! what it found in the unit that they came in. Powers of two only change exponents: nothing is rounded.
//! Sizes that are sane as they are keep the unit 1, and their bits.

use std::borrow::Cow;

use crate::error::{Error, SolveError};
use crate::Result;

/// Sizes from 2^-64 to 2^64 (5e-20 to 2e19) stay as they are:
/// their eighth powers are far from the ends of `f64`, 2^±1022.
const SANE: i32 = 64;

/// A unit, a power of two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Unit {
    exponent: i32,
}

impl Unit {
    /// The unit for numbers up to this `size`.
    #[must_use]
    pub fn of_size(size: f64) -> Self {
        let exponent = exponent(size);
        Self { exponent: if exponent.abs() > SANE { exponent } else { 0 } }
    }

    /// The unit for finite `numbers`.
    #[must_use]
    pub fn of(numbers: impl IntoIterator<Item = f64>) -> Self {
        Self::of_size(numbers.into_iter().fold(0.0, |size, x| size.max(x.abs())))
    }

    /// Whether it is 1.
    #[must_use]
    pub fn is_one(self) -> bool {
        self.exponent == 0
    }

    /// The unit of areas where this is that of lengths, and so on.
    #[must_use]
    pub fn power(self, power: i32) -> Self {
        Self { exponent: power * self.exponent }
    }

    /// The unit of products with what has the unit `other`.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self { exponent: self.exponent + other.exponent }
    }

    /// `x` measured in this unit.
    #[must_use]
    pub fn measure(self, x: f64) -> f64 {
        times_power_of_two(x, -self.exponent)
    }

    /// What measures `x` in this unit.
    #[must_use]
    pub fn restore(self, x: f64) -> f64 {
        times_power_of_two(x, self.exponent)
    }

    /// `numbers` measured in this unit.
    #[must_use]
    pub fn measure_all<'x>(self, numbers: &'x [f64]) -> Cow<'x, [f64]> {
        if self.is_one() {
            return Cow::Borrowed(numbers);
        }
        numbers.iter().map(|&x| self.measure(x)).collect()
    }

    /// [`Unit::restore`] for all of `numbers`.
    pub fn restore_all<'x>(self, numbers: impl IntoIterator<Item = &'x mut f64>) {
        if !self.is_one() {
            numbers.into_iter().for_each(|x| *x = self.restore(*x));
        }
    }

    /// [`Unit::restore`] for an answer that has to be a number.
    ///
    /// # Errors
    /// [`SolveError::NoNumber`] where it is none, or too large for one; `what` says what it is.
    pub fn restore_finite(self, what: &'static str, x: f64) -> Result<f64> {
        let restored = self.restore(x);
        if restored.is_finite() {
            Ok(restored)
        } else {
            Err(Error::Solve(SolveError::NoNumber { what }))
        }
    }

    /// Takes points measured in this unit back to that of the `original` points; those that are where they
    /// were, in `measured`, keep every bit.
    pub fn restore_points(self, points: &mut [[f64; 3]], measured: &[[f64; 3]], original: &[[f64; 3]]) {
        if self.is_one() {
            return;
        }
        let mut before = measured.iter().zip(original);
        for point in points {
            *point = match before.next() {
                Some((measured, original)) if measured == point => *original,
                _ => point.map(|x| self.restore(x)),
            };
        }
    }
}

/// `e` such that `2^e ≤ |x| < 2^(e + 1)`, 0 for zero.
fn exponent(x: f64) -> i32 {
    let biased = |x: f64| (x.to_bits() >> 52 & 0x7ff) as i32;
    match biased(x) {
        0 if x == 0.0 => 0,
        // Below the normal numbers.
        0 => biased(times_power_of_two(x, 64)) - 1023 - 64,
        b => b - 1023,
    }
}

/// `x · 2^exponent`, rounded only below the normal numbers and infinite only above the largest.
fn times_power_of_two(x: f64, exponent: i32) -> f64 {
    const STEP: i32 = 1000;
    let (mut x, mut left) = (x, exponent);
    while left != 0 && x != 0.0 && x.is_finite() {
        let step = left.clamp(-STEP, STEP);
        x *= f64::from_bits(((1023 + step) as u64) << 52);
        left -= step;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_those_of_the_largest_power_below() {
        for (x, e) in [
            (1.0, 0),
            (1.99, 0),
            (2.0, 1),
            (0.75, -1),
            (-8.0, 3),
            (5e-324, -1074),
            (f64::MAX, 1023),
            (0.0, 0),
        ] {
            assert_eq!(exponent(x), e, "{x}");
        }
    }

    #[test]
    fn sane_sizes_are_left_alone_and_others_come_to_about_one() {
        for size in [0.0, 1e-19, 1.0, -1e19] {
            assert!(Unit::of_size(size).is_one());
        }
        for size in [5e-324, 1e-300, 1e-20, 1e20, 1e300, f64::MAX] {
            let unit = Unit::of_size(size);
            let measured = unit.measure(size);
            assert!((1.0..2.0).contains(&measured), "{size} is {measured}");
            assert_eq!(unit.restore(measured), size);
        }
    }
}

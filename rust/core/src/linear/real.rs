//! The numbers that a factor is made of, and the vector instructions for them.

use faer::traits::RealField;
use pulp::Simd;

/// Double or single precision. Half as many digits are half the memory, which is what a triangular solve of a
/// large factor takes its time for, and twice as many numbers in a vector register.
pub(crate) trait Real: RealField + Copy + Default + Send + Sync + PartialOrd + 'static {
    /// A vector register.
    type Lanes<S: Simd>: Copy;

    /// Zero.
    const ZERO: Self;

    /// One.
    const ONE: Self;

    /// The nearest number.
    fn of(x: f64) -> Self;

    /// In double precision.
    fn double(self) -> f64;

    /// Whether it is a number, and not too large for one.
    fn is_number(self) -> bool;

    /// The square root.
    fn root(self) -> Self;

    /// Numbers in a register.
    fn lanes<S: Simd>() -> usize;

    /// As whole registers; what is left over is dropped.
    fn registers<S: Simd>(values: &[Self]) -> &[Self::Lanes<S>];

    /// As whole registers, to be written.
    fn registers_mut<S: Simd>(values: &mut [Self]) -> &mut [Self::Lanes<S>];

    /// A register full of one number.
    fn splat<S: Simd>(simd: S, x: Self) -> Self::Lanes<S>;

    /// `-a`.
    fn negated<S: Simd>(simd: S, a: Self::Lanes<S>) -> Self::Lanes<S>;

    /// `a - b`.
    fn minus<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>) -> Self::Lanes<S>;

    /// `a b`.
    fn times<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>) -> Self::Lanes<S>;

    /// `a b + c`, rounded once where the machine can.
    fn times_plus<S: Simd>(
        simd: S,
        a: Self::Lanes<S>,
        b: Self::Lanes<S>,
        c: Self::Lanes<S>,
    ) -> Self::Lanes<S>;

    /// `c - a b`, likewise.
    fn minus_times<S: Simd>(
        simd: S,
        a: Self::Lanes<S>,
        b: Self::Lanes<S>,
        c: Self::Lanes<S>,
    ) -> Self::Lanes<S>;

    /// The sum of a register.
    fn sum<S: Simd>(simd: S, a: Self::Lanes<S>) -> Self;
}

/// [`Real`] for a type, with what `pulp` calls its register and its operations.
macro_rules! real {
    ($type:ty, $lanes:ident, $n:ident, $read:ident, $write:ident, $splat:ident, $neg:ident, $sub:ident,
     $mul:ident, $mul_add:ident, $negate_mul_add:ident, $sum:ident) => {
        impl Real for $type {
            type Lanes<S: Simd> = S::$lanes;

            const ZERO: Self = 0.0;

            const ONE: Self = 1.0;

            #[inline(always)]
            fn of(x: f64) -> Self {
                x as Self
            }

            #[inline(always)]
            fn double(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn is_number(self) -> bool {
                self.is_finite()
            }

            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn lanes<S: Simd>() -> usize {
                S::$n
            }

            #[inline(always)]
            fn registers<S: Simd>(values: &[Self]) -> &[Self::Lanes<S>] {
                S::$read(values).0
            }

            #[inline(always)]
            fn registers_mut<S: Simd>(values: &mut [Self]) -> &mut [Self::Lanes<S>] {
                S::$write(values).0
            }

            #[inline(always)]
            fn splat<S: Simd>(simd: S, x: Self) -> Self::Lanes<S> {
                simd.$splat(x)
            }

            #[inline(always)]
            fn negated<S: Simd>(simd: S, a: Self::Lanes<S>) -> Self::Lanes<S> {
                simd.$neg(a)
            }

            #[inline(always)]
            fn minus<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>) -> Self::Lanes<S> {
                simd.$sub(a, b)
            }

            #[inline(always)]
            fn times<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>) -> Self::Lanes<S> {
                simd.$mul(a, b)
            }

            #[inline(always)]
            fn times_plus<S: Simd>(
                simd: S,
                a: Self::Lanes<S>,
                b: Self::Lanes<S>,
                c: Self::Lanes<S>,
            ) -> Self::Lanes<S> {
                simd.$mul_add(a, b, c)
            }

            #[inline(always)]
            fn minus_times<S: Simd>(
                simd: S,
                a: Self::Lanes<S>,
                b: Self::Lanes<S>,
                c: Self::Lanes<S>,
            ) -> Self::Lanes<S> {
                simd.$negate_mul_add(a, b, c)
            }

            #[inline(always)]
            fn sum<S: Simd>(simd: S, a: Self::Lanes<S>) -> Self {
                simd.$sum(a)
            }
        }
    };
}

real!(
    f64,
    f64s,
    F64_LANES,
    as_simd_f64s,
    as_mut_simd_f64s,
    splat_f64s,
    neg_f64s,
    sub_f64s,
    mul_f64s,
    mul_add_e_f64s,
    negate_mul_add_e_f64s,
    reduce_sum_f64s
);
real!(
    f32,
    f32s,
    F32_LANES,
    as_simd_f32s,
    as_mut_simd_f32s,
    splat_f32s,
    neg_f32s,
    sub_f32s,
    mul_f32s,
    mul_add_e_f32s,
    negate_mul_add_e_f32s,
    reduce_sum_f32s
);

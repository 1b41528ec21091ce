//! Run-time choice of instructions for hot loops.
//!
//! Ranking a child is one population count, which baseline x86-64 lacks. A loop that ranks children is
//! compiled twice, and the better copy is chosen when the loop is entered. Results never depend on the
//! choice.

/// A loop that is worth compiling twice. `run` must be marked `#[inline(always)]`, and so must the functions
/// that it calls, if they are to be compiled twice as well. (This is a type and not a closure, because the
/// compiler may leave a closure out of line, and then nothing is gained.)
pub trait Hot {
    /// The loop's result.
    type Output;

    /// Runs the loop.
    fn run(self) -> Self::Output;
}

/// Runs `hot` compiled with POPCNT and BMI2 if the processor has them. Costs one cached feature test.
#[inline(always)]
pub fn with_popcount<H: Hot>(hot: H) -> H::Output {
    #[cfg(all(target_arch = "x86_64", feature = "std", not(target_feature = "popcnt")))]
    {
        #[target_feature(enable = "popcnt,bmi2")]
        fn with_bits<H: Hot>(hot: H) -> H::Output {
            hot.run()
        }
        if std::is_x86_feature_detected!("popcnt") && std::is_x86_feature_detected!("bmi2") {
            // SAFETY: the features that the function enables were just detected.
            #[allow(unsafe_code)]
            return unsafe { with_bits(hot) };
        }
    }
    hot.run()
}

/// Runs `hot` as [`with_popcount`] does, with AVX2 as well if the processor has it. Meant for loops over the
/// coordinates of a point.
#[inline(always)]
pub fn with_vectors<H: Hot>(hot: H) -> H::Output {
    #[cfg(all(target_arch = "x86_64", feature = "std", not(target_feature = "avx2")))]
    {
        #[target_feature(enable = "popcnt,bmi2,avx2")]
        fn with_avx2<H: Hot>(hot: H) -> H::Output {
            hot.run()
        }
        if std::is_x86_feature_detected!("avx2")
            && std::is_x86_feature_detected!("popcnt")
            && std::is_x86_feature_detected!("bmi2")
        {
            // SAFETY: the features that the function enables were just detected.
            #[allow(unsafe_code)]
            return unsafe { with_avx2(hot) };
        }
    }
    with_popcount(hot)
}

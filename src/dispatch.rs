//! Run-time choice of instructions for hot loops.
//!
//! Ranking a child is one population count, which baseline x86-64 lacks. A loop that ranks is compiled
//! twice and the better copy is chosen when it is entered; results never depend on the choice.

/// A loop worth compiling twice. `run` must be marked `#[inline(always)]`, and so must what it calls to take
/// part. (A type instead of a closure, because a closure may be left out of line, and then nothing is
/// gained.)
pub trait Hot {
    /// What the loop returns.
    type Output;

    /// The loop.
    fn run(self) -> Self::Output;
}

/// Runs `hot` compiled with POPCNT and BMI2 where the processor has them. Pays for one cached feature test.
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

/// As [`with_popcount`], with AVX2 besides where the processor has it: for loops over the coordinates of a
/// point.
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

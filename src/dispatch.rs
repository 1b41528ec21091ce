//! Run-time choice of instructions for hot loops.
//!
//! Ranking a child is one population count, which baseline x86-64 lacks. A loop that ranks is compiled
//! twice and the better copy is chosen when it is entered; results never depend on the choice.

/// Runs `work` compiled with POPCNT and BMI where the processor has them. Pays for one cached feature test,
/// so it belongs around loops. What `work` calls takes part as far as it is inlined.
#[inline(always)]
pub fn with_popcount<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(all(target_arch = "x86_64", feature = "std", not(target_feature = "popcnt")))]
    {
        #[target_feature(enable = "popcnt,bmi1,bmi2,lzcnt")]
        fn with_bits<R>(work: impl FnOnce() -> R) -> R {
            work()
        }
        let found = std::is_x86_feature_detected!("popcnt")
            && std::is_x86_feature_detected!("bmi1")
            && std::is_x86_feature_detected!("bmi2")
            && std::is_x86_feature_detected!("lzcnt");
        if found {
            // SAFETY: the features that the function enables were just detected.
            #[allow(unsafe_code)]
            return unsafe { with_bits(work) };
        }
    }
    work()
}

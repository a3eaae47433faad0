//! What may be switched off, to see what it is worth: `make ablate`.
//!
//! In a build with the feature `ablate`, and in no other, the environment's `DEPTHPLANES_OFF` names one of [`SWITCHES`].

/// Everything that may be switched off.
#[cfg(feature = "ablate")]
const SWITCHES: [&str; 18] = [
    "refine",
    "bowed-merge",
    "shown",
    "wide",
    "redundant",
    "edge-on",
    "bow",
    "joint",
    "surroundings",
    "turns",
    "folds",
    "excess",
    "line",
    "rejected",
    "flood",
    "touching",
    "gaps",
    "rounding",
];

/// Whether a part of the method is switched on.
#[inline(always)]
pub(crate) fn is_on(part: &str) -> bool {
    #[cfg(feature = "ablate")]
    {
        static OFF: std::sync::LazyLock<String> =
            std::sync::LazyLock::new(|| std::env::var("DEPTHPLANES_OFF").unwrap_or_default());
        assert!(OFF.is_empty() || SWITCHES.contains(&OFF.as_str()), "DEPTHPLANES_OFF is one of {SWITCHES:?}");
        assert!(SWITCHES.contains(&part), "{part} is not listed in SWITCHES");
        *OFF != part
    }
    #[cfg(not(feature = "ablate"))]
    {
        let _ = part;
        true
    }
}

//! How long a detection took: what the caller measured and the record states.

/// How long detection took, in milliseconds, over several runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Of the whole method.
    pub total: Spread,
    /// Of each stage, by name, in the method's order.
    pub stages: Vec<(&'static str, Spread)>,
}

/// The middle and the best of several measurements, milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Half of the runs took less.
    pub median: f64,
    /// No run took less.
    pub min: f64,
}

//! How planes are looked for: a method with its parameters and what is wanted beside planes.

use crate::error::{Error, Result};
use depthplanes::methods::{self, MethodInfo};
use depthplanes::{Coplanar, Detector};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether this process is the copy of another one.
static IS_FORKED: AtomicBool = AtomicBool::new(false);

/// Notes that this process was forked. The threads that the library had started are not in it, and would be waited for.
#[pyfunction]
pub(crate) fn forked() {
    IS_FORKED.store(true, Ordering::Relaxed);
}

/// A method with a value for each of its parameters, all checked.
pub(crate) struct Recipe {
    pub(crate) method: &'static MethodInfo,
    pub(crate) values: Vec<f64>,
    threads: usize,
    curved: bool,
    pub(crate) coplanar: Option<Coplanar>,
}

impl Recipe {
    /// Parameters are named as in the method's table, with `_` for `-`.
    ///
    /// # Errors
    /// An unknown method or parameter, a value that is not accepted.
    pub(crate) fn new(
        method: &str,
        given: &BTreeMap<String, f64>,
        threads: usize,
        curved: bool,
        merge_coplanar: Option<(f64, f64)>,
    ) -> Result<Self> {
        let method = methods::find(method)?;
        let names: Vec<(String, f64)> = given.iter().map(|(name, &value)| (name.replace('_', "-"), value)).collect();
        let named: Vec<(&str, f64)> = names.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        drop(method.with(&named)?); // they are checked
        let mut values = method.defaults();
        for (name, value) in named {
            values[method.position(name).expect("it was accepted")] = value;
        }
        let coplanar =
            merge_coplanar.map(|(angle_deg, distance_m)| Coplanar::new(angle_deg, distance_m)).transpose()?;
        if curved && !method.tells_curved {
            let others = methods::METHODS.iter().filter(|method| method.tells_curved).map(|method| method.name);
            let accepted = others.collect::<Vec<_>>().join(", ");
            return Err(depthplanes::Error::NoCurved { method: method.name, accepted }.into());
        }
        if threads == 0 {
            return Err(Error::Input("parameter `threads` is 0; accepted: a whole number from 1".into()));
        }
        Ok(Recipe { method, values, threads, curved, coplanar })
    }

    /// The threads for a map: those that were asked for, but one in a process that was forked. The answer is the same.
    pub(crate) fn threads(&self) -> usize {
        if IS_FORKED.load(Ordering::Relaxed) { 1 } else { self.threads }
    }

    /// A detector of it.
    pub(crate) fn detector(&self) -> Detector {
        const CHECKED: &str = "the parameters were checked";
        let method = self.method.of_values(&self.values).expect(CHECKED);
        let detector = Detector::new(method).expect(CHECKED).threads(self.threads()).curved(self.curved);
        match self.coplanar {
            Some(within) => detector.merge_coplanar(within).expect(CHECKED),
            None => detector,
        }
    }
}

//! How planes are looked for, and what is stated of the maps: a method with its parameters, and settings by name.
//!
//! Names are those of the program's flags; parameters, their defaults and ranges are those of the method's table.

use crate::error::Result;
use depthplanes::methods::{self, MethodInfo};
use depthplanes::{Coplanar, Detector};
use depthplanes_io::ReadOptions;

/// Everything that is stated of a detector.
pub(crate) struct Settings {
    pub(crate) method: &'static MethodInfo,
    pub(crate) values: Vec<f64>,
    pub(crate) reading: ReadOptions,
    pub(crate) coplanar: Option<Coplanar>,
    /// Focal length and difference of the principal points in pixels, baseline in metres.
    focal_px: Option<f64>,
    baseline_m: Option<f64>,
    doffs_px: Option<f64>,
    threads: usize,
    curved: bool,
}

/// A number that is stated by name and is no parameter of a method.
struct Setting {
    name: &'static str,
    accepted: &'static str,
    accepts: fn(f64) -> bool,
    set: fn(&mut Settings, f64),
}

const fn number(name: &'static str, set: fn(&mut Settings, f64)) -> Setting {
    Setting { name, accepted: "a finite number", accepts: f64::is_finite, set }
}

const fn switch(name: &'static str, set: fn(&mut Settings, f64)) -> Setting {
    Setting { name, accepted: "0 for no or 1 for yes", accepts: |given| given == 0.0 || given == 1.0, set }
}

/// All of them.
static SETTINGS: [Setting; 10] = [
    number("scale", |settings, given| settings.reading.scale = Some(given)),
    number("depth-scale", |settings, given| settings.reading.depth_scale = Some(given)),
    number("missing", |settings, given| settings.reading.missing = Some(given)),
    number("focal", |settings, given| settings.focal_px = Some(given)),
    number("baseline", |settings, given| settings.baseline_m = Some(given)),
    number("doffs", |settings, given| settings.doffs_px = Some(given)),
    switch("disparity", |settings, given| settings.reading.disparity = given == 1.0),
    switch("ray-distance", |settings, given| settings.reading.ray_distance = given == 1.0),
    switch("curved", |settings, given| settings.curved = given == 1.0),
    Setting {
        name: "threads",
        accepted: "a whole number from 1 to 1024",
        accepts: |given| (1.0..=1024.0).contains(&given) && given.fract() == 0.0,
        set: |settings, given| settings.threads = given as usize,
    },
];

impl Settings {
    /// A method with its defaults.
    pub(crate) fn new(method: &'static MethodInfo) -> Self {
        Settings {
            method,
            values: method.defaults(),
            reading: ReadOptions::default(),
            coplanar: None,
            focal_px: None,
            baseline_m: None,
            doffs_px: None,
            threads: 1,
            curved: false,
        }
    }

    /// States a parameter of the method, or a setting.
    ///
    /// # Errors
    /// An unknown name, a value that is not accepted, curved surfaces of a method that does not tell them.
    pub(crate) fn set(&mut self, name: &str, given: f64) -> Result<()> {
        if let Some(at) = self.method.position(name) {
            let mut values = self.values.clone();
            values[at] = given;
            drop(self.method.of_values(&values)?); // they are checked
            self.values = values;
            return Ok(());
        }
        let setting = self.setting(name)?;
        if !(setting.accepts)(given) {
            let accepted = setting.accepted.to_string();
            return Err(depthplanes::Error::Parameter { name: setting.name, given, accepted }.into());
        }
        (setting.set)(self, given);
        Ok(())
    }

    /// As [`Settings::set`], of a number that is written as text.
    ///
    /// # Errors
    /// As of [`Settings::set`], and for a text that is no number.
    pub(crate) fn set_text(&mut self, name: &str, text: &str) -> Result<()> {
        let Ok(given) = text.trim().parse() else {
            let param = self.method.position(name).map(|at| &self.method.params[at]);
            let (name, accepted) = match param {
                Some(param) => (param.name, param.accepted()),
                None => self.setting(name).map(|setting| (setting.name, setting.accepted.to_string()))?,
            };
            return Err(depthplanes::Error::Text { name, given: text.into(), accepted }.into());
        };
        self.set(name, given)
    }

    fn setting(&self, name: &str) -> Result<&'static Setting> {
        SETTINGS.iter().find(|setting| setting.name == name).ok_or_else(|| {
            let params = self.method.params.iter().map(|param| param.name);
            let names: Vec<&str> = params.chain(SETTINGS.iter().map(|setting| setting.name)).collect();
            depthplanes::Error::Unknown { what: "parameter", given: name.into(), accepted: names.join(", ") }.into()
        })
    }

    /// How maps are read.
    ///
    /// # Errors
    /// A stereo rig of which too little is stated.
    pub(crate) fn reading(&self) -> Result<ReadOptions> {
        Ok(self.reading.clone().rig(self.focal_px, self.baseline_m, self.doffs_px)?)
    }

    /// A detector of it.
    ///
    /// # Errors
    /// Parameters or limits out of range; they were checked.
    pub(crate) fn detector(&self) -> Result<Detector> {
        let detector = Detector::new(self.method.of_values(&self.values)?)?.threads(self.threads).curved(self.curved);
        Ok(match self.coplanar {
            Some(within) => detector.merge_coplanar(within)?,
            None => detector,
        })
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings::new(methods::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_setting_has_the_name_of_a_parameter() {
        for setting in &SETTINGS {
            assert!(methods::METHODS.iter().all(|method| method.position(setting.name).is_none()), "{}", setting.name);
        }
    }

    #[test]
    fn what_is_refused_changes_nothing() {
        let mut settings = Settings::default();
        settings.set("min-pixels", 300.0).unwrap();
        let refused: [(&str, f64); 4] = [("min-pixels", -1.0), ("threads", 0.5), ("curved", 2.0), ("focal", f64::NAN)];
        for (name, given) in refused {
            let error = settings.set(name, given).unwrap_err();
            assert!(error.text.contains(name) && error.text.contains("accepted"), "{}", error.text);
        }
        let at = settings.method.position("min-pixels").unwrap();
        assert_eq!((settings.values[at], settings.threads, settings.curved), (300.0, 1, false));
        assert_eq!(settings.focal_px, None);
    }
}

//! The library's tables for C: what there is, with the names that are accepted.

use crate::border::for_c;
use depthplanes::methods::{METHODS, MethodInfo, Param};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::presets::SENSOR_PRESETS;
use std::ffi::c_char;
use std::mem::MaybeUninit;
use std::sync::LazyLock;

/// A name that is accepted, and what it means.
#[repr(C)]
pub struct dp_name {
    /// The name.
    pub name: *const c_char,
    /// One line about it.
    pub about: *const c_char,
}

/// A parameter of a method.
#[repr(C)]
pub struct dp_parameter {
    /// The name.
    pub name: *const c_char,
    /// One sentence: what it does.
    pub about: *const c_char,
    /// Its unit; may be empty.
    pub unit: *const c_char,
    /// The values that are accepted, in words.
    pub accepted: *const c_char,
    /// Its value unless one is stated.
    pub default_value: f64,
}

/// A method.
#[repr(C)]
pub struct dp_method {
    /// The name.
    pub name: *const c_char,
    /// One sentence: what it finds, and whose it is.
    pub about: *const c_char,
    /// Its parameters, in the order of the table.
    pub parameters: *const dp_parameter,
    /// How many there are.
    pub parameter_count: usize,
}

/// The rows of a table.
struct Table<T>(Vec<T>);

// SAFETY: what the pointers of its rows lead to stays for good, and nobody writes to it.
unsafe impl<T> Send for Table<T> {}
// SAFETY: as above.
unsafe impl<T> Sync for Table<T> {}

/// A text that stays for good.
fn text(of: &str) -> *const c_char {
    for_c(of).into_raw()
}

fn name(name: &str, about: &str) -> dp_name {
    dp_name { name: text(name), about: text(about) }
}

fn parameter(param: &Param) -> dp_parameter {
    dp_parameter {
        name: text(param.name),
        about: text(param.meaning),
        unit: text(param.unit),
        accepted: text(&param.accepted()),
        default_value: param.default,
    }
}

fn method(method: &&MethodInfo) -> dp_method {
    let parameters: Vec<dp_parameter> = method.params.iter().map(parameter).collect();
    let parameters = parameters.leak();
    let (first, parameter_count) = (parameters.as_ptr(), parameters.len());
    dp_method { name: text(method.name), about: text(method.about), parameters: first, parameter_count }
}

static METHODS_OF_C: LazyLock<Table<dp_method>> = LazyLock::new(|| Table(METHODS.iter().map(method).collect()));
static SENSORS_OF_C: LazyLock<Table<dp_name>> =
    LazyLock::new(|| Table(SENSOR_PRESETS.iter().map(|preset| name(preset.name, preset.about)).collect()));
static UNITS_OF_C: LazyLock<Table<dp_name>> =
    LazyLock::new(|| Table(ENCODINGS.iter().map(|unit| name(unit.name, unit.about)).collect()));

impl<T> Table<T> {
    /// The first row; how many there are goes to `count`, if that is not null.
    fn rows(&self, count: Option<&mut MaybeUninit<usize>>) -> *const T {
        if let Some(count) = count {
            count.write(self.0.len());
        }
        self.0.as_ptr()
    }
}

/// All methods, the usual one first. Their number is written to `count`, unless that is null.
#[unsafe(no_mangle)]
pub extern "C" fn dp_methods(count: Option<&mut MaybeUninit<usize>>) -> *const dp_method {
    METHODS_OF_C.rows(count)
}

/// All sensors that `dp_detector_set_sensor` knows. Their number is written to `count`, unless that is null.
#[unsafe(no_mangle)]
pub extern "C" fn dp_sensors(count: Option<&mut MaybeUninit<usize>>) -> *const dp_name {
    SENSORS_OF_C.rows(count)
}

/// All units that `dp_detector_set_unit` knows. Their number is written to `count`, unless that is null.
#[unsafe(no_mangle)]
pub extern "C" fn dp_units(count: Option<&mut MaybeUninit<usize>>) -> *const dp_name {
    UNITS_OF_C.rows(count)
}

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn dp_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

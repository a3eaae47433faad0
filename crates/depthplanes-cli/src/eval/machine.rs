//! What was measured on, and when.

use std::time::SystemTime;

/// The processor and how many of it there are.
pub(super) fn name() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name));
    format!("{} x {cores}", model.unwrap_or(std::env::consts::ARCH))
}

/// The day, UTC: 2026-11-26.
pub(super) fn today() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10].to_string()
}

//! Metres per unit of maps, under the names that programs give to it.

/// What an object states: plain name, name as written, and the number, if it is one.
pub(super) type Entry<'a> = (String, &'a str, Option<f64>);

/// Names of units in a metre.
const PER_METRE: &[&str] = &["depthmapfactor", "depthfactor", "unitspermeter", "unitspermetre"];

/// Names that some programs use for metres per unit and others for units in a metre.
const EITHER: &[&str] = &[
    "depthscale",
    "pngdepthscale",
    "depthunits",
    "depthunit",
    "integerdepthscale",
    "depthunitscalefactor",
    "depthscalefactor",
    "depthscalingfactor",
    "scalingfactor",
];

/// Metres per unit as an object states it; a note where what is meant is not sure. BOP's scale makes millimetres.
pub(super) fn unit_m(object: &[Entry<'_>]) -> Option<Result<f64, String>> {
    let find = |name: &str| object.iter().find(|(plain, ..)| plain == name);
    let of = |names: &[&str]| names.iter().find_map(|name| find(name)?.2).filter(|&value| value > 0.0);
    if let Some(units) = of(PER_METRE) {
        return Some(Ok(units.recip()));
    }
    // BOP: beside `cam_K`, or in camera.json beside the camera. A thousandth there is metres, as RealSense has it.
    if let Some(scale) = of(&["depthscale"]) {
        let least = if find("camk").is_some() { 0.01 } else { 0.05 };
        let is_beside = ["camk", "cx"].iter().any(|name| find(name).is_some());
        if is_beside && (least..=1.5).contains(&scale) {
            return Some(Ok(0.001 * scale));
        }
    }
    if let Some((name, value)) = EITHER.iter().find_map(|name| Some((name, of(&[name])?))) {
        let key = find(name).map_or(*name, |(_, key, _)| key);
        return Some(match value {
            ..=0.05 => Ok(value),
            1.5.. => Ok(value.recip()),
            1.0 if *name == "depthunitscalefactor" => Ok(1.0),
            _ => Err(format!(
                "`{key}` of the camera file is {value}, which may be metres, millimetres or units in a metre, and is not used; \
                 --scale states metres per unit"
            )),
        });
    }
    // Replica and NICE-SLAM: 6553.5 units in a metre, beside the camera. Other scales are not of the map.
    let is_camera = find("fx").is_some();
    of(&["scale"]).filter(|&scale| is_camera && scale >= 100.0).map(|scale| Ok(scale.recip()))
}

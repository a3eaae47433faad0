//! The ground as JSON.

use depthplanes::ground::{ClassifiedPlane, Floor, Ground, Obstacle, Sector, Step, Up};
use serde_json::{Value, json};

/// The ground of one input as JSON, `depthplanes.floor/1`; `floor` is null where there is none. `source` is what the input is
/// called, `up` what was known of up.
pub fn ground_record(source: &str, ground: &Ground, up: Up) -> Value {
    json!({
        "schema": "depthplanes.floor/1",
        "source": source,
        "up": ground.up,
        "up_from": up.name(),
        "floor": ground.floor.as_ref().map(floor),
        "planes": ground.planes.iter().map(plane).collect::<Vec<_>>(),
        "obstacles": ground.obstacles.iter().map(obstacle).collect::<Vec<_>>(),
        "steps": ground.steps.iter().map(step).collect::<Vec<_>>(),
        "sectors": ground.sectors.iter().map(sector).collect::<Vec<_>>(),
    })
}

fn floor(floor: &Floor) -> Value {
    json!({
        "label": floor.label,
        "labels": floor.labels,
        "height_m": floor.height_m,
        "height_sd_m": floor.height_sd_m,
        "tilt_deg": floor.tilt_deg,
        "tilt_sd_deg": floor.tilt_sd_deg,
        "roll_deg": floor.roll_deg,
        "roll_sd_deg": floor.roll_sd_deg,
        "confidence": floor.confidence,
        "normal": floor.plane.normal,
        "pixel_count": floor.pixel_count,
    })
}

fn plane(plane: &ClassifiedPlane) -> Value {
    json!({
        "label": plane.label,
        "class": plane.class.name(),
        "height_m": plane.height_m,
        "slope_deg": plane.slope_deg,
    })
}

fn obstacle(obstacle: &Obstacle) -> Value {
    let pixels = obstacle.bounding_box;
    json!({
        "kind": if obstacle.is_drop { "drop" } else { "obstacle" },
        "distance_m": obstacle.distance_m,
        "bearing_deg": obstacle.bearing_deg,
        "width_m": obstacle.width_m,
        "height_m": obstacle.height_m,
        "bounding_box": {"u_min": pixels.u_min, "v_min": pixels.v_min, "u_max": pixels.u_max, "v_max": pixels.v_max},
    })
}

fn step(step: &Step) -> Value {
    json!({
        "label": step.label,
        "order": step.order,
        "height_m": step.height_m,
        "rise_m": step.rise_m,
        "run_m": step.run_m,
        "distance_m": step.distance_m,
    })
}

fn sector(sector: &Sector) -> Value {
    json!({
        "from_deg": sector.from_deg,
        "to_deg": sector.to_deg,
        "free_m": sector.free_m,
        "blocked": sector.is_blocked,
    })
}

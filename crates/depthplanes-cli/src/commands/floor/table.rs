//! The ground for people.

use crate::table::{Align, aligned, row};
use crate::terminal::plain;
use depthplanes::ground::{Floor, Ground, Sector, Up};
use depthplanes::{Detection, Plane};

/// One line on the floor, one on the camera, and the planes in columns.
pub(super) fn table(name: &str, ground: &Ground, planes: &[Plane], most: usize) -> String {
    let Some(floor) = &ground.floor else { return format!("{}: no floor\n", plain(name)) };
    let mut text = format!("{}: {}\n{}", plain(name), pieces(floor), camera(floor));
    let mut rows = vec![row(["plane", "class", "height", "slope", "pixels"])];
    let number = |value: Option<f64>, digits: usize, unit: &str| {
        value.map_or("-".to_string(), |value| format!("{:.digits$} {unit}", value + 0.0))
    };
    let shown = ground.planes.iter().zip(planes).take(most);
    rows.extend(shown.map(|(of, plane)| {
        let (height, slope) = (number(of.height_m, 3, "m"), number(of.slope_deg, 1, "deg"));
        row([&of.label.to_string(), of.class.name(), &height, &slope, &plane.pixel_count.to_string()])
    }));
    let mut columns = [Align::Right; 5];
    columns[1] = Align::Left;
    text += &aligned(&columns, &rows);
    if planes.len() > most {
        text += &format!("... and {} smaller; --rows N shows more\n", planes.len() - most);
    }
    text += "height: of the plane's middle above the floor; slope: 0 faces up, 90 upright, 180 faces down\n";
    text + &steps(ground) + &obstacles(ground, most) + &free(ground)
}

/// The steps of a stair, if there are two.
fn steps(ground: &Ground) -> String {
    if ground.steps.len() < 2 {
        return String::new();
    }
    let mut rows = vec![row(["step", "plane", "rise", "run", "height"])];
    rows.extend(ground.steps.iter().map(|step| {
        let run = step.run_m.map_or("-".to_string(), |run| format!("{run:.3} m"));
        let (rise, height) = (format!("{:.3} m", step.rise_m), format!("{:.3} m", step.height_m));
        row([&step.order.to_string(), &step.label.to_string(), &rise, &run, &height])
    }));
    "\n".to_string() + &aligned(&[Align::Right; 5], &rows)
}

fn obstacles(ground: &Ground, most: usize) -> String {
    if ground.obstacles.is_empty() {
        return "no obstacle\n".into();
    }
    let mut rows = vec![row(["obstacle", "distance", "bearing", "width", "height"])];
    rows.extend(ground.obstacles.iter().take(most).map(|of| {
        let kind = if of.is_drop { "drop" } else { "obstacle" };
        let [distance, width, height] = [of.distance_m, of.width_m, of.height_m].map(|metres| format!("{metres:.2} m"));
        row([kind, &distance, &format!("{:.0} deg", of.bearing_deg + 0.0), &width, &height])
    }));
    let mut columns = [Align::Right; 5];
    columns[0] = Align::Left;
    let mut text = "\n".to_string() + &aligned(&columns, &rows);
    if ground.obstacles.len() > most {
        text += &format!("... and {} farther away; --rows N shows more\n", ground.obstacles.len() - most);
    }
    text + "distance: along the floor, from below the camera; bearing: to the right of the direction of view\n"
}

/// How far the floor is free to the left, ahead and to the right.
fn free(ground: &Ground) -> String {
    let cell = |sector: &Sector| format!("{:.1}{}", sector.free_m, if sector.is_blocked { "" } else { "+" });
    let cells: Vec<String> = ground.sectors.iter().map(cell).collect();
    let (Some(first), Some(last)) = (ground.sectors.first(), ground.sectors.last()) else { return String::new() };
    format!(
        "\nfree floor, metres, from {:.0} to {:.0} deg (+: as far as it is seen): {}\n",
        first.from_deg,
        last.to_deg,
        cells.join(" ")
    )
}

fn pieces(floor: &Floor) -> String {
    let labels: Vec<String> = floor.labels.iter().map(u16::to_string).collect();
    let planes = if labels.len() == 1 { "plane" } else { "planes" };
    format!("the floor is {planes} {}, confidence {:.2}", labels.join(", "), floor.confidence)
}

fn camera(floor: &Floor) -> String {
    let Floor { height_m, height_sd_m, tilt_deg, tilt_sd_deg, roll_deg, roll_sd_deg, .. } = floor;
    format!(
        "camera: {height_m:.3} m (sd {height_sd_m:.3}) above it, looks down {tilt_deg:.1} deg (sd {tilt_sd_deg:.1}), \
         roll {:.1} deg (sd {roll_sd_deg:.1})\n",
        roll_deg + 0.0
    )
}

/// Why there is no floor, and what would help.
pub(super) fn no_floor(found: &Detection, up: Up) -> String {
    if found.planes.is_empty() {
        return "no floor, since there is no plane; `depthplanes explain` says why a pixel has none".into();
    }
    match up {
        Up::Known(_) => "no floor: no plane is level by the --up that was given; is it in camera coordinates, x right, \
                              y down, z ahead? Without --up it is estimated"
            .into(),
        Up::Estimated => "no floor: no plane is likely to be one. If one is in view, state what is up with --up X,Y,Z, as an \
                               IMU or a pose tells it; that is needed where the camera looks straight down or lies on its side"
            .into(),
    }
}

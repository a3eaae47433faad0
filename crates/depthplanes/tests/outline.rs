//! Outlines of random label images against their definitions, and areas against analytic ones.

mod naive;

use depthplanes::detection::{PixelBox, Plane};
use depthplanes::outline::{Outline, Outliner, Outlines, Rectangle, Ring};
use depthplanes::{DepthView, Detection, Detector, Error, Intrinsics, Ngaf, Sensor, ValueKind};
use naive::Random;

type Point = [f64; 2];

/// A label image as a detection; its planes know their labels alone.
fn detection(labels: Vec<u16>, width: usize) -> Detection {
    let nowhere = PixelBox { u_min: 0, v_min: 0, u_max: 0, v_max: 0 };
    let plane = |label: u16| Plane::new(label, labels.iter().filter(|&&other| other == label).count(), nowhere);
    let planes = (1..=labels.iter().copied().max().unwrap_or(0)).map(plane).collect();
    let mut detection = Detection::default();
    (detection.width, detection.height) = (width, labels.len() / width);
    (detection.labels, detection.planes) = (labels, planes);
    detection
}

/// Blocks, stripes, specks and holes of a few labels; planes need not be connected.
fn label_image(random: &mut Random) -> Detection {
    let (width, height) = (1 + random.below(24) as usize, 1 + random.below(24) as usize);
    let labels = 1 + random.below(4);
    let mut image = vec![random.below(labels + 1) as u16; width * height];
    for _ in 0..random.below(12) {
        let (u, v) = (random.below(width as u64) as usize, random.below(height as u64) as usize);
        let (w, h) = (1 + random.below(12) as usize, 1 + random.below(12) as usize);
        let (label, slope) = (random.below(labels + 1) as u16, random.below(3) as usize);
        for y in v..(v + h).min(height) {
            let u = u + slope * (y - v) / 2;
            (u..(u + w).min(width)).for_each(|x| image[y * width + x] = label);
        }
    }
    let specks = [0, 0, 2, 10, 60][random.below(5) as usize];
    let speck = |label: u16, random: &mut Random| {
        if random.below(100) < specks { random.below(labels + 1) as u16 } else { label }
    };
    detection(image.iter().map(|&label| speck(label, random)).collect(), width)
}

fn points(ring: &Ring<'_>) -> Vec<Point> {
    ring.points_px().collect()
}

/// All rings of a plane: whether it is a hole, its points.
fn rings(outline: &Outline<'_>) -> Vec<(bool, Vec<Point>)> {
    let all = outline.polygons().flat_map(|polygon| {
        let holes: Vec<_> = polygon.holes().map(|ring| (true, points(&ring))).collect();
        std::iter::once((false, points(&polygon.outer()))).chain(holes)
    });
    all.collect()
}

fn edges(ring: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    (0..ring.len()).map(|k| (ring[k], ring[(k + 1) % ring.len()]))
}

/// Below 0 if it runs counter-clockwise on the picture.
fn area(ring: &[Point]) -> f64 {
    edges(ring).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0
}

/// How often a ring goes round a point, counter-clockwise on the picture.
fn winding(ring: &[Point], [u, v]: Point) -> i32 {
    let crossing = |(a, b): (Point, Point)| {
        if (a[1] <= v) == (b[1] <= v) {
            return 0;
        }
        let left = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) < u;
        if !left {
            0
        } else if b[1] > a[1] {
            1
        } else {
            -1
        }
    };
    edges(ring).map(crossing).sum()
}

fn distance(p: Point, (a, b): (Point, Point)) -> f64 {
    let (way, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = ((from[0] * way[0] + from[1] * way[1]) / (way[0].powi(2) + way[1].powi(2))).clamp(0.0, 1.0);
    (from[0] - t * way[0]).hypot(from[1] - t * way[1])
}

fn distance_to_ring(p: Point, ring: &[Point]) -> f64 {
    edges(ring).map(|edge| distance(p, edge)).fold(f64::INFINITY, f64::min)
}

fn pixels(detection: &Detection) -> impl Iterator<Item = (Point, u16)> {
    let at = |at: usize| [(at % detection.width) as f64, (at / detection.width) as f64];
    detection.labels.iter().enumerate().map(move |(k, &label)| (at(k), label))
}

fn outlines(detection: &Detection, tolerance: f64) -> Outlines {
    Outliner::new(tolerance).unwrap().outline(detection, None).unwrap().clone()
}

#[test]
fn filling_the_exact_rings_gives_back_the_mask() {
    let mut random = Random(1);
    let mut holes = 0;
    for _ in 0..400 {
        let detection = label_image(&mut random);
        for outline in outlines(&detection, 0.0).iter() {
            let rings = rings(&outline);
            for (pixel, label) in pixels(&detection) {
                let inside: i32 = rings.iter().map(|(_, ring)| winding(ring, pixel)).sum();
                assert_eq!(inside, i32::from(label == outline.label()), "{pixel:?} of {detection:?}");
            }
            let count = detection.planes[usize::from(outline.label()) - 1].pixel_count;
            assert_eq!(rings.iter().map(|(_, ring)| area(ring)).sum::<f64>(), -(count as f64));
            holes += rings.iter().filter(|(is_hole, _)| *is_hole).count();
        }
    }
    assert!(holes > 300, "{holes} holes");
}

/// A plane, a hole in it, the plane again in the hole and so on, in rings of that many pixels.
fn squares_in_squares(found: &mut Detection, pixels: usize) {
    let (width, height) = (found.width, found.height);
    for (at, label) in found.labels.iter_mut().enumerate() {
        let (u, v) = (at % width, at / width);
        let from_edge = u.min(v).min(width - 1 - u).min(height - 1 - v);
        if *label != 2 {
            *label = u16::from((from_edge / pixels).is_multiple_of(2) && !found.planes.is_empty());
        }
    }
}

#[test]
fn small_holes_are_filled_and_what_stood_in_them_is_covered_once() {
    let mut random = Random(77);
    let (mut filled, mut islands) = (0, 0);
    for round in 0..1500 {
        let mut found = label_image(&mut random);
        if round % 3 == 0 {
            squares_in_squares(&mut found, 1 + random.below(3) as usize);
        }
        let min_hole = [0, 1, 2, 5, 12, 40, 1000][round % 7];
        let all = outlines(&found, 0.0);
        let mut outliner = Outliner::new(0.0).unwrap().min_hole_px(min_hole);
        let kept = outliner.outline(&found, None).unwrap().clone();
        assert_eq!(kept.min_hole_px(), min_hole);
        for (outline, after) in all.iter().zip(kept.iter()) {
            let (before, after) = (rings(&outline), rings(&after));
            let small = |ring: &(bool, Vec<Point>)| ring.0 && area(&ring.1).abs() < min_hole as f64;
            assert!(!after.iter().any(small));
            let gone: Vec<_> = before.iter().filter(|ring| small(ring)).collect();
            filled += gone.len();
            islands += before.len() - after.len() - gone.len();
            for (pixel, label) in pixels(&found) {
                let turns: i32 = after.iter().map(|(_, ring)| winding(ring, pixel)).sum();
                let covered = gone.iter().any(|(_, ring)| winding(ring, pixel) != 0);
                let wanted = i32::from(covered || label == outline.label());
                assert_eq!(turns, wanted, "{pixel:?} of {found:?}, holes below {min_hole}");
            }
        }
    }
    assert!(filled > 300 && islands > 10, "{filled} holes, {islands} islands");
}

#[test]
fn each_connected_part_is_one_polygon() {
    let mut random = Random(2);
    for _ in 0..400 {
        let detection = label_image(&mut random);
        let map: Vec<f64> = detection.labels.iter().map(|&label| label.into()).collect();
        let parts = naive::flood(&map, detection.width, |label| label > 0.0, 0.0, false);
        for outline in outlines(&detection, 0.0).iter() {
            let of_plane = |(at, part): (usize, &Option<usize>)| {
                part.filter(|&first| first == at && detection.labels[at] == outline.label())
            };
            let expected = parts.iter().enumerate().filter_map(of_plane).count();
            assert_eq!(outline.polygons().count(), expected, "{detection:?}");
            for polygon in outline.polygons() {
                assert!(area(&points(&polygon.outer())) < 0.0);
                assert!(polygon.holes().all(|hole| area(&points(&hole)) > 0.0));
            }
        }
    }
}

/// Whether two edges have a point in common that is not an end of both, or both ends.
fn meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let side = |a: Point, b: Point, p: Point| {
        let area = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        area.partial_cmp(&0.0).unwrap() as i32
    };
    let on = |p: Point, edge: (Point, Point)| distance(p, edge) == 0.0;
    let crossing = side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
    let touching = [(a, (c, d)), (b, (c, d)), (c, (a, b)), (d, (a, b))]
        .into_iter()
        .any(|(p, edge)| side(edge.0, edge.1, p) == 0 && on(p, edge) && p != edge.0 && p != edge.1);
    crossing || touching || [(a, b), (b, a)].contains(&(c, d))
}

/// A larger image with rough edges and holes near them, where chords come into conflict.
fn rough_image(random: &mut Random) -> Detection {
    let (width, height) = (60, 40);
    let holes = 2 + random.below(12);
    let inside = |u: f64, v: f64| (u - 30.0).powi(2) / 700.0 + (v - 20.0).powi(2) / 300.0 < 1.0;
    let mut labels: Vec<u16> =
        (0..width * height).map(|at| inside((at % width) as f64, (at / width) as f64).into()).collect();
    for _ in 0..width * height * holes as usize / 100 {
        let at = random.below((width * height) as u64) as usize;
        labels[at] = random.below(3) as u16;
    }
    detection(labels, width)
}

#[test]
fn simplified_rings_never_meet_and_keep_their_places() {
    let mut random = Random(3);
    for round in 0..300 {
        let detection = if round % 4 == 0 { rough_image(&mut random) } else { label_image(&mut random) };
        let tolerance = [0.3, 0.75, 1.0, 1.0, 2.5, 8.0, 1e9][random.below(7) as usize];
        let (exact, simple) = (outlines(&detection, 0.0), outlines(&detection, tolerance));
        for (exact, simple) in exact.iter().zip(simple.iter()) {
            let (exact, simple) = (rings(&exact), rings(&simple));
            assert_eq!(exact.len(), simple.len());
            let all: Vec<_> = simple.iter().flat_map(|(_, ring)| edges(ring)).collect();
            for (k, &edge) in all.iter().enumerate() {
                let meets = all[..k].iter().find(|&&other| meet(edge, other));
                assert!(meets.is_none(), "{edge:?} {meets:?}, tolerance {tolerance}, {detection:?}");
            }
            for ((is_hole, exact), (_, simple)) in exact.iter().zip(&simple) {
                assert!(simple.len() >= 3 && (area(simple) > 0.0) == *is_hole);
                assert!(simple.iter().all(|point| exact.contains(point)));
                let most = exact.iter().map(|&point| distance_to_ring(point, simple)).fold(0.0, f64::max);
                assert!(most <= tolerance * (1.0 + 1e-12), "{most} of {tolerance}");
                let mut seen = simple.clone();
                seen.sort_by(|a, b| a.partial_cmp(b).unwrap());
                seen.dedup();
                assert_eq!(seen.len(), simple.len(), "a ring comes to a point once");
            }
            for _ in 0..100 {
                let inside = |at: Point| simple.iter().map(|(_, ring)| winding(ring, at)).sum::<i32>();
                let at = [random.between(-1.0, 60.0), random.between(-1.0, 40.0)];
                assert!([0, 1].contains(&inside(at)), "{at:?}, tolerance {tolerance}, {detection:?}");
            }
        }
    }
}

#[test]
fn a_hole_that_a_chord_would_pass_over_stays_inside() {
    // A notch beside a hole; the notch is shallower than the tolerance.
    let rows = ["1111111111", "1111111111", "1111011111", "1110111111", "1110111111"];
    let labels = rows.iter().flat_map(|row| row.bytes().map(|byte| u16::from(byte - b'0'))).collect();
    let detection = detection(labels, 10);
    for tolerance in [1.0, 2.0, 5.0, 50.0] {
        let outlines = outlines(&detection, tolerance);
        let polygon = outlines.get(1).unwrap().polygons().next().unwrap();
        let outer = points(&polygon.outer());
        for hole in polygon.holes() {
            for point in hole.points_px() {
                assert!(winding(&outer, point) == 1 || distance_to_ring(point, &outer) == 0.0);
            }
        }
    }
}

#[test]
fn a_straight_edge_keeps_two_corners_and_stairs_become_a_line() {
    let rectangle = detection([[0, 0, 0, 0, 0], [0, 1, 1, 1, 0], [0, 1, 1, 1, 0]].concat(), 5);
    assert_eq!(
        rings(&outlines(&rectangle, 0.0).get(1).unwrap())[0].1,
        [[0.5, 0.5], [0.5, 2.5], [3.5, 2.5], [3.5, 0.5]]
    );
    assert_eq!(outlines(&rectangle, 0.0), Outlines::clone(&outlines(&rectangle, 0.0)));
    let stairs = detection((0..40 * 40).map(|at| u16::from(at % 40 <= at / 40)).collect(), 40);
    let (exact, simple) = (outlines(&stairs, 0.0), outlines(&stairs, 1.0));
    assert_eq!(rings(&exact.get(1).unwrap())[0].1.len(), 82);
    assert!(rings(&simple.get(1).unwrap())[0].1.len() <= 5);
}

#[test]
fn hulls_are_convex_and_hold_every_corner() {
    let mut random = Random(4);
    for _ in 0..400 {
        let detection = label_image(&mut random);
        for outline in outlines(&detection, 0.0).iter() {
            let hull = points(&outline.hull());
            let corners: Vec<Point> = rings(&outline).into_iter().flat_map(|(_, ring)| ring).collect();
            assert!(hull.iter().all(|point| corners.contains(point)));
            let side = |(a, b): (Point, Point), p: Point| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            for (k, edge) in edges(&hull).enumerate() {
                assert!(side(edge, hull[(k + 2) % hull.len()]) < 0.0, "strictly convex");
                assert!(corners.iter().all(|&corner| side(edge, corner) <= 0.0));
            }
        }
    }
}

/// Asserts that a rectangle holds points and that no direction of many gives a smaller one.
fn check_rectangle<const N: usize>(
    rectangle: &Rectangle<N>,
    points: &[[f64; N]],
    handed: impl Fn([[f64; N]; 2]) -> f64,
) {
    let dot = |a: [f64; N], b: [f64; N]| (0..N).map(|i| a[i] * b[i]).sum::<f64>();
    let Rectangle { centre, axes, sides } = *rectangle;
    let size = sides[0];
    assert!(sides[0] >= sides[1] && sides[1] > 0.0);
    assert!((dot(axes[0], axes[0]) - 1.0).abs() < 1e-12 && (dot(axes[1], axes[1]) - 1.0).abs() < 1e-12);
    assert!(dot(axes[0], axes[1]).abs() < 1e-12 && (handed(axes) - 1.0).abs() < 1e-9, "{}", handed(axes));
    assert!(axes[0][0] >= 0.0);
    let placed: Vec<Point> = points
        .iter()
        .map(|point| {
            let from: [f64; N] = std::array::from_fn(|i| point[i] - centre[i]);
            axes.map(|axis| dot(axis, from))
        })
        .collect();
    for point in &placed {
        assert!((0..2).all(|k| point[k].abs() <= sides[k] / 2.0 + 1e-9 * size), "{point:?} {sides:?}");
    }
    let least = (0..360).map(|step| {
        let (sine, cosine) = (f64::from(step) / 360.0 * std::f64::consts::FRAC_PI_2).sin_cos();
        let width = |[x, y]: Point| {
            let along = placed.iter().map(|point| point[0] * x + point[1] * y);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        width([cosine, sine]) * width([-sine, cosine])
    });
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(rectangle.area() <= least * (1.0 + 1e-9), "{} {least}", rectangle.area());
    for corner in rectangle.corners() {
        let from: [f64; N] = std::array::from_fn(|i| corner[i] - centre[i]);
        assert!((dot(from, from).sqrt() - sides[0].hypot(sides[1]) / 2.0).abs() < 1e-9 * size);
    }
}

#[test]
fn rectangles_hold_every_corner_and_none_is_smaller() {
    let mut random = Random(5);
    for _ in 0..300 {
        let detection = label_image(&mut random);
        for outline in outlines(&detection, 1.0).iter() {
            // A quarter turn counter-clockwise on the picture leads from right to up, where v falls.
            let handed = |axes: [Point; 2]| axes[0][1] * axes[1][0] - axes[0][0] * axes[1][1];
            check_rectangle(&outline.rectangle_px(), &points(&outline.hull()), handed);
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Signed area of a plane ring around a normal.
fn area_m2(ring: &Ring<'_>, normal: [f64; 3]) -> f64 {
    let points: Vec<[f64; 3]> = ring.points_m().expect("metric").collect();
    let origin = points[0];
    points.windows(2).map(|pair| dot(normal, cross(sub(pair[0], origin), sub(pair[1], origin)))).sum::<f64>() / 2.0
}

/// Detects a plane `1/z = a u + b v + c` where `holds`, missing elsewhere, in a float map of metres.
fn detect(
    camera: Intrinsics,
    (width, height): (usize, usize),
    [a, b, c]: [f64; 3],
    holds: impl Fn(usize, usize) -> bool,
) -> (Detection, Sensor) {
    let value = |at: usize| {
        let (u, v) = (at % width, at / width);
        let q = a * u as f64 + b * v as f64 + c;
        if holds(u, v) && q > 0.0 { (1.0 / q) as f32 } else { 0.0 }
    };
    let map: Vec<f32> = (0..width * height).map(value).collect();
    let sensor = Sensor::default().value_kind(ValueKind::Depth { metres: 1.0 }).intrinsics(Some(camera));
    let mut detector = Detector::new(Ngaf::default().theta(1e6).min_pixels(3)).unwrap().sensor(sensor);
    (detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap().clone(), sensor)
}

#[test]
fn areas_by_rings_are_areas_by_runs_and_rings_turn_about_the_normal() {
    let mut random = Random(6);
    let mut measured = 0;
    for round in 0..300 {
        let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]][round % 4];
        let (fx, fy) = (signs[0] * random.between(20.0, 60.0), signs[1] * random.between(20.0, 60.0));
        let camera = Intrinsics::new(fx, fy, random.between(0.0, 30.0), random.between(0.0, 30.0)).unwrap();
        let labels = label_image(&mut random);
        let abc = [random.between(-0.01, 0.01), random.between(-0.01, 0.01), random.between(0.4, 1.0)];
        let inside = |u: usize, v: usize| labels.labels[v * labels.width + u] > 0;
        let (found, _) = detect(camera, (labels.width, labels.height), abc, inside);
        let (mut exact, mut simple) = (Outliner::new(0.0).unwrap(), Outliner::default());
        let exact = exact.outline(&found, Some(&camera)).unwrap();
        let simple = simple.outline(&found, Some(&camera)).unwrap();
        for plane in &found.planes {
            let Some(metric) = plane.metric else { continue };
            let (exact, simple) = (exact.get(plane.label).unwrap(), simple.get(plane.label).unwrap());
            let normal = metric.plane.normal;
            let mut sum = 0.0;
            for polygon in exact.polygons() {
                assert!(area_m2(&polygon.outer(), normal) > 0.0);
                assert!(polygon.holes().all(|hole| area_m2(&hole, normal) < 0.0));
                let holes: f64 = polygon.holes().map(|hole| area_m2(&hole, normal)).sum();
                sum += area_m2(&polygon.outer(), normal) + holes;
            }
            let area = metric.area_m2.expect("far from infinity");
            assert!((sum - area).abs() < 1e-9 * area, "{sum} {area}");
            for polygon in simple.polygons() {
                assert!(area_m2(&polygon.outer(), normal) > 0.0);
                assert!(polygon.holes().all(|hole| area_m2(&hole, normal) < 0.0));
            }
            let hull: Vec<[f64; 3]> = exact.hull().points_m().unwrap().collect();
            assert!(area_m2(&exact.hull(), normal) >= area * (1.0 - 1e-9));
            assert!(hull.iter().all(|&point| (dot(normal, point) + metric.plane.distance).abs() < 1e-9));
            let handed = |axes: [[f64; 3]; 2]| dot(normal, cross(axes[0], axes[1]));
            check_rectangle(&exact.rectangle_m().unwrap(), &hull, handed);
            measured += 1;
        }
    }
    assert!(measured > 300, "{measured} planes");
}

#[test]
fn a_wall_that_faces_the_camera_has_the_area_of_its_pixels() {
    let camera = Intrinsics::new(50.0, -40.0, 9.0, 7.0).unwrap();
    let (found, _) = detect(camera, (20, 16), [0.0, 0.0, 0.5], |_, _| true);
    let metric = found.planes[0].metric.unwrap();
    assert!((metric.area_m2.unwrap() - 20.0 * 16.0 * 4.0 / (50.0 * 40.0)).abs() < 1e-6);
    let mut outliner = Outliner::default();
    let outlines = outliner.outline(&found, Some(&camera)).unwrap();
    let rectangle = outlines.get(1).unwrap().rectangle_m().unwrap();
    assert!((rectangle.sides[0] - 0.8).abs() < 1e-6 && (rectangle.sides[1] - 0.8).abs() < 1e-6, "{rectangle:?}");
}

/// A board of 2 m x 1 m that leans back and is turned, 3 m away, seen at growing resolution: the
/// area errs by at most half a pixel along its edge.
#[test]
fn the_area_of_a_board_comes_to_its_true_area() {
    let (along, up) = ([0.8, 0.0, 0.6], [-0.6 * 0.6, 0.8, 0.8 * 0.6]);
    let (centre, normal) = ([0.2, -0.1, 3.0], cross(along, up));
    for scale in [1.0, 2.0, 4.0] {
        let camera = Intrinsics::new(150.0 * scale, 150.0 * scale, 80.0 * scale, 60.0 * scale).unwrap();
        let size = (160.0 * scale, 120.0 * scale);
        let m = normal.map(|x| x / dot(normal, centre));
        let (a, b) = (m[0] / camera.fx, m[1] / camera.fy);
        let abc = [a, b, m[2] - a * camera.cx - b * camera.cy];
        let on_board = |u: usize, v: usize| {
            let ray = camera.ray(u as f64, v as f64);
            let from = sub(ray.map(|r| r / dot(m, ray)), centre);
            dot(from, along).abs() <= 1.0 && dot(from, up).abs() <= 0.5
        };
        let (found, _) = detect(camera, (size.0 as usize, size.1 as usize), abc, on_board);
        assert_eq!(found.planes.len(), 1);
        let area = found.planes[0].metric.unwrap().area_m2.unwrap();
        assert!((area - 2.0).abs() < 0.03 / scale, "{area} at {scale}");
        let mut outliner = Outliner::default();
        let outline = outliner.outline(&found, Some(&camera)).unwrap().get(1).unwrap();
        let rectangle = outline.rectangle_m().unwrap();
        assert!((rectangle.sides[0] - 2.0).abs() < 0.06 / scale, "{rectangle:?}");
        assert!((rectangle.sides[1] - 1.0).abs() < 0.06 / scale, "{rectangle:?}");
        assert!(dot(rectangle.axes[0], along) > 0.999);
        let corners = points(&outline.polygons().next().unwrap().outer()).len();
        assert!(corners <= 8, "{corners} corners");
    }
}

#[test]
fn a_plane_that_reaches_infinity_has_no_area_and_no_outline_in_metres() {
    // Inverse depth 0.2 + v: all pixels lie before infinity, the upper half of the first row's squares does not.
    let (width, height) = (12, 9);
    let map: Vec<f32> = (0..width * height).map(|at| 0.2 + (at / width) as f32).collect();
    let camera = Intrinsics::new(50.0, 50.0, 6.0, -2.0).unwrap();
    let value_kind = ValueKind::InverseDepth { slope: 0.1, offset: 0.0 };
    let sensor = Sensor::default().value_kind(value_kind).intrinsics(Some(camera));
    let mut detector = Detector::new(Ngaf::default()).unwrap().sensor(sensor);
    let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
    assert_eq!(found.planes[0].metric.unwrap().area_m2, None);
    let mut outliner = Outliner::default();
    let outline = outliner.outline(found, Some(&camera)).unwrap().get(1).unwrap();
    assert!(!outline.is_metric() && outline.rectangle_m().is_none() && outline.hull().points_m().is_none());
    assert_eq!(outline.hull().points_px().len(), 4);
}

#[test]
fn what_is_no_label_image_or_no_tolerance_is_an_error() {
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Outliner::new(tolerance), Err(Error::Parameter { name: "outlines", .. })));
    }
    let mut outliner = Outliner::default();
    let mut given = detection(vec![1, 1, 0, 1], 2);
    given.width = 3;
    assert!(matches!(outliner.outline(&given, None), Err(Error::Length { given: 4, least: 6, most: 6 })));
    assert!(matches!(outliner.outline(&Detection::default(), None), Err(Error::Size { .. })));
}

#[test]
fn labels_without_a_plane_are_background_and_planes_without_a_pixel_have_no_outline() {
    let mut given = detection(vec![1, 7, 3, 3], 2);
    given.planes.truncate(3);
    let outlines = outlines(&given, 1.0);
    assert_eq!(outlines.iter().map(|outline| outline.label()).collect::<Vec<_>>(), [1, 3]);
    assert!(outlines.get(2).is_none() && outlines.get(7).is_none() && outlines.get(0).is_none());
}

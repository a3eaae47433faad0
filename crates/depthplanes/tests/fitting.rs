//! Closed-form fits against nalgebra's decompositions, and metric planes against analytic ones.

mod naive;

use depthplanes::internals::{AffineFit, Moments, ValueSums, hessian_normal_form, metric_covariance};
use depthplanes::{HessianNormalForm, Intrinsics};
use naive::Random;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, SMatrix, Vector3, Vector4};

type Point = [f64; 3];

/// Pixels of shapes that groups take, next to (u, v): rectangles, strips two pixels wide, L and T
/// shapes, stairs, three pixels.
fn shape(random: &mut Random, u: f64, v: f64) -> Vec<[f64; 2]> {
    let (length, width) = (3 + random.below(60), 2 + random.below(20));
    let rectangle = |width: u64, height: u64| {
        (0..width * height).map(move |at| ((at % width) as f64, (at / width) as f64)).collect::<Vec<_>>()
    };
    let shape = match random.below(6) {
        0 => rectangle(length, width),
        1 => rectangle(length, 2),
        2 => rectangle(2, length),
        3 => (0..length).map(|k| (k as f64, 0.0)).chain((1..width).map(|k| (0.0, k as f64))).collect(),
        4 => (0..2 * length).map(|k| (k.div_ceil(2) as f64, (k / 2) as f64)).collect(),
        _ => vec![(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)],
    };
    shape.into_iter().map(|(x, y)| [u + x, v + y]).collect()
}

/// Points of a random plane over a random shape anywhere in a map of 4096 x 4096.
fn points(random: &mut Random, noise: f64) -> Vec<Point> {
    let (u, v) = (random.below(4096) as f64, random.below(4096) as f64);
    let (a, b, level) = (random.between(-30.0, 30.0), random.between(-30.0, 30.0), random.between(1.0, 65_535.0));
    let at =
        |[x, y]: [f64; 2], random: &mut Random| [x, y, level + a * (x - u) + b * (y - v) + noise * random.gaussian()];
    shape(random, u, v).into_iter().map(|pixel| at(pixel, random)).collect()
}

/// The library's fit, its sums taken about the first point.
fn fit(points: &[Point]) -> Option<AffineFit> {
    let origin = points[0];
    let mut sums = Moments::default();
    points.iter().for_each(|p| sums.add(p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]));
    sums.fit().map(|fit| fit.moved(origin))
}

struct Oracle {
    abc: Vector3<f64>,
    rms: f64,
    covariance: Matrix3<f64>,
}

/// Least squares by singular values about the first pixel; covariance s^2 (A^T A)^-1 from the same.
fn oracle(points: &[Point]) -> Oracle {
    let [u, v, q] = points[0];
    let design = DMatrix::from_fn(points.len(), 3, |i, j| [points[i][0] - u, points[i][1] - v, 1.0][j]);
    let values = DVector::from_fn(points.len(), |i, _| points[i][2] - q);
    let svd = design.clone().svd(true, true);
    let abc = svd.solve(&values, 1e-12).unwrap();
    let squares = (&design * &abc - values).norm_squared();
    let freedom = points.len() as f64 - 3.0;
    let v_t = svd.v_t.unwrap();
    let inverse_squares = DMatrix::from_diagonal(&svd.singular_values.map(|s| 1.0 / (s * s)));
    let inverse = v_t.transpose() * inverse_squares * v_t;
    // q = a (u' - u) + b (v' - v) + c' + q: to coefficients about pixel (0, 0).
    let shift = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -u, -v, 1.0);
    let inverse = Matrix3::from_fn(|i, j| inverse[(i, j)]);
    let variance = if freedom > 0.0 { squares / freedom } else { 0.0 };
    Oracle {
        abc: shift * Vector3::new(abc[0], abc[1], abc[2]) + Vector3::new(0.0, 0.0, q),
        rms: (squares / points.len() as f64).sqrt(),
        covariance: shift * inverse * shift.transpose() * variance,
    }
}

fn spread(points: &[Point]) -> f64 {
    let n = points.len() as f64;
    let mean = points.iter().map(|p| p[2]).sum::<f64>() / n;
    (points.iter().map(|p| (p[2] - mean) * (p[2] - mean)).sum::<f64>() / n).sqrt()
}

#[track_caller]
fn assert_near(given: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((given - expected).abs() <= tolerance, "{what}: {given} instead of {expected}, more than {tolerance} off");
}

#[test]
fn fits_match_singular_value_decomposition() {
    let mut random = Random(21);
    for case in 0..5000 {
        let noise = [0.0, 0.01, 1.0, 50.0][case % 4];
        let points = points(&mut random, noise);
        let (fit, oracle, spread) = (fit(&points).unwrap(), oracle(&points), spread(&points));
        let what = format!("case {case}, {} points, noise {noise}", points.len());
        for p in &points {
            let expected = oracle.abc[0] * p[0] + oracle.abc[1] * p[1] + oracle.abc[2];
            assert_near(fit.at(p[0], p[1]), expected, 1e-6, &what);
        }
        assert_near(fit.abc[0], oracle.abc[0], 1e-7, &what);
        assert_near(fit.abc[1], oracle.abc[1], 1e-7, &what);
        // One pass of sums leaves a residual of up to a millionth of what the slopes span where there is none.
        let scale = spread + 60.0 * (fit.abc[0].abs() + fit.abc[1].abs());
        assert_near(fit.rms * fit.rms, oracle.rms * oracle.rms, 1e-12 * scale * scale, &what);
        assert_eq!(fit.n, points.len() as f64);
    }
}

#[test]
fn sums_about_the_corner_of_the_map_still_fit() {
    let mut random = Random(22);
    for case in 0..500 {
        let points = points(&mut random, 1.0);
        let mut sums = Moments::default();
        points.iter().for_each(|p| sums.add(p[0], p[1], p[2]));
        let (fit, oracle) = (sums.fit().unwrap(), oracle(&points));
        for p in &points {
            let expected = oracle.abc[0] * p[0] + oracle.abc[1] * p[1] + oracle.abc[2];
            assert_near(fit.at(p[0], p[1]), expected, 0.02, &format!("case {case}"));
        }
    }
}

#[test]
fn covariances_match_the_inverse_normal_matrix() {
    let mut random = Random(23);
    for case in 0..3000 {
        let points = points(&mut random, [0.5, 5.0][case % 2]);
        let (fit, oracle) = (fit(&points).unwrap(), oracle(&points));
        let given = fit.covariance();
        if points.len() == 3 {
            assert_eq!(given, [[0.0; 3]; 3]);
            continue;
        }
        for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
            let scale = (oracle.covariance[(i, i)] * oracle.covariance[(j, j)]).sqrt();
            assert_near(given[i][j], oracle.covariance[(i, j)], 1e-6 * scale, &format!("case {case} [{i}][{j}]"));
        }
    }
}

#[test]
fn adding_sums_is_fitting_the_union() {
    let mut random = Random(24);
    for case in 0..1000 {
        let points = points(&mut random, 2.0);
        let origin = points[0];
        let sums = |part: &[Point]| {
            let mut sums = Moments::default();
            part.iter().for_each(|p| sums.add(p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]));
            sums
        };
        let (left, right) = points.split_at(random.below(points.len() as u64 + 1) as usize);
        let mut merged = sums(left);
        merged.merge(&sums(right));
        let (merged, whole) = (merged.fit().unwrap().moved(origin), fit(&points).unwrap());
        for p in &points {
            assert_near(merged.at(p[0], p[1]), whole.at(p[0], p[1]), 1e-8, &format!("case {case}"));
        }
        assert_near(merged.rms, whole.rms, 1e-6, &format!("case {case}"));
        assert_eq!(merged.n, whole.n);
    }
}

#[test]
fn sums_of_a_run_are_the_sums_of_its_pixels() {
    let mut random = Random(25);
    for length in (0..70).chain([1000, 4096]) {
        let values: Vec<u16> = (0..length).map(|_| random.below(65_536) as u16).collect();
        let (u, v, first) = (random.below(50) as f64 - 25.0, random.below(50) as f64, 1000.0);
        let (mut given, mut expected) = (Moments::default(), Moments::default());
        given.add_places(u, v, values.len());
        let mut sums = ValueSums::default();
        sums.add(u, v, &values, |value| f64::from(value) - first);
        let given = given.with(&sums);
        values.iter().zip(0..).for_each(|(&q, k)| expected.add(u + f64::from(k), v, f64::from(q) - first));
        // Whole numbers below 2^53 add up without rounding in any order.
        assert_eq!(given, expected, "{length} pixels");
    }
}

#[test]
fn points_on_a_line_have_no_fit() {
    let line = |du: f64, dv: f64, n: usize| (0..n).map(move |k| [7.0 + du * k as f64, 9.0 + dv * k as f64, k as f64]);
    for n in [1, 2, 3, 10, 4000] {
        for (du, dv) in [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (2.0, -1.0)] {
            assert!(fit(&line(du, dv, n).collect::<Vec<_>>()).is_none(), "{n} points along ({du}, {dv})");
        }
        // One pixel beside the line makes it a plane.
        let beside = line(1.0, 0.0, n.max(2)).chain([[7.0, 10.0, 3.0]]).collect::<Vec<_>>();
        assert!(fit(&beside).is_some(), "{n} points and one beside");
    }
    assert!(Moments::default().fit().is_none());
}

#[test]
fn scaled_values_scale_the_plane_its_residual_and_its_covariance() {
    let mut random = Random(26);
    for case in 0..200 {
        let points = points(&mut random, 1.0);
        let (slope, offset) = (random.between(-3.0, 3.0), random.between(-5.0, 5.0));
        let scaled: Vec<Point> = points.iter().map(|p| [p[0], p[1], slope * p[2] + offset]).collect();
        let (given, expected) = (fit(&points).unwrap().scaled(slope, offset), fit(&scaled).unwrap());
        let what = format!("case {case}");
        for p in &points {
            assert_near(given.at(p[0], p[1]), expected.at(p[0], p[1]), 1e-7, &what);
        }
        assert_near(given.rms, expected.rms, 1e-6, &what);
        let (given, expected) = (given.covariance(), expected.covariance());
        (0..3).for_each(|k| assert_near(given[k][k], expected[k][k], 1e-6 * expected[k][k].abs() + 1e-12, &what));
    }
}

/// A camera, now and then with an axis that points the other way.
fn camera(random: &mut Random) -> Intrinsics {
    let mut sign = || if random.below(3) == 0 { -1.0 } else { 1.0 };
    let signs = [sign(), sign()];
    let mut focal = || random.between(200.0, 1500.0);
    let (fx, fy) = (signs[0] * focal(), signs[1] * focal());
    Intrinsics::new(fx, fy, random.between(0.0, 1000.0), random.between(0.0, 800.0)).unwrap()
}

/// A plane before the camera: it meets the ray through the pixel at the given depth, and faces the
/// camera within 75 degrees or so.
fn plane_through(random: &mut Random, ray: [f64; 3], depth: f64) -> (Vector3<f64>, f64) {
    let ray = Vector3::from(ray);
    loop {
        let normal = Vector3::from_fn(|_, _| random.gaussian()).normalize();
        let distance = -normal.dot(&ray) * depth;
        if distance > 0.25 * depth * ray.norm() {
            return (normal, distance);
        }
    }
}

#[test]
fn metric_planes_of_analytic_depth_are_exact() {
    let mut random = Random(27);
    for case in 0..2000 {
        let camera = camera(&mut random);
        let (u, v) = (random.below(1000) as f64, random.below(800) as f64);
        let depth = random.between(0.3, 10.0);
        let (normal, distance) = plane_through(&mut random, camera.ray(u, v), depth);
        let side = 20 + random.below(60);
        let pixels = (0..side * side).map(|at| [u + (at % side) as f64, v + (at / side) as f64]);
        let inverse_depth = |[u, v]: [f64; 2]| -normal.dot(&Vector3::from(camera.ray(u, v))) / distance;
        let points: Vec<Point> = pixels.map(|[u, v]| [u, v, inverse_depth([u, v])]).collect();
        let fit = fit(&points).unwrap();
        let plane = hessian_normal_form(&fit, &camera).unwrap();
        let what = format!("case {case}, {camera:?}");
        (0..3).for_each(|k| assert_near(plane.normal[k], normal[k], 1e-9, &what));
        assert_near(plane.distance, distance, 1e-9, &what);
    }
}

#[test]
fn planes_survive_the_way_to_inverse_depth_and_back() {
    let mut random = Random(28);
    for case in 0..5000 {
        let camera = camera(&mut random);
        let normal = Vector3::from_fn(|_, _| random.gaussian()).normalize();
        let plane = HessianNormalForm { normal: normal.into(), distance: 10f64.powf(random.between(-3.0, 3.0)) };
        let abc = plane.inverse_depth(&camera).unwrap();
        let back = HessianNormalForm::from_inverse_depth(abc, &camera).unwrap();
        let what = format!("case {case}");
        (0..3).for_each(|k| assert_near(back.normal[k], plane.normal[k], 1e-11, &what));
        assert_near(back.distance, plane.distance, 1e-11 * plane.distance, &what);
        // Points of the plane in front of the camera have that inverse depth, at their pixel.
        let (u, v) = (random.between(0.0, 1000.0), random.between(0.0, 800.0));
        let q = abc[0] * u + abc[1] * v + abc[2];
        let point = Vector3::from(camera.ray(u, v)) / q;
        assert_near(normal.dot(&point) + plane.distance, 0.0, 1e-9 * point.norm().max(1.0), &what);
    }
    let camera = Intrinsics::new(500.0, -500.0, 320.0, 240.0).unwrap();
    assert!(HessianNormalForm::from_inverse_depth([0.0; 3], &camera).is_none());
    assert!(HessianNormalForm::from_inverse_depth([f64::NAN, 0.0, 1.0], &camera).is_none());
    assert!(HessianNormalForm { normal: [0.0, 0.0, -1.0], distance: 0.0 }.inverse_depth(&camera).is_none());
}

#[test]
fn normals_point_to_the_camera_and_distances_are_not_negative() {
    let mut random = Random(29);
    for _ in 0..5000 {
        let camera = camera(&mut random);
        let abc = [random.between(-0.01, 0.01), random.between(-0.01, 0.01), random.between(-4.0, 4.0)];
        let plane = HessianNormalForm::from_inverse_depth(abc, &camera).unwrap();
        assert!(plane.distance > 0.0);
        let normal = Vector3::from(plane.normal);
        assert_near(normal.norm(), 1.0, 1e-12, "length");
        let (u, v) = (random.between(0.0, 1000.0), random.between(0.0, 800.0));
        let q = abc[0] * u + abc[1] * v + abc[2];
        if q > 1e-3 {
            assert!(normal.dot(&Vector3::from(camera.ray(u, v))) < 0.0, "a seen side faces away");
        }
    }
    let camera = Intrinsics::new(500.0, 500.0, 320.0, 240.0).unwrap();
    let wall = HessianNormalForm::from_inverse_depth([0.0, 0.0, 0.5], &camera).unwrap();
    assert_eq!((wall.normal, wall.distance), ([-0.0, -0.0, -1.0], 2.0));
    // A floor one metre below, y being down: 1/z = (v - cy) / fy.
    let floor = HessianNormalForm::from_inverse_depth([0.0, 1.0 / 500.0, -240.0 / 500.0], &camera).unwrap();
    assert_near(floor.normal[1], -1.0, 1e-12, "up");
    assert_near(floor.distance, 1.0, 1e-12, "height");
}

/// A fit over a rectangle with noise, as a sensor would give it.
fn noisy_fit(random: &mut Random, truth: &HessianNormalForm, camera: &Intrinsics, noise: f64) -> AffineFit {
    let [a, b, c] = truth.inverse_depth(camera).unwrap();
    let at = |k: u64| [300.0 + (k % 40) as f64, 200.0 + (k / 40) as f64];
    let point = |k: u64, random: &mut Random| {
        let [u, v] = at(k);
        [u, v, a * u + b * v + c + noise * random.gaussian()]
    };
    fit(&(0..40 * 30).map(|k| point(k, random)).collect::<Vec<_>>()).unwrap()
}

fn slanted_plane(random: &mut Random, camera: &Intrinsics) -> HessianNormalForm {
    let (normal, distance) = plane_through(random, camera.ray(320.0, 215.0), 2.0);
    HessianNormalForm { normal: normal.into(), distance }
}

fn vector(plane: &HessianNormalForm) -> Vector4<f64> {
    let [x, y, z] = plane.normal;
    Vector4::new(x, y, z, plane.distance)
}

#[test]
fn metric_covariances_match_finite_differences() {
    let mut random = Random(30);
    for case in 0..200 {
        let camera = camera(&mut random);
        let truth = slanted_plane(&mut random, &camera);
        let fit = noisy_fit(&mut random, &truth, &camera, 1e-3);
        let abc = fit.covariance();
        let derivative = |k: usize| {
            let step = 1e-4 * abc[k][k].sqrt();
            let moved = |sign: f64| {
                let mut coefficients = fit.abc;
                coefficients[k] += sign * step;
                vector(&HessianNormalForm::from_inverse_depth(coefficients, &camera).unwrap())
            };
            (moved(1.0) - moved(-1.0)) / (2.0 * step)
        };
        let jacobian = SMatrix::<f64, 4, 3>::from_columns(&[derivative(0), derivative(1), derivative(2)]);
        // So little that the second order does not count.
        let little = abc.map(|row| row.map(|x| 1e-8 * x));
        let expected = jacobian * Matrix3::from_fn(|i, j| little[i][j]) * jacobian.transpose();
        let given = metric_covariance(fit.abc, &little, &camera);
        for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
            let tolerance = 1e-5 * expected.trace();
            assert_near(given[i][j], expected[(i, j)], tolerance, &format!("case {case} [{i}][{j}]"));
            assert_eq!(given[i][j].to_bits(), given[j][i].to_bits());
        }
    }
}

#[test]
fn metric_covariances_predict_the_scatter_of_fits() {
    let mut random = Random(31);
    let draws = 2000;
    for noise in [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2] {
        let camera = camera(&mut random);
        let truth = slanted_plane(&mut random, &camera);
        let mut sum = 0.0;
        for _ in 0..draws {
            let fit = noisy_fit(&mut random, &truth, &camera, noise);
            let error = vector(&hessian_normal_form(&fit, &camera).unwrap()) - vector(&truth);
            let covariance = metric_covariance(fit.abc, &fit.covariance(), &camera);
            let covariance = Matrix4::from_fn(|i, j| covariance[i][j]);
            // A unit normal has two degrees of freedom, so the 4 x 4 matrix has rank 3.
            let values = covariance.symmetric_eigenvalues();
            let rank = values.iter().filter(|&&value| value > 1e-9 * values.max()).count();
            assert_eq!(rank, 3, "{values}");
            let information = covariance.pseudo_inverse(1e-9 * values.max()).unwrap();
            sum += error.dot(&(information * error));
        }
        let mean = sum / f64::from(draws);
        println!("normalised squared error {mean:.2} at noise {noise}");
        assert!((mean - 3.0).abs() < 0.3, "normalised squared error {mean} instead of 3 at noise {noise}");
    }
}

#[test]
fn what_smooth_error_does_to_a_plane_is_what_its_correlation_says() {
    let (length, step) = (64.0, 4.0);
    for [width, height] in [[24, 16], [64, 64], [200, 100], [400, 40]] {
        let nodes: Vec<[f64; 2]> = (0..width / 4 * (height / 4))
            .map(|k| [k % (width / 4), k / (width / 4)].map(|at| (f64::from(at) + 0.5) * step))
            .collect();
        let mut sums = Moments::default();
        nodes.iter().for_each(|[u, v]| sums.add(*u, *v, 0.0));
        let fit = sums.fit().unwrap();
        let (given, left) = fit.covariance_by_smooth(1.0, length);
        // A Gaussian correlation of that integral, pair by pair.
        let middle = [f64::from(width) / 2.0, f64::from(height) / 2.0];
        let share = |pixels: u32| f64::from(pixels * pixels) / 12.0 * (1.0 - 16.0 / f64::from(pixels * pixels));
        let (mut a, mut b, mut mean) = (0.0, 0.0, 0.0);
        for [u, v] in &nodes {
            for [x, y] in &nodes {
                let apart = (u - x).powi(2) + (v - y).powi(2);
                let correlation =
                    (-std::f64::consts::PI * apart / (length * length)).exp() / (nodes.len() as f64).powi(2);
                a += correlation * (u - middle[0]) * (x - middle[0]) / share(width).powi(2);
                b += correlation * (v - middle[1]) * (y - middle[1]) / share(height).powi(2);
                mean += correlation;
            }
        }
        let [row, column, one] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [middle[0], middle[1], 1.0]];
        let variance =
            |by: [f64; 3]| -> f64 { (0..3).map(|i| (0..3).map(|j| by[i] * given[i][j] * by[j]).sum::<f64>()).sum() };
        for (given, expected) in [(variance(row), a), (variance(column), b), (variance(one), mean)] {
            assert!((given / expected - 1.0).abs() < 0.2, "{width} x {height}: {given} instead of {expected}");
        }
        let kept = 1.0 - mean - a * share(width) - b * share(height);
        assert!((left - kept).abs() < 0.1, "{width} x {height}: {left} left instead of {kept}");
    }
}

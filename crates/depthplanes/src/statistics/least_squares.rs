//! Running sums and the least-squares plane, shared by everything that fits one.
//!
//! In: points (u, v, q), q being any value that is affine over a plane: disparity, inverse depth, or
//! the map's own value. Out: `q = a u + b v + c` with its residual and its covariance. Sums are kept
//! about an origin near the points, so that no digits are lost far from the image's corner; adding
//! two sums is fitting the union.

use crate::camera::{HessianNormalForm, Intrinsics, ray_coefficients};

/// Sums over points (u, v, q) relative to an origin of the owner's choice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Points.
    pub n: f64,
    /// Sum of u.
    pub u: f64,
    /// Sum of v.
    pub v: f64,
    /// Sum of q.
    pub q: f64,
    /// Sum of u u.
    pub uu: f64,
    /// Sum of u v.
    pub uv: f64,
    /// Sum of v v.
    pub vv: f64,
    /// Sum of u q.
    pub uq: f64,
    /// Sum of v q.
    pub vq: f64,
    /// Sum of q q.
    pub qq: f64,
}

impl Moments {
    /// Adds one point.
    #[inline]
    pub fn add(&mut self, u: f64, v: f64, q: f64) {
        self.n += 1.0;
        self.u += u;
        self.v += v;
        self.q += q;
        self.uu += u * u;
        self.uv += u * v;
        self.vv += v * v;
        self.uq += u * q;
        self.vq += v * q;
        self.qq += q * q;
    }

    /// Adds where the pixels of a run lie: columns `u, u + 1, ..`, row `v`; not their values.
    #[inline(always)]
    pub fn add_places(&mut self, u: f64, v: f64, count: usize) {
        let n = count as f64;
        let sum_k = n * (n - 1.0) / 2.0;
        let sum_kk = sum_k * (2.0 * n - 1.0) / 3.0;
        let sum_u = n * u + sum_k;
        self.n += n;
        self.u += sum_u;
        self.v += n * v;
        self.uu += u * (n * u + 2.0 * sum_k) + sum_kk;
        self.uv += v * sum_u;
        self.vv += n * v * v;
    }

    /// These sums with the values that were summed beside them.
    pub fn with(mut self, values: &ValueSums) -> Self {
        [self.q, self.uq, self.vq, self.qq] = values.lanes.map(|lanes| lanes.iter().sum());
        self
    }

    /// Adds the sums of other points about the same origin.
    #[inline]
    pub fn merge(&mut self, other: &Moments) {
        self.n += other.n;
        self.u += other.u;
        self.v += other.v;
        self.q += other.q;
        self.uu += other.uu;
        self.uv += other.uv;
        self.vv += other.vv;
        self.uq += other.uq;
        self.vq += other.vq;
        self.qq += other.qq;
    }

    /// Takes away the sums of some of the points about the same origin.
    #[inline]
    pub fn remove(&mut self, other: &Moments) {
        self.n -= other.n;
        self.u -= other.u;
        self.v -= other.v;
        self.q -= other.q;
        self.uu -= other.uu;
        self.uv -= other.uv;
        self.vv -= other.vv;
        self.uq -= other.uq;
        self.vq -= other.vq;
        self.qq -= other.qq;
    }

    /// The sums of the same points about an origin that lies (du, dv, dq) before this one.
    #[inline]
    pub fn moved(&self, [du, dv, dq]: [f64; 3]) -> Moments {
        let Moments { n, u, v, q, uu, uv, vv, uq, vq, qq } = *self;
        Moments {
            n,
            u: u + n * du,
            v: v + n * dv,
            q: q + n * dq,
            uu: uu + du * (2.0 * u + n * du),
            uv: uv + du * v + dv * u + n * du * dv,
            vv: vv + dv * (2.0 * v + n * dv),
            uq: uq + du * q + dq * u + n * du * dq,
            vq: vq + dv * q + dq * v + n * dv * dq,
            qq: qq + dq * (2.0 * q + n * dq),
        }
    }

    /// Sum of the squared residuals of the points about `q = a u + b v + c`.
    #[inline]
    pub fn squares_about(&self, [a, b, c]: [f64; 3]) -> f64 {
        let Moments { n, u, v, q, uu, uv, vv, uq, vq, qq } = *self;
        let linear = a * (a * uu - 2.0 * uq + 2.0 * (b * uv + c * u)) + b * (b * vv - 2.0 * vq + 2.0 * c * v);
        (qq + linear + c * (c * n - 2.0 * q)).max(0.0)
    }

    /// The least-squares plane about the same origin; `None` if the points lie on a line.
    #[inline(always)] // what of it is not asked for is not computed
    pub fn fit(&self) -> Option<AffineFit> {
        let n = self.n;
        let central = |product: f64, x: f64, y: f64| product - x * y / n;
        let (uu, uv, vv) =
            (central(self.uu, self.u, self.u), central(self.uv, self.u, self.v), central(self.vv, self.v, self.v));
        let (uq, vq, qq) =
            (central(self.uq, self.u, self.q), central(self.vq, self.v, self.q), central(self.qq, self.q, self.q));
        let det = uu * vv - uv * uv;
        // Three pixels that are not on a line span a determinant of 1/3 and more.
        if n < 3.0 || det <= 1e-9 * uu * vv {
            return None;
        }
        let (a, b) = ((vv * uq - uv * vq) / det, (uu * vq - uv * uq) / det);
        let c = (self.q - a * self.u - b * self.v) / n;
        let squares = (qq - a * uq - b * vq).max(0.0);
        let inverse = [[vv / det, -uv / det], [-uv / det, uu / det]];
        Some(AffineFit { abc: [a, b, c], n, rms: (squares / n).sqrt(), mean: [self.u / n, self.v / n], inverse })
    }
}

/// Values that are summed side by side; the same number on every processor, so that all round alike.
pub(crate) const LANES: usize = 8;
/// One number for each of them.
pub(crate) type Lanes = [f64; LANES];

/// Sums over the values of points whose places are summed elsewhere ([`Moments::add_places`]).
#[derive(Clone, Copy, Debug, Default)]
pub struct ValueSums {
    /// Of q, u q, v q, q q.
    lanes: [Lanes; 4],
}

impl ValueSums {
    /// Adds a run of pixels of one row: columns `u, u + 1, ..`, row `v`, each value turned into q.
    #[inline(always)]
    pub fn add<T: Copy>(&mut self, u: f64, v: f64, values: &[T], q: impl Fn(T) -> f64) {
        let [mut sum, mut sum_k, mut squares] = [[0.0; LANES]; 3];
        in_lanes(
            values,
            |_, value| q(value),
            #[inline(always)]
            |k, q| {
                for lane in 0..LANES {
                    sum[lane] += q[lane];
                    sum_k[lane] += k[lane] * q[lane];
                    squares[lane] += q[lane] * q[lane];
                }
            },
        );
        let [of_q, of_uq, of_vq, of_qq] = &mut self.lanes;
        for lane in 0..LANES {
            of_q[lane] += sum[lane];
            of_uq[lane] += u * sum[lane] + sum_k[lane];
            of_vq[lane] += v * sum[lane];
            of_qq[lane] += squares[lane];
        }
    }
}

/// Turns the values of a run into q, which may depend on a value's number k, and calls `visit` with the numbers and q
/// of [`LANES`] at a time, 0 for lanes without a value.
#[inline(always)]
pub(crate) fn in_lanes<T: Copy>(values: &[T], q: impl Fn(f64, T) -> f64, mut visit: impl FnMut(&Lanes, &Lanes)) {
    let (groups, rest) = values.as_chunks::<LANES>();
    let mut k = NUMBERS;
    for group in groups {
        let mut lanes = [0.0; LANES];
        for lane in 0..LANES {
            lanes[lane] = q(k[lane], group[lane]);
        }
        visit(&k, &lanes);
        for lane in 0..LANES {
            k[lane] += LANES as f64;
        }
    }
    if rest.is_empty() {
        return;
    }
    let mut lanes = [0.0; LANES];
    if let Some(last) = values.last_chunk::<LANES>() {
        // The rest is read as the end of the last [`LANES`] values, of which the first ones have been visited.
        let (first, done) = ((values.len() - LANES) as f64, (values.len() - rest.len()) as f64);
        for lane in 0..LANES {
            k[lane] = first + NUMBERS[lane];
            let of_last = q(k[lane], last[lane]);
            lanes[lane] = if k[lane] < done { 0.0 } else { of_last };
        }
    } else {
        for (lane, &value) in rest.iter().enumerate() {
            lanes[lane] = q(k[lane], value);
        }
    }
    visit(&k, &lanes);
}

/// 0, 1, .. 7.
const NUMBERS: Lanes = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Nodes in standard deviations and weights of Gauss's rule for a uniform distribution.
const GAUSS: [(f64, f64); 3] =
    [(-1.341_640_786_499_874, 5.0 / 18.0), (0.0, 8.0 / 18.0), (1.341_640_786_499_874, 5.0 / 18.0)];

/// `q = a u + b v + c`, least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineFit {
    /// The coefficients (a, b, c).
    pub abc: [f64; 3],
    /// Points.
    pub n: f64,
    /// Root mean square residual in q.
    pub rms: f64,
    /// Mean (u, v).
    mean: [f64; 2],
    /// Inverse of the centred 2x2 normal matrix.
    inverse: [[f64; 2]; 2],
}

impl AffineFit {
    /// The same plane about another origin: `u = u' - du` and so on, for sums that were taken
    /// relative to (du, dv, dq).
    pub fn moved(mut self, [du, dv, dq]: [f64; 3]) -> Self {
        self.abc[2] += dq - self.abc[0] * du - self.abc[1] * dv;
        self.mean = [self.mean[0] + du, self.mean[1] + dv];
        self
    }

    /// The plane of other values `q' = slope q + offset` at the same points.
    pub fn scaled(mut self, slope: f64, offset: f64) -> Self {
        self.abc = self.abc.map(|x| x * slope);
        self.abc[2] += offset;
        self.rms *= slope.abs();
        self
    }

    /// Value at a pixel.
    #[inline(always)]
    pub fn at(&self, u: f64, v: f64) -> f64 {
        self.abc[0] * u + self.abc[1] * v + self.abc[2]
    }

    /// Variance of the residuals, with n - 3 degrees of freedom; 0 for three points, which leave no residual.
    pub fn variance(&self) -> f64 {
        if self.n > 3.0 { self.rms * self.rms * self.n / (self.n - 3.0) } else { 0.0 }
    }

    /// Covariance of (a, b, c) by the residuals: their variance times the inverse normal matrix, as if all points were
    /// equally good.
    pub fn covariance(&self) -> [[f64; 3]; 3] {
        let variance = self.variance();
        let [[uu, uv], [_, vv]] = self.inverse.map(|row| row.map(|x| x * variance));
        self.about_origin([[uu, uv, 0.0], [uv, vv, 0.0], [0.0, 0.0, variance / self.n]])
    }

    /// Covariance of (a, b, c) by what is known of the points' errors, and the mean of their variances, which
    /// `variance` gives for a q: `(A^T A)^-1 A^T S A (A^T A)^-1`, A being the rows (u, v, 1) and S the variances.
    ///
    /// `A^T S A` is taken over the parallelogram that has the points' number, mean and second moments, by Gauss's rule
    /// of three nodes each way: exact for a rectangle, near for others, and nothing has to be summed pixel by pixel.
    pub fn covariance_by(&self, variance: impl Fn(f64) -> f64) -> ([[f64; 3]; 3], f64) {
        let ([[p, q], [_, r]], [mean_u, mean_v]) = (self.inverse, self.mean);
        let [across, skew, down] = self.spread();
        let mut sums = [[0.0; 3]; 3];
        for (x, weight_x) in GAUSS {
            for (y, weight_y) in GAUSS {
                let (u, v) = (across * x, skew * x + down * y);
                let share = self.n * weight_x * weight_y * variance(self.at(mean_u + u, mean_v + v));
                let row = [u, v, 1.0];
                sums = std::array::from_fn(|i| std::array::from_fn(|j| sums[i][j] + share * row[i] * row[j]));
            }
        }
        let inverse = [[p, q, 0.0], [q, r, 0.0], [0.0, 0.0, self.n.recip()]];
        (self.about_origin(propagate(&inverse, &sums)), sums[2][2] / self.n)
    }

    /// Covariance of (a, b, c) by an error that neighbouring points share, with the given variance and correlated
    /// over `length` pixels (the integral of its correlation along a line); and how much of the variance the
    /// residuals show, since the plane takes up the rest.
    ///
    /// Along a side of l pixels, with r = l / length, the mean of such an error keeps the share `1 / sqrt(1 + r^2)`
    /// of its variance; its slope, in standard deviations of place, keeps `r^2 / (2 + r^2 + r^3)`: within 7 and 5 %
    /// of what a Gaussian correlation gives by integration. On long sides both become `1 / r`, one over the number of
    /// patches. On short ones the error is a constant with a slope of one deviation over `length / 2.5`. The sides
    /// are those of the parallelogram of [`AffineFit::covariance_by`].
    pub fn covariance_by_smooth(&self, variance: f64, length: f64) -> ([[f64; 3]; 3], f64) {
        let [across, skew, down] = self.spread();
        let shares = |spread: f64| {
            let r = 12.0f64.sqrt() * spread / length;
            [(1.0 + r * r).sqrt().recip(), r * r / (2.0 + r * r + r * r * r)]
        };
        let ([mean_x, slope_x], [mean_y, slope_y]) = (shares(across), shares(down));
        let shares = [slope_x * mean_y, mean_x * slope_y, mean_x * mean_y];
        let of_sides =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { variance * shares[i] } else { 0.0 }));
        let to_pixels = [[across.recip(), -skew / (across * down), 0.0], [0.0, down.recip(), 0.0], [0.0, 0.0, 1.0]];
        let left = variance * (1.0 - shares.iter().sum::<f64>()).max(0.0);
        (self.about_origin(propagate(&to_pixels, &of_sides)), left)
    }

    /// The Cholesky factor of the points' second moments, [u by u; v by u, v]: `u = across x`, `v = skew x + down y`.
    fn spread(&self) -> [f64; 3] {
        let [[p, q], [_, r]] = self.inverse;
        let scale = (self.n * (p * r - q * q)).recip();
        let across = (r * scale).sqrt();
        let skew = -q * scale / across;
        [across, skew, (p * scale - skew * skew).max(0.0).sqrt()]
    }

    /// Covariance of (a, b, c) from that of (a, b, value at the mean).
    fn about_origin(&self, covariance: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let [u, v] = self.mean;
        propagate(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-u, -v, 1.0]], &covariance)
    }
}

/// `J C J^T`, symmetric to the last bit; no variance is below 0 by rounding.
fn propagate<const N: usize>(jacobian: &[[f64; 3]; N], covariance: &[[f64; 3]; 3]) -> [[f64; N]; N] {
    let product = |i: usize, j: usize| -> f64 {
        (0..3).map(|k| (0..3).map(|l| jacobian[i][k] * covariance[k][l] * jacobian[j][l]).sum::<f64>()).sum()
    };
    let entry = |i: usize, j: usize| if i <= j { product(i, j) } else { product(j, i) };
    let mut all: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    (0..N).for_each(|i| all[i][i] = all[i][i].max(0.0));
    all
}

/// Covariance of (nx, ny, nz, distance) of the plane whose inverse depth (1/m) has the coefficients `abc` with that
/// covariance.
///
/// m, as in [`HessianNormalForm::from_inverse_depth`], is linear in (a, b, c). If it is off by s |m| along m and by t |m| across
/// it, the normal `-m / |m|` moves by `-t + s t` and the distance `1 / |m|` by `(-s + s^2 - t . t / 2) / |m|`, to
/// second order. The first order alone is not enough: a plane turns about its pixels, so that one combination of
/// normal and distance has hardly any error of first order, and all of its error is of second order where the normal
/// is not known to a fraction of a degree.
pub fn metric_covariance(abc: [f64; 3], covariance: &[[f64; 3]; 3], camera: &Intrinsics) -> [[f64; 4]; 4] {
    let m = ray_coefficients(abc, camera);
    let length = m.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along = m.map(|x| x / length);
    let [first, second] = across(along);
    // dm / d(a, b, c) is [[fx, 0, 0], [0, fy, 0], [cx, cy, 1]]; this is d(t, t, s) / d(a, b, c).
    let by_abc = [first, second, along].map(|[x, y, z]| {
        [x * camera.fx + z * camera.cx, y * camera.fy + z * camera.cy, z].map(|derivative| derivative / length)
    });
    let sigma = propagate(&by_abc, covariance);
    // The second order as quadratic forms of (t, t, s), and their second moments (Isserlis' theorem).
    let forms = [
        [[0.0, 0.0, 0.5], [0.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.5, 0.0]],
        [[-0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 1.0]],
    ];
    let moved = forms.map(|form| multiply(&form, &sigma));
    let trace = |x: &[[f64; 3]; 3]| x[0][0] + x[1][1] + x[2][2];
    let both = |i: usize, j: usize| {
        sigma[i][j] + trace(&moved[i]) * trace(&moved[j]) + 2.0 * trace(&multiply(&moved[i], &moved[j]))
    };
    let errors = std::array::from_fn(|i| std::array::from_fn(|j| both(i, j)));
    let axes = |k: usize| [first[k], second[k], 0.0];
    propagate(&[axes(0), axes(1), axes(2), [0.0, 0.0, length.recip()]], &errors)
}

/// Two unit vectors at right angles to a unit vector and to each other.
fn across([x, y, z]: [f64; 3]) -> [[f64; 3]; 2] {
    // Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017.
    let sign = 1.0f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), x * y * (-1.0 / (sign + z)));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

fn multiply(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The metric plane of an inverse-depth fit (1/m).
pub fn hessian_normal_form(fit: &AffineFit, camera: &Intrinsics) -> Option<HessianNormalForm> {
    HessianNormalForm::from_inverse_depth(fit.abc, camera)
}

//! Running sums and the least-squares plane, shared by everything that fits one.
//!
//! In: points (u, v, q), q being any value that is affine over a plane: disparity, inverse depth, or
//! the map's own value. Out: `q = a u + b v + c` with its residual and its covariance. Sums are kept
//! about an origin near the points, so that no digits are lost far from the image's corner; adding
//! two sums is fitting the union.

use crate::camera::{Hessian, Intrinsics, ray_coefficients};

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

    /// Adds a run of pixels of one row: columns `u, u + 1, ..`, row `v`, and the sums over k = 0, 1 ..
    /// of their values q_k.
    #[inline]
    pub fn add_run(&mut self, u: f64, v: f64, values: &RunSums) {
        let n = values.n;
        let sum_k = n * (n - 1.0) / 2.0;
        let sum_kk = sum_k * (2.0 * n - 1.0) / 3.0;
        let sum_u = n * u + sum_k;
        self.n += n;
        self.u += sum_u;
        self.v += n * v;
        self.q += values.q;
        self.uu += u * (n * u + 2.0 * sum_k) + sum_kk;
        self.uv += v * sum_u;
        self.vv += n * v * v;
        self.uq += u * values.q + values.kq;
        self.vq += v * values.q;
        self.qq += values.qq;
    }

    /// Adds the sums of other points about the same origin.
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

    /// The least-squares plane about the same origin; `None` if the points lie on a line.
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

/// Sums over one run's values, k counting from 0 at its first pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunSums {
    /// Pixels.
    pub n: f64,
    /// Sum of q_k.
    pub q: f64,
    /// Sum of k q_k.
    pub kq: f64,
    /// Sum of q_k q_k.
    pub qq: f64,
}

impl RunSums {
    /// Sums of a run's values.
    #[inline]
    pub fn of<T: Copy>(values: &[T], q: impl Fn(T) -> f64) -> Self {
        let [q, kq, qq] = sum_terms(values, |k, value| {
            let q = q(value);
            [q, k * q, q * q]
        });
        RunSums { n: values.len() as f64, q, kq, qq }
    }
}

/// Lanes that the sums of long runs are spread over, always the same, so that every processor rounds
/// alike.
const LANES: usize = 8;

/// Sums of some terms over a run's values, each with its number k = 0, 1 ..
#[inline(always)]
pub(crate) fn sum_terms<T: Copy, const N: usize>(values: &[T], terms: impl Fn(f64, T) -> [f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    let blocks = values.chunks_exact(LANES);
    let rest = blocks.remainder();
    if values.len() >= LANES {
        let mut lanes = [[0.0; LANES]; N];
        let mut first = 0.0;
        for block in blocks {
            for lane in 0..LANES {
                let terms = terms(first + lane as f64, block[lane]);
                (0..N).for_each(|n| lanes[n][lane] += terms[n]);
            }
            first += LANES as f64;
        }
        sums = lanes.map(|lanes| lanes.iter().sum());
    }
    let mut k = (values.len() - rest.len()) as f64;
    for &value in rest {
        let terms = terms(k, value);
        (0..N).for_each(|n| sums[n] += terms[n]);
        k += 1.0;
    }
    sums
}

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

    /// The same plane of other values: `q' = slope q + offset`.
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

    /// Covariance of (a, b, c): the residual variance (n - 3 degrees of freedom) times the inverse
    /// normal matrix. All 0 for three points, which leave no residual.
    pub fn covariance(&self) -> [[f64; 3]; 3] {
        let variance = if self.n > 3.0 { self.rms * self.rms * self.n / (self.n - 3.0) } else { 0.0 };
        let ([[uu, uv], [_, vv]], [u, v]) = (self.inverse, self.mean);
        let (cu, cv) = (-(uu * u + uv * v), -(uv * u + vv * v));
        let cc = 1.0 / self.n - cu * u - cv * v;
        [[uu, uv, cu], [uv, vv, cv], [cu, cv, cc]].map(|row| row.map(|x| x * variance))
    }
}

/// Covariance of (nx, ny, nz, distance) of the plane whose inverse depth is `fit` (1/m).
///
/// With m as in [`Hessian::from_inverse_depth`], m^ = m/|m|: dn = -(I - m^ m^T) dm / |m| and
/// d(distance) = -m^ . dm / |m|^2; m is linear in (a, b, c). Of first order: it understates the scatter
/// of small patches in strong noise.
pub fn metric_covariance(fit: &AffineFit, camera: &Intrinsics) -> [[f64; 4]; 4] {
    let m = ray_coefficients(fit.abc, camera);
    let length = m.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = m.map(|x| x / length);
    // Rows: d(nx, ny, nz, distance) / dm.
    let mut by_m = [[0.0; 3]; 4];
    for i in 0..3 {
        for j in 0..3 {
            by_m[i][j] = (unit[i] * unit[j] - if i == j { 1.0 } else { 0.0 }) / length;
        }
        by_m[3][i] = -unit[i] / (length * length);
    }
    // dm / d(a, b, c) is [[fx, 0, 0], [0, fy, 0], [cx, cy, 1]].
    let jacobian = by_m.map(|[x, y, z]| [x * camera.fx + z * camera.cx, y * camera.fy + z * camera.cy, z]);
    let abc = fit.covariance();
    let product = |i: usize, j: usize| -> f64 {
        (0..3).map(|k| (0..3).map(|l| jacobian[i][k] * abc[k][l] * jacobian[j][l]).sum::<f64>()).sum()
    };
    std::array::from_fn(|i| std::array::from_fn(|j| if i <= j { product(i, j) } else { product(j, i) }))
}

/// The metric plane of an inverse-depth fit (1/m).
pub fn hessian(fit: &AffineFit, camera: &Intrinsics) -> Option<Hessian> {
    Hessian::from_inverse_depth(fit.abc, camera)
}

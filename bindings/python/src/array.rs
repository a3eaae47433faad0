//! Arrays of NumPy as maps.
//!
//! In: an array of two dimensions. Out: its pixels where they lie, if its type is one of the library's and the pixels of a row
//! follow each other; crops of larger arrays do. All else is copied once.

use crate::error::{Error, Result};
use depthplanes::{AnyView, DepthView, Pixel, Sensor, ValueKind, with_view};
use depthplanes_io::{Frame, Pixels, ReadOptions, formats, frame_of_samples};
use numpy::ndarray::{Array2, ArrayView2};
use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// An array that is borrowed from Python.
pub(crate) enum Borrowed<'py> {
    U8(PyReadonlyArray2<'py, u8>),
    U16(PyReadonlyArray2<'py, u16>),
    F32(PyReadonlyArray2<'py, f32>),
    /// Of a type that is none of the library's: it is converted as files are.
    Other(Bound<'py, PyUntypedArray>),
}

/// The array as a map, and what of it is borrowed: itself, or a copy whose rows are in order.
///
/// # Errors
/// [`Error::Input`] for another number of dimensions.
pub(crate) fn borrow<'py>(array: &Bound<'py, PyAny>) -> Result<(Bound<'py, PyAny>, Borrowed<'py>)> {
    let untyped = array.cast::<PyUntypedArray>().map_err(PyErr::from)?;
    if untyped.ndim() != 2 {
        let shape = array.getattr(intern!(array.py(), "shape"))?;
        return Err(Error::Input(format!(
            "depth is an array of the shape {shape}; accepted: a map of two dimensions, (height, width)"
        )));
    }
    if let Some(map) = typed(array) {
        if map.pixels().is_some() {
            return Ok((array.clone(), map));
        }
        // A method of every array, which copies what is in order but not aligned, too.
        let copy = array.call_method1(intern!(array.py(), "copy"), ("C",))?;
        return match typed(&copy).filter(|map| map.pixels().is_some()) {
            Some(map) => Ok((copy, map)),
            None => {
                Err(Error::Type("depth is an array whose copy is not in order; accepted: an array of NumPy".into()))
            }
        };
    }
    Ok((array.clone(), Borrowed::Other(untyped.clone())))
}

fn typed<'py>(array: &Bound<'py, PyAny>) -> Option<Borrowed<'py>> {
    fn of<'py, T: Element>(array: &Bound<'py, PyAny>) -> Option<PyReadonlyArray2<'py, T>> {
        array.cast::<PyArray2<T>>().ok()?.try_readonly().ok()
    }
    let wide = || of(array).map(Borrowed::U16).or_else(|| of(array).map(Borrowed::F32));
    wide().or_else(|| of(array).map(Borrowed::U8))
}

impl Borrowed<'_> {
    /// The pixels where they lie; `None` if they do not lie as those of a map, or are of another type.
    pub(crate) fn pixels(&self) -> Option<depthplanes::Result<AnyView<'_>>> {
        match self {
            Borrowed::U8(array) => in_place(array),
            Borrowed::U16(array) => in_place(array),
            Borrowed::F32(array) => in_place(array),
            Borrowed::Other(_) => None,
        }
    }

    /// The frame of a copy, read as files are.
    ///
    /// # Errors
    /// [`Error::Type`] for a type that is no number of a map, and those of the readers.
    pub(crate) fn frame(&self, py: Python<'_>, options: &ReadOptions) -> Result<Frame> {
        match (self.pixels().transpose()?, self) {
            (Some(AnyView::U8(map)), _) => of_rows(&map, "uint8", |value| [value], options),
            (Some(AnyView::U16(map)), _) => of_rows(&map, "uint16", u16::to_le_bytes, options),
            (Some(AnyView::F32(map)), _) => of_rows(&map, "float32", f32::to_le_bytes, options),
            (None, Borrowed::Other(array)) => of_other(py, array, options),
            (None, _) => unreachable!("arrays that are not in order were copied"),
        }
    }
}

/// A map over an array's own memory.
fn in_place<'a, T: Pixel + Element>(array: &'a PyReadonlyArray2<'_, T>) -> Option<depthplanes::Result<AnyView<'a>>> {
    let [height, width] = [array.shape()[0], array.shape()[1]];
    if height == 0 || width == 0 {
        return Some(Err(depthplanes::Error::Size { width, height }));
    }
    let size = size_of::<T>() as isize;
    let [down, right] = [array.strides()[0], array.strides()[1]];
    let stride = if height == 1 { width } else { usize::try_from(down / size).ok()? };
    let is_in_order = (width == 1 || right == size) && (height == 1 || down % size == 0) && stride >= width;
    let start = array.data();
    if !is_in_order || !start.is_aligned() {
        return None;
    }
    // SAFETY: NumPy's array has pixels from `start` on, aligned, `width` of them side by side in each of `height` rows that
    // begin `stride` apart; what lies between two rows belongs to the same memory. The array is borrowed for `'a` and not
    // written to by Rust; the documentation asks the same of Python's threads, and any bits are a valid number.
    let pixels = unsafe { std::slice::from_raw_parts(start, (height - 1) * stride + width) };
    Some(DepthView::with_stride(pixels, width, height, stride).map(Into::into))
}

fn of_rows<T: Pixel, const N: usize>(
    map: &DepthView<'_, T>,
    sample: &str,
    bytes: impl Fn(T) -> [u8; N],
    options: &ReadOptions,
) -> Result<Frame> {
    let samples: Vec<u8> = map.rows().flatten().flat_map(|&value| bytes(value)).collect();
    Ok(frame_of_samples(&samples, sample, (map.width(), map.height()), options)?)
}

fn of_other(py: Python<'_>, array: &Bound<'_, PyUntypedArray>, options: &ReadOptions) -> Result<Frame> {
    let code: String = array.dtype().getattr(intern!(py, "str"))?.extract()?;
    let name: String = array.dtype().getattr(intern!(py, "name"))?.extract()?;
    let sample = if code.starts_with('>') { format!("{name}-be") } else { name.clone() };
    if !formats::raw_types().any(|known| known == sample) {
        let accepted = "uint8, uint16, float32 and float64, and the other integers and floats of up to 64 bits";
        return Err(Error::Type(format!("depth is an array of {name}; accepted: {accepted}")));
    }
    let size = (array.shape()[1], array.shape()[0]);
    let bytes = array.call_method0(intern!(py, "tobytes"))?;
    let samples = bytes.cast::<PyBytes>().map_err(PyErr::from)?.as_bytes();
    py.detach(|| Ok(frame_of_samples(samples, &sample, size, options)?))
}

/// About how many pixels a fingerprint looks at.
const LOOKED_AT: usize = 256;

/// A number that tells whether a map was written to: of evenly spaced pixels (FNV-1a). Of 640 x 480 pixels it looks at one at least
/// in any square of 39 x 39.
pub(crate) fn fingerprint(map: AnyView<'_>) -> u64 {
    fn of<T: Pixel>(map: &DepthView<'_, T>) -> u64 {
        let step = (map.area() / LOOKED_AT).max(1);
        // From row to row by the golden section of that, which leaves no wide gaps.
        let shift = step * 618 / 1000;
        let (mut hash, mut first) = (0xcbf2_9ce4_8422_2325_u64, 0);
        for row in map.rows() {
            // Sums alone: a remainder for each row would take as long as the pixels, which are no longer in the cache.
            let mut u = first;
            while u < row.len() {
                let value: f64 = row[u].into();
                hash = (hash ^ value.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
                u += step;
            }
            first += shift;
            if first >= step {
                first -= step;
            }
        }
        hash
    }
    with_view!(map, map => of(&map))
}

/// An array over memory that `owner` keeps; it cannot be written to.
pub(crate) fn lent<'py, T: Element>(
    owner: &Bound<'py, PyAny>,
    pixels: &[T],
    [height, width]: [usize; 2],
) -> PyResult<Bound<'py, PyAny>> {
    let view = ArrayView2::from_shape((height, width), pixels).expect("as many pixels as the size says");
    // SAFETY: the memory belongs to `owner`, which the array keeps alive, and which never changes it while it lives.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone()) }.into_any();
    array.getattr(intern!(array.py(), "flags"))?.setattr(intern!(array.py(), "writeable"), false)?;
    Ok(array)
}

/// The numbers of a frame as an array over its own memory, which `owner` keeps.
pub(crate) fn map_array<'py>(frame: &Frame, owner: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let size = [frame.height, frame.width];
    match &frame.pixels {
        Pixels::U8(pixels) => lent(owner, pixels, size),
        Pixels::U16(pixels) => lent(owner, pixels, size),
        Pixels::F32(pixels) => lent(owner, pixels, size),
    }
}

/// Depth in metres at each pixel, NaN where there is none.
///
/// # Errors
/// [`Error::Input`] for numbers that are not metric.
pub(crate) fn depth_m<'py>(py: Python<'py>, map: AnyView<'_>, sensor: &Sensor) -> Result<Bound<'py, PyArray2<f32>>> {
    if sensor.value_kind == ValueKind::Disparity {
        return Err(depthplanes::Error::NotMetric { wants: "depth_m", is_disparity: true }.into());
    }
    let kind = sensor.value_kind;
    let metres: Vec<f32> = with_view!(map, map => {
        let valid = map.validity();
        let depth = |&value: &_| {
            let depth = valid.holds(value).then(|| kind.depth_m(f64::from(value))).flatten();
            depth.map_or(f32::NAN, |depth| depth as f32)
        };
        map.rows().flatten().map(depth).collect()
    });
    let metres = Array2::from_shape_vec((map.height(), map.width()), metres).expect("a number for each pixel");
    Ok(PyArray2::from_owned_array(py, metres))
}

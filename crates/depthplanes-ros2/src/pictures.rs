//! Images in which pixels say what they are of.

use crate::messages::{Header, Image};

/// `mono16`: the id of each pixel's plane; 0 where there is none.
pub(crate) fn labels(labels: &[u16], [width, height]: [usize; 2], header: &Header) -> Image {
    let mut data = vec![0; 2 * labels.len()];
    for (pair, label) in data.as_chunks_mut::<2>().0.iter_mut().zip(labels) {
        *pair = label.to_le_bytes();
    }
    image("mono16", 2, data, [width, height], header)
}

/// `mono8`: what each pixel is by its height above the floor ([`depthplanes::ground::marks`]); all 0 without a floor.
pub(crate) fn marks(marks: &[u8], [width, height]: [usize; 2], header: &Header) -> Image {
    let data = if marks.is_empty() { vec![0; width * height] } else { marks.to_vec() };
    image("mono8", 1, data, [width, height], header)
}

fn image(encoding: &str, bytes: usize, data: Vec<u8>, [width, height]: [usize; 2], header: &Header) -> Image {
    Image {
        header: header.clone(),
        height: height as u32,
        width: width as u32,
        encoding: encoding.into(),
        is_bigendian: 0,
        step: (bytes * width) as u32,
        data,
    }
}

//! A colour picture to draw on.

/// 8-bit sRGB pixels, row by row, top row first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A picture of one colour.
    pub(super) fn filled(width: usize, height: usize, colour: [u8; 3]) -> Self {
        Picture { width, height, pixels: vec![colour; width * height] }
    }

    /// Sets a pixel; outside the picture nothing happens.
    pub(super) fn set(&mut self, u: usize, v: usize, colour: [u8; 3]) {
        if u < self.width && v < self.height {
            self.pixels[v * self.width + u] = colour;
        }
    }

    /// Fills a rectangle, cut off at the picture's edges.
    pub(super) fn fill(&mut self, [u, v]: [usize; 2], [width, height]: [usize; 2], colour: [u8; 3]) {
        for v in v..v + height {
            for u in u..u + width {
                self.set(u, v, colour);
            }
        }
    }

    /// Copies another picture in, its top left corner at (u, v).
    pub(super) fn paste(&mut self, other: &Picture, [u, v]: [usize; 2]) {
        for (row, pixels) in other.pixels.chunks_exact(other.width).enumerate() {
            let start = (v + row) * self.width + u;
            self.pixels[start..start + other.width].copy_from_slice(pixels);
        }
    }

    /// The picture as a PNG file.
    pub(super) fn png(&self) -> Vec<u8> {
        encode_png(self.width, self.height, png::ColorType::Rgb, png::BitDepth::Eight, self.pixels.as_flattened())
    }
}

/// A colour over another, `share` (0 to 1) of the upper.
pub(super) fn blend(below: [u8; 3], above: [u8; 3], share: f32) -> [u8; 3] {
    let mix = |below: u8, above: u8| (f32::from(below) * (1.0 - share) + f32::from(above) * share).round() as u8;
    [mix(below[0], above[0]), mix(below[1], above[1]), mix(below[2], above[2])]
}

/// A 16-bit grey PNG file, the usual home of labels and of depth in millimetres.
pub fn grey16_png(width: usize, height: usize, values: &[u16]) -> Vec<u8> {
    let samples: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
    encode_png(width, height, png::ColorType::Grayscale, png::BitDepth::Sixteen, &samples)
}

/// An 8-bit grey PNG file.
pub(super) fn grey8_png(width: usize, height: usize, values: &[u8]) -> Vec<u8> {
    encode_png(width, height, png::ColorType::Grayscale, png::BitDepth::Eight, values)
}

/// An 8-bit grey PGM file.
pub(super) fn grey8_pgm(width: usize, height: usize, values: &[u8]) -> Vec<u8> {
    [format!("P5\n{width} {height}\n255\n").as_bytes(), values].concat()
}

/// A PNG file of samples in PNG's own order (16-bit samples high byte first).
fn encode_png(width: usize, height: usize, colour: png::ColorType, depth: png::BitDepth, samples: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(samples));
    // Writing to memory fails only if the samples do not fill the stated size.
    written.expect("as many samples as pixels");
    bytes
}

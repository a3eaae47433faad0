//! Groups map after map on every kernel, for tests that compare the labels with other libraries'
//! (`tests/oracles`). One process serves thousands of maps and keeps its memory between them, so
//! what a map leaves behind is tested as well.
//!
//! All numbers are little-endian. At the start the worker writes one line of text: the names of this
//! processor's kernels, fastest first. Then it answers requests until standard input ends.
//!
//! | request | type | |
//! |---|---|---|
//! | pixel type | u32 | 1 = u8, 2 = u16, 4 = f32 |
//! | width, height | u32 each | pixels |
//! | threads | u32 | group on 1, 2 ... this many threads |
//! | min_pixels | u32 | a plane has more pixels than this |
//! | theta | f64 | map units |
//! | pixels | width * height of the type | row by row, top row first |
//!
//! | answer | type | |
//! |---|---|---|
//! | images | u32 | kernels * threads; 0 if the request was refused |
//! | labels | that many images of width * height u16 | kernel after kernel, of each one thread, two ... |
//! | or message | u32 bytes, then UTF-8 | why it was refused |
//!
//! A request whose parameters or result are refused (theta below 0, too many planes) is answered so
//! and the next one is read. After a header that does not tell how many bytes follow (unknown pixel
//! type, impossible size or thread count) or a request that breaks off, the worker ends with code 1.

use depthplanes::DepthView;
use depthplanes::internals::{Compiles, ConnectedComponents, Connectivity, Kernel, Selection, kernels};
use depthplanes::limits::{MAX_PIXELS, MAX_SIDE};
use std::error::Error;
use std::io::{self, BufReader, BufWriter, Read, Write};

const HEADER: usize = 28;
const MAX_THREADS: u32 = 64;

struct Request {
    bytes_per_pixel: u32,
    width: usize,
    height: usize,
    threads: u32,
    min_pixels: u32,
    theta: f64,
}

/// A kernel with the memory that it keeps from map to map.
struct Lane {
    grouper: ConnectedComponents,
    selection: Selection,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    writeln!(output, "{}", kernels().map(Kernel::name).collect::<Vec<_>>().join(" "))?;
    output.flush()?;
    let lane = |kernel| Lane { grouper: ConnectedComponents::with_kernel(kernel), selection: Selection::default() };
    let mut lanes: Vec<Lane> = kernels().map(lane).collect();
    while let Some(request) = read_request(&mut input)? {
        let bytes = read_pixels(&mut input, &request)?;
        let answer = match request.bytes_per_pixel {
            1 => label(&mut lanes, &request, &bytes),
            2 => label(&mut lanes, &request, &numbers(&bytes, u16::from_le_bytes)),
            _ => label(&mut lanes, &request, &numbers(&bytes, f32::from_le_bytes)),
        };
        match answer {
            Ok(images) => write_images(&mut output, &images)?,
            Err(refusal) => write_refusal(&mut output, &refusal.to_string())?,
        }
        output.flush()?;
    }
    Ok(())
}

/// The next header, checked as far as the size of what follows depends on it; `None` at the end.
fn read_request(input: &mut impl Read) -> Result<Option<Request>, Box<dyn Error>> {
    let mut header = Vec::with_capacity(HEADER);
    input.take(HEADER as u64).read_to_end(&mut header)?;
    if header.is_empty() {
        return Ok(None);
    }
    let Some((fields, theta)) = header.split_last_chunk::<8>().filter(|_| header.len() == HEADER) else {
        return Err(format!("a header has {HEADER} bytes; the input ends after {}", header.len()).into());
    };
    let [bytes_per_pixel, width, height, threads, min_pixels] = numbers(fields, u32::from_le_bytes)[..] else {
        unreachable!("20 bytes are 5 fields");
    };
    if ![1, 2, 4].contains(&bytes_per_pixel) {
        return Err(format!("pixel type {bytes_per_pixel}: 1, 2 or 4 is known").into());
    }
    let (width, height) = (width as usize, height as usize);
    let fits = |side| (1..=MAX_SIDE).contains(&side);
    if !fits(width) || !fits(height) || width * height > MAX_PIXELS {
        return Err(format!("a map of {width} x {height}").into());
    }
    if !(1..=MAX_THREADS).contains(&threads) {
        return Err(format!("{threads} threads: 1 to {MAX_THREADS} are accepted").into());
    }
    Ok(Some(Request { bytes_per_pixel, width, height, threads, min_pixels, theta: f64::from_le_bytes(*theta) }))
}

/// The request's pixels; memory grows with what arrives, not with what the header promises.
fn read_pixels(input: &mut impl Read, request: &Request) -> Result<Vec<u8>, Box<dyn Error>> {
    let expected = request.width * request.height * request.bytes_per_pixel as usize;
    let mut bytes = Vec::new();
    input.take(expected as u64).read_to_end(&mut bytes)?;
    if bytes.len() < expected {
        return Err(format!("a map has {expected} bytes; the input ends after {}", bytes.len()).into());
    }
    Ok(bytes)
}

fn numbers<T, const N: usize>(bytes: &[u8], read: fn([u8; N]) -> T) -> Vec<T> {
    bytes.as_chunks::<N>().0.iter().map(|&bytes| read(bytes)).collect()
}

/// The label image of every kernel and number of threads.
fn label<T: Compiles>(lanes: &mut [Lane], request: &Request, pixels: &[T]) -> depthplanes::Result<Vec<Vec<u16>>> {
    let map = DepthView::new(pixels, request.width, request.height)?;
    let rule = Connectivity::new(map.validity(), request.theta)?;
    let mut images = Vec::new();
    for Lane { grouper, selection } in lanes {
        for threads in 1..=request.threads {
            let groups = grouper.group(&map, &rule, threads as usize);
            selection.select(groups, request.min_pixels)?;
            let mut labels = vec![u16::MAX; map.area()]; // so that a pixel that is left out shows
            selection.paint(groups, &mut labels);
            images.push(labels);
        }
    }
    Ok(images)
}

fn write_images(output: &mut impl Write, images: &[Vec<u16>]) -> io::Result<()> {
    output.write_all(&(images.len() as u32).to_le_bytes())?;
    for image in images {
        let bytes: Vec<u8> = image.iter().flat_map(|label| label.to_le_bytes()).collect();
        output.write_all(&bytes)?;
    }
    Ok(())
}

fn write_refusal(output: &mut impl Write, message: &str) -> io::Result<()> {
    output.write_all(&0u32.to_le_bytes())?;
    output.write_all(&(message.len() as u32).to_le_bytes())?;
    output.write_all(message.as_bytes())
}

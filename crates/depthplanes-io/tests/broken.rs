//! Broken files: each gives a typed error, none panics, none makes the program take much memory.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use common::*;
use depthplanes_io::{Error, ReadOptions, decode};
use png::{BitDepth, ColorType};

/// Counts the bytes in use and the most there ever were.
struct Counting;

static IN_USE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
const MOST_BYTES: usize = 64 << 20;

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = IN_USE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(now, Ordering::Relaxed);
        // SAFETY: the caller keeps the contract.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps the contract.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

type Case = (String, Vec<u8>);

fn truncations() -> Vec<Case> {
    let mut files = valid_files();
    let rows: Vec<Vec<u8>> = (0..5).map(|_| vec![9; 7]).collect();
    files.push(("bmp", "8-bit", bmp(7, 5, 8, &grey_palette(), &rows)));
    let cuts = |length: usize| [0, 1, 9, length / 4, length / 2, length * 3 / 4, length * 7 / 8];
    let cut = |(name, kind, bytes): (&str, &str, Vec<u8>)| {
        cuts(bytes.len()).map(|end| (format!("{name} {kind} cut at {end}"), bytes[..end].to_vec()))
    };
    files.into_iter().flat_map(cut).collect()
}

fn case(name: &str, bytes: impl AsRef<[u8]>) -> Case {
    (name.to_string(), bytes.as_ref().to_vec())
}

/// Text headers, and what is wrong with them.
fn lying_texts() -> Vec<Case> {
    let texts = [
        "P5 0 5 255\n",
        "P5 5 0 255\n",
        "P5 99999 99999 255\n",
        "P5 65535 65535 65535\n",
        "P5 7 5 0\n",
        "P5 7 5 65536\n",
        "P5 7 5 70000\n",
        "P5 -7 5 255\n",
        "P5 7 5 255\nshort",
        "P5 x y z\n",
        "P5 7",
        "P5\n#",
        "P5 18446744073709551615 2 255\n",
        "P5 18446744073709551616 2 255\n",
        "P2 2 2 255 1 2 3",
        "P2 2 2 255 1 2 3 x",
        "P2 2 2 255 1 2 3 256",
        "P2 2 2 9 1 2 3 10",
        "P2 60000 2000 255 1 2",
        "P2 2 2 255 1 2 3 -4",
        "P3 1 1 255 1 2",
        "P3 1 1 255 1 2 3",
        "P6 2 2 255\n12345",
        "P7 2 2 255\n1234",
        "P1 2 2 1 0 1 0",
        "P4 8 1\n\x01",
        "Pf 0 5 -1\n",
        "Pf 5 5 0\n",
        "Pf 5 5 nan\n",
        "Pf 5 5 inf\n",
        "Pf 5 5 -1\nshort",
        "Pf 65535 2000 -1\n",
        "Pf a b c\n",
        "PF 2 2 -1\n0123456789",
        "Pf 5 5",
        "Pf 1e3 5 -1\n",
        "ply\nformat ascii 1.0\n",
        "hello world, no map",
        "VERSION 0.7\n",
        "VERSION 0.7\nDATA ascii\n",
        "# .PCD v0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1 2\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1\n2\n3\n4\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE U\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1\n2\n3\n4\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 2\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1\n2\n3\n4\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1\n2\n3\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1\n2\n3\nx\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 60000\nHEIGHT 2000\nDATA ascii\n1\n2\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 60000\nHEIGHT 2000\nDATA binary\n1234",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA zip\n1234",
        "# .PCD v0.7\nFIELDS z\nSIZE -4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1 2 3 4",
        "# .PCD v0.7\nFIELDS a z\nSIZE 99999999 4\nTYPE F F\nWIDTH 2\nHEIGHT 2\nDATA binary\n1234",
        "# .PCD v0.7\nFIELDS a z\nSIZE 4 4\nCOUNT 18446744073709551615 1\nTYPE F F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n1 2",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 4\nHEIGHT 1\nDATA ascii\n1\n2\n3\n4\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 0\nHEIGHT 0\nDATA ascii\n",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA binary_compressed\n\x01\0\0\0\x10\0\0\0",
        "# .PCD v0.7\nFIELDS z\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nDATA binary_compressed\n\x01\0\0\0\x10\0\0\0\0",
    ];
    texts.iter().map(|text| case(&text.escape_default().to_string(), text)).collect()
}

fn lying_arrays() -> Vec<Case> {
    let mut cases = Vec::new();
    for descr in ["<c8", "|b1", "<U4", "|O", "<u3", "<f16", "|V2", "", "<M8[ns]"] {
        cases.push(case(&format!("npy of dtype {descr}"), npy(descr, false, "(2, 2)", &[0; 64])));
    }
    for shape in [
        "()",
        "(4,)",
        "(2, 2, 3)",
        "(3, 2, 2)",
        "(0, 4)",
        "(4, 0)",
        "(65535, 2000)",
        "(99999, 99999)",
        "(-2, 2)",
        "(2, x)",
        "(18446744073709551615, 18446744073709551615)",
        "2, 2",
        "(2, 2",
        "(1, 2, 2, 2, 1)",
        "(18446744073709551615, 5, 7)",
        "(0, 5, 7)",
    ] {
        cases.push(case(&format!("npy of shape {shape}"), npy("<u2", false, shape, &[0; 6])));
    }
    let mut version = npy("<u2", false, "(2, 2)", &[0; 8]);
    version[6] = 9;
    cases.push(case("npy version 9", &version));
    cases.push(case("npy with a header of 4 GiB", b"\x93NUMPY\x02\x00\xff\xff\xff\xff{'descr'"));
    cases.push(case("npy without fields", b"\x93NUMPY\x01\x00\x02\x00{}"));
    let array = npy("|u1", false, "(2, 2)", &[1, 2, 3, 4]);
    let good = zip(&[("a.npy", array.clone())], true);
    let find = |magic: &[u8]| good.windows(4).position(|window| window == magic).unwrap();
    let mut edit = |name: &str, at: usize, bytes: &[u8]| {
        let mut bad = good.clone();
        bad[at..at + bytes.len()].copy_from_slice(bytes);
        cases.push(case(name, bad));
    };
    let (central, end) = (find(b"PK\x01\x02"), find(b"PK\x05\x06"));
    edit("npz with a wrong checksum", central + 16, &[1, 2, 3, 4]);
    edit("npz that promises 2 GiB", central + 24, &[0, 0, 0, 0x80]);
    edit("npz that promises 16 MiB", central + 24, &[0, 0, 0, 1]);
    edit("npz that promises less", central + 24, &[9, 0, 0, 0]);
    edit("npz above 4 GiB", central + 24, &[0xff; 4]);
    edit("npz encrypted", central + 8, &[1]);
    edit("npz packed by method 99", central + 10, &[99]);
    edit("npz with its member elsewhere", central + 42, &[7]);
    edit("npz with a long member", central + 20, &[0xff, 0xff, 0, 0]);
    edit("npz with a long name", central + 28, &[0xff, 0xff]);
    edit("npz with more entries", end + 10, &[5]);
    edit("npz with its directory elsewhere", end + 16, &[0xff, 0xff, 0xff, 0x7f]);
    edit("npz with damaged data", 40, &[0xff; 8]);
    cases.push(case("npz without members", zip(&[], false)));
    cases.push(case("npz without arrays", zip(&[("readme.txt", b"hi".to_vec())], false)));
    cases.push(case("npz with two maps", zip(&[("a.npy", array.clone()), ("b.npy", array)], false)));
    cases.push(case("npz of a list", zip(&[("a.npy", npy("|u1", false, "(4,)", &[1; 4]))], false)));
    cases.push(case("npz whose array is text", zip(&[("a.npy", b"text".to_vec())], true)));
    cases
}

/// A PNG of stated size whose data are whatever is given; its checksums are right.
fn raw_png(width: u32, height: u32, depth: u8, color: u8, data: &[u8]) -> Vec<u8> {
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, color, 0, 0, 0]].concat();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, body) in [(b"IHDR", header.as_slice()), (b"IDAT", data), (b"IEND", &[])] {
        file.extend((body.len() as u32).to_be_bytes());
        file.extend(kind);
        file.extend(body);
        let mut crc = flate2::Crc::new();
        crc.update(kind);
        crc.update(body);
        file.extend(crc.sum().to_be_bytes());
    }
    file
}

fn lying_pictures() -> Vec<Case> {
    let mut cases = Vec::new();
    for (width, height, depth, color) in [
        (0, 5, 8, 0),
        (5, 0, 8, 0),
        (1 << 31, 5, 8, 0),
        (60_000, 60_000, 16, 0),
        (60_000, 2_000, 16, 6),
        (7, 5, 3, 0),
        (7, 5, 8, 3),
        (7, 5, 8, 9),
        (7, 5, 16, 0),
        (70_000, 1, 8, 0),
    ] {
        let name = format!("png of {width} x {height}, depth {depth}, colour {color}");
        cases.push((name, raw_png(width, height, depth, color, b"\x78\x9c\x03\0\0\0\0\x01")));
    }
    let halves: Vec<u8> = (0..35u8).flat_map(|at| [at, at ^ 0x55, 255 - at]).collect();
    cases.push(case("png of spread bytes", png(7, 5, ColorType::Rgb, BitDepth::Eight, &halves)));
    cases.push(case("png of noise", raw_png(7, 5, 16, 0, &[0x55; 40])));
    cases.push(case("png colourised", png(1, 1, ColorType::Rgb, BitDepth::Eight, &[1, 2, 3])));
    let rows: Vec<Vec<u8>> = (0..5).map(|_| vec![9; 7]).collect();
    let good = bmp(7, 5, 8, &grey_palette(), &rows);
    let mut edit = |name: &str, at: usize, bytes: &[u8]| {
        let mut bad = good.clone();
        bad[at..at + bytes.len()].copy_from_slice(bytes);
        cases.push(case(name, bad));
    };
    edit("bmp with run lengths", 30, &[1]);
    edit("bmp of 16 bits", 28, &[16]);
    edit("bmp of no bits", 28, &[0]);
    edit("bmp without columns", 18, &[0; 4]);
    edit("bmp of negative width", 18, &[0xff; 4]);
    edit("bmp of 2^31 rows", 22, &[0, 0, 0, 0x80]);
    edit("bmp of 60000 x 2000", 18, &[0x60, 0xea, 0, 0, 0xd0, 7, 0, 0]);
    edit("bmp with pixels elsewhere", 10, &[0xff; 4]);
    edit("bmp with a short palette", 46, &[3, 0]);
    edit("bmp with a long header", 14, &[124]);
    cases.extend(rvl_and_lzf());
    cases
}

fn rvl_and_lzf() -> Vec<Case> {
    let words = depthplanes_io::formats::rvl::pack(&depth());
    let sized =
        |width: u32, height: u32, words: &[u8]| [&width.to_le_bytes()[..], &height.to_le_bytes(), words].concat();
    let packed = lzf(&bytes_le(&depth()));
    vec![
        case("rvl with more rows", sized(7, 6, &words)),
        case("rvl without columns", sized(0, 5, &words)),
        case("rvl of 60000 x 60000", sized(60_000, 60_000, &words)),
        case("rvl of 16000 x 16000", sized(16_000, 16_000, &words)),
        case("rvl with a long run", sized(7, 5, &0x7f00_0000u32.to_le_bytes())),
        case("rvl with a number without end", sized(7, 5, &[0xff; 64])),
        case("rvl of empty runs", sized(7, 5, &[0; 4])),
        case("compressedDepth around rvl of noise", [config_header(1.0, 0.0), sized(7, 5, &[0xee; 8])].concat()),
        case("compressedDepth around nothing", config_header(1.0, 0.0)),
        case("pclzf of colour", pclzf(7, 5, "rgb24", &packed, 105)),
        case("pclzf of another size", pclzf(7, 5, "depth16", &packed, 72)),
        case("pclzf of 60000 x 2000", pclzf(60_000, 2_000, "depth16", &packed, 240_000_000)),
        case("pclzf that ends early", pclzf(7, 5, "depth16", &packed[..20], 70)),
        case("pclzf that points before its start", pclzf(7, 5, "depth16", &[0x20, 9], 70)),
        case("pclzf without columns", pclzf(0, 5, "depth16", &packed, 0)),
    ]
}

#[cfg(feature = "tiff")]
fn tiffs() -> Vec<Case> {
    let good = tiff(&depth());
    let mut cases =
        vec![case("tiff without a directory", b"II*\0\x08\0\0\0"), case("tiff that loops", b"II*\0\0\0\0\0")];
    // Every entry of the directory in turn gets a huge value.
    let at = u32::from_le_bytes(good[4..8].try_into().unwrap()) as usize;
    let tag = |entry: usize| u16::from_le_bytes(good[at + 2 + 12 * entry..][..2].try_into().unwrap());
    for entry in 0..usize::from(good[at]) {
        // Size, bits, packing and place of the strips.
        if [256, 257, 258, 259, 273].contains(&tag(entry)) {
            let mut bad = good.clone();
            bad[at + 2 + 12 * entry + 8..][..4].copy_from_slice(&[0xfe, 0xff, 0, 0]);
            cases.push((format!("tiff with a wrong tag {}", tag(entry)), bad));
        }
    }
    cases
}

#[cfg(not(feature = "tiff"))]
fn tiffs() -> Vec<Case> {
    Vec::new()
}

#[test]
fn broken_files_give_typed_errors_in_little_memory() {
    let cases = [truncations(), lying_texts(), lying_arrays(), lying_pictures(), tiffs()].concat();
    assert!(cases.len() >= 120, "{} cases", cases.len());
    println!("{} broken files", cases.len());
    for (name, bytes) in cases {
        let before = IN_USE.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        let result = decode(&bytes, "broken", &ReadOptions::default());
        let peak = PEAK.load(Ordering::Relaxed) - before;
        let error = result.err().unwrap_or_else(|| panic!("{name}: was accepted"));
        let expected = matches!(error.kind(), Error::Unreadable { .. } | Error::Limit { .. } | Error::Parameter { .. });
        assert!(expected && error.to_string().starts_with("broken: "), "{name}: {error:?}");
        assert!(peak < MOST_BYTES, "{name}: {peak} bytes at most");
    }
}

//! A sensor's noise: from files, from presets, and whether it suits the map.

use depthplanes::Intrinsics;
use depthplanes::noise::{NoiseModel, NoiseTable, SensorNoise};
use depthplanes_io::noise_table::parse;
use depthplanes_io::presets::{self, SENSOR_PRESETS};
use depthplanes_io::{Error, ReadOptions, decode, encoding, read_noise_table};

const MAP: &[u8] = b"P2 2 1 65535 900 901";

#[test]
fn a_table_is_read_with_and_without_a_heading() {
    let expected = NoiseTable::new(&[[1.0, 0.002], [2.5, 0.009]]).unwrap();
    for text in [
        "1,0.002\n2.5,0.009\n",
        "range_m,sigma_m\r\n1,0.002\r\n2.5,0.009",
        "# a wall\n\nrange;sigma\n 1 ; 2e-3 \n2.5;0.009 # far\n\n",
        "1\t0.002\n2.5\t0.009",
    ] {
        assert_eq!(parse(text).unwrap(), expected, "{text}");
    }
}

#[test]
fn what_is_no_table_is_refused_with_the_line() {
    for (text, said) in [
        ("", "0 rows"),
        ("range,sigma\n", "0 rows"),
        ("1,0.002\nfar,0.009\n", "line 2 is `far,0.009`"),
        ("hello", "line 1 is `hello`"),
        ("1 0.002\n", "line 1"),
        ("1,0.002,7\n", "line 1"),
        ("a,b\nc,d\n1,x2\n", "line 3"),
        ("2,0.002\n1,0.009\n", "row 2"),
        ("1,-0.002\n", "row 1"),
        ("1,nan\n", "row 1"),
        (&"1,0.1\n".repeat(17), "17 rows"),
    ] {
        let error = parse(text).unwrap_err();
        assert!(matches!(error, Error::Unreadable { .. } | Error::Library(_)), "{error:?}");
        assert!(error.to_string().contains(said), "{text}: {error}");
    }
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join("bytes.csv"), [0xFF, 0xFE, 0]).unwrap();
    std::fs::write(folder.join("large.csv"), vec![b'#'; (1 << 16) + 1]).unwrap();
    for (name, said) in [("bytes.csv", "not text"), ("large.csv", "limit"), ("gone.csv", "gone.csv")] {
        let error = read_noise_table(folder.join(name)).unwrap_err().to_string();
        assert!(error.contains(said) && error.contains(name), "{error}");
    }
}

#[test]
fn a_stated_noise_goes_before_the_presets_and_must_suit_the_map() {
    let table = SensorNoise::Table(NoiseTable::new(&[[1.0, 0.002]]).unwrap());
    let stated = ReadOptions { preset: Some("kinect1".into()), noise: Some(table), ..Default::default() };
    let sensor = decode(MAP, "x", &stated).unwrap().sensor;
    assert_eq!(sensor.noise, Some(table));
    // Each part by itself.
    let of_preset = presets::by_name("kinect1").unwrap().smooth_noise.unwrap().of();
    assert_eq!(sensor.smooth_noise, of_preset);
    let preset = Some("kinect2".into());
    let smooth = ReadOptions { preset, smooth_noise: Some(table), noise: None, ..stated };
    let sensor = decode(MAP, "x", &smooth).unwrap().sensor;
    assert_eq!(
        (sensor.noise, sensor.smooth_noise),
        (presets::by_name("kinect2").unwrap().noise.unwrap().of(), Some(table))
    );
    let disparity = ReadOptions { encoding: Some("kitti".into()), noise: Some(table), ..Default::default() };
    let error = decode(MAP, "x", &disparity).unwrap_err();
    assert!(matches!(error.kind(), Error::Parameter { option: "--noise-table", .. }), "{error}");
    let rig = encoding::Stereo { focal_px: 500.0, baseline_m: 0.2, doffs_px: 0.0 };
    let metric = ReadOptions { stereo: Some(rig), ..disparity };
    assert_eq!(decode(MAP, "x", &metric).unwrap().sensor.noise, Some(table));
}

#[test]
fn every_presets_noise_suits_its_encoding() {
    let camera = Intrinsics::new(425.0, 425.0, 424.0, 240.0).unwrap();
    for preset in SENSOR_PRESETS {
        let camera_size = Some((2, 1)); // a part of the picture
        let preset_name = Some(preset.name.into());
        let options = ReadOptions { preset: preset_name, intrinsics: Some(camera), camera_size, ..Default::default() };
        let sensor = decode(MAP, preset.name, &options).unwrap().sensor;
        assert_eq!(sensor.noise.is_some(), preset.noise.is_some(), "{}", preset.name);
        assert_eq!(sensor.smooth_noise.is_some(), preset.smooth_noise.is_some(), "{}", preset.name);
        for noise in sensor.noise.into_iter().chain(sensor.smooth_noise) {
            let model = NoiseModel::new(sensor.value_kind, noise, 1.0).unwrap_or_else(|| panic!("{}", preset.name));
            let at_2_m = model.depth_sigma_m(2.0).unwrap();
            assert!((1e-4..0.02).contains(&at_2_m), "{}: {at_2_m} m at 2 m", preset.name);
        }
    }
}

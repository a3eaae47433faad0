//! Tables as Parquet, read by the crate's own reader: the rows of the CSV form. Python's tests read them with pyarrow.
#![cfg(feature = "parquet")]

use depthplanes::methods;
use depthplanes::{Detection, Detector, scene::Spec};
use depthplanes_io::Frame;
use depthplanes_io::outputs::{OUTPUTS, Report, TableForm};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;
use std::path::Path;

#[test]
fn a_table_has_the_rows_of_the_csv() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("parquet");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("planes.parquet");
    let form = TableForm::of(&path).unwrap();
    let (mut table, mut csv) = (form.begin(&path).unwrap(), String::new());
    // With a camera and without, with many planes and with none.
    for (name, spec, metric) in [("a \"quoted\", name", "boxes", true), ("äö", "room", false), ("none", "boxes", true)]
    {
        let scene = spec.parse::<Spec>().unwrap().frame().unwrap();
        let mut frame = Frame::from(scene);
        frame.sensor.intrinsics = frame.sensor.intrinsics.filter(|_| metric);
        let mut detector = Detector::default().sensor(frame.sensor);
        let detection = detector.detect(frame.view().unwrap()).unwrap();
        let detection = if name == "none" { &Detection::default() } else { detection };
        let report = Report::new(name, &frame, methods::default(), &[], detection);
        table.add(&form.rows(&report)).unwrap();
        let planes = OUTPUTS.iter().find(|output| output.name == "planes").unwrap();
        let text = String::from_utf8((planes.writer(Path::new("p.csv")).unwrap().encode)(&report).unwrap()).unwrap();
        csv += text.split_once('\n').unwrap().1;
    }
    assert!(!path.exists(), "it has its name when it is whole");
    table.finish().unwrap();
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let text = |field: &Field| match field {
        Field::Null => String::new(),
        Field::Str(text) if text.contains([',', '"']) => format!("\"{}\"", text.replace('"', "\"\"")),
        Field::Str(text) => text.clone(),
        Field::Long(number) => number.to_string(),
        Field::Double(number) => number.to_string(),
        other => panic!("{other}"),
    };
    let rows = reader.get_row_iter(None).unwrap().map(|row| {
        let fields: Vec<String> = row.unwrap().get_column_iter().map(|(_, field)| text(field)).collect();
        fields.join(",") + "\n"
    });
    let rows: String = rows.collect();
    let differs = rows.lines().zip(csv.lines()).find(|(row, line)| row != line);
    assert_eq!((differs, rows.lines().count()), (None, csv.lines().count()));
    assert!(csv.lines().count() > 50, "{}", csv.lines().count());
}

#[test]
fn a_table_of_no_rows_has_the_columns() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("empty.parquet");
    TableForm::of(&path).unwrap().begin(&path).unwrap().finish().unwrap();
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let columns = reader.metadata().file_metadata().schema_descr().columns();
    assert_eq!((columns.len(), columns[0].name(), reader.get_row_iter(None).unwrap().count()), (23, "source", 0));
}

//! The table as Apache Parquet (feature `parquet`): the columns of the CSV form, numbers that are not known being null.

use super::error::OutputError;
use super::planes::{CSV_COLUMNS, array_rows};
use super::staged::Staged;
use super::table_form::{Form, Rows};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use serde_json::Value;
use std::io;
use std::sync::Arc;

pub(super) const FORM: Form =
    Form { extension: "parquet", rows: array_rows, begin: |file| Ok(Box::new(Table::begin(file)?)) };

/// The columns of whole numbers; the others but the first, the source, are of double precision.
const WHOLE: &[&str] = &["label", "pixel_count", "u_min", "v_min", "u_max", "v_max"];

/// Rows that are kept until they are written together: some tens of megabytes.
const GROUP: usize = 100_000;

/// A file that is being written.
#[derive(Debug)]
struct Table {
    file: SerializedFileWriter<Staged>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    fn begin(file: Staged) -> Result<Self, OutputError> {
        let target = file.target().to_path_buf();
        let column = |name: &&str| match *name {
            "source" => format!("REQUIRED BYTE_ARRAY {name} (UTF8);"),
            _ if WHOLE.contains(name) => format!("OPTIONAL INT64 {name};"),
            _ => format!("OPTIONAL DOUBLE {name};"),
        };
        let columns: String = CSV_COLUMNS.iter().map(column).collect();
        let schema =
            parse_message_type(&format!("message planes {{ {columns} }}")).expect("the columns have plain names");
        let program = concat!("depthplanes ", env!("CARGO_PKG_VERSION"));
        let properties = WriterProperties::builder().set_created_by(program.into()).build();
        let file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        Ok(Table {
            file: file.map_err(|error| OutputError::Write { path: target, source: of_file(error) })?,
            rows: Vec::new(),
        })
    }

    fn write_group(&mut self) -> Result<(), OutputError> {
        let rows = std::mem::take(&mut self.rows);
        let written = self.file.next_row_group().and_then(|group| write_columns(group, &rows));
        written.map_err(|error| OutputError::Write {
            path: self.file.inner().target().to_path_buf(),
            source: of_file(error),
        })
    }
}

impl Rows for Table {
    fn add(&mut self, rows: &str) -> Result<(), OutputError> {
        let parsed = rows.lines().map(|line| serde_json::from_str(line).expect("rows are arrays of JSON"));
        self.rows.extend(parsed);
        if self.rows.len() >= GROUP { self.write_group() } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> Result<Staged, OutputError> {
        if !self.rows.is_empty() {
            self.write_group()?;
        }
        let target = self.file.inner().target().to_path_buf();
        self.file.into_inner().map_err(|error| OutputError::Write { path: target, source: of_file(error) })
    }
}

fn write_columns(mut group: SerializedRowGroupWriter<'_, Staged>, rows: &[Vec<Value>]) -> Result<(), ParquetError> {
    for (at, name) in CSV_COLUMNS.iter().enumerate() {
        let values = rows.iter().map(|row| &row[at]);
        let levels: Vec<i16> = values.clone().map(|value| i16::from(!value.is_null())).collect();
        let mut column = group.next_column()?.expect("there are as many as the schema has");
        if *name == "source" {
            let texts: Vec<ByteArray> = values.map(|value| value.as_str().unwrap_or_default().into()).collect();
            column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
        } else if WHOLE.contains(name) {
            let numbers: Vec<i64> = values.filter_map(Value::as_f64).map(|number| number as i64).collect();
            column.typed::<Int64Type>().write_batch(&numbers, Some(&levels), None)?;
        } else {
            let numbers: Vec<f64> = values.filter_map(Value::as_f64).collect();
            column.typed::<DoubleType>().write_batch(&numbers, Some(&levels), None)?;
        }
        column.close()?;
    }
    group.close().map(drop)
}

/// What the system said, if it was the system.
fn of_file(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other.to_string()),
        },
        other => io::Error::other(other.to_string()),
    }
}

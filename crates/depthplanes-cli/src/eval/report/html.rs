//! The report as one page of HTML that needs nothing else.

use super::page::{Page, Section};
use super::plots::Plot;
use super::strips::{Picture, Strip};
use super::table::Table;
use crate::table::Align;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

const STYLE: &str = "
:root { color-scheme: light; font: 15px/1.45 system-ui, sans-serif; color: #1b1b1b; background: #fff; }
body { max-width: 1240px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #ddd; } h3 { font-size: 1rem; margin: 1.2rem 0 .4rem; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; display: block; overflow-x: auto; }
th, td { padding: .2rem .5rem; text-align: right; white-space: nowrap; } th { border-bottom: 2px solid #999; }
.words { text-align: left; } tbody tr:nth-child(odd) { background: #f5f6f8; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; } dt { color: #555; } dd { margin: 0; }
.plots { margin-top: 1rem; display: flex; flex-wrap: wrap; gap: 1.2rem; } figure { margin: 0; } figcaption { color: #444; font-size: .85rem; max-width: 570px; } p { max-width: 46rem; }

.strip { display: flex; flex-wrap: wrap; gap: .5rem; } .strip img { display: block; width: 194px; height: auto; }
";

pub(super) fn page(page: &Page<'_>) -> String {
    let fact = |[what, value]: &[String; 2]| format!("<dt>{}</dt><dd>{}</dd>\n", safe(what), safe(value));
    let facts: String = page.facts.iter().map(fact).collect();
    let sections: String = page.sections.iter().map(section).collect();
    let refusals: String = page.refusals.iter().map(|refusal| format!("<li>{}</li>\n", safe(refusal))).collect();
    let refusals = if refusals.is_empty() { refusals } else { format!("<h2>Refusals</h2>\n<ul>{refusals}</ul>\n") };
    let title = safe(page.title);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>depthplanes: {title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n\
         <dl>{facts}</dl>\n{sections}{refusals}</body>\n</html>\n"
    )
}

fn section(section: &Section) -> String {
    let Section { title, text, tables, plots, strips } = section;
    let paragraphs = text.split("\n\n").filter(|text| !text.is_empty());
    let text: String = paragraphs.map(|text| format!("<p>{}</p>\n", safe(text))).collect();
    let headed = |of: &Table| {
        let heading = if of.title == *title { String::new() } else { format!("<h3>{}</h3>\n", safe(&of.title)) };
        heading + &table(of)
    };
    let tables: String = tables.iter().map(headed).collect();
    let figure =
        |plot: &Plot| format!("<figure>{}<figcaption>{}</figcaption></figure>\n", plot.svg, safe(&plot.caption));
    let plots: String = plots.iter().map(figure).collect();
    let strips: String = strips.iter().map(strip).collect();
    format!("<h2>{}</h2>\n{text}{tables}<div class=\"plots\">{plots}</div>\n{strips}", safe(title))
}

fn table(table: &Table) -> String {
    let aligns = table.aligns();
    let cells = |tag: &str, cells: &[String]| -> String {
        let cell = |(cell, align): (&String, &Align)| {
            let class = if *align == Align::Left { " class=\"words\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", safe(cell))
        };
        cells.iter().zip(&aligns).map(cell).collect()
    };
    let rows: String = table.rows.iter().map(|row| format!("<tr>{}</tr>\n", cells("td", row))).collect();
    format!("<table><thead><tr>{}</tr></thead>\n<tbody>{rows}</tbody></table>\n", cells("th", &table.head))
}

fn strip(strip: &Strip) -> String {
    let picture = |picture: &Picture| {
        let caption = safe(&picture.caption);
        let png = STANDARD.encode(&picture.png);
        format!(
            "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{png}\"><figcaption>{caption}</figcaption></figure>\n"
        )
    };
    let pictures: String = strip.pictures.iter().map(picture).collect();
    format!("<h3>{}</h3>\n<div class=\"strip\">{pictures}</div>\n", safe(&strip.title))
}

/// Text that means nothing to HTML.
fn safe(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

//! The report as one page of HTML that needs nothing else.

use super::Page;
use super::table::Table;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

const STYLE: &str = "
:root { color-scheme: light; font: 15px/1.45 system-ui, sans-serif; color: #1b1b1b; background: #fff; }
body { max-width: 1180px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #ddd; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; display: block; overflow-x: auto; }
th, td { padding: .2rem .5rem; text-align: right; white-space: nowrap; } th { border-bottom: 2px solid #999; }
th:first-child, td:first-child { text-align: left; } tbody tr:nth-child(odd) { background: #f5f6f8; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; } dt { color: #555; } dd { margin: 0; }
.plots { display: flex; flex-wrap: wrap; gap: 1.2rem; } figure { margin: 0; } figcaption { color: #444; font-size: .85rem; }

.strip { display: flex; flex-wrap: wrap; gap: .5rem; } .strip img { display: block; width: 220px; height: auto; }
";

pub(super) fn page(page: &Page) -> String {
    let facts: String =
        page.facts.iter().map(|[what, value]| format!("<dt>{}</dt><dd>{}</dd>\n", safe(what), safe(value))).collect();
    let plots: String = page
        .plots
        .iter()
        .map(|plot| format!("<figure>{}<figcaption>{}</figcaption></figure>\n", plot.svg, safe(&plot.caption)))
        .collect();
    let tables: String = page.tables.iter().map(table).collect();
    let strips: String = page.strips.iter().map(strip).collect();
    let refusals: String = page.refusals.iter().map(|refusal| format!("<li>{}</li>\n", safe(refusal))).collect();
    let refusals = if refusals.is_empty() { refusals } else { format!("<h2>Refusals</h2>\n<ul>{refusals}</ul>\n") };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>depthplanes: evaluation</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>Evaluation</h1>\n\
         <dl>{facts}</dl>\n{tables}<h2>Plots</h2>\n<div class=\"plots\">{plots}</div>\n\
         <h2>Pictures</h2>\n{strips}{refusals}</body>\n</html>\n"
    )
}

fn table(table: &Table) -> String {
    let cells = |tag: &str, cells: &[String]| -> String {
        cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", safe(cell))).collect()
    };
    let rows: String = table.rows.iter().map(|row| format!("<tr>{}</tr>\n", cells("td", row))).collect();
    format!(
        "<h2>{}</h2>\n<table><thead><tr>{}</tr></thead>\n<tbody>{rows}</tbody></table>\n",
        safe(&table.title),
        cells("th", &table.head)
    )
}

fn strip(strip: &super::strips::Strip) -> String {
    let picture = |picture: &super::strips::Picture| {
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

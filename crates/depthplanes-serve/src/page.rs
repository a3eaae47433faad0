//! The page's files, which are part of the program: `npm run build` in `page` makes them.

use axum::body::Bytes;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE, HeaderName};
use axum::response::{IntoResponse, Response};

/// A file by its path.
struct File {
    path: &'static str,
    kind: &'static str,
    bytes: &'static [u8],
}

const FILES: &[File] = &[
    File { path: "/", kind: "text/html; charset=utf-8", bytes: include_bytes!("../page/dist/index.html") },
    File { path: "/page.css", kind: "text/css; charset=utf-8", bytes: include_bytes!("../page/dist/page.css") },
    File { path: "/page.js", kind: "text/javascript; charset=utf-8", bytes: include_bytes!("../page/dist/page.js") },
    File { path: "/icon.svg", kind: "image/svg+xml", bytes: include_bytes!("../page/dist/icon.svg") },
    File {
        path: "/licences.txt",
        kind: "text/plain; charset=utf-8",
        bytes: include_bytes!("../page/dist/licences.txt"),
    },
];

/// The page asks nobody else, and nobody else shows it in a frame.
const HEADERS: [(HeaderName, &str); 5] = [
    (
        HeaderName::from_static("content-security-policy"),
        "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (HeaderName::from_static("x-content-type-options"), "nosniff"),
    (HeaderName::from_static("referrer-policy"), "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
];

/// The file of a path, if there is one.
pub(crate) fn file(path: &str) -> Option<Response> {
    let file = FILES.iter().find(|file| file.path == path)?;
    let headers = [(CONTENT_TYPE, file.kind), (CACHE_CONTROL, "no-cache")];
    Some((headers, HEADERS, Bytes::from_static(file.bytes)).into_response())
}

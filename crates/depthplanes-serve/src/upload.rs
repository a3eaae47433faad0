//! Files that are dragged onto the page.

use crate::event::Event;
use crate::hub::Hub;
use axum::body::{Body, to_bytes};
use axum::extract::{Path, State};
use axum::http::StatusCode;
use depthplanes_video::VideoFrame;
use std::sync::Arc;
use std::sync::mpsc::TrySendError;
use std::time::Duration;

/// Longest time for the bytes to come.
const LONGEST: Duration = Duration::from_secs(60);

type Refusal = (StatusCode, String);

/// Reads a map as `detect` does, with the flags of the command line, and shows it instead of the source.
///
/// # Errors
/// What is wrong with it, as text for people.
pub(crate) async fn upload(
    State(hub): State<Arc<Hub>>,
    Path(name): Path<String>,
    body: Body,
) -> Result<StatusCode, Refusal> {
    let Ok(_place) = hub.uploads.try_acquire() else {
        return Err((StatusCode::TOO_MANY_REQUESTS, "another file is being read; try again".into()));
    };
    let name: String = name.chars().filter(|letter| !letter.is_control()).collect(); // it comes back in texts
    let most = hub.limits.upload_bytes;
    let too_large = |_| {
        let message = format!(
            "{name}: the file did not arrive, or is larger than {} MB; read it with `depthplanes detect`",
            most >> 20
        );
        (StatusCode::PAYLOAD_TOO_LARGE, message)
    };
    let late = |_| (StatusCode::REQUEST_TIMEOUT, format!("{name}: the file did not arrive within a minute"));
    let bytes = tokio::time::timeout(LONGEST, to_bytes(body, most)).await.map_err(late)?.map_err(too_large)?;
    let (known, called) = (Arc::clone(&hub), name.clone());
    let read = tokio::task::spawn_blocking(move || depthplanes_io::decode(&bytes, &called, &known.read)).await;
    let frame = match read {
        Ok(Ok(frame)) => frame,
        Ok(Err(error)) => return Err((StatusCode::UNPROCESSABLE_ENTITY, error.to_string())),
        Err(_) => return Err((StatusCode::INTERNAL_SERVER_ERROR, format!("{name}: the file could not be read"))),
    };
    let video = VideoFrame { index: 0, name, time_s: None, pose: None, up: None, frame };
    match hub.events.try_send(Event::Show(Box::new(video))) {
        Ok(()) => Ok(StatusCode::NO_CONTENT),
        Err(TrySendError::Full(_)) => Err((StatusCode::SERVICE_UNAVAILABLE, "too much is asked for; try again".into())),
        Err(TrySendError::Disconnected(_)) => Err((StatusCode::SERVICE_UNAVAILABLE, "the program is ending".into())),
    }
}

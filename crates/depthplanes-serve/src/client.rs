//! One open page: it is sent states, and the newest frame whenever it has drawn those before.

use crate::event::Event;
use crate::explainer::{Question, refusal};
use crate::hub::{Hub, Shown};
use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, oneshot};
use tokio::time::{Instant, timeout};

/// Frames that are on their way to a page, or wait there to be drawn.
const UNDER_WAY: u32 = 2;
/// A page that takes no bytes for so long is gone; it connects again if it is not.
const PATIENCE: Duration = Duration::from_secs(30);
/// Bytes of a message from a page.
pub(crate) const MESSAGE_BYTES: usize = 4096;
/// How often a silent page is asked whether it is there.
const EVERY: Duration = Duration::from_secs(20);

/// What a page asks for.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum Wish {
    /// A frame was drawn.
    Drawn,
    Play,
    Pause,
    Step {
        #[serde(default)]
        back: bool,
    },
    Seek {
        index: u64,
    },
    Set {
        name: String,
        value: f64,
    },
    Reset,
    Return,
    Explain {
        serial: u64,
        at: [usize; 2],
    },
}

/// Why a page is let go: what it is told, if it still hears.
struct Gone(CloseFrame);

impl Gone {
    /// It does not answer, or has closed the connection.
    fn silent() -> Self {
        Gone(CloseFrame { code: close_code::AWAY, reason: "the page does not answer".into() })
    }

    /// It sent what no page sends: more bytes than a message has.
    fn too_large() -> Self {
        Gone(CloseFrame {
            code: close_code::SIZE,
            reason: format!("messages have at most {MESSAGE_BYTES} bytes").into(),
        })
    }
}

pub(crate) async fn attend(mut socket: WebSocket, hub: Arc<Hub>, _place: OwnedSemaphorePermit) {
    let (mut shown, mut state, mut stopping) = (hub.shown.subscribe(), hub.state.subscribe(), hub.stopping.subscribe());
    shown.mark_changed();
    state.mark_changed();
    // Where the queue is full the player is awake.
    let _ = hub.events.try_send(Event::Opened);
    let mut page = Page { hub: &hub, under_way: 0, camera: 0, answer: None, heard: Instant::now() };
    let mut pulse = tokio::time::interval(EVERY);
    let mut outcome = send(&mut socket, Message::text(hub.hello.clone())).await;
    while outcome.is_ok() && !*stopping.borrow() {
        outcome = tokio::select! {
            _ = stopping.changed() => break,
            _ = state.changed() => {
                let text = state.borrow_and_update().to_string();
                send(&mut socket, Message::text(text)).await
            }
            _ = shown.changed(), if page.under_way < UNDER_WAY => {
                let newest = shown.borrow_and_update().clone();
                match newest {
                    Some(newest) => page.show(&mut socket, &newest).await,
                    None => Ok(()),
                }
            }
            answer = answered(&mut page.answer) => send(&mut socket, Message::text(answer)).await,
            message = socket.recv() => page.hear(&mut socket, message).await,
            _ = pulse.tick() => page.ask(&mut socket).await,
        };
    }
    let ended = || CloseFrame { code: close_code::AWAY, reason: "the program has ended".into() };
    let ending = outcome.err().map_or_else(ended, |Gone(why)| why);
    let _ = timeout(Duration::from_secs(1), socket.send(Message::Close(Some(ending)))).await;
}

struct Page<'a> {
    hub: &'a Hub,
    /// Frames that were sent and not drawn yet.
    under_way: u32,
    /// The camera that it knows.
    camera: u64,
    answer: Option<oneshot::Receiver<String>>,
    heard: Instant,
}

impl Page<'_> {
    async fn show(&mut self, socket: &mut WebSocket, shown: &Shown) -> Result<(), Gone> {
        if let Some(rays) = shown.rays.as_ref().filter(|rays| rays.number != self.camera) {
            self.camera = rays.number;
            send(socket, Message::Binary(rays.message.clone())).await?;
        }
        self.under_way += 1;
        send(socket, Message::Binary(shown.message.clone())).await
    }

    async fn hear(
        &mut self,
        socket: &mut WebSocket,
        message: Option<Result<Message, axum::Error>>,
    ) -> Result<(), Gone> {
        self.heard = Instant::now();
        match message {
            None | Some(Ok(Message::Close(_))) => Err(Gone::silent()),
            Some(Err(_)) => Err(Gone::too_large()), // where it is another error nobody hears it
            Some(Ok(Message::Text(text))) => match serde_json::from_str(&text) {
                Ok(wish) => self.grant(socket, wish).await,
                Err(error) => send(socket, refused(&format!("this is not understood: {error}"))).await,
            },
            Some(Ok(Message::Binary(_))) => send(socket, refused("messages to the server are text")).await,
            Some(Ok(_)) => Ok(()),
        }
    }

    async fn grant(&mut self, socket: &mut WebSocket, wish: Wish) -> Result<(), Gone> {
        let event = match wish {
            Wish::Drawn => {
                self.under_way = self.under_way.saturating_sub(1);
                return Ok(());
            }
            Wish::Explain { serial, at } => {
                return match self.explain(serial, at) {
                    Ok(()) => Ok(()),
                    Err(why) => send(socket, Message::text(refusal(at, why).to_string())).await,
                };
            }
            Wish::Play => Event::Play(true),
            Wish::Pause => Event::Play(false),
            Wish::Step { back } => Event::Step { back },
            Wish::Seek { index } => Event::Seek(index),
            Wish::Set { name, value } => match self.hub.method.with(&[(&name, value)]) {
                Ok(_) => Event::Set { name, value },
                Err(error) => return send(socket, refused(&error.to_string())).await,
            },
            Wish::Reset => Event::Reset,
            Wish::Return => Event::Return,
        };
        match self.hub.events.try_send(event) {
            Ok(()) => Ok(()),
            Err(_) => send(socket, refused("too much is asked for at once; try again")).await,
        }
    }

    /// Asks for an explanation; one at a time.
    fn explain(&mut self, serial: u64, at: [usize; 2]) -> Result<(), &'static str> {
        if self.answer.is_some() {
            return Err("the pixel before is still being explained");
        }
        let frame = self.hub.recent.find(serial).ok_or("that frame has passed; pause, and pick the pixel again")?;
        let (answer, receiver) = oneshot::channel();
        let question = Question { frame, at, answer };
        self.hub.questions.try_send(question).map_err(|_| "too many pixels are being explained; try again")?;
        self.answer = Some(receiver);
        Ok(())
    }

    /// Asks a silent page whether it is there.
    async fn ask(&self, socket: &mut WebSocket) -> Result<(), Gone> {
        if self.heard.elapsed() > 3 * EVERY {
            return Err(Gone::silent());
        }
        send(socket, Message::Ping(Default::default())).await
    }
}

/// The answer that is waited for; without one this never ends.
async fn answered(waiting: &mut Option<oneshot::Receiver<String>>) -> String {
    let Some(receiver) = waiting else { return std::future::pending().await };
    let answer = receiver.await;
    *waiting = None;
    answer.unwrap_or_else(|_| refusal([0, 0], "the pixel could not be explained").to_string())
}

fn refused(why: &str) -> Message {
    Message::text(json!({"type": "refused", "error": why}).to_string())
}

async fn send(socket: &mut WebSocket, message: Message) -> Result<(), Gone> {
    match timeout(PATIENCE, socket.send(message)).await {
        Ok(Ok(())) => Ok(()),
        _ => Err(Gone::silent()),
    }
}

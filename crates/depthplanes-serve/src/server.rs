//! The server: its routes, and the threads behind it.

use crate::client::{self, MESSAGE_BYTES};
use crate::config::Config;
use crate::connections::Bounded;
use crate::error::{Error, Result};
use crate::event::Event;
use crate::explainer;
use crate::guard::Guard;
use crate::hub::Hub;
use crate::page;
use crate::pipeline::Pipeline;
use crate::player::Player;
use crate::reader::Reader;
use crate::upload::upload;
use axum::Router;
use axum::extract::{DefaultBodyLimit, Request, State, WebSocketUpgrade};
use axum::http::StatusCode;
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{any, get, post};
use depthplanes_io::page::parameter_record;
use depthplanes_video::Source;
use serde_json::{Value, json};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::thread::JoinHandle;
use std::time::Duration;

/// Wishes of pages that wait for the player; more are refused.
const WAITING: usize = 64;
/// Time for pages to hear that it ends.
const FAREWELL: Duration = Duration::from_secs(2);

/// A running server. It ends with [`Server::stop`], or when it is dropped.
pub struct Server {
    hub: Arc<Hub>,
    address: SocketAddr,
    threads: Vec<JoinHandle<()>>,
}

impl std::fmt::Debug for Server {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Server").field("address", &self.address).finish_non_exhaustive()
    }
}

impl Server {
    /// Serves the page on a socket, and plays the source.
    ///
    /// # Errors
    /// A parameter out of range, and what the system says.
    pub fn start(listener: TcpListener, source: Box<dyn Source>, config: Config) -> Result<Server> {
        let pipeline = Pipeline::new(&config)?;
        let address = listener.local_addr().map_err(Error::io("the socket's address"))?;
        listener.set_nonblocking(true).map_err(Error::io("a socket that does not wait"))?;
        let (events, received) = sync_channel(WAITING);
        let questions = explainer::start(config.method).map_err(Error::io("a thread"))?;
        let guard = Guard::new(address.ip(), &config.hosts);
        let hub = Arc::new(Hub::new(&config, hello(&config).to_string(), guard, events.clone(), questions));
        let deliver = move |read| events.send(Event::Read(read)).is_ok();
        let reader = Reader::start(source, deliver).map_err(Error::io("a thread"))?;
        let player = Player::new(pipeline, reader, Arc::clone(&hub));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build();
        let runtime = runtime.map_err(Error::io("a runtime"))?;
        let thread = |name: &str| std::thread::Builder::new().name(name.into());
        let play = thread("player").spawn(move || player.run(&received)).map_err(Error::io("a thread"))?;
        let shared = Arc::clone(&hub);
        let serve = thread("server").spawn(move || {
            runtime.block_on(serve(listener, shared));
            runtime.shutdown_timeout(FAREWELL);
        });
        Ok(Server { hub, address, threads: vec![play, serve.map_err(Error::io("a thread"))?] })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Tells all pages that it ends, and ends.
    pub fn stop(self) {}
}

impl Drop for Server {
    fn drop(&mut self) {
        self.hub.stopping.send_replace(true);
        let _ = self.hub.events.send(Event::Stop); // where the player has ended already there is nobody to tell
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}

async fn serve(listener: TcpListener, hub: Arc<Hub>) {
    let most = hub.limits.connections;
    let routes = Router::new()
        .route("/live", any(open))
        .route("/file/{name}", post(upload))
        .fallback(get(file))
        .layer(from_fn_with_state(Arc::clone(&hub), check))
        .layer(DefaultBodyLimit::disable()) // files have a limit of their own, and nothing else has a body that is read
        .with_state(Arc::clone(&hub));
    let Ok(listener) = tokio::net::TcpListener::from_std(listener) else { return };
    let mut stopping = hub.stopping.subscribe();
    let ended = async move { drop(stopping.wait_for(|stops| *stops).await) };
    let served = axum::serve(Bounded::new(listener, most), routes).with_graceful_shutdown(ended);
    let mut stopping = hub.stopping.subscribe();
    let late = async move {
        let _ = stopping.wait_for(|stops| *stops).await;
        tokio::time::sleep(FAREWELL).await;
    };
    tokio::select! {
        _ = served => (),
        () = late => (),
    }
}

/// Refuses whoever is not a page of this server.
async fn check(State(hub): State<Arc<Hub>>, request: Request, next: Next) -> Response {
    match hub.guard.refusal(request.headers()) {
        Some(why) => (StatusCode::FORBIDDEN, why).into_response(),
        None => next.run(request).await,
    }
}

async fn file(request: Request) -> Response {
    page::file(request.uri().path()).unwrap_or_else(|| StatusCode::NOT_FOUND.into_response())
}

/// A page opens its connection.
async fn open(State(hub): State<Arc<Hub>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(place) = Arc::clone(&hub.clients).try_acquire_owned() else {
        let message = format!("{} pages are open, and no more are accepted", hub.limits.clients);
        return (StatusCode::SERVICE_UNAVAILABLE, message).into_response();
    };
    let upgrade = upgrade.max_message_size(MESSAGE_BYTES).max_frame_size(MESSAGE_BYTES);
    upgrade.on_upgrade(move |socket| client::attend(socket, hub, place))
}

/// The first message to a page: what it needs once.
fn hello(config: &Config) -> Value {
    json!({
        "type": "hello",
        "version": env!("CARGO_PKG_VERSION"),
        "source": config.name,
        "method": {"name": config.method.name, "about": config.method.about},
        "parameters": config.method.params.iter().map(parameter_record).collect::<Vec<_>>(),
        "upload_bytes": config.limits.upload_bytes,
    })
}

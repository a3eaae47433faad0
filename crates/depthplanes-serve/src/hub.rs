//! What the threads share: the newest frame and state, and the queues of what is asked for.

use crate::config::{Config, Limits};
use crate::event::Event;
use crate::explainer::Question;
use crate::guard::Guard;
use crate::rays::Rays;
use crate::recent::Recents;
use axum::body::Bytes;
use depthplanes::methods::MethodInfo;
use depthplanes_io::ReadOptions;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use tokio::sync::{Semaphore, watch};

/// A frame as clients get it.
#[derive(Debug)]
pub(crate) struct Shown {
    pub(crate) message: Bytes,
    pub(crate) rays: Option<Arc<Rays>>,
}

/// Shared by all.
pub(crate) struct Hub {
    pub(crate) hello: String,
    pub(crate) method: &'static MethodInfo,
    pub(crate) read: ReadOptions,
    pub(crate) limits: Limits,
    pub(crate) guard: Guard,
    /// The newest frame; nobody waits for clients.
    pub(crate) shown: watch::Sender<Option<Arc<Shown>>>,
    pub(crate) state: watch::Sender<Arc<str>>,
    /// Becomes true when all has to end.
    pub(crate) stopping: watch::Sender<bool>,
    pub(crate) clients: Arc<Semaphore>,
    pub(crate) uploads: Semaphore,
    pub(crate) events: SyncSender<Event>,
    pub(crate) questions: SyncSender<Question>,
    pub(crate) recent: Recents,
}

impl Hub {
    pub(crate) fn new(
        config: &Config,
        hello: String,
        guard: Guard,
        events: SyncSender<Event>,
        questions: SyncSender<Question>,
    ) -> Self {
        Hub {
            hello,
            method: config.method,
            read: config.read.clone(),
            limits: config.limits,
            guard,
            shown: watch::Sender::new(None),
            state: watch::Sender::new("{}".into()),
            stopping: watch::Sender::new(false),
            clients: Arc::new(Semaphore::new(config.limits.clients)),
            uploads: Semaphore::new(1),
            events,
            questions,
            recent: Recents::default(),
        }
    }
}

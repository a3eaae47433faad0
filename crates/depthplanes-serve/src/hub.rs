//! What the threads share: the newest frame and state, and the queues of what is asked for.

use crate::config::Limits;
use crate::explainer::Question;
use crate::guard::Guard;
use crate::player::Event;
use crate::rays::Rays;
use axum::body::Bytes;
use depthplanes_io::ReadOptions;
use depthplanes_video::VideoFrame;
use std::collections::VecDeque;
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::{Semaphore, watch};

/// Frames that can be explained after newer ones have come.
const RECENT: usize = 4;

/// A frame as clients get it.
#[derive(Debug)]
pub(crate) struct Shown {
    pub(crate) message: Bytes,
    pub(crate) rays: Option<Arc<Rays>>,
}

/// A frame that can be explained.
#[derive(Clone, Debug)]
pub(crate) struct Recent {
    pub(crate) serial: u64,
    pub(crate) video: Arc<VideoFrame>,
    pub(crate) values: Vec<f64>,
    /// The ids of its labels.
    pub(crate) ids: Vec<u32>,
}

/// Shared by all.
pub(crate) struct Hub {
    pub(crate) hello: String,
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
    recent: Mutex<VecDeque<Recent>>,
}

impl Hub {
    pub(crate) fn new(
        config: &crate::config::Config,
        hello: String,
        guard: Guard,
        events: SyncSender<Event>,
        questions: SyncSender<Question>,
    ) -> Self {
        Hub {
            hello,
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
            recent: Mutex::default(),
        }
    }

    /// Keeps a frame for questions.
    pub(crate) fn remember(&self, frame: Recent) {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        recent.push_back(frame);
        if recent.len() > RECENT {
            recent.pop_front();
        }
    }

    /// The frame of that number, if it is kept.
    pub(crate) fn recall(&self, serial: u64) -> Option<Recent> {
        let recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        recent.iter().find(|frame| frame.serial == serial).cloned()
    }
}

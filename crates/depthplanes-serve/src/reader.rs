//! The thread that waits for the source, so that nobody else does.

use depthplanes_video::{Source, VideoFrame};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

/// What is asked of the source.
struct Request {
    /// Counts the requests.
    number: u64,
    /// The frame that is wanted, instead of the next.
    seek: Option<u64>,
}

/// What came of a request.
pub(crate) struct Read {
    number: u64,
    /// The frame's place in the source.
    pub(crate) index: u64,
    /// `None` at the end.
    pub(crate) frame: Option<depthplanes_video::Result<Box<VideoFrame>>>,
    /// Milliseconds that it took.
    pub(crate) ms: f64,
}

/// Asks for one frame at a time.
pub(crate) struct Reader {
    requests: Sender<Request>,
    number: u64,
    pub(crate) frames: Option<u64>,
    pub(crate) can_seek: bool,
}

impl Reader {
    /// Starts the thread; `deliver` takes what it reads, and returns whether more is wanted. The first frame is asked for.
    ///
    /// # Errors
    /// What the system says of one more thread.
    pub(crate) fn start(
        mut source: Box<dyn Source>,
        deliver: impl Fn(Read) -> bool + Send + 'static,
    ) -> std::io::Result<Self> {
        let (requests, receiver) = channel();
        let (frames, can_seek) = (source.frames(), source.seek(0));
        let run = move || read_all(source.as_mut(), &receiver, deliver);
        std::thread::Builder::new().name("reader".into()).spawn(run)?;
        let mut reader = Reader { requests, number: 0, frames, can_seek };
        reader.ask(None);
        Ok(reader)
    }

    /// Asks for the next frame, or for that of an index. What was asked for before does not count any more.
    pub(crate) fn ask(&mut self, seek: Option<u64>) {
        self.number += 1;
        // Where the thread is gone its end was told.
        let _ = self.requests.send(Request { number: self.number, seek });
    }

    /// Whether it is the answer to the newest request.
    pub(crate) fn is_newest(&self, read: &Read) -> bool {
        read.number == self.number
    }
}

fn read_all(source: &mut dyn Source, requests: &Receiver<Request>, deliver: impl Fn(Read) -> bool) {
    let mut index = 0;
    while let Ok(mut request) = requests.recv() {
        // Only the newest counts: a slider asks for many.
        while let Ok(newer) = requests.try_recv() {
            request = Request { seek: newer.seek.or(request.seek), ..newer };
        }
        if let Some(wanted) = request.seek {
            source.seek(wanted);
            index = wanted;
        }
        let start = Instant::now();
        let frame = source.next_frame().map(|frame| frame.map(Box::new));
        let ms = start.elapsed().as_secs_f64() * 1e3;
        if !deliver(Read { number: request.number, index, frame, ms }) {
            return;
        }
        index += 1;
    }
}

//! The thread that explains pixels, which takes several detections and holds up nobody else.

use crate::recent::Recent;
use depthplanes::Detector;
use depthplanes::explanation::Verdict;
use depthplanes::methods::MethodInfo;
use depthplanes_io::outputs::explanation_record;
use serde_json::{Value, json};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use tokio::sync::oneshot;

/// Questions that wait; more are refused.
const WAITING: usize = 8;

/// Why does this pixel have a plane, or none?
pub(crate) struct Question {
    pub(crate) frame: Recent,
    pub(crate) at: [usize; 2],
    /// Takes the answer, a message.
    pub(crate) answer: oneshot::Sender<String>,
}

/// Starts the thread, which ends with the last sender.
///
/// # Errors
/// What the system says of one more thread.
pub(crate) fn start(method: &'static MethodInfo) -> std::io::Result<SyncSender<Question>> {
    let (sender, receiver) = sync_channel(WAITING);
    std::thread::Builder::new().name("explainer".into()).spawn(move || answer_all(method, &receiver))?;
    Ok(sender)
}

fn answer_all(method: &'static MethodInfo, questions: &Receiver<Question>) {
    while let Ok(question) = questions.recv() {
        let answer = explain(method, &question).unwrap_or_else(|error| refusal(question.at, &error.to_string()));
        // Nobody waits for it any more if this fails.
        let _ = question.answer.send(answer.to_string());
    }
}

/// The message that says why there is no answer.
pub(crate) fn refusal(at: [usize; 2], error: &str) -> Value {
    json!({"type": "explanation", "at": at, "error": error})
}

fn explain(method: &'static MethodInfo, question: &Question) -> depthplanes::Result<Value> {
    let Question { frame: Recent { serial, video, values, ids }, at, .. } = question;
    let mut detector = Detector::new(method.of_values(values)?)?.sensor(video.frame.sensor);
    let mut why = detector.explain(video.frame.view()?, *at)?;
    name_by_id(&mut why.verdict, ids);
    let mut answer = explanation_record(&video.name, method, values, &why);
    answer["type"] = "explanation".into();
    answer["serial"] = (*serial).into();
    Ok(answer)
}

/// The page knows planes by their ids.
fn name_by_id(verdict: &mut Verdict, ids: &[u32]) {
    if let Verdict::Plane { label, .. } | Verdict::Off { label, .. } | Verdict::Unexplained { label } = verdict {
        let id = usize::from(*label).checked_sub(1).and_then(|at| ids.get(at));
        *label = id.and_then(|id| u16::try_from(*id).ok()).unwrap_or(*label);
    }
}

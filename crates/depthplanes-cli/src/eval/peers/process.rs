//! The program behind a command: started once, asked and answering in lines of JSON.

use crate::failure::{Failure, Outcome};
use serde::de::DeserializeOwned;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

/// How numerical libraries are told how many threads to use.
const THREADS: [&str; 3] = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"];

/// A running program; it is ended when this is dropped, and its folder goes.
pub(super) struct Process {
    command: String,
    child: Child,
    questions: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    folder: PathBuf,
}

impl Process {
    /// Starts the program: words with spaces between. Its standard error is ours.
    ///
    /// # Errors
    /// A program that is not there.
    pub(super) fn start(command: &str, threads: usize) -> Outcome<Self> {
        let mut words = command.split_whitespace();
        let failed = |why: String| {
            Failure::request(format!("--peers {command}: {why}; give a program and its arguments with spaces between"))
        };
        let program = words.next().ok_or_else(|| failed("it names no program".into()))?;
        let mut starting = Command::new(program);
        starting.args(words).stdin(Stdio::piped()).stdout(Stdio::piped());
        starting.envs(THREADS.map(|name| (name, threads.to_string())));
        let mut child = starting.spawn().map_err(|error| failed(format!("`{program}` cannot be started: {error}")))?;
        let questions = child.stdin.take();
        let answers = BufReader::new(child.stdout.take().expect("it is a pipe"));
        static STARTED: AtomicUsize = AtomicUsize::new(0);
        let name = format!("depthplanes-peers-{}-{}", std::process::id(), STARTED.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        Ok(Process { command: command.into(), child, questions, answers, folder })
    }

    /// A folder of its own with nothing in it.
    ///
    /// # Errors
    /// A disk that refuses.
    pub(super) fn empty_folder(&self) -> Outcome<PathBuf> {
        let _ = std::fs::remove_dir_all(&self.folder); // making it says what is wrong
        let failed = |error| Failure::machine(format!("{}: the folder cannot be made: {error}", self.folder.display()));
        std::fs::create_dir_all(&self.folder).map_err(failed)?;
        Ok(self.folder.clone())
    }

    /// Asks in a line, and reads the answer, a line too. Messages say `what` was asked for and what is `accepted`.
    ///
    /// # Errors
    /// A program that has ended, or that answers something else.
    pub(super) fn ask<T: DeserializeOwned>(&mut self, question: &str, what: &str, accepted: &str) -> Outcome<T> {
        let sent = self.questions.as_mut().map(|pipe| writeln!(pipe, "{question}").and_then(|()| pipe.flush()));
        let mut line = String::new();
        // A program that does not listen has ended or is about to: the missing answer says it.
        let read = if matches!(sent, Some(Ok(()))) { self.answers.read_line(&mut line) } else { Ok(0) };
        let wrong = |why: String| Failure::machine(format!("--peers {}: asked for {what}, {why}", self.command));
        match read {
            Err(error) => Err(wrong(format!("its answer cannot be read: {error}"))),
            Ok(0) => {
                self.questions = None;
                let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
                Err(wrong(format!("it ended without an answer ({status}); what it said of that is above")))
            }
            Ok(_) => serde_json::from_str(&line).map_err(|_| {
                let given: String = line.trim_end().chars().take(200).collect();
                wrong(format!("it answered `{given}`; accepted: a line like {accepted}"))
            }),
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It has answered all that was asked; nothing of it is lost.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

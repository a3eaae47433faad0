//! `depthplanes serve`: the live page.
//!
//! In: a source of frames. Out: a page on a socket, and a line that says where; it ends with a signal.

use crate::args::Serve;
use crate::failure::{Failure, Outcome, note, say};
use crate::load;
use crate::run::Recipe;
use crate::signals;
use depthplanes::noise::SensorNoise;
use depthplanes_serve::{Config, Server};
use depthplanes_video::{SourceOptions, open};
use std::io::Write;
use std::net::{SocketAddr, TcpListener};

pub(super) fn run(wanted: &Serve, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
    let mut read = load::options(&wanted.reading)?;
    read.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let source = open(&wanted.source, &SourceOptions::default().read(read.clone()))?;
    let mut config = Config::default();
    config.name.clone_from(&wanted.source);
    (config.method, config.values, config.read) = (wanted.method, recipe.values, read);
    config.up = wanted.up;
    config.camera_height_m = wanted.camera_height;
    config.kept_frames = wanted.kept_frames.unwrap_or(config.kept_frames);
    config.ignore_poses = wanted.ignore_poses;
    config.hosts.clone_from(&wanted.hosts);

    let interrupted = signals::Interruption::heard().map_err(|error| Failure::machine(format!("signals: {error}")))?;
    let listener = listen((wanted.bind, wanted.port).into())?;
    let server = Server::start(listener, source, config).map_err(failed)?;
    writeln!(out, "http://{}/", shown(server.address()))?;
    out.flush()?;
    if wanted.bind.is_loopback() {
        say("only this machine can open the page (--bind lets others in); Ctrl-C ends it");
    } else {
        let port = server.address().port();
        note(&format!(
            "other machines can open the page under this machine's addresses (port {port}), see the video and change parameters; \
             nobody is asked for a password"
        ));
    }
    interrupted.wait();
    server.stop();
    Ok(())
}

fn listen(address: SocketAddr) -> Outcome<TcpListener> {
    TcpListener::bind(address).map_err(|error| {
        let hint = if error.kind() == std::io::ErrorKind::AddrInUse { "; --port 0 takes one that is free" } else { "" };
        Failure::request(format!("{address}: {error}{hint}"))
    })
}

/// An address that a browser can be given.
fn shown(mut address: SocketAddr) -> SocketAddr {
    if address.ip().is_unspecified() {
        address.set_ip(std::net::Ipv4Addr::LOCALHOST.into());
    }
    address
}

fn failed(error: depthplanes_serve::Error) -> Failure {
    match error {
        depthplanes_serve::Error::Library(error) => error.into(),
        error => Failure::machine(error.to_string()),
    }
}

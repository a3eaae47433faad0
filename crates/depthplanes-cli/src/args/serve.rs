//! `depthplanes serve`: its flags and what they mean.

use super::flags::{self, Reading, path_given};
use super::outputs;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use depthplanes::methods::MethodInfo;
use depthplanes_video::StatedUp;
use std::net::IpAddr;
use std::path::PathBuf;

/// What is wanted of the live page.
pub(crate) struct Serve {
    pub(crate) source: String,
    pub(crate) reading: Reading,
    pub(crate) method: &'static MethodInfo,
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) noise_table: Option<PathBuf>,
    pub(crate) up: StatedUp,
    pub(crate) camera_height: Option<f64>,
    pub(crate) kept_frames: Option<u32>,
    pub(crate) ignore_poses: bool,
    pub(crate) port: u16,
    pub(crate) bind: IpAddr,
    /// Names of this machine, beside `localhost`.
    pub(crate) hosts: Vec<String>,
}

/// The port, if nothing is said.
const PORT: &str = "7878";

/// The command; `method` has the flags of the method.
pub(super) fn command(method: Vec<Arg>) -> Command {
    let page = [
        Arg::new("port")
            .long("port")
            .value_name("N")
            .value_parser(value_parser!(u16))
            .default_value(PORT)
            .help("The port; 0 for any that is free"),
        Arg::new("bind")
            .long("bind")
            .value_name("ADDRESS")
            .value_parser(value_parser!(IpAddr))
            .default_value("127.0.0.1")
            .help("The address to listen at; 0.0.0.0 lets other machines in"),
        Arg::new("host")
            .long("host")
            .value_name("NAME")
            .action(ArgAction::Append)
            .value_parser(host_name)
            .help("A name of this machine by which browsers may ask for the page, beside localhost and addresses"),
    ];
    let running = [
        flags::count("kept-frames", "N").help("Frames for which a plane that is not seen keeps its id [default: 30]"),
        flags::switch("ignore-poses", "Estimate how the camera moves even where the source says it"),
    ];
    let under = |heading: &'static str| move |arg: Arg| arg.help_heading(heading);
    Command::new("serve")
        .about("Shows depth video live in a browser: planes, floor, obstacles; sliders act at once")
        .arg(flags::source())
        .args(page.map(under("Page")))
        .args(outputs::ground_flags().map(under("Ground")))
        .arg(outputs::world_up().help_heading("Ground"))
        .args(flags::reading())
        .args(method)
        .args(running.map(under("Running")))
}

/// A name as browsers send it, without scheme and port.
fn host_name(given: &str) -> Result<String, String> {
    let is_label = |label: &str| {
        !label.is_empty() && label.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte))
    };
    if given.split('.').all(is_label) {
        Ok(given.into())
    } else {
        Err("accepted: a name such as robot.local, without http:// and port".into())
    }
}

pub(super) fn from_matches(matches: &ArgMatches, method: &'static MethodInfo) -> Serve {
    Serve {
        source: matches.get_one::<String>("source").cloned().expect("it is required"),
        reading: Reading::from_matches(matches),
        method,
        parameters: flags::parameters_given(matches),
        noise_table: path_given(matches, "noise-table"),
        up: outputs::stated_up(matches),
        camera_height: matches.get_one("camera-height").copied(),
        kept_frames: matches.get_one::<usize>("kept-frames").map(|&frames| frames as u32),
        ignore_poses: matches.get_flag("ignore-poses"),
        port: *matches.get_one("port").expect("it has a default"),
        bind: *matches.get_one("bind").expect("it has a default"),
        hosts: matches.get_many::<String>("host").into_iter().flatten().cloned().collect(),
    }
}

//! The program `depthplanes`: planes from depth and disparity maps, on the command line.

use std::process::ExitCode;

// musl's own allocator asks the system anew for each large block: `ngaf`, `normals` and `hough` take half as long again.
#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

fn main() -> ExitCode {
    depthplanes_cli::main(std::env::args_os()).into()
}

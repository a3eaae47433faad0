//! The name that programs remember the shared library by: of versions before 1.0 each minor one may change the interface.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        let part = |name: &str| std::env::var(format!("CARGO_PKG_VERSION_{name}")).expect("cargo sets it");
        let (major, minor) = (part("MAJOR"), part("MINOR"));
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libdepthplanes.so.{major}.{minor}");
    }
}

//! Gives the shared library the name under which programs look for it when they start.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        // The number is LEAFLESS_ABI, so that programs never meet a library that does not fit.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libleafless.so.0");
    }
}

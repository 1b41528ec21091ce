//! Sets the name of the shared library that programs look for when they start.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // For `packaging/notices.rs`.
    println!("cargo::rustc-env=LEAFLESS_TARGET={}", std::env::var("TARGET").unwrap_or_default());
    // The number is LEAFLESS_ABI, so that programs never load an incompatible library.
    let (name, option) = match std::env::var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("linux") => ("libleafless.so.0", "-Wl,-soname,"),
        // Programs define `@rpath`.
        Ok("macos") => ("libleafless.0.dylib", "-Wl,-install_name,@rpath/"),
        _ => return,
    };
    println!("cargo::rustc-cdylib-link-arg={option}{name}");
    // For `packaging/install.rs`.
    println!("cargo::rustc-env=LEAFLESS_SONAME={name}");
}

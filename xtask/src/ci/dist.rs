//! The files of a release for Linux, in `target/dist`: wheel and sources of the Python package, the
//! package for Debian, the archive for `cargo binstall`, and their sums by SHA-256.
//!
//! A commit gives the same bytes at any time and in any folder: the files have the time of the
//! commit, archives are sorted and have no owner, and the paths of this computer are replaced.

use super::{Outcome, Problem, Runner, tools};

/// Platform of the release.
const PLATFORM: &str = "x86_64-unknown-linux-gnu";

/// Linker of everything that is compiled, with the oldest glibc on which it runs.
const LINKER: &str = "#!/bin/sh\nexec maturin zig cc -- -target x86_64-linux-gnu.2.17 \"$@\"\n";

/// Lines of a shell, with the variables of [`run`].
const STEPS: [&str; 12] = [
    // changes without a commit belong to no release
    "git diff --exit-code --stat HEAD",
    "rm -rf $DIST $FILES; mkdir -p $DIST $FILES/completions",
    // a second release uses the tools of the first through a link, which `venv` refuses
    "[ -L $TOOLS ] || python3 -m venv $TOOLS; pip install --quiet maturin==1.16.0 ziglang==0.17.1",
    "printf %s \"$LINKER\" > $TOOLS/bin/linker; chmod +x $TOOLS/bin/linker",
    "CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER=cc \
     cargo install --quiet --locked --root $TOOLS --target-dir $TOOLS/target cargo-deb@3.8.0",
    "cargo build --locked --profile dist --target $PLATFORM -p phea-cli",
    "maturin build --compatibility manylinux2014 --target $PLATFORM --out $DIST",
    "maturin sdist --out $DIST",
    "cp LICENSE-* README.md $FILES/../phea $FILES; $FILES/phea man --out $FILES/man; \
     for shell in bash elvish fish powershell zsh; do \
     $FILES/phea completions $shell > $FILES/completions/phea.$shell; done",
    "cargo-deb --no-build --no-strip --locked --profile dist --target $PLATFORM -p phea-cli --output $DIST",
    "tar --create --sort=name --mtime=@$SOURCE_DATE_EPOCH --owner=0 --group=0 --numeric-owner \
     --mode=u=rwX,go=rX --transform=s,^package,$ARCHIVE, --use-compress-program='gzip -9 -n' \
     --file=$DIST/$ARCHIVE.tar.gz --directory=$FILES/.. package",
    "cd $DIST; sha256sum phea* > SHA256SUMS; cat SHA256SUMS; ls -l",
];

/// Makes the files from the current commit.
pub(super) fn run(runner: &Runner) -> Outcome {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Err(Problem::Skipped(format!("the release is made on {PLATFORM}")));
    }
    tools::python()?;
    let output = |line: &str| tools::output(line).unwrap_or_default().trim().to_string();
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let cargo = std::env::var("CARGO_HOME").unwrap_or(variable("HOME") + "/.cargo");
    let library = output("rustc --print sysroot") + "/lib/rustlib/src/rust";
    let compiler = output("rustc --version --verbose");
    let commit = compiler.lines().find_map(|line| line.strip_prefix("commit-hash: ")).unwrap_or_default();
    let replaced = [
        (runner.root.to_string_lossy().into_owned(), "/phea"),
        (runner.target.to_string_lossy().into_owned(), "/phea/target"),
        (cargo, "/cargo"),
        (library, &format!("/rustc/{commit}")),
    ];
    let flags = replaced.map(|(folder, name)| format!("--remap-path-prefix {folder}={name}"));
    let variables = [
        // not in `target`, where cargo would put the builds of the profile `dist` next to the files
        ("CARGO_TARGET_DIR", runner.path("release-files")),
        ("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER", runner.path("tools/bin/linker")),
        ("ARCHIVE", format!("phea-{}-{PLATFORM}", env!("CARGO_PKG_VERSION"))),
        ("DIST", runner.path("dist")),
        ("FILES", runner.path(&format!("release-files/{PLATFORM}/dist/package"))),
        ("LINKER", LINKER.to_string()),
        ("PATH", format!("{}:{}", runner.path("tools/bin"), variable("PATH"))),
        ("PLATFORM", PLATFORM.to_string()),
        ("RUSTFLAGS", flags.join(" ")),
        ("SOURCE_DATE_EPOCH", output("git log -1 --format=%ct")),
        ("TOOLS", runner.path("tools")),
    ];
    let variables = variables.each_ref().map(|(name, value)| (*name, value.as_str()));
    STEPS.iter().try_for_each(|step| runner.execute(&["sh", "-euc", step], &variables))
}

/// Makes the files again, from a clone of the commit in another folder, and compares their sums.
pub(super) fn again(runner: &Runner) -> Outcome {
    let clone = runner.path("again");
    let steps = [
        format!("rm -rf {clone}"),
        format!("git clone --quiet . {clone}"),
        format!("mkdir {clone}/target"),
        format!("ln -s {} {clone}/target/tools", runner.path("tools")),
        format!("cargo run --quiet --manifest-path {clone}/Cargo.toml -p xtask -- dist"),
        format!("diff {}/SHA256SUMS {clone}/target/dist/SHA256SUMS", runner.path("dist")),
    ];
    runner.steps(&steps, &[("CARGO_TARGET_DIR", &format!("{clone}/target"))])
}

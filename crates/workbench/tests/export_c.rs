//! Exported C gives the bits of the simulation, whatever the compiler does.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use phea_machine::Deployed;
use phea_workbench::export::{DeployedSignal, ExportKind};

use crate::exported::{commands, drawn, exported, samples};

const WARNINGS: &str = "-pedantic -Wall -Wextra -Werror -Wconversion -Wsign-conversion \
    -Wdouble-promotion -Wfloat-equal -Wshadow -Wcast-qual -Wmissing-prototypes -Wvla";

/// A program that reads signals and writes commands, with the exported files beside it.
fn written(deployed: &Deployed, folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    let exported = exported(deployed);
    let files = ExportKind::C.files(&exported);
    assert!(files.iter().map(|file| &file.name).eq(&ExportKind::C.file_names("rig")));
    for file in files {
        fs::write(folder.join(&file.name), &file.bytes).unwrap();
    }
    let places = ["reference", "measurement", "velocity", "pressure"];
    let place = |signal: &DeployedSignal| places.iter().position(|name| *name == signal.name()).unwrap();
    let assigned = exported.signals().into_iter();
    let assigned: String =
        assigned.map(|one| format!("        read.{} = row[{}];\n", one.name(), place(&one))).collect();
    let program = format!(
        "#include \"rig.h\"\n#include <stdio.h>\nint main(void) {{\n    double row[4];\n    rig_state state;\n    \
         rig_signals read;\n    rig_reset(&state);\n    while (fread(row, sizeof row, 1, stdin) == 1) {{\n{assigned}        \
         row[0] = rig_step(&state, &read).command;\n        (void)fwrite(row, sizeof(double), 1, stdout);\n    }}\n    \
         return 0;\n}}\n"
    );
    fs::write(folder.join("through.c"), program).unwrap();
}

/// A compiler with its options, and the program that runs what it makes.
#[derive(Clone, Copy)]
struct Build {
    compiler: &'static str,
    options: &'static str,
    runner: Option<&'static str>,
}

const fn build(compiler: &'static str, options: &'static str) -> Build {
    Build { compiler, options, runner: None }
}

const fn on_arm(options: &'static str) -> Build {
    Build { compiler: "arm-linux-gnueabihf-gcc", options, runner: Some("qemu-arm") }
}

/// Builds whose results are compared in every run of the tests.
const ALWAYS: [Build; 2] =
    [build("gcc", "-std=c99 -O0"), build("gcc", "-std=c99 -O3 -march=native -ffp-contract=fast")];

/// Builds with every compiler, beyond those of every run.
const MORE: [Build; 7] = [
    build("gcc", "-std=c99 -O2 -fanalyzer"),
    build("gcc", "-std=gnu99 -O3 -march=native"),
    build("gcc", "-std=c99 -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all"),
    build("clang", "-std=c99 -O0 -Weverything -Wno-padded"),
    build("clang", "-std=gnu99 -O3 -march=native -ffp-contract=fast -Wno-overriding-t-option"),
    on_arm("-std=gnu99 -O3 -static -ffp-contract=fast -mfpu=neon-vfpv4"),
    on_arm("-std=c99 -O2 -static -mfpu=vfpv3-d16"),
];

impl Build {
    /// A program, compiled without a warning.
    fn program(&self, folder: &Path, main: &str) -> PathBuf {
        let out = folder.join("program");
        let mut command = Command::new(self.compiler);
        command.args(self.options.split_whitespace()).args(WARNINGS.split_whitespace());
        let status =
            command.args(["rig.c", "rig_self_test.c", main, "-o"]).arg(&out).current_dir(folder).status();
        assert!(status.unwrap().success(), "{} {} in {}", self.compiler, self.options, folder.display());
        out
    }

    fn command(&self, program: &Path) -> Command {
        match self.runner {
            None => Command::new(program),
            Some(runner) => {
                let mut command = Command::new(runner);
                command.arg(program);
                command
            }
        }
    }

    /// Commands for samples in a file.
    fn commands(&self, program: &Path, input: &Path) -> Vec<u64> {
        let input = fs::File::open(input).unwrap();
        let output = self.command(program).stdin(Stdio::from(input)).output().unwrap();
        output.stdout.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
    }
}

/// Compares a controller in the build that fuses most.
pub(crate) fn compare_fused(deployed: &Deployed, name: &str) {
    compare(deployed, name, 2000, &ALWAYS[1..]);
}

/// Compares a controller in these builds with the simulation, and runs its self test.
fn compare(deployed: &Deployed, name: &str, count: usize, builds: &[Build]) {
    let folder = std::env::temp_dir().join(format!("phea_export_c_{}_{name}", std::process::id()));
    written(deployed, &folder);
    let samples = samples(count, count as u64);
    let bytes: Vec<u8> = samples.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let input = folder.join("samples");
    fs::write(&input, bytes).unwrap();
    let expected = commands(deployed, &samples);
    for build in builds {
        let program = build.program(&folder, "through.c");
        let found = build.commands(&program, &input);
        assert!(found == expected, "controller {name}, {} {}", build.compiler, build.options);
        let test = build.program(&folder, "example_main.c");
        let outcome = build.command(&test).output().unwrap();
        assert!(outcome.status.success(), "{}", String::from_utf8_lossy(&outcome.stdout));
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn exported_c_gives_the_bits_of_the_simulation() {
    (1..13).for_each(|seed| compare(&drawn(seed), &seed.to_string(), 4000, &ALWAYS));
}

/// With fused products and sums allowed, the self test finds different results.
#[test]
fn relaxed_arithmetic_is_found_by_the_self_test() {
    let fused = build("gcc", "-std=c99 -O3 -march=native -ffp-contract=fast -DRIG_RELAXED");
    let folder = std::env::temp_dir().join(format!("phea_export_c_{}_relaxed", std::process::id()));
    let differs = |seed: u64| {
        written(&drawn(seed), &folder);
        !fused.command(&fused.program(&folder, "example_main.c")).output().unwrap().status.success()
    };
    let count = (1..7).filter(|seed| differs(*seed)).count();
    fs::remove_dir_all(folder).unwrap();
    // a processor without such an instruction has nothing to fuse
    assert_eq!(count, if has_fused_operations() { 6 } else { 0 });
}

fn has_fused_operations() -> bool {
    let target = Command::new("gcc").args(["-march=native", "-dM", "-E", "-x", "c", "/dev/null"]).output();
    String::from_utf8_lossy(&target.unwrap().stdout).contains("__FMA__")
}

/// A million samples of 300 controllers by every compiler, with sanitizers and on ARM.
#[test]
#[ignore = "part of the long tests; needs clang, gcc-arm-linux-gnueabihf and qemu-user"]
fn soak() {
    let builds = [ALWAYS.as_slice(), &MORE].concat();
    (1..301).for_each(|seed| compare(&drawn(seed), &seed.to_string(), 1_000_000, &builds));
}

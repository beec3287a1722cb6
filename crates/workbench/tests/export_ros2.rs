//! The exported package of ros2_control, compiled against stand-ins for both generations of its
//! interfaces.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use phea_machine::Deployed;
use phea_workbench::export::ExportKind;

use crate::exported::{commands, drawn, exported, samples};

const STAND_IN: &str = include_str!("ros2/stand_in.hpp");
const MAIN: &str = include_str!("ros2/main.cpp");

/// Headers that only include the stand-in.
const HEADERS: [&str; 6] = [
    "controller_interface/controller_interface.hpp",
    "pluginlib/class_list_macros.hpp",
    "rclcpp/rclcpp.hpp",
    "rclcpp_lifecycle/state.hpp",
    "realtime_tools/realtime_buffer.h",
    "std_msgs/msg/float64.hpp",
];

fn written(folder: &Path, deployed: &Deployed, humble: bool) {
    let mut headers = HEADERS.to_vec();
    if !humble {
        headers.push("realtime_tools/realtime_buffer.hpp");
    }
    for header in headers {
        let path = folder.join(header);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "#include \"stand_in.hpp\"\n").unwrap();
    }
    fs::write(folder.join("stand_in.hpp"), STAND_IN).unwrap();
    fs::write(folder.join("main.cpp"), MAIN).unwrap();
    let files = ExportKind::Ros2.files(&exported(deployed));
    assert!(files.iter().map(|file| &file.name).eq(&ExportKind::Ros2.file_names("rig")));
    for file in files {
        let text = String::from_utf8(file.bytes.clone()).unwrap();
        assert!(!text.contains('@') || text.contains("nobody@example.com"), "{text}");
        fs::write(folder.join(&file.name), &file.bytes).unwrap();
    }
}

fn compiled(folder: &Path, humble: bool) {
    let run = |line: &str| {
        let status = Command::new("sh").args(["-c", line]).current_dir(folder).status().unwrap();
        assert!(status.success(), "{line} in {}", folder.display());
    };
    let generation = if humble { "-DHUMBLE" } else { "" };
    run("gcc -std=c99 -O2 -c rig.c");
    run(&format!(
        "g++ -std=c++17 -O2 -Wall -Wextra -Werror {generation} -I. rig_controller.cpp main.cpp rig.o -o run"
    ));
}

#[test]
fn the_package_gives_the_bits_of_the_simulation() {
    let root = std::env::temp_dir().join(format!("phea_export_ros2_{}", std::process::id()));
    for (seed, humble) in [(5, true), (7, false)] {
        let deployed = drawn(seed);
        let folder = root.join(seed.to_string());
        written(&folder, &deployed, humble);
        compiled(&folder, humble);
        let samples = samples(1_000_000, seed);
        let bytes: Vec<u8> = samples.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        fs::write(folder.join("samples"), bytes).unwrap();
        let input = fs::File::open(folder.join("samples")).unwrap();
        let output = Command::new(folder.join("run")).stdin(Stdio::from(input)).output().unwrap();
        assert!(output.status.success(), "{seed}: {}", String::from_utf8_lossy(&output.stderr));
        let found = output.stdout.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes));
        assert!(found.eq(commands(&deployed, &samples)), "controller {seed}");
    }
    fs::remove_dir_all(root).unwrap();
}

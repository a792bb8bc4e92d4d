//! The official Python reader of MCAP opens what is written here, packed too, and we what its writer packs.

use std::fs;
use std::process::{Command, Stdio};

use crate::common::Folder;

const READ: &str = "
import sys
from mcap.reader import make_reader
for name in sys.argv[1:]:
    with open(name, 'rb') as file:
        reader = make_reader(file, validate_crcs=True)
        print(sum(1 for _ in reader.iter_messages()), reader.get_summary().statistics.message_count)
";
const WRITE: &str = "
import struct, sys
from mcap.writer import Writer
with open(sys.argv[1], 'wb') as file:
    writer = Writer(file)
    writer.start(profile='ros2')
    text = 'std_msgs/Header header\\ngeometry_msgs/Wrench wrench\\n'
    schema = writer.register_schema('geometry_msgs/msg/WrenchStamped', 'ros2msg', text.encode())
    channel = writer.register_channel('/ft', 'cdr', schema)
    for k in range(20000):
        second, rest = divmod(k * 1000000, 10**9)
        header = struct.pack('<iII', second, rest, 4) + b'tip\\0'
        data = b'\\0\\1\\0\\0' + header + struct.pack('<6d', 0, 0, -2, 0, 0, k * 1e-6)
        writer.add_message(channel, log_time=k * 1000000, publish_time=k * 1000000, data=data)
    writer.finish()
";

/// Python with the package `mcap`: what `FINGERTIP_PYTHON` names, or `python3`.
fn python() -> Option<String> {
    let python = std::env::var("FINGERTIP_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut command = Command::new(&python);
    command.args(["-c", "import mcap, zstandard, lz4"]).stdout(Stdio::null()).stderr(Stdio::null());
    let found = command.status().is_ok_and(|status| status.success());
    if !found {
        println!("skipped: {python} has no package mcap; name one that has by FINGERTIP_PYTHON");
    }
    found.then_some(python)
}

#[test]
fn python_reads_what_we_write_and_we_what_python_packs() {
    let Some(python) = python() else { return };
    let folder = Folder::new();
    let run = |script: &str, names: &[&str]| {
        let names = names.iter().map(|name| folder.path(name));
        let output = Command::new(&python).args(["-c", script]).args(names).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    run(WRITE, &["py.mcap"]);
    let said = folder.succeed(&["info", "py.mcap"]).replace('\u{202f}', "");
    assert!(said.contains("/ft: 20000 messages, wrenches [N, N·m], frame tip"), "{said}");
    let whole = fs::read(folder.path("py.mcap")).unwrap();
    fs::write(folder.path("cut.mcap"), &whole[..whole.len() / 2]).unwrap();
    let mut names = Vec::new();
    for packing in ["none", "lz4", "zstd"] {
        let name = format!("{packing}.mcap");
        folder.succeed(&["recover", "cut.mcap", &name, "--compression", packing]);
        names.push(name);
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let counts = run(READ, &names);
    let counts: Vec<u32> = counts.split_whitespace().map(|count| count.parse().unwrap()).collect();
    assert!(counts.len() == 6 && counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    assert!((8000..12_000).contains(&counts[0]), "{counts:?}");
}

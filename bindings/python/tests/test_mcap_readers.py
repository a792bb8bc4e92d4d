"""The official reader of MCAP opens what is written here, plain and packed, and we what its writer packs."""

import csv
import struct
import subprocess
import sys

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

COMMAND = [sys.executable, "-m", "fingertip._command"]
PACKINGS = ["none", "lz4", "zstd"]
WRENCH = "geometry_msgs/msg/WrenchStamped"


def fingertip(folder, *arguments):
    run = subprocess.run([*COMMAND, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout.replace("\u202f", "")


def read(path):
    """All messages of a file by their topics, once its checksums, its index and its statistics were checked."""
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        messages = list(reader.iter_messages())
    assert summary.statistics.message_count == len(messages)
    topics = {}
    for schema, channel, message in messages:
        assert channel.message_encoding == "cdr" and schema.encoding == "ros2msg" and schema.data
        topics.setdefault(channel.topic, []).append((schema.name, message))
    for topic in topics:
        # Through the index of the chunks, too.
        with path.open("rb") as file:
            assert sum(1 for _ in make_reader(file).iter_messages(topics=[topic])) == len(topics[topic])
    return topics, {chunk.compression for chunk in summary.chunk_indexes}


def wrench(message):
    """Seconds, frame and components of a stamped wrench in CDR, little-endian."""
    second, rest, length = struct.unpack_from("<iII", message.data, 4)
    frame = message.data[16 : 16 + length - 1].decode()
    start = 4 + (12 + length + 7) // 8 * 8
    return second + rest * 1e-9, frame, struct.unpack_from("<6d", message.data, start)


def packed(packing):
    return {"" if packing == "none" else packing}


@pytest.mark.parametrize("packing", PACKINGS)
def test_what_is_converted_is_read(tmp_path, packing):
    random = np.random.default_rng(4)
    rows = np.column_stack([np.arange(30_000) * 1e-3, random.normal(size=(30_000, 6)).round(6)])
    header = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm"
    np.savetxt(tmp_path / "a.csv", rows, delimiter=",", header=header, comments="", fmt="%.9g")
    fingertip(tmp_path, "convert", "a.csv", "a.mcap", "--compression", packing)
    topics, compressions = read(tmp_path / "a.mcap")
    assert list(topics) == ["/fingertip/wrench"] and compressions == packed(packing)
    found = [wrench(message) for name, message in topics["/fingertip/wrench"] if name == WRENCH]
    assert {frame for _, frame, _ in found} == {"fingertip_sensor"}
    assert np.array_equal([components for _, _, components in found], rows[:, 1:])
    assert np.abs(np.array([time for time, _, _ in found]) - rows[:, 0]).max() < 1e-9


@pytest.mark.parametrize("packing", PACKINGS)
def test_what_is_recorded_is_read(tmp_path, packing):
    record = ["record", "sim?rate_Hz=1e6", "--samples", "3000", "--scene", "sim", "-o"]
    fingertip(tmp_path, *record, "a.mcap", "--compression", packing)
    topics, compressions = read(tmp_path / "a.mcap")
    assert compressions == packed(packing)
    names = {topic: messages[0][0] for topic, messages in topics.items()}
    assert names["/fingertip/wrench"] == WRENCH and len(topics["/fingertip/wrench"]) == 3000
    assert names["/fingertip/signals"] == names["/fingertip/dummy"] == "fingertip_msgs/msg/Signals"
    # The same numbers as in CSV, which the command makes of it.
    fingertip(tmp_path, "convert", "a.mcap", "a.csv", "--topic", "/fingertip/wrench")
    with (tmp_path / "a.csv").open() as file:
        lines = csv.reader(line for line in file if not line.startswith("#"))
        rows = np.array([[float(cell) for cell in line] for line in list(lines)[1:]])
    found = np.array([wrench(message)[2] for _, message in topics["/fingertip/wrench"]])
    assert np.array_equal(rows[:, 1:], found)


def test_what_the_official_writer_packs_is_read_and_recovered(tmp_path):
    for compression in CompressionType:
        name = f"{compression.name.lower()}.mcap"
        with (tmp_path / name).open("wb") as file:
            writer = Writer(file, compression=compression)
            writer.start(profile="ros2")
            text = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n"
            schema = writer.register_schema(WRENCH, "ros2msg", text.encode())
            channel = writer.register_channel("/ft", "cdr", schema)
            for k in range(20_000):
                second, rest = divmod(k * 1_000_000, 10**9)
                header = struct.pack("<iII", second, rest, 4) + b"tip\0"
                data = b"\0\1\0\0" + header + struct.pack("<6d", 0, 0, -2, 0, 0, k * 1e-6)
                writer.add_message(channel, log_time=k * 1_000_000, publish_time=k * 1_000_000, data=data)
            writer.finish()
        said = fingertip(tmp_path, "info", name)
        assert "/ft: 20000 messages, wrenches [N, N·m], frame tip" in said, said
        whole = (tmp_path / name).read_bytes()
        (tmp_path / "cut.mcap").write_bytes(whole[: len(whole) // 2])
        for packing in PACKINGS:
            fingertip(tmp_path, "recover", "cut.mcap", "out.mcap", "--compression", packing, "--overwrite")
            topics, compressions = read(tmp_path / "out.mcap")
            found = [wrench(message) for _, message in topics["/ft"]]
            assert 8000 < len(found) < 12_000 and compressions == packed(packing)
            assert [round(components[5] * 1e6) for _, _, components in found] == list(range(len(found)))

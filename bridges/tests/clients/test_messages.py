"""The package of messages, read by the packages of others that build it or read its messages."""

import subprocess
from pathlib import Path

import pytest
from catkin_pkg.package import parse_package
from conftest import FINGERTIP
from mcap.reader import make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

PACKAGE = Path(__file__).parents[2] / "ros" / "fingertip_msgs"


@pytest.fixture(scope="module")
def types():
    """What ROS 2 has, and these."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for file in sorted(PACKAGE.glob("msg/*.msg")):
        store.register(get_types_from_msg(file.read_text(), f"fingertip_msgs/msg/{file.stem}"))
    return store


def test_the_package_says_what_it_needs():
    package = parse_package(str(PACKAGE))
    assert package.name == "fingertip_msgs" and package.licenses and package.maintainers
    needs = {dependency.name for dependency in package.build_depends + package.exec_depends}
    used = set()
    for file in PACKAGE.glob("msg/*.msg"):
        used |= {line.split("/")[0] for line in file.read_text().splitlines() if "/" in line.split(" ")[0]}
    assert used - {"#"} <= needs, (used, needs)
    assert "rosidl_interface_packages" in {member.name for member in package.member_of_groups}
    assert package.get_build_type() == "ament_cmake"
    cmake = (PACKAGE / "CMakeLists.txt").read_text()
    assert all(f"msg/{file.name}" in cmake for file in PACKAGE.glob("msg/*.msg"))


def test_messages_are_what_the_package_says(types, live, tmp_path):
    """What `record` writes, and with it every bridge, is decoded by the definitions of the package."""
    recording = tmp_path / "touch.mcap"
    command = [FINGERTIP, "record", "sim", "--samples", "500", "--scene", "sim", "-q", "-o", recording]
    subprocess.run(command, check=True, timeout=60)
    seen = {}
    with open(recording, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.message_encoding != "cdr" or schema.name == "tactile_msgs/msg/TactileContact":
                continue
            decoded = types.deserialize_cdr(message.data, schema.name)
            # And back again, byte for byte: nothing was passed over.
            assert bytes(types.serialize_cdr(decoded, schema.name)) == message.data, schema.name
            seen.setdefault(schema.name, []).append(decoded)
    assert len(seen["fingertip_msgs/msg/Touch"]) == 500 and len(seen["fingertip_msgs/msg/Signals"]) >= 500
    for number, touch in enumerate(seen["fingertip_msgs/msg/Touch"]):
        assert touch.number == number and touch.header.frame_id == "fingertip_sensor"
        said = (PACKAGE / "msg" / "Touch.msg").read_text()
        assert touch.status == "contact" or touch.status in said
        if touch.status == "contact":
            n, f = touch.normal, touch.load.force
            assert abs(touch.normal_force + n.x * f.x + n.y * f.y + n.z * f.z) < 1e-9

"""ROS 2, with PyPI `cyclonedds` as the other side, on loopback alone."""

import os
import random
import socket
import subprocess
import sys
import time
from dataclasses import dataclass
from math import isnan

# Before the library is loaded.
os.environ["CYCLONEDDS_URI"] = (
    '<CycloneDDS><Domain Id="any"><General><AllowMulticast>false</AllowMulticast><Interfaces>'
    '<NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces></General><Discovery>'
    "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>"
    '<Peers><Peer Address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>'
)

from conftest import RADIUS, check_consecutive, close, now, said, timer  # noqa: E402
from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import IdlStruct  # noqa: E402
from cyclonedds.idl.types import array, float32, float64, int32, int64, sequence, uint8, uint32, uint64  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from cyclonedds.util import duration  # noqa: E402

DOMAIN = int(os.environ.get("FINGERTIP_TEST_DOMAIN", 100 + os.getpid() % 100))
SENSOR = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(20_000))
RELIABLE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(20_000))
KEPT = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal, Policy.History.KeepLast(10))


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    sec: int32
    nanosec: uint32
    frame_id: str

    def stamp(self):
        return self.sec + self.nanosec * 1e-9


@dataclass
class WrenchStamped(IdlStruct, typename="geometry_msgs::msg::dds_::WrenchStamped_"):
    header: Header
    wrench: array[float64, 6]


@dataclass
class PointStamped(IdlStruct, typename="geometry_msgs::msg::dds_::PointStamped_"):
    header: Header
    point: array[float64, 3]


@dataclass
class TactileContact(IdlStruct, typename="tactile_msgs::msg::dds_::TactileContact_"):
    header: Header
    name: str
    position: array[float64, 3]
    normal: array[float64, 3]
    wrench: array[float64, 6]


@dataclass
class Touch(IdlStruct, typename="fingertip_msgs::msg::dds_::Touch_"):
    header: Header
    number: uint64
    time: float64
    status: str
    load: array[float64, 6]
    point: array[float64, 3]
    normal: array[float64, 3]
    normal_force: float64
    tangential_force: array[float64, 3]
    spin_torque: float64
    margin: float64
    utilisation: float64
    slip: uint8


@dataclass
class Transform(IdlStruct, typename="geometry_msgs::msg::dds_::TransformStamped_"):
    header: Header
    child_frame_id: str
    translation: array[float64, 3]
    rotation: array[float64, 4]


@dataclass
class TFMessage(IdlStruct, typename="tf2_msgs::msg::dds_::TFMessage_"):
    transforms: sequence[Transform]


@dataclass
class Vector(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    xyz: array[float64, 3]


@dataclass
class Colour(IdlStruct, typename="std_msgs::msg::dds_::ColorRGBA_"):
    rgba: array[float32, 4]


@dataclass
class Place(IdlStruct, typename="visualization_msgs::msg::dds_::UVCoordinate_"):
    uv: array[float32, 2]


@dataclass
class Marker(IdlStruct, typename="visualization_msgs::msg::dds_::Marker_"):
    header: Header
    ns: str
    id: int32
    type: int32
    action: int32
    pose: array[float64, 7]
    scale: array[float64, 3]
    color: Colour
    lifetime_sec: int32
    lifetime_nanosec: uint32
    frame_locked: bool
    points: sequence[Vector]
    colors: sequence[Colour]
    texture_resource: str
    texture_header: Header
    texture_format: str
    texture_data: sequence[uint8]
    uv_coordinates: sequence[Place]
    text: str
    mesh_resource: str
    mesh_file_name: str
    mesh_file_data: sequence[uint8]
    mesh_use_embedded_materials: bool


@dataclass
class MarkerArray(IdlStruct, typename="visualization_msgs::msg::dds_::MarkerArray_"):
    markers: sequence[Marker]


@dataclass
class Request(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Request_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    nothing: uint8


@dataclass
class Response(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Response_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    success: bool
    message: str


@dataclass
class ParameterValue(IdlStruct, typename="rcl_interfaces::msg::dds_::ParameterValue_"):
    type: uint8
    bool_value: bool
    integer_value: int64
    double_value: float64
    string_value: str
    byte_array_value: sequence[uint8]
    bool_array_value: sequence[bool]
    integer_array_value: sequence[int64]
    double_array_value: sequence[float64]
    string_array_value: sequence[str]


@dataclass
class Parameter(IdlStruct, typename="rcl_interfaces::msg::dds_::Parameter_"):
    name: str
    value: ParameterValue


@dataclass
class SetResult(IdlStruct, typename="rcl_interfaces::msg::dds_::SetParametersResult_"):
    successful: bool
    reason: str


@dataclass
class GetRequest(IdlStruct, typename="rcl_interfaces::srv::dds_::GetParameters_Request_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    names: sequence[str]


@dataclass
class GetResponse(IdlStruct, typename="rcl_interfaces::srv::dds_::GetParameters_Response_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    values: sequence[ParameterValue]


@dataclass
class ListRequest(IdlStruct, typename="rcl_interfaces::srv::dds_::ListParameters_Request_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    prefixes: sequence[str]
    depth: uint64


@dataclass
class ListResponse(IdlStruct, typename="rcl_interfaces::srv::dds_::ListParameters_Response_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    names: sequence[str]
    prefixes: sequence[str]


@dataclass
class SetRequest(IdlStruct, typename="rcl_interfaces::srv::dds_::SetParameters_Request_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    parameters: sequence[Parameter]


@dataclass
class SetResponse(IdlStruct, typename="rcl_interfaces::srv::dds_::SetParameters_Response_"):
    guid: array[uint8, 8]
    high: int32
    low: uint32
    results: sequence[SetResult]


class Peer:
    """The other side: a participant on loopback."""

    def __init__(self):
        self.participant = DomainParticipant(DOMAIN)

    def reader(self, name, kind, qos=SENSOR):
        return DataReader(self.participant, Topic(self.participant, name, kind, qos=qos), qos=qos)

    def writer(self, name, kind, qos=RELIABLE):
        return DataWriter(self.participant, Topic(self.participant, name, kind, qos=qos), qos=qos)


def gather(reader, count, seconds=40):
    """So many messages, with the time at which each came."""
    got, ends = [], time.monotonic() + seconds
    while len(got) < count:
        assert time.monotonic() < ends, f"{len(got)} of {count}"
        got += [(now(), message) for message in reader.take(1000)] or [time.sleep(0.0002)] * 0
    return got


def start(live, folder, *more, source=None):
    source = source or ["--replay", folder / "touch.csv"]
    environment = {"ROS_DOMAIN_ID": str(DOMAIN), "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}
    one = live(*source, "--scene", folder / "scene.toml", "--ros2", *more, environment=environment)
    one.line(r"ROS 2: +(\S+)")
    return one


def test_ten_thousand_samples_come_whole(live, folder, rows):
    peer = Peer()
    kinds = {"touch": Touch, "wrench": WrenchStamped, "contact": TactileContact, "point": PointStamped}
    readers = [peer.reader(f"rt/fingertip/{name}", kind, RELIABLE) for name, kind in kinds.items()]
    touches, wrenches, contacts, points = readers
    one = start(live, folder, "--ros-reliable")
    got = gather(touches, 10_000)
    check_consecutive([touch.number for _, touch in got], 10_000)
    by_stamp = {}
    for _, touch in got:
        row = rows[touch.number]
        by_stamp[(touch.header.sec, touch.header.nanosec)] = row
        assert touch.time == row.time and touch.load == row.wrench and touch.header.frame_id == "fingertip_sensor"
        assert touch.status == "contact" and close(touch.point, row.point, 1e-9) and close(touch.normal, row.normal, 1e-9)
        assert abs(touch.normal_force - row.normal_force) < 1e-9 and touch.slip in (1, 2, 3, 4)
        assert abs(touch.utilisation - row.utilisation) < 1e-9 and not isnan(touch.margin)
    # The others say the same of a sample. The readers become known one after the other, so that one may begin before the touches.
    says = [
        (wrenches, lambda message, row: message.wrench == row.wrench),
        (contacts, lambda message, row: message.name == "fingertip" and close(message.position, row.point, 1e-9)),
        (points, lambda message, row: close(message.point, row.point, 1e-9)),
    ]
    first, last = min(by_stamp), max(by_stamp)
    for reader, agrees in says:
        shared = 0
        for _, message in gather(reader, 9000):
            stamp = (message.header.sec, message.header.nanosec)
            if row := by_stamp.get(stamp):
                assert agrees(message, row), (message, row)
                shared += 1
            else:
                assert stamp < first or stamp > last, stamp
        assert shared >= 5000, shared
    said("ros2, from sample to client", [when - touch.header.stamp() for when, touch in got], median=1)
    one.end()


def test_best_effort_is_as_sensors_send(live, folder, rows):
    """What is lost on the way shows as a gap of numbers, and what comes is right."""
    peer = Peer()
    touches = peer.reader("rt/fingertip/touch", Touch)
    one = start(live, folder)
    got = [touch for _, touch in gather(touches, 5000)]
    assert all(touch.load == rows[touch.number].wrench for touch in got)
    lost = got[-1].number - got[0].number + 1 - len(got)
    print(f"\nros2, best effort: {lost} lost of {len(got) + lost}")
    assert lost < 250
    one.end()


def call(writer, reader, number, *asked, kind=Request, seconds=15):
    ends = time.monotonic() + seconds
    while not writer.get_matched_subscriptions() or not reader.get_matched_publications():
        assert time.monotonic() < ends, "no service"
        time.sleep(0.05)
    writer.write(kind([number] * 8, 0, number, *(asked or [0])))
    while True:
        assert time.monotonic() < ends, "no answer"
        for answer in reader.take(10):
            if list(answer.guid) == [number] * 8 and answer.low == number:
                return answer
        time.sleep(0.01)


def test_an_answer_waits_for_its_reader(live, folder):
    """DDS makes the ends known one after the other: a caller whose reader is known late is answered all the same."""
    peer = Peer()
    one = start(live, folder)
    writer = peer.writer("rq/fingertip/resetRequest", Request)
    ends = time.monotonic() + 15
    while not writer.get_matched_subscriptions():
        assert time.monotonic() < ends, "no service"
        time.sleep(0.05)
    writer.write(Request([7] * 8, 0, 7, 0))
    time.sleep(0.3)
    reader = peer.reader("rr/fingertip/resetReply", Response, RELIABLE)
    answers = []
    while not answers:
        assert time.monotonic() < ends, "no answer"
        answers = reader.take(10)
        time.sleep(0.01)
    assert list(answers[0].guid) == [7] * 8 and answers[0].success
    one.end()


def test_services_take_a_zero_and_forget(live, folder, rows):
    peer = Peer()
    one = start(live, folder)
    service = lambda name: (
        peer.writer(f"rq/fingertip/{name}Request", Request), peer.reader(f"rr/fingertip/{name}Reply", Response, RELIABLE)
    )
    touches = peer.reader("rt/fingertip/touch", Touch)
    answer = call(*service("tare"), 7)
    assert answer.success, answer
    numbers = answer.message.removeprefix("zero taken off: ").replace(" N,", "").replace(" N m", "").split()
    zero = [float(number) for number in numbers]
    touches.take(5000)
    touch = gather(touches, 1)[0][1]
    assert close([a + b for a, b in zip(touch.load, zero)], rows[round(touch.time * 1000)].wrench, 1e-12)
    assert call(*service("reset"), 8).success
    one.end()


def test_parameters_are_those_of_the_scene(live, folder):
    """As `ros2 param` asks for them."""
    peer = Peer()
    one = start(live, folder)

    def service(name, asked, answered):
        return (
            peer.writer(f"rq/fingertip/live/{name}Request", asked),
            peer.reader(f"rr/fingertip/live/{name}Reply", answered, RELIABLE),
        )

    listed = call(*service("list_parameters", ListRequest, ListResponse), 1, ["surface", "friction"], 0, kind=ListRequest)
    assert set(listed.prefixes) == {"surface", "friction"}, listed
    assert {"surface.radius_m", "surface.shape", "friction.static_coefficient"} <= set(listed.names), listed
    names = ["surface.radius_m", "surface.shape", "version", "none"]
    radius, shape, version, none = call(
        *service("get_parameters", GetRequest, GetResponse), 2, names, kind=GetRequest
    ).values
    assert (radius.type, radius.double_value, shape.type, shape.string_value) == (3, RADIUS, 4, "sphere")
    assert (version.type, version.integer_value, none.type) == (2, 2, 0)
    answer = call(
        *service("set_parameters", SetRequest, SetResponse), 3, [Parameter("surface.radius_m", radius)], kind=SetRequest
    )
    assert [result.successful for result in answer.results] == [False] and "of the scene" in answer.results[0].reason
    one.end()


def ports_of(process):
    """The UDP ports that a process listens on."""
    held = set()
    for number in os.listdir(f"/proc/{process}/fd"):
        try:
            held.add(os.readlink(f"/proc/{process}/fd/{number}"))
        except OSError:
            pass  # Closed meanwhile.
    ports = set()
    with open("/proc/net/udp") as file:
        for line in file.readlines()[1:]:
            cells = line.split()
            if f"socket:[{cells[9]}]" in held:
                ports.add(int(cells[1].split(":")[1], 16))
    return ports


def take_nothing():
    """A reliable reader whose place is full after ten samples, which it never takes. For a process of its own."""
    full = Qos(
        Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepAll,
        Policy.ResourceLimits(max_samples=10, max_instances=1, max_samples_per_instance=10),
    )
    kept = Peer().reader("rt/fingertip/touch", Touch, full)
    time.sleep(120)
    del kept


def test_participants_of_ill_will_cost_nobody_else_a_sample(live, folder, rows):
    """Bytes of no sense and cut messages at its ports, a reliable reader that takes nothing, participants that come and go."""
    peer = Peer()
    touches = peer.reader("rt/fingertip/touch", Touch, RELIABLE)
    one = start(live, folder, "--ros-reliable")
    gather(touches, 100)
    before = one.memory()
    stuck = subprocess.Popen(
        [sys.executable, "-c", "import test_ros2; test_ros2.take_nothing()"],
        cwd=os.path.dirname(__file__), env={**os.environ, "FINGERTIP_TEST_DOMAIN": str(DOMAIN)},
    )
    random.seed(5)
    ports = ports_of(one.process.pid)
    assert len(ports) >= 4, ports
    socket_ = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def attack(turn):
        head = b"RTPS" + bytes([2, 4, 1, 18]) + random.randbytes(12)
        # Submessages whose kind, flags and length say anything.
        parts = b"".join(
            bytes([random.choice([1, 6, 7, 8, 9, 0x15, 0x16, 0x12, 0x13, random.randrange(256)]), random.randrange(256)])
            + random.choice([len(rest), 0, 65535, random.randrange(65536)]).to_bytes(2, "little") + rest
            for rest in (random.randbytes(random.randrange(0, 200)) for _ in range(4))
        )
        for port in ports:
            for datagram in (random.randbytes(random.randrange(1, 1400)), head, head + parts, (head + parts)[: random.randrange(60)]):
                for _ in range(10):
                    socket_.sendto(datagram, ("127.0.0.1", port))
        if turn % 10 == 0:
            DomainParticipant(DOMAIN)

    got = []
    ends, turn = time.monotonic() + 60, 0
    with timer() as own:
        while len(got) < 6000:
            assert time.monotonic() < ends, len(got)
            if turn < 60:
                attack(turn)
            turn += 1
            got += [(now(), touch) for touch in touches.take(2000)]
            time.sleep(0.002)
    check_consecutive([touch.number for _, touch in got], 6000)
    assert all(touch.load == rows[touch.number].wrench for _, touch in got)
    steps = [abs(b.header.stamp() - a.header.stamp() - 1e-3) for (_, a), (_, b) in zip(got, got[1:])]
    said("ros2, step of the sampling, under attack", steps, most=1 + 1e3 * own[0])
    memory = one.memory()
    stuck.kill()
    stuck.wait()
    print(f"memory {before} kB before, {memory} kB under attack")
    assert memory - before < 40_000
    one.end()


def test_markers_and_frames_are_those_of_the_surface(live, folder, rows):
    peer = Peer()
    markers = peer.reader("rt/fingertip/markers", MarkerArray, RELIABLE)
    frames, fixed = peer.reader("rt/tf", TFMessage, RELIABLE), peer.reader("rt/tf_static", TFMessage, KEPT)
    one = start(live, folder)
    by_id = {}
    while 0 not in by_id:
        by_id |= {marker.id: marker for _, message in gather(markers, 1) for marker in message.markers}
    surface = by_id[0]
    assert len(surface.points) % 3 == 0 and len(surface.points) > 1000 and surface.type == 11
    assert all(abs(sum(x * x for x in point.xyz) ** 0.5 - 0.013) < 2e-4 for point in surface.points)
    ball, arrow = by_id[1], by_id[2]
    assert abs(sum(x * x for x in ball.pose[:3]) ** 0.5 - 0.013) < 1e-9 and len(arrow.points) == 2
    frame = gather(frames, 1)[0][1].transforms[0]
    assert frame.child_frame_id == "fingertip_sensor_contact" and frame.header.frame_id == "fingertip_sensor"
    i, j, k, w = frame.rotation
    third = [2 * (i * k + j * w), 2 * (j * k - i * w), 1 - 2 * (i * i + j * j)]
    assert close([0.013 * x for x in third], frame.translation, 1e-9)
    assert gather(fixed, 1)[0][1].transforms[0].child_frame_id == "fingertip_sensor_surface"
    one.end()


def test_wrenches_of_another_driver_are_a_source(live, folder, rows):
    peer = Peer()
    driver = peer.writer("rt/ft_sensor/wrench", WrenchStamped)
    touches = peer.reader("rt/fingertip/touch", Touch)
    one = start(live, folder, source=["ros2:///ft_sensor/wrench"])
    while not driver.get_matched_subscriptions() or not touches.get_matched_publications():
        time.sleep(0.05)
    got = []
    for number in range(3000):
        driver.write(WrenchStamped(Header(1000 + number // 1000, number % 1000 * 1_000_000, "ft"), rows[number].wrench))
        time.sleep(0.001)
        got += touches.take(100)
    ends = time.monotonic() + 5
    while len(got) < 3000 and time.monotonic() < ends:
        got += touches.take(100)
    times = [touch.time for touch in got]
    assert len(got) > 2900 and all(b > a for a, b in zip(times, times[1:])), len(got)
    # The time of a touch counts from the first message that was taken.
    first = next(number for number in range(3000) if rows[number].wrench == got[0].load)
    for touch in got:
        number = first + round((touch.time - got[0].time) * 1000)
        assert touch.load == rows[number].wrench and close(touch.point, rows[number].point, 1e-9)
    print(f"\nros2 as a source: {len(got)} of 3000, from message {first} on")
    one.end()


def test_a_node_that_was_killed_comes_back(live, folder):
    peer = Peer()
    touches = peer.reader("rt/fingertip/touch", Touch)
    for _ in range(2):
        one = start(live, folder)
        gather(touches, 100)
        one.kill()
        touches.take(20_000)

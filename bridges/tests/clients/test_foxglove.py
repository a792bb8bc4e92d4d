"""The WebSocket of Foxglove, with PyPI `websockets` as the client."""

import asyncio
import base64
import json
import socket
import struct
import subprocess
from pathlib import Path

import websockets
from conftest import FINGERTIP, RADIUS, check_consecutive, close, now, said, timer
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader

PROTOCOL = "foxglove.sdk.v1"


class Cdr:
    """Little-endian plain CDR, read field by field."""

    def __init__(self, data):
        assert data[:4] == b"\0\1\0\0"
        self.data, self.at = data[4:], 0

    def number(self, kind):
        size = struct.calcsize(kind)
        self.at = -(-self.at // size) * size
        (value,) = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += size
        return value

    def numbers(self, count):
        return [self.number("d") for _ in range(count)]

    def string(self):
        length = self.number("I")
        text = self.data[self.at : self.at + length - 1].decode()
        self.at += length
        return text

    def header(self):
        return self.number("i") + self.number("I") * 1e-9, self.string()


def read_touch(data):
    cdr = Cdr(data)
    stamp, frame = cdr.header()
    touch = {"stamp": stamp, "frame": frame, "number": cdr.number("Q"), "time": cdr.number("d"), "status": cdr.string()}
    touch |= {"load": cdr.numbers(6), "point": cdr.numbers(3), "normal": cdr.numbers(3), "normal_force": cdr.number("d")}
    touch |= {"tangential_force": cdr.numbers(3), "spin_torque": cdr.number("d"), "margin": cdr.number("d")}
    touch |= {"utilisation": cdr.number("d"), "slip": cdr.number("B")}
    assert cdr.at == len(cdr.data)
    return touch


def scene_update(name, schema):
    """The class of messages of this name, by the descriptors that a schema holds."""
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(schema).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def xyz(vector):
    return [vector.x, vector.y, vector.z]


def check_scene(scene, touches):
    """What a scene shows; a contact is held against the touch of its time."""
    for entity in scene.entities:
        assert entity.frame_id == "fingertip_sensor" and entity.frame_locked
        if entity.id == "surface":
            (triangles,) = entity.triangles
            assert len(triangles.points) % 3 == 0 and len(triangles.points) > 1000
            assert all(abs(sum(x * x for x in xyz(point)) ** 0.5 - RADIUS) < 2e-4 for point in triangles.points)
            return "surface"
        assert entity.id == "contact"
        touch = touches.get(entity.timestamp.seconds * 10**9 + entity.timestamp.nanos)
        if touch is None:
            return "contact without its touch"
        (ball,), (arrow,) = entity.spheres, entity.arrows
        assert xyz(ball.pose.position) == touch["point"]
        # The arrow ends at the contact, along the force, 4 mm for a newton.
        force = touch["load"][:3]
        size = sum(x * x for x in force) ** 0.5
        assert abs(arrow.shaft_length + arrow.head_length - 0.004 * size) < 1e-12
        assert close(xyz(arrow.pose.position), [at - 0.004 * along for at, along in zip(touch["point"], force)], 1e-12)
        q = arrow.pose.orientation
        first = [1 - 2 * (q.y**2 + q.z**2), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w)]
        assert close(first, [x / size for x in force], 1e-9)
        # The rim of the cone of friction goes round the normal, at the height of the normal force.
        corners = [xyz(point) for line in entity.lines for point in line.points if xyz(point) != touch["point"]]
        heights = [sum((a - b) * n for a, b, n in zip(corner, touch["point"], touch["normal"])) for corner in corners]
        assert corners and (close(heights, [0.004 * touch["normal_force"]] * len(heights), 1e-12) or len(entity.lines) > 1)
        return "contact"
    assert [deletion.id for deletion in scene.deletions] in ([], ["contact"])
    return "nothing"


async def connect(address):
    """A connection, its channels by topic, and its services by name."""
    stream = await websockets.connect(address, subprotocols=[PROTOCOL], max_size=None)
    assert stream.subprotocol == PROTOCOL
    return stream, *await advertised(stream)


async def advertised(stream):
    """The channels by topic, and the services by name."""
    channels, services = {}, {}
    while len(channels) < 4 or len(services) < 2:
        message = json.loads(await asyncio.wait_for(stream.recv(), 10))
        if message["op"] == "advertise":
            channels |= {channel["topic"]: channel for channel in message["channels"]}
        if message["op"] == "advertiseServices":
            services |= {service["name"]: service for service in message["services"]}
    return channels, services


async def subscribe(stream, channels, topics):
    chosen = [{"id": place, "channelId": channels[topic]["id"]} for place, topic in enumerate(topics)]
    await stream.send(json.dumps({"op": "subscribe", "subscriptions": chosen}))


async def data(stream):
    """The next message of a subscription: which, when, what."""
    while True:
        message = await asyncio.wait_for(stream.recv(), 20)
        if isinstance(message, bytes) and message[0] == 1:
            return (*struct.unpack_from("<IQ", message, 1), message[13:])


async def call(stream, service, number):
    encoding = b"json"
    await stream.send(struct.pack("<BIII", 2, service["id"], number, len(encoding)) + encoding + b"{}")
    while True:
        message = await asyncio.wait_for(stream.recv(), 20)
        if isinstance(message, bytes) and message[0] == 3:
            _, _, length = struct.unpack_from("<III", message, 1)
            return json.loads(message[13 + length :])
        if isinstance(message, str) and json.loads(message)["op"] == "serviceCallFailure":
            return json.loads(message)


def start(live, folder):
    one = live("--replay", folder / "touch.csv", "--scene", folder / "scene.toml", "--foxglove=127.0.0.1:0")
    return one, one.line(r"Foxglove: (\S+)")


def test_ten_thousand_samples_come_whole(live, folder, rows):
    one, address = start(live, folder)

    async def gather():
        stream, channels, _ = await connect(address)
        assert channels["/fingertip/wrench"]["schemaName"] == "geometry_msgs/msg/WrenchStamped"
        assert channels["/fingertip/touch"]["encoding"] == "cdr"
        assert channels["/fingertip/scene"]["schemaName"] == "foxglove.SceneUpdate"
        await subscribe(stream, channels, ["/fingertip/wrench", "/fingertip/contact", "/fingertip/touch"])
        got = {0: [], 1: [], 2: []}
        while len(got[2]) < 10_000:
            which, stamp, message = await data(stream)
            got[which].append((now(), stamp, message))
        await stream.close()
        return got

    got = asyncio.run(gather())
    touches = [read_touch(message) for _, _, message in got[2]]
    check_consecutive([touch["number"] for touch in touches], 10_000)
    stamps = {stamp: touch for (_, stamp, _), touch in zip(got[2], touches)}
    for touch in touches:
        row = rows[touch["number"]]
        assert touch["time"] == row.time and touch["load"] == row.wrench and touch["frame"] == "fingertip_sensor"
        assert close(touch["point"], row.point, 1e-9) and abs(touch["normal_force"] - row.normal_force) < 1e-9
        assert abs(touch["utilisation"] - row.utilisation) < 1e-9 and touch["slip"] in (1, 2, 3, 4)
    # All three say the same of a sample; one that came before or behind those of the touches is no match.
    matched = [0, 0]
    for _, stamp, message in got[0]:
        if stamp in stamps:
            cdr = Cdr(message)
            cdr.header()
            assert cdr.numbers(6) == stamps[stamp]["load"]
            matched[0] += 1
    for _, stamp, message in got[1]:
        if stamp in stamps:
            cdr = Cdr(message)
            cdr.header()
            assert cdr.string() == "fingertip" and cdr.numbers(3) == stamps[stamp]["point"]
            matched[1] += 1
    assert min(matched) >= 9_990, matched
    said("foxglove, from sample to client", [when - stamp * 1e-9 for when, stamp, _ in got[2]], median=1)
    one.end()


def test_the_scene_is_that_of_the_touch(live, folder, rows):
    """The scene, decoded by the schema that the server gives: the surface, and what touches it."""
    one, address = start(live, folder)

    async def gather():
        stream, channels, _ = await connect(address)
        await subscribe(stream, channels, ["/fingertip/scene", "/fingertip/touch"])
        scenes, touches = [], {}
        while len(scenes) < 40:
            which, stamp, message = await data(stream)
            if which:
                touches[stamp] = read_touch(message)
            else:
                scenes.append(message)
        await stream.close()
        return channels["/fingertip/scene"], scenes, touches

    channel, scenes, touches = asyncio.run(gather())
    kind = scene_update(channel["schemaName"], base64.b64decode(channel["schema"]))
    matched = [check_scene(kind.FromString(scene), touches) for scene in scenes]
    assert matched.count("surface") >= 1 and matched.count("contact") >= 30, matched
    one.end()


def test_a_zero_is_taken(live, folder, rows):
    one, address = start(live, folder)

    async def talk():
        stream, channels, services = await connect(address)
        zero = await call(stream, services["/fingertip/tare"], 1)
        assert zero["success"] and len(zero["zero"]) == 6, zero
        assert (await call(stream, services["/fingertip/reset"], 2))["success"]
        await subscribe(stream, channels, ["/fingertip/touch"])
        touch = read_touch((await data(stream))[2])
        await stream.close()
        row = rows[round(touch["time"] * 1000)]
        assert close([a + b for a, b in zip(touch["load"], zero["zero"])], row.wrench, 1e-12)

    asyncio.run(talk())
    one.end()


def test_the_client_of_foxglove_takes_touches_and_a_zero(live, folder, rows):
    """npm @foxglove/ws-protocol, which Foxglove itself is built on."""
    one, address = start(live, folder)
    client = Path(__file__).with_name("client.mjs")
    done = subprocess.run(["node", client, address, "2000"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    got = json.loads(done.stdout)
    check_consecutive(got["numbers"], 2000)
    assert all(load == rows[number].wrench for number, load in zip(got["numbers"], got["loads"]))
    assert got["call"] == 7 and got["zero"]["success"] and len(got["zero"]["zero"]) == 6
    assert got["channels"]["/fingertip/touch"] == ["cdr", "fingertip_msgs/msg/Touch", "ros2msg"]
    one.end()


def test_a_recording_has_the_channels_of_the_stream(live, folder, tmp_path):
    """`record` writes the topics, encodings and schemas that `live` serves, and messages that can be read by them."""
    one, address = start(live, folder)

    async def ask():
        stream, channels, _ = await connect(address)
        await stream.close()
        return channels

    channels = asyncio.run(ask())
    one.end()
    recording = tmp_path / "touch.mcap"
    subprocess.run(
        [FINGERTIP, "record", "sim", "--samples", "2000", "--scene", "sim", "-q", "-o", recording], check=True, timeout=60
    )
    touches, scenes, topics = {}, [], {}
    with open(recording, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            topics[channel.topic] = (channel.message_encoding, schema.name, schema.encoding, schema.data)
            if channel.topic == "/fingertip/touch":
                touches[message.log_time] = read_touch(message.data)
            if channel.topic == "/fingertip/scene":
                scenes.append(message.data)
    for topic, channel in channels.items():
        schema = channel["schema"]
        text = base64.b64decode(schema) if channel["schemaEncoding"] == "protobuf" else schema.encode()
        assert topics[topic] == (channel["encoding"], channel["schemaName"], channel["schemaEncoding"], text), topic
    kind = scene_update(topics["/fingertip/scene"][1], topics["/fingertip/scene"][3])
    matched = [check_scene(kind.FromString(scene), touches) for scene in scenes]
    assert len(touches) == 2000 and matched.count("surface") == 2 and matched.count("contact") > 10, matched


def test_a_server_that_was_killed_comes_back(live, folder):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    arguments = ["--replay", folder / "touch.csv", "--scene", folder / "scene.toml", f"--foxglove=127.0.0.1:{port}"]

    first = live(*arguments)
    address = first.line(r"Foxglove: (\S+)")

    async def over_and_over():
        """One client, which connects anew by itself as Foxglove does."""
        seen = 0
        async for stream in websockets.connect(address, subprotocols=[PROTOCOL], max_size=None):
            try:
                channels, _ = await advertised(stream)
                await subscribe(stream, channels, ["/fingertip/touch"])
                await data(stream)
                seen += 1
                if seen == 2:
                    return
                first.kill()
                assert live(*arguments).line(r"Foxglove: (\S+)") == address
                while True:
                    await data(stream)
            except websockets.ConnectionClosed:
                continue

    asyncio.run(asyncio.wait_for(over_and_over(), 60))


def test_clients_of_ill_will_cost_nobody_else_a_sample(live, folder, rows):
    one, address = start(live, folder)
    host, port = address.removeprefix("ws://").split(":")
    before = one.memory()

    def attack():
        kept = [socket.create_connection((host, int(port)), timeout=10) for _ in range(200)]
        for number, connection in enumerate(kept):
            connection.sendall([b"", b"GET / HTTP/1.1\r\n", b"\0\xff" * 500, b"GET /" + b"a" * 20_000][number % 4])
        return kept

    async def under_attack():
        stream, channels, _ = await connect(address)
        slow = [await connect(address) for _ in range(4)]
        for connection, known, _ in slow:
            # Asks for everything and reads nothing.
            await subscribe(connection, known, list(known))
            connection.transport.pause_reading()
        await subscribe(stream, channels, ["/fingertip/touch"])
        kept = await asyncio.to_thread(attack)
        await slow[0][0].send("x" * (1 << 20))
        await slow[1][0].send(b"\x02" + b"\xff" * 100)
        touches = []
        while len(touches) < 6000:
            message = (await data(stream))[2]
            touches.append((now(), read_touch(message)))
        memory = one.memory()
        for connection in kept:
            connection.close()
        for connection, _, _ in slow:
            connection.transport.abort()
        await stream.close()
        return touches, memory

    with timer() as own:
        touches, memory = asyncio.run(under_attack())
    check_consecutive([touch["number"] for _, touch in touches], 6000)
    assert all(touch["load"] == rows[touch["number"]].wrench for _, touch in touches)
    steps = [abs(b["stamp"] - a["stamp"] - 1e-3) for (_, a), (_, b) in zip(touches, touches[1:])]
    said("foxglove, step of the sampling, under attack", steps, most=1 + 1e3 * own[0])
    said("foxglove, from sample to client, under attack", [when - touch["stamp"] for when, touch in touches])
    print(f"memory {before} kB before, {memory} kB under attack")
    # A thousand messages and more wait for each that is slow; no more than that.
    assert memory - before < 60_000
    one.end()

"""The WebSocket of Foxglove, with PyPI `websockets` as the client."""

import asyncio
import json
import socket
import struct

import websockets
from conftest import check_consecutive, close, now, said

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


async def connect(address):
    """A connection, its channels by topic, and its services by name."""
    stream = await websockets.connect(address, subprotocols=[PROTOCOL], max_size=None)
    assert stream.subprotocol == PROTOCOL
    channels, services = {}, {}
    while len(channels) < 4 or len(services) < 2:
        message = json.loads(await asyncio.wait_for(stream.recv(), 10))
        if message["op"] == "advertise":
            channels |= {channel["topic"]: channel for channel in message["channels"]}
        if message["op"] == "advertiseServices":
            services |= {service["name"]: service for service in message["services"]}
    return stream, channels, services


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
    # All three say the same of a sample.
    for _, stamp, message in got[0]:
        if stamp in stamps:
            cdr = Cdr(message)
            cdr.header()
            assert cdr.numbers(6) == stamps[stamp]["load"]
    for _, stamp, message in got[1]:
        if stamp in stamps:
            cdr = Cdr(message)
            cdr.header()
            assert cdr.string() == "fingertip" and cdr.numbers(3) == stamps[stamp]["point"]
    said("foxglove, from sample to client", [when - stamp * 1e-9 for when, stamp, _ in got[2]])
    one.end()


def test_the_scene_is_drawn_and_a_zero_is_taken(live, folder, rows):
    one, address = start(live, folder)

    async def talk():
        stream, channels, services = await connect(address)
        await subscribe(stream, channels, ["/fingertip/scene"])
        drawn = b""
        while b"surface" not in drawn or b"contact" not in drawn:
            drawn += (await data(stream))[2]
        zero = await call(stream, services["/fingertip/tare"], 1)
        assert zero["success"] and len(zero["zero"]) == 6, zero
        assert (await call(stream, services["/fingertip/reset"], 2))["success"]
        await subscribe(stream, channels, ["/fingertip/scene", "/fingertip/touch"])
        stream_two, channels, _ = await connect(address)
        await subscribe(stream_two, channels, ["/fingertip/touch"])
        touch = read_touch((await data(stream_two))[2])
        await stream.close()
        await stream_two.close()
        row = rows[round(touch["time"] * 1000)]
        assert close([a + b for a, b in zip(touch["load"], zero["zero"])], row.wrench, 1e-12)

    asyncio.run(talk())
    one.end()


def test_a_server_that_was_killed_comes_back(live, folder):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    arguments = ["--replay", folder / "touch.csv", "--scene", folder / "scene.toml", f"--foxglove=127.0.0.1:{port}"]

    async def twice():
        for _ in range(2):
            one = live(*arguments)
            address = one.line(r"Foxglove: (\S+)")
            stream, channels, _ = await connect(address)
            await subscribe(stream, channels, ["/fingertip/touch"])
            await data(stream)
            one.kill()
            try:
                while True:
                    await data(stream)
            except websockets.ConnectionClosed:
                pass

    asyncio.run(twice())


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

    touches, memory = asyncio.run(under_attack())
    check_consecutive([touch["number"] for _, touch in touches], 6000)
    assert all(touch["load"] == rows[touch["number"]].wrench for _, touch in touches)
    steps = [abs(b["stamp"] - a["stamp"] - 1e-3) for (_, a), (_, b) in zip(touches, touches[1:])]
    said("foxglove, step of the sampling, under attack", steps)
    said("foxglove, from sample to client, under attack", [when - touch["stamp"] for when, touch in touches])
    print(f"memory {before} kB before, {memory} kB under attack")
    # A thousand messages and more wait for each that is slow; no more than that.
    assert memory - before < 60_000
    one.end()

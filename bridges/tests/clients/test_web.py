"""The page and its WebSocket, with PyPI `websockets` as the client, and with sockets of ill will."""

import asyncio
import json
import socket
import time
import urllib.error
import urllib.request
from urllib.parse import urlsplit

import pytest
import websockets
from conftest import check_consecutive, close, now, said, timer


def addresses(live):
    watch, command = live.line(r"Watch: +(\S+)"), live.line(r"Command: +(\S+)")
    return watch, command


def samples_of(address):
    return address.replace("http://", "ws://").replace("/?", "/samples?")


def start(live, folder, *more):
    one = live("--replay", folder / "touch.csv", "--scene", folder / "scene.toml", "--web=127.0.0.1:0", *more)
    return one, *addresses(one)


async def gather(address, count, seconds=60):
    """So many samples, with the time at which each came."""
    async with websockets.connect(samples_of(address)) as socket:
        raw, got = [], 0
        ends = time.monotonic() + seconds
        while got < count:
            text = await asyncio.wait_for(socket.recv(), ends - time.monotonic())
            raw.append((now(), text))
            got += text.count('"stamp"')
    messages = [(when, json.loads(text)) for when, text in raw]
    missed = sum(message.get("missed", 0) for _, message in messages)
    return [(when, one) for when, message in messages for one in message.get("samples", [])], missed


def test_ten_thousand_samples_come_whole(live, folder, rows):
    one, watch, _ = start(live, folder)
    got, missed = asyncio.run(gather(watch, 10_000))
    assert missed == 0
    check_consecutive([sample["n"] for _, sample in got], 10_000)
    for _, sample in got:
        row = rows[sample["n"]]
        assert sample["t"] == row.time and sample["wrench"] == row.wrench
        contact = sample["contact"]
        assert close(contact["point"], row.point, 1e-9) and close(contact["normal"], row.normal, 1e-9)
        assert abs(contact["normal_force"] - row.normal_force) < 1e-9
        assert abs(sample["margin"]["utilisation"] - row.utilisation) < 1e-9
        assert sample["slip"] in ("holding", "warning", "slipping", "not_pressing")
    said("web, from sample to client", [when - sample["stamp"] for when, sample in got], median=1)
    one.end()


def test_who_comes_without_the_token_or_from_elsewhere_stays_out(live, folder):
    one, watch, command = start(live, folder)
    place = urlsplit(watch)

    def status(path, **headers):
        request = urllib.request.Request(f"http://{place.netloc}{path}", headers=headers)
        try:
            return urllib.request.urlopen(request, timeout=5).status
        except urllib.error.HTTPError as error:
            return error.code

    assert status(f"/?{place.query}") == 200
    for path in ("/", "/?token=", f"/?{place.query[:-1]}", f"/x?{place.query}"[:10], "/samples"):
        assert status(path) == 403, path
    assert status(f"/x?{place.query}") == 404 and status(f"/samples?{place.query}") == 426
    assert status(f"/?{place.query}", Origin="http://evil.example") == 403
    assert status(f"/?{place.query}", Host="evil.example") == 403

    async def streams():
        for origin in ("http://evil.example", "null", f"https://{place.netloc}"):
            with pytest.raises(websockets.InvalidStatus):
                await websockets.connect(samples_of(command), origin=origin)
        async with websockets.connect(samples_of(command), origin=f"http://{place.netloc}") as own:
            assert "hello" in json.loads(await own.recv())

    asyncio.run(streams())
    one.end()


async def answer(socket):
    while True:
        message = json.loads(await asyncio.wait_for(socket.recv(), 10))
        if "did" in message or "refused" in message:
            return message


def test_one_writer_takes_a_zero_and_the_others_watch(live, folder, rows):
    one, watch, command = start(live, folder)

    async def talk():
        async with websockets.connect(samples_of(command)) as writer:
            hello = json.loads(await writer.recv())["hello"]
            assert hello["commands"] and hello["has_scene"] and hello["coefficient"] == 0.5
            async with websockets.connect(samples_of(watch)) as reader, websockets.connect(samples_of(command)) as second:
                for other in (reader, second):
                    assert not json.loads(await other.recv())["hello"]["commands"]
                    await other.send('{"do":"tare"}')
                    assert "refused" in await answer(other)
                for nonsense in ("", "{}", '{"do":"fly"}', "[1]", '{"do":{"do":"tare"}}'):
                    await writer.send(nonsense)
                    assert "refused" in await answer(writer)
                await writer.send('{"do":"reset"}')
                assert await answer(writer) == {"did": "reset"}
                await writer.send('{"do":"tare"}')
                assert await answer(writer) == {"did": "tare"}
                zero = None
                while zero is None:
                    message = json.loads(await asyncio.wait_for(reader.recv(), 10))
                    zero = (message.get("status") or {}).get("zero", {}).get("taken") and message["status"]["zero"]["value"] or None
                while "samples" not in message:
                    message = json.loads(await asyncio.wait_for(reader.recv(), 10))
        sample = message["samples"][0]
        # The number counts what is given; while the zero was taken, nothing was.
        row = rows[round(sample["t"] * 1000)]
        assert close([a + b for a, b in zip(sample["wrench"], zero)], row.wrench, 1e-12)
        before = range(round(sample["t"] * 1000) - 1000, round(sample["t"] * 1000))
        mean = [sum(rows[k].wrench[axis] for k in before) / 1000 for axis in range(6)]
        assert close(zero, mean, 1e-2)
        # Who ends gives the commands back.
        async with websockets.connect(samples_of(command)) as third:
            for _ in range(50):
                hello = json.loads(await third.recv())["hello"]
                if hello["commands"]:
                    break
                await third.close()
                await asyncio.sleep(0.1)
                third = await websockets.connect(samples_of(command))
            assert hello["commands"]
            await third.close()

    asyncio.run(talk())
    one.end()


def test_a_server_that_was_killed_comes_back_at_the_same_address(live, folder, tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    common = ["--replay", folder / "touch.csv", "--scene", folder / "scene.toml", "--web-tokens", tmp_path / "tokens"]
    first = live(*common, f"--web=127.0.0.1:{port}")
    watch, _ = addresses(first)

    async def over_and_over():
        seen = 0
        async for stream in websockets.connect(samples_of(watch)):
            try:
                while "samples" not in json.loads(await asyncio.wait_for(stream.recv(), 10)):
                    pass
                seen += 1
                if seen == 1:
                    first.kill()
                    assert addresses(live(*common, f"--web=127.0.0.1:{port}"))[0] == watch
                    while True:
                        await asyncio.wait_for(stream.recv(), 10)
                return
            except websockets.ConnectionClosed:
                continue

    asyncio.run(asyncio.wait_for(over_and_over(), 60))


def raw(address, head):
    place = urlsplit(address)
    one = socket.create_connection((place.hostname, place.port), timeout=10)
    one.settimeout(10)
    one.sendall(head if isinstance(head, bytes) else head.encode())
    return one


def upgrade(address):
    place = urlsplit(address)
    return (
        f"GET /samples?{place.query} HTTP/1.1\r\nHost: {place.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )


def test_clients_of_ill_will_cost_nobody_else_a_sample(live, folder, rows):
    one, watch, command = start(live, folder)
    place = urlsplit(watch)

    async def quiet_reader(count):
        return await gather(watch, count)

    before = one.memory()
    with timer() as own_calm:
        calm, _ = asyncio.run(quiet_reader(2000))

    def attack():
        kept = []
        # Who reads nothing; its buffer is small, so that the server finds it full.
        for _ in range(4):
            slow = socket.socket()
            slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            slow.connect((place.hostname, place.port))
            slow.sendall(upgrade(watch).encode())
            kept.append(slow)
        # Huge frames: by their length, and by their bytes.
        huge = raw(command, upgrade(command))
        huge.sendall(bytes([0x81, 0xFF]) + (1 << 62).to_bytes(8, "big") + b"\0" * 4)
        kept.append(huge)
        large = raw(watch, upgrade(watch))
        try:
            large.sendall(bytes([0x81, 0xFF]) + (1 << 20).to_bytes(8, "big") + b"\0" * 4 + b"x" * (1 << 20))
        except OSError:
            pass
        kept.append(large)
        # Frames without a mask, an unknown opcode, and heads without an end.
        kept.append(raw(watch, upgrade(watch).encode() + b"\x81\x05hello\x0f\x00"))
        kept.append(raw(watch, "GET /" + "a" * 20_000))
        kept.append(raw(watch, b"\x00\xff" * 100))
        # 200 connections that say nothing, or half a head.
        for number in range(200):
            try:
                kept.append(raw(watch, "GET / HTTP/1.1\r\n" if number % 2 else ""))
            except OSError:
                pass
        return kept

    async def under_attack():
        async with websockets.connect(samples_of(watch)) as reader:
            kept = await asyncio.to_thread(attack)
            raw_texts, got = [], 0
            while got < 6000:
                text = await asyncio.wait_for(reader.recv(), 20)
                raw_texts.append((now(), text))
                got += text.count('"stamp"')
            memory = one.memory()
            for connection in kept:
                connection.close()
            return raw_texts, memory

    with timer() as own:
        texts, memory = asyncio.run(under_attack())
    messages = [(when, json.loads(text)) for when, text in texts]
    assert sum(message.get("missed", 0) for _, message in messages) == 0
    loud = [(when, sample) for when, message in messages for sample in message.get("samples", [])]
    check_consecutive([sample["n"] for _, sample in loud], 6000)
    assert all(sample["wrench"] == rows[sample["n"]].wrench for _, sample in loud)

    def jitter(samples):
        steps = [b["stamp"] - a["stamp"] - 1e-3 for (_, a), (_, b) in zip(samples, samples[1:])]
        return [abs(step) for step in steps]

    said("web, step of the sampling, calm", jitter(calm), most=1 + 1e3 * own_calm[0])
    said("web, step of the sampling, under attack", jitter(loud), most=1 + 1e3 * own[0])
    said("web, from sample to client, under attack", [when - sample["stamp"] for when, sample in loud], median=1)
    print(f"memory {before} kB before, {memory} kB under attack")
    # The ring of samples is there from the start; sixteen threads have their stacks.
    assert memory - before < 20_000
    # And afterwards there is room again.
    time.sleep(4)
    asyncio.run(gather(watch, 100))
    errors = one.end()
    assert "requests were refused" in errors, errors

"""The page in headless Chromium, over its DevTools protocol. `PICTURES=FOLDER` keeps what is seen, to be looked at."""

import asyncio
import base64
import json
import os
import shutil
import socket
import subprocess
import urllib.request
from pathlib import Path

import pytest
import websockets
from conftest import QUIET

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ROWS = "JSON.stringify([...document.querySelectorAll('#live-table tr')].map(row => [...row.cells].map(cell => cell.textContent)))"
FRAMES = """new Promise(done => { let count = 0; const begun = performance.now();
    const step = () => { count++; performance.now() - begun < 3000 ? requestAnimationFrame(step) : done(count / 3); };
    requestAnimationFrame(step); })"""
COLOURS = """(() => { const canvas = document.querySelector('.solid canvas'), { data } = canvas.getContext('2d')
    .getImageData(0, 0, canvas.width, canvas.height), seen = new Set();
    for (let place = 0; place < data.length; place += 4) seen.add(data.slice(place, place + 3).join());
    return seen.size; })()"""
SHOT = "document.querySelector('.solid canvas').toDataURL()"


@pytest.fixture(autouse=True)
def chromium():
    assert CHROMIUM, "there is no chromium; `.ci/chromium` installs it"


class Tab:
    """A tab, and what its page complained of."""

    def __init__(self, stream):
        self.stream, self.number, self.complaints = stream, 0, []

    async def call(self, method, **parameters):
        self.number += 1
        await self.stream.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(await asyncio.wait_for(self.stream.recv(), 60))
            if message.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.complaints.append(message["params"])
            if message.get("id") == self.number:
                assert "error" not in message, message
                return message["result"]

    async def value(self, expression):
        result = await self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    async def table(self):
        return {row[0]: row[1] for row in json.loads(await self.value(ROWS))}

    async def until(self, expression, seconds=90):
        for _ in range(seconds * 5):
            if await self.value(expression):
                return
            await asyncio.sleep(0.2)
        raise AssertionError(f"never: {expression}")

    async def look(self, name, width, height, dark):
        await self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        await self.call("Emulation.setEmulatedMedia", features=[scheme])
        await asyncio.sleep(1)
        # Nothing is wider than the window.
        assert await self.value("document.documentElement.scrollWidth <= innerWidth"), name
        if folder := os.environ.get("PICTURES"):
            picture = await self.call("Page.captureScreenshot")
            (Path(folder) / f"{name}.png").write_bytes(base64.b64decode(picture["data"]))


def browse(folder, work):
    """Does something with a tab of a browser of its own."""

    async def run():
        profile = folder / "profile"
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--js-flags=--expose-gc",
                   "--remote-debugging-port=0", f"--user-data-dir={profile}", "about:blank"]
        browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            told = profile / "DevToolsActivePort"
            for _ in range(300):
                if told.exists() and told.read_text().count("\n"):
                    break
                await asyncio.sleep(0.1)
            port = told.read_text().split()[0]
            tabs = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=20))
            address = next(tab["webSocketDebuggerUrl"] for tab in tabs if tab["type"] == "page")
            async with websockets.connect(address, max_size=None) as stream:
                tab = Tab(stream)
                for domain in ("Runtime", "Log", "Page", "HeapProfiler"):
                    await tab.call(f"{domain}.enable")
                await work(tab)
        finally:
            browser.kill()
            browser.wait()

    asyncio.run(run())


def test_the_page_shows_what_is_felt_and_commands(live, tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        arguments = [f"--web=127.0.0.1:{free.getsockname()[1]}", "--web-tokens", tmp_path / "tokens"]
    one = live(*arguments)
    command = one.line(r"Command: +(\S+)")

    async def work(tab):
        await tab.call("Page.navigate", url=command)
        await tab.until("document.getElementById('live-light')?.textContent === 'live'")
        await tab.until("[...document.querySelectorAll('#live-table td')].some(cell => cell.textContent === 'contact')")
        assert await tab.value(COLOURS) > 20
        for name, width, height, dark in [("light", 1200, 1400, False), ("dark", 1200, 1400, True), ("phone", 390, 2500, False)]:
            await tab.look(name, width, height, dark)
        frames = await tab.value(FRAMES)
        table = await tab.table()
        print(f"\nbrowser: {frames:.0f} frames a second, from sample to picture {table['From sample to picture']}, missed {table['Missed here']}")
        assert frames > (55 if QUIET else 10) and table["Missed here"] == "0"
        # A sentence for those who listen, and not one for each sample.
        assert await tab.value("document.getElementById('live-said').textContent.length > 5")
        changes = """new Promise(done => { let count = 0; const watch = new MutationObserver(list => count += list.length);
            watch.observe(document.getElementById('live-said'), { childList: true, characterData: true, subtree: true });
            setTimeout(() => done(count), 5000); })"""
        assert await tab.value(changes) <= 6
        # Held, the view turns by the keyboard.
        await tab.value("document.getElementById('live-hold').click(); document.querySelector('.solid canvas').focus()")
        await asyncio.sleep(0.5)
        before = await tab.value(SHOT)
        await tab.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowLeft")
        await asyncio.sleep(0.5)
        assert before != await tab.value(SHOT)
        await tab.value("document.getElementById('live-hold').click()")
        # A zero, by its button.
        watch = """window.lights = []; new MutationObserver(() => lights.push(document.getElementById('live-light').textContent))
            .observe(document.getElementById('live-light'), { childList: true, characterData: true, subtree: true })"""
        await tab.value(f"{watch}; document.getElementById('live-tare').click()")
        await tab.until("lights.some(light => light.startsWith('taking the zero'))")
        await tab.until("['live', 'slipping'].includes(document.getElementById('live-light')?.textContent)")
        # Amid a slip, which the page must not go on showing.
        await tab.until("document.getElementById('live-light').textContent === 'slipping'")
        one.kill()
        await tab.until("document.getElementById('live-light')?.textContent === 'not connected'")
        await tab.until("document.getElementById('live-said').textContent === 'not connected'")
        # And started anew: the page finds it.
        live(*arguments).line(r"Command: +(\S+)")
        await tab.until("['live', 'slipping'].includes(document.getElementById('live-light')?.textContent)")
        errors = [one for one in tab.complaints if "ERR_CONNECTION_REFUSED" not in json.dumps(one) and "WebSocket connection" not in json.dumps(one)]
        assert not errors, errors[:3]

    browse(tmp_path, work)


def test_an_hour_leaves_memory_as_it_was(live, folder, rows, tmp_path):
    """An hour, played 90 times as fast: at 50 Hz, or on a quiet machine all of it at 1 kHz, 30 times as fast."""
    rate, speed = (1000, 30) if QUIET else (50, 90)
    with open(tmp_path / "hour.csv", "w") as file:
        file.write("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n")
        wrenches = [",".join(map(repr, row.wrench)) for row in rows]
        file.writelines(f"{number / rate!r},{wrenches[number % 40_000]}\n" for number in range(3600 * rate))
    one = live("--replay", tmp_path / "hour.csv", "--speed", speed, "--scene", folder / "scene.toml", "--web=127.0.0.1:0")
    watch = one.line(r"Watch: +(\S+)")

    async def work(tab):
        await tab.call("Page.navigate", url=watch)
        await tab.until("document.getElementById('live-light')?.textContent === 'live'")
        await asyncio.sleep(5)

        async def heap():
            await tab.call("HeapProfiler.collectGarbage")
            return (await tab.call("Runtime.getHeapUsage"))["usedSize"] / 1e6

        page, server = [await heap()], [one.memory()]
        for _ in range(3):
            await asyncio.sleep((3600 / speed - 13) / 3)
            page.append(await heap())
            server.append(one.memory())
        print(f"\nbrowser: an hour, page {[f'{size:.1f} MB' for size in page]}, server {[f'{size} kB' for size in server]}")
        # A sample takes some 300 bytes: kept, they would be 50 MB and more.
        assert page[-1] < page[0] + 3 and server[-1] < server[1] + 4000, (page, server)

    browse(tmp_path, work)

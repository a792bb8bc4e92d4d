// The playground as its reader finds it: run in the page by `.ci/book`, which looks for "sound" in the title.
(async () => {
  // A pointer that a script makes cannot be captured.
  HTMLCanvasElement.prototype.setPointerCapture = () => {};
  const faults = [], say = what => faults.push(what);
  try {
    for (let tries = 0; tries < 200 && document.documentElement.dataset.playground !== "ready"; tries++)
      await new Promise(done => setTimeout(done, 20));
    if (document.documentElement.dataset.playground !== "ready") throw new Error("it does not become ready");
    const of = id => document.getElementById(id), verdict = of("verdict");
    const put = (id, value) => {
      const control = of(id);
      control.value = value;
      control.dispatchEvent(new Event("input"));
      control.dispatchEvent(new Event("change"));
    };
    const cell = row => of("felt").rows[row].cells[1].textContent;
    const drawn = () => new Promise(done => setTimeout(done, 60));
    for (let shape = 0; shape < 7; shape++) for (let model = 0; model < 3; model++) {
      put("shape", shape);
      put("model", model);
      if (verdict.dataset.told !== "0" || !(+verdict.dataset.mistake < 1e-7))
        say(`shape ${shape}, model ${model}: ${verdict.textContent} off by ${verdict.dataset.mistake} m`);
      if (!(parseInt(cell(7)) > 50)) say(`shape ${shape}, model ${model}: takes ${cell(7)} instructions`);
    }
    put("shape", 0);
    put("model", 0);
    put("knob4", 3);
    if (!(+verdict.dataset.mistake > 1e-4)) say("a spin torque does not fool a point contact");
    put("model", 2);
    if (!(+verdict.dataset.mistake < 1e-7) || !cell(2).includes("soft finger")) say("auto does not take the soft finger");
    put("knob4", 0);
    put("model", 0);
    put("knob2", 0.9);
    if (!verdict.textContent.includes("slips") || !cell(5).startsWith("-")) say("it does not slip beyond friction");
    put("knob2", 0);
    put("sign", 1);
    if (Math.abs(+verdict.dataset.mistake - 26e-3) > 1e-6) say("the wrong sign is not on the far side");
    put("sign", 0);

    await drawn();
    const canvas = document.querySelector("#tip canvas"), box = canvas.getBoundingClientRect();
    const pixels = () => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    // A frame is drawn when the browser finds time.
    const changes = async from => {
      for (let tries = 0; tries < 100; tries++) {
        if (pixels().some((value, place) => value !== from[place])) return true;
        await drawn();
      }
      return false;
    };
    for (let tries = 0; tries < 100 && new Set(pixels()).size < 50; tries++) await drawn();
    const before = pixels(), truth = cell(1);
    if (new Set(before).size < 50) say("nothing is drawn");
    const point = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: box.left + x, clientY: box.top + y }));
    point("pointerdown", box.width / 2, box.height / 2);
    point("pointermove", box.width / 2 - 20, box.height / 2 + 15);
    point("pointerup", box.width / 2, box.height / 2);
    if (cell(1) === truth) say("the touch does not follow the pointer");
    if (!await changes(before)) say("the drawing does not follow");
    await drawn();
    const held = cell(1), turned = pixels();
    point("pointerdown", 6, 6);
    point("pointermove", 60, 30);
    point("pointerup", 60, 30);
    if (cell(1) !== held) say("a drag beside the solid moves the touch");
    if (!await changes(turned)) say("it does not turn beside the solid");

    if (Math.abs(+of("condition").dataset.number - Math.SQRT2) > 1e-3) say("the best rosettes do not have √2");
    put("gauge-q", 45);
    if (!(+of("condition").dataset.number > 3)) say("worse gauges are not worse");
    if (document.documentElement.scrollWidth > document.documentElement.clientWidth + 1) say("the page is wider than the window");
  } catch (error) {
    say(String(error));
  }
  document.title = faults.length ? `faults: ${faults.join("; ")}` : "sound";
})();

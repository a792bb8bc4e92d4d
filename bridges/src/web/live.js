// Shows samples as they come: in the view of the surface, in a table, and as curves.
(() => {
  const by = id => document.getElementById("live-" + id);
  const solid = document.querySelector(".solid"), token = new URLSearchParams(location.search).get("token") || "";
  const SPAN = 10, TRAIL = 300, ROOM = 60000;
  let about = {}, source = {}, socket = null, held = false, wait = 500, missed = 0;
  let samples = [], last = null, trail = [], spins = false, greatest = 0, slipped = -Infinity, slipCount = 0, delays = [], rate = 0, counted = null;

  // What is known of a number, with its digits and unit.
  const number = (value, unit, digits = 3) =>
    Number.isFinite(value) ? `${value.toPrecision(digits).replace(/e\+?/, "·10^").replace("-", "−")} ${unit}` : "–";
  const fixed = (list, scale, places) =>
    list ? list.map(value => Number.isFinite(value) ? (value * scale).toFixed(places).replace("-", "−") : "–").join(", ") : "–";
  const size = list => Math.hypot(...list);
  const nice = value => { const decade = 10 ** Math.floor(Math.log10(value)); return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].map(step => step * decade).find(step => step >= value * 0.9999) || value; };

  // What is told in words: contact, slip, and how the sensor is.
  const reasons = { below_threshold: "force below the threshold", misses: "the line of action misses the surface", only_pulling: "the force pulls outward",
    outside_active_region: "presses outside the active region", not_finite: "the reading is not finite", beyond_friction: "more tangential than friction allows",
    saturated: "a gauge is saturated", uncalibrated: "beyond what the sensor was calibrated for", unusable_row: "the reading is of no use", rest: "at rest, for the zero" };
  const slips = { holding: "holding", warning: "slip is near", slipping: "SLIPPING", not_pressing: "not pressing" };
  const health = () => {
    if (!socket || socket.readyState !== 1) return ["bad", "not connected"];
    return { waiting: ["", "waiting for the first sample"], running: ["good", "live"], resting: ["suspect", "taking the zero: do not touch"],
      lost: ["bad", "sensor lost, connecting anew"], ended: ["", "the recording is over"] }[source.health] || ["", "…"];
  };
  // A slip of milliseconds is shown for half a second; calls in quick succession are one slip.
  const recent = () => last && last.t >= slipped && last.t - slipped < 0.5;
  const verdict = () => last && last.slip ? slips[recent() ? "slipping" : last.slip] : "–";
  const state = () => !last ? "nothing yet" : last.contact ? "contact" : about.has_scene ? `no contact: ${reasons[last.status] || last.status}` : "no scene";
  const sentence = () => {
    if (!last || health()[1] !== "live" || !about.has_scene) return health()[1];
    if (!last.contact) return state();
    return `Contact at ${fixed(last.contact.point, 1e3, 1)} mm, pressed with ${number(last.contact.normal_force, "N", 2)}${last.slip ? ", " + verdict() : ""}`;
  };
  // Whoever listens hears a change at once, and numbers every five seconds.
  let heard = "", when = 0;
  const say = text => { by("said").textContent = text; when = performance.now(); };
  const tell = () => {
    const kind = [health()[1], state(), verdict()].join();
    if (kind !== heard && performance.now() - when > 1000 || performance.now() - when > 5000) { heard = kind; if (by("said").textContent !== sentence()) say(sentence()); }
  };

  const rows = () => {
    const list = [["State", state()]];
    const load = last && (last.load || last.wrench);
    if (about.has_scene) {
      const touch = last && last.contact, ellipse = touch && touch.ellipse;
      const tangential = touch && size(touch.tangential_force);
      list.push(["Contact point / mm", touch ? fixed(touch.point, 1e3, 2) : "–"]);
      list.push(["… within, 95 %", ellipse ? "± " + number(ellipse.semi_axes[0] * 1e3, "mm", 2) : "–"]);
      list.push(["Normal force", touch ? number(touch.normal_force, "N") : "–"]);
      list.push(["Tangential force", touch ? number(tangential, "N") : "–"]);
      const ratio = touch && tangential / touch.normal_force;
      list.push(["Friction ratio", touch ? number(ratio, about.coefficient ? `of ${about.coefficient.toPrecision(3)}` : "") : "–"]);
      list.push(["Slip margin", last && last.margin && touch ? number(last.margin.newtons, "N") : "–", touch && last.margin && last.margin.newtons < 0]);
      if (about.watches_slip) list.push(["Slip", verdict(), recent()], ["Slips", String(slipCount)]);
      spins ||= Boolean(touch && touch.spin_torque);
      if (spins) list.push(["Spin torque", touch ? number(touch.spin_torque * 1e3, "mN m", 2) : "–"]);
    }
    list.push(["Force x, y, z / N", load ? fixed(load.slice(0, 3), 1, 3) : "–"]);
    list.push(["Torque x, y, z / mN m", load ? fixed(load.slice(3), 1e3, 2) : "–"]);
    list.push(["Samples a second", rate ? rate.toFixed(0) : "–"]);
    list.push(["Missed here", String(missed), missed > 0]);
    if (source.lost !== null && source.lost !== undefined) list.push(["Lost by the sensor", String(source.lost), source.lost > 0]);
    if (source.faults) list.push(["Bad samples", String(source.faults), true]);
    const sorted = [...delays].sort((a, b) => a - b);
    list.push(["From sample to picture", sorted.length ? `${(sorted[sorted.length >> 1] * 1e3).toFixed(0)} ms` : "–"]);
    return list;
  };
  const table = () => {
    const list = rows(), body = by("table");
    while (body.rows.length > list.length) body.deleteRow(-1);
    list.forEach(([name, value, alarm], place) => {
      let row = body.rows[place];
      if (!row) {
        row = body.insertRow();
        const head = document.createElement("th");
        head.scope = "row";
        row.append(head, document.createElement("td"));
      }
      if (row.cells[0].textContent !== name) row.cells[0].textContent = name;
      if (row.cells[1].textContent !== value) row.cells[1].textContent = value;
      row.className = alarm ? "alarm" : "";
    });
  };
  const head = () => {
    const [kind, word] = health(), light = by("light");
    // What was felt last says nothing of now once nothing comes.
    const slipping = word === "live" && recent();
    light.className = "light " + (slipping ? "bad" : kind);
    light.textContent = slipping ? "slipping" : word;
    by("source").textContent = about.source || "";
    const faults = (source.seen || []).length ? "sensor: " + source.seen.join("; ") : "";
    by("why").textContent = word === "not connected" ? "If fingertip live was started anew, take its new address from the terminal." : source.why || faults;
    const may = about.commands && socket && socket.readyState === 1;
    by("tare").disabled = by("reset").disabled = !may;
    by("tare").title = by("reset").title = may ? "" : "This page watches. The address that takes commands is in the terminal; one page at a time has them.";
  };

  // What stands on the surface: trail, ellipse, cone and arrow, in millimetres.
  const view = () => {
    if (!solid || !solid.live) return;
    if (!solid.dataset.zoom) {
      solid.dataset.zoom = 0.8;
      solid.dispatchEvent(new Event("reset"));
    }
    const parts = trail.map((point, place) => ({ at: [point], kind: "dot", colour: "a", wide: 2.2, lift: 0.05, alpha: 0.15 + 0.6 * place / trail.length }));
    const touch = last && last.contact;
    if (touch) {
      const point = touch.point.map(value => value * 1e3), reach = solid.reach, along = (from, direction, length) => from.map((value, i) => value + direction[i] * length);
      // As long as the greatest force of the curves is a good length.
      const force = size(touch.force), scale = 0.4 * reach / nice(Math.max(greatest, force, 1e-9));
      const used = last.margin ? last.margin.utilisation : 0, colour = used >= 1 || recent() ? "alarm" : used > 0.8 || last.slip === "warning" ? "b" : "c";
      const normal = touch.normal, helper = Math.abs(normal[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const unit = list => list.map(value => value / (size(list) || 1));
      const right = unit(cross(normal, helper)), up = cross(normal, right);
      if (about.coefficient) {
        const length = Math.max(0.1 * reach, touch.normal_force * scale), radius = about.coefficient * length, far = along(point, normal, length);
        const rim = place => { const angle = place / 24 * 2 * Math.PI; return along(along(far, right, radius * Math.cos(angle)), up, radius * Math.sin(angle)); };
        for (let place = 0; place < 24; place++) parts.push({ at: [point, rim(place), rim(place + 1)], kind: "fill", colour, alpha: 0.16, lift: 0.02 });
        parts.push({ at: Array.from({ length: 25 }, (_, place) => rim(place)), kind: "line", colour, wide: 1.2, lift: 0.03 });
      }
      const from = along(point, touch.force, -scale), direction = unit(touch.force), head = Math.min(0.14 * reach, 0.4 * force * scale);
      for (let piece = 0; piece < 8; piece++)
        parts.push({ at: [along(from, touch.force, scale * piece / 8), along(from, touch.force, scale * (piece + 1) / 8 - (piece > 6 ? 0.05 * scale : 0))], kind: "line", colour: "ink", wide: 3, lift: 0.06 });
      const across = size(cross(direction, normal)) > 0.05 ? unit(cross(direction, normal)) : right, back = along(point, direction, -head);
      for (const side of [across, cross(direction, across)])
        parts.push({ at: [point, along(back, side, 0.4 * head), along(back, side, -0.4 * head)], kind: "fill", colour: "ink", alpha: 1, lift: 0.07 });
      if (touch.ellipse && touch.ellipse.semi_axes[0] * 1e3 < 2 * reach) {
        const [a, b] = touch.ellipse.semi_axes, [one, other] = touch.ellipse.directions;
        const turn = place => { const angle = place / 32 * 2 * Math.PI; return along(along(point, one, 1e3 * a * Math.cos(angle)), other, 1e3 * b * Math.sin(angle)); };
        parts.push({ at: Array.from({ length: 33 }, (_, place) => turn(place)), kind: "line", colour: "ink", wide: 1.2, lift: 9 });
      }
      // Through the surface, too, so that a contact behind is not lost.
      parts.push({ at: [point], kind: "ring", colour, wide: 2, lift: 9 });
    }
    solid.live(parts);
  };

  // Ten seconds of a canvas, as wide as it is; each column from its least to its greatest value.
  const load = sample => sample.load || sample.wrench;
  const pick = {
    force: [0, 1, 2].map(axis => sample => load(sample)[axis]), torque: [3, 4, 5].map(axis => sample => load(sample)[axis] * 1e3),
    contact: [sample => sample.contact ? sample.contact.normal_force : NaN, sample => sample.contact ? size(sample.contact.tangential_force) : NaN],
    margin: [sample => sample.contact && sample.margin ? sample.margin.newtons : NaN],
  };
  const curve = canvas => {
    const ink = canvas.getContext("2d");
    if (!ink) return;
    const dense = devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
    if (canvas.width !== Math.round(wide * dense) || canvas.height !== Math.round(high * dense)) { canvas.width = Math.round(wide * dense); canvas.height = Math.round(high * dense); }
    ink.setTransform(dense, 0, 0, dense, 0, 0);
    ink.clearRect(0, 0, wide, high);
    const style = getComputedStyle(canvas), colour = name => style.getPropertyValue("--" + name).trim();
    const left = 40, right = wide - 4, top = 8, bottom = high - 18, now = last ? last.t : 0, columns = Math.max(1, Math.floor(right - left));
    const of = pick[canvas.dataset.of], lows = of.map(() => []), highs = of.map(() => []);
    let low = 0, most = 0;
    for (const sample of samples) {
      const column = Math.floor((sample.t - now + SPAN) / SPAN * columns);
      if (column < 0 || column > columns) continue;
      for (let kind = 0; kind < of.length; kind++) {
        const value = of[kind](sample);
        if (!Number.isFinite(value)) continue;
        if (!(lows[kind][column] <= value)) lows[kind][column] = value;
        if (!(highs[kind][column] >= value)) highs[kind][column] = value;
        if (value < low) low = value;
        if (value > most) most = value;
      }
    }
    const above = most > 0 ? nice(most) : low < 0 ? 0 : 1, below = low < -0.02 * above ? -nice(-low) : 0;
    const y = value => bottom - (value - below) / (above - below) * (bottom - top);
    ink.font = "11px system-ui, sans-serif";
    ink.textAlign = "right";
    ink.fillStyle = colour("soft");
    ink.lineWidth = 1;
    let labelled = [];
    for (const value of new Set([0, above, below])) {
      ink.strokeStyle = colour(value === 0 ? "soft" : "rule");
      ink.beginPath(); ink.moveTo(left, y(value)); ink.lineTo(right, y(value)); ink.stroke();
      if (labelled.some(other => Math.abs(other - y(value)) < 11)) continue;
      labelled.push(y(value));
      ink.fillText(String(+value.toPrecision(3)).replace("-", "−"), left - 5, y(value) + 4);
    }
    ink.textAlign = "left"; ink.fillText(`−${SPAN} s`, left, high - 4);
    ink.textAlign = "right"; ink.fillText("now", right, high - 4);
    ink.save();
    ink.beginPath(); ink.rect(left, top - 2, right - left, bottom - top + 4); ink.clip();
    highs.forEach((values, kind) => {
      ink.strokeStyle = colour("abc"[kind]);
      ink.lineWidth = 1.4;
      ink.setLineDash([[], [5, 3], [1.5, 2.5]][kind]);
      ink.beginPath();
      // Samples that follow one another are joined, those with a pause between them are not.
      const joined = 1 + 2 * columns / SPAN / Math.max(rate, 1);
      let before = -Infinity;
      for (let column = 0; column <= columns; column++) {
        if (values[column] === undefined) continue;
        const x = left + column;
        column - before <= joined ? ink.lineTo(x, y(values[column])) : ink.moveTo(x, y(values[column]));
        ink.lineTo(x, y(lows[kind][column]) + 0.01);
        before = column;
      }
      ink.stroke();
    });
    ink.restore();
    ink.setLineDash([]);
  };
  const canvases = [...document.querySelectorAll(".curve-of")];

  // The view as often as the screen shows it; curves and table as often as they can be read.
  let asked = false, tabled = 0, curved = 0;
  const soon = () => { if (!asked) { asked = true; requestAnimationFrame(frame); } };
  const frame = () => {
    asked = false;
    if (!held) view();
    if (!held && performance.now() - curved > 50) { curved = performance.now(); canvases.forEach(curve); }
    if (performance.now() - tabled > 250) {
      tabled = performance.now();
      greatest = samples.reduce((most, sample) => sample.contact ? Math.max(most, size(sample.contact.force)) : most, 0);
      if (!held) table();
      head();
      tell();
    }
    if (last && last.fresh) {
      last.fresh = false;
      delays.push((performance.timeOrigin + performance.now()) / 1e3 - last.stamp);
      if (delays.length > 120) delays.shift();
    }
  };

  const take = message => {
    if (message.hello) { about = message.hello; samples = []; trail = []; missed = 0; last = null; spins = false; slipped = -Infinity; slipCount = 0; counted = null; delays = []; }
    if (message.status) source = message.status;
    if (message.did === "reset") { trail = []; slipCount = 0; }
    if (message.refused) say(message.refused);
    if (message.samples && message.samples.length) {
      missed += message.missed;
      for (const sample of message.samples) {
        // A recording that begins anew.
        if (last && sample.t < last.t) samples = [];
        if (sample.slip === "slipping") {
          if (!(last && last.slip === "slipping") && !(sample.t - slipped <= 0.05)) slipCount++;
          slipped = sample.t;
        }
        last = sample;
        samples.push(sample);
      }
      last.fresh = true;
      if (last.contact) { trail.push(last.contact.point.map(value => value * 1e3)); if (trail.length > TRAIL) trail.shift(); }
      let old = 0;
      while (old < samples.length && samples[old].t < last.t - SPAN) old++;
      old = Math.max(old, samples.length - ROOM);
      if (old > 0) samples.splice(0, old);
      counted ||= [performance.now(), last.n];
      const stretch = performance.now() - counted[0];
      if (stretch > 1000) { rate = (last.n - counted[1]) / stretch * 1e3; counted = [performance.now(), last.n]; }
    }
    soon();
  };
  const connect = () => {
    socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/samples?token=${encodeURIComponent(token)}&pace=60`);
    socket.onopen = () => { wait = 500; soon(); };
    socket.onmessage = event => take(JSON.parse(event.data));
    socket.onclose = () => { setTimeout(connect, wait); wait = Math.min(5000, wait * 1.5); soon(); };
  };
  const send = what => { if (socket && socket.readyState === 1) socket.send(JSON.stringify({ do: what })); };
  by("tare").onclick = () => send("tare");
  by("reset").onclick = () => send("reset");
  by("hold").onclick = () => { held = !held; by("hold").setAttribute("aria-pressed", String(held)); soon(); };
  new ResizeObserver(soon).observe(document.body);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", soon);
  setInterval(soon, 500);
  table();
  connect();
})();

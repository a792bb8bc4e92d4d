// The playground: sends what is set to the module, and draws what comes back.
(async () => {
  const of = id => document.getElementById(id), host = of("tip"), verdict = of("verdict");
  if (!host || host.dataset.net) return;
  if (typeof FINGERTIP_MODULE === "undefined") {
    verdict.textContent = "The module is missing: `.ci/book` builds it.";
    return;
  }
  const bytes = Uint8Array.from(atob(FINGERTIP_MODULE), letter => letter.charCodeAt(0));
  // At once, which takes some hundredths of a second; browsers that do not want that wait for it.
  const module = async () => {
    try { return new WebAssembly.Instance(new WebAssembly.Module(bytes), {}); }
    catch { return (await WebAssembly.instantiate(bytes, {})).instance; }
  };
  const { exports: tip } = await module();

  const shapes = ["sphere", "ellipsoid", "capsule", "cylinder with ends", "cut cone", "rounded box", "superquadric"];
  const models = ["point contact", "soft finger", "auto"];
  const reasons = ["", "The line of action misses.", "The force only pulls.", "The force is below the threshold.",
    "No friction would hold this force.", "No contact can be told."];
  // Place in the module, label, unit, least, greatest, step, first, factor to SI.
  const knobs = [
    [1, "force", "N", 0.05, 10, 0.05, 2, 1],
    [2, "sideways over normal", "", 0, 1.5, 0.01, 0.25, 1],
    [3, "direction", "°", 0, 360, 1, 0, Math.PI / 180],
    [4, "spin torque", "N·mm", -5, 5, 0.1, 0, 1e-3],
    [7, "friction", "", 0.05, 1.5, 0.05, 0.5, 1],
    [5, "noise of the force", "mN", 0.1, 200, 0.1, 50, 1e-3],
    [6, "noise of the torque", "N·mm", 0.005, 2, 0.005, 0.5, 1e-3],
  ];

  const labelled = (form, text, control) => {
    const label = document.createElement("label"), name = document.createElement("span");
    name.textContent = text;
    label.append(name, control);
    form.append(label);
    return control;
  };
  const select = (form, text, options, changed) => {
    const control = labelled(form, text, document.createElement("select"));
    options.forEach((option, place) => control.add(new Option(option, place)));
    control.onchange = () => changed(+control.value);
    return control;
  };
  const slider = (form, [, text, unit, least, greatest, step, first], changed) => {
    const box = document.createElement("span"), control = document.createElement("input"), told = document.createElement("output");
    Object.assign(control, { type: "range", min: least, max: greatest, step, value: first });
    control.setAttribute("aria-label", text);
    const tell = () => { told.textContent = control.value + (unit ? "\u202f" + unit : ""); };
    control.oninput = () => { tell(); changed(+control.value); };
    box.append(control, told);
    labelled(form, text, box);
    tell();
    return control;
  };

  const mm = 1e3, three = place => [0, 1, 2].map(i => tip.value(place + i));
  const far = (from, along, length) => from.map((value, i) => value + along[i] * length);
  const size = vector => Math.hypot(...vector), unit = vector => vector.map(value => value / size(vector));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const ring = (centre, a, b) => Array.from({ length: 49 }, (_, i) => {
    const turn = i * Math.PI / 24;
    return centre.map((value, k) => value + a[k] * Math.cos(turn) + b[k] * Math.sin(turn));
  });
  const number = (value, digits = 3) => Number.isFinite(value) ? value.toPrecision(digits) : "–";
  const place = point => point.every(Number.isFinite) ? point.map(value => (value * mm).toFixed(2)).join(", ") : "–";

  let reach = 1;
  const shape = () => {
    const net = [];
    for (let i = 0; !Number.isNaN(tip.net(i)); i += 3) net.push([tip.net(i), tip.net(i + 1), tip.net(i + 2)].map(value => value * mm));
    const greatest = Math.max(...net.map(size));
    reach = 1.6 * greatest;
    const axes = [0, 1, 2].map(i => [0, 1, 2].map(k => k == i ? Math.max(...net.map(point => point[i])) + 0.3 * greatest : 0));
    const text = list => list.map(point => point.map(value => value.toFixed(3)).join(",")).join(";");
    Object.assign(host.dataset, { columns: 40, net: text(net), axes: text(axes), centre: "0,0,0", reach, contacts: "" });
  };

  const line = (colour, at, wide, through = false) => ({ kind: "line", colour, at, wide, through, lift: 0.05 });
  const dot = (colour, at, wide) => ({ kind: "dot", colour, at: [at], wide, lift: 0.08 });
  const arrow = (colour, from, to, wide) => {
    const along = unit(to.map((value, i) => value - from[i])), head = 0.06 * reach;
    const side = unit(cross(along, Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), back = far(to, along, -head);
    return [line(colour, [from, to], wide), line(colour, [far(back, side, 0.4 * head), to, far(back, side, -0.4 * head)], wide)];
  };

  const rows = of("felt").tBodies[0];
  const show = (found, mistake) => {
    const [normal, sideways, spin, margin] = [15, 16, 17, 18].map(tip.value), force = three(3), torque = three(6);
    const counted = tip.value(30), chosen = tip.value(31) ? "soft finger" : "point contact";
    const lines = [
      ["the sensor reads", force.map(value => value.toFixed(3)).join(", ") + "\u202fN; " + torque.map(value => (value * mm).toFixed(2)).join(", ") + "\u202fN·mm"],
      ["touched in truth", place(three(0)) + "\u202fmm"],
      ["contact found", found ? place(three(9)) + "\u202fmm, by " + chosen : "–"],
      ["off by", found ? (mistake * mm).toFixed(3) + "\u202fmm" : "–"],
      ["normal, sideways, spin", found ? `${number(normal)}\u202fN, ${number(sideways)}\u202fN, ${number(spin * mm)}\u202fN·mm` : "–"],
      ["margin to slip", found ? number(margin) + "\u202fN" : "–"],
      ["95 % of single samples within", found ? `${number(tip.value(19) * mm)} × ${number(tip.value(20) * mm)}\u202fmm` : "–"],
      ["instructions of the contact", Number.isFinite(counted) ? counted + " (x86-64, f32)" : "–"],
    ];
    rows.replaceChildren(...lines.map(cells => {
      const row = document.createElement("tr");
      row.append(...cells.map((cell, k) => Object.assign(document.createElement(k ? "td" : "th"), { textContent: cell })));
      return row;
    }));
  };

  const feel = () => {
    const told = tip.touch(), found = told === 0;
    const at = three(0).map(value => value * mm), force = three(3), along = unit(force), foot = three(27).map(value => value * mm);
    const marks = [line("line", Array.from({ length: 41 }, (_, i) => far(foot, along, reach * (i / 20 - 1))), 1, true)];
    const length = reach * (0.3 + 0.35 * Math.min(1, size(force) / 6));
    marks.push(...arrow("force", far(at, along, -length), at, 3), dot("true", at, 3));
    let mistake = NaN;
    if (found) {
      const contact = three(9).map(value => value * mm), normal = three(12);
      mistake = size(contact.map((value, i) => value - at[i])) / mm;
      const a = three(21).map(value => value * tip.value(19) * mm), b = three(24).map(value => value * tip.value(20) * mm);
      if ([...a, ...b].every(Number.isFinite)) marks.push(line("ellipse", ring(contact, a, b), 2));
      const side = unit(cross(normal, Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), other = cross(normal, side);
      const high = 0.22 * reach, broad = high * friction, rim = ring(far(contact, normal, high), side.map(v => v * broad), other.map(v => v * broad));
      marks.push(line("cone", rim, 1.5));
      for (let i = 0; i < 48; i += 6) marks.push(line("cone", [contact, rim[i]], 1));
      marks.push(dot("found", contact, 4.5));
    }
    if (host.live) host.live(marks);
    show(found, mistake);
    const margin = tip.value(18);
    verdict.textContent = !found ? reasons[told] : margin < 0 ? "Contact; it slips." : "Contact; it holds.";
    verdict.dataset.told = told;
    verdict.dataset.mistake = mistake;
    host.dispatchEvent(new Event("redraw"));
  };

  let friction = 0.5, dragged = false;
  const form = of("knobs");
  select(form, "shape", shapes, value => { tip.set_shape(value); shape(); feel(); }).id = "shape";
  select(form, "model", models, value => { tip.set(0, value); feel(); }).id = "model";
  select(form, "sign of the wrench", ["as it is", "wrong: the reaction"], value => { tip.set(8, value ? -1 : 1); feel(); }).id = "sign";
  knobs.forEach(knob => {
    const [number, , , , , , first, factor] = knob;
    tip.set(number, first * factor);
    slider(form, knob, value => {
      tip.set(number, value * factor);
      if (number === 7) friction = value;
      feel();
    }).id = "knob" + number;
  });
  host.grab = (from, along) => {
    const met = tip.aim(...from.map(value => value / mm), ...along) === 0;
    if (met) feel();
    return met || dragged;
  };
  host.dataset.view = "0.8,0.6,0;-0.25,0.33,0.91;0.546,-0.728,0.415";
  shape();
  feel();
  const script = document.createElement("script");
  script.src = "playground/solid.js";
  script.onload = feel;
  host.append(script);
  // The colours of the drawing are those of the theme that the reader chooses.
  new MutationObserver(() => host.dispatchEvent(new Event("redraw"))).observe(document.documentElement, { attributeFilter: ["class"] });

  // Gauges.
  const layout = { kind: 1, q: 19.8, d: 10, radius: 10, lever: 10 }, curve = of("curve");
  const condition = q => tip.condition(layout.kind, q * Math.PI / 180, layout.d / mm, layout.radius / mm, layout.lever / mm);
  const draw = () => {
    const dense = window.devicePixelRatio || 1, wide = curve.clientWidth, high = curve.clientHeight, ink = curve.getContext("2d");
    curve.width = wide * dense;
    curve.height = high * dense;
    ink.setTransform(dense, 0, 0, dense, 0, 0);
    const style = getComputedStyle(curve), left = 56, foot = high - 40, top = 12, most = 20;
    const x = q => left + (wide - left - 12) * (q - 2) / 83, y = value => foot - (foot - top) * Math.log(value) / Math.log(most);
    ink.strokeStyle = ink.fillStyle = style.color;
    ink.font = "13px system-ui, sans-serif";
    ink.lineWidth = 0.5;
    [1, 2, 5, 10, 20].forEach(value => {
      ink.beginPath(); ink.moveTo(left, y(value)); ink.lineTo(wide - 12, y(value)); ink.stroke();
      ink.textAlign = "right"; ink.fillText(value, left - 6, y(value) + 4);
    });
    ink.textAlign = "center";
    [10, 20, 30, 40, 50, 60, 70, 80].forEach(q => ink.fillText(q + "°", x(q), foot + 16));
    ink.fillText("angle Q of the gauges", (left + wide) / 2, foot + 33);
    ink.textAlign = "left";
    ink.font = "italic 13px system-ui, sans-serif"; ink.fillText("N", 2, (top + foot) / 2);
    ink.font = "10px system-ui, sans-serif"; ink.fillText("c", 12, (top + foot) / 2 + 4);
    ink.strokeStyle = style.getPropertyValue("--contact");
    ink.lineWidth = 2;
    ink.beginPath();
    let drawn = false;
    for (let q = 2; q <= 85; q += 0.25) {
      const value = condition(q);
      if (value <= most) { ink[drawn ? "lineTo" : "moveTo"](x(q), y(value)); drawn = true; } else drawn = false;
    }
    ink.stroke();
    const here = condition(layout.q);
    of("condition").textContent = Number.isFinite(here) ? `The condition number is ${here.toFixed(2)}.` : "These gauges make no sensor.";
    of("condition").dataset.number = here;
    if (here <= most) {
      ink.fillStyle = style.getPropertyValue("--force");
      ink.beginPath(); ink.arc(x(layout.q), y(here), 5, 0, 7); ink.fill();
    }
  };
  const gauges = of("gauge-knobs");
  select(gauges, "layout", ["Bicchi and Dario 1987", "three rosettes"], value => { layout.kind = value; draw(); }).value = 1;
  [
    [0, "angle Q", "°", 2, 85, 0.1, 19.8, "q"], [0, "radius of the tube", "mm", 3, 15, 0.1, 10, "radius"],
    [0, "second ring behind the first", "mm", 1, 20, 0.5, 10, "d"], [0, "lever", "mm", 3, 30, 0.5, 10, "lever"],
  ].forEach(knob => { slider(gauges, knob, value => { layout[knob[7]] = value; draw(); }).id = "gauge-" + knob[7]; });
  new ResizeObserver(draw).observe(curve);
  new MutationObserver(draw).observe(document.documentElement, { attributeFilter: ["class"] });
  document.documentElement.dataset.playground = "ready";
})();

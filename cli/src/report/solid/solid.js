// Draws the solid of the element around this script, and lets it be turned.
//
// A page may change the attributes of the element and send it "redraw". To `live` of the element it gives what is to be
// drawn with it from then on: lines, filled shapes, dots and rings of points `at`, each with the name of its `colour`, `wide`
// or with that radius, and lifted out of the surface by a share of its reach; a line that is `through` shows behind the
// solid, too. It may take hold of the pointer by `grab`, a function of a line of sight (a point and a direction) that says
// whether it does.
(host => {
  const canvas = document.createElement("canvas"), ink = canvas.getContext("2d");
  if (!ink) return;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The surface with contacts, to be turned with the arrow keys");
  const given = host.dataset;
  const points = text => text ? text.split(";").map(item => item ? item.split(",").map(Number) : null) : [];
  let axes, centre, reach, contacts, facets;
  const read = () => {
    const columns = +given.columns, net = points(given.net);
    axes = points(given.axes);
    [centre] = points(given.centre);
    reach = +given.reach;
    contacts = given.contacts.split("|").map(points);
    facets = [];
    for (let first = 0; first + columns < net.length; first++) {
      const row = first - first % columns, next = row + (first + 1) % columns;
      const corners = [first, first + columns, next + columns, next].map(place => net[place]);
      if (corners.every(corner => corner)) facets.push(corners);
    }
  };
  read();
  let live = [], frame, zoom;
  // A page may ask for `data-zoom` below 1, so that there is room for a force.
  const reset = () => { frame = points(given.view); zoom = +given.zoom || 1; };
  reset();

  const minus = (a, b) => a.map((value, i) => value - b[i]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const seen = point => { const from = minus(point, centre); return frame.map(axis => dot(axis, from)); };
  const mean = corners => corners.reduce((sum, corner) => sum + corner[2], 0) / corners.length;

  // 0 to 7, lit from the left above the viewer; the inside is darker.
  const shade = corners => {
    const normal = cross(minus(corners[2], corners[0]), minus(corners[3], corners[1]));
    const light = dot(normal, [-0.35, 0.45, 0.82]) / (Math.hypot(...normal) || 1);
    return Math.floor(Math.min(7.9, 8 * (normal[2] < 0 ? 0.35 * Math.abs(light) : Math.max(0, light))));
  };

  const pixels = () => zoom * (Math.min(canvas.clientWidth, canvas.clientHeight) / 2 - 6) / reach;

  const draw = () => {
    const dense = window.devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
    canvas.width = wide * dense;
    canvas.height = high * dense;
    ink.setTransform(dense, 0, 0, dense, 0, 0);
    const style = getComputedStyle(host), colour = name => style.getPropertyValue("--" + name).trim();
    const scale = pixels();
    const place = ([x, y]) => [wide / 2 + scale * x, high / 2 - scale * y];
    const colours = [0, 1, 2, 3, 4, 5, 6, 7].map(i => colour("s" + i));
    const items = facets.map(facet => {
      const corners = facet.map(seen);
      return [mean(corners), () => {
        ink.fillStyle = ink.strokeStyle = colours[shade(corners)];
        ink.lineWidth = 0.7;
        ink.beginPath();
        corners.forEach(corner => ink.lineTo(...place(corner)));
        ink.closePath();
        ink.fill();
        ink.stroke();
      }];
    });
    contacts.forEach((of, kind) => {
      const fill = colour("q" + kind);
      of.map(seen).forEach(point => items.push([point[2] + 0.06 * reach, () => {
        ink.fillStyle = fill;
        ink.beginPath();
        ink.arc(...place(point), 2.2, 0, 7);
        ink.fill();
      }]));
    });
    axes.forEach((tip, kind) => {
      const line = colour("abc"[kind]), at = share => seen(tip.map(value => value * share));
      for (let piece = 0; piece < 24; piece++) {
        const ends = [at(piece / 24), at((piece + 1) / 24)];
        items.push([mean(ends), () => {
          ink.strokeStyle = line;
          ink.lineWidth = 2;
          ink.beginPath();
          ends.forEach(end => ink.lineTo(...place(end)));
          ink.stroke();
        }]);
      }
      items.push([mean([at(1)]), () => {
        ink.fillStyle = colour("ink");
        ink.font = "12px system-ui, sans-serif";
        ink.textAlign = "center";
        const [x, y] = place(at(1.06));
        ink.fillText("xyz"[kind], x, y + 4);
      }]);
    });
    live.forEach(({ at, kind, colour: name, wide = 2, alpha = 1, lift = 0, through = false }) => {
      const corners = at.map(seen), tone = colour(name);
      const push = (depth, points, dashes) => items.push([depth, () => {
        ink.globalAlpha = alpha;
        ink.fillStyle = ink.strokeStyle = tone;
        ink.lineWidth = wide;
        ink.setLineDash(dashes);
        ink.beginPath();
        if (kind === "dot" || kind === "ring") points.forEach(point => ink.arc(...place(point), kind === "ring" ? 5 : wide, 0, 7));
        else points.forEach(point => ink.lineTo(...place(point)));
        kind === "fill" || kind === "dot" ? ink.fill() : ink.stroke();
        ink.setLineDash([]);
        ink.globalAlpha = 1;
      }]);
      if (through) push(Infinity, corners, [2, 4]);
      if (kind !== "line") push(mean(corners) + lift * reach, corners, []);
      // Piece by piece, since it may lie before the solid in part.
      else for (let piece = 1; piece < corners.length; piece++) {
        const ends = [corners[piece - 1], corners[piece]];
        push(mean(ends) + lift * reach, ends, []);
      }
    });
    items.sort((one, other) => one[0] - other[0]).forEach(item => item[1]());
  };

  let asked = false;
  const soon = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; draw(); });
  };
  // By angles to the right and down, about the directions of the screen.
  const turn = (right, down) => {
    const mix = (a, b, angle) => a.map((value, i) => value * Math.cos(angle) + b[i] * Math.sin(angle));
    const [x, y, z] = frame, side = mix(x, z, right), near = mix(z, x, -right);
    frame = [side, mix(y, near, -down), mix(near, y, down)];
    soon();
  };
  const closer = factor => { zoom = Math.min(20, Math.max(0.3, zoom * factor)); soon(); };
  // From the viewer into the picture.
  const sight = event => {
    const box = canvas.getBoundingClientRect(), scale = pixels();
    const x = (event.clientX - box.left - box.width / 2) / scale, y = (box.height / 2 - event.clientY + box.top) / scale;
    const from = centre.map((value, i) => value + frame[0][i] * x + frame[1][i] * y + frame[2][i] * 4 * reach);
    return [from, frame[2].map(value => -value)];
  };
  let held = null, grabbed = false;
  canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId);
    held = [event.clientX, event.clientY];
    grabbed = host.grab ? host.grab(...sight(event)) : false;
  };
  canvas.onpointerup = canvas.onpointercancel = () => { held = null; };
  canvas.onpointermove = event => {
    if (!held) return;
    if (grabbed) return void host.grab(...sight(event));
    turn((event.clientX - held[0]) / 120, (event.clientY - held[1]) / 120);
    held = [event.clientX, event.clientY];
  };
  canvas.addEventListener("wheel", event => { event.preventDefault(); closer(Math.exp(-event.deltaY / 600)); }, { passive: false });
  canvas.ondblclick = () => { reset(); soon(); };
  canvas.onkeydown = event => {
    const keys = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }, zooms = { "+": 1.2, "-": 1 / 1.2 };
    if (keys[event.key]) turn(...keys[event.key].map(step => step / 6));
    else if (zooms[event.key]) closer(zooms[event.key]);
    else return;
    event.preventDefault();
  };
  host.addEventListener("redraw", () => { read(); soon(); });
  host.append(canvas);
  host.reach = reach;
  host.addEventListener("reset", canvas.ondblclick);
  host.live = parts => { live = parts; soon(); };
  host.classList.add("turns");
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", soon);
  new ResizeObserver(soon).observe(canvas);
})(document.currentScript.parentNode);

// Shows what the point of a drawing nearest to the pointer says, in the units of its axes.
(() => {
  const near = 12, name = "http://www.w3.org/2000/svg";
  const element = (kind, parent) => parent.appendChild(document.createElementNS(name, kind));
  const digits = number => Number(number.toPrecision(4)).toString().replace("-", "\u2212");

  // How a place between 0 and 1 is read on an axis: its name, its unit, its ends, and whether it has decades.
  const axis = text => {
    const [label, low, high, decades] = text.split(";"), [what, unit] = label.split(" / ");
    const read = share => decades ? low * (high / low) ** share : +low + share * (high - low);
    return share => `${what} ${digits(read(share))}${unit ? (unit === "\u00b0" ? "" : " ") + unit : ""}`;
  };

  for (const plot of document.querySelectorAll("svg[data-x], svg[data-turn]")) {
    const drawing = plot.ownerSVGElement, given = plot.dataset, box = plot.viewBox.baseVal;
    let read;
    if (given.turn) {
      const scale = +given.turn, middle = [box.x + box.width / 2, box.y + box.height / 2];
      read = ([x, y]) => {
        const right = (x - middle[0]) / scale, up = (middle[1] - y) / scale, chord = Math.hypot(right, up);
        const angle = 360 / Math.PI * Math.asin(Math.min(1, chord / 2)), turn = 180 / Math.PI * Math.atan2(up, right);
        return [`${digits(angle)}\u00b0 from the pole`, `${digits(turn)}\u00b0 around it`];
      };
    } else {
      const across = axis(given.x), up = axis(given.y);
      read = ([x, y]) => [across((x - box.x) / box.width), up(1 - (y - box.y) / box.height)];
    }
    const keys = drawing.closest("figure")?.querySelectorAll(".keys i") ?? [];
    const called = path => [...keys].find(key => path.classList.contains(key.classList[0]))?.nextSibling?.data;
    let points;
    const all = () => points ??= [...plot.querySelectorAll(".curve, .dots, .squares")].flatMap(path => {
      const what = called(path);
      return [...path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)/g)].map(([, x, y]) => [+x, +y, what]);
    });
    let shown;
    const hide = () => { shown?.remove(); shown = undefined; };
    const show = event => {
      const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawing.getScreenCTM().inverse());
      let best, least = near * near;
      for (const point of all()) {
        const square = (point[0] - place.x) ** 2 + (point[1] - place.y) ** 2;
        if (square < least) [best, least] = [point, square];
      }
      hide();
      if (!best) return;
      shown = element("g", drawing);
      shown.setAttribute("class", "reading");
      const spot = element("circle", shown);
      spot.setAttribute("cx", best[0]);
      spot.setAttribute("cy", best[1]);
      spot.setAttribute("r", 4);
      const lines = [best[2], ...read(best)].filter(line => line), left = best[0] > box.x + box.width / 2;
      lines.forEach((line, row) => {
        const text = element("text", shown);
        text.setAttribute("x", best[0] + (left ? -8 : 8));
        text.setAttribute("y", Math.max(best[1], box.y + 14 * lines.length) - 14 * (lines.length - 1 - row));
        text.setAttribute("text-anchor", left ? "end" : "start");
        text.textContent = line;
      });
    };
    drawing.addEventListener("pointermove", show);
    drawing.addEventListener("pointerdown", show);
    drawing.addEventListener("pointerleave", hide);
  }
})();

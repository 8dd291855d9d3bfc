// Figures: the value under the pointer, the figure at large, its files, and its drawing for a telephone.
"use strict";
(() => {
  const save = (name, type, text) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  // Images of a drawing for a telephone are those of the broad one.
  const phone = matchMedia("(max-width: 40rem)");
  const narrow = () => {
    if (!phone.matches) return;
    document.querySelectorAll(".narrow[data-packed]").forEach(async (drawing) => {
      const packed = drawing.dataset.packed;
      drawing.removeAttribute("data-packed");
      const template = document.createElement("template");
      template.innerHTML = await unpacked(packed);
      const images = drawing.parentElement.querySelectorAll(".broad image");
      template.content.querySelectorAll("image[data-image]").forEach((image) => {
        image.setAttribute("href", images[image.dataset.image].getAttribute("href"));
      });
      drawing.replaceChildren(template.content);
    });
  };
  narrow();
  phone.addEventListener("change", narrow);

  // A drawing as a file has its title and the style of the page's figures in itself.
  const alone = (svg) => {
    const copy = svg.cloneNode(true);
    const title = document.createElementNS(svg.namespaceURI, "title");
    const style = document.createElementNS(svg.namespaceURI, "style");
    title.textContent = svg.getAttribute("aria-label");
    style.textContent = document.getElementById("figure-style").textContent;
    copy.prepend(title, style);
    return copy.outerHTML;
  };

  const REACH = 16;
  const shown = document.createElement("output");
  shown.className = "value";
  shown.hidden = true;
  const spot = document.createElement("span");
  spot.className = "spot";
  spot.hidden = true;
  const hide = () => { shown.hidden = spot.hidden = true; };
  const number = (axis, value, places) => {
    const text = axis.logarithmic ? (10 ** value).toPrecision(4) : value.toFixed(Math.min(Math.max(places, 0), 100));
    return `${axis.label} ${String(Number(text)).replace("-", "\u2212")}${axis.unit ? ` ${axis.unit}` : ""}`;
  };
  // The datum of a drawing next to a place in the window, within reach; a line has one everywhere.
  const nearest = (svg, panels, place) => {
    const matrix = svg.getScreenCTM();
    const at = new DOMPoint(place.x, place.y).matrixTransform(matrix.inverse());
    let best = { away: REACH / matrix.a };
    svg.querySelectorAll("svg[data-x]").forEach((frame, index) => {
      const [left, top, width, height] = ["x", "y", "width", "height"].map((name) => Number(frame.getAttribute(name)));
      if (at.x < left || at.x > left + width || at.y < top || at.y > top + height) return;
      const [across, up] = [frame.dataset.x, frame.dataset.y].map((ends) => ends.split(" ").map(Number));
      const place = ([x, y]) => [left + width * (x - across[0]) / (across[1] - across[0]), top + height * (up[1] - y) / (up[1] - up[0])];
      panels[index].series.forEach((series) => {
        if (series.kind === "region") return;
        let before = null;
        series.x.of.forEach((value, row) => {
          const datum = [value, series.y.of[row]];
          const [x, y] = place(datum);
          let back = 0;
          if (series.kind === "line" && before) {
            const step = [x - before.at[0], y - before.at[1]];
            const length = step[0] ** 2 + step[1] ** 2;
            back = length ? Math.min(Math.max((step[0] * (x - at.x) + step[1] * (y - at.y)) / length, 0), 1) : 0;
          }
          const between = (one, other) => (back ? one + back * (other - one) : one);
          const near = back ? [between(x, before.at[0]), between(y, before.at[1])] : [x, y];
          const away = Math.hypot(near[0] - at.x, near[1] - at.y);
          if (away < best.away) {
            const told = back ? datum.map((part, which) => between(part, before.datum[which])) : datum;
            best = { away, near, told, series, panel: panels[index] };
          }
          before = Number.isNaN(x + y) ? null : { at: [x, y], datum };
        });
      });
    });
    return best.series && { ...best, at: new DOMPoint(...best.near).matrixTransform(matrix) };
  };
  const point = (container, figure) => {
    let last = 0;
    const show = async (event) => {
      const svg = event.target.closest?.("svg[viewBox]");
      const turn = (last += 1);
      if (!svg) return hide();
      const panels = await figureValues(figure);
      const found = turn === last && nearest(svg, panels, { x: event.clientX, y: event.clientY });
      if (turn !== last) return;
      if (!found) return hide();
      const { series, panel, told, at } = found;
      const values = [number(panel.x, told[0], series.x.places), number(panel.y, told[1], series.y.places)].join(", ");
      shown.textContent = series.name ? `${series.name}: ${values}` : values;
      container.append(spot, shown);
      shown.hidden = spot.hidden = false;
      spot.style.left = `${at.x}px`;
      spot.style.top = `${at.y}px`;
      const room = document.documentElement.clientWidth;
      shown.style.left = `${Math.max(4, Math.min(at.x + 12, room - shown.offsetWidth - 4))}px`;
      shown.style.top = `${at.y - shown.offsetHeight - 10 > 0 ? at.y - shown.offsetHeight - 10 : at.y + 14}px`;
    };
    container.addEventListener("pointermove", show);
    container.addEventListener("pointerdown", show);
    // A finger leaves at once; its value stays until the next touch.
    container.addEventListener("pointerleave", (event) => {
      if (event.pointerType !== "mouse") return;
      last += 1;
      hide();
    });
  };
  document.addEventListener("pointerdown", (event) => { if (!event.target.closest("svg")) hide(); });
  addEventListener("scroll", hide, { passive: true, capture: true });

  const button = (label, act) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = label;
    made.addEventListener("click", act);
    return made;
  };

  // The figure as large as the window; a rectangle that is dragged there fills it.
  const enlarge = (figure) => {
    const dialog = document.createElement("dialog");
    dialog.className = "large";
    const drawing = document.createElement("div");
    drawing.className = "drawing";
    const drawn = [...figure.querySelectorAll(".drawing > svg")].find((svg) => svg.getClientRects().length);
    const svg = drawn.cloneNode(true);
    const whole = svg.getAttribute("viewBox");
    dialog.setAttribute("aria-label", svg.getAttribute("aria-label"));
    const buttons = document.createElement("div");
    buttons.className = "save";
    const hint = document.createElement("span");
    hint.textContent = "Drag a rectangle to zoom in.";
    buttons.append(button("Close", () => dialog.close()), button("Whole figure", () => svg.setAttribute("viewBox", whole)), hint);
    drawing.append(svg);
    dialog.append(buttons, drawing);
    const box = document.createElementNS(svg.namespaceURI, "rect");
    box.setAttribute("class", "zoom");
    let begun = null;
    const at = (event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const sides = (event) => {
      const to = at(event);
      return [Math.min(begun.x, to.x), Math.min(begun.y, to.y), Math.abs(to.x - begun.x), Math.abs(to.y - begun.y)];
    };
    svg.addEventListener("pointerdown", (event) => {
      begun = at(event);
      svg.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    svg.addEventListener("pointermove", (event) => {
      if (!begun) return;
      svg.append(box);
      sides(event).forEach((side, index) => box.setAttribute(["x", "y", "width", "height"][index], side));
    });
    svg.addEventListener("pointerup", (event) => {
      const to = begun && sides(event);
      begun = null;
      box.remove();
      if (to && to[2] > 4 && to[3] > 4) svg.setAttribute("viewBox", to.join(" "));
    });
    point(dialog, figure);
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  };

  document.querySelectorAll("figure[id] .save").forEach((buttons) => {
    const figure = buttons.closest("figure");
    const name = figure.id.replace("plate-", "");
    figure.querySelectorAll(".drawing").forEach((drawing) => point(drawing, figure));
    buttons.append(
      button("Enlarge", () => enlarge(figure)),
      button("Save as SVG", () => save(`${name}.svg`, "image/svg+xml", alone(figure.querySelector(".broad svg")))),
      button("Data as CSV", async () => save(`${name}.csv`, "text/csv", figureTable(await figureValues(figure)))),
    );
  });
})();

// A plot on the page: draws scenes (see draw.js) on a canvas and lets the reader point, drag, pinch and use the keyboard.
//
//   const plot = Explore.plot(host, { label, aspect: 0.6, least: 240, describe: () => text, select(motion), choose(motion),
//                                     zoom({ x: [low, high], y: [low, high] }), back(), scrub(x, done) (a drag moves the cursor) })
//   plot.draw(scene)            draws; `scene.description` (one or two sentences that say the result) is what a screen reader reads
//   plot.mark([{ x, y }])       rings on top: the motion that is selected somewhere else; [] takes them away
//   plot.svg(width = 860)       the scene as an SVG file with the colours of paper
//   plot.cursor(x)              an upright line on top, cheap enough for every frame
//   plot.scene, plot.redraw()
// Pointing: the nearest datum of a layer with `hover` or `motion` shows its box and calls `select(motion)`; a click or Enter
// calls `choose(motion)`; a dragged rectangle, a pinch, + and - call `zoom`; Escape and a double click call `back`.
// Arrow keys walk through the data; Shift and arrows move a rule that can be moved.
"use strict";
(() => {
  const finite = (value) => value !== null && Number.isFinite(value);

  // A scene onto a pen ---------------------------------------------------------------------------------------------------

  const grouped = (layer, xs, ys) => {
    // One group for each colour and shape, so that a cloud is a handful of paths.
    const groups = new Map();
    for (let index = 0; index < xs.length; index += 1) {
      if (!Number.isFinite(xs[index]) || !Number.isFinite(ys[index])) continue;
      const colour = layer.colours ? layer.colours[index] : layer.colour || "blue";
      const shape = layer.shapes ? layer.shapes[index] : layer.shape || "disc";
      const key = `${colour} ${shape}`;
      if (!groups.has(key)) groups.set(key, { colour, shape, xs: [], ys: [] });
      const group = groups.get(key);
      group.xs.push(xs[index]); group.ys.push(ys[index]);
    }
    return groups.values();
  };
  const mapped = (values, map) => {
    const made = new Float64Array(values.length);
    for (let index = 0; index < values.length; index += 1) made[index] = map(values[index]);
    return made;
  };
  const drawn = {
    points: (pen, layer, { across, up }, theme) => {
      const [xs, ys] = [mapped(layer.x, across), mapped(layer.y, up)];
      if (!layer.colours && !layer.shapes) { pen.marks(xs, ys, layer.shape || "disc", layer.size ?? 6, theme[layer.colour || "blue"], layer.alpha); return; }
      for (const group of grouped(layer, xs, ys)) pen.marks(group.xs, group.ys, group.shape, layer.size ?? 6, theme[group.colour], layer.alpha);
    },
    line: (pen, layer, { across, up }, theme) => pen.path(mapped(layer.x, across), mapped(layer.y, up),
      { stroke: layer.width === 0 ? undefined : theme[layer.colour || "ink"], width: layer.width, dash: layer.dash, alpha: layer.alpha, close: layer.close, fill: layer.fill && theme[layer.fill] }),
    band: (pen, layer, { across, up }, theme) => {
      const there = [...layer.x.keys()].filter((index) => finite(layer.low[index]) && finite(layer.high[index]));
      const xs = there.map((index) => across(layer.x[index]));
      pen.path([...xs, ...xs.slice().reverse()], [...there.map((index) => up(layer.low[index])), ...there.map((index) => up(layer.high[index])).reverse()],
        { fill: theme[layer.colour || "blue"], alpha: layer.alpha ?? 0.2, close: true });
    },
    cells: (pen, layer, { across, up }, theme) => pen.image({ left: across(layer.x[0]), right: across(layer.x[1]), bottom: up(layer.y[0]), top: up(layer.y[1]) },
      layer.columns, layer.rows, layer.cells, layer.colours.map((name) => theme[name] || name)),
    rects: (pen, layer, { across, up }, theme) => layer.rects.forEach(([x0, x1, y0, y1]) => pen.rect(across(x0), up(y1), across(x1) - across(x0), up(y0) - up(y1),
      { fill: layer.stroke ? undefined : theme[layer.colour || "blue"], stroke: layer.stroke && theme[layer.stroke], width: layer.width, alpha: layer.alpha })),
    rule: (pen, layer, { across, up, box }, theme) => {
      const style = { stroke: theme[layer.colour || "ink"], width: layer.width ?? 1.5, dash: layer.dash, alpha: layer.alpha };
      const upright = layer.x !== undefined;
      const at = upright ? across(layer.x) : up(layer.y);
      if (!Number.isFinite(at)) return;
      if (upright) pen.path([at, at], [box.top, box.bottom], style); else pen.path([box.left, box.right], [at, at], style);
      // A handle, so that a reader sees that it can be dragged.
      if (layer.move) { if (upright) pen.marks([at], [box.bottom - 7], "disc", 13, style.stroke); else pen.marks([box.right - 7], [at], "disc", 13, style.stroke); }
      if (!layer.label) return;
      const right = upright && at > (box.left + box.right) / 2;
      if (upright) pen.text(at + (right ? -1 : 1) * (layer.move ? 11 : 5), layer.move ? box.bottom - 8 : box.top + 9, layer.label, { colour: style.stroke, anchor: right ? "end" : "start" });
      else pen.text(box.left + 5, at + (at < box.top + 18 ? 10 : -9), layer.label, { colour: style.stroke });
    },
    flags: (pen, layer, { across, up, box }, theme) => layer.x.forEach((x, index) => {
      const at = across(x);
      if (!(at >= box.left - 1 && at <= box.right + 1)) return;
      const colour = theme[layer.colours ? layer.colours[index] : layer.colour || "vermilion"];
      const y = layer.y && finite(layer.y[index]) ? up(layer.y[index]) : box.top + 7;
      if (layer.line) pen.path([at, at], [box.top, box.bottom], { stroke: colour, width: 1, dash: [3, 3], alpha: 0.8 });
      pen.marks([at], [y], layer.shapes ? layer.shapes[index] : layer.shape || "triangle", layer.size ?? 9, colour);
      if (layer.label && layer.label[index]) pen.text(at + 7, y, layer.label[index], { colour, size: 11 });
    }),
    text: (pen, layer, { across, up }, theme) => pen.text(across(layer.x) + (layer.dx || 0), up(layer.y) + (layer.dy || 0), layer.text, { colour: theme[layer.colour || "soft"], anchor: layer.anchor, bold: layer.bold, size: layer.size }),
  };
  const titled = ({ label, unit }) => (unit ? `${label} (${Explore.unit(unit)})` : label || "");
  const axes = (pen, scene, { box, title, across, up }, theme) => {
    const [wide, high] = [box.right - box.left, box.bottom - box.top];
    const ticks = { x: Explore.ticks(scene.x, wide / 75), y: Explore.ticks(scene.y, high / 45) };
    ticks.x.forEach(([at, label]) => {
      pen.path([across(at), across(at)], [box.top, box.bottom], { stroke: theme.line, width: 0.7 });
      pen.text(across(at), box.bottom + 12, label, { colour: theme.ink, anchor: "middle" });
    });
    ticks.y.forEach(([at, label]) => {
      pen.path([box.left, box.right], [up(at), up(at)], { stroke: theme.line, width: 0.7 });
      pen.text(box.left - 6, up(at), label, { colour: theme.ink, anchor: "end" });
    });
    pen.text((box.left + box.right) / 2, box.bottom + 31, titled(scene.x), { colour: theme.soft, anchor: "middle" });
    pen.text(title, (box.top + box.bottom) / 2, titled(scene.y), { colour: theme.soft, anchor: "middle", turn: -90 });
  };
  const moves = (layer) => layer && layer.kind === "rule" && layer.move;
  /** Draws a scene with a pen; rules that can be moved only where `whole`. */
  Explore.render = (pen, scene, width, height, theme, whole = true) => {
    const place = Explore.layout(scene, width, height);
    if (!scene.x.bare) axes(pen, scene, place, theme);
    pen.clip(place.box);
    scene.layers.filter((layer) => layer && (whole || !moves(layer))).forEach((layer) => drawn[layer.kind](pen, layer, place, theme));
    pen.unclip();
    const { box } = place;
    if (!scene.x.bare) pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top, { stroke: theme.ink, width: 0.8 });
    if (scene.message) pen.text((box.left + box.right) / 2, (box.top + box.bottom) / 2, scene.message, { colour: theme.soft, anchor: "middle", size: 13 });
    return place;
  };

  // The plot -----------------------------------------------------------------------------------------------------------

  const made = (host, name, kind) => { const element = document.createElement(name); element.className = kind; host.append(element); return element; };
  const live = () => { const found = document.querySelector(".explore .live"); return found || { textContent: "" }; };
  /** Says a sentence to a screen reader. */
  Explore.say = (sentence) => { live().textContent = sentence; };
  /** A hover box as text: what the live region says. */
  Explore.spoken = (told) => [told.title, ...(told.rows || []).map(([name, value]) => `${name} ${value}`), told.known].filter(Boolean).join(", ");

  Explore.plot = (host, options = {}) => {
    const element = made(host, "div", "plot");
    const canvas = made(element, "canvas", "plot-data");
    const over = made(element, "canvas", "plot-over");
    const tip = made(element, "div", "tip");
    tip.hidden = true;
    Object.entries({ role: "img", tabindex: "0", "aria-label": options.label || "" }).forEach(([name, value]) => canvas.setAttribute(name, value));
    tip.setAttribute("aria-hidden", "true");
    const plot = { element, canvas, options, scene: null, place: null, marked: [], at: null, box: null, line: null };
    let size = [0, 0];

    const fit = () => {
      const width = Math.max(1, Math.round(element.clientWidth));
      const height = Math.round(options.height ? options.height(width) : Math.max(options.least ?? 240, width * (options.aspect ?? 0.6)));
      const ratio = window.devicePixelRatio || 1;
      size = [width, height];
      [canvas, over].forEach((each) => {
        const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
        if (each.width !== w || each.height !== h) [each.width, each.height] = [w, h];
        each.style.height = `${height}px`;
        each.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0);
      });
    };
    plot.redraw = () => {
      if (!plot.scene || !element.clientWidth) return;
      fit();
      const to = canvas.getContext("2d");
      to.clearRect(0, 0, ...size);
      plot.theme = Explore.theme(element);
      plot.place = Explore.render(Explore.canvasPen(to), plot.scene, ...size, plot.theme, false);
      plot.overlay();
    };
    plot.draw = (scene) => {
      const still = scene.base !== undefined && plot.scene && plot.scene.base === scene.base && plot.place && Math.round(element.clientWidth) === size[0];
      plot.scene = scene;
      if (still) { plot.overlay(); return; }
      plot.at = null;
      tip.hidden = true;
      canvas.setAttribute("aria-label", [options.label, scene.description].filter(Boolean).join(". "));
      plot.redraw();
    };
    /** What lies above the data: the datum pointed at, the motion selected elsewhere, the rectangle being dragged. */
    plot.overlay = () => {
      const to = over.getContext("2d");
      to.clearRect(0, 0, ...size);
      if (!plot.place) return;
      const [pen, theme, { across, up, box }] = [Explore.canvasPen(to), plot.theme, plot.place];
      pen.clip(box);
      plot.scene.layers.filter(moves).forEach((layer) => drawn.rule(pen, layer, plot.place, theme));
      if (plot.line !== null) { const at = across(plot.line); pen.path([at, at], [box.top, box.bottom], { stroke: theme.ink, width: 1.5 }); }
      if (plot.marked.length) {
        const [xs, ys] = [plot.marked.map(({ x }) => across(x)), plot.marked.map(({ y }) => up(y))];
        pen.marks(xs, ys, "ring", 17, theme.paper); pen.marks(xs, ys, "ring", 14, theme.ink);
      }
      if (plot.at) { pen.marks([plot.at.px], [plot.at.py], "ring", 17, theme.paper); pen.marks([plot.at.px], [plot.at.py], "ring", 14, theme.vermilion); }
      if (plot.box) pen.rect(plot.box[0], plot.box[2], plot.box[1] - plot.box[0], plot.box[3] - plot.box[2], { stroke: theme.blue, width: 1.5, dash: [5, 3] });
      pen.unclip();
    };
    plot.mark = (places) => { plot.marked = places || []; if (plot.place) plot.overlay(); };
    plot.cursor = (x) => { plot.line = x; if (plot.place) plot.overlay(); };
    plot.svg = (width = 860) => {
      if (!plot.scene) return null;
      const height = Math.round((width * size[1]) / (size[0] || width)) || width * 0.6;
      const theme = Explore.theme(element, true);
      const pen = Explore.svgPen(width, height, theme.paper, canvas.getAttribute("aria-label"));
      Explore.render(pen, plot.scene, width, height, theme);
      return pen.finish();
    };
    /** Shows a datum's box; `spoken` says it to a screen reader too. */
    plot.point = (at, spoken) => {
      plot.at = at;
      tip.hidden = true;
      if (at) {
        const told = at.layer.hover ? at.layer.hover(at.index) : null;
        if (told) {
          Explore.tipInto(tip, told);
          tip.hidden = false;
          const [w, h] = [tip.offsetWidth, tip.offsetHeight];
          tip.style.left = `${Math.max(0, Math.min(size[0] - w, at.px + (at.px + 14 + w > size[0] ? -14 - w : 14)))}px`;
          tip.style.top = `${Math.max(0, Math.min(size[1] - h, at.py - h / 2))}px`;
          if (spoken) Explore.say(Explore.spoken(told));
        }
      }
      if (options.select) options.select(at && at.layer.motion ? at.layer.motion(at.index) : null);
      plot.overlay();
    };
    Explore.pointing(plot, { size: () => size });
    new ResizeObserver(() => { if (Math.round(element.clientWidth) !== size[0]) plot.redraw(); }).observe(element);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", plot.redraw);
    return plot;
  };
  /** Fills a hover box: a title, rows of names and values, and how they are known. */
  Explore.tipInto = (tip, told) => {
    tip.replaceChildren();
    if (told.title) made(tip, "strong", "").textContent = told.title;
    const list = made(tip, "dl", "");
    (told.rows || []).forEach(([name, value]) => { made(list, "dt", "").textContent = name; made(list, "dd", "").textContent = value; });
    if (told.known) made(tip, "em", "").textContent = told.known;
  };
})();

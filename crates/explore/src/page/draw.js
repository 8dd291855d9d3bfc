// Draws a scene: axes, grid and layers of data, by one of two pens. `canvasPen` paints on the screen, `svgPen` writes the
// file that "Save SVG" saves. A pen knows pixels only; `Explore.render(pen, scene, width, height, theme)` knows data.
//
// A scene is plain data:
//   { x: AXIS, y: AXIS, layers: [LAYER...], equal: bool (one scale for both axes), message: text in the middle,
//     base: any value; while it is the same object or text, only rules that can be moved are drawn anew }
//   AXIS  = { label, unit, range: [low, high], log, turn: true (degrees: ticks at 30, 45, 90), ticks: [values], format, bare,
//             room (letters of the labels, so that pictures above each other line up) }
//   LAYER = { kind, colour, alpha, name (for the key), hover(i) -> {title, rows: [[name, value]], known}, motion(i), ... }
//     points   { x: [], y: [], shape, size (px, across), colours: [per point], shapes: [per point] }
//     line     { x: [], y: [], width, dash: [on, off], close, fill }   NaN or null breaks the line
//     band     { x: [], low: [], high: [] }
//     cells    { columns, rows, x: [low, high], y: [low, high], cells: [index...] (row by row from below), colours: [per index] }
//     rects    { rects: [[x0, x1, y0, y1]...], stroke, width }
//     rule     { x: value | y: value, width, dash, label, move(value, done) (it can be dragged) }
//     flags    { x: [], y: [] (missing: at the top edge), shape, label: [per flag], line: true (a line down to the axis) }
//     text     { x, y, text, anchor: "start"|"middle"|"end", dx, dy (px) }
// Colours are names of CSS variables: ink soft line wash paper blue vermilion green purple gold teal grey.
// Shapes: disc ring square triangle diamond cross plus dot (a small square, quick in clouds).
"use strict";
const Explore = {};
(() => {
  Explore.colours = ["blue", "vermilion", "green", "purple", "gold", "teal"];
  Explore.shapes = ["disc", "triangle", "square", "diamond", "ring", "cross"];
  const NAMES = ["ink", "soft", "line", "wash", "paper", "grey", ...Explore.colours];

  /** The colours in force at an element; `light` takes those of paper, for files. */
  Explore.theme = (element, light = false) => {
    const probe = light ? element.appendChild(document.createElement("i")) : element;
    if (light) probe.className = "explore-light";
    const style = getComputedStyle(probe);
    const found = Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim() || "#888"]));
    if (light) probe.remove();
    return found;
  };

  // Numbers as text ---------------------------------------------------------------------------------------------------

  const signed = (text) => text.replace(/^-/, "\u2212");
  const power = (text) => text.replace(/e([+-]?)(\d+)$/, (_, sign, digits) => `\u00d710${[...(sign === "-" ? `-${digits}` : digits)].map((one) => (one === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[one])).join("")}`);
  /** A number with so many significant digits, a real minus sign and no trailing zeros. */
  Explore.number = (value, digits = 5) => {
    if (value === null || value === undefined || !Number.isFinite(Number(value))) return "\u2013";
    const rounded = Number(Number(value).toPrecision(digits));
    const size = Math.abs(rounded);
    return signed(power(size !== 0 && (size >= 1e6 || size < 1e-4) ? rounded.toExponential() : String(rounded)));
  };
  Explore.fixed = (value, places) => (value === null || value === undefined || Number.isNaN(value) ? "\u2013" : signed(Number(value).toFixed(places)));
  /** A unit of the model file as it is printed. */
  Explore.unit = (unit) => (unit || "").replace(/^deg$/, "\u00b0").replace(/\^2/g, "\u00b2").replace(/\^3/g, "\u00b3");
  Explore.quantity = (value, unit, digits) => `${Explore.number(value, digits)}${unit ? `${unit === "\u00b0" || unit === "deg" ? "" : "\u00a0"}${Explore.unit(unit)}` : ""}`;
  /** A name of the model file as words: base_radius is "base radius", flank_start_deg "flank start". */
  Explore.spaced = (name) => name.replace(/_(deg|rpm)$/, "").replace(/_/g, " ");
  Explore.degrees = (radians) => (radians * 180) / Math.PI;
  Explore.radians = (degrees) => (degrees * Math.PI) / 180;
  /** The angle between 0 and 360 degrees. */
  Explore.turned = (radians) => ((Explore.degrees(radians) % 360) + 360) % 360;
  /** A column of angles in degrees, whatever the unit that its name ends in. */
  Explore.angles = (found, start) => {
    const name = Object.keys(found || {}).find((key) => key.startsWith(start));
    if (!name) return [];
    return name.endsWith("_deg") ? found[name] : found[name].map((each) => (each === null ? null : Explore.degrees(each)));
  };
  /** The column whose name begins with `start`: position_m or position_mm, as the model has it. */
  Explore.column = (found, start) => {
    const name = found && (start in found ? start : Object.keys(found).find((key) => key.startsWith(start)));
    return name ? found[name] : [];
  };
  /** The lowest and highest finite number, with a margin; `[0, 1]` where there is none. */
  Explore.extent = (lists, margin = 0.05) => {
    let [low, high] = [Infinity, -Infinity];
    for (const list of lists) for (const value of list) if (value !== null && Number.isFinite(value)) { if (value < low) low = value; if (value > high) high = value; }
    if (low > high) return [0, 1];
    // Values that differ by rounding alone are one value.
    const more = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? (high - low) * margin : Math.abs(low) * margin || margin;
    return [low - more, high + more];
  };

  // Scales ------------------------------------------------------------------------------------------------------------

  const STEPS = [1, 2, 2.5, 5, 10];
  const TURNS = [1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360];
  const step = (span, wanted, turn) => {
    if (turn && span / wanted > 0.7) return TURNS.find((each) => span / each <= wanted) || 360;
    const unit = 10 ** Math.floor(Math.log10(span / wanted));
    return unit * STEPS.find((each) => span / (unit * each) <= wanted + 1e-9);
  };
  /** Ticks of an axis: `[[value, label]...]`, about as many as wanted. */
  Explore.ticks = (axis, wanted) => {
    const [low, high] = axis.range;
    if (axis.ticks) return axis.ticks.filter((at) => at >= low && at <= high).map((at) => [at, axis.format ? axis.format(at) : Explore.number(at)]);
    if (!(high > low)) return [[low, Explore.number(low)]];
    const made = [];
    if (axis.log && high / low > 20) {
      const every = Math.max(1, Math.ceil(Math.log10(high / low) / wanted));
      for (let exponent = Math.ceil(Math.log10(low) - 1e-9); 10 ** exponent <= high * (1 + 1e-9); exponent += every) made.push([10 ** exponent, Explore.number(10 ** exponent)]);
      return made;
    }
    const by = step(high - low, Math.max(2, wanted), axis.turn);
    const places = Math.max(0, Math.min(12, -Math.floor(Math.log10(by) + 1e-9) + (Math.abs(by / 10 ** Math.floor(Math.log10(by) + 1e-9) - 2.5) < 1e-6 ? 1 : 0)));
    const small = Math.max(Math.abs(low), Math.abs(high)) < 1e-4 || Math.max(Math.abs(low), Math.abs(high)) >= 1e6;
    for (let index = Math.ceil(low / by - 1e-9); index * by <= high + by * 1e-9; index += 1) {
      const at = index * by;
      made.push([at, axis.format ? axis.format(at) : small ? Explore.number(at, 6) : signed((at === 0 ? 0 : at).toFixed(places))]);
    }
    return made;
  };
  const scale = (axis, from, to) => {
    const of = axis.log ? Math.log : (value) => value;
    const [low, high] = axis.range.map(of);
    const span = high - low || 1;
    const map = (value) => (value === null ? NaN : from + ((of(value) - low) / span) * (to - from));
    map.back = (pixel) => { const value = low + ((pixel - from) / (to - from)) * span; return axis.log ? Math.exp(value) : value; };
    return map;
  };
  /** The frame's box and the two scales of a scene at a size; `across(x)`, `up(y)` and their `.back`. */
  Explore.layout = (scene, width, height) => {
    const bare = scene.x.bare;
    // The left margin has room for the longest label and the title beside it.
    const labels = bare ? [] : Explore.ticks(scene.y, (height - 54) / 45).map(([, label]) => label.length);
    const wide = Math.max(scene.y.room || 3, ...labels) * 6.8 + 8;
    const box = bare ? { left: 2, top: 2, right: width - 2, bottom: height - 2 } : { left: wide + 20, top: 12, right: width - 18, bottom: height - 42 };
    if (scene.equal) {
      const [spanX, spanY] = [scene.x, scene.y].map(({ range }) => range[1] - range[0] || 1);
      const per = Math.min((box.right - box.left) / spanX, (box.bottom - box.top) / spanY);
      const [spareX, spareY] = [box.right - box.left - spanX * per, box.bottom - box.top - spanY * per];
      box.left += spareX / 2; box.right -= spareX / 2; box.top += spareY / 2; box.bottom -= spareY / 2;
    }
    return { box, title: box.left - wide - 8, across: scale(scene.x, box.left, box.right), up: scale(scene.y, box.bottom, box.top) };
  };

  // Shapes: each adds itself to a path by moveTo, lineTo, arc ------------------------------------------------------------

  const SHAPES = {
    disc: (to, x, y, r) => { to.moveTo(x + r, y); to.arc(x, y, r, 0, 2 * Math.PI); },
    square: (to, x, y, r) => to.rect(x - r * 0.9, y - r * 0.9, r * 1.8, r * 1.8),
    triangle: (to, x, y, r) => { to.moveTo(x, y - r * 1.2); to.lineTo(x + r * 1.1, y + r * 0.8); to.lineTo(x - r * 1.1, y + r * 0.8); to.closePath(); },
    diamond: (to, x, y, r) => { to.moveTo(x, y - r * 1.3); to.lineTo(x + r * 1.3, y); to.lineTo(x, y + r * 1.3); to.lineTo(x - r * 1.3, y); to.closePath(); },
    cross: (to, x, y, r) => { to.moveTo(x - r, y - r); to.lineTo(x + r, y + r); to.moveTo(x - r, y + r); to.lineTo(x + r, y - r); },
    plus: (to, x, y, r) => { to.moveTo(x - r, y); to.lineTo(x + r, y); to.moveTo(x, y - r); to.lineTo(x, y + r); },
  };
  SHAPES.ring = SHAPES.disc;
  const OUTLINED = new Set(["ring", "cross", "plus"]);

  // The two pens ---------------------------------------------------------------------------------------------------------

  /** A pen on a 2D canvas context whose unit is a CSS pixel. */
  Explore.canvasPen = (to) => {
    const ends = (style, trace) => {
      to.save();
      to.globalAlpha = style.alpha ?? 1;
      to.beginPath();
      trace();
      if (style.fill) { to.fillStyle = style.fill; to.fill(style.close ? "evenodd" : "nonzero"); }
      if (style.stroke) {
        to.strokeStyle = style.stroke; to.lineWidth = style.width ?? 1.5; to.setLineDash(style.dash || []);
        to.lineJoin = "round"; to.lineCap = style.cap || "butt"; to.stroke();
      }
      to.restore();
    };
    return {
      path: (xs, ys, style) => ends(style, () => {
        let going = false;
        for (let index = 0; index < xs.length; index += 1) {
          if (Number.isNaN(xs[index]) || Number.isNaN(ys[index])) { going = false; continue; }
          if (going) to.lineTo(xs[index], ys[index]); else to.moveTo(xs[index], ys[index]);
          going = true;
        }
        if (style.close) to.closePath();
      }),
      marks: (xs, ys, shape, size, colour, alpha = 1) => {
        if (shape === "dot") { Explore.cloud(to, xs, ys, size, colour, alpha); return; }
        ends(OUTLINED.has(shape) ? { stroke: colour, alpha, width: Math.max(1, size / 5) } : { fill: colour, alpha }, () => {
          for (let index = 0; index < xs.length; index += 1) SHAPES[shape](to, xs[index], ys[index], size / 2);
        });
      },
      rect: (x, y, width, height, style) => ends(style, () => to.rect(x, y, width, height)),
      text: (x, y, text, { colour, size = 12, anchor = "start", baseline = "middle", bold, turn = 0 }) => {
        to.save();
        to.translate(x, y); to.rotate((turn * Math.PI) / 180);
        to.font = `${bold ? "600 " : ""}${size}px ${Explore.sans}`;
        to.fillStyle = colour; to.textAlign = anchor === "middle" ? "center" : anchor; to.textBaseline = baseline;
        to.fillText(text, 0, 0);
        to.restore();
      },
      image: (box, columns, rows, cells, colours) => {
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [columns, rows];
        const own = canvas.getContext("2d");
        const data = own.createImageData(columns, rows);
        const whole = new Uint32Array(data.data.buffer);
        const shades = colours.map((colour) => Explore.rgba(own, colour));
        for (let row = 0; row < rows; row += 1) for (let column = 0; column < columns; column += 1) whole[(rows - 1 - row) * columns + column] = shades[cells[row * columns + column]] || 0;
        own.putImageData(data, 0, 0);
        to.save(); to.imageSmoothingEnabled = false; to.drawImage(canvas, box.left, box.top, box.right - box.left, box.bottom - box.top); to.restore();
      },
      clip: (box) => { to.save(); to.beginPath(); to.rect(box.left, box.top, box.right - box.left, box.bottom - box.top); to.clip(); },
      unclip: () => to.restore(),
    };
  };
  /** Many small squares: a large cloud is set pixel by pixel, fifty thousand in a few milliseconds. */
  Explore.cloud = (to, xs, ys, size, colour, alpha) => {
    if (xs.length < 3000) {
      to.save(); to.globalAlpha = alpha; to.fillStyle = colour;
      for (let index = 0; index < xs.length; index += 1) to.fillRect(xs[index] - size / 2, ys[index] - size / 2, size, size);
      to.restore();
      return;
    }
    const [ratio, { width, height }] = [to.getTransform().a, to.canvas];
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const own = canvas.getContext("2d");
    const data = own.createImageData(width, height);
    const whole = new Uint32Array(data.data.buffer);
    const shade = ((Explore.rgba(own, colour) & 0xffffff) | (Math.round(255 * alpha) << 24)) >>> 0;
    const side = Math.max(1, Math.round(size * ratio));
    for (let index = 0; index < xs.length; index += 1) {
      const [left, top] = [Math.round(xs[index] * ratio - side / 2), Math.round(ys[index] * ratio - side / 2)];
      if (!(left >= 0 && top >= 0 && left + side < width && top + side < height)) continue;
      for (let row = 0; row < side; row += 1) whole.fill(shade, (top + row) * width + left, (top + row) * width + left + side);
    }
    own.putImageData(data, 0, 0);
    to.save(); to.setTransform(1, 0, 0, 1, 0, 0); to.drawImage(canvas, 0, 0); to.restore();
  };
  /** Several SVG files below each other as one. */
  Explore.stack = (files) => {
    const sizes = files.map((file) => /width="([\d.]+)" height="([\d.]+)"/.exec(file).slice(1).map(Number));
    const [width, height] = [Math.max(...sizes.map(([each]) => each)), sizes.reduce((sum, [, each]) => sum + each, 0)];
    let top = 0;
    const parts = files.map((file, index) => { const placed = file.replace("<svg ", `<svg x="${(width - sizes[index][0]) / 2}" y="${top}" `); top += sizes[index][1]; return placed; });
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">${parts.join("")}</svg>\n`;
  };
  Explore.sans = 'system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif';
  /** A colour as one little-endian pixel. */
  Explore.rgba = (context, colour) => {
    context.fillStyle = "#000"; context.fillStyle = colour;
    const hex = context.fillStyle;
    const parts = hex.startsWith("#") ? [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)) : hex.match(/[\d.]+/g).map(Number);
    return ((255 << 24) | (parts[2] << 16) | (parts[1] << 8) | parts[0]) >>> 0;
  };

  let clips = 0;
  /** A pen that writes SVG; `finish()` returns the file. */
  Explore.svgPen = (width, height, paper, title) => {
    const parts = [];
    const escape = (text) => String(text).replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
    const at = (value) => Math.round(value * 100) / 100;
    const look = (style) => [`fill="${style.fill || "none"}"`, style.fill && style.close ? 'fill-rule="evenodd"' : "", style.stroke ? `stroke="${style.stroke}" stroke-width="${style.width ?? 1.5}"` : "",
      style.dash && style.dash.length ? `stroke-dasharray="${style.dash.join(" ")}"` : "", (style.alpha ?? 1) < 1 ? `opacity="${style.alpha}"` : ""].filter(Boolean).join(" ");
    const trace = () => {
      const d = [];
      return { d, moveTo: (x, y) => d.push(`M${at(x)} ${at(y)}`), lineTo: (x, y) => d.push(`L${at(x)} ${at(y)}`), closePath: () => d.push("z"),
        arc: (x, y, r) => d.push(`A${at(r)} ${at(r)} 0 1 1 ${at(x - r)} ${at(y)}A${at(r)} ${at(r)} 0 1 1 ${at(x + r)} ${at(y)}`),
        rect: (x, y, w, h) => d.push(`M${at(x)} ${at(y)}h${at(w)}v${at(h)}h${at(-w)}z`) };
    };
    return {
      path: (xs, ys, style) => {
        const to = trace();
        let going = false;
        for (let index = 0; index < xs.length; index += 1) {
          if (Number.isNaN(xs[index]) || Number.isNaN(ys[index])) { going = false; continue; }
          if (going) to.lineTo(xs[index], ys[index]); else to.moveTo(xs[index], ys[index]);
          going = true;
        }
        if (style.close) to.closePath();
        parts.push(`<path d="${to.d.join("")}" ${look(style)}/>`);
      },
      marks: (xs, ys, shape, size, colour, alpha = 1) => {
        if (!xs.length) return;
        if (shape === "dot") {
          const d = Array.from(xs, (x, index) => `M${at(x)} ${at(ys[index])}h0`).join("");
          parts.push(`<path d="${d}" fill="none" stroke="${colour}" stroke-width="${size}" stroke-linecap="round"${alpha < 1 ? ` opacity="${alpha}"` : ""}/>`);
          return;
        }
        const to = trace();
        for (let index = 0; index < xs.length; index += 1) SHAPES[shape](to, xs[index], ys[index], size / 2);
        parts.push(`<path d="${to.d.join("")}" ${look(OUTLINED.has(shape) ? { stroke: colour, alpha, width: Math.max(1, size / 5) } : { fill: colour, alpha })}/>`);
      },
      rect: (x, y, w, h, style) => parts.push(`<rect x="${at(x)}" y="${at(y)}" width="${at(w)}" height="${at(h)}" ${look(style)}/>`),
      text: (x, y, text, { colour, size = 12, anchor = "start", baseline = "middle", bold, turn = 0 }) => {
        const drop = { middle: 0.35, top: 0.8, bottom: -0.2, alphabetic: 0 }[baseline] * size;
        parts.push(`<text transform="translate(${at(x)} ${at(y)})${turn ? ` rotate(${turn})` : ""}" dy="${at(drop)}" fill="${colour}" font-size="${size}" text-anchor="${anchor}"${bold ? ' font-weight="600"' : ""}>${escape(text)}</text>`);
      },
      image: (box, columns, rows, cells, colours) => {
        // Runs of one colour in a row become one rectangle.
        const [w, h] = [(box.right - box.left) / columns, (box.bottom - box.top) / rows];
        const runs = colours.map(() => []);
        for (let row = 0; row < rows; row += 1) for (let column = 0; column < columns;) {
          const cell = cells[row * columns + column];
          let end = column + 1;
          while (end < columns && cells[row * columns + end] === cell) end += 1;
          if (runs[cell]) runs[cell].push(`M${at(box.left + column * w)} ${at(box.bottom - (row + 1) * h)}h${at((end - column) * w)}v${at(h)}h${at((column - end) * w)}z`);
          column = end;
        }
        runs.forEach((d, index) => { if (d.length) parts.push(`<path d="${d.join("")}" fill="${colours[index]}" shape-rendering="crispEdges"/>`); });
      },
      clip: (box) => {
        clips += 1;
        parts.push(`<clipPath id="clip${clips}"><rect x="${at(box.left)}" y="${at(box.top)}" width="${at(box.right - box.left)}" height="${at(box.bottom - box.top)}"/></clipPath><g clip-path="url(#clip${clips})">`);
      },
      unclip: () => parts.push("</g>"),
      finish: () => `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="${escape(Explore.sans)}" role="img"><title>${escape(title || "")}</title><rect width="${width}" height="${height}" fill="${paper}"/>${parts.join("\n")}</svg>\n`,
    };
  };
})();

// Basins of attraction: what each start of a grid ends on, at one cam angle.
//
// The grid is computed three times, each finer than the last, so that something is seen at once. A colour and a shape stand
// for each attractor. The shapes are strewn over the colours, and a keyboard walks through them.
"use strict";
(() => {
  const { number, fixed, quantity, degrees, radians, column } = Explore;
  const GRIDS = [[40, 30], [80, 60], [160, 120]];
  const FINEST = [320, 240];
  // Starts whose shape is drawn: so many across and up.
  const MARKS = [20, 14];

  const nameOf = (ending) => Explore.ending(ending);
  const keyOf = (ending, seen) => {
    const plain = `${ending.kind || ending.ending} ${ending.revolutions ?? ""} ${ending.impacts ?? ""}`;
    seen.set(plain, (seen.get(plain) || 0) + 1);
    return `${plain} ${seen.get(plain)}`;
  };
  /** Numbers the endings so that an attractor keeps its colour when the grid becomes finer. */
  const lookOf = (endings, kept) => {
    const seen = new Map();
    return endings.map((ending) => {
      const key = keyOf(ending, seen);
      if (!kept.has(key)) kept.set(key, kept.size);
      const index = kept.get(key);
      return { colour: Explore.colours[index % 6], shape: Explore.shapes[index % 6] };
    });
  };
  /** The share of the starts of each ending, with the standard error of as many starts drawn by chance. */
  const sharesOf = (found) => {
    const counts = found.endings.map(() => 0);
    let all = 0;
    found.ends.forEach((each) => { if (each >= 0) { counts[each] += 1; all += 1; } });
    return counts.map((count) => ({ share: count / (all || 1), error: Math.sqrt(((count / (all || 1)) * (1 - count / (all || 1))) / (all || 1)) }));
  };
  const rangesOf = (grid) => ({ x: column(grid, "position_"), y: column(grid, "velocity_") });

  /** A range without digits that nobody chose: to a thousandth of its width. */
  const neat = ([low, high]) => { const unit = 10 ** Math.floor(Math.log10((high - low) / 500)); return [low, high].map((each) => Number((Math.round(each / unit) * unit).toPrecision(12))); };
  Explore.parts.neat = neat;
  /** The start in the middle of each cell. */
  const starts = (found, columns, rows) => {
    const { x, y } = rangesOf(found);
    return (index) => ({
      position: x[0] + ((index % columns) + 0.5) * (x[1] - x[0]) / columns,
      velocity: y[0] + (Math.floor(index / columns) + 0.5) * (y[1] - y[0]) / rows,
    });
  };
  /** The cells in which a shape is drawn: a sparse lattice, its rows shifted against each other. */
  const strewn = (columns, rows, width) => {
    const found = [];
    const [wide, high] = MARKS.map((most) => Math.max(6, Math.round(most * Math.min(1, width / 700))));
    for (let row = 0; row < high; row += 1) for (let across = 0; across < wide; across += 1) {
      const [u, v] = [(across + (row % 2 ? 0.75 : 0.25)) / wide, (row + 0.5) / high];
      found.push(Math.floor(v * rows) * columns + Math.min(columns - 1, Math.floor(u * columns)));
    }
    return found;
  };

  /** A curve cut where neighbours are far apart: a chord across the picture is no border. */
  const broken = (points, x, y) => {
    const line = { x: [], y: [] };
    const far = ([q0, v0], [q1, v1]) => Math.hypot((q1 - q0) / (x[1] - x[0]), (v1 - v0) / (y[1] - y[0]));
    let last = null;
    points.forEach((point, index) => {
      // Points nearer to each other than a pixel are one.
      const step = last ? far(last, point) : 1;
      if (step < 0.001 && index < points.length - 1) return;
      if (last && step > 0.06) { line.x.push(NaN); line.y.push(NaN); }
      line.x.push(point[0]); line.y.push(point[1]);
      last = point;
    });
    return line;
  };

  /** The layers of a picture: cells, shapes, the border and its saddles, the start. */
  const layersOf = (found, looks, state, angle, unit, width) => {
    const [columns, rows] = found.size;
    const start = starts(found, columns, rows);
    const hover = (index) => {
      const ending = found.endings[found.ends[index]];
      const from = start(index);
      return { title: ending ? Explore.parts.capital(nameOf(ending)) : "Below the cam, or undecided",
        rows: [["position", quantity(from.position, unit.length)], ["velocity", quantity(from.velocity, unit.velocity)]], known: "sampled; click to start there" };
    };
    const motion = (index) => (found.ends[index] < 0 ? null : { rpm: state.rpm, cam_angle_rad: angle, ...start(index) });
    const { x, y } = rangesOf(found);
    const marks = looks.map(({ shape }, ending) => {
      const cells = strewn(columns, rows, width).filter((index) => found.ends[index] === ending);
      return { kind: "points", x: cells.map((index) => start(index).position), y: cells.map((index) => start(index).velocity), shape, size: 7, colour: "paper", alpha: 0.85,
        keys: { hover: (index) => hover(cells[index]), motion: (index) => motion(cells[index]) } };
    });
    const { curves = [], saddles = [], stable = [] } = found.boundary || {};
    const lines = found.endings.length > 1 ? curves.map((points) => broken(points, x, y)) : [];
    const border = [["paper", 4.5], ["ink", 2]].flatMap(([colour, width]) => lines.map((line) => ({ kind: "line", ...line, colour, width })));
    const own = state.start && Math.abs(state.start.cam_angle_rad - angle) < 1e-9 && Number.isFinite(state.start.position) ? state.start : null;
    return [
      { kind: "cells", columns, rows, x, y, cells: found.ends, colours: looks.map(({ colour }) => colour), hover, motion },
      ...marks, ...border,
      stable.length > 0 && found.endings.length > 0 && { kind: "points", x: stable.map(([q]) => q), y: stable.map(([, v]) => v), shape: "disc", size: 9, colour: "paper" },
      stable.length > 0 && found.endings.length > 0 && { kind: "points", x: stable.map(([q]) => q), y: stable.map(([, v]) => v), shape: "disc", size: 6, colour: "ink",
        hover: () => ({ title: "A stable periodic motion", rows: [["crosses the section", "at this point"]], known: "computed" }),
        motion: (index) => ({ rpm: state.rpm, cam_angle_rad: angle, position: stable[index][0], velocity: stable[index][1] }) },
      saddles.length > 0 && { kind: "points", x: saddles.map(([q]) => q), y: saddles.map(([, v]) => v), shape: "cross", size: 12, colour: "ink",
        motion: (index) => ({ rpm: state.rpm, cam_angle_rad: angle, position: saddles[index][0], velocity: saddles[index][1] }),
        hover: () => ({ title: "Saddle: an unstable periodic motion", rows: [["its stable manifold", "is the border"]], known: "computed" }) },
      own && { kind: "points", x: [own.position], y: [own.velocity], shape: "ring", size: 15, colour: "paper" },
      own && { kind: "points", x: [own.position], y: [own.velocity], shape: "plus", size: 12, colour: "ink" },
      own && { kind: "text", x: own.position, y: own.velocity, text: "start", dx: 10, dy: -10, colour: "ink", bold: true },
    ];
  };

  /** Fields for a start typed in, for those who cannot click. */
  const typed = (context, angle) => {
    const field = (label) => Explore.element("input", { type: "number", step: "any", "aria-label": label, placeholder: label });
    const [q, v] = [field("position"), field("velocity")];
    const take = () => {
      if (q.value !== "" && v.value !== "") context.choose({ rpm: context.state().rpm, cam_angle_rad: angle(), position: Number(q.value), velocity: Number(v.value) });
    };
    const element = Explore.element("span", { class: "typed" }, "Start at", q, v, Explore.button("Start there", take));
    element.show = (start) => {
      if (document.activeElement === q || document.activeElement === v) return;
      [q.value, v.value] = start && Number.isFinite(start.position) ? [start.position, start.velocity] : ["", ""];
    };
    return element;
  };

  const sectionOf = (context) => Explore.parts.optionOf(context, "section_deg", (value) => Number.isFinite(value) && value >= 0 && value < 360, 0);

  Explore.view({
    name: "basins", title: "Basins of attraction", wide: true,
    mount(panel, context) {
      const legend = Explore.element("div", { class: "legend" });
      const plot = context.plot(panel.body, {
        label: "Basins of attraction", aspect: 0.55, least: 280,
        zoom: ({ x, y }) => context.setOption("range", { x: neat(x), y: neat(y) }),
        back: () => { if (!Explore.parts.boxOf(context)) return false; context.setOption("range", null); return true; },
      });
      panel.body.append(legend);
      const angle = () => radians(sectionOf(context));
      const section = Explore.element("input", { type: "number", min: "0", max: "360", step: "any", value: "0",
        onchange: () => context.setOption("section_deg", ((Number(section.value) % 360) + 360) % 360) });
      const start = typed(context, angle);
      const finer = Explore.button("Finer", () => compute(context.state(), [FINEST]), { hidden: true });
      panel.options.append(Explore.element("label", { class: "menu" }, "Cam angle of the starts (°)", section), start, finer);
      let [shown, wanted, kept, run, border] = [null, null, new Map(), 0, null];

      // The shapes answer to the keyboard alone: a pointer would jump from shape to shape instead of cell to cell.
      const arm = (on) => {
        if (!plot.scene) return;
        plot.scene.layers.filter((layer) => layer && layer.keys).forEach((layer) => Object.assign(layer, on ? layer.keys : { hover: undefined, motion: undefined }));
        plot.cached = null;
      };
      plot.canvas.addEventListener("keydown", () => arm(true), true);
      plot.canvas.addEventListener("pointermove", () => arm(false), true);
      plot.canvas.addEventListener("pointerdown", () => arm(false), true);

      const draw = (state) => {
        if (!shown) return;
        const [looks, shares, unit] = [lookOf(shown.endings, kept), sharesOf(shown), Explore.parts.units(context)];
        const { x, y } = rangesOf(shown);
        const told = shown.endings.map((ending, index) => ({ ...looks[index], ...shares[index], name: nameOf(ending) })).sort((a, b) => b.share - a.share);
        const text = told.map(({ name, share, error }) => `${fixed(share * 100, 1)} ± ${fixed(Math.max(error * 100, 0.1), 1)} %: ${name}`);
        panel.heading(told.length === 1 ? `Every start settles on one motion: ${told[0].name}` : `${told.length} motions share the starts: ${told.slice(0, 3).map(({ name, share }) => `${name} (${fixed(share * 100, share < 0.1 || share > 0.99 ? 1 : 0)} %)`).join(", ")}`);
        legend.replaceChildren(Explore.key(told.map(({ colour, shape }, index) => ({ colour, shape, label: text[index] }))));
        plot.draw({
          x: { label: `position at cam angle ${number(degrees(shown.angle), 6)}°`, unit: unit.length, range: x },
          y: { label: "velocity at this angle", unit: unit.velocity, range: y },
          layers: layersOf(shown, looks, state, shown.angle, unit, plot.element.clientWidth || 700),
          description: `${shown.size[0]} by ${shown.size[1]} starts at ${number(state.rpm, 8)} rpm: ${text.join("; ")}`,
        });
      };
      const take = (found, grid, at) => {
        // A list of one entry a cell: the ending of its start.
        shown = { ...found, ...(found.grid || {}), ends: found.cell_endings || found.cells, size: grid, angle: at, boundary: found.boundary || border };
        draw(context.state());
        panel.note(`${number(grid[0] * grid[1])} starts${grid[0] < 160 ? "; a finer grid follows" : ""}. Click one to start there; drag a rectangle to zoom in. Large dots: stable periodic motions. Crosses: unstable ones. The lines through the crosses are their stable manifolds, which are the border.`);
      };
      const compute = async (state, grids) => {
        run += 1;
        const own = run;
        const [range, at] = [Explore.parts.boxOf(context), angle()];
        finer.hidden = true;
        const section = { view: "basins", rpm: state.rpm, cam_angle_rad: at, ...(range ? { position: range.x, velocity: range.y } : {}) };
        for (const grid of grids) {
          const found = await context.ask({ ...section, grid }, { slow: true });
          if (own !== run) return;
          if (!found) { wanted = null; Explore.parts.refused(panel); return; }
          take(found, grid, at);
        }
        // The border takes a second or two: it comes last.
        if (!border && shown.endings.length > 1) {
          const found = await context.ask({ ...section, grid: GRIDS[0], boundary: true }, { lane: "basins-border", slow: true });
          if (own !== run) return;
          border = found ? found.boundary : null;
          shown.boundary = border;
          draw(context.state());
        }
        finer.hidden = grids[grids.length - 1] === FINEST;
      };
      return {
        async update(state, { coarse }) {
          section.value = String(Number(sectionOf(context).toPrecision(10)));
          start.show(state.start);
          const key = JSON.stringify([context.app.question(), state.rpm, sectionOf(context), Explore.parts.boxOf(context)]);
          if (coarse && key !== wanted) { panel.status("computed when the slider rests"); return; }
          if (coarse) return;
          if (key === wanted) { panel.status(""); draw(state); return; }
          wanted = key;
          border = null;
          // A motion keeps its colour at all speeds of a machine, as long as there are colours for all.
          const machine = JSON.stringify([state.file, state.text]);
          if (machine !== kept.machine || kept.size > 12) kept = Object.assign(new Map(), { machine });
          await compute(state, GRIDS);
        },
        highlight(to) {
          const here = to && Number.isFinite(to.position) && Math.abs(degrees(to.cam_angle_rad - angle()) % 360) < 0.5;
          plot.mark(here ? [{ x: to.position, y: to.velocity }] : []);
        },
        csv: () => {
          if (!shown) return null;
          const from = starts(shown, ...shown.size);
          const [all, unit] = [[...shown.ends.keys()].map((index) => ({ ...from(index), ending: shown.endings[shown.ends[index]] || {} })), Explore.parts.units(context)];
          const name = (start, of) => `${start}_${(of || "").replace("/", "_")}`;
          return Explore.csv({
            [name("position", unit.length)]: all.map((each) => each.position), [name("velocity", unit.velocity)]: all.map((each) => each.velocity), ending: all.map((each) => each.ending.ending || each.ending.kind || ""),
            revolutions: all.map((each) => each.ending.revolutions ?? ""), impacts: all.map((each) => each.ending.impacts ?? ""),
          });
        },
      };
    },
  });
})();

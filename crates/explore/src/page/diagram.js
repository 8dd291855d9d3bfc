// The bifurcation diagram over any number: a dragged rectangle is computed anew at full resolution; the events of the
// attractors are flags; the number as it is now is a line that moves every other view.
"use strict";
(() => {
  const SHOWN = { angle: "impact angle", before: "velocity before impact", after: "velocity after impact", position: "position at impact" };
  const CAUSE = {
    "corner-impact": ["corner impact", "diamond", "vermilion"], fold: ["fold", "triangle", "purple"], flip: ["flip", "square", "green"], graze: ["graze", "ring", "gold"],
    "symmetry-breaking": ["symmetry breaking", "cross", "teal"], detachment: ["separation", "triangle", "teal"], runs: ["beginning or end seen in runs", "cross", "grey"],
  };
  const causeOf = (cause) => CAUSE[cause] || [String(cause).replace(/-/g, " "), "triangle", "gold"];

  // Events of the document of `speeds --json`: what attractors begin, end and pass with, and separation -----------------------

  const eventsOf = (sheet, varied) => {
    const found = new Map();
    const where = (event) => (varied === "rpm" ? event.speed_rpm : event.value ?? event.speed_rpm);
    const add = (event, what, attractor) => {
      if (!event) return;
      const key = `${event.cause} ${where(event)}`;
      if (!found.has(key)) found.set(key, { ...event, at: where(event), whose: [] });
      found.get(key).whose.push(`${attractor.id} ${what}`);
      const span = (attractor.to ?? attractor.to_rpm) - (attractor.from ?? attractor.from_rpm);
      found.get(key).span = Math.max(found.get(key).span ?? 0, span);
    };
    (sheet.attractors || []).forEach((attractor) => {
      add(attractor.birth, "begins", attractor);
      add(attractor.death, "ends", attractor);
      (attractor.passes || []).forEach((event) => add({ cause: "corner-impact", ...event }, "passes", attractor));
    });
    if (sheet.detachment_rpm && varied === "rpm") found.set(`detachment ${sheet.detachment_rpm}`, { cause: "detachment", at: sheet.detachment_rpm, located: true, whose: [], error_rpm: sheet.detachment_error_rpm });
    return [...found.values()].sort((a, b) => a.at - b.at);
  };
  const told = (event, name, unit) => {
    const [word] = causeOf(event.cause);
    const error = event.error_rpm ?? event.error;
    const bracket = event.bracket_rpm || event.bracket;
    const digits = bracket && bracket[1] > bracket[0] ? Math.min(12, Math.max(4, Math.ceil(-Math.log10((bracket[1] - bracket[0]) / Math.abs(event.at))) + 1)) : 10;
    return {
      title: word,
      rows: [[name, `${Explore.number(event.at, Math.min(digits, 10))}${error ? ` \u00b1 ${Explore.number(error, 2)}` : ""}\u00a0${unit}`],
        ...(Number.isFinite(event.cam_angle_rad) ? [["cam angle", `${Explore.fixed(Explore.turned(event.cam_angle_rad), 2)}\u00b0`]] : []),
        ...(event.whose.length ? [["attractors", event.whose.join(", ")]] : [])],
      known: event.located ? "located by its equation" : "bracketed by runs",
    };
  };

  /** The attractors of neighbouring values joined to families, so that each keeps its colour: by where their impacts lie and how far they spread. */
  const familiesOf = (found) => {
    const angles = Explore.angles(found, "cam_angle_");
    const groups = [];
    found.value.forEach((value, row) => {
      const last = groups[groups.length - 1];
      const group = groups.slice(-8).find((each) => each.value === value && each.index === found.attractor[row]);
      if (group) group.rows.push(row); else groups.push({ value, index: found.attractor[row], rows: [row], turn: last && last.value === value ? last.turn : (last ? last.turn : 0) + 1 });
    });
    groups.forEach((group) => {
      const own = group.rows.map((row) => angles[row]);
      group.mean = own.reduce((sum, each) => sum + each, 0) / own.length;
      group.spread = Math.sqrt(own.reduce((sum, each) => sum + (each - group.mean) ** 2, 0) / own.length);
    });
    const families = new Array(found.value.length).fill(0);
    let [count, before] = [0, []];
    for (let turn = 1; turn <= (groups.length ? groups[groups.length - 1].turn : 0); turn += 1) {
      const own = groups.filter((group) => group.turn === turn);
      const pairs = own.flatMap((group) => before.map((old) => ({ group, old, far: Math.abs(group.mean - old.mean) + 2 * Math.abs(group.spread - old.spread) }))).sort((a, b) => a.far - b.far);
      const taken = new Set();
      pairs.forEach(({ group, old, far }) => { if (group.family === undefined && !taken.has(old) && far < 60) { group.family = old.family; taken.add(old); } });
      own.forEach((group) => { if (group.family === undefined) { group.family = count; count += 1; } group.rows.forEach((row) => { families[row] = group.family; }); });
      before = own;
    }
    return families;
  };

  // The view ---------------------------------------------------------------------------------------------------------------

  Explore.view({
    name: "diagram", title: "Bifurcation diagram",
    mount(panel, context) {
      const visited = { list: [null], at: 0 };
      const zoomTo = (zoom) => context.change({ zoom });
      const step = (by) => {
        const to = visited.at + by;
        if (to < 0 || to >= visited.list.length) return false;
        visited.at = to;
        zoomTo(visited.list[to]);
        return true;
      };
      const plot = context.plot(panel.body, { label: "Bifurcation diagram", aspect: 0.66, least: 300, zoom: ({ x, y }) => zoomTo({ x, y }), back: () => step(-1) });
      const over = Explore.menu("Over", [["rpm", "speed (rpm)"]], "rpm", (name) => context.change({ over: { name, range: null }, zoom: null }));
      const shown = Explore.menu("Shows", Object.entries(SHOWN), "angle", (value) => context.setOption("shows", value, {}, context.state().zoom ? { zoom: { ...context.state().zoom, y: null } } : {}));
      const all = Explore.check("all attractors", false, (on) => context.setOption("all", on));
      const events = Explore.check("events", true, (on) => context.setOption("events", on));
      const back = Explore.button("\u2190 Back", () => step(-1), { title: "Back to the previous rectangle (Escape)" });
      const on = Explore.button("Forward \u2192", () => step(1));
      const whole = Explore.button("Whole range", () => zoomTo(null));
      const fields = ["From", "To"].map((label, index) => {
        const input = Explore.element("input", { type: "text", inputmode: "decimal", onchange: () => {
          const range = [...seen.x];
          range[index] = Number(input.value.replace(",", "."));
          if (Number.isFinite(range[index]) && range[0] < range[1]) context.change({ over: { ...context.state().over, range }, zoom: null }); else input.value = Explore.number(seen.x[index], 8);
        } });
        return { input, element: Explore.element("label", { class: "short" }, label, input) };
      });
      panel.options.append(over, shown, ...fields.map(({ element }) => element), all, events, back, on, whole);
      const key = Explore.element("div", {});
      panel.body.append(key);
      const seen = { x: [0, 1], found: null, sheet: null };

      /** The number that varies: its name, unit and range. */
      const varied = (state) => {
        const model = context.model();
        const { name, range } = state.over;
        if (name === "rpm") return { name, label: "speed", unit: "rpm", whole: range || model.study || model.speeds, log: false };
        const number = model.numbers.find(({ path }) => path === name);
        return number ? { name, label: Explore.spaced(number.name), symbol: number.symbol, unit: Explore.unit(number.unit), whole: range || number.slider, log: number.scale === "log" && (range || number.slider)[0] > 0 }
          : { name: "rpm", label: "speed", unit: "rpm", whole: model.speeds, log: false };
      };
      const follow = (state) => {
        // Undo and links move through rectangles too: what is new to the list is put behind the present one.
        const key = JSON.stringify(state.zoom);
        if (JSON.stringify(visited.list[visited.at]) === key) return;
        const near = [visited.at - 1, visited.at + 1].find((index) => index >= 0 && index < visited.list.length && JSON.stringify(visited.list[index]) === key);
        if (near !== undefined) { visited.at = near; return; }
        visited.list.splice(visited.at + 1, Infinity, state.zoom);
        visited.at += 1;
      };

      const column = (found, which) => (which === "angle" ? Explore.angles(found, "cam_angle_") : Explore.column(found, { before: "velocity_before_", after: "velocity_after_", position: "position_" }[which]));
      const pointsLayer = (found, axis, which, state) => {
        const [values, ys] = [found.value, column(found, which)];
        const groups = found.attractor && found.attractor.length ? found.families || (found.families = familiesOf(found)) : null;
        const crowded = ys.length > 8000;
        const [angles, velocity] = [Explore.angles(found, "cam_angle_"), Explore.column(found, "velocity_before_")];
        const motion = (index) => ({ rpm: axis.name === "rpm" ? values[index] : state.rpm, over: { name: axis.name, value: values[index] },
          cam_angle_rad: Explore.radians(angles[index]), position: Explore.column(found, "position_")[index], velocity: Explore.column(found, "velocity_after_")[index], label: "impact" });
        const units = context.model().units;
        return {
          kind: "points", x: values, y: ys, size: crowded ? 1.2 : groups ? 4.5 : 3, shape: groups && !crowded ? undefined : "dot", colour: "blue", alpha: crowded ? 0.75 : 0.9,
          colours: groups && groups.map((each) => Explore.colours[(each ?? 0) % 6]), shapes: groups && groups.map((each) => (crowded ? "dot" : Explore.shapes[(each ?? 0) % 6])),
          hover: (index) => ({ title: groups ? `Attractor ${groups[index] + 1}` : "Impact", rows: [[axis.label, Explore.quantity(values[index], axis.unit, 8)], ["impact angle", `${Explore.fixed(angles[index], 3)}\u00b0`],
            ["velocity before", Explore.quantity(velocity[index], units.velocity, 5)]], known: "computed; click to follow this motion" }),
          motion,
        };
      };
      const flags = (list, axis) => {
        const inside = list.filter(({ at }) => at >= seen.x[0] && at <= seen.x[1]);
        return inside.length ? [{ kind: "flags", x: inside.map(({ at }) => at), shapes: inside.map(({ cause }) => causeOf(cause)[1]), colours: inside.map(({ cause }) => causeOf(cause)[2]), line: true, size: 10,
          hover: (index) => told(inside[index], axis.label, axis.unit) }] : [];
      };
      const corners = (which) => (which === "angle" ? (context.model().corners || []).map(({ angle_deg: y }) => ({ kind: "rule", y, colour: "grey", width: 1, dash: [2, 3] })) : []);

      // Flags of another model, speed or range are not shown.
      const asked = (state) => JSON.stringify([context.app.question(), state.over.name === "rpm" ? null : state.rpm, state.over, state.zoom && state.zoom.x]);
      const draw = (state) => {
        const { found, axis, which } = seen;
        if (!found) return;
        const units = context.model().units;
        const unit = { angle: "\u00b0", before: units.velocity, after: units.velocity, position: units.length }[which];
        const ys = column(found, which);
        const range = state.zoom && state.zoom.y ? state.zoom.y : which === "angle" ? [0, 360] : Explore.extent([ys], 0.04);
        const list = context.option("events", true) && seen.sheet && seen.whose === asked(state) ? eventsOf(seen.sheet, axis.name) : [];
        const now = context.value(axis.name);
        const shownEvents = list.filter(({ at }) => at >= seen.x[0] && at <= seen.x[1]);
        const base = JSON.stringify([seen.turn, which, seen.x, range, shownEvents.map(({ at }) => at)]);
        plot.draw({
          base,
          x: { label: axis.symbol ? `${axis.label} ${axis.symbol}` : axis.label, unit: axis.unit, range: seen.x, log: axis.log },
          y: { label: SHOWN[which], unit, range, turn: which === "angle" },
          layers: [...corners(which), pointsLayer(found, axis, which, state), ...flags(list, axis),
            { kind: "rule", x: now, colour: "ink", width: 1.5, label: Explore.quantity(now, axis.unit, 6), move: (value, done) => context.assign(axis.name, Number(value.toPrecision(6)), { moving: !done }) }],
          description: [`${SHOWN[which]} of ${ys.length} impacts over the ${axis.label}, ${Explore.number(seen.x[0], 6)} to ${Explore.number(seen.x[1], 6)} ${axis.unit || ""}`,
            ...shownEvents.slice(0, 12).map((event) => `${causeOf(event.cause)[0]} at ${Explore.number(event.at, 7)}`)].join("; "),
        });
        if (base === seen.base) return;
        seen.base = base;
        const causes = [...new Set(shownEvents.map(({ cause }) => cause))];
        key.replaceChildren(Explore.key([...causes.map((cause) => ({ colour: causeOf(cause)[2], shape: causeOf(cause)[1], label: causeOf(cause)[0] })),
          ...(which === "angle" && (context.model().corners || []).length ? [{ colour: "grey", dash: [2, 3], label: "corner of the cam" }] : [])]));
        heading(shownEvents, axis, found);
      };
      const heading = (list, axis, found) => {
        // What concerns a thousandth of the range only, or is known by runs alone, is on the picture but not in the heading.
        const wide = (seen.x[1] - seen.x[0]) / 100;
        const main = list.filter((event) => event.located && (event.span ?? Infinity) > wide).map((event) => `${causeOf(event.cause)[0]} at ${Explore.number(event.at, 6)}`);
        const named = main.slice(0, 3).join(", ") + (main.length > 3 ? ` and ${main.length - 3} more` : "");
        const unit = axis.unit ? `\u00a0${axis.unit}` : "";
        panel.heading(named ? `${named[0].toUpperCase()}${named.slice(1)}${main.length > 3 ? "" : unit}` : `Impacts over the ${axis.label}, ${Explore.number(seen.x[0], 5)} to ${Explore.number(seen.x[1], 5)}${unit}`);
        const failed = (found.failed || []).length;
        panel.note(failed ? `${failed} of ${found.values.length} values could not be run. ${found.failed[0].sentence}` : "Drag a rectangle to compute this range at full resolution. Drag the line to change the number in every view.");
      };

      // All attractors cost a hundred times as much as one run each: the plain diagram stands there until they are found.
      const attractors = async (state, axis, question, which, x) => {
        panel.status("looking for all attractors\u2026");
        const found = await context.ask({ view: "diagram", ...question, over: { ...question.over, count: 100 }, transient: 300, record: 60, attractors: true, patience: 10000 }, { lane: "diagram-attractors", slow: "last", silent: true });
        panel.status("");
        if (!found || !context.option("all", false)) return;
        Object.assign(seen, { found, axis, which, x, turn: (seen.turn || 0) + 1, allOf: asked(state) });
        draw(context.state());
      };
      return {
        async update(state, { coarse }) {
          follow(state);
          const model = context.model();
          over.fill([["rpm", "speed (rpm)"], ...model.numbers.filter(({ path }) => !path.startsWith("study.")).map(({ path, name, symbol, unit }) => [path, `${Explore.spaced(name)}${symbol ? ` ${symbol}` : ""}${unit ? ` (${Explore.unit(unit)})` : ""}`])], state.over.name);
          const which = context.option("shows", "angle");
          shown.set(which);
          all.set(context.option("all", false));
          events.set(context.option("events", true));
          back.disabled = visited.at === 0;
          on.disabled = visited.at >= visited.list.length - 1;
          whole.disabled = !state.zoom;
          const axis = varied(state);
          const x = (state.zoom && state.zoom.x) || axis.whole;
          fields.forEach(({ input }, index) => { if (document.activeElement !== input) input.value = Explore.number(x[index], 7).replace("\u2212", "-"); });
          const tall = state.zoom && state.zoom.y && which === "angle" ? Math.min(6, Math.max(1, 360 / (state.zoom.y[1] - state.zoom.y[0]))) : 1;
          const question = { ...(axis.name === "rpm" ? {} : { rpm: state.rpm }), over: { name: axis.name, low: x[0], high: x[1], log: axis.log } };
          // About a value for each pixel across, so that a cloud has no empty columns.
          const count = Math.min(600, Math.max(240, 10 * Math.round((plot.place ? plot.place.box.right - plot.place.box.left : panel.body.clientWidth - 80) / 10)));
          const found = await context.ask({ view: "diagram", ...question, over: { ...question.over, count }, transient: 300, record: Math.round(80 * tall) },
            { coarse, rough: { over: { ...question.over, count: 90 }, transient: 120, record: 30 } });
          if (found && context.option("all", false) && seen.allOf === asked(state) && seen.found.attractor.length) {
            Object.assign(seen, { which });
            draw(state);
          } else if (found) {
            seen.turn = (seen.turn || 0) + (seen.found === found ? 0 : 1);
            Object.assign(seen, { found, axis, which, x });
            draw(state);
          }
          if (coarse) return;
          if (context.option("all", false)) attractors(state, axis, question, which, x);
          if (!context.option("events", true)) return;
          const sheet = await context.ask({ view: "speeds", ...question, over: { ...question.over, count: 16 }, starts: 4, budget: "quick" }, { lane: "diagram-events", slow: "last", silent: true });
          if (sheet) { seen.sheet = sheet; seen.whose = asked(state); draw(context.state()); }
        },
        highlight(motion) {
          if (!motion || !seen.axis) { plot.mark([]); return; }
          const x = seen.axis.name === "rpm" ? motion.rpm : motion.over && motion.over.name === seen.axis.name ? motion.over.value : context.value(seen.axis.name);
          const y = seen.which === "angle" ? Explore.turned(motion.cam_angle_rad) : { before: motion.velocity_before, after: motion.velocity, position: motion.position }[seen.which];
          plot.mark(Number.isFinite(x) && Number.isFinite(y) ? [{ x, y }] : []);
        },
      };
    },
  });
})();

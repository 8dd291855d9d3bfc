// The local map near a corner impact: its orbits beside the machine's, the verdict, and how the verdict changes with a number.
//
// `verify` is asked at the numbers as they are. For the strip it is asked at values along one number, the nearest first, and
// then between neighbours whose verdicts differ. The strip is kept while only that number moves.
"use strict";
(() => {
  const { number, quantity, extent } = Explore;
  const VALUES = 17;
  const HALVINGS = 6;

  // Orbits against the change of the period ----------------------------------------------------------------------------------

  const STABLE = { colour: "blue", width: 2.2 };
  const UNSTABLE = { colour: "vermilion", width: 2.2, dash: [7, 4] };
  const stableOf = (each) => each.stable ?? each.is_stable ?? each.stability === "stable";
  const rpmAt = (found, change) => 60 / (found.period_s + change);
  const reachOf = (found) => found.reach_s || 1e-3 * found.period_s;

  /** The rays of the local map, out of the answer of `verify`: enough while a slider moves. `local` adds the machine's own orbits. */
  const raysOf = ({ corner_impact: corner, local_map: maps = [] }) => {
    const sides = maps.filter((each) => each.speeds === "faster" || each.speeds === "slower").map((each) => ({ ...each, sign: each.speeds === "faster" ? -1 : 1 }));
    return {
      period_s: corner.period_s,
      // x* itself, on the section half a revolution from the corner.
      section: (corner.cam_angle_rad + Math.PI) % (2 * Math.PI), at: [corner.state[0] + Explore.column(corner, "state_origin_"), corner.state[1]],
      rays: sides.flatMap((each) => each.periodic_orbits.map((orbit) => ({ word: orbit.word, sign: each.sign, stable: orbit.stable, positions: orbit.points.map(([q]) => q), velocities: orbit.points.map(([, v]) => v) }))),
      left: sides.filter((each) => each.ends.every((end) => end.end === "escapes")).map((each) => each.sign),
    };
  };
  const rayLayers = (found, reach, scale) => found.rays.filter((ray) => ray.positions.length <= 2).flatMap((ray) => ray.positions.map((slope, point) => {
    const parts = [...Array(21).keys()].map((step) => (step / 20) * reach);
    return {
      kind: "line", x: parts.map((at) => at * ray.sign * scale), y: parts.map((at) => at * slope), ...(stableOf(ray) ? STABLE : UNSTABLE),
      hover: (index) => ({ title: `Orbit ${ray.word} of the local map, ${stableOf(ray) ? "stable" : "unstable"}`, rows: [["at", `${number(rpmAt(found, parts[index] * ray.sign), 9)} rpm`], ["position from x*", number(parts[index] * slope, 5)]], known: "computed" }),
      motion: (index) => ({ rpm: rpmAt(found, parts[index] * ray.sign), cam_angle_rad: found.section, position: found.at[0] + parts[index] * slope, velocity: found.at[1] + parts[index] * ray.velocities[point] }),
    };
  }));
  const machineLayers = (found, scale) => (found.machine || []).map((line) => ({
    kind: "line", x: line.points.map(([change]) => change * scale), y: line.points.map(([, q]) => q), colour: "grey", width: 5, alpha: 0.55,
    hover: (index) => ({ title: `The machine's own orbit, ${stableOf(line) ? "stable" : "unstable"}`, rows: [["at", `${number(rpmAt(found, line.points[index][0]), 9)} rpm`], ["position from x*", number(line.points[index][1], 5)]], known: "computed" }),
  }));
  /** Words on the side where no orbit of the map is. */
  const emptySides = (found, reach, scale, y) => [-1, 1].filter((sign) => !found.rays.some((ray) => ray.sign === sign && ray.positions.length <= 2)).map((sign) => ({
    kind: "text", x: sign * 0.5 * reach * scale, y: (y[0] + y[1]) / 2, anchor: "middle", text: (found.left || []).includes(sign) ? "no orbit: motions diverge" : "no orbit of period one or two",
  }));
  const raysScene = (found, unit, small) => {
    const reach = reachOf(found);
    const scale = reach * 1e3 < 1 ? 1e6 : 1e3;
    const rays = rayLayers(found, reach, scale);
    const flattest = found.rays.filter((ray) => ray.positions.length <= 2).flatMap((ray) => ray.positions.map((slope) => Math.abs(slope) * reach)).filter((size) => size > 0).sort((a, b) => a - b)[0];
    const shown = small && flattest ? rays.filter((ray) => Math.max(...ray.y.map(Math.abs)) <= 1.5 * flattest) : rays;
    const y = extent([[0], ...shown.map((ray) => ray.y)], 0.25);
    return {
      x: { label: "change of the period δT; faster to the left", unit: scale === 1e6 ? "µs" : "ms", range: [-reach * scale, reach * scale] },
      y: { label: "position relative to x*", unit: unit.length, range: y },
      layers: [{ kind: "rule", x: 0, colour: "grey", width: 1, dash: [2, 3], label: `${number(rpmAt(found, 0), 9)} rpm` }, ...machineLayers(found, scale), ...rays, ...emptySides(found, reach, scale, y)],
      description: found.rays.filter((ray) => ray.positions.length <= 2).map((ray) => `Orbit ${ray.word}, ${stableOf(ray) ? "stable" : "unstable"}, at ${ray.sign < 0 ? "faster" : "slower"} speeds`).join(". ") || "The local map has no orbit of period one or two",
    };
  };

  // The strip of verdicts ----------------------------------------------------------------------------------------------------

  const valuesOf = ({ slider: [low, high], scale }) => [...Array(VALUES).keys()].map((index) => {
    const part = index / (VALUES - 1);
    return Number((scale === "log" && low > 0 ? low * (high / low) ** part : low + (high - low) * part).toPrecision(6));
  });
  /** Verdicts along a number: `{ key, rows: [{ value, verdict | null }], ask(from, onRow) }`. */
  const stripOf = (context, path, key) => {
    const found = context.model().numbers.find((each) => each.path === path);
    const strip = { key, path, found, rows: valuesOf(found).map((value) => ({ value, verdict: null })), stopped: false };
    const model = context.app.question();
    const verdictAt = async (value) => {
      // Asked of the transport itself: at some values a machine has no corner impact, and that is a result here, no complaint.
      const answer = await context.app.transport.ask({ view: "verify", model: { ...model, set: { ...model.set, [path]: value } } }, "local-strip", { slow: true });
      return Explore.verdict.of(answer);
    };
    const place = (row) => { strip.rows.push(row); strip.rows.sort((a, b) => a.value - b.value); };
    strip.ask = async (from, onRow) => {
      try {
        const began = performance.now();
        const order = strip.rows.filter((row) => !row.verdict).sort((a, b) => Math.abs(a.value - from) - Math.abs(b.value - from));
        for (const row of order) { row.verdict = await verdictAt(row.value); if (strip.stopped) return; onRow(); }
        // Where a verdict takes long, as where motions are searched for danger, the ends of its range are left wider.
        const halvings = (performance.now() - began) / Math.max(1, order.length) > 200 ? HALVINGS - 3 : HALVINGS;
        for (const [low, high] of changes(strip.rows)) {
          let [a, b] = [low, high];
          for (let step = 0; step < halvings; step += 1) {
            const row = { value: Number(((a.value + b.value) / 2).toPrecision(8)), verdict: null };
            row.verdict = await verdictAt(row.value);
            if (strip.stopped) return;
            place(row);
            if (row.verdict.kind === a.verdict.kind) a = row; else b = row;
          }
          onRow();
        }
        strip.done = true;
        onRow();
      } catch (problem) {
        if (problem !== Explore.superseded) throw problem;
        if (!strip.stopped) setTimeout(() => { if (!strip.stopped) strip.ask(from, onRow); }, 300);
      }
    };
    return strip;
  };
  /** Neighbours whose verdicts differ. */
  const changes = (rows) => {
    const asked = rows.filter((row) => row.verdict);
    return asked.slice(1).map((row, index) => [asked[index], row]).filter(([a, b]) => a.verdict.kind !== b.verdict.kind);
  };
  const nameOf = (verdict) => Explore.verdict.names[verdict.kind] || verdict.kind;
  /** The strip in words: each range of the number with its verdict, and the ends between which it changes. */
  const stripWords = (strip) => {
    const asked = strip.rows.filter((row) => row.verdict);
    if (!asked.length) return "";
    const unit = strip.found.unit ? ` ${strip.found.unit}` : "";
    const between = changes(strip.rows);
    if (!between.length) return `${nameOf(asked[0].verdict)} at ${asked[0].verdict.kind === "none" ? "any of" : "all"} ${asked.length} values of ${strip.found.name} from ${number(asked[0].value, 4)} to ${number(asked[asked.length - 1].value, 4)}${unit}.`;
    const parts = between.map(([a, b]) => `from ${nameOf(a.verdict).toLowerCase()} to ${nameOf(b.verdict).toLowerCase()} between ${number(a.value, 5)} and ${number(b.value, 5)}${unit}`);
    return `As ${strip.found.name} grows, the verdict changes ${parts.join(", then ")}${strip.done ? "" : "; still computing"}.`;
  };
  /** Ranges of one verdict that are wide enough for a word: `[from, to, verdict]`. */
  const ranges = (rows, least) => {
    const asked = rows.filter((row) => row.verdict);
    const found = [];
    asked.forEach((row) => {
      const last = found[found.length - 1];
      if (last && last[2].kind === row.verdict.kind) last[1] = row.value; else found.push([row.value, row.value, row.verdict]);
    });
    return asked.length < 2 ? [] : found.filter(([from, to]) => to - from > least * (rows[rows.length - 1].value - rows[0].value));
  };
  const stripScene = (strip, now, move, width) => {
    const asked = strip.rows.filter((row) => row.verdict);
    const log = strip.found.scale === "log" && strip.found.slider[0] > 0;
    const middle = (a, b) => (log ? Math.sqrt(a * b) : (a + b) / 2);
    const ends = strip.rows.map((row, index) => [index ? middle(strip.rows[index - 1].value, row.value) : row.value, index + 1 < strip.rows.length ? middle(row.value, strip.rows[index + 1].value) : row.value]);
    const kinds = Object.keys(Explore.verdict.looks);
    const marked = asked.filter((row, index) => index % Math.ceil(asked.length / 24) === 0);
    return {
      x: { label: strip.found.name, unit: strip.found.unit, range: strip.found.slider, log },
      y: { label: "", range: [0, 1], ticks: [] },
      layers: [
        ...kinds.map((kind) => ({ kind: "rects", colour: Explore.verdict.looks[kind].colour, alpha: 0.3, rects: strip.rows.flatMap((row, index) => (row.verdict && row.verdict.kind === kind ? [[...ends[index], 0, 1]] : [])) })),
        { kind: "points", x: marked.map((row) => row.value), y: marked.map(() => 0.5), size: 8, colours: marked.map((row) => Explore.verdict.looks[row.verdict.kind].colour), shapes: marked.map((row) => Explore.verdict.looks[row.verdict.kind].shape),
          hover: (index) => ({ title: nameOf(marked[index].verdict), rows: [[strip.found.name, quantity(marked[index].value, strip.found.unit)], ...(marked[index].verdict.speed ? [["corner impact at", `${number(marked[index].verdict.speed, 8)} rpm`]] : []), ...(marked[index].verdict.danger ? [["danger", marked[index].verdict.danger]] : [])], known: marked[index].verdict.sentence ? marked[index].verdict.sentence.split("\n")[0].slice(0, 120) : "computed" }) },
        ...ranges(strip.rows, 110 / width).map(([a, b, verdict]) => ({ kind: "text", x: middle(Math.max(a, strip.found.slider[0]), b), y: 0.82, anchor: "middle", text: nameOf(verdict).toLowerCase(), colour: "ink", size: 11 })),
        { kind: "flags", x: marked.filter((row) => row.verdict.danger).map((row) => row.value), colour: "vermilion", shape: "triangle" },
        { kind: "rule", x: now, label: `${number(now, 5)}`, move },
      ],
      description: stripWords(strip),
    };
  };

  // Feigin's signs --------------------------------------------------------------------------------------------------------------

  // The determinants span decades on both sides of 0, so the axes are cube roots.
  const root = Math.cbrt;
  const TICKS = [-100, -10, -1, -0.1, 0, 0.1, 1, 10, 100].map(root);
  const axis = (label, values) => {
    const most = Math.max(0.6, ...values.map((value) => Math.abs(root(value)))) * 1.15;
    return { label, range: [-most, most], ticks: TICKS.filter((at) => Math.abs(at) > 0.2 || at === 0), format: (at) => number(at ** 3, 3) };
  };
  const signsScene = (rows, now, pair, names, words) => {
    const seen = rows.filter((row) => row.verdict && row.verdict.minus !== undefined && pair(row.verdict).every(Number.isFinite));
    const points = seen.map((row) => pair(row.verdict));
    const own = now && pair(now).every(Number.isFinite) ? pair(now) : null;
    const [x, y] = [0, 1].map((side) => axis(names[side], [...points.map((each) => each[side]), ...(own ? [own[side]] : [])]));
    const [w, h] = [x.range[1], y.range[1]];
    const text = (sx, sy, label) => ({ kind: "text", x: sx * w * 0.94, y: sy * h * 0.88, anchor: sx < 0 ? "start" : "end", text: label, colour: "ink", size: 11 });
    return {
      x, y,
      layers: [
        { kind: "rects", colour: words.colours[0], alpha: 0.13, rects: [[0, w, 0, h], [-w, 0, -h, 0]] },
        { kind: "rects", colour: words.colours[1], alpha: 0.16, rects: [[-w, 0, 0, h], [0, w, -h, 0]] },
        { kind: "rule", x: 0, width: 1 }, { kind: "rule", y: 0, width: 1 },
        text(1, 1, words.same), text(-1, -1, words.same), text(-1, 1, words.other), text(1, -1, words.other),
        { kind: "line", x: points.map(([a]) => root(a)), y: points.map(([, b]) => root(b)), colour: "grey", width: 1.5 },
        { kind: "points", x: points.map(([a]) => root(a)), y: points.map(([, b]) => root(b)), shape: "disc", size: 4, colour: "grey",
          hover: (index) => ({ title: nameOf(seen[index].verdict), rows: [["value", number(seen[index].value, 5)], [names[0], number(points[index][0], 5)], [names[1], number(points[index][1], 5)]], known: "computed" }) },
        own && { kind: "points", x: [root(own[0])], y: [root(own[1])], shape: "diamond", size: 12, colour: "ink" },
      ],
      description: own ? `${names[0]} is ${number(own[0], 4)} and ${names[1]} is ${number(own[1], 4)}: ${own[0] * own[1] > 0 ? words.same : words.other}` : "",
    };
  };
  const FOLDS = { names: ["det(I − A⁻)", "det(I − A⁺)"], words: { same: "persistence", other: "fold", colours: ["blue", "vermilion"] }, pair: (verdict) => [verdict.minus, verdict.plus] };
  const FLIPS = { names: ["det(I + A⁻)", "det(I + A⁺)"], words: { same: "no period two", other: "period two is born", colours: ["blue", "purple"] }, pair: (verdict) => verdict.flips || [] };

  // The view -------------------------------------------------------------------------------------------------------------------

  Explore.view({
    name: "local", title: "Local map near a corner impact", wide: true,
    mount(panel, context) {
      const make = Explore.element;
      const [words, numbers, said] = [make("div", { class: "verdict-words" }), make("details", {}, make("summary", {}, "A⁻, A⁺, B and their eigenvalues"), make("div", { class: "wide" })), make("p", { class: "note" })];
      const [pair, signs] = [make("div", { class: "pair" }), make("div", { class: "pair" })];
      const titled = (host, title) => { const box = make("div", {}, make("h4", {}, title)); host.append(box); return box; };
      panel.body.append(words, pair);
      const [all, near] = [context.plot(titled(pair, "Orbits of the local map"), { label: "Orbits near the corner impact", aspect: 0.6, least: 220 }), context.plot(titled(pair, "The flattest orbits, enlarged"), { label: "The flattest orbits, enlarged", aspect: 0.6, least: 220 })];
      const over = Explore.menu("Verdict over", [], "", (path) => context.setOption("over", path));
      const strip = context.plot(panel.body, { label: "Verdict over a number", height: () => 124 });
      strip.element.before(over);
      panel.body.append(said, signs, numbers);
      const [folds, flips] = [context.plot(titled(signs, "These signs decide between persistence and fold"), { label: "Signs that decide on a fold", aspect: 0.7, least: 210 }), context.plot(titled(signs, "These signs decide whether period two is born"), { label: "Signs that decide on period two", aspect: 0.7, least: 210 })];
      let [verdict, row, answered, rays] = [null, null, null, null];

      const choices = () => context.model().numbers.filter((each) => each.path.startsWith("follower.") || Object.keys(context.state().set).includes(each.path));
      const chosen = () => {
        const paths = choices().map((each) => each.path);
        const wanted = context.option("over", null) || Object.keys(context.state().set).filter((path) => paths.includes(path)).pop() || "follower.restitution";
        return paths.includes(wanted) ? wanted : paths[0];
      };
      const drawStrip = () => {
        if (!row) return;
        const now = context.value(row.path);
        strip.draw(stripScene(row, now, (value, done) => context.assign(row.path, Number(value.toPrecision(4)), { moving: !done }), strip.element.clientWidth || 700));
        said.textContent = stripWords(row);
        folds.draw(signsScene(row.rows, verdict, FOLDS.pair, FOLDS.names, FOLDS.words));
        flips.draw(signsScene(row.rows, verdict, FLIPS.pair, FLIPS.names, FLIPS.words));
      };
      const refreshStrip = (coarse) => {
        const path = chosen();
        const { set, ...rest } = context.app.question();
        const { [path]: _, ...others } = set;
        const key = JSON.stringify([rest, others, path]);
        over.fill(choices().map((each) => [each.path, each.name]), path);
        if (row && row.key === key) { drawStrip(); return; }
        if (coarse) return;
        if (row) row.stopped = true;
        row = stripOf(context, path, key);
        drawStrip();
        row.ask(context.value(path), drawStrip).catch((problem) => { said.textContent = problem.message; });
      };
      const parts = [pair, signs, numbers];
      const draw = async (found, coarse) => {
        verdict = Explore.verdict.of({ found });
        panel.heading(Explore.verdict.heading(found));
        words.replaceChildren(...Explore.verdict.words(found).map((each) => make("p", {}, each)));
        numbers.lastChild.replaceChildren(Explore.verdict.table(found, Explore.parts.units(context)));
        parts.forEach((each) => { each.hidden = false; });
        drawRays(raysOf(found));
        if (coarse) return;
        const local = await context.ask({ view: "local" }, { lane: "local-rays", slow: true, silent: true });
        if (local && verdict && answered === JSON.stringify(context.app.question())) drawRays({ ...raysOf(found), reach_s: local.reach_s, machine: local.machine });
      };
      const drawRays = (local) => {
        rays = local;
        const unit = Explore.parts.units(context);
        all.element.parentNode.firstChild.textContent = local.machine && local.machine.length ? "Orbits of the local map; grey: the machine's own" : "Orbits of the local map";
        all.draw(raysScene(local, unit, false));
        // The flattest rays are drawn once more where the steepest leave no room for them.
        const sizes = local.rays.filter((ray) => ray.positions.length <= 2).flatMap((ray) => ray.positions.map(Math.abs)).filter((size) => size > 0);
        near.element.parentNode.hidden = !(Math.min(...sizes) < 0.2 * Math.max(...sizes));
        if (!near.element.parentNode.hidden) near.draw(raysScene(local, unit, true));
      };
      return {
        async update(state, { coarse }) {
          if (!context.model()) return;
          refreshStrip(coarse);
          const key = JSON.stringify(context.app.question());
          if (coarse && answered === key) return;
          const found = await context.ask({ view: "verify" }, { slow: true, coarse });
          if (found) { answered = key; await draw(found, coarse); drawStrip(); return; }
          if (JSON.stringify(context.app.question()) !== key || context.answer("local")) return;
          // Refused: the panel has the program's sentence. The strip may still show where a verdict is to be had.
          [verdict, answered] = [null, key];
          Explore.parts.refused(panel);
          panel.heading("No corner impact to classify here");
          words.replaceChildren();
          parts.forEach((each) => { each.hidden = true; });
          drawStrip();
        },
        /** A motion on the section of the map is a point beside its orbits. */
        highlight(motion) {
          const here = rays && motion && Number.isFinite(motion.position) && Math.abs(motion.cam_angle_rad - rays.section) < 1e-6;
          const scale = rays && reachOf(rays) * 1e3 < 1 ? 1e6 : 1e3;
          [all, near].forEach((plot) => plot.mark(here ? [{ x: (60 / motion.rpm - rays.period_s) * scale, y: motion.position - rays.at[0] }] : []));
        },
        csv: () => (row ? Explore.csv({
          [row.path]: row.rows.map((each) => each.value), verdict: row.rows.map((each) => (each.verdict || {}).kind || ""), danger: row.rows.map((each) => (each.verdict || {}).danger || ""), corner_impact_rpm: row.rows.map((each) => (each.verdict || {}).speed ?? ""),
          det_i_minus_a_minus: row.rows.map((each) => (each.verdict || {}).minus ?? ""), det_i_minus_a_plus: row.rows.map((each) => (each.verdict || {}).plus ?? ""),
        }) : null),
      };
    },
  });
})();

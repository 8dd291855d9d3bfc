// Contact force and loads over the speed, and what a need asks of the machine.
//
// Two questions: the curves, and the need. A need is a line that can be dragged; while it moves the page reads the curves that
// are there, and asks the program when it rests.
"use strict";
(() => {
  const { number, fixed, quantity, extent, element: make } = Explore;

  const LOADS = {
    impact_speed: { name: "impact speed", need: "impact speed" }, gap: { name: "largest gap", need: "gap" }, energy_lost: { name: "energy lost per revolution", need: "energy" },
    largest_force: { name: "largest force", need: null }, off_cam: { name: "share of the time off the cam", need: null },
  };

  /** A number with its error: the error rounded up to two digits, and the number to the same place, as in the program: 2915 ± 13. */
  const withError = (value, error, digits = 6) => {
    if (!Number.isFinite(error) || error <= Math.abs(value) * 1e-10) return number(value, digits);
    const places = Math.max(0, 1 - Math.floor(Math.log10(error)));
    const unit = 10 ** -(1 - Math.floor(Math.log10(error)));
    return places > 12 ? number(value, digits) : `${fixed(Math.round(value / unit) * unit, places)} ± ${fixed(Math.ceil(error / unit - 1e-9) * unit, places)}`;
  };
  Explore.withError = withError;
  /** A column of a list of rows: the value and its error, found by the beginning of the name. */
  const columnsOf = (rows, start) => {
    const names = Object.keys(rows[0] || {}).filter((key) => key.startsWith(`${start}_`) && !key.includes("_parts"));
    const [error, name] = [names.find((key) => key.startsWith(`${start}_error`)), names.find((key) => !key.includes("_error"))];
    return { x: rows.map((row) => row.speed_rpm), y: rows.map((row) => row[name] ?? null), error: rows.map((row) => (error ? row[error] ?? 0 : 0)), unit: name ? name.slice(start.length + 1) : "" };
  };
  // Names of columns end in their unit: mm_s is mm/s.
  const UNITS = { m_s: "m/s", mm_s: "mm/s", in_s: "in/s", ft_s: "ft/s", n: "N", kn: "kN", lbf: "lbf", j: "J", mj: "mJ", m: "m", mm: "mm", um: "um", in: "in", ft: "ft", share: "" };
  const unitOf = (name) => (name in UNITS ? UNITS[name] : name.replace(/_/g, " "));

  /** A curve with the band of its error. */
  const curve = ({ x, y, error }, colour, hover, motion) => [
    error.some((each) => each > 0) && { kind: "band", x, low: y.map((each, index) => (each === null ? null : each - error[index])), high: y.map((each, index) => (each === null ? null : each + error[index])), colour, alpha: 0.25 },
    { kind: "line", x, y, colour, width: 2 },
    { kind: "points", x, y, colour, size: 4, shape: "disc", hover, motion },
  ];
  const separationLayers = ({ separation }) => (separation ? [
    separation.error_rpm > 1e-6 * separation.speed_rpm && { kind: "rects", colour: "vermilion", alpha: 0.2, rects: [[separation.speed_rpm - separation.error_rpm, separation.speed_rpm + separation.error_rpm, -1e12, 1e12]] },
    { kind: "rule", x: separation.speed_rpm, colour: "vermilion", dash: [6, 3], label: `${withError(separation.speed_rpm, separation.error_rpm, 7)} rpm` },
  ] : []);

  // The need ---------------------------------------------------------------------------------------------------------------

  const isNeed = (need) => Boolean(need) && need.rpm > 0 && (need.kind === "separation" || (need.kind in LOADS && Boolean(LOADS[need.kind].need) && need.below > 0));
  /** The need as the program reads it. */
  const needText = (need, unit) => (need.kind === "separation" ? `no separation to ${need.rpm} rpm` : `${LOADS[need.kind].need} below ${need.below} ${unit} to ${need.rpm} rpm`);
  const known = (row) => ({ computed: "computed", sampled: "sampled by runs", proved: "proved" }[row.known] || row.known);
  const limit = (row) => {
    const value = `${withError(row.value, row.error)}`;
    if (row.other !== undefined && row.other !== null) return `between ${value} and ${withError(row.other, row.other_error)}`;
    return `${row.is_upper_bound ? "at most" : "at least"} ${value}`;
  };
  const meets = (row) => row.value !== null && (row.is_upper_bound ? row.now <= row.value - (row.error || 0) : row.now >= row.value + (row.error || 0)) && !(row.other < row.now);
  const misses = (row) => (row.is_upper_bound ? row.now > row.value + (row.error || 0) : row.now < row.value - (row.error || 0)) || row.other < row.now;
  /** The number to set so that the need is met at the far end of ±: rounded to the safe side, in steps no smaller than ±. */
  const safe = (row) => {
    const edge = row.is_upper_bound ? row.value - (row.error || 0) : row.value + (row.error || 0);
    const least = Math.max(row.error || 0, Math.abs(edge) * 1e-3);
    const unit = 10 ** Math.floor(Math.log10(least));
    const step = unit * [1, 2, 5, 10].find((each) => each * unit >= least * 0.999);
    return Number((((row.is_upper_bound ? Math.floor : Math.ceil)(edge / step)) * step).toPrecision(6));
  };
  /** What the need asks of each number, as a list with buttons that try it. */
  const needList = (rows, context) => {
    const path = (row) => (context.model().numbers.find((each) => each.path.endsWith(`.${row.parameter}`)) || {}).path;
    return make("ul", { class: "needs" }, ...rows.map((row) => {
      const [unit, own] = [row.unit ? ` ${row.unit}` : "", path(row)];
      if (row.value === null) return make("li", {}, `No change of ${row.parameter} alone meets the need: ${row.note || "none was found"} (${known(row)}).`);
      const value = safe(row);
      const set = own && !meets(row) && value > 0 ? Explore.button(`Set ${number(value, 4)}${unit}`, () => context.assign(own, value), { "aria-label": `Set the ${row.parameter} to ${number(value, 4)}${unit}` }) : null;
      return make("li", {}, make("strong", {}, row.parameter), ` ${limit(row)}${unit} (now ${number(row.now, 5)}; ${known(row)})${row.note ? `; ${row.note}` : ""} `, set);
    }));
  };
  /** The motion from rest at the speed of a point. */
  const atSpeed = ({ x }) => (index) => ({ rpm: x[index], cam_angle_rad: 0 });
  /** The value of a curve at a speed, between its points; null outside. */
  const at = ({ x, y }, rpm) => {
    const index = x.findIndex((each) => each >= rpm);
    if (index <= 0 || y[index] === null || y[index - 1] === null) return index === 0 && x[0] === rpm ? y[0] : null;
    const part = (rpm - x[index - 1]) / (x[index] - x[index - 1]);
    return y[index - 1] + part * (y[index] - y[index - 1]);
  };

  Explore.view({
    name: "loads", title: "Contact force and loads over the speed", wide: true,
    mount(panel, context) {
      const pair = make("div", { class: "pair" });
      const [words, list] = [make("p", { class: "need-words" }), make("div", { "aria-live": "polite" })];
      panel.body.append(pair, words, list);
      const zoom = { zoom: ({ x }) => context.setOption("range", x.map((each) => Number(each.toPrecision(5)))), back: () => { if (!rangeOf()) return false; context.setOption("range", null); return true; } };
      const hosts = [0, 1].map(() => { const host = make("div"); pair.append(host); return host; });
      const [force, loads] = [context.plot(hosts[0], { label: "Least contact force over the speed", aspect: 0.62, least: 240, ...zoom }), context.plot(hosts[1], { label: "Loads over the speed", aspect: 0.62, least: 240, ...zoom })];
      const shows = Explore.menu("Load", Object.entries(LOADS).map(([key, each]) => [key, each.name]), "impact_speed", (value) => context.setOption("load", value));
      const kinds = Explore.menu("Need", [["none", "none"], ["separation", "no separation"], ...Object.entries(LOADS).filter(([, each]) => each.need).map(([key, each]) => [key, `${each.name} below`])], "none", (kind) => choose(kind));
      const field = (label, key) => {
        const input = make("input", { type: "text", inputmode: "decimal", size: 7, onchange: () => { const value = Number(input.value.replace(",", ".")); if (value > 0) assign({ [key]: value }, true); } });
        return { input, element: make("label", { class: "short" }, label, input) };
      };
      const [to, below] = [field("up to (rpm)", "rpm"), field("below", "below")];
      panel.options.append(shows, kinds, below.element, to.element);
      let [shown, required] = [null, null];

      const rangeOf = () => Explore.parts.optionOf(context, "range", Explore.parts.isRange, null);
      const need = () => Explore.parts.optionOf(context, "need", isNeed, null);
      const assign = (patch, done) => { if (need()) context.setOption("need", { ...need(), ...patch }, { moving: !done }); };
      const separation = () => (shown && shown.separation ? shown.separation.speed_rpm : context.model().separation ? context.model().separation.rpm : context.state().rpm);
      const choose = (kind) => {
        if (kind === "none") { context.setOption("need", null); return; }
        const rpm = need() ? need().rpm : Number((1.25 * separation()).toPrecision(2));
        if (kind === "separation") { context.setOption("need", { kind, rpm }); return; }
        const most = shown ? Math.max(0, ...columnsOf(shown.loads, kind).y.filter(Number.isFinite)) : 1;
        context.setOption("need", { kind, rpm, below: Number((most / 4 || 1).toPrecision(2)) }, {}, {});
      };
      const loadKey = () => (need() && LOADS[need().kind] ? need().kind : Explore.parts.optionOf(context, "load", (key) => key in LOADS, "impact_speed"));
      const loadUnit = () => unitOf(shown && shown.loads.length ? columnsOf(shown.loads, loadKey()).unit : "");
      const needRule = () => need() && { kind: "rule", x: need().rpm, colour: "green", width: 2.5, label: `need: to ${number(need().rpm, 5)} rpm`, move: (value, done) => assign({ rpm: Number(value.toPrecision(3)) }, done) };

      const range = () => (shown.contact_force.length > 1 ? [shown.contact_force[0].speed_rpm, shown.contact_force[shown.contact_force.length - 1].speed_rpm] : context.model().speeds);
      const forceScene = () => {
        const rows = columnsOf(shown.contact_force, "least");
        const unit = unitOf(rows.unit);
        const hover = (index) => ({ title: `${number(rows.x[index], 6)} rpm`, rows: [["least force", `${withError(rows.y[index], rows.error[index])} ${unit}`], ["at cam angle", Number.isFinite(shown.contact_force[index].cam_angle_rad) ? `${number(Explore.turned(shown.contact_force[index].cam_angle_rad), 5)}°` : "–"]], known: rows.y[index] < 0 ? "computed; below 0 the follower separates" : "computed" });
        return {
          x: { label: "speed", unit: "rpm", range: range() }, y: { label: "least contact force", unit, range: extent([rows.y, [0]]) },
          layers: [{ kind: "rule", y: 0, colour: "ink", width: 1 }, ...separationLayers(shown), ...curve(rows, "blue", hover, atSpeed(rows)), { kind: "rule", x: context.state().rpm, colour: "grey", width: 1.5, dash: [2, 3], label: "" }, needRule()],
          description: `${headline()}. The least contact force is ${withError(rows.y[0], rows.error[0])} ${unit} at ${number(rows.x[0], 5)} rpm, and at ${number(rows.x[rows.x.length - 1], 5)} rpm it is ${withError(rows.y[rows.y.length - 1], rows.error[rows.error.length - 1])} ${unit}`,
        };
      };
      const loadScene = () => {
        const key = loadKey();
        if (!shown.loads.length) return { x: { label: "speed", unit: "rpm", range: range() }, y: { label: LOADS[key].name, range: [0, 1] }, layers: [...separationLayers(shown), needRule()], message: "no impacts at these speeds", description: "No impacts at these speeds" };
        const rows = columnsOf(shown.loads, key);
        const unit = unitOf(rows.unit);
        const hover = (index) => ({ title: `${number(rows.x[index], 6)} rpm`, rows: [[LOADS[key].name, `${withError(rows.y[index], rows.error[index])} ${unit}`]], known: "sampled: the largest value in runs from four starts" });
        const bound = need() && need().kind === key && { kind: "rule", y: need().below, colour: "green", width: 2.5, label: `need: below ${number(need().below, 4)} ${unit}`, move: (value, done) => assign({ below: Number(value.toPrecision(2)) }, done) };
        const last = rows.y.length - 1;
        return {
          x: { label: "speed", unit: "rpm", range: range() }, y: { label: LOADS[key].name, unit, range: extent([rows.y, [0], bound ? [need().below] : []]) },
          layers: [...separationLayers(shown), ...curve(rows, "purple", hover, atSpeed(rows)), bound, needRule()],
          description: `${LOADS[key].name}, sampled, rises to ${withError(rows.y[last], rows.error[last])} ${unit} at ${number(rows.x[last], 5)} rpm`,
        };
      };
      const headline = () => {
        const { separation: found, separates } = shown;
        if (found) return `Separates at ${withError(found.speed_rpm, found.error_rpm, 7)} rpm, at ${withError(Explore.turned(found.cam_angle_rad), Explore.degrees(found.cam_angle_error_rad || 0), 5)}° of the cam`;
        return { "at-every-speed": "Separates at every speed, however low", never: "Stays on the cam at every speed" }[separates] || `Separates ${String(separates).replace(/-/g, " ")}`;
      };
      const draw = () => {
        if (!shown) return;
        panel.heading(headline());
        force.draw(forceScene());
        loads.draw(loadScene());
        say();
      };
      const same = () => required && need() && required.text === needText(need(), loadUnit());
      const say = () => {
        if (!need()) { words.textContent = "Choose a need, such as no separation up to a speed, and drag its line. The program finds the spring that meets it."; list.replaceChildren(); return; }
        const text = needText(need(), loadUnit());
        if (!same()) {
          const rows = need().kind === "separation" ? columnsOf(shown.contact_force, "least") : columnsOf(shown.loads, need().kind);
          const value = at(rows, need().rpm);
          words.textContent = `Need: ${text}. ${value === null ? "" : need().kind === "separation" ? `There the least contact force is ${number(value, 3)} ${unitOf(rows.unit)}, as read from the curve. ` : `There it is ${number(value, 3)} ${unitOf(rows.unit)}, as read from the curve. `}The program computes the answer when the line rests.`;
          list.classList.add("waiting");
          return;
        }
        list.classList.remove("waiting");
        const found = required.rows.filter((row) => row.value !== null);
        const met = found.length > 0 && found.some(meets) && !found.some(misses);
        words.textContent = met ? `Need: ${text}. The machine meets it without a change.` : found.length === 0 ? `Need: ${text}. No change of a single number meets it.`
          : `Need: ${text}. The machine ${found.some(misses) ? "does not meet it" : "may miss it: it lies within ± of the limit"}. Each of these changes alone meets it, with the other numbers unchanged:`;
        list.replaceChildren(needList(required.rows, context));
      };
      const show = (state) => {
        shows.set(loadKey());
        shows.hidden = Boolean(need() && LOADS[need().kind]);
        kinds.set(need() ? need().kind : "none");
        [to, below].forEach(({ element }, index) => { element.hidden = !need() || (index === 1 && !LOADS[need().kind]); });
        if (need()) [[to, need().rpm], [below, need().below]].forEach(([{ input }, value]) => { if (document.activeElement !== input) input.value = value ?? ""; });
        if (below.element.firstChild) below.element.firstChild.textContent = `below (${loadUnit()})`;
        return state;
      };
      // A machine that separates at every speed or at none has no range of its own.
      const speeds = () => {
        const range = rangeOf() || (context.model().separation ? null : context.model().speeds);
        return range ? { rpm: range } : {};
      };
      /** The curves: of a measured cam first at a few speeds, as each takes a run of 16 cams. */
      const curves = async (coarse) => {
        const measured = Boolean(context.model().separation && context.model().separation.error_rpm);
        const asked = { view: "design", ...speeds() };
        if (coarse && measured) return null;
        const counts = coarse ? [14] : measured ? [11, 41] : [41];
        for (const count of counts) {
          const found = await context.ask({ ...asked, count }, { slow: true, coarse });
          if (!found) { if (Explore.parts.refused(panel)) shown = null; return null; }
          [shown, required] = [found, shownFor(found)];
          draw();
        }
        return shown;
      };
      // An answer to a need is of one machine: it is kept while the numbers are the same.
      const shownFor = () => (required && required.model === JSON.stringify(context.app.question()) ? required : null);
      return {
        async update(state, { coarse }) {
          if (!context.model()) return;
          show(state);
          if (shown) draw();
          await curves(coarse);
          if (coarse || !shown || !need() || same()) return;
          const [text, model] = [needText(need(), loadUnit()), JSON.stringify(context.app.question())];
          const found = await context.ask({ view: "design", ...speeds(), count: 2, needs: [text] }, { lane: "loads-need", slow: true });
          if (!found || !need()) return;
          required = { text, model, rows: found.needs || [] };
          draw();
        },
        highlight(motion) {
          if (!shown) return;
          const mark = (plot, rows) => { const y = motion && rows.x.length ? at(rows, motion.rpm) : null; plot.mark(y === null ? [] : [{ x: motion.rpm, y }]); };
          mark(force, columnsOf(shown.contact_force, "least"));
          mark(loads, columnsOf(shown.loads, loadKey()));
        },
        command: () => { const answer = context.answer(need() ? "loads-need" : "loads") || context.answer("loads"); return answer ? answer.command : null; },
        csv: () => {
          if (!shown) return null;
          const rows = shown.contact_force;
          const names = Object.keys(rows[0] || {}).filter((key) => typeof rows[0][key] !== "object");
          const loaded = new Map(shown.loads.map((row) => [row.speed_rpm, row]));
          const more = Object.keys(shown.loads[0] || {}).filter((key) => typeof shown.loads[0][key] !== "object" && key !== "speed_rpm" && !names.includes(key));
          return Explore.csv({ ...Object.fromEntries(names.map((name) => [name, rows.map((row) => row[name])])), ...Object.fromEntries(more.map((name) => [name, rows.map((row) => (loaded.get(row.speed_rpm) || {})[name] ?? "")])) });
        },
      };
    },
  });
})();

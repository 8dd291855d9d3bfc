// The whole page: `Explore.mount(element, { transport, model: { file, text }, state })`.
"use strict";
(() => {
  const make = Explore.element;
  const REST = 120;

  /** What the views and the controls share: the state, the model, selection. */
  const appOf = (element, { transport, model, state }) => {
    const initial = { ...Explore.start, file: (model && model.file) || null, text: (model && model.text) ?? null, ...(state || {}) };
    const app = { element, transport, store: Explore.store(initial), model: null, selecting: [], views: null, controls: null };
    const now = () => app.store.state;
    app.question = () => ({ file: now().file, text: now().text, set: now().set });
    /** The name that the model file has, or gets where the reader changes the built-in model's text. */
    app.fileName = () => now().file || `${(app.model ? app.model.name : "model").replace(/ with .*$/, "").replace(/[^\w.-]+/g, "-")}.toml`;
    app.ask = (question, lane) => transport.ask({ model: app.question(), ...question }, lane).then(
      (answer) => { if (answer.error) { app.refused(answer.error); return null; } return answer.found; },
      (problem) => { if (problem !== Explore.superseded) app.refused({ sentence: problem.message, broken: true }); return null; });
    app.number = (path) => (app.model ? app.model.numbers.find((each) => each.path === path) : null);
    /** A number of the model by its path, or the speed. */
    app.value = (path) => {
      if (path === "rpm") return now().rpm;
      const number = app.number(path);
      return now().set[path] ?? (number ? number.value : null);
    };
    app.assign = (path, value, { moving = false } = {}) => {
      if (path === "rpm") { app.store.change({ rpm: value }, { moving, step: "rpm" }); return; }
      const number = app.number(path);
      const set = { ...now().set, [path]: value };
      if (number && number.given === value && !moving) delete set[path];
      app.store.change({ set }, { moving, step: path });
    };
    app.unassign = (path) => {
      if (path === "rpm") { app.store.change({ rpm: app.usual() }); return; }
      const set = { ...now().set };
      delete set[path];
      app.store.change({ set });
    };
    /** Another model: its speed, its range and its start are its own. */
    app.take = (file, text, step = null) => app.store.change({ file, text, set: {}, rpm: step ? now().rpm : null, over: { name: "rpm", range: null }, zoom: null, start: null, story: null }, { step });
    /** The speed that a model is shown at first: the roundest near the middle of its study or of its usual range. */
    app.usual = () => {
      const [low, high] = app.model.study || app.model.speeds || [400, 800];
      const middle = (low + high) / 2;
      const round = [1000, 500, 200, 100, 50, 20, 10, 5, 2, 1].map((unit) => Math.round(middle / unit) * unit).find((each) => each > 0 && Math.abs(each - middle) <= (high - low) / 8);
      return round || Number(middle.toPrecision(3));
    };
    app.select = (motion, from) => { app.selecting.forEach((fn) => fn(motion)); app.views.highlight(motion, from); };
    app.choose = (motion) => {
      if (!motion) return;
      const start = Object.fromEntries(["cam_angle_rad", "position", "velocity", "relative_velocity"].filter((key) => Number.isFinite(motion[key])).map((key) => [key, motion[key]]));
      const patch = { start: Number.isFinite(start.cam_angle_rad) ? start : null };
      if (Number.isFinite(motion.rpm)) patch.rpm = motion.rpm;
      if (motion.over && motion.over.name !== "rpm") patch.set = { ...now().set, [motion.over.name]: motion.over.value };
      app.store.change(patch);
    };
    app.refused = (error) => {
      app.reason = error;
      if (app.controls) app.controls.refuse(error);
      // A new model that cannot be read has no speed to run at: every view says why it is empty.
      if (now().rpm === null) app.views.panels.forEach(({ panel }) => panel.error(app.inPanel(error)));
    };
    /** An error as a panel shows it: what is wrong with the model stands in the headline and at the number, once. */
    app.inPanel = (error) => (app.reason && error.sentence === app.reason.sentence ? { sentence: "The model cannot be run: see the headline." } : error);
    app.reset = () => app.store.reset();
    app.show = (name) => {
      const found = document.getElementById(`view-${name}`);
      if (found) found.scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth", block: "nearest" });
    };
    return app;
  };

  // The bar at the top: the speed, undo, redo -----------------------------------------------------------------------------------

  const barOf = (app) => {
    const speed = Explore.numberRow({ path: "rpm", name: "Speed", symbol: "", unit: "rpm", slider: [100, 1000], scale: "linear", meaning: "speed of the cam", allowed: "above 0" },
      (value, how) => app.assign("rpm", value, how), () => app.unassign("rpm"));
    const undo = Explore.button("Undo", () => app.store.undo(), { title: "Undo (Ctrl+Z)" });
    const redo = Explore.button("Redo", () => app.store.redo(), { title: "Redo (Ctrl+Shift+Z)" });
    const reset = Explore.button("Reset", () => app.reset(), { title: "Back to the model and the speed with which the page began" });
    const link = Explore.button("Copy link", (event) => Explore.copy(app.store.link(), event.currentTarget));
    const start = Explore.button("Start at rest", () => app.store.change({ start: null }), { hidden: true, class: "chosen" });
    const element = make("div", { class: "bar" }, speed.element, make("div", { class: "bar-buttons" }, undo, redo, reset, link, start));
    const update = () => {
      const { state } = app.store;
      const range = app.model && app.model.speeds ? app.model.speeds : [100, 1000];
      speed.update({ path: "rpm", name: "Speed", unit: "rpm", slider: range, scale: "linear", meaning: "speed of the cam", allowed: "above 0", given: app.model ? app.usual() : state.rpm, error: state.rpm !== null && !(state.rpm > 0) ? "The speed must be above 0 rpm." : null }, state.rpm);
      undo.disabled = !app.store.canUndo();
      redo.disabled = !app.store.canRedo();
      start.hidden = !state.start;
      start.title = state.start ? `The motion starts at cam angle ${Explore.fixed(Explore.turned(state.start.cam_angle_rad), 1)}\u00b0. Click to start it at rest on the cam at 0\u00b0 again.` : "";
    };
    return { element, update };
  };

  const keys = (app) => (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const typing = event.target.matches && event.target.matches("input[type=text], textarea");
    const key = event.key.toLowerCase();
    if (typing || (key !== "z" && key !== "y")) return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) app.store.redo(); else app.store.undo();
  };

  const counted = (number, word) => `${number} ${word}${number === 1 ? "" : "s"}`;
  /** What a run settles on, in the program's words: the answer of `long_run`, an ending of `basins`. */
  Explore.motionInWords = ({ words, kind, revolutions, impacts }) => {
    if (words) return words;
    const turns = revolutions === 1 ? "a revolution" : counted(revolutions, "revolution");
    if (kind === "periodic" && revolutions) return impacts === 0 ? "never meets the cam" : `${counted(impacts, "impact")} in ${turns}`;
    if (kind === "resting") return !revolutions ? "rests now and then" : revolutions === 1 ? "rests in each revolution" : `rests, period ${turns}`;
    return kind === "stays" ? "stays on the cam" : String(kind);
  };

  // The headline: what the motion is, in words ----------------------------------------------------------------------------------

  const headlineOf = (app) => {
    const text = make("h2", { class: "headline", "aria-live": "polite" }, "\u2026");
    const known = make("p", { class: "headline-known" });
    const update = async (coarse) => {
      const { rpm, start } = app.store.state;
      if (!(rpm > 0)) { text.textContent = `${Explore.number(rpm)} rpm: no motion`; known.textContent = "The speed must be above 0 rpm."; return; }
      const question = { model: app.question(), view: "long_run", rpm, ...(start ? { start } : {}), ...(coarse ? { budget: "quick" } : {}) };
      try {
        const answer = await app.transport.ask(question, "headline", { coarse });
        if (answer.error) { text.textContent = `${app.model ? app.model.name : "The model"} cannot be run`; known.textContent = answer.error.sentence; return; }
        const found = answer.found;
        text.textContent = `${Explore.number(rpm, 6)} rpm: ${Explore.motionInWords(found)}`;
        text.title = answer.command || "";
        const [rate, error] = [found.lyapunov_per_revolution, found.lyapunov_standard_error];
        const growth = Number.isFinite(rate) ? `Deviations ${rate < 0 ? "shrink" : "grow"} by a factor of ${Explore.number(Math.exp(Math.abs(rate)), 4)} a revolution (exponent ${Explore.number(rate, 4)}${error ? `\u00a0\u00b1\u00a0${Explore.number(error, 2)}` : ""}). ` : "";
        known.textContent = `${growth}How it is known: ${answer.known}${answer.how ? `, ${answer.how}` : ""}.`;
      } catch (problem) {
        if (problem !== Explore.superseded) known.textContent = problem.message;
      }
    };
    const refuse = (error) => { text.textContent = error.broken ? "Nothing can be computed here" : "The model cannot be run"; known.textContent = error.sentence; };
    return { element: make("div", { class: "headline-box" }, text, known), update, refuse };
  };

  /** Mounts the page into an element. */
  Explore.mount = (element, options) => {
    element.classList.add("explore");
    const app = appOf(element, options);
    const [bar, headline] = [barOf(app), headlineOf(app)];
    const side = make("div", { class: "side", role: "group", "aria-label": "Numbers of the model" });
    const [tours, stage] = [make("div", { class: "tours" }), make("div", { class: "stage" })];
    element.replaceChildren(headline.element, bar.element, tours, make("div", { class: "columns" }, side, stage), 
      make("p", { class: "keys" }, "Keys: the arrows step through the points of a picture; + and \u2212 zoom; Escape goes back; Shift with an arrow moves the line; Enter follows the motion of a point. Ctrl+Z undoes, Ctrl+Shift+Z redoes."),
      make("p", { class: "live", "aria-live": "polite" }));
    app.controls = Explore.mountControls(side, app);
    app.views = Explore.mountViews(stage, app);
    if (Explore.mountStories) Explore.mountStories(tours, app);
    document.addEventListener("keydown", keys(app));

    // The model that was asked about last, and the one that `app.model` is the answer to.
    let [timer, frame, asked, known] = [null, null, null, null];
    const refresh = (coarse) => { if (app.model && app.store.state.rpm !== null) { app.views.refresh(coarse); headline.update(coarse); } };
    const model = async () => {
      const key = JSON.stringify(app.question());
      if (key === asked) { if (key === known && app.store.state.rpm === null) app.store.fill({ rpm: app.usual() }); return; }
      asked = key;
      const found = await app.ask({ view: "model" }, "model");
      if (!found) { if (app.reason) headline.refuse(app.reason); return; }
      if (key !== asked) return;
      const before = app.model;
      // What a model that cannot be run has left in views out of sight.
      if (app.reason) app.views.panels.forEach(({ panel }) => panel.error(null));
      [app.model, app.reason] = [found, null];
      known = key;
      app.controls.update();
      app.controls.refuse(null);
      if (app.store.state.rpm === null) app.store.fill({ rpm: app.usual() });
      bar.update();
      // Names and units of another machine: what is drawn is labelled anew.
      if (!before || before.name !== found.name || JSON.stringify(before.units) !== JSON.stringify(found.units)) { refresh(true); setTimeout(() => refresh(false), REST / 2); }
    };
    const changed = (_, { moving }) => {
      // A drag stays in its allowed range: the model is asked about when it rests.
      if (!moving) model();
      bar.update();
      if (app.model) app.controls.update();
      // Coarse at once, at most one a frame; full when the state has rested.
      if (!frame) frame = requestAnimationFrame(() => { frame = null; refresh(true); });
      clearTimeout(timer);
      timer = setTimeout(() => { model(); refresh(false); }, moving ? REST : REST / 2);
    };
    app.store.subscribe(changed);
    bar.update();
    model();
    return app;
  };
})();

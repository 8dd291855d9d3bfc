// The registry of views, and the panel that each is shown in.
//
//   Explore.view({ name, title, wide: bool, mount(panel, context) -> INSTANCE })
//   INSTANCE = { update(state, { coarse }), csv(), svg(), command(), highlight(motion) }   all but update may be missing
// `update` runs when the state has changed and the panel is in sight: at once with `coarse: true`, and again with
// `coarse: false` when the state has rested. It asks with `context.ask` and draws.
// A missing csv(), command() are filled in from the last answer; svg() from the panel's plots, below each other.
//
//   panel: { element, body, options (row of controls), heading(text), note(text), known(known, how), status(text), error(error) }
//   context: {
//     state()                      the state now (never change it in place; see state.js)
//     change(patch, { moving })    changes it; `moving` while something is dragged (one step of undo for the whole drag)
//     option(name, otherwise), setOption(name, value, how, more)   options of this view, kept in the state; `more` changes with it
//     model()                      `found` of the view `model` (numbers, units, corners...), null before the first answer
//     value(number), assign(number, value, { moving })  a number of the model by its path, or "rpm"
//     ask(question, { lane, coarse, rough, slow, silent })   -> Promise of `found`, or null when superseded or refused (the panel
//                                  says so). Fills in the model; the same question is not asked twice. `rough` are the fields that
//                                  a coarse question has instead. `slow` for answers of over 0.2 s, "last" for
//                                  those of many seconds, which must not hold up the slow ones.
//     answer(lane)                 the last whole answer of a lane: { found, command, known, how }
//     plot(host, options)          an Explore.plot whose select and choose are linked
//     select(motion)               shows a motion in every view; null for none.   onSelect(fn) is told of it
//     choose(motion)               makes it the state's start and speed (undoable)
//     start()                      { start } of the state, or {}: to be spread into a question
//   }
//   MOTION = { rpm, cam_angle_rad, position | relative_velocity | velocity | velocity_before, over: { name, value }, label, from: view's name }
"use strict";
(() => {
  Explore.views = [];
  Explore.view = (view) => Explore.views.push(view);
  /** What a question rejects with when a newer one of its lane has taken its place. */
  Explore.superseded = new Error("superseded by a newer question");

  // Small parts of a page ------------------------------------------------------------------------------------------------

  /** An element with attributes (`onclick` and the like are listeners) and children. */
  Explore.element = (name, attributes = {}, ...children) => {
    const element = document.createElement(name);
    Object.entries(attributes).forEach(([key, value]) => {
      if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
      else if (value === true) element.setAttribute(key, "");
      else if (value !== false && value !== null && value !== undefined) element.setAttribute(key, value);
    });
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
  };
  const make = Explore.element;
  Explore.button = (label, onclick, attributes = {}) => make("button", { type: "button", onclick, ...attributes }, label);
  /** A labelled menu; choices are `[[value, label]...]`. It has `set(value)`. */
  Explore.menu = (label, choices, value, changed) => {
    const select = make("select", { onchange: () => changed(select.value) });
    const element = make("label", { class: "menu" }, make("span", {}, label), select);
    let filled = null;
    element.fill = (list, now) => { const key = JSON.stringify(list); if (key !== filled) { filled = key; select.replaceChildren(...list.map(([key, text]) => make("option", { value: key }, text))); } select.value = now; };
    element.set = (now) => { select.value = now; };
    element.fill(choices, value);
    return element;
  };
  Explore.check = (label, value, changed) => {
    const input = make("input", { type: "checkbox", onchange: () => changed(input.checked) });
    input.checked = value;
    const element = make("label", { class: "check" }, input, label);
    element.set = (now) => { input.checked = now; };
    return element;
  };
  /** The key of a picture: `[{ colour, shape | dash | line, label }...]`. */
  Explore.key = (list) => make("ul", { class: "key" }, ...list.map(({ colour, shape, dash, label }) => {
    const canvas = make("canvas", { width: "44", height: "28", "data-colour": colour, "aria-hidden": "true" });
    const row = make("li", {}, canvas, label);
    requestAnimationFrame(() => {
      const to = canvas.getContext("2d");
      to.scale(2, 2);
      const [pen, shade] = [Explore.canvasPen(to), Explore.theme(canvas)[colour]];
      if (shape) pen.marks([11], [7], shape, 9, shade); else pen.path([1, 21], [7, 7], { stroke: shade, width: 2.2, dash });
    });
    return row;
  }));
  const KNOWN = { proved: "proved", computed: "computed", sampled: "sampled", read: "read from the model" };
  const LONG = {
    proved: "Proved by interval arithmetic.", computed: "Computed in double precision, with a checked error.",
    sampled: "Sampled: events between the samples may be missed.", read: "The number is given in the model.",
  };

  // A panel ------------------------------------------------------------------------------------------------------------

  const panelOf = (view) => {
    const id = `view-${view.name}`;
    const heading = make("h3", { id: `${id}-heading` }, view.title);
    const [note, body, options] = [make("p", { class: "note" }), make("div", { class: "body" }), make("div", { class: "options" })];
    const known = make("span", { class: "known" });
    const status = make("span", { class: "status" });
    const error = make("p", { class: "sentence", role: "alert", hidden: true });
    const buttons = make("div", { class: "save" });
    const element = make("section", { class: `panel${view.wide ? " wide-panel" : ""}`, id, "aria-labelledby": `${id}-heading`, tabindex: "-1" },
      make("div", { class: "panel-head" }, heading, make("p", { class: "panel-state" }, status, " ", known)), options, error, body, note, buttons);
    return {
      element, body, options, buttons, view,
      heading: (text) => { if (heading.textContent !== text) heading.textContent = text; },
      note: (text) => { note.textContent = text; },
      known: (how, sentence) => {
        known.textContent = how ? KNOWN[how] || how : "";
        known.className = `known ${how || ""}`;
        known.title = sentence || LONG[how] || "";
      },
      status: (text) => { status.textContent = text; element.toggleAttribute("aria-busy", Boolean(text)); },
      error: (found) => {
        error.hidden = !found;
        error.textContent = found ? found.sentence || String(found) : "";
        body.classList.toggle("stale", Boolean(found));
        if (found) body.querySelectorAll(".tip").forEach((tip) => { tip.hidden = true; });
      },
    };
  };

  // The context that a view works in ---------------------------------------------------------------------------------------

  const contextOf = (app, panel, view) => {
    const lanes = new Map();
    const own = () => app.store.state.views[view.name] || {};
    const context = {
      app, lanes, plots: [],
      state: () => app.store.state,
      change: (patch, how) => app.store.change(patch, how),
      option: (name, otherwise) => (name in own() ? own()[name] : otherwise),
      setOption: (name, value, how, more = {}) => app.store.change({ ...more, views: { ...app.store.state.views, [view.name]: { ...own(), [name]: value } } }, how),
      model: () => app.model,
      value: (number) => app.value(number),
      assign: (number, value, how) => app.assign(number, value, how),
      select: (motion) => app.select(motion ? { ...motion, from: view.name } : null, view.name),
      onSelect: (fn) => app.selecting.push(fn),
      choose: (motion) => app.choose(motion),
      start: () => (app.store.state.start ? { start: app.store.state.start } : {}),
      answer: (lane = view.name) => (lanes.get(lane) || {}).answer || null,
      plot: (host, options) => {
        const plot = Explore.plot(host, { select: context.select, choose: context.choose, ...options });
        context.plots.push(plot);
        return plot;
      },
      ask: (question, { lane = view.name, coarse = false, rough = null, slow = false, silent = false } = {}) => {
        if (!lanes.has(lane)) lanes.set(lane, { key: null, answer: null, promise: null });
        const last = lanes.get(lane);
        const full = { model: app.question(), ...question };
        const again = () => last.promise.then((found) => { if (found) panel.error(null); return found; });
        // The full answer, where it is at hand, is better than a coarse one.
        if (last.promise && last.key === JSON.stringify(full)) return again();
        const whole = coarse && rough ? { ...full, ...rough } : full;
        const key = JSON.stringify(whole);
        if (last.key === key && last.promise) return again();
        last.key = key;
        if (!silent) panel.status(coarse ? "" : "computing\u2026");
        const done = () => { if (last.key === key && !silent) panel.status(""); };
        last.promise = app.transport.ask(whole, lane, { slow, coarse }).then((answer) => {
          done();
          if (answer.error) { last.answer = null; panel.error(app.inPanel(answer.error)); return null; }
          last.answer = { ...answer, coarse };
          panel.error(null);
          if (!silent) panel.known(answer.known, answer.how);
          return answer.found;
        }, (problem) => {
          done();
          if (last.key === key) last.promise = null;
          if (problem !== Explore.superseded) panel.error({ sentence: problem.message || String(problem) });
          return null;
        });
        return last.promise;
      },
    };
    return context;
  };

  /** The columns of an answer as CSV: flat arrays of the longest length, in the order of the answer. */
  Explore.csv = (found) => {
    const columns = Object.entries(found || {}).filter(([, list]) => Array.isArray(list) && (list.length === 0 || typeof list[0] !== "object" || list[0] === null));
    const length = Math.max(0, ...columns.map(([, list]) => list.length));
    const whole = columns.filter(([, list]) => list.length === length);
    if (!length) return null;
    const cell = (value) => (value === null || value === undefined ? "" : /[",\n]/.test(String(value)) ? `"${String(value).replace(/"/g, '""')}"` : String(value));
    const lines = [whole.map(([name]) => name).join(",")];
    for (let row = 0; row < length; row += 1) lines.push(whole.map(([, list]) => cell(list[row])).join(","));
    return `${lines.join("\n")}\n`;
  };

  /** Mounts every registered view into `host`, and returns `{ refresh(coarse), highlight(motion), panels }`. */
  Explore.mountViews = (host, app) => {
    const panels = Explore.views.map((view) => {
      const panel = panelOf(view);
      host.append(panel.element);
      const context = contextOf(app, panel, view);
      let instance = {};
      try { instance = view.mount(panel, context) || {}; } catch (problem) { panel.error({ sentence: `This view cannot be shown: ${problem.message}` }); }
      const entry = { view, panel, context, instance, seen: false, due: null };
      Explore.saveButtons(entry, app);
      return entry;
    });
    const run = (entry, coarse) => {
      if (!entry.instance.update) return;
      entry.due = null;
      Promise.resolve().then(() => entry.instance.update(app.store.state, { coarse })).catch((problem) => entry.panel.error({ sentence: `This view cannot be drawn: ${problem.message}` }));
    };
    // Only what is in sight is computed; the rest is computed when it comes into sight.
    const watcher = new IntersectionObserver((seen) => seen.forEach(({ target, isIntersecting }) => {
      const entry = panels.find(({ panel }) => panel.element === target);
      entry.seen = isIntersecting;
      if (!isIntersecting || !entry.due) return;
      run(entry, true);
      setTimeout(() => run(entry, false), 60);
    }), { rootMargin: "0px" });
    panels.forEach(({ panel }) => watcher.observe(panel.element));
    return {
      panels,
      refresh: (coarse) => panels.forEach((entry) => { entry.due = entry.due || !coarse; if (entry.seen) run(entry, coarse); else entry.due = true; }),
      highlight: (motion, from) => panels.forEach(({ view, instance }) => { if (view.name !== from && instance.highlight) instance.highlight(motion); }),
    };
  };
})();

// The controls: every number of the model as a slider and a field, the cam law and the follower, the model file.
"use strict";
(() => {
  const make = Explore.element;
  const POSITIONS = 500;

  // A slider's position and the number that it means ------------------------------------------------------------------------

  const logarithmic = ({ scale, slider }) => scale === "log" && slider[0] > 0;
  const place = (number, value) => {
    const [low, high] = number.slider;
    const at = logarithmic(number) ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return Math.round(Math.min(1, Math.max(0, at || 0)) * POSITIONS);
  };
  // Rounded to what a slider can show, so that no number has digits that nobody chose.
  const valueAt = (number, position) => {
    const [low, high] = number.slider;
    const part = position / POSITIONS;
    if (part === 0) return low;
    if (part === 1) return high;
    const value = logarithmic(number) ? low * (high / low) ** part : low + (high - low) * part;
    const span = logarithmic(number) ? value * Math.log(high / low) : high - low;
    const places = Math.max(0, Math.min(15, Math.ceil(-Math.log10(span / POSITIONS))));
    return Number(value.toFixed(places));
  };
  Explore.sliders = { place, valueAt };

  // One number --------------------------------------------------------------------------------------------------------------

  /** The row of a number: `update(number, value)` after every change; `assign(value, { moving })` is called by it. */
  Explore.numberRow = (first, assign, reset) => {
    let number = first;
    let held = false;
    const id = `number-${first.path.replace(/\W/g, "-")}`;
    const slider = make("input", { type: "range", min: 0, max: POSITIONS, step: 1, id: `${id}-slider`, "aria-label": `${Explore.spaced(first.name)}, slider` });
    const field = make("input", { type: "text", inputmode: "decimal", id, autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-allowed` });
    const unit = make("span", { class: "unit" }, Explore.unit(first.unit));
    const back = Explore.button("\u21ba", () => { say(null); reset(number); }, { class: "back", "aria-label": `Reset ${Explore.spaced(first.name)}` });
    const allowed = make("p", { class: "allowed", id: `${id}-allowed` });
    const sentence = make("p", { class: "sentence", role: "alert", hidden: true });
    const label = make("label", { for: id }, Explore.spaced(first.name), first.symbol ? make("i", {}, ` ${first.symbol}`) : null);
    const element = make("div", { class: "number-row", "data-path": first.path }, make("div", { class: "number-head" }, label, field, unit, back), slider, allowed, sentence);
    const say = (text) => { sentence.hidden = !text; sentence.textContent = text || ""; field.toggleAttribute("aria-invalid", Boolean(text)); };
    const ends = () => { if (held) { held = false; assign(valueAt(number, Number(slider.value)), { moving: false }); } };
    slider.addEventListener("input", () => { held = true; assign(valueAt(number, Number(slider.value)), { moving: true }); });
    slider.addEventListener("change", ends);
    field.addEventListener("change", () => {
      const value = Number(field.value.trim().replace("\u2212", "-").replace(",", "."));
      if (field.value.trim() === "" || !Number.isFinite(value)) { say(`${Explore.spaced(number.name)} must be a number.`); return; }
      assign(value, { moving: false });
    });
    const update = (now, value) => {
      number = now;
      if (!held) slider.value = place(now, value);
      slider.setAttribute("aria-valuetext", Explore.quantity(value, now.unit));
      if (document.activeElement !== field || !field.hasAttribute("aria-invalid")) field.value = value === null || value === undefined ? "" : String(Number(Number(value).toPrecision(9)));
      field.title = Number(value) === Number(field.value) ? "" : String(value);
      unit.textContent = Explore.unit(now.unit);
      back.classList.toggle("idle", now.given === undefined || now.given === null || value === now.given);
      back.title = `Back to ${Explore.quantity(now.given, now.unit)}`;
      label.title = now.meaning || "";
      allowed.textContent = [now.meaning, now.allowed].filter(Boolean).join(" \u2013 ");
      say(now.error);
    };
    return { element, update, say, path: first.path };
  };

  // The panel of controls -------------------------------------------------------------------------------------------------------

  const GROUPS = { follower: "Follower", cam: "Cam", study: "Study", uncertainty: "Uncertainty" };
  const CONTACTS = { point: "point", flat: "flat face", roller: "roller" };

  const groupsOf = (app, host) => {
    let shape = null;
    let rows = [];
    const build = (model) => {
      const groups = new Map(model.numbers.some(({ path }) => path.startsWith("follower.")) ? [["follower", []]] : []);
      model.numbers.forEach((number) => { const name = number.path.split(".")[0]; groups.set(name, [...(groups.get(name) || []), number]); });
      rows = [];
      const roomy = app.element.clientWidth >= 700;
      host.replaceChildren(...[...groups].map(([name, numbers], index) => {
        const own = numbers.map((number) => Explore.numberRow(number, (value, how) => app.assign(number.path, value, how), (now) => app.unassign(now.path)));
        rows.push(...own);
        return make("details", { class: "group", open: roomy ? name !== "study" : index === 0 && false }, make("summary", {}, GROUPS[name] || name), make("div", { class: "rows" }, ...own.map(({ element }) => element)));
      }));
    };
    return (model) => {
      const now = model.numbers.map(({ path }) => path).join();
      if (now !== shape) { shape = now; build(model); }
      rows.forEach((row) => {
        const number = model.numbers.find(({ path }) => path === row.path);
        row.update(number, app.store.state.set[row.path] ?? number.value);
      });
      return rows;
    };
  };

  /** The model file with another follower; a new roller is as large as half the cam's base circle. */
  const withContact = ({ text, numbers }, contact) => {
    const lines = text.split("\n");
    const bounds = (name) => {
      const from = lines.indexOf(`[${name}]`);
      const end = lines.findIndex((line, index) => index > from && /^\[/.test(line));
      return from < 0 ? null : [from, end < 0 ? lines.length : end];
    };
    const table = bounds("cam.contact");
    if (table) lines.splice(table[0], table[1] - table[0]);
    const [from, end] = bounds("cam");
    for (let index = end - 1; index > from; index -= 1) if (/^contact\s*=/.test(lines[index])) lines.splice(index, 1);
    const base = numbers.find(({ path }) => path === "cam.base_radius");
    const first = /rows = \[\s*\[[^,]+,\s*([\d.]+)/.exec(text);
    const radius = 0.5 * (base ? base.value : first ? Number(first[1]) : 1);
    const written = { point: null, flat: 'contact = "flat"', roller: `contact = { roller_radius = ${Number(radius.toPrecision(3))} }` }[contact];
    if (written) lines.splice(from + 1, 0, written);
    return lines.join("\n");
  };

  const lawMenus = (app) => {
    const take = async (law) => {
      const found = await app.ask({ view: "template", law }, "template");
      if (found) app.take(`${law}.toml`, found.text);
    };
    const laws = Explore.menu("Cam law", [], "", take);
    const contacts = Explore.menu("Follower", Object.entries(CONTACTS), "", (contact) => app.take(app.fileName(), withContact(app.model, contact), "text"));
    const note = make("p", { class: "allowed" }, "A new law starts from an example machine. Undo restores yours.");
    return {
      element: make("div", { class: "laws" }, laws, contacts, note),
      update: (model) => {
        laws.fill(model.laws.map((name) => [name, name]), model.law);
        contacts.hidden = !model.contact;
        if (model.contact) contacts.set(model.contact);
      },
    };
  };

  const fileArea = (app) => {
    const area = make("textarea", { rows: 16, spellcheck: "false", autocapitalize: "off", autocomplete: "off", "aria-label": "Model file" });
    const sentence = make("p", { class: "sentence", role: "alert", hidden: true });
    let timer = null;
    area.addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(() => app.take(app.fileName(), area.value, "text"), 400);
    });
    const load = make("input", { type: "file", accept: ".toml,text/plain", hidden: true, onchange: async () => {
      const file = load.files[0];
      if (!file) return;
      app.take(file.name, await file.text());
      load.value = "";
    } });
    const details = make("details", { class: "group" }, make("summary", {}, "Model file"), area, sentence,
      make("div", { class: "save" }, Explore.button("Save model file", () => Explore.saveModel(app)), Explore.button("Open a file\u2026", () => load.click()), load,
        Explore.button("Paper\u2019s model", () => app.take(null, null), { title: "The model of the paper, built into the program" })));
    return {
      element: details,
      update: (model) => { if (document.activeElement !== area) area.value = model.text; sentence.hidden = true; },
      refuse: (error) => {
        sentence.hidden = !error;
        if (!error) return;
        sentence.textContent = error.sentence;
        details.open = true;
      },
    };
  };

  /** Mounts the controls; returns `{ update(), refuse(error) }`. */
  Explore.mountControls = (host, app) => {
    const title = make("p", { class: "model-name" });
    const source = make("p", { class: "allowed" });
    const notes = make("ul", { class: "notes" });
    const numbers = make("div", { class: "numbers" });
    const [laws, file] = [lawMenus(app), fileArea(app)];
    const groups = groupsOf(app, numbers);
    host.append(make("h3", {}, "Numbers"), title, source, laws.element, numbers, file.element, notes);
    let rows = [];
    return {
      update: () => {
        const { model } = app;
        if (!model) return;
        title.textContent = model.name;
        source.textContent = model.source || "";
        notes.replaceChildren(...(model.notes || []).map((note) => make("li", {}, note)));
        rows = groups(model);
        laws.update(model);
        file.update(model);
      },
      /** Shows the program's sentence at the number that it is about, or else at the model file. */
      refuse: (error) => {
        const row = error && error.field && rows.find(({ path }) => path === error.field || path.endsWith(`.${error.field}`));
        if (row) { row.say(error.sentence); const group = row.element.closest("details"); if (group) group.open = true; } else file.refuse(error);
      },
    };
  };
})();

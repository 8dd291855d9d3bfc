// The state of the page, its history and its address.
//
//   { file, text (null: the paper's model, built in), set: { path: number }, rpm (null: the model's usual speed),
//     over: { name: "rpm" | path, range: null | [low, high] }, zoom: null | { x, y }, start: null | { cam_angle_rad, ... },
//     slow (times slower than real; null: a revolution takes about four seconds), views: { name: { option: value } }, story: null | { name, step } }
//
// `Explore.store(initial)` holds one such object and never changes it in place. A drag is one step: changes that are
// `moving` wait for the one that is not. Each step is an entry of the browser's history, so Back and Forward undo and redo
// too, and the address holds what differs from the start.
"use strict";
(() => {
  const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
  Explore.start = { file: null, text: null, set: {}, rpm: null, over: { name: "rpm", range: null }, zoom: null, start: null, slow: null, views: {}, story: null };

  // The address: `#rpm=678&set.follower.restitution=0.7` ----------------------------------------------------------------------

  const NESTED = ["set", "views"];
  const soft = (text) => encodeURIComponent(text).replace(/%(2C|3A|5B|5D|20|2F)/g, (code) => ({ "%2C": ",", "%3A": ":", "%5B": "[", "%5D": "]", "%20": "+", "%2F": "/" }[code]));
  const written = (value) => soft(typeof value === "string" && !/^[-\d[{"]|^(null|true|false)$/.test(value) ? value : JSON.stringify(value));
  const readBack = (text) => { const plain = decodeURIComponent(text.replace(/\+/g, "%20")); try { return JSON.parse(plain); } catch { return plain; } };
  /** What of a state differs from another, as the part of an address after `#`. */
  Explore.written = (state, from) => Object.keys(state).flatMap((key) => {
    if (same(state[key], from[key])) return [];
    if (!NESTED.includes(key) || Object.keys(from[key]).some((name) => !(name in state[key]))) return [`${key}=${written(state[key])}`];
    return Object.keys(state[key]).filter((name) => !same(state[key][name], from[key][name])).map((name) => `${key}.${name}=${written(state[key][name])}`);
  }).join("&");
  /** The state that an address holds; null for an address of another kind, such as a heading's. */
  Explore.readAddress = (hash, from) => {
    const text = hash.replace(/^#/, "");
    if (text === "") return { ...from };
    if (!text.includes("=")) return null;
    const state = { ...from };
    try {
      text.split("&").forEach((part) => {
        const at = part.indexOf("=");
        const [name, value] = [decodeURIComponent(part.slice(0, at)), readBack(part.slice(at + 1))];
        const [key, rest] = [name.split(".")[0], name.split(".").slice(1).join(".")];
        if (!(key in Explore.start)) return;
        if (NESTED.includes(key)) {
          if (rest) state[key] = { ...state[key], [rest]: value };
          else if (value && typeof value === "object") state[key] = value;
        } else state[key] = value;
      });
    } catch { return null; }
    return sound(state, from);
  };
  // An address can be written by anyone: a part of the wrong kind is left out.
  const isRange = (value) => Array.isArray(value) && value.length === 2 && value.every((each) => Number.isFinite(each));
  const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
  const sound = (state, from) => {
    const kept = { ...state };
    const need = (key, good) => { if (!good) kept[key] = from[key]; };
    need("file", kept.file === null || typeof kept.file === "string");
    need("text", kept.text === null || typeof kept.text === "string");
    need("rpm", kept.rpm === null || Number.isFinite(kept.rpm));
    need("slow", kept.slow === null || (Number.isFinite(kept.slow) && kept.slow >= 1));
    need("over", isObject(kept.over) && typeof kept.over.name === "string" && (kept.over.range === null || isRange(kept.over.range)));
    need("zoom", kept.zoom === null || (isObject(kept.zoom) && isRange(kept.zoom.x) && (kept.zoom.y === null || isRange(kept.zoom.y))));
    need("start", kept.start === null || (isObject(kept.start) && Object.values(kept.start).every((each) => Number.isFinite(each))));
    need("story", kept.story === null || isObject(kept.story));
    need("views", Object.values(kept.views).every(isObject));
    kept.set = Object.fromEntries(Object.entries(kept.set).filter(([, value]) => Number.isFinite(value)));
    return kept;
  };

  // The store ----------------------------------------------------------------------------------------------------------

  Explore.store = (initial) => {
    const load = `${Date.now()}.${Math.random()}`;
    const address = () => { const text = Explore.written(store.state, initial); return text ? `#${text}` : `${location.pathname}${location.search}`; };
    // A page inside another (a notebook) may have no address of its own: the history is then the store's alone.
    const tell = (verb) => {
      try {
        const now = location.hash && !location.hash.includes("=") && address() === `${location.pathname}${location.search}` ? location.hash : address();
        history[verb]({ explore: store.index, load }, "", now);
        return true;
      } catch { return false; }
    };
    const store = {
      initial, state: initial, steps: [initial], index: 0, listeners: [], before: null, last: { name: null, at: 0 }, alone: false, late: null,
      subscribe: (fn) => store.listeners.push(fn),
      tell: (how) => store.listeners.forEach((fn) => fn(store.state, how)),
      /** Changes the state. `moving` while something is dragged; `step` names a change so that quick repeats are one step. */
      change: (patch, { moving = false, step = null } = {}) => {
        const next = { ...store.state, ...patch };
        if (same(next, store.state) && !(store.before && !moving)) return;
        if (moving && !store.before) store.before = store.state;
        store.state = next;
        if (!moving) store.settle(step);
        store.tell({ moving });
      },
      settle: (step) => {
        clearTimeout(store.late);
        const now = Date.now();
        const again = step !== null && store.last.name === step && now - store.last.at < 1000 && store.index > 0;
        store.last = { name: step, at: now };
        store.before = null;
        if (same(store.state, store.steps[store.index])) return;
        if (again) { store.steps[store.index] = store.state; store.alone = !tell("replaceState") || store.alone; return; }
        store.steps.splice(store.index + 1, Infinity, store.state);
        store.index += 1;
        store.alone = !tell("pushState") || store.alone;
      },
      /** What the program fills in by itself, such as the usual speed of a new model: no step of the history. */
      fill: (patch) => {
        // What is filled in at the start belongs to the start: the address of an untouched page stays empty.
        if (Object.keys(patch).every((key) => initial[key] === null) && same({ ...store.state, rpm: null }, initial)) Object.assign(initial, patch);
        store.state = { ...store.state, ...patch };
        if (!store.before) { store.steps[store.index] = store.state; tell("replaceState"); }
        store.tell({ moving: false });
      },
      canUndo: () => store.index > 0,
      canRedo: () => store.index < store.steps.length - 1,
      go: (by) => {
        const to = store.index + by;
        if (to < 0 || to >= store.steps.length) return;
        const ours = !store.alone && history.state && history.state.load === load && history.state.explore === store.index;
        if (!ours) { store.apply(to); tell("replaceState"); return; }
        history.go(by);
        // A history that does not answer, as in some frames: the step is taken without it.
        clearTimeout(store.late);
        store.late = setTimeout(() => store.apply(to), 600);
      },
      undo: () => store.go(-1),
      redo: () => store.go(1),
      apply: (index) => {
        clearTimeout(store.late);
        [store.index, store.state, store.before, store.last] = [index, store.steps[index], null, { name: null, at: 0 }];
        store.tell({ moving: false });
      },
      reset: () => store.change({ ...initial }),
      link: () => `${location.href.split("#")[0]}${(Explore.written(store.state, initial) || "").replace(/^(?=.)/, "#")}`,
    };
    window.addEventListener("popstate", (event) => {
      const kept = event.state && event.state.load === load ? event.state.explore : null;
      if (kept !== null && store.steps[kept]) { store.apply(kept); return; }
      const state = Explore.readAddress(location.hash, initial);
      if (!state || same(state, store.state)) return;
      // An address typed by hand, or one of an earlier visit: a step like any other.
      store.state = state;
      store.steps.splice(store.index + 1, Infinity, state);
      store.index += 1;
      tell("replaceState");
      store.tell({ moving: false });
    });
    const first = Explore.readAddress(location.hash, initial);
    if (first) { store.state = first; store.steps = [first]; }
    tell("replaceState");
    return store;
  };
})();

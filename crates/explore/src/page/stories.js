// Guided tours: each is a sequence of states of the page with two sentences to each, and the bar that leads through it.
//
// A step names all of its state; what it does not name is as the page begins with the paper's model. A sentence says only what
// the page then shows, and how it is known. The models of measured and dangerous machines come with the page in `Explore.models`.
"use strict";
(() => {
  const make = Explore.element;
  Explore.stories = [];
  Explore.story = (story) => Explore.stories.push(story);
  Explore.models = Explore.models || {};

  // Half a revolution from the corner P of the paper's cam: the section of its Poincaré map.
  const SECTION = { cam_angle_rad: 5.762717154756 };
  const SECTION_DEG = 330.179371;
  const WIDE = { x: [0.4, 6], y: [-60, 60] };
  const basins = (range) => ({ basins: { section_deg: SECTION_DEG, range } });

  Explore.story({
    name: "corner", title: "Through the paper\u2019s corner impact",
    steps: [
      { title: "One impact a revolution", view: "plane", state: { rpm: 700 },
        text: "At 700 rpm the follower strikes the cam once in each revolution, at 155.30°, after the corner at 150.18°. The multipliers of this motion have the modulus 0.8, so deviations shrink by a factor of 1.25 per revolution (computed)." },
      { title: "Towards the corner", view: "impacts", state: { rpm: 674, start: { cam_angle_rad: 0, position: 5.083725353456, velocity: -41.830150033 }, views: { impacts: { orbits: true, range: { x: [135, 160], y: [100, 180] } } } },
        text: "At 674 rpm this motion strikes at 150.46°, just after the corner. A second periodic motion (triangle) is unstable and strikes at 138.44°, before the corner. Interval arithmetic proves that both exist." },
      { title: "At the corner", view: "local", state: { rpm: 673.24, start: { cam_angle_rad: 0, position: 5.23398, velocity: -43.61246 } },
        text: "At 673.234445 rpm the two motions meet at the corner and vanish together: a nonsmooth fold. The map before the corner has one real eigenvalue above 1, 1.0051; the map after it has none. An odd total means a fold (computed by four routes that agree, and proved by \u201ccertify\u201d)." },
      { title: "Beyond it", view: "plane", state: { rpm: 668, start: { ...SECTION, position: 5.3970079, velocity: 0 }, views: { plane: { approach: true, revolutions: 32 } } },
        text: "At 668 rpm there is no periodic motion with one impact per revolution (proved). A run that starts where the two motions met drifts away: within 20 revolutions its impacts lose half of their speed. In the long run it is chaotic (sampled over tens of thousands of revolutions)." },
      { title: "The whole picture", view: "diagram", state: { rpm: 678, over: { name: "rpm", range: [660, 750] }, views: { diagram: { all: true } } },
        text: "The branch with one impact per revolution ends at 673.234445 rpm without a warning: its multipliers have the modulus 0.8 all the way to this speed (computed). Below it runs settle on chaos, except in narrow windows. Chaos also coexists with the branch, up to about 682 rpm (sampled)." },
    ],
  });

  Explore.story({
    name: "chatter", title: "Chattering at 183 rpm",
    steps: [
      { title: "Permanent contact", view: "loads", state: { rpm: 100 },
        text: "At 100 rpm the follower stays on the cam: the contact force is above zero at every angle. The least contact force falls to zero at 114.98 rpm, at the corner at 150.18°, where the cam\u2019s acceleration drops (computed)." },
      { title: "A short hop", view: "machine", state: { rpm: 120 },
        text: "At 120 rpm the follower leaves the cam twice in each revolution and is off it for 3.7 % of the time. Each return is a complete chatter, with infinitely many impacts. The program computes 117 impacts per revolution and sums the rest." },
      { title: "The long chatter", view: "machine", state: { rpm: 183 },
        text: "At 183 rpm the follower flies from the corner at 150.18° to 182.37°, bounces 75 times, and rests on the cam from 269.5° on (computed). Each impact returns 0.8 of the speed relative to the cam, so the hops shrink nearly as a geometric series." },
      { title: "A softer contact", view: "machine", state: { rpm: 183, set: { "follower.restitution": 0.5 } },
        text: "With a restitution of 0.5 the chatter ends after 26 computed impacts, and the follower rests from 260.4° on. The first impact is as fast as before, 3.85 m/s, because it depends on the flight and not on the restitution (computed)." },
      { title: "Each revolution repeats", view: "impacts", state: { rpm: 183 },
        text: "After a rest on the cam the motion does not depend on the impacts before it, so each revolution repeats the previous one. The Lyapunov exponent is therefore \u2212\u221e: this follows from the rest itself and needs no fit." },
    ],
  });

  Explore.story({
    name: "coexistence", title: "Two motions at 678 rpm",
    steps: [
      { title: "From rest: chaos", view: "impacts", state: { rpm: 678 },
        text: "A run at 678 rpm that starts at rest on the cam settles on no periodic motion within 21,601 revolutions. Deviations grow by a factor of 1.41 per revolution: the Lyapunov exponent is 0.345 ± 0.015 (sampled)." },
      { title: "From another start: a periodic motion", view: "impacts", state: { rpm: 678, start: { cam_angle_rad: 0, position: 4.4, velocity: -34 } },
        text: "From 4.4 m and \u221234 m/s the same machine settles on a periodic motion with one impact per revolution, at 151.70°. The command \u201corbit --rpm 678 --impacts 1\u201d proves that this motion is stable." },
      { title: "The two basins", view: "basins", state: { rpm: 678, views: basins(WIDE) },
        text: "Each point is a start at the cam angle 330.18°, coloured by the motion on which it settles. In this rectangle 61 % of the starts settle on the periodic motion and 39 % on chaos (sampled on the grid)." },
      { title: "The border", view: "basins", state: { rpm: 678, views: basins(null) },
        text: "The cross on the border is a third periodic motion, which strikes at 122.47°. It is unstable, with the multiplier 1.1046 (computed). Its stable manifold, the line through the cross, is the border between the two basins." },
      { title: "Chaos is lost", view: "basins", state: { rpm: 684, views: basins(WIDE) },
        text: "At 684 rpm all starts of the rectangle settle on the periodic motion (sampled). At about 682.2 rpm the chaotic attractor meets the border of its basin. Above this speed chaos is only a transient." },
    ],
  });

  Explore.story({
    name: "valve", title: "A measured cam: from separation to a spring", model: "valve.toml",
    steps: [
      { title: "Where it separates", view: "loads", state: { rpm: 2500, views: { loads: { range: [2000, 4000] } } },
        text: "The lifts of this cam are given every two degrees, rounded to 0.001 mm as by a gauge. The acceleration of the cam is therefore uncertain by 1.4 % of its largest value. The follower separates at 2915 ± 13 rpm, where ± is the uncertainty from the rounding (computed)." },
      { title: "What separation costs", view: "loads", state: { rpm: 3500, views: { loads: { range: [2000, 4000], load: "impact_speed" } } },
        text: "At 3500 rpm the follower is off the cam for 24.7 % of the time and lands at up to 3668 ± 21 mm/s. These loads are sampled: each is the largest value in runs from four starts." },
      { title: "A need", view: "loads", state: { rpm: 3600, views: { loads: { range: [2000, 4000], need: { kind: "separation", rpm: 3600 } } } },
        text: "Suppose that the follower must stay on the cam up to 3600 rpm (green line). One change is enough: a preload of at least 472.7 ± 7.6 N instead of 220 N, or a stiffness of at least 60.03 ± 0.57 N/mm instead of 30 N/mm (computed)." },
      { title: "A spring that meets the need", view: "loads", state: { rpm: 3600, set: { "follower.stiffness": 40, "follower.preload": 400 }, views: { loads: { range: [2000, 4000], need: { kind: "separation", rpm: 3600 } } } },
        text: "With a spring of 40 N/mm and a preload of 400 N the follower separates at 3629 ± 17 rpm. This whole range lies above the required 3600 rpm (computed)." },
    ],
  });

  const near = { section_deg: 270, range: { x: [1.22, 1.42], y: [-0.3, 0.3] } };
  const periodic = (position, velocity) => ({ cam_angle_rad: 0, position, velocity });
  Explore.story({
    name: "dangerous", title: "A dangerous border collision", model: "dangerous.toml",
    steps: [
      { title: "A stable motion", view: "plane", state: { rpm: 58, start: periodic(1.07992, -2.55283) },
        text: "At 58 rpm this follower strikes its cam once in each revolution, at 89.44°, just before the corner at 90°. The multipliers of this motion have the modulus 0.95, so small deviations die out (computed)." },
      { title: "The verdict", view: "local", state: { rpm: 60, start: periodic(1.07992, -2.55283) },
        text: "At 60 rpm the impact passes the corner. Feigin\u2019s counts give persistence, and the motion is stable on both sides. Yet exactly at the corner impact motions from at least 99.7 % of the directions diverge, along the sequence LLR, by a factor of 1.396 per period. The border collision is dangerous (computed)." },
      { title: "A wide basin at 59 rpm", view: "basins", state: { rpm: 59, views: { basins: near } },
        text: "At 59 rpm every start of this window settles on the periodic motion (sampled). The window is 0.2 m wide and 0.6 m/s high." },
      { title: "A small basin at 59.5 rpm", view: "basins", state: { rpm: 59.5, views: { basins: near } },
        text: "At 59.5 rpm only 3 % of the starts in the same window settle on it. The others settle on a motion with three impacts in three revolutions (sampled). The first motion is as stable as before: its multipliers have the modulus 0.95 (computed)." },
      { title: "Almost no basin at 59.9 rpm", view: "basins", state: { rpm: 59.9, views: { basins: near } },
        text: "At 59.9 rpm 0.1 % of the starts in the window settle on the first motion: near 60 rpm the width of the basin shrinks in proportion to the distance from 60 rpm. A small disturbance then throws the follower off this motion, although its multipliers say that it is stable (sampled)." },
    ],
  });

  // The bar --------------------------------------------------------------------------------------------------------------------

  const listed = () => Explore.stories.filter((story) => !story.model || Explore.models[story.model]);
  /** The whole state of a step. */
  const stateOf = (story, step) => ({
    ...Explore.start, ...(story.model ? { file: story.model, text: Explore.models[story.model] } : {}), ...story.steps[step].state, story: { name: story.name, step },
  });
  // What a text speaks of: the machine, its motion, and what a step sets in its view. All else is the reader's own.
  const SPOKEN = ["file", "text", "set", "rpm", "start"];
  const equal = (one, other) => JSON.stringify(one ?? null) === JSON.stringify(other ?? null);
  const isAs = (state, wanted) => SPOKEN.every((key) => equal(state[key], wanted[key]))
    && Object.entries(wanted.views).every(([view, options]) => Object.entries(options).every(([name, value]) => equal((state.views[view] || {})[name], value)));

  /** Mounts the list of stories into `host`, and the bar of the one that is told at the end of the page, where it stays in sight. */
  Explore.mountStories = (host, app) => {
    const [title, place, text, changed] = [make("h3", {}), make("p", { class: "place" }), make("p", { class: "text", "aria-live": "polite" }), make("p", { class: "place", hidden: true })];
    const to = (story, step) => app.store.change(stateOf(story, step));
    const now = () => { const told = app.store.state.story; return told ? listed().find(({ name }) => name === told.name) || null : null; };
    const by = (way) => () => { const story = now(); if (story) to(story, app.store.state.story.step + way); };
    const [back, next] = [Explore.button("Back", by(-1)), Explore.button("Next", by(1), { class: "primary" })];
    const again = Explore.button("Back to this step", () => to(now(), app.store.state.story.step), { hidden: true });
    const end = Explore.button("End the tour", () => app.store.change({ story: null }));
    const bar = make("section", { class: "story", hidden: true, "aria-label": "Guided tour" }, make("div", { class: "story-head" }, title, place), text, changed, make("div", { class: "buttons" }, back, next, again, end));
    app.element.append(bar);
    const list = make("ul", {});
    host.replaceChildren(make("nav", { class: "stories", "aria-label": "Guided tours" }, make("p", {}, "Guided tours, a few steps each:"), list));
    list.replaceChildren(...listed().map((story) => make("li", {}, Explore.button(story.title, () => to(story, 0), { "data-story": story.name }))));

    let shown = null;
    const told = (name) => app.element.querySelectorAll(".panel").forEach((panel) => panel.classList.toggle("told", panel.id === `view-${name}`));
    const update = (state) => {
      const story = now();
      const step = story && Number.isInteger(state.story.step) ? story.steps[state.story.step] : null;
      bar.hidden = !step;
      app.element.classList.toggle("touring", Boolean(step));
      list.querySelectorAll("button").forEach((button) => button.setAttribute("aria-pressed", String(Boolean(step && button.dataset.story === story.name))));
      if (!step) { if (shown) told(null); shown = null; return; }
      const key = `${story.name} ${state.story.step}`;
      const same = isAs(state, stateOf(story, state.story.step));
      changed.hidden = same;
      again.hidden = same;
      changed.textContent = same ? "" : "You have changed the numbers. The text describes the original step.";
      if (key === shown) return;
      shown = key;
      title.textContent = `${story.title}: ${step.title.charAt(0).toLowerCase()}${step.title.slice(1)}`;
      place.textContent = `Step ${state.story.step + 1} of ${story.steps.length}`;
      text.textContent = step.text;
      back.disabled = state.story.step === 0;
      next.disabled = state.story.step === story.steps.length - 1;
      told(step.view);
      // The panel's top goes below the bar of the speed; the text stands at the foot of the window.
      const panel = app.element.querySelector(`#view-${step.view}`);
      if (panel) panel.scrollIntoView({ block: "start", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
    };
    app.store.subscribe(update);
    update(app.store.state);
  };
})();

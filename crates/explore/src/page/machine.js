// The machine in motion: the cam turns, the follower flies, impacts flash; gap and contact force run along below.
"use strict";
(() => {
  const make = Explore.element;
  const SLOW = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  /** How many times slower than real the machine is shown. */
  const slowness = ({ slow, rpm }) => slow ?? SLOW.reduce((best, each) => (Math.abs(Math.log((each * 15) / rpm)) < Math.abs(Math.log((best * 15) / rpm)) ? each : best));
  const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

  /** Linear interpolation in a sorted column. */
  const at = (times, values, time) => {
    if (!times.length) return null;
    let [low, high] = [0, times.length - 1];
    while (high - low > 1) { const middle = (low + high) >> 1; if (times[middle] <= time) low = middle; else high = middle; }
    const [t0, t1, a, b] = [times[low], times[high], values[low], values[high]];
    if (a === null || b === null) return a ?? b;
    return t1 > t0 ? a + ((b - a) * Math.min(1, Math.max(0, (time - t0) / (t1 - t0)))) : a;
  };

  // The picture of the machine ------------------------------------------------------------------------------------------------

  const turned = (points, angle, up = 0) => {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    return [points.map(([x, y]) => c * x - s * y), points.map(([x, y]) => s * x + c * y + up)];
  };
  /** How far the picture reaches: the cam's largest radius all round, and the follower above it. */
  const reach = (outline, lift, positions) => {
    const radius = Math.max(...outline.whole.map(([x, y]) => Math.hypot(x, y)));
    const follower = outline.follower || [];
    const rise = Math.max(...positions.filter((each) => each !== null), ...lift) - lift[0];
    const top = Math.max(tipOf(outline), ...follower.map(([, y]) => y)) + rise + radius * 0.35;
    const side = Math.max(radius * 1.08, ...follower.map(([x]) => Math.abs(x) * 1.05));
    return { radius, x: [-side, side], y: [-radius * 1.08, Math.max(top, radius * 1.3)] };
  };
  /** The height at which the follower touches a cam that stands at 0 degrees. */
  const tipOf = ({ follower, whole }) => {
    const radius = Math.max(...whole.map(([x, y]) => Math.hypot(x, y)));
    if (follower && follower.length) return Math.min(...follower.filter(([x]) => Math.abs(x) < 0.2 * radius).map(([, y]) => y), radius * 2);
    return whole.reduce((best, [x, y]) => (y > 0 && Math.abs(x) < Math.abs(best[0]) ? [x, y] : best), [Infinity, radius])[1];
  };

  const picture = (canvas, box, seen, frame, theme) => {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const to = canvas.getContext("2d");
    to.setTransform(ratio, 0, 0, ratio, 0, 0);
    to.clearRect(0, 0, width, height);
    paint(Explore.canvasPen(to), width, height, box, seen, frame, theme);
  };
  const paint = (pen, width, height, box, { outline, lift }, frame, theme) => {
    const scene = { x: { range: box.x, bare: true }, y: { range: box.y }, equal: true, layers: [] };
    // Two lines of text stand below the cam.
    const { across, up } = Explore.layout(scene, width, height - 34);
    const draw = ([xs, ys], style) => pen.path(xs.map(across), ys.map(up), style);
    const angle = frame.angle;
    draw(turned(outline.whole, angle), { stroke: theme.ink, width: 1.6, fill: theme.wash, close: true });
    (outline.corners || []).forEach(([, point]) => { const [xs, ys] = turned([point], angle); pen.marks(xs.map(across), ys.map(up), "diamond", 8, theme.vermilion); });
    // A mark from the axis outwards, so that the turning of a round cam is seen.
    draw(turned([[0, 0], [0, box.radius * 0.45]], angle), { stroke: theme.soft, width: 1.2 });
    pen.marks([across(0)], [up(0)], "ring", 9, theme.ink);
    const raise = (frame.position ?? lift[0]) - lift[0];
    const follower = outline.follower || [];
    if (frame.flash > 0 && frame.touch) {
      const size = 14 + 34 * frame.flash;
      pen.marks([across(frame.touch[0])], [up(frame.touch[1])], "disc", size, theme.gold, 0.25 + 0.5 * frame.flash);
    }
    if (frame.ghost !== null && Number.isFinite(frame.ghost)) {
      const height = frame.tip + frame.ghost - lift[0];
      draw([[-box.radius * 0.3, box.radius * 0.3], [height, height]], { stroke: theme.purple, width: 2, dash: [5, 3] });
    }
    if (follower.length) draw(turned(follower, 0, raise), { stroke: theme.blue, width: 2, fill: theme.paper, close: follower.length > 2 });
    const foot = follower.length ? Math.max(...follower.map(([, y]) => y)) : frame.tip + box.radius * 0.16;
    // A point is drawn as the end of a cone.
    if (!follower.length) draw([[0, box.radius * 0.07, -box.radius * 0.07], [frame.tip + raise, foot + raise, foot + raise]], { stroke: theme.blue, width: 1.5, fill: theme.blue, close: true });
    draw([[0, 0], [foot + raise, box.y[1] * 2]], { stroke: theme.blue, width: Math.max(3, (across(box.radius) - across(0)) * 0.09) });
    pen.text(4, height - 24, `cam angle ${Explore.fixed(((Explore.degrees(angle) % 360) + 360) % 360, 1)}\u00b0`, { colour: theme.soft });
    pen.text(4, height - 9, frame.state, { colour: theme.soft });
  };

  // The two strips --------------------------------------------------------------------------------------------------------------

  const strip = (found, units, name, ghost) => {
    const angle = Explore.angles(found, "cam_angle_");
    const begin = Explore.column(found, "time_")[0] || 0;
    const time = Explore.column(found, "time_").map((each) => (each - begin) * 1e3);
    const end = time[time.length - 1] || 1;
    const x = { label: "time", unit: "ms", range: [0, end] };
    const events = found.events || {};
    const when = Explore.column(events, "time_").map((each) => (each - begin) * 1e3);
    const kinds = events.event || [];
    const impacts = [...kinds.keys()].filter((index) => kinds[index] === "impact");
    const before = Explore.column(events, "velocity_before_");
    const camVelocity = Explore.column(events, "cam_velocity_");
    const angles = Explore.angles(events, "cam_angle_");
    const value = name === "gap" ? Explore.column(found, "gap_") : Explore.column(found, "contact_force_");
    const range = Explore.extent([value, ...(ghost ? [ghost[name]] : [])], 0.08);
    if (name === "gap") range[0] = Math.min(range[0], 0);
    const silent = name === "force" && !value.some((each) => each > 0);
    if (name === "force") [range[0], range[1]] = silent ? [0, 1] : [Math.min(0, range[0]), range[1]];
    const row = (index) => [["time", `${Explore.fixed(time[index], 2)} ms`], ["cam angle", `${Explore.fixed(((angle[index] % 360) + 360) % 360, 1)}\u00b0`],
      [name === "gap" ? "gap" : "contact force", Explore.quantity(value[index], name === "gap" ? units.length : units.force, 4)]];
    return {
      message: silent ? "impacts only" : null,
      x, y: { room: 5, ticks: silent ? [0] : undefined, label: name === "gap" ? "gap" : "contact force", unit: name === "gap" ? units.length : units.force, range },
      layers: [
        name === "gap" ? { kind: "band", x: time, low: time.map(() => 0), high: value, colour: "blue", alpha: 0.18 } : null,
        { kind: "line", x: time, y: value, colour: name === "gap" ? "blue" : "green", width: 1.8, hover: (index) => ({ rows: row(index), known: "computed" }) },
        ghost ? { kind: "line", x: ghost.part.map((each) => each * end), y: ghost[name], colour: "purple", width: 1.6, dash: [5, 3] } : null,
        { kind: "points", x: impacts.map((index) => when[index]), y: impacts.map(() => 0), colour: "vermilion", shape: "triangle", size: 9,
          hover: (index) => {
            const each = impacts[index];
            return { title: "Impact", rows: [["cam angle", `${Explore.fixed(((angles[each] % 360) + 360) % 360, 2)}\u00b0`], ["velocity before", Explore.quantity(before[each], units.velocity, 4)],
              ["relative to the cam", Explore.quantity(before[each] - camVelocity[each], units.velocity, 4)]], known: "computed" };
          },
          motion: (index) => ({ rpm: found.rpm, cam_angle_rad: Explore.radians(angles[impacts[index]]), velocity_before: before[impacts[index]], label: "impact" }) },
      ],
      description: name === "gap" ? `Gap between follower and cam over ${Explore.number(end, 3)} ms, up to ${Explore.quantity(range[1], units.length, 3)}, with ${impacts.length} impacts`
        : `Contact force over ${Explore.number(end, 3)} ms, up to ${Explore.quantity(range[1], units.force, 3)}`,
    };
  };

  Explore.view({
    name: "machine", title: "The machine in motion", place: "machine",
    mount(panel, context) {
      const canvas = make("canvas", { class: "machine", role: "img", tabindex: "0", "aria-label": "The cam and its follower" });
      const strips = make("div", { class: "strips" });
      panel.body.append(canvas, strips);
      const clock = { time: 0, playing: !still(), last: null };
      const scrub = (ms) => { clock.playing = false; clock.time = Math.max(0, ms / 1e3); show(); label(); };
      const [gap, force] = ["Gap between follower and cam", "Contact force"].map((name) => context.plot(strips, { label: name, height: (width) => (width < 420 ? 132 : 140), scrub }));
      let [cam, motion, box, theme, drawn, ghost] = [null, null, null, null, null, null];

      const play = Explore.button("Pause", () => { clock.playing = !clock.playing; clock.last = null; label(); run(); });
      const stepBy = (part) => { clock.playing = false; if (motion) clock.time = (clock.time + motion.end * (1 + part)) % motion.end; label(); show(); };
      const label = () => { play.textContent = clock.playing ? "Pause" : "Play"; };
      const slow = Explore.menu("Slowed", SLOW.map((each) => [String(each), `${each}\u00d7`]), "50", (value) => context.change({ slow: Number(value) }));
      panel.options.append(play, Explore.button("\u2190", () => stepBy(-1 / 360), { "aria-label": "One step back" }), Explore.button("\u2192", () => stepBy(1 / 360), { "aria-label": "One step on" }), slow);
      canvas.addEventListener("keydown", (event) => {
        if (event.key === " ") { play.click(); event.preventDefault(); }
        if (event.key === "ArrowLeft" || event.key === "ArrowRight") { stepBy(event.key === "ArrowRight" ? 1 / 180 : -1 / 180); event.preventDefault(); }
      });
      label();

      const frameAt = (time) => {
        const angle = motion.angle0 + motion.rate * time;
        const gapNow = at(motion.time, motion.gap, time);
        const flashes = motion.impacts.filter(({ when }) => time >= when && time - when < motion.glow);
        const bright = ({ when, strength }) => (1 - (time - when) / motion.glow) * (0.35 + 0.65 * strength);
        const last = flashes[flashes.length - 1];
        const flash = last ? bright(last) : 0;
        const contact = gapNow !== null && gapNow <= motion.largest * 1e-9;
        const shadow = ghost ? at(ghost.part, ghost.position, time / motion.end) : null;
        return { ghost: shadow, angle, position: at(motion.time, motion.position, time), flash, touch: [0, motion.tip + (last ? last.height - cam.lift[0] : 0)], tip: motion.tip,
          state: contact ? `on the cam, force ${Explore.quantity(at(motion.time, motion.force, time), motion.units.force, 3)}` : `in flight, gap ${Explore.quantity(gapNow, motion.units.length, 3)}` };
      };
      const show = () => {
        if (!cam || !motion || !canvas.clientWidth) return;
        if (!theme) theme = Explore.theme(canvas);
        picture(canvas, box, cam, frameAt(clock.time), theme);
        gap.cursor(clock.time * 1e3);
        force.cursor(clock.time * 1e3);
      };
      let going = false;
      const tick = (now) => {
        going = false;
        if (!clock.playing || !motion || !canvas.isConnected) return;
        if (clock.last !== null) clock.time = (clock.time + Math.min(0.1, (now - clock.last) / 1e3) / slowness(context.state())) % motion.end;
        clock.last = now;
        show();
        run();
      };
      let visible = true;
      const run = () => { if (!going && clock.playing && visible) { going = true; requestAnimationFrame(tick); } };
      new IntersectionObserver(([{ isIntersecting }]) => { visible = isIntersecting; clock.last = null; run(); }).observe(canvas);
      matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { theme = null; show(); });
      new ResizeObserver(show).observe(canvas);

      const take = (found, rpm) => {
        const begin = Explore.column(found, "time_")[0] || 0;
        const time = Explore.column(found, "time_").map((each) => each - begin);
        const [events, units] = [found.events || {}, context.model().units];
        const end = time[time.length - 1] || 1;
        const gaps = Explore.column(found, "gap_");
        const [when, kinds, before, along] = [Explore.column(events, "time_").map((each) => each - begin), events.event || [], Explore.column(events, "velocity_before_"), Explore.column(events, "cam_velocity_")];
        const hard = kinds.map((_, index) => Math.abs(before[index] - along[index]));
        const hardest = Math.max(1e-300, ...hard.filter((each) => Number.isFinite(each)));
        const part = motion ? clock.time / motion.end : 0;
        motion = { time, end, units, gap: gaps, position: Explore.column(found, "position_"), force: Explore.column(found, "contact_force_"),
          angle0: Explore.radians(Explore.angles(found, "cam_angle_")[0] || 0), rate: (rpm * Math.PI) / 30, largest: Math.max(1e-300, ...gaps.filter((each) => each !== null)), glow: end / 25,
          tip: tipOf(cam.outline), impacts: [...kinds.keys()].filter((index) => kinds[index] === "impact").map((index) => ({ when: when[index], height: Explore.column(events, "position_")[index], strength: hard[index] / hardest })) };
        clock.time = part * end;
        return motion;
      };
      const drawStrips = () => { gap.draw(strip(drawn, motion.units, "gap", ghost)); force.draw(strip(drawn, motion.units, "force", ghost)); };
      // A motion pointed at in another view: its two revolutions over the same cam angles, whatever its speed.
      const follow = async (to) => {
        const question = to && drawn ? Explore.questionOf(to, context) : null;
        if (!question) { if (ghost) { ghost = null; drawStrips(); show(); } return; }
        const found = await context.ask({ view: "motion", ...question, transient: 0, revolutions: 2, samples: 180 }, { lane: "machine-pointed", silent: true, coarse: true });
        if (!found || pointed !== to) return;
        const turn = Explore.column(found, "turned_");
        const whole = motion.angle0 + motion.rate * motion.end;
        ghost = { part: turn.map((each) => ((each - (turn[0] || 0)) + question.start.cam_angle_rad - motion.angle0) / (whole - motion.angle0)), gap: Explore.column(found, "gap_"), force: Explore.column(found, "contact_force_"), position: Explore.column(found, "position_") };
        drawStrips();
        show();
      };
      // A spline has a corner of high order at each of its points: only those that the model names are marked.
      const marked = (corners) => (corners || []).filter(([angle]) => (context.model().corners || []).some(({ angle_deg: degrees }) => Math.abs(Explore.turned(angle) - degrees) < 0.05));
      let pointed = null;
      // The outline depends on the cam's numbers alone: it is not asked for again while one of the follower is dragged.
      const camModel = () => { const model = context.app.question(); return { ...model, set: Object.fromEntries(Object.entries(model.set).filter(([path]) => !path.startsWith("follower."))) }; };
      return {
        highlight(to) { pointed = to; follow(to); },
        async update(state, { coarse }) {
          slow.set(String(slowness(state)));
          const [shape, found] = await Promise.all([
            context.ask({ view: "cam", model: camModel() }, { lane: "machine-cam", coarse, silent: true }),
            context.ask({ view: "motion", rpm: state.rpm, transient: 300, revolutions: 2, samples: 360, ...context.start() }, { coarse, rough: { transient: 100, samples: 180 } }),
          ]);
          if (!shape || !found) return;
          cam = { outline: { ...shape.outline, corners: marked(shape.outline.corners), whole: shape.outline.pieces.flatMap(({ points }) => points) }, lift: Explore.column(shape, "lift_") };
          box = reach(cam.outline, cam.lift, Explore.column(found, "position_"));
          const taken = take(found, state.rpm);
          const { impacts } = taken;
          panel.heading(impacts.length ? `${["", "One", "Two", "Three", "Four", "Five", "Six"][impacts.length] || impacts.length} impact${impacts.length > 1 ? "s" : ""} in two revolutions` : taken.largest > 1e-290 && taken.gap.some((each) => each > 0) ? "The follower flies without an impact in two revolutions" : "The follower stays on the cam");
          canvas.setAttribute("aria-label", `The cam and its follower at ${Explore.number(state.rpm)} rpm: ${panel.view.title}`);
          drawn = found;
          ghost = null;
          drawStrips();
          show();
          run();
        },
        svg: () => {
          if (!cam || !motion) return null;
          const light = Explore.theme(canvas, true);
          const pen = Explore.svgPen(480, 480, light.paper, `The machine at ${context.state().rpm} rpm`);
          paint(pen, 480, 480, box, cam, frameAt(clock.time), light);
          return Explore.stack([pen.finish(), gap.svg(480), force.svg(480)]);
        },
      };
    },
  });
})();

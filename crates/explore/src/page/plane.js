// Three pictures of where a motion goes: its phase plane, its impact map, and the basins of attraction.
//
// All three are linked. Pointing at a start in the basins draws its motion in the phase plane and its impacts in the impact
// map, and the other way round. What is pointed at is asked for in a lane of its own, so that it never disturbs the view.
"use strict";
(() => {
  const { number, quantity, turned, degrees, column, extent } = Explore;

  // What the views share ----------------------------------------------------------------------------------------------

  /** What a question takes as `start`, from a motion that is pointed at: at rest on the cam where it names a cam angle alone. */
  Explore.startOf = (motion) => {
    if (!motion || !Number.isFinite(motion.cam_angle_rad)) return null;
    const start = { cam_angle_rad: motion.cam_angle_rad };
    if (Number.isFinite(motion.position) && Number.isFinite(motion.velocity)) return { ...start, position: motion.position, velocity: motion.velocity };
    return Number.isFinite(motion.relative_velocity) ? { ...start, relative_velocity: motion.relative_velocity } : start;
  };
  /** The question of a motion that is pointed at: its speed, its start, and the model with the number that the diagram varies. */
  Explore.questionOf = (motion, context) => {
    const start = Explore.startOf(motion);
    if (!start) return null;
    const varied = motion.over && motion.over.name !== "rpm" ? { model: { ...context.app.question(), set: { ...context.app.question().set, [motion.over.name]: motion.over.value } } } : {};
    return { ...varied, rpm: motion.rpm ?? context.state().rpm, start };
  };
  /** The column of cam angles in radians, whatever unit the model's files have. */
  const anglesOf = (found) => Explore.angles(found, "cam_angle_").map(Explore.radians);
  const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  const many = (count, one, more = `${one}s`) => `${number(count)} ${count === 1 ? one : more}`;
  // An address can be written by anyone: an option of the wrong kind counts as missing.
  const isRange = (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite) && value[0] < value[1];
  const isBox = (value) => Boolean(value) && isRange(value.x) && isRange(value.y);
  const optionOf = (context, name, isGood, otherwise) => { const value = context.option(name, otherwise); return isGood(value) ? value : otherwise; };
  const boxOf = (context) => optionOf(context, "range", isBox, null);
  /** Where the program refuses, its sentence stands in the panel: a heading and evidence of an earlier answer go. */
  const refused = (panel) => {
    if (panel.element.querySelector(".sentence").hidden) return false;
    panel.heading(panel.view.title);
    panel.known(null);
    return true;
  };
  const units = (context) => (context.model() || {}).units || {};

  /** The name of a long-run motion in words; an ending of `basins` names its kind `ending`. */
  Explore.ending = (found) => Explore.motionInWords({ kind: found.ending, ...found });

  /** What the long run comes to, asked once for all views of a state; null where it is refused or superseded. */
  const asked = { key: null, promise: null };
  const longRun = (context, state) => {
    const question = { view: "long_run", model: context.app.question(), rpm: state.rpm, ...context.start() };
    const key = JSON.stringify(question);
    if (asked.key !== key) {
      const promise = context.app.transport.ask(question, "long-run", { slow: true }).then((answer) => answer.found || null, () => { if (asked.promise === promise) asked.key = null; return null; });
      [asked.key, asked.promise] = [key, promise];
    }
    return asked.promise;
  };

  /** Paints more on top of a plot's data, each time that what lies on top is painted. */
  const onTop = (plot, paint) => {
    const before = plot.overlay;
    plot.overlay = () => {
      before();
      if (plot.place) paint(Explore.canvasPen(plot.element.querySelector(".plot-over").getContext("2d")), plot.place, Explore.theme(plot.element));
    };
  };
  /** An arrow from pixel to pixel: its shaft ends a little before both. */
  const arrow = (pen, [x0, y0], [x1, y1], colour, alpha = 1) => {
    const far = Math.hypot(x1 - x0, y1 - y0);
    if (!(far > 12)) return;
    const [dx, dy] = [(x1 - x0) / far, (y1 - y0) / far];
    const [bx, by, ex, ey] = [x0 + dx * 7, y0 + dy * 7, x1 - dx * 8, y1 - dy * 8];
    pen.path([bx, ex - dx * 6], [by, ey - dy * 6], { stroke: colour, width: 1.8, alpha });
    pen.path([ex, ex - dx * 9 - dy * 4, ex - dx * 9 + dy * 4], [ey, ey - dy * 9 + dx * 4, ey - dy * 9 - dx * 4], { fill: colour, close: true, alpha });
  };

  // The phase plane --------------------------------------------------------------------------------------------------------

  /** A run cut at its impacts, where time stands still and the velocity jumps: `pieces` has NaN there, `jumps` the two ends. */
  const cut = (time, x, y) => {
    const pieces = { x: [], y: [], index: [] };
    const jumps = { x: [], y: [] };
    for (let index = 0; index < x.length; index += 1) {
      if (index > 0 && time[index] === time[index - 1]) {
        pieces.x.push(NaN); pieces.y.push(NaN); pieces.index.push(-1);
        jumps.x.push(x[index - 1], x[index], NaN); jumps.y.push(y[index - 1], y[index], NaN);
      }
      pieces.x.push(x[index]); pieces.y.push(y[index]); pieces.index.push(index);
    }
    return { pieces, jumps };
  };
  /** Arrowheads along a curve, in the direction of time: one each third of the picture's width, none upon another. */
  const heads = ({ x, y }, [x0, x1], [y0, y1], aspect) => {
    const found = { x: [], y: [] };
    let since = 0.2;
    const taken = [];
    for (let index = 1; index < x.length; index += 1) {
      const [dx, dy] = [(x[index] - x[index - 1]) / (x1 - x0), ((y[index] - y[index - 1]) / (y1 - y0)) * aspect];
      const far = Math.hypot(dx, dy);
      if (!(far > 0)) continue;
      since += far;
      if (since < 0.33) continue;
      since = 0;
      const [px, py] = [(x[index] - x0) / (x1 - x0), ((y[index] - y0) / (y1 - y0)) * aspect];
      if (taken.some(([a, b]) => Math.hypot(a - px, b - py) < 0.12)) continue;
      taken.push([px, py]);
      const [ux, uy] = [dx / far, dy / far];
      const back = (side) => [x[index] + (-0.02 * ux - side * 0.009 * uy) * (x1 - x0), y[index] + ((-0.02 * uy + side * 0.009 * ux) / aspect) * (y1 - y0)];
      const [left, right] = [back(1), back(-1)];
      found.x.push(left[0], x[index], right[0], NaN); found.y.push(left[1], y[index], right[1], NaN);
    }
    return found;
  };
  /** The two coordinates of a run: of the follower itself, or of the gap between follower and cam. */
  const coordinates = (found, gap) => {
    const [velocity, cam] = [column(found, "velocity_"), column(found, "cam_velocity_")];
    return gap ? { x: column(found, "gap_"), y: velocity.map((each, index) => each - cam[index]) } : { x: column(found, "position_"), y: velocity };
  };
  const runOf = (found, gap) => ({ time: found.time_s || column(found, "time_"), ...coordinates(found, gap) });

  const revolutionsOf = (context) => optionOf(context, "revolutions", (value) => Number.isInteger(value) && value > 0 && value <= 100, 4);

  Explore.view({
    name: "plane", title: "Phase plane",
    mount(panel, context) {
      const ASPECT = 0.75;
      const plot = context.plot(panel.body, {
        label: "Phase plane of the motion", aspect: ASPECT, least: 260,
        zoom: ({ x, y }) => context.setOption("range", { x: Explore.parts.neat(x), y: Explore.parts.neat(y) }),
        back: () => { if (!boxOf(context)) return false; context.setOption("range", null); return true; },
      });
      const axes = Explore.menu("Axes", [["follower", "position and velocity"], ["gap", "gap and relative velocity"]], "follower", (value) => {
        context.change({ views: { ...context.state().views, plane: { ...(context.state().views.plane || {}), axes: value, range: null } } });
      });
      const turns = Explore.menu("Revolutions", ["1", "2", "4", "8", "16", "32"].map((each) => [each, each]), "4", (value) => context.setOption("revolutions", Number(value)));
      const approach = Explore.check("with the transient", false, (on) => context.setOption("approach", on));
      panel.options.append(axes, turns, approach);
      let shown = null;
      let pointed = null;

      const hover = (found, rows) => (index) => {
        const [row, unit] = [rows[index], units(context)];
        if (row < 0) return null;
        return {
          title: `Cam angle ${number(turned(anglesOf(found)[row]), 5)}°`,
          rows: [["position", quantity(column(found, "position_")[row], unit.length)], ["velocity", quantity(column(found, "velocity_")[row], unit.velocity)],
            ["gap", quantity(column(found, "gap_")[row], unit.length)], ["contact force", quantity(column(found, "contact_force_")[row], unit.force)]],
          known: "computed",
        };
      };
      const motion = (found, rows, rpm) => (index) => (rows[index] < 0 ? null : {
        rpm, cam_angle_rad: anglesOf(found)[rows[index]], position: column(found, "position_")[rows[index]], velocity: column(found, "velocity_")[rows[index]],
      });
      const draw = (state) => {
        if (!shown) return;
        const { found, rpm } = shown;
        const gap = context.option("axes", "follower") === "gap" && column(found, "cam_velocity_").length > 0;
        const run = runOf(found, gap);
        const { pieces, jumps } = cut(run.time, run.x, run.y);
        const cam = gap || !column(found, "cam_velocity_").length ? null : { x: column(found, "cam_lift_"), y: column(found, "cam_velocity_") };
        const other = pointed ? runOf(pointed, gap) : null;
        const lists = cam ? [cam] : [];
        const range = boxOf(context) || { x: extent([run.x, ...lists.map(({ x }) => x)]), y: extent([run.y, ...lists.map(({ y }) => y)]) };
        const tips = heads(pieces, range.x, range.y, ASPECT);
        const unit = units(context);
        plot.draw({
          x: { label: gap ? "gap between follower and cam" : "position of the follower", unit: unit.length, range: range.x },
          y: { label: gap ? "relative velocity" : "velocity", unit: unit.velocity, range: range.y },
          layers: [
            gap ? { kind: "rule", x: 0, colour: "grey", width: 3, label: "on the cam" } : cam && { kind: "line", ...cam, colour: "grey", width: 1.4, dash: [2, 3] },
            other && { kind: "line", ...cut(other.time, other.x, other.y).pieces, colour: "purple", width: 1.2, alpha: 0.8 },
            { kind: "line", ...jumps, colour: "vermilion", width: 1.3, dash: [5, 3] },
            { kind: "line", ...pieces, colour: "blue", width: 1.8, hover: hover(found, pieces.index), motion: motion(found, pieces.index, rpm) },
            { kind: "line", ...tips, colour: "blue", width: 1.8 },
            ...ends(jumps),
          ],
          description: `${panel.element.querySelector("h3").textContent} at ${number(state.rpm, 8)} rpm, drawn over ${many(revolutionsOf(context), "revolution")} with ${many(jumps.x.length / 3, "impact")}`,
        });
      };
      // An impact begins at a square and ends at a triangle.
      const ends = ({ x, y }) => {
        const at = (offset) => ({ x: x.filter((_, index) => index % 3 === offset), y: y.filter((_, index) => index % 3 === offset) });
        return x.length > 1500 ? [] : [{ kind: "points", ...at(0), shape: "square", size: 5, colour: "vermilion" }, { kind: "points", ...at(1), shape: "triangle", size: 6, colour: "vermilion" }];
      };
      const point = async (to) => {
        const question = to && to.from !== "machine" ? Explore.questionOf(to, context) : null;
        const found = question && await context.ask({ view: "motion", ...question, transient: 0, revolutions: 3, samples: 120 }, { lane: "plane-pointed", silent: true, coarse: true });
        if (!found && !pointed) return;
        pointed = found;
        draw(context.state());
      };
      return {
        async update(state, { coarse }) {
          const [revolutions, approaching] = [revolutionsOf(context), context.option("approach", false)];
          [axes, turns].forEach((each, index) => each.set(String(index ? revolutions : context.option("axes", "follower"))));
          approach.set(approaching);
          const found = await context.ask({ view: "motion", rpm: state.rpm, transient: approaching ? 0 : 300, revolutions, samples: coarse ? 120 : revolutions <= 4 ? 720 : 360, ...context.start() }, { coarse });
          if (!found) { refused(panel); return; }
          shown = { found, rpm: state.rpm };
          const hits = found.events && found.events.event ? found.events.event.filter((each) => each === "impact").length : 0;
          if (coarse) panel.heading(`${capital(many(hits, "impact"))} in ${many(revolutions, "revolution")}`);
          draw(state);
          panel.note(`Blue: the follower, in the direction of the arrows. Dashed: its impacts, from the square to the triangle.${column(found, "cam_velocity_").length ? " Grey: the cam." : ""}`);
          if (coarse) return;
          const long = await longRun(context, state);
          if (!long || state !== context.state()) return;
          panel.heading(long.kind === "chaotic" ? "Chaotic: the curve never closes" : long.revolutions ? `The curve closes: ${Explore.ending(long)}` : capital(Explore.ending(long)));
          draw(state);
        },
        highlight(to) {
          const gap = context.option("axes", "follower") === "gap";
          plot.mark(to && !gap && Number.isFinite(to.position) && Number.isFinite(to.velocity) ? [{ x: to.position, y: to.velocity }] : []);
          point(to);
        },
      };
    },
  });

  // The impact map -------------------------------------------------------------------------------------------------------

  /** The question for the events of a run alone. */
  const eventsOf = (run) => ({ view: "motion", samples: 0, ...run });
  /** Impacts of a run as points of the map's plane, with the state that each leaves behind. */
  const impactsOf = ({ events }) => {
    const rows = [...events.event.keys()].filter((index) => events.event[index] === "impact");
    const of = (list) => rows.map((index) => list[index]);
    const [after, cam] = [of(column(events, "velocity_after_")), of(column(events, "cam_velocity_"))];
    return { angle: of(anglesOf(events)), position: of(column(events, "position_")), velocity: after, speed: after.map((each, index) => each - cam[index]) };
  };
  /** What is drawn: the plane of angle and velocity, or each angle over the one before it. */
  const planeOf = ({ angle, speed }, returns) => (returns
    ? { x: angle.slice(0, -1).map(turned), y: angle.slice(1).map(turned) } : { x: angle.map(turned), y: speed });
  // A run that chatters has dozens of impacts in a revolution: as many revolutions are asked for as make some thousand points.
  const inTurn = ([low, high]) => [Math.max(0, low), Math.min(360, high)];
  const FEW = 40;
  const enough = (hits, revolutions) => Math.max(20, Math.min(2000, Math.round((3000 * revolutions) / Math.max(1, hits))));

  /** Impacts that differ by more than rounding: a periodic motion has as many as it has impacts in a period. */
  const distinct = ({ x, y }) => new Set(x.map((each, index) => `${each.toPrecision(7)} ${y[index].toPrecision(7)}`)).size;
  /** Periodic orbits as points of the map's plane. Restitution gives the relative velocity after an impact from both velocities. */
  const orbitLayers = (orbits, restitution, rpm) => orbits.map(({ stable, impacts, known }) => {
    const speed = impacts.map((each) => (restitution / (1 + restitution)) * (column(each, "velocity_after_") - column(each, "velocity_before_")));
    const angle = impacts.map((each) => each.cam_angle_rad ?? Explore.radians(each.cam_angle_deg));
    const look = stable ? { shape: "ring", size: 16, colour: "green" } : { shape: "triangle", size: 12, colour: "vermilion" };
    return {
      kind: "points", x: angle.map(turned), y: speed, ...look,
      hover: (index) => ({ title: `Periodic orbit, ${stable ? "stable" : "unstable"}`, rows: [["strikes at", `${number(turned(angle[index]), 7)}°`], ["leaves the cam at", number(speed[index], 6)]], known }),
      motion: (index) => ({ rpm, cam_angle_rad: angle[index], relative_velocity: speed[index] }),
    };
  });
  /** Where the map is looked at: a few points are shown in the whole turn, where the corners are. */
  const rangeOf = (drawn, orbits, returns, few) => {
    const [x, y] = [[drawn.x, ...orbits.map((each) => each.x)], [drawn.y, ...orbits.map((each) => each.y)]];
    const turn = (lists) => (few ? [0, 360] : inTurn(extent(lists)));
    return { x: turn(x), y: returns ? turn(y) : few ? extent([...y, [0]], 0.15) : extent(y) };
  };
  const impactHeading = (long, { angle }) => {
    if (!angle.length) return "No impacts: the follower stays on the cam";
    if (long.kind === "chaotic") return "The impacts never repeat: chaos";
    const own = angle.slice(0, long.impacts || 0).map((at) => `${number(turned(at), 5)}°`);
    if (long.kind === "periodic" && own.length <= 3) return `The impacts repeat at ${own.join(", ")}`;
    return `${capital(Explore.ending(long))}${long.revolutions ? ": the impacts repeat" : ""}`;
  };

  Explore.view({
    name: "impacts", title: "Impact map",
    mount(panel, context) {
      const plot = context.plot(panel.body, {
        label: "Impact map", aspect: 0.75, least: 260,
        zoom: ({ x, y }) => context.setOption("range", { x: Explore.parts.neat(x), y: Explore.parts.neat(y) }),
        back: () => { if (!boxOf(context)) return false; context.setOption("range", null); return true; },
      });
      const show = Explore.menu("Show", [["map", "velocity over angle"], ["return", "each angle over the previous one"]], "map", (value) => {
        context.change({ views: { ...context.state().views, impacts: { ...(context.state().views.impacts || {}), show: value, range: null } } });
      });
      const orbits = Explore.check("periodic orbits of one revolution", false, (on) => context.setOption("orbits", on));
      panel.options.append(show, orbits);
      let shown = null;
      let pointed = null;
      // The image of the impact that is pointed at, and the image of that: three arrows.
      onTop(plot, (pen, { across, up, box }, theme) => {
        if (!plot.at || !shown || plot.at.layer.images !== true) return;
        const drawn = planeOf(shown.impacts, context.option("show", "map") === "return");
        pen.clip(box);
        for (let step = 0; step < 3; step += 1) {
          const [from, to] = [plot.at.index + step, plot.at.index + step + 1];
          if (to < drawn.x.length) arrow(pen, [across(drawn.x[from]), up(drawn.y[from])], [across(drawn.x[to]), up(drawn.y[to])], theme.vermilion, 1 - step * 0.3);
        }
        pen.unclip();
      });
      const hover = (impacts) => (index) => {
        const unit = units(context);
        const next = index + 1 < impacts.angle.length ? [["next impact", `${number(turned(impacts.angle[index + 1]), 6)}°, ${quantity(impacts.speed[index + 1], unit.velocity)}`]] : [];
        return { title: `Impact ${index + 1} at ${number(turned(impacts.angle[index]), 6)}°`, rows: [["leaves the cam at", quantity(impacts.speed[index], unit.velocity)], ...next], known: "computed" };
      };
      const draw = () => {
        if (!shown) return;
        const returns = context.option("show", "map") === "return";
        const [{ impacts, rpm }, unit] = [shown, units(context)];
        const drawn = planeOf(impacts, returns);
        const other = pointed && planeOf(pointed, returns);
        const different = drawn.x.length > 20000 ? Infinity : distinct(drawn);
        const few = different <= 100;
        const own = returns || !context.option("orbits", false) || !shown.orbits ? [] : orbitLayers(shown.orbits, context.value("follower.restitution"), rpm);
        const range = boxOf(context) || rangeOf(drawn, own, returns, different <= 12);
        const corners = ((context.model() || {}).corners || []).map((each) => each.angle_deg).filter((at) => at >= range.x[0] && at <= range.x[1]);
        plot.draw({
          x: { label: returns ? "cam angle at an impact" : "cam angle at the impact", unit: "°", range: range.x, turn: true },
          y: returns ? { label: "cam angle at the next impact", unit: "°", range: range.y, turn: true } : { label: "relative velocity after the impact", unit: unit.velocity, range: range.y },
          layers: [
            ...corners.map((x, index) => ({ kind: "rule", x, colour: "grey", width: 1, dash: [2, 3], label: index === 0 ? "corner" : "" })),
            returns && { kind: "line", x: [0, 360], y: [0, 360], colour: "grey", width: 1 },
            { kind: "points", ...drawn, shape: few ? "disc" : "dot", size: few ? 8 : 2, colour: "blue", images: true, hover: hover(impacts),
              motion: (index) => ({ rpm, cam_angle_rad: impacts.angle[index], position: impacts.position[index], velocity: impacts.velocity[index], relative_velocity: impacts.speed[index] }) },
            other && { kind: "points", ...other, shape: "ring", size: 9, colour: "purple" },
            ...own,
          ],
          message: drawn.x.length ? "" : impacts.angle.length ? "only one impact" : "no impacts: the follower stays on the cam",
          description: `${panel.element.querySelector("h3").textContent}. ${many(impacts.angle.length, "impact")} at ${number(rpm, 8)} rpm`,
        });
      };
      const point = async (to) => {
        const question = to && to.from !== "machine" && to.from !== "plane" ? Explore.questionOf(to, context) : null;
        const found = question && await context.ask(eventsOf({ ...question, transient: 0, revolutions: 20 }), { lane: "impacts-pointed", silent: true, coarse: true });
        if (!found && !pointed) return;
        pointed = found ? impactsOf(found) : null;
        draw();
      };
      return {
        async update(state, { coarse }) {
          show.set(context.option("show", "map"));
          orbits.set(context.option("orbits", false));
          const asked = eventsOf({ rpm: state.rpm, transient: 300, ...context.start() });
          const first = await context.ask({ ...asked, revolutions: FEW }, { lane: "impacts-first", coarse, silent: !coarse });
          if (!first) { refused(panel); return; }
          const more = enough(impactsOf(first).angle.length, FEW);
          const found = coarse ? first : await context.ask({ ...asked, revolutions: more });
          if (!found) return;
          shown = { impacts: impactsOf(found), rpm: state.rpm };
          if (coarse) panel.heading(`${capital(many(shown.impacts.angle.length, "impact"))} in ${FEW} revolutions`);
          panel.note(shown.impacts.angle.length ? `Each point is an impact of ${many(coarse ? FEW : more, "revolution")}. Point at one to see its next three.` : "");
          draw();
          if (coarse) return;
          const long = await longRun(context, state);
          if (!long || state !== context.state()) return;
          panel.heading(impactHeading(long, shown.impacts));
          draw();
          if (!context.option("orbits", false)) return;
          const sheet = await context.ask({ view: "orbit", rpm: state.rpm, revolutions: 1 }, { lane: "impacts-orbits", slow: true, silent: true });
          if (!sheet || state !== context.state()) return;
          shown.orbits = sheet.orbits.filter((each) => each.impacts.length > 0);
          draw();
          panel.note(`Rings: stable periodic orbits of one revolution, triangles: unstable ones (${shown.orbits.every((each) => each.known === "proved") ? "their existence is proved" : "computed"}).`);
        },
        highlight(to) {
          const impact = to && Number.isFinite(to.relative_velocity) && context.option("show", "map") === "map";
          plot.mark(impact ? [{ x: turned(to.cam_angle_rad), y: to.relative_velocity }] : []);
          point(to);
        },
        csv: () => {
          if (!shown) return null;
          const [{ impacts }, unit] = [shown, units(context)];
          const name = (start, of) => `${start}_${(of || "").replace("/", "_")}`;
          return Explore.csv({ cam_angle_deg: impacts.angle.map(degrees), [name("position", unit.length)]: impacts.position, [name("velocity_after", unit.velocity)]: impacts.velocity, [name("relative_velocity_after", unit.velocity)]: impacts.speed });
        },
      };
    },
  });
  Explore.parts = { capital, many, units, refused, isRange, optionOf, boxOf };
})();

// The slider: picks a frame of the data in the page and draws it. Every number comes from there; what is reckoned here is
// where on the screen it goes.
"use strict";
(async () => {
  const source = document.getElementById("through-data");
  if (!source) return;
  const data = JSON.parse(await unpacked(source.textContent));
  const { frames, axes, places } = data;
  const get = (id) => document.getElementById(id);
  const slider = get("speed");
  const SVG = "http://www.w3.org/2000/svg";
  const minus = (text) => text.replace("-", "\u2212");
  const fixed = (value, places) => minus(value.toFixed(places));
  const rpm = (frame) => `${frame.rpm.toFixed(places.speed)} rpm`;
  const kind = (orbit) => orbit.stability;

  const element = (parent, name, attributes, text) => {
    const made = document.createElementNS(SVG, name);
    Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
    if (text !== undefined) made.textContent = text;
    parent.append(made);
    return made;
  };
  const pixel = (value) => Math.round(value * 100) / 100;
  const line = (points) => points.map(([x, y], index) => `${index ? "L" : "M"}${pixel(x)} ${pixel(y)}`).join("");

  // A frame with two axes; `moving` is emptied for each speed.
  const WIDTH = 440;
  const HEIGHT = 300;
  const panel = (id, x, y, names, square = false) => {
    const [width, height] = [WIDTH, HEIGHT];
    const box = { left: 58, top: 8, right: width - 16, bottom: height - 36 };
    if (square) {
      const spare = (box.right - box.left - (box.bottom - box.top)) / 2;
      box.left += spare;
      box.right -= spare;
    }
    const svg = element(get(id), "svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": names.label });
    const across = (value) => box.left + ((value - x.range[0]) / (x.range[1] - x.range[0])) * (box.right - box.left);
    const up = (value) => box.bottom - ((value - y.range[0]) / (y.range[1] - y.range[0])) * (box.bottom - box.top);
    const titled = (name, unit) => (unit ? `${name} (${unit})` : name);
    x.ticks.forEach(([at, label]) => {
      element(svg, "path", { class: "grid", d: `M${across(at)} ${box.top}V${box.bottom}` });
      element(svg, "text", { x: across(at), y: box.bottom + 15, "text-anchor": "middle" }, minus(label));
    });
    y.ticks.forEach(([at, label]) => {
      element(svg, "path", { class: "grid", d: `M${box.left} ${up(at)}H${box.right}` });
      element(svg, "text", { x: box.left - 5, y: up(at) + 4, "text-anchor": "end" }, minus(label));
    });
    element(svg, "text", { x: (box.left + box.right) / 2, y: height - 5, "text-anchor": "middle", class: "soft" }, titled(names.x, x.unit));
    element(svg, "text", { x: 0, y: 0, "text-anchor": "middle", class: "soft", transform: `translate(${box.left - 45} ${(box.top + box.bottom) / 2}) rotate(-90)` }, titled(names.y, y.unit));
    // An svg of its own cuts off what lies outside.
    const inside = element(svg, "svg", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top, viewBox: `${box.left} ${box.top} ${box.right - box.left} ${box.bottom - box.top}` });
    const still = element(inside, "g", {});
    const moving = element(inside, "g", {});
    element(svg, "rect", { class: "frame", x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top });
    return { svg, box, across, up, still, moving, at: ([a, b]) => [across(a), up(b)] };
  };
  const ring = (parent, [x, y], orbit, radius = 5) => element(parent, "circle", { class: `${kind(orbit)} ring`, cx: pixel(x), cy: pixel(y), r: radius });
  // Runs of frames in which an orbit of one kind at one place goes on: what a trace joins.
  const traces = (value) => {
    const done = [];
    const open = new Map();
    frames.forEach((frame) => {
      const seen = new Set();
      frame.orbits.forEach((orbit) => {
        const key = `${orbit.place} ${orbit.stability}`;
        if (seen.has(key)) return;
        seen.add(key);
        if (!open.has(key)) {
          open.set(key, { orbit, points: [] });
          done.push(open.get(key));
        }
        open.get(key).points.push(value(frame, orbit));
      });
      [...open.keys()].filter((key) => !seen.has(key)).forEach((key) => open.delete(key));
    });
    return done;
  };

  const whole = panel("revolution", axes.angle, axes.position, { label: "Position of follower and cam against the cam angle", x: "cam angle", y: "position" });
  element(whole.still, "path", { class: "cam", d: line(data.cam.map(([angle, lift]) => whole.at([angle, lift]))) });
  data.corners.forEach(([angle, name], index) => {
    element(whole.still, "path", { class: "corner", d: `M${whole.across(angle)} ${whole.box.top}V${whole.box.bottom}` });
    // Neighbours at two heights: their letters do not touch.
    element(whole.still, "text", { x: whole.across(angle) + 3, y: whole.box.top + (index % 2 ? 27 : 13), class: "soft" }, name);
  });

  const near = panel("near", axes.near, axes.acceleration, { label: "Acceleration of the cam near the corner, and where orbits hit it", x: "cam angle", y: "acceleration" });
  [-360, 0, 360].forEach((turn) => element(near.still, "path", { class: "cam", d: line(data.cam.map(([angle, , bend]) => near.at([angle + turn, bend]))) }));
  element(near.still, "path", { class: "corner", d: `M${near.across(data.corner_deg)} ${near.box.top}V${near.box.bottom}` });
  element(near.still, "text", { x: near.across(data.corner_deg) + 4, y: near.box.top + 13, class: "soft" }, data.corner);

  const plane = panel("plane", axes.plane, axes.plane, { label: "Multipliers in the complex plane", x: "real part", y: "imaginary part" }, true);
  element(plane.still, "ellipse", { class: "cam", cx: plane.across(0), cy: plane.up(0), rx: plane.across(1) - plane.across(0), ry: plane.up(0) - plane.up(1) });
  // What lies outside is held at the edge, where it can be seen; the readout has its value.
  const held = (part) => Math.max(0.96 * axes.plane.range[0], Math.min(0.96 * axes.plane.range[1], part));
  [0, 1].forEach((index) => {
    traces((frame, orbit) => plane.at([orbit.multipliers[index].re, orbit.multipliers[index].im]))
      .forEach(({ orbit, points }) => element(plane.still, "path", { class: `${kind(orbit)} trace`, d: line(points) }));
  });

  const diagram = panel("diagram", axes.speed, axes.angle, { label: "Cam angle of impacts against speed", x: "speed", y: "cam angle" });
  element(diagram.still, "path", { class: "corner", d: `M${diagram.box.left} ${diagram.up(data.corner_deg)}H${diagram.box.right}` });
  element(diagram.still, "text", { x: diagram.box.left + 4, y: diagram.up(data.corner_deg) - 4, class: "soft" }, data.corner);
  const dots = (run) => frames.flatMap((frame) => run(frame).impacts_deg.map((angle) => diagram.at([frame.rpm, angle]))).map(([x, y]) => `M${pixel(x)} ${pixel(y)}h0`).join("");
  element(diagram.still, "path", { class: "dot rising", d: dots((frame) => frame.speeding) });
  element(diagram.still, "path", { class: "dot", d: dots((frame) => frame.slowing) });
  traces((frame, orbit) => diagram.at([frame.rpm, orbit.angle_deg])).forEach(({ orbit, points }) => element(diagram.still, "path", { class: kind(orbit), d: line(points) }));

  // The cam as a shape: it turns anticlockwise, as in the figures, and its next angles come up from the right.
  const middle = [WIDTH / 2, HEIGHT - 118];
  const scale = 112 / data.drawn_radius_m;
  const shape = element(get("shape"), "svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "The cam turned to the impact, with the follower on it" });
  const placed = (angle, height, shown) => {
    const turn = ((angle - shown) * Math.PI) / 180;
    const radius = (height + data.drawn_on_m) * scale;
    return [middle[0] + radius * Math.sin(turn), middle[1] - radius * Math.cos(turn)];
  };
  const cam = element(shape, "g", {});
  const lifted = (angle) => data.cam.reduce((best, point) => (Math.abs(point[0] - angle) < Math.abs(best[0] - angle) ? point : best))[1];
  element(cam, "path", { class: "body", d: `${line(data.cam.map(([angle, lift]) => placed(angle, lift, 0)))}z` });
  data.corners.forEach(([angle, name]) => {
    const at = placed(angle, lifted(angle), 0);
    const label = placed(angle, lifted(angle) - data.drawn_radius_m * 0.13, 0);
    element(cam, "circle", { cx: at[0], cy: at[1], r: 3 });
    const text = element(cam, "text", { x: label[0], y: label[1] + 4, "text-anchor": "middle" }, name);
    text.dataset.at = label.join(" ");
  });
  element(shape, "circle", { class: "frame", cx: middle[0], cy: middle[1], r: 4 });
  const onCam = element(shape, "g", {});

  const drawShape = (frame) => {
    onCam.replaceChildren();
    const main = frame.orbits.find((orbit) => orbit.stable) || frame.orbits[0];
    const shown = main ? main.angle_deg : frame.slowing.impacts_deg[0];
    if (shown === undefined) return;
    cam.setAttribute("transform", `rotate(${-pixel(shown)} ${middle[0]} ${middle[1]})`);
    cam.querySelectorAll("text").forEach((text) => {
      const [x, y] = text.dataset.at.split(" ");
      text.setAttribute("transform", `rotate(${pixel(shown)} ${x} ${y})`);
    });
    const tip = placed(shown, main ? main.position_m : lifted(shown), shown);
    element(onCam, "path", { class: "rod", d: `M${pixel(tip[0])} ${pixel(tip[1] - 3)}V14` });
    frame.orbits.forEach((orbit) => ring(onCam, placed(orbit.angle_deg, orbit.position_m, shown), orbit));
    element(onCam, "text", { x: 8, y: 20, class: "soft" }, `turned by ${shown.toFixed(2)}\u00b0`);
  };

  const cells = (row, values) => values.forEach(([text, number]) => {
    const cell = row.insertCell();
    cell.textContent = text;
    cell.dataset.head = get("readout").tHead.rows[0].cells[cell.cellIndex].textContent;
    if (number) cell.className = "n";
  });
  const multiplier = ({ re, im }) => (im === 0 ? fixed(re, places.multiplier) : `${fixed(re, places.multiplier)} ${im < 0 ? "\u2212" : "+"} ${im.toFixed(places.multiplier).replace("-", "")}\u202fi`);
  const readout = (frame) => {
    const body = get("readout").tBodies[0];
    body.replaceChildren();
    frame.orbits.forEach((orbit) => {
      const side = orbit.place === "elsewhere" ? "elsewhere" : `${orbit.place} ${data.corner}`;
      cells(body.insertRow(), [
        [kind(orbit), false], [side, false], [fixed(orbit.angle_deg, places.angle), true], [fixed(orbit.from_corner_deg, places.angle), true],
        [fixed(orbit.velocity_before_m_s, places.velocity), true], [fixed(orbit.velocity_after_m_s, places.velocity), true],
        [orbit.multipliers.map(multiplier).join(", "), true], [fixed(orbit.modulus, places.multiplier), true],
      ]);
    });
  };
  const words = (frame, index) => {
    const [slowing, speeding] = [frame.slowing.words, frame.speeding.words];
    const other = slowing === speeding ? "; so has one from slower speeds" : `; one from slower speeds has ${speeding}`;
    const run = `A run that came from faster speeds has ${slowing}${other}.`;
    if (index === data.at_corner) return `${rpm(frame)}: the orbit hits the corner ${data.corner}. It is shown with the law before the corner and with the law after it. ${run}`;
    if (!frame.orbits.length) return `${rpm(frame)}: there is no orbit with one impact a revolution. ${run}`;
    const found = frame.orbits.map((orbit) => `${kind(orbit)} at ${orbit.angle_deg.toFixed(2)}\u00b0`).join(", ");
    return `${rpm(frame)}: ${frame.orbits.length === 1 ? "one orbit" : `${frame.orbits.length} orbits`} with one impact a revolution, ${found}. ${run}`;
  };

  let told = 0;
  const show = (index) => {
    const frame = frames[index];
    slider.value = index;
    slider.setAttribute("aria-valuetext", rpm(frame));
    get("speed-shown").textContent = rpm(frame);
    get("player").dataset.frame = index;
    // The live region speaks when the hand rests; what is seen changes at once.
    get("summary").textContent = words(frame, index);
    get("summary").setAttribute("aria-busy", "true");
    clearTimeout(told);
    told = setTimeout(() => get("summary").setAttribute("aria-busy", "false"), 400);

    [whole, near, plane, diagram].forEach(({ moving }) => moving.replaceChildren());
    frame.slowing.paths.forEach((path) => element(whole.moving, "path", { class: "run", d: line(path.map(whole.at)) }));
    frame.orbits.forEach((orbit) => {
      element(whole.moving, "path", { class: kind(orbit), d: line(orbit.path.map(whole.at)) });
      const angle = data.corner_deg + orbit.from_corner_deg;
      const hit = element(near.moving, "path", { class: `${kind(orbit)} impact`, d: `M${pixel(near.across(angle))} ${near.box.top}V${near.box.bottom}` });
      hit.dataset.angle = orbit.angle_deg;
    });
    frame.orbits.forEach((orbit) => {
      ring(whole.moving, whole.at([orbit.angle_deg, orbit.position_m]), orbit);
      orbit.multipliers.forEach(({ re, im }) => {
        const mark = ring(plane.moving, plane.at([held(re), held(im)]), orbit, 5.5);
        mark.classList.add("multiplier");
        mark.dataset.re = re;
        mark.dataset.im = im;
      });
      ring(diagram.moving, diagram.at([frame.rpm, orbit.angle_deg]), orbit, 4);
    });
    element(diagram.moving, "path", { class: "cursor", d: `M${pixel(diagram.across(frame.rpm))} ${diagram.box.top}V${diagram.box.bottom}` });
    drawShape(frame);
    readout(frame);
  };

  const play = get("play");
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  let timer = 0;
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.setAttribute("aria-pressed", "false");
    play.textContent = still.matches ? "Next speed" : "Play";
  };
  const last = frames.length - 1;
  const step = () => {
    const next = Number(slider.value) + 1;
    if (next > last) return stop();
    show(next);
  };
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (Number(slider.value) === last) show(0);
    // Whoever wants no motion goes on step by step.
    if (still.matches) return step();
    timer = setInterval(step, 80);
    play.setAttribute("aria-pressed", "true");
    play.textContent = "Pause";
  });
  still.addEventListener("change", stop);
  get("to-corner").addEventListener("click", () => { stop(); show(data.at_corner); });
  slider.addEventListener("input", () => { stop(); show(Number(slider.value)); });
  // In the diagram the frame nearest to the pointer is taken.
  const pointed = (event) => {
    const box = diagram.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * diagram.svg.viewBox.baseVal.width;
    const off = (index) => Math.abs(diagram.across(frames[index].rpm) - x);
    stop();
    show(frames.reduce((best, _, index) => (off(index) < off(best) ? index : best), 0));
  };
  diagram.svg.addEventListener("pointerdown", (event) => { diagram.svg.setPointerCapture(event.pointerId); pointed(event); });
  diagram.svg.addEventListener("pointermove", (event) => { if (event.buttons) pointed(event); });

  get("player").hidden = false;
  stop();
  show(data.at_corner);
})();

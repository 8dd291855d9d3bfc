// Hands on a plot: pointer, touch and keyboard. Everything that a pointer can do, keys can do (see plot.js).
"use strict";
(() => {
  const REACH = { mouse: 18, pen: 22, touch: 30 };

  /** Tells `visit(layer, index, px, py)` of every datum in sight that can be pointed at. Rules and pictures are no data. */
  const eachDatum = (plot, visit) => {
    if (!plot.place) return;
    const { across, up, box } = plot.place;
    plot.scene.layers.filter((layer) => layer && (layer.hover || layer.motion) && layer.x && layer.x.length !== undefined && layer.kind !== "cells").forEach((layer) => {
      for (let index = 0; index < layer.x.length; index += 1) {
        const px = across(layer.x[index]);
        if (!(px >= box.left - 1 && px <= box.right + 1)) continue;
        const py = layer.y && layer.y[index] !== null && layer.y[index] !== undefined ? up(layer.y[index]) : box.top + 7;
        if (py >= box.top - 1 && py <= box.bottom + 1) visit(layer, index, px, py);
      }
    });
  };
  const cell = (plot, px, py) => {
    const layer = plot.scene.layers.find((each) => each && each.kind === "cells" && (each.hover || each.motion));
    if (!layer) return null;
    const { across, up } = plot.place;
    const column = Math.floor(((px - across(layer.x[0])) / (across(layer.x[1]) - across(layer.x[0]))) * layer.columns);
    const row = Math.floor(((py - up(layer.y[0])) / (up(layer.y[1]) - up(layer.y[0]))) * layer.rows);
    return column >= 0 && row >= 0 && column < layer.columns && row < layer.rows ? { layer, index: row * layer.columns + column, px, py } : null;
  };
  const nearest = (plot, px, py, reach) => {
    let [best, least] = [null, reach * reach];
    eachDatum(plot, (layer, index, x, y) => {
      const far = (x - px) ** 2 + (y - py) ** 2;
      if (far < least) { best = { layer, index, px: x, py: y }; least = far; }
    });
    return best || cell(plot, px, py);
  };
  const ruleAt = (plot, px, py, reach) => plot.scene.layers.find((layer) => layer && layer.kind === "rule" && layer.move
    && Math.abs(layer.x !== undefined ? plot.place.across(layer.x) - px : plot.place.up(layer.y) - py) < reach);
  const ordered = ([a, b]) => (a < b ? [a, b] : [b, a]);

  Explore.pointing = (plot, { size }) => {
    const { canvas, options } = plot;
    const pointers = new Map();
    let drag = null;
    let pinch = null;

    const place = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    const held = (value, low, high) => Math.min(high, Math.max(low, value));
    const moveRule = (rule, px, py, done) => {
      const { across, up, box } = plot.place;
      rule.move(rule.x !== undefined ? across.back(held(px, box.left, box.right)) : up.back(held(py, box.top, box.bottom)), done);
    };
    const zoomTo = ([x0, x1, y0, y1]) => {
      const { across, up } = plot.place;
      options.zoom({ x: ordered([across.back(x0), across.back(x1)]), y: ordered([up.back(y0), up.back(y1)]) });
    };
    /** Zooms about a pixel: a factor of 2 halves both ranges. */
    const zoomBy = (factor, px, py) => {
      const { box } = plot.place;
      if (factor < 1 && options.back && factor === 0.5 && options.back()) return;
      zoomTo([px + (box.left - px) / factor, px + (box.right - px) / factor, py + (box.top - py) / factor, py + (box.bottom - py) / factor]);
    };

    const down = (event) => {
      if (!plot.place || event.button > 0) return;
      const [px, py] = place(event);
      pointers.set(event.pointerId, [px, py]);
      if (pointers.size === 2 && options.zoom) { const [a, b] = [...pointers.values()]; pinch = { far: Math.hypot(a[0] - b[0], a[1] - b[1]) }; drag = null; plot.box = null; return; }
      const rule = ruleAt(plot, px, py, event.pointerType === "mouse" ? 8 : 20);
      drag = { px, py, rule, moved: false };
      try { canvas.setPointerCapture(event.pointerId); } catch { /* a pointer made by a script has no capture */ }
    };
    const move = (event) => {
      if (!plot.place) return;
      const [px, py] = place(event);
      if (pointers.has(event.pointerId)) pointers.set(event.pointerId, [px, py]);
      if (pinch && pointers.size === 2) { const [a, b] = [...pointers.values()]; pinch.now = Math.hypot(a[0] - b[0], a[1] - b[1]); pinch.at = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]; return; }
      if (drag) {
        drag.moved = drag.moved || Math.hypot(px - drag.px, py - drag.py) > 5;
        if (drag.rule) { if (drag.moved) moveRule(drag.rule, px, py, false); return; }
        if (options.scrub && drag.moved) { options.scrub(plot.place.across.back(held(px, plot.place.box.left, plot.place.box.right)), false); return; }
        if (drag.moved && options.zoom) {
          const { box } = plot.place;
          const [x, y] = [ordered([held(drag.px, box.left, box.right), held(px, box.left, box.right)]), ordered([held(drag.py, box.top, box.bottom), held(py, box.top, box.bottom)])];
          // A level stroke means the range across: a finger cannot draw a rectangle, as the page scrolls under it.
          plot.box = y[1] - y[0] < 0.2 * (x[1] - x[0]) ? [...x, box.top, box.bottom] : [...x, ...y];
          plot.overlay();
          return;
        }
      }
      canvas.style.cursor = ruleAt(plot, px, py, 8) ? (plot.scene.layers.some((layer) => layer && layer.kind === "rule" && layer.move && layer.y !== undefined) ? "row-resize" : "col-resize") : options.zoom ? "crosshair" : "default";
      const at = nearest(plot, px, py, REACH[event.pointerType] || 18);
      if (!at && !plot.at) return;
      if (at && plot.at && at.layer === plot.at.layer && at.index === plot.at.index) return;
      plot.point(at, false);
    };
    const up = (event) => {
      pointers.delete(event.pointerId);
      if (pinch) {
        if (pinch.now && Math.abs(pinch.now / pinch.far - 1) > 0.1) zoomBy(pinch.now / pinch.far, ...pinch.at);
        pinch = null;
        return;
      }
      if (!drag) return;
      const [{ rule, moved, px, py }, [x, y]] = [drag, place(event)];
      drag = null;
      const box = plot.box;
      plot.box = null;
      if (rule && moved) { moveRule(rule, x, y, true); return; }
      if (box) { plot.overlay(); if (box[1] - box[0] > 6 && box[3] - box[2] > 6) zoomTo(box); return; }
      if (options.scrub && !nearest(plot, px, py, 12)) { options.scrub(plot.place.across.back(x), true); return; }
      if (moved) return;
      const at = nearest(plot, px, py, REACH[event.pointerType] || 18);
      plot.point(at, false);
      if (at && at.layer.motion && options.choose) options.choose(at.layer.motion(at.index));
      else if (!at && options.empty) options.empty(plot.place.across.back(px), plot.place.up.back(py));
    };
    canvas.addEventListener("pointerdown", down);
    canvas.addEventListener("pointermove", move);
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", () => { pointers.clear(); [drag, pinch, plot.box] = [null, null, null]; plot.overlay(); });
    canvas.addEventListener("pointerleave", () => { if (!drag && plot.at) plot.point(null, false); });
    canvas.addEventListener("dblclick", () => options.back && options.back());
    canvas.addEventListener("wheel", (event) => {
      // A plain wheel scrolls the page; with Ctrl (or a pinch on a touch pad) it zooms.
      if (!event.ctrlKey || !options.zoom || !plot.place) return;
      event.preventDefault();
      zoomBy(Math.exp(-event.deltaY / 300), ...place(event));
    }, { passive: false });
    canvas.addEventListener("blur", () => { if (plot.at) plot.point(null, false); });

    // Keys --------------------------------------------------------------------------------------------------------------
    const walk = (key) => {
      const sideways = key === "ArrowLeft" || key === "ArrowRight";
      const forward = key === "ArrowRight" || key === "ArrowUp" ? 1 : -1;
      const now = plot.at || { px: forward > 0 ? -1 : size()[0] + 1, py: size()[1] / 2 };
      let [best, least] = [null, Infinity];
      eachDatum(plot, (layer, index, px, py) => {
        const [dx, dy] = [(px - now.px) * (sideways ? forward : 1), (py - now.py) * (sideways ? 1 : -forward)];
        const [along, aside] = sideways ? [dx, Math.abs(dy)] : [dy, Math.abs(dx)];
        if (along <= 0.5) return;
        const far = along + 3 * aside;
        if (far < least) { best = { layer, index, px, py }; least = far; }
      });
      if (best) plot.point(best, true);
    };
    const nudge = (key) => {
      const rule = plot.scene.layers.find((layer) => layer && layer.kind === "rule" && layer.move);
      if (!rule) return false;
      const { across, up: rising } = plot.place;
      const by = key === "ArrowRight" || key === "ArrowUp" ? 1 : -1;
      const [px, py] = rule.x !== undefined ? [across(rule.x) + by * 2, 0] : [0, rising(rule.y) - by * 2];
      moveRule(rule, px, py, true);
      return true;
    };
    canvas.addEventListener("keydown", (event) => {
      if (!plot.place || event.ctrlKey || event.metaKey || event.altKey) return;
      const { box } = plot.place;
      const middle = plot.at ? [plot.at.px, plot.at.py] : [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
      const arrow = event.key.startsWith("Arrow");
      if (arrow && event.shiftKey && options.scrub) options.scrub(plot.place.across.back(plot.place.across(plot.line ?? plot.scene.x.range[0]) + (event.key === "ArrowRight" || event.key === "ArrowUp" ? 3 : -3)), true);
      else if (arrow && event.shiftKey && nudge(event.key)) { /* moved */ }
      else if (arrow) walk(event.key);
      else if ((event.key === "+" || event.key === "=") && options.zoom) zoomBy(2, ...middle);
      else if (event.key === "-" && options.zoom) zoomBy(0.5, ...middle);
      else if (event.key === "Escape") { if (plot.at) plot.point(null, false); else if (options.back) options.back(); }
      else if (event.key === "Enter" && plot.at && plot.at.layer.motion && options.choose) options.choose(plot.at.layer.motion(plot.at.index));
      else return;
      event.preventDefault();
    });
  };
})();

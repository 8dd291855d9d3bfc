// The verdict on a corner impact in words, and the numbers that it rests on. `local.js` shows both.
"use strict";
(() => {
  const { number, element: make } = Explore;

  Explore.verdict = {};
  const NAMES = { persistence: "Persistence", "nonsmooth-fold": "Nonsmooth fold", "nonsmooth-flip": "Nonsmooth flip", none: "No corner impact", refused: "No verdict" };
  /** A colour and a shape for each verdict; letters stand for them where there is room for one sign alone. */
  const LOOKS = {
    persistence: { colour: "blue", shape: "disc" }, "nonsmooth-fold": { colour: "vermilion", shape: "cross" }, "nonsmooth-flip": { colour: "purple", shape: "diamond" },
    refused: { colour: "gold", shape: "square" }, none: { colour: "grey", shape: "dot" },
  };
  Explore.verdict.names = NAMES;
  Explore.verdict.looks = LOOKS;

  /** The verdict of an answer of `verify`: `{ kind, speed, danger, minus, plus, flips, sentence }`. */
  Explore.verdict.of = (answer) => {
    if (!answer || answer.error || !answer.found || !answer.found.corner_impact) return { kind: "none", sentence: answer && answer.error ? answer.error.sentence : "" };
    const { classification, corner_impact: corner, refusal, conditions = [] } = answer.found;
    const value = (name) => (conditions.find((each) => each.name === name) || {}).value;
    const signs = { minus: value("det(I - A-)"), plus: value("det(I - A+)"), flips: [value("det(I + A-)"), value("det(I + A+)")] };
    if (!classification) return { kind: "refused", speed: corner.speed_rpm, ...signs, sentence: told(refusal) };
    return { kind: classification.scenario, speed: corner.speed_rpm, danger: classification.danger ? classification.danger.kind : null, ...signs };
  };
  const told = (refusal) => (typeof refusal === "string" ? refusal : refusal ? refusal.sentence || refusal.reason || Object.values(refusal).filter((each) => typeof each === "string").join(": ") : "");

  // In words ------------------------------------------------------------------------------------------------------------

  const SIDES = { minus: "before the corner", plus: "after it" };
  const stability = (found, side) => found.classification.stability[side] || (found.classification.stable[side] ? "stable" : "unstable");
  const scenario = (found) => {
    const { scenario: kind, fixed_points_exist_for: exist } = found.classification;
    const side = (which) => `the one that strikes ${SIDES[which]} is ${stability(found, which)}`;
    if (kind === "nonsmooth-fold") {
      const other = exist.minus === "faster" ? "slower" : "faster";
      return [`Two periodic motions meet at the corner and vanish together. Both exist at ${exist.minus} speeds: ${side("minus")}, ${side("plus")}. At ${other} speeds there is neither.`];
    }
    const crossing = `The periodic motion crosses the corner and persists: at ${exist.minus} speeds it strikes before the corner (${stability(found, "minus")}), at ${exist.plus} speeds after it (${stability(found, "plus")}).`;
    if (kind !== "nonsmooth-flip") return [crossing];
    const twice = (found.local_map || []).find((each) => each.period_two && each.period_two.admissible && each.speeds !== "critical");
    return [crossing, twice ? `An orbit of period two is born there. It exists at ${twice.speeds} speeds and is ${twice.period_two.stability}.` : "An orbit of period two is born there."];
  };
  const ENDS = { "fixed-point": "settle on the orbit", "period-two": "settle on the orbit", periodic: "settle on the orbit", chaotic: "are chaotic", escapes: "diverge", undecided: "are undecided" };
  /** Where the starts of the local map end, at faster and at slower speeds. */
  const endings = (found) => (found.local_map || []).filter((each) => each.speeds === "faster" || each.speeds === "slower").map((each) => {
    const parts = each.ends.map((end) => `${end.starts} ${ENDS[end.end] || end.end}${end.word ? ` ${end.word}` : ""}`);
    if (each.ends.length === 1) return `At ${each.speeds} speeds all ${parts[0].replace(/^\d+ /, `${each.starts} starts of the local map `)}.`;
    return `At ${each.speeds} speeds, of ${each.starts} starts of the local map ${parts.join(", ")}.`;
  });
  const KNOWN = { proved: "proved", computed: "computed", sampled: "sampled" };
  const danger = ({ danger: found }) => {
    if (!found) return [];
    const grows = found.diverges && found.diverges.word ? ` Motions from at least ${Math.floor(found.diverges.share_of_directions * 1000) / 10} % of the directions diverge along the sequence ${found.diverges.word}, by a factor of ${number(found.diverges.multiplier, 5)} per period (${KNOWN[found.diverges.known] || found.diverges.known}).` : "";
    if (found.kind === "dangerous") return [`Dangerous: the basin of the stable motion shrinks to nothing at the corner impact, although the motion stays stable (${KNOWN[found.known] || found.known}).${grows}`];
    return [`Several attractors meet at the corner impact: the smallest disturbance selects the one on which the motion settles (${KNOWN[found.known] || found.known}).${grows}`];
  };
  /** Sentences that say what happens at the corner impact. */
  Explore.verdict.words = (found) => {
    if (!found.classification) return [`There is no verdict. ${told(found.refusal)}`];
    return [...scenario(found), ...danger(found.classification), ...endings(found)];
  };
  /** The result in one line. */
  Explore.verdict.heading = (found) => {
    const { kind, speed, danger: is } = Explore.verdict.of({ found });
    return `${NAMES[kind] || kind}${is === "dangerous" ? ", and dangerous" : is ? ", with several attractors" : ""}, at ${number(speed, 9)} rpm`;
  };

  // In numbers -----------------------------------------------------------------------------------------------------------

  const DIGITS = 8;
  const cell = (value) => make("td", { class: "n" }, number(value, DIGITS));
  const matrix = (rows) => make("table", { class: "matrix" }, make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map(cell)))));
  const complex = ({ re, im }) => (im === 0 ? number(re, DIGITS) : `${number(re, DIGITS)} ${im < 0 ? "−" : "+"} ${number(Math.abs(im), DIGITS)} i`);
  const ROUTES = { closed_form: "closed form", variational: "variation along the orbit", finite_difference: "finite differences", least_squares: "a fit to simulations" };
  /** How a number is known: the routes that agree, and the largest difference between two of them. */
  const agreement = (found, quantity) => {
    const all = (found.agreement || []).filter((each) => each.quantity === quantity && Number.isFinite(each.max_rel_diff));
    if (!all.length) return "computed";
    const routes = [...new Set(all.flatMap((each) => each.routes))].map((each) => ROUTES[each] || each.replace(/_/g, " "));
    const most = Math.max(...all.map((each) => each.max_rel_diff));
    return `computed; ${routes.join(", ")} ${all.every((each) => each.agrees) ? "agree" : "DISAGREE"} to ${number(most, 1)}`;
  };
  /** The table of A, B and the eigenvalues of both sides, each with how it is known. */
  Explore.verdict.table = (found, units) => {
    const route = found.routes.closed_form || found.routes.variational || Object.values(found.routes)[0];
    const { minus, plus } = Explore.verdict.of({ found });
    const row = (name, value, known) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, value), make("td", { class: "how" }, known));
    const side = (which, sign, determinant) => [
      row(`A${sign}`, matrix(route[which].A), agreement(found, `A_${which}`)),
      row(`B${sign}`, matrix(route[which].B.map((each) => [each])), agreement(found, `B_${which}`)),
      row(`eigenvalues of A${sign}`, make("span", {}, ...found.eigenvalues[which].flatMap((each, index) => (index ? [make("br"), complex(each)] : [complex(each)]))), agreement(found, `eigenvalues_${which}`)),
      row(`det(I − A${sign})`, number(determinant, DIGITS), "computed; its sign decides"),
    ];
    return make("table", { class: "numbers-table" },
      make("caption", {}, `One revolution near the corner impact: x → A x + B δT, x is the deviation of position (${units.length || "m"}) and velocity (${units.velocity || "m/s"}), and δT the deviation of the period (s). − holds before the corner, + after it.`),
      make("thead", {}, make("tr", {}, make("th", {}, "number"), make("th", {}, "value"), make("th", {}, "how it is known"))),
      make("tbody", {}, ...side("minus", "⁻", minus), ...side("plus", "⁺", plus)));
  };
})();

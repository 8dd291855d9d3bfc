// Values of the figures, which stand packed beside them: each as the difference from the one before, in units of its last digit.
"use strict";
const figureValues = (() => {
  const known = new WeakMap();
  const column = ({ places, steps }) => {
    let sum = 0;
    const value = (step) => (sum += step) * 10 ** Math.max(-places, 0) / 10 ** Math.max(places, 0);
    return { places, of: steps.map((step) => (step === null ? NaN : value(step))) };
  };
  const cells = ({ grid: [x, y], rows, gaps, counts }) => {
    let cell = 0;
    const numbers = gaps.map((gap) => (cell += gap));
    const middles = (axis, index) => ({ places: axis.places, of: numbers.map((number) => axis.from + (index(number) + 0.5) * axis.each) });
    return { x: middles(x, (number) => Math.floor(number / rows)), y: middles(y, (number) => number % rows), count: { places: 0, of: counts } };
  };
  const series = ({ number, name, kind, ...values }) => {
    if (kind === "cell") return { number, name, kind, ...cells(values) };
    const columns = Object.entries(values).map(([part, of]) => [part, column(of)]);
    return { number, name, kind, ...Object.fromEntries(columns) };
  };
  const read = async (packed) => {
    const { panels } = JSON.parse(await unpacked(packed));
    return panels.map((panel) => ({ ...panel, series: panel.series.map(series) }));
  };
  // The panels of a figure of the page: axes, and columns of each series.
  return (figure) => {
    if (!known.has(figure)) known.set(figure, read(figure.querySelector(".save").dataset.packed));
    return known.get(figure);
  };
})();

const figureTable = (panels) => {
  const word = (text) => `"${text.replaceAll('"', '""')}"`;
  const head = ({ label, unit }) => (unit ? `${label} (${unit})` : label);
  const rows = ["panel,series,kind,x,y,count,width,height,panel_number,series_number"];
  panels.forEach((panel, index) => panel.series.forEach((series) => {
    const text = (part, row) => {
      const column = series[part];
      const value = column ? column.of[row] : part === "count" ? 1 : NaN;
      return Number.isNaN(value) ? "" : value.toFixed(Math.max(column?.places ?? 0, 0));
    };
    const heads = [word(`${head(panel.x)}, ${head(panel.y)}`), word(series.name), series.kind];
    series.x.of.forEach((_, row) => {
      const values = ["x", "y", "count", "width", "height"].map((part) => text(part, row));
      rows.push([...heads, ...values, index, series.number].join(","));
    });
  }));
  return rows.join("\n") + "\n";
};

// Each figure as a file: its drawing as SVG, its numbers as CSV, which stand packed beside it; and its drawing for a telephone.
"use strict";
(() => {
  const save = (name, type, text) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  const phone = matchMedia("(max-width: 40rem)");
  const narrow = () => {
    if (!phone.matches) return;
    document.querySelectorAll(".narrow[data-packed]").forEach(async (drawing) => {
      const packed = drawing.dataset.packed;
      drawing.removeAttribute("data-packed");
      drawing.innerHTML = await unpacked(packed);
    });
  };
  narrow();
  phone.addEventListener("change", narrow);
  document.querySelectorAll("figure[id] .save").forEach((buttons) => {
    const figure = buttons.closest("figure");
    const name = figure.id.replace("plate-", "");
    const button = (label, act) => {
      const made = document.createElement("button");
      made.type = "button";
      made.textContent = label;
      made.addEventListener("click", act);
      buttons.append(made);
    };
    button("Save as SVG", () => save(`${name}.svg`, "image/svg+xml", figure.querySelector(".broad svg").outerHTML));
    button("Data as CSV", async () => save(`${name}.csv`, "text/csv", await unpacked(buttons.dataset.packed)));
  });
})();

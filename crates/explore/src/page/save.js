// Saves what is seen: pictures, columns, the model file; copies commands and the link.
"use strict";
(() => {
  /** Saves text as a file of the reader's. */
  Explore.download = (name, text, kind) => {
    const address = URL.createObjectURL(new Blob([text], { type: kind }));
    const link = Explore.element("a", { href: address, download: name, hidden: true });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  };
  /** Copies text; where the clipboard is refused, as in some notebooks, the text is shown to be copied by hand. */
  Explore.copy = async (text, button) => {
    try {
      await navigator.clipboard.writeText(text);
      const before = button.textContent;
      button.textContent = "Copied";
      Explore.say(`Copied: ${text}`);
      setTimeout(() => { button.textContent = before; }, 1500);
    } catch {
      const field = Explore.element("textarea", { readonly: true, rows: 2, class: "copied", "aria-label": "Copy this text" });
      field.value = text;
      const old = button.parentElement.querySelector(".copied");
      if (old) old.remove();
      button.parentElement.append(field);
      field.focus();
      field.select();
    }
  };
  const stem = (app) => app.fileName().replace(/^.*[\\/]/, "").replace(/\.toml$/, "");

  /** The buttons under a panel: Save SVG, Save CSV, Copy as command. */
  Explore.saveButtons = (entry, app) => {
    const { view, panel, context, instance } = entry;
    const name = (extension) => `${stem(app)}-${view.name}.${extension}`;
    const nothing = () => Explore.say("There is nothing to save yet.");
    const svg = () => {
      const drawn = instance.svg ? [instance.svg()] : context.plots.filter(({ element }) => element.clientWidth).map((plot) => plot.svg());
      const files = drawn.filter(Boolean);
      const text = files.length > 1 ? Explore.stack(files) : files[0];
      if (text) Explore.download(name("svg"), text, "image/svg+xml"); else nothing();
    };
    const csv = () => {
      const answer = context.answer();
      const text = instance.csv ? instance.csv() : answer ? Explore.csv(answer.found) : null;
      if (text) Explore.download(name("csv"), text, "text/csv"); else nothing();
    };
    const command = (event) => {
      const answer = context.answer();
      const text = instance.command ? instance.command() : answer && answer.command;
      if (text) Explore.copy(text, event.currentTarget); else nothing();
    };
    panel.buttons.append(Explore.button("Save SVG", svg), Explore.button("Save CSV", csv), Explore.button("Copy as command", command, { title: "Command line that computes these results, digit for digit" }));
  };
  /** Saves the model file with the changes in it. */
  Explore.saveModel = (app) => {
    if (app.model) Explore.download(`${stem(app)}.toml`, app.model.text, "application/toml");
  };
})();

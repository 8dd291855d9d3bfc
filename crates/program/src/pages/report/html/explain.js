// A click on a number shows what it stands for: the part of the last section that has its name. Nothing here knows a number.
"use strict";
(() => {
  const dialog = document.createElement("dialog");
  dialog.id = "explained";
  document.body.append(dialog);
  const close = document.createElement("button");
  close.type = "button";
  close.textContent = "Close";
  close.autofocus = true;
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  document.getElementById("main").addEventListener("click", (event) => {
    // Numbers of figures are no elements of their own.
    const number = event.target.closest("data, [data-value], figure text");
    const about = number && !number.closest("#numbers") && number.closest("[data-about]");
    const source = about && document.getElementById(`explain-${about.dataset.about}`);
    if (!source || String(getSelection())) return;
    const copy = source.cloneNode(true);
    const title = document.createElement("h3");
    title.append(...copy.querySelector("summary").childNodes);
    copy.querySelector("summary").remove();
    dialog.replaceChildren(title, ...copy.childNodes, close);
    dialog.setAttribute("aria-label", title.textContent);
    dialog.showModal();
  });
})();

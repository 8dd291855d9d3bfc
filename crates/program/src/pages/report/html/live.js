// The live page in the place of the still picture: its scripts are unpacked, and its module when it is asked first.
"use strict";
(async () => {
  const [host, still] = ["explore-live", "explore-still"].map((id) => document.getElementById(id));
  const script = document.createElement("script");
  script.textContent = await unpacked(document.getElementById("explore-script").textContent);
  // In sight before it begins: what is not in sight is not computed.
  host.hidden = false;
  still.classList.add("replaced");
  document.body.append(script);

  // The first picture is over the speed: a click there takes the live page to that speed.
  const figure = document.querySelector("#answer figure");
  if (!figure) return;
  const hint = document.createElement("p");
  hint.className = "note";
  hint.textContent = "Click a speed in this picture to see its motion below.";
  figure.append(hint);
  figure.addEventListener("click", (event) => {
    const svg = event.target.closest("svg[viewBox]");
    if (!svg) return;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    svg.querySelectorAll("svg[data-x]").forEach((frame) => {
      const [left, top, width, height] = ["x", "y", "width", "height"].map((name) => Number(frame.getAttribute(name)));
      if (at.x < left || at.x > left + width || at.y < top || at.y > top + height) return;
      const [low, high] = frame.dataset.x.split(" ").map(Number);
      const rpm = low + ((high - low) * (at.x - left)) / width;
      Explore.app.assign("rpm", Math.round(10 * rpm) / 10);
      host.scrollIntoView({ block: "start", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
    });
  });
})();

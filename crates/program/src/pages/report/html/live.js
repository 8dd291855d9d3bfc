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
})();

// The ledger: verdicts by the style sheet, words by this, and how many are left. Nothing here knows a number.
"use strict";
(() => {
  const form = document.getElementById("ledger-filter");
  if (!form) return;
  const search = document.getElementById("ledger-search");
  const count = document.getElementById("ledger-count");
  const claims = Array.from(document.querySelectorAll(".claim"));
  const texts = claims.map((claim) => claim.textContent.toLowerCase());
  const verdict = () => form.querySelector("input[name=verdict]:checked").value;
  search.parentElement.hidden = false;

  const apply = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = verdict();
    let left = 0;
    claims.forEach((claim, index) => {
      const shown = (wanted === "all" || claim.dataset.verdict === wanted) && words.every((word) => texts[index].includes(word));
      claim.hidden = !shown;
      left += shown ? 1 : 0;
    });
    count.textContent = `${left} of ${claims.length} shown`;
  };
  // A link to a claim shows it, whatever the filter was.
  const follow = () => {
    const target = location.hash.startsWith("#claim-") && document.getElementById(location.hash.slice(1));
    if (!target || !target.hidden) return;
    document.getElementById("verdict-all").checked = true;
    search.value = "";
    apply();
    target.scrollIntoView();
  };
  form.addEventListener("input", apply);
  form.addEventListener("submit", (event) => event.preventDefault());
  window.addEventListener("hashchange", follow);
  apply();
  follow();
})();

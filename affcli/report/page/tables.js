"use strict";
(() => {
  /** Make the headings of a table sort it: numbers as numbers, words as words. */
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = head.textContent;
      head.replaceChildren(button);
      head.setAttribute("aria-sort", "none");
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        for (const other of heads) other.setAttribute("aria-sort", "none");
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const value = (row) => row.cells[column].dataset.sort ?? row.cells[column].textContent.trim();
        const rows = [...table.tBodies[0].rows];
        const numbers = rows.every((row) => !Number.isNaN(parseFloat(value(row))));
        const compared = (a, b) => numbers ? parseFloat(a) - parseFloat(b) : a.localeCompare(b, "en");
        // Equal ones keep their order both ways, so that one can sort by a second column.
        rows.sort((a, b) => (down ? -1 : 1) * compared(value(a), value(b)));
        table.tBodies[0].append(...rows);
      });
    });
  }
  for (const radio of document.querySelectorAll("input[name=sector]"))
    radio.addEventListener("change", () => {
      for (const arrow of document.querySelectorAll("#tools .arrow"))
        arrow.classList.toggle("dim", radio.value !== "all" && !arrow.classList.contains(radio.value));
    });
  /** A long list is folded, says so, and can be unfolded. */
  const fold = (list) => {
    const said = document.createElement("p"), button = document.createElement("button"), words = document.createTextNode("");
    const count = () => list.matches("ol") ? list.children.length : [...list.querySelectorAll("tbody tr")].filter((row) => !row.hidden).length;
    said.className = "more";
    button.type = "button";
    said.append(words, button);
    list.after(said);
    const look = () => {
      list.classList.remove("folded");
      said.hidden = list.scrollHeight < 30 * parseFloat(getComputedStyle(document.body).fontSize);
      list.classList.toggle("folded", !said.hidden && !list.unfolded);
      if (list.matches("ol")) list.tabIndex = list.matches(".folded") ? 0 : -1;
      words.textContent = list.unfolded ? "" : `${count()} in this list, which scrolls. `;
      button.textContent = list.unfolded ? "Show fewer" : `Show all ${count()}`;
    };
    button.addEventListener("click", () => { list.unfolded = !list.unfolded; look(); });
    list.addEventListener("changed", look);
    addEventListener("resize", look);
    look();
  };
  document.querySelectorAll(".tall").forEach(fold);
  /** One robot alone, or all of them. */
  const whose = document.getElementById("whose");
  const only = () => {
    for (const one of document.querySelectorAll("[data-robot]"))
      if (one instanceof SVGElement) one.style.opacity = whose.value && one.dataset.robot !== whose.value ? 0.12 : "";
      else one.hidden = Boolean(whose.value) && one.dataset.robot !== whose.value;
    for (const list of document.querySelectorAll(".tall")) list.dispatchEvent(new Event("changed"));
  };
  whose?.addEventListener("change", only);
  if (whose) only();
  /** What an arrow is, where the pointer rests on it. */
  for (const arrow of document.querySelectorAll(".arrow")) {
    const { part, used, row, trials } = arrow.dataset;
    const title = document.createElementNS(arrow.namespaceURI, "title");
    const sector = ["toward", "away", "left", "right"].find((name) => arrow.classList.contains(name));
    title.textContent = `row ${row ?? arrow.id.slice(4)}: puck nearest to the ${part}, moved ${sector}; ${used ?? "1/1"}` +
      (trials ? `; excluded in ${trials} trial${trials === "1" ? "" : "s"}` : "");
    arrow.append(title);
  }
  /** Paper has nothing to unfold; what was closed is closed again afterwards. */
  let unfolded = [];
  addEventListener("beforeprint", () => {
    unfolded = [...document.querySelectorAll("details:not([open])")];
    for (const closed of unfolded) closed.open = true;
  });
  addEventListener("afterprint", () => {
    for (const opened of unfolded) opened.open = false;
    unfolded = [];
  });
})();

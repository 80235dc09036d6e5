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

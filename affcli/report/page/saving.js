(() => {
  /** Let what the page shows be taken away: pictures as SVG, tables and data as CSV or JSON. */
  // What a look is where nothing says otherwise; only what differs is written.
  const LOOKS = { fill: "rgb(0, 0, 0)", stroke: "none", "stroke-width": "1px", "stroke-dasharray": "none", "stroke-linecap": "butt", "stroke-linejoin": "miter", opacity: "1", "marker-end": "none", visibility: "visible" };
  const OF_TEXT = { "font-size": "", "font-family": "", "text-anchor": "start" };
  const stem = document.title.split(": ").slice(1).join(": ").replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "-") || "affcli";

  function save(name, type, text) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = `${stem}-${name}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }
  function button(words, parent, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.className = "save";
    made.textContent = words;
    made.addEventListener("click", act);
    parent.append(made);
  }
  const csv = (rows) => rows.map((row) => row.map((cell) => {
    const text = String(cell ?? "").replaceAll("\u00ad", "");
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  }).join(",") + "\r\n").join("");

  /** A copy of a drawing that needs no style sheet, nor anything else of the page. */
  function alone(node) {
    const copy = node.cloneNode(true), originals = [node, ...node.querySelectorAll("*")];
    [copy, ...copy.querySelectorAll("*")].forEach((one, i) => {
      const looks = getComputedStyle(originals[i]);
      const usual = originals[i].localName === "text" ? { ...LOOKS, ...OF_TEXT } : LOOKS;
      const own = Object.keys(usual).map((name) => [name, looks.getPropertyValue(name).replaceAll('"', "'")]).filter(([name, look]) => look !== usual[name]);
      if (own.length) one.setAttribute("style", own.map((pair) => pair.join(":")).join(";"));
      for (const name of ["class", "role", "aria-label", "aria-labelledby", "data-part", "data-used", "data-row", "data-trials", "data-robot"]) one.removeAttribute(name);
    });
    for (const use of copy.querySelectorAll("use")) use.replaceWith(alone(document.querySelector(use.getAttribute("href"))));
    return copy;
  }
  function picture(of) {
    const NS = "http://www.w3.org/2000/svg", root = document.createElementNS(NS, "svg");
    const make = (name, attributes, parent, text = "") => {
      const node = document.createElementNS(NS, name);
      for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
      node.textContent = text;
      parent.append(node);
      return node;
    };
    // Taken away it is dark on light, whatever the page is.
    document.documentElement.classList.add("light");
    const drawn = [...of.querySelectorAll("svg")].filter((one) => one.viewBox.baseVal), across = Math.min(4, drawn.length);
    const [, , wide, high] = drawn[0].getAttribute("viewBox").split(" ").map(Number), width = drawn.length > 1 ? 260 : 640, height = Math.round((width * high) / wide);
    const whole = { width: across * (width + 10) + 10, height: Math.ceil(drawn.length / across) * (height + 30) + 10 };
    for (const [key, value] of Object.entries({ xmlns: NS, ...whole, viewBox: `0 0 ${whole.width} ${whole.height}` })) root.setAttribute(key, value);
    root.append(alone(document.getElementById("heads")));
    make("rect", { ...whole, fill: "#ffffff" }, root);
    drawn.forEach((one, i) => {
      const x = 10 + (i % across) * (width + 10), y = 10 + Math.floor(i / across) * (height + 30);
      const title = one.closest("figure")?.querySelector("figcaption").firstChild.textContent.trim() ?? document.getElementById("which").textContent;
      make("text", { x, y: y + 12, "font-size": 13, "font-family": "sans-serif" }, root, title);
      const copy = alone(one);
      for (const [key, value] of Object.entries({ x, y: y + 18, width, height })) copy.setAttribute(key, value);
      root.append(copy);
    });
    document.documentElement.classList.remove("light");
    return new XMLSerializer().serializeToString(root);
  }
  for (const of of document.querySelectorAll("[data-saved]"))
    button("Save as SVG", of.matches(".film") ? of.querySelector(".controls") : of.parentElement.insertBefore(document.createElement("div"), of.nextSibling),
      () => save(`${of.dataset.saved}.svg`, "image/svg+xml", picture(of)));

  const data = JSON.parse(document.getElementById("data")?.textContent ?? "null");
  const ROWS = ["run", "robot", "tool", "row", "behavior", "x_in", "y_in", "dx_in", "dy_in", "nearest_part", "times_successful", "times_used"];
  const rows = () => [...document.querySelectorAll("#tools .arrow")].map((arrow) => {
    const { run, robot, tool } = arrow.closest("details").dataset, { part, used } = arrow.dataset;
    return [run, robot, tool, arrow.id.slice(4), arrow.closest("figure").dataset.call, ...arrow.getAttribute("d").match(/-?\d+(\.\d+)?/g), part, ...(used ?? "1/1").split("/")];
  });
  const STEPS = ["trial", "step", "row", "behavior", "from_goal_in", "expected_from_goal_in", "repositioning_in", "expected_dx_in", "expected_dy_in", "seen_dx_in", "seen_dy_in",
    "replicated", "blocked", "excluded", "lost", "successful_before", "used_before", "successful_after", "used_after"];
  const steps = () => data.trials.flatMap((trial) => trial.steps.map((step, i) => [
    trial.id, i + 1, ...step.close[0].slice(0, 2), step.distance_to_goal, ...step.close[0].slice(2, 4), ...step.expected.slice(0, 2), ...step.seen.slice(0, 2),
    ...[step.replicated, step.blocked, step.excluded, step.lost].map((is) => (is === null ? "" : Number(is))), ...step.before, ...step.after]));
  const shown = (table) => [...table.rows].map((row) => [...row.cells].map((cell) => (cell.querySelector(".choose")?.lastChild ?? cell).textContent.replace(/\s+/g, " ").trim()));

  const box = document.getElementById("taken");
  box.hidden = false;
  button("Rows (CSV)", box, () => save("rows.csv", "text/csv", csv([ROWS, ...rows()])));
  if (data) button("Steps (CSV)", box, () => save("steps.csv", "text/csv", csv([STEPS, ...steps()])));
  for (const table of document.querySelectorAll("main .scroll > table")) {
    const name = table.parentElement.getAttribute("aria-label").replace(/ \(.*/, "");
    button(`${name} (CSV)`, box, () => save(`${name.toLowerCase().replace(/\W+/g, "-")}.csv`, "text/csv", csv(shown(table))));
  }
  button("Rows, trials, steps and films (JSON)", box, () => save("page.json", "application/json",
    JSON.stringify({ rows: rows().map((row) => Object.fromEntries(ROWS.map((name, i) => [name, row[i]]))), ...data })));
})();

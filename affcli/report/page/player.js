"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const RATE = 15; // frames a robot second
  // The boxes of Fig. 7 before a row is used: the paper's searches, or one for another planner.
  const NESTED = ["observe", "over", "reach", "s1", "s2", "s3", "s4"], OTHER = ["observe", "over", "reach", "choose"];
  const words = (name, value) => name === "nearest" ? `${+(100 * value).toFixed(1)} %` : value === 0.5 ? "1/2" : String(value);
  const NAMES = {
    consistent: () => "1: seen with these colours", probable: (value) => `2: probability over ${words("probable", value)}`,
    reachable: () => "in the arm's reach", nearest: (value) => `3: best ${words("nearest", value)} by expected distance`,
  };
  const LIT = 140; // milliseconds that each box is lit for while a row is chosen, at 4x
  const COMPARED = 500; // and the last one, at the end of a step
  const end = () => ({ solved: "over", "attractor out of reach": "reach", "no row left": searches().at(-1), "no plan found": searches().at(-1) })[trial.outcome]; // the box where a trial ends
  const SVG = "http://www.w3.org/2000/svg";

  /** Undo report/page/films.packed. */
  function unpacked(text, unit) {
    const values = [];
    let now = 0;
    for (const word of text.split(",")) {
      const zeros = word[0] === "~" ? Number(word.slice(1)) : 0;
      if (!zeros) now += Number(word);
      for (let i = 0; i < Math.max(1, zeros); i++) values.push(now * unit);
    }
    return values;
  }

  const make = (name, attributes, parent) => {
    const node = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    parent.append(node);
    return node;
  };
  const html = (name, text = "", kind = "") => {
    const node = document.createElement(name);
    node.textContent = text;
    if (kind) node.className = kind;
    return node;
  };
  const nested = () => trial.planner.split(/[:@]/)[0] === "nested-query";
  const searches = () => nested() ? NESTED : OTHER;
  const steps = (count) => `${count} step${count === 1 ? "" : "s"}`;

  const svg = byId("table"), rows = [...byId("list").tBodies[0].rows].filter((row) => row.matches(".filmed")); // as the trials are in the data
  let trial, world, film, way, starts, frame, timer, drawn;

  /** Choose a trial: unpack its film, draw what does not move, list its steps. */
  function choose(index) {
    stop();
    trial = data.trials[index];
    world = data.worlds[trial.world];
    film = Object.fromEntries(Object.entries(trial.film).map(([k, v]) => [k, unpacked(v, data.unit)]));
    way = film.x.map((x, i) => `${x.toFixed(2)},${film.y[i].toFixed(2)}`);
    starts = [];
    let at = 0;
    for (const step of trial.steps) {
      starts.push(at);
      at += step.frames;
    }
    draw();
    list();
    for (const box of byId("flow").children)
      box.hidden = nested() ? box.dataset.box === "choose" : /^s\d$/.test(box.dataset.box);
    for (const { name, value } of trial.steps[0]?.reasons ?? []) {
      const shown = byId("flow").querySelector(`[data-value="${CSS.escape(name)}"]`);
      if (shown && value !== null) shown.textContent = words(name, value);
    }
    const planner = trial.planner === "nested-query" ? "" : `, planner ${trial.planner}`;
    const tasks = trial.tasks === "extension-of-reach" ? "" : `, tasks ${trial.tasks}`;
    const broken = trial.shape === trial.tool ? "" : `, truly the ${trial.shape} (nobody told the robot)`;
    const same = trial.equal ? "" : " This replay DIFFERS from its record.";
    byId("which").textContent =
      `Trial ${trial.id}: ${trial.tool}${broken}, goal ${trial.goal}, start ${trial.start}${tasks}${planner}: ` +
      `${trial.outcome} after ${steps(trial.steps.length)}.${same}`;
    byId("scrub").max = Math.max(0, film.x.length - 1);
    byId("player").hidden = false;
    rows.forEach((row, i) => row.classList.toggle("chosen", i === index));
    show(0);
  }

  const outlines = (parts, parent, look) =>
    parts.map((points) => make("polygon", { points, ...look }, parent));

  function draw() {
    svg.replaceChildren();
    const [left, bottom, width, height] = world.view;
    svg.setAttribute("viewBox", `${left} ${-bottom - height} ${width} ${height}`);
    const flip = make("g", { transform: "scale(1,-1)" }, svg);
    const t = world.table;
    make("rect", { class: "top", x: t.left, y: t.near, width: t.right - t.left, height: t.far - t.near }, flip);
    if (trial.region) {
      make("polygon", { class: "goal", points: trial.region }, flip);
      const corners = trial.region.split(" ").map((corner) => corner.split(",").map(Number));
      const x = Math.min(...corners.map((c) => c[0])), y = Math.max(...corners.map((c) => c[1]));
      make("text", { class: "label", x: x + 0.3, y: -y + 1.2 }, svg).textContent = /^\d+$/.test(trial.goal) ? `G${trial.goal}` : trial.goal;
    }
    make("text", { class: "label", x: 0, y: -bottom - 0.5, "text-anchor": "middle" }, svg).textContent = "the robot stands here";
    const ghosts = make("g", {}, flip);
    const path = make("polyline", { class: "path" }, flip);
    const missing = trial.held.map((one) => {
      const group = make("g", {}, flip);
      outlines(one.missing, group, { class: "missing" });
      return group;
    });
    const puck = make("g", {}, flip);
    make("circle", { class: "puck", r: world.puck }, puck);
    make("line", { class: "mark", x2: world.puck }, puck);
    // The tool has the colour of the one the robot believes to hold; a new grasp is a new outline.
    const tools = trial.held.map((one) => {
      const group = make("g", {}, flip);
      outlines(one.parts, group, { class: "held", fill: trial.color });
      make("path", { class: "grasp", d: "M-.6 0H.6M0-.6V.6" }, group);
      return group;
    });
    const expected = make("path", { class: "expected", "marker-end": "url(#head-away)" }, flip);
    const seen = make("path", { class: "seen", "marker-end": "url(#head-seen)" }, flip);
    const marker = make("marker", { id: "head-seen", viewBox: "0 0 6 6", refX: 5, refY: 3, markerWidth: 4, markerHeight: 4, orient: "auto" }, make("defs", {}, svg));
    make("path", { d: "M0 .6L6 3L0 5.4z", fill: "currentColor" }, marker);
    drawn = { path, missing, puck, tools, expected, seen, ghosts };
  }

  const stepAt = (f) => {
    let i = starts.length - 1;
    while (i > 0 && starts[i] > f) i--;
    return i;
  };

  function list() {
    byId("count").textContent = steps(trial.steps.length);
    byId("steps").replaceChildren(...trial.steps.map((step, i) => {
      const item = html("li");
      const button = html("button");
      button.type = "button";
      const verdict = step.replicated ? html("span", "as expected", "yes") : html("span", step.blocked ? "blocked" : "not as expected", "no");
      button.append(`${i + 1}. ${step.close[0][1]}: `, verdict, step.excluded ? ", row excluded" : "");
      button.addEventListener("click", () => {
        stop();
        show(starts[i]);
        byId("why").scrollIntoView({ block: "nearest" });
      });
      item.append(button);
      return item;
    }));
    byId("steps").dispatchEvent(new Event("changed"));
  }

  function lit(names) {
    for (const box of byId("flow").children) {
      const on = names.includes(box.dataset.box);
      box.classList.toggle("lit", on);
      if (on) box.setAttribute("aria-current", "step"); else box.removeAttribute("aria-current");
    }
  }

  /** Show one frame; at the beginning of a step all searches are lit. */
  function show(f) {
    const last = film.x.length - 1;
    frame = Math.min(last, Math.max(0, f));
    const x = film.x[frame], y = film.y[frame], wx = film.wx[frame], wy = film.wy[frame];
    drawn.puck.setAttribute("transform", `translate(${x} ${y}) rotate(${(film.a[frame] * 180) / Math.PI})`);
    const at = `translate(${wx} ${wy}) rotate(${(film.wa[frame] * 180) / Math.PI})`, held = Math.round(film.held[frame] / data.unit);
    for (const groups of [drawn.tools, drawn.missing])
      groups.forEach((group, i) => {
        group.setAttribute("transform", at);
        group.setAttribute("visibility", i === held ? "visible" : "hidden");
      });
    for (const part of svg.querySelectorAll(".held")) part.classList.toggle("lifted", film.lift[frame] > 0.01);
    drawn.path.setAttribute("points", way.slice(0, frame + 1).join(" "));
    byId("scrub").value = frame;
    if (!trial.steps.length) {
      byId("why").replaceChildren(html("h3", "No step was taken"), ending());
      delete byId("why").dataset.step;
      lit(end() ? [end()] : []);
      now("the beginning");
      return;
    }
    const i = stepAt(frame), step = trial.steps[i], inStep = frame - starts[i];
    const first = inStep === 0, ended = inStep === step.frames - 1;
    const arrow = (node, [dx, dy, words], on) => node.setAttribute("d", on && words !== "none" ? `M${step.at[0]} ${step.at[1]}l${dx} ${dy}` : "");
    arrow(drawn.expected, step.expected, true);
    ahead(i);
    arrow(drawn.seen, step.seen, ended);
    let phase = inStep < step.placed ? "position wrist" : step.close[0][1];
    let boxes = [inStep < step.placed ? "place" : "explore"];
    if (first) { boxes = searches(); phase = "choose a row"; }
    if (ended) { boxes = ["compare"]; phase = "compare"; }
    if (ended && i === trial.steps.length - 1) {
      const box = end();
      boxes = box ? ["compare", box] : ["compare"];
      phase = `the end: ${trial.outcome}`;
    }
    lit(boxes);
    now(`step ${i + 1} of ${trial.steps.length}, ${phase}`);
    if (byId("why").dataset.step !== `${trial.id}/${i}`) why(i);
    [...byId("steps").querySelectorAll("button")].forEach((button, k) => {
      if (k !== i) return button.removeAttribute("aria-current");
      if (button.hasAttribute("aria-current")) return;
      button.setAttribute("aria-current", "step");
      // The list alone is scrolled, never the page.
      const list = byId("steps"), top = button.offsetTop - list.offsetTop;
      if (top < list.scrollTop || top + button.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top - list.clientHeight / 3;
    });
  }

  const plansOf = (step) => step.reasons.filter(({ moves }) => moves);

  /** Show where the plan of step i should leave the puck, move by move. */
  function ahead(i) {
    if (drawn.ghosts.dataset.step === String(i)) return;
    drawn.ghosts.dataset.step = String(i);
    drawn.ghosts.replaceChildren();
    for (const { x, y } of plansOf(trial.steps[i])[0]?.moves ?? []) make("circle", { class: "ghost", cx: x, cy: y, r: world.puck }, drawn.ghosts);
  }

  /** Say what a planner that looks ahead weighed in a step; nothing for another. */
  function plans(step) {
    const told = plansOf(step).map(({ name, value, moves }) => html("li", `${name}: ` +
      moves.map(({ behavior, x, y }) => `${behavior} to (${x.toFixed(1)}, ${y.toFixed(1)})`).join(", ") +
      (value === null ? "" : `; ${value.toFixed(1)} steps to the goal`)));
    if (!told.length) return [];
    const list = html("ul", "", "plans");
    list.append(...told);
    return [list];
  }

  function now(words) {
    byId("now").textContent = `Now: ${words}; ${(frame / RATE).toFixed(1)} s of the robot's time.`;
    byId("scrub").setAttribute("aria-valuetext", words);
  }

  function ending() {
    const rows = trial.failure ? `; ${trial.failure}` : trial.left?.length ? `; rows left: ${trial.left.join(", ")}` : "";
    return html("p", `The trial ended: ${trial.outcome}${rows}.`);
  }

  /** Say why the row of step i was chosen, and what came of it. */
  function why(i) {
    const step = trial.steps[i], [id, behavior, ends, travel] = step.close[0];
    const box = byId("why");
    box.dataset.step = `${trial.id}/${i}`;
    const funnel = html("table", "", "funnel");
    funnel.append(html("caption", nested() ? "Rows that each search left" : "What the planner went by"));
    const most = Math.max(1, ...step.reasons.map((reason) => reason.rows ?? 0));
    const reasons = step.reasons.filter(({ moves }) => !moves).map(({ name, rows, value }) => [nested() && NAMES[name] ? NAMES[name](value) : name, rows, value]);
    for (const [name, count, value] of [...reasons, [nested() ? "4: least re-positioning" : "chosen", 1, null]]) {
      const row = funnel.insertRow();
      const head = html("th", name);
      head.scope = "row";
      row.append(head, html("td", String(count ?? (value === null ? "" : +value.toPrecision(3)))));
      if (count === null) continue;
      const bar = html("i");
      bar.style.width = `${(100 * count) / most}%`;
      row.insertCell().append(bar);
    }
    const others = html("table");
    others.append(html("caption", "Chosen, and what came close"));
    const top = others.createTHead().insertRow();
    for (const name of ["row", "behavior", "wrist travels, in", "ends from goal, in", "proba\u00adbility"]) {
      const head = html("th", name);
      head.scope = "col";
      top.append(head);
    }
    const body = others.createTBody();
    step.close.forEach(([row, call, end, repositioning, probability], k) => {
      const line = body.insertRow();
      const head = html("th"), link = html("a", String(row));
      link.href = `#row-${row}`;
      link.title = "Show it over the tool";
      head.append(link, k ? "" : " (chosen)");
      head.scope = "row";
      line.append(head);
      for (const text of [call, repositioning, end, probability]) line.append(html("td", text));
    });
    const nearest = step.reasons.find((reason) => reason.name === "nearest")?.rows;
    const reason = nested() && nearest
      ? `of the ${nearest} row${nearest === 1 ? "" : "s"} that should leave the puck nearest the goal it needs the least re-positioning, ${travel} in.`
      : `chosen by ${trial.planner}; the wrist travels ${travel} in.`;
    const hold = step.hold ? ` The tool was grasped anew first: ${step.hold}.` : "";
    const lead = html("p", `Row ${id}, ${behavior}: ${reason} The puck is ${step.distance_to_goal?.toFixed(1)} in from the goal's centre and should end ${ends} in from it.${hold}`, "answer");
    const outcome = html("p");
    const word = step.blocked ? "blocked: the tool would have come down on the puck, counted as a failure" : step.replicated ? "as expected (within 40 degrees)" : "not as expected";
    outcome.append(`Expected ${step.expected[2]}, seen ${step.seen[2]}: `, html("span", word, step.replicated ? "yes" : "no"),
      `. Successes/uses ${step.before.join("/")} before, ${step.after.join("/")} after${step.excluded ? ": excluded from now on" : ""}.` +
      (step.lost ? ` In truth the ${trial.shape} cannot do it.` : ""));
    const scroll = html("div", "", "scroll");
    scroll.tabIndex = 0;
    scroll.setAttribute("role", "region");
    scroll.setAttribute("aria-label", "Rows that came close");
    scroll.append(others);
    box.replaceChildren(html("h3", `Step ${i + 1}: why this row?`), lead, funnel, ...plans(step), scroll, outcome);
    if (i === trial.steps.length - 1) box.append(ending());
    if (timer === undefined) byId("said").textContent = `Step ${i + 1}: row ${id}, ${behavior}, ${word}`;
  }

  function stop() {
    cancelAnimationFrame(timer);
    timer = undefined;
    byId("play").textContent = "Play";
  }

  function play() {
    if (timer !== undefined) return stop();
    if (frame >= film.x.length - 1) show(0);
    byId("play").textContent = "Pause";
    // Between frames there is time to think: each search is lit in turn, then what is compared.
    let last = performance.now(), due = 0, searching = frame === starts[stepAt(frame)] ? last : 0, until = 0;
    const tick = (time) => {
      timer = requestAnimationFrame(tick);
      const speed = Number(byId("speed").value), slower = Math.min(2, 4 / speed);
      if (searching) {
        const box = Math.max(0, Math.floor((time - searching) / (LIT * slower)));
        if (box < searches().length) { lit([searches()[box]]); last = time; return; }
        searching = 0;
      }
      if (time < until) { last = time; return; }
      due += ((time - last) / 1000) * RATE * speed;
      last = time;
      for (; due >= 1; due--) {
        if (frame >= film.x.length - 1) return stop();
        show(frame + 1);
        const i = stepAt(frame);
        if (frame === starts[i]) { searching = time; due = 0; return; }
        if (frame === starts[i] + trial.steps[i].frames - 1) { until = time + COMPARED * slower; due = 0; return; }
      }
    };
    timer = requestAnimationFrame(tick);
  }

  function go(by) {
    stop();
    if (!trial.steps.length) return;
    const i = stepAt(frame);
    const to = by < 0 && frame > starts[i] ? i : i + by;
    show(to >= starts.length ? film.x.length - 1 : starts[Math.max(0, to)]);
  }

  byId("play").addEventListener("click", play);
  byId("back").addEventListener("click", () => go(-1));
  byId("on").addEventListener("click", () => go(1));
  byId("scrub").addEventListener("input", (event) => { stop(); show(Number(event.target.value)); });
  byId("player").tabIndex = -1;
  byId("player").addEventListener("keydown", (event) => {
    const field = ["INPUT", "SELECT"].includes(event.target.tagName);
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const keys = {
      ArrowLeft: () => go(-1), ArrowRight: () => go(1), ",": () => { stop(); show(frame - 1); }, ".": () => { stop(); show(frame + 1); },
      Home: () => { stop(); show(0); }, End: () => { stop(); show(film.x.length - 1); },
    };
    if (event.target.tagName !== "BUTTON") keys[" "] = play;
    if (field && event.target.id !== "scrub") return;
    if (event.target.id === "scrub" && event.key !== " ") return; // the slider has its own keys
    const act = keys[event.key];
    if (act) { event.preventDefault(); act(); }
  });
  rows.forEach((row, index) => {
    const head = row.cells[0], button = html("button", "", "choose");
    button.type = "button";
    button.append(html("span", "Replay "), head.textContent);
    button.addEventListener("click", () => {
      choose(index);
      byId("player").scrollIntoView({ block: "start" });
      byId("player").focus({ preventScroll: true });
    });
    head.replaceChildren(button);
  });
  // A row's number leads to its arrow, in a tool that may be folded up.
  byId("why").addEventListener("click", (event) => {
    const arrow = event.target.hash && document.querySelector(event.target.hash);
    if (!arrow) return;
    stop();
    arrow.closest("details").open = true;
  });
  choose(data.first);
})();

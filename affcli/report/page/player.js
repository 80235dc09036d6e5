"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const RATE = 15; // frames a robot second
  const SEARCHES = ["observe", "over", "reach", "s1", "s2", "s3", "s4"];
  const LIT = 140; // milliseconds that each box is lit for while a row is chosen, at 4x
  const COMPARED = 500; // and the last one, at the end of a step
  const END = { solved: "over", "attractor out of reach": "reach", "no row left": "s4" }; // the box where a trial ends
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
  const steps = (count) => `${count} step${count === 1 ? "" : "s"}`;

  const svg = byId("table"), rows = [...byId("list").tBodies[0].rows]; // as the trials are in the data
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
    const broken = trial.shape === trial.tool ? "" : `, truly the ${trial.shape} (nobody told the robot)`;
    const same = trial.equal ? "" : " This replay DIFFERS from its record.";
    byId("which").textContent =
      `Trial ${trial.id}: ${trial.tool}${broken}, goal ${trial.goal}, start ${trial.start}: ` +
      `${trial.outcome} after ${steps(trial.steps.length)}.${same}`;
    byId("scrub").max = Math.max(0, film.x.length - 1);
    byId("player").hidden = false;
    rows.forEach((row, i) => row.classList.toggle("chosen", i === index));
    show(0);
  }

  const outlines = (parts, parent, look) =>
    parts.map((points) => make("polygon", { points: points.map((p) => p.join(",")).join(" "), ...look }, parent));

  function draw() {
    svg.replaceChildren();
    const [left, bottom, width, height] = world.view;
    svg.setAttribute("viewBox", `${left} ${-bottom - height} ${width} ${height}`);
    const flip = make("g", { transform: "scale(1,-1)" }, svg);
    const t = world.table;
    make("rect", { class: "top", x: t.left, y: t.near, width: t.right - t.left, height: t.far - t.near }, flip);
    if (trial.region) {
      const [x, y, half] = trial.region;
      make("rect", { class: "goal", x: x - half, y: y - half, width: 2 * half, height: 2 * half }, flip);
      make("text", { class: "label", x: x - half + 0.3, y: -(y + half) + 1.2 }, svg).textContent = `G${trial.goal}`;
    }
    make("text", { class: "label", x: 0, y: -bottom - 0.5, "text-anchor": "middle" }, svg).textContent = "the robot stands here";
    const path = make("polyline", { class: "path" }, flip);
    const missing = make("g", {}, flip);
    const believed = world.tools[trial.tool], held = world.tools[trial.shape];
    const gone = Object.entries(believed.parts).filter(([name]) => !(name in held.parts));
    outlines(gone.map(([, points]) => points), missing, { class: "missing" });
    const puck = make("g", {}, flip);
    make("circle", { class: "puck", r: world.puck }, puck);
    make("line", { class: "mark", x2: world.puck }, puck);
    const tool = make("g", {}, flip);
    // The tool has the colour of the one the robot believes to hold.
    const parts = outlines(Object.values(held.parts), tool, { class: "held", fill: believed.color });
    make("path", { class: "grasp", d: "M-.6 0H.6M0-.6V.6" }, tool);
    const expected = make("path", { class: "expected", "marker-end": "url(#head-away)" }, flip);
    const seen = make("path", { class: "seen", "marker-end": "url(#head-seen)" }, flip);
    const marker = make("marker", { id: "head-seen", viewBox: "0 0 6 6", refX: 5, refY: 3, markerWidth: 4, markerHeight: 4, orient: "auto" }, make("defs", {}, svg));
    make("path", { d: "M0 .6L6 3L0 5.4z", fill: "currentColor" }, marker);
    drawn = { path, missing, puck, tool, parts, expected, seen };
  }

  const stepAt = (f) => {
    let i = starts.length - 1;
    while (i > 0 && starts[i] > f) i--;
    return i;
  };

  function list() {
    byId("steps").replaceChildren(...trial.steps.map((step, i) => {
      const item = html("li");
      const button = html("button");
      button.type = "button";
      const verdict = step.replicated ? html("span", "as expected", "yes") : html("span", step.blocked ? "blocked" : "not as expected", "no");
      button.append(`${i + 1}. ${step.close[0][1]}: `, verdict, step.died ? ", row excluded" : "");
      button.addEventListener("click", () => {
        stop();
        show(starts[i]);
        byId("why").scrollIntoView({ block: "nearest" });
      });
      item.append(button);
      return item;
    }));
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
    drawn.tool.setAttribute("transform", `translate(${wx} ${wy})`);
    drawn.missing.setAttribute("transform", `translate(${wx} ${wy})`);
    for (const part of drawn.parts) part.classList.toggle("lifted", film.lift[frame] > 0.01);
    drawn.path.setAttribute("points", way.slice(0, frame + 1).join(" "));
    byId("scrub").value = frame;
    if (!trial.steps.length) {
      byId("why").replaceChildren(html("h3", "No step was taken"), ending());
      delete byId("why").dataset.step;
      lit(END[trial.outcome] ? [END[trial.outcome]] : []);
      now("the beginning");
      return;
    }
    const i = stepAt(frame), step = trial.steps[i], inStep = frame - starts[i];
    const first = inStep === 0, ended = inStep === step.frames - 1;
    const arrow = (node, [dx, dy, words], on) => node.setAttribute("d", on && words !== "none" ? `M${step.at[0]} ${step.at[1]}l${dx} ${dy}` : "");
    arrow(drawn.expected, step.expected, true);
    arrow(drawn.seen, step.seen, ended);
    let phase = inStep < step.placed ? "position wrist" : step.close[0][1];
    let boxes = [inStep < step.placed ? "place" : "explore"];
    if (first) { boxes = SEARCHES; phase = "choose a row"; }
    if (ended) { boxes = ["compare"]; phase = "compare"; }
    if (ended && i === trial.steps.length - 1) {
      const box = END[trial.outcome];
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

  function now(words) {
    byId("now").textContent = `Now: ${words}; ${(frame / RATE).toFixed(1)} s of the robot's time.`;
    byId("scrub").setAttribute("aria-valuetext", words);
  }

  function ending() {
    const rows = trial.left ? `; the searches left ${trial.left.join(", ")} rows` : "";
    return html("p", `The trial ended: ${trial.outcome}${rows}.`);
  }

  /** Say why the row of step i was chosen, and what came of it. */
  function why(i) {
    const step = trial.steps[i], [id, behavior, ends, travel] = step.close[0];
    const box = byId("why");
    box.dataset.step = `${trial.id}/${i}`;
    const funnel = html("table", "", "funnel");
    funnel.append(html("caption", "Rows that each search left"));
    const names = ["1: seen with these colours", "2: probability over 1/2", "in the arm's reach", "3: best 20 % by expected distance", "4: least re-positioning"];
    [...step.left, 1].forEach((count, k) => {
      const row = funnel.insertRow();
      const head = html("th", names[k]);
      head.scope = "row";
      const bar = html("i");
      bar.style.width = `${(100 * count) / Math.max(1, step.left[0])}%`;
      row.append(head, html("td", String(count)));
      row.insertCell().append(bar);
    });
    const others = html("table");
    others.append(html("caption", "Chosen, and what came close in search 4"));
    const top = others.createTHead().insertRow();
    for (const name of ["row", "behavior", "wrist travels", "ends from goal", "probability"]) {
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
      for (const text of [call, `${repositioning} in`, `${end} in`, probability]) line.append(html("td", text));
    });
    const lead = html("p", `Row ${id}, ${behavior}: of the ${step.left[3]} row${step.left[3] === 1 ? "" : "s"} that should leave the puck nearest the goal it needs the least re-positioning, ${travel} in. The puck is ${step.toGoal} in from the goal's centre and should end ${ends} in from it.`, "answer");
    const outcome = html("p");
    const word = step.blocked ? "blocked: the tool would have come down on the puck, counted as a failure" : step.replicated ? "as expected (within 40 degrees)" : "not as expected";
    outcome.append(`Expected ${step.expected[2]}, seen ${step.seen[2]}: `, html("span", word, step.replicated ? "yes" : "no"),
      `. Successes/uses ${step.before.join("/")} before, ${step.after.join("/")} after${step.died ? ": excluded from now on" : ""}.` +
      (step.lost ? ` In truth the ${trial.shape} cannot do it.` : ""));
    const scroll = html("div", "", "scroll");
    scroll.tabIndex = 0;
    scroll.setAttribute("role", "region");
    scroll.setAttribute("aria-label", "Rows that came close");
    scroll.append(others);
    box.replaceChildren(html("h3", `Step ${i + 1}: why this row?`), lead, funnel, scroll, outcome);
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
        if (box < SEARCHES.length) { lit([SEARCHES[box]]); last = time; return; }
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

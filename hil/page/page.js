// Plays a run again: everything is drawn from the data in the page, for any moment of it.
"use strict";

(async () => {
  const $ = (id) => document.getElementById(id);
  const SVG = "http://www.w3.org/2000/svg";
  const PX_PER_M = 100;

  // ---- The data

  let run;
  try {
    const packed = Uint8Array.from(atob($("run").textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    run = JSON.parse(await new Response(stream).text());
  } catch (error) {
    notice(
      "DecompressionStream" in window
        ? `The data of this page cannot be read: ${error.message}`
        : "This page needs a browser of 2023 or later.",
    );
    return;
  }
  const HZ = run.hz;

  // A column of differences as values.
  function sums(column, scale = 1) {
    let sum = 0;
    return Float64Array.from(column, (more) => (sum += more) / scale);
  }

  // How many of the times are not after `t`.
  function count(times, t) {
    let low = 0;
    let high = times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  const seconds = (cycles, digits = 3) => `${(cycles / HZ).toFixed(digits)} s`;

  function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key === "class") element.className = value;
      else if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
      else element.setAttribute(key, value);
    }
    element.append(...children);
    return element;
  }

  function draw(name, css, parent) {
    const element = document.createElementNS(SVG, name);
    if (css) element.setAttribute("class", css);
    parent.append(element);
    return element;
  }

  function setText(element, text) {
    if (element.textContent !== text) element.textContent = text;
  }

  function notice(text) {
    $("notice").hidden = false;
    $("notice").append(make("div", {}, text));
  }

  for (const [what, cycles] of run.full) notice(`More than a page holds: ${what} is shown up to ${seconds(cycles)}.`);

  // ---- Time

  const views = [];
  let now = 0;
  let playing = false;
  let last = 0;

  function show() {
    for (const view of views) view(now);
  }

  function goTo(cycles) {
    now = Math.min(Math.max(cycles, 0), run.end);
    show();
  }

  function play(on) {
    if (on && now >= run.end) now = 0;
    playing = on;
    if (!on) show();
    $("play").setAttribute("aria-label", on ? "pause" : "play");
    $("play-icon").setAttribute("d", on ? "M2 1h4v14H2zM10 1h4v14h-4z" : "M3 1l11 7-11 7z");
    last = 0;
    if (on) requestAnimationFrame(step);
  }

  function step(stamp) {
    if (!playing) return;
    const passed = last ? (Math.min(stamp - last, 100) / 1000) * Number($("speed").value) * HZ : 0;
    last = stamp;
    if (now + passed >= run.end) play(false);
    goTo(now + passed);
    if (playing) requestAnimationFrame(step);
  }

  // ---- Play, scrub

  const scene = run.scene;
  const findings = run.findings;
  // What the source accepts is counted by itself, and not with its severity.
  const kindOf = (each) => (each.accepted ? "accepted" : each.severity);
  const accepted = (each) => (each.accepted ? `accepted in the source: ${each.accepted}` : "");
  const byTime = [...findings].sort((a, b) => a.t - b.t);
  const lines = { ...run.lines, t: sums(run.lines.t) };
  const isOrder = (index) => lines.received[lines.pin[index]];
  // Speeds that are sent many times a second are no marks.
  const orders = [...lines.t.keys()].filter((n) => isOrder(n) && !lines.text[n].startsWith("#SETR"));

  function neighbour(way) {
    const found = way > 0 ? byTime.find((each) => each.t > now) : byTime.findLast((each) => each.t < now);
    if (found) pick(found);
  }

  $("play").addEventListener("click", () => play(!playing));
  $("before").addEventListener("click", () => neighbour(-1));
  $("after").addEventListener("click", () => neighbour(1));
  $("scrub").max = run.end / HZ;
  $("scrub").addEventListener("input", () => goTo(Number($("scrub").value) * HZ));
  setText($("end"), `/ ${seconds(run.end, run.end < 10 * HZ ? 3 : 1)}`);

  function tick(cycles, top, css, text) {
    const mark = draw("rect", css, $("ticks"));
    mark.setAttribute("x", ((1000 * cycles) / (run.end || 1) - 1).toFixed(1));
    mark.setAttribute("y", top);
    mark.setAttribute("width", 2.5);
    mark.setAttribute("height", 9);
    draw("title", "", mark).textContent = `${text}, ${seconds(cycles)}`;
  }
  for (const each of findings) tick(each.t, 0, kindOf(each), each.rule + (each.accepted && `, accepted: ${each.accepted}`));
  for (const index of orders) tick(lines.t[index], 10, "order", lines.text[index]);
  for (const [cycles, text] of scene ? scene.happened : []) tick(cycles, 10, "world", text);

  views.push(() => {
    // To the microsecond where it stands at one, as at a finding.
    setText($("clock"), seconds(now, playing || Math.round((now / HZ) * 1e6) % 1000 === 0 ? 3 : 6));
    $("scrub").value = now / HZ;
    $("scrub").setAttribute("aria-valuetext", seconds(now));
  });

  // ---- Tiles

  const tiles = {};
  function tile(title, text) {
    if (!tiles[title]) {
      const value = make("span", { class: "value" });
      tiles[title] = value;
      $("tiles").append(make("div", { class: "tile" }, make("span", { class: "title" }, title), value));
    }
    setText(tiles[title], text);
  }

  const told = (rows, t) => {
    let found = null;
    for (const [cycles, value] of rows) {
      if (cycles > t) break;
      found = value;
    }
    return found;
  };

  const kinds = ["error", "warning", "note", "accepted"];
  for (const kind of kinds) {
    const many = findings.filter((each) => kindOf(each) === kind).length;
    const text = `${many} ${kind}${many === 1 || kind === "accepted" ? "" : "s"}`;
    if (many) $("counts").append(make("span", { class: `severity ${kind}` }, text));
    setText($(`count-${kind}`), text);
    // Few programs accept anything.
    if (kind === "accepted") $(`count-${kind}`).parentElement.hidden = !many;
  }
  if (!findings.length) {
    $("counts").append(make("span", { class: "soft" }, "no findings"));
    document.querySelector(".findings").classList.add("empty");
  }

  // ---- The arena

  function series(data, ...names) {
    const columns = { t: sums(data.t) };
    for (const name of names) columns[name] = sums(data[name], run.units);
    return columns;
  }

  // Between two looks in a straight line; what has not changed for long stood until shortly before.
  function poseAt(path, t) {
    const next = count(path.t, t);
    if (!next) return path.t.length ? [path.x[0], path.y[0], path.h[0]] : null;
    const index = next - 1;
    if (next === path.t.length) return [path.x[index], path.y[index], path.h[index]];
    const wide = Math.min(path.t[next] - path.t[index], run.look);
    const share = Math.max(0, 1 - (path.t[next] - t) / wide);
    return ["x", "y", "h"].map((name) => path[name][index] + share * (path[name][next] - path[name][index]));
  }

  // A growing row of points, in pieces: those that are finished are not touched again.
  class Stroke {
    constructor(layer, css, path, dots) {
      this.layer = layer;
      this.css = css;
      this.path = path;
      this.dots = dots;
      this.pieces = [];
      this.shown = -1;
    }
    piece(from, to) {
      const { x, y } = this.path;
      let d = "";
      for (let n = this.dots ? from : Math.max(0, from - 1); n < to; n++) {
        d += `${this.dots || !d ? "M" : "L"}${(x[n] * PX_PER_M).toFixed(1)} ${(-y[n] * PX_PER_M).toFixed(1)}${this.dots ? "h0" : ""}`;
      }
      return d;
    }
    show(many) {
      if (many === this.shown) return;
      this.shown = many;
      const size = 256;
      const whole = Math.floor(many / size);
      while (this.pieces.length <= whole) {
        this.pieces.push({ path: draw("path", this.css, this.layer), to: -1 });
      }
      this.pieces.forEach((piece, n) => {
        const to = Math.max(n * size, Math.min(many, (n + 1) * size));
        if (to === piece.to) return;
        piece.to = to;
        piece.path.setAttribute("d", to > n * size ? this.piece(n * size, to) : "");
      });
    }
  }

  function arena() {
    $("arena").hidden = $("legend").hidden = false;
    const robot = series(scene.robot, "x", "y", "h");
    const believed = series(scene.believed, "x", "y", "h");
    const cloud = series(scene.cloud, "x", "y");
    const sonars = Object.entries(scene.sonars)
      .filter(([name]) => scene.mounts[name])
      .map(([name, data]) => ({ name, mount: scene.mounts[name], ...series(data, "measured", "ray", "echo") }));
    const layer = $("window").firstElementChild;
    const grid = layer.querySelector(".grid");

    const xs = [...robot.x];
    const ys = [...robot.y];
    for (const [ax, ay, bx, by] of scene.walls) {
      xs.push(ax, bx);
      ys.push(ay, by);
    }
    const [left, right] = [xs, xs].map((all, n) => all.reduce((a, b) => (n ? Math.max(a, b) : Math.min(a, b))));
    const [low, high] = [ys, ys].map((all, n) => all.reduce((a, b) => (n ? Math.max(a, b) : Math.min(a, b))));
    const margin = 0.25;
    const extent = [left - margin, -high - margin, right - left + 2 * margin, high - low + 2 * margin];

    // The gestures of the view's arena, which ask for an element, the extent, and whom to tell.
    const frame = Object.create(arenaWindow.methods);
    Object.assign(frame, {
      $el: $("window"),
      extent: extent.map((each) => each * PX_PER_M),
      above: 44, // its buttons
      below: 30, // its measure
      $emit: (what, value) => (what === "seen" ? looked(value) : what === "shifted" ? follow(false) : undefined),
    });
    for (const name of ["wheel", "down", "move", "up", "cancel"]) frame[name] = frame[name].bind(frame);
    // Steps of the grid, and the measure in the corner, by how near one looks.
    let gridded = "";
    function looked({ box: [x, y, width, height], unit }) {
      if (gridded === [x, y, width, height].join()) return;
      gridded = [x, y, width, height].join();
      const step = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find((s) => (s * PX_PER_M) / unit >= 56) || 100;
      const wide = step * PX_PER_M;
      let d = "";
      for (let at = Math.ceil(x / wide) * wide; at < x + width; at += wide) d += `M${at} ${y}v${height}`;
      for (let at = Math.ceil(y / wide) * wide; at < y + height; at += wide) d += `M${x} ${at}h${width}`;
      grid.replaceChildren();
      draw("path", "", grid).setAttribute("d", d);
      $("bar").style.width = `${wide / unit}px`;
      setText($("bar"), `${step} m`);
      arrows();
      lost[0](poseAt(believed, now));
      lost[1](poseAt(robot, now));
    }

    let walls = "";
    for (const [ax, ay, bx, by] of scene.walls) {
      walls += `M${ax * PX_PER_M} ${-ay * PX_PER_M}L${bx * PX_PER_M} ${-by * PX_PER_M}`;
    }
    draw("path", "wall", $("walls")).setAttribute("d", walls);

    const trails = [
      [new Stroke($("cloud"), "cloud", cloud, true), cloud],
      [new Stroke($("trails"), "trail-odo", believed, false), believed],
      [new Stroke($("trails"), "trail-true", robot, false), robot],
    ];

    const { ahead, radius, track, wheel } = scene.body;
    function body(css) {
      const group = draw("g", css, $("robots"));
      const circle = draw("circle", "", group);
      circle.setAttribute("cx", ahead * PX_PER_M);
      circle.setAttribute("r", radius * PX_PER_M);
      const [w, half] = [wheel * PX_PER_M, (track / 2) * PX_PER_M];
      draw("path", "", group).setAttribute("d", `M${-w} ${-half}h${2 * w}M${-w} ${half}h${2 * w}`);
      const nose = draw("path", "nose", group);
      const pressed = draw("path", "pressed", group);
      pressed.setAttribute("d", `M${(ahead + radius) * PX_PER_M} ${-half}v${2 * half}`);
      return { group, nose, pressed };
    }
    const ghost = body("ghost");
    const real = body("robot");

    function setPose({ group }, [x, y, h]) {
      group.setAttribute("transform", `translate(${x * PX_PER_M} ${-y * PX_PER_M}) rotate(${(-h * 180) / Math.PI})`);
    }

    // What lies beyond the edge: an arrow at the edge that points there, and how far it is from the middle.
    function away(group, text, [px, py]) {
      const [x, y, width, height] = frame.seen;
      const [mx, my] = [x + width / 2, y + height / 2];
      const [dx, dy] = [px * PX_PER_M - mx, -py * PX_PER_M - my];
      const inside = Math.abs(dx) <= width / 2 && Math.abs(dy) <= height / 2;
      group.style.display = inside ? "none" : "";
      if (inside) return;
      const u = 1 / frame.scale;
      const part = Math.min((width / 2 - 22 * u) / Math.abs(dx), (height / 2 - 22 * u) / Math.abs(dy));
      const [ax, ay] = [mx + part * dx, my + part * dy];
      const [arrow, words] = group.children;
      const turn = (Math.atan2(dy, dx) * 180) / Math.PI;
      arrow.setAttribute("d", `M${-6 * u} ${-7 * u}L${8 * u} 0L${-6 * u} ${7 * u}Z`);
      arrow.setAttribute("transform", `translate(${ax} ${ay}) rotate(${turn})`);
      const right = ax > mx;
      words.setAttribute("x", ax + (right ? -14 : 14) * u);
      words.setAttribute("y", Math.max(ay, y + 60 * u) + 4 * u);
      words.setAttribute("text-anchor", right ? "end" : "start");
      setText(words, `${text}, ${(Math.hypot(dx, dy) / PX_PER_M).toFixed(2)} m away`);
    }
    const lost = ["odometry", "robot"].map((text) => {
      const group = draw("g", "away", $("robots"));
      draw("path", "", group);
      draw("text", "", group);
      return (pose) => (pose ? away(group, text, pose) : (group.style.display = "none"));
    });

    // However small the body is, one sees where it looks.
    function arrows() {
      const unit = 1 / frame.scale;
      const tip = Math.max((ahead + radius) * PX_PER_M, 16 * unit) + 3 * unit;
      const barb = 5 * unit;
      for (const { nose } of [ghost, real]) {
        nose.setAttribute("d", `M0 0H${tip}M${tip - barb} ${-barb}L${tip} 0L${tip - barb} ${barb}`);
      }
    }

    const shapes = sonars.map(() => ["beam", "measured", "ray", "hit", "echo"].map((css) => draw("path", css, $("beams"))));
    function beams([x, y, h], t) {
      const cross = 4.5 / frame.scale;
      sonars.forEach((sonar, n) => {
        const [mx, my, bearing] = sonar.mount;
        const [c, s, look] = [Math.cos(h), Math.sin(h), h + bearing];
        const at = (range, turn) => {
          const [px, py] = [x + c * mx - s * my + range * Math.cos(turn), y + s * mx + c * my + range * Math.sin(turn)];
          return `${(px * PX_PER_M).toFixed(1)} ${(-py * PX_PER_M).toFixed(1)}`;
        };
        const arc = (range, half) => {
          const r = (range * PX_PER_M).toFixed(1);
          return `${at(range, look - half)}A${r} ${r} 0 0 0 ${at(range, look + half)}`;
        };
        const index = count(sonar.t, t) - 1;
        const range = (name) => (index < 0 ? -1 : sonar[name][index]);
        const [measured, ray, echo] = ["measured", "ray", "echo"].map(range);
        const [cone, edge, line, hit, answer] = shapes[n];
        const half = scene.half_angle;
        cone.setAttribute("d", measured > 0 ? `M${at(0, look)}L${arc(Math.min(measured, 6.45), half)}Z` : "");
        edge.setAttribute("d", measured > 0 ? `M${arc(Math.min(measured, 6.45), half)}` : "");
        line.setAttribute("d", ray > 0 ? `M${at(0, look)}L${at(ray, look)}` : "");
        const [k, k2] = [cross, 2 * cross];
        hit.setAttribute("d", ray > 0 ? `M${at(ray, look)}m${-k} ${-k}l${k2} ${k2}m0 ${-k2}l${-k2} ${k2}` : "");
        answer.setAttribute("d", echo > 0 ? `M${arc(echo, Math.PI / 45)}` : "");
        tile(ranged(sonar), measured > 0 ? (measured * 100).toFixed(0) : "–");
      });
    }

    const ranged = (sonar) => `${sonar.name.toLowerCase()}, cm`;

    let posted = null;
    function posts(t) {
      const rows = told(scene.posts, t) || [];
      if (rows === posted) return;
      posted = rows;
      $("posts").replaceChildren();
      for (const [, x, y, r] of rows) {
        const circle = draw("circle", "post", $("posts"));
        circle.setAttribute("cx", x * PX_PER_M);
        circle.setAttribute("cy", -y * PX_PER_M);
        circle.setAttribute("r", r * PX_PER_M);
      }
    }

    let following = false;
    function follow(on) {
      following = on;
      $("follow").setAttribute("aria-pressed", String(on));
      if (on) show();
    }
    $("nearer").addEventListener("click", () => frame.zoom(1.4));
    $("farther").addEventListener("click", () => frame.zoom(1 / 1.4));
    $("fit").addEventListener("click", () => {
      follow(false);
      frame.fit();
    });
    $("follow").addEventListener("click", () => {
      if (!following && frame.fitted) frame.zoom(2.5);
      follow(!following);
    });

    for (const title of ["robot", "x, y", "heading", ...sonars.map(ranged)]) tile(title, "");
    views.push((t) => {
      const pose = poseAt(robot, t);
      setPose(real, pose);
      const belief = poseAt(believed, t);
      ghost.group.style.display = belief ? "" : "none";
      if (belief) setPose(ghost, belief);
      const pressed = told(scene.bumper, t) === 1;
      real.pressed.style.display = pressed ? "" : "none";
      ghost.pressed.style.display = "none";
      tiles.robot.parentElement.className = `tile state${pressed ? " bump" : ""}`;
      tile("robot", `${told(scene.state, t) || "–"}${pressed ? ", bumper" : ""}`);
      tile("x, y", `${pose[0].toFixed(2)} ${pose[1].toFixed(2)} m`);
      tile("heading", `${((pose[2] * 180) / Math.PI).toFixed(0)}°`);
      beams(pose, t);
      posts(t);
      for (const [stroke, path] of trails) stroke.show(count(path.t, t));
      if (following) frame.centre(pose[0] * PX_PER_M, -pose[1] * PX_PER_M);
      lost[0](belief);
      lost[1](pose);
    });
    // As the component of the view is set up.
    arenaWindow.mounted.call(frame);
    arrows();
    $("window").addEventListener("wheel", () => (gridded = ""), { passive: true });
  }

  // ---- Parts of a board that stands in no world

  const signals = run.signals.map((each) => ({ ...each, t: sums(each.t) }));

  function valueAt(signal, t) {
    const index = count(signal.t, t) - 1;
    return index < 0 ? null : signal.v[index];
  }
  const worded = (value) => (value === null ? "–" : Number(value.toPrecision(5)).toString());

  function parts() {
    const faces = signals.filter((each) => each.channel === "faces");
    if (!faces.length) return;
    $("parts").hidden = false;
    const rows = make("tbody");
    const head = make("tr", {}, ...["part", "sees or does", "value", "between its least and most"].map((text) => make("th", { scope: "col" }, text)));
    $("parts").append(make("table", {}, make("thead", {}, head), rows));
    for (const face of faces) {
      const dot = face.name.indexOf(".");
      const [least, most] = [face.v.reduce((a, b) => Math.min(a, b)), face.v.reduce((a, b) => Math.max(a, b))];
      const value = make("td", { class: "value" });
      const meter = make("meter", { min: least, max: most > least ? most : least + 1, "aria-label": face.name });
      const range = make("span", { class: "soft" }, most > least ? `${worded(least)} to ${worded(most)}` : "stays");
      rows.append(
        make("tr", {}, make("th", { scope: "row" }, face.name.slice(0, dot)), make("td", {}, face.name.slice(dot + 1)), value,
          most > least ? make("td", {}, meter, range) : make("td", {}, range)),
      );
      views.push((t) => {
        const v = valueAt(face, t);
        setText(value, worded(v));
        meter.value = v ?? least;
      });
    }
  }

  // ---- Findings

  const items = new Map();
  let picked = null;

  function detail(each) {
    const box = make("div", { class: "detail" }, make("p", {}, each.message));
    if (each.accepted) box.append(make("p", { class: "soft" }, accepted(each)));
    if (each.where) box.append(make("p", { class: "mono" }, each.where));
    for (const text of each.details) box.append(make("p", { class: "soft" }, text));
    if (each.source) {
      const code = make("div", { class: "code", tabindex: "0", role: "region", "aria-label": `source of ${each.rule}` });
      each.source.lines.forEach((text, n) => {
        const number = each.source.first + n;
        const css = number === each.source.marked ? "here" : "";
        code.append(make("div", { class: css }, make("span", { class: "number" }, `${number}`), text));
      });
      box.append(code);
    }
    if (each.from.length) box.append(make("p", { class: "soft" }, `called from ${each.from.join(", from ")}`));
    const rule = run.rules[each.rule];
    const more = make("details", {}, make("summary", {}, `${each.rule}: ${rule.title}`));
    // Markdown of the rules, which come with the tool; the run has no word in it.
    const page = make("div");
    page.innerHTML = rule.page;
    for (const wide of page.querySelectorAll("pre")) wide.tabIndex = 0;
    more.append(page);
    if (rule.source) more.append(make("p", { class: "soft" }, `Source: ${rule.source}`));
    box.append(more);
    return box;
  }

  function open(each) {
    if (picked) {
      const { item, button } = items.get(picked);
      button.setAttribute("aria-expanded", "false");
      item.querySelector(".detail")?.remove();
    }
    picked = each;
    if (!each) return;
    const { item, button } = items.get(each);
    item.hidden = false;
    button.setAttribute("aria-expanded", "true");
    item.append(detail(each));
    const scroll = $("findings-scroll");
    const top = item.getBoundingClientRect().top - scroll.getBoundingClientRect().top;
    if (scroll.scrollHeight > scroll.clientHeight) scroll.scrollTop += top - 4;
  }

  // To the moment of a finding, with its source.
  function pick(each) {
    play(false);
    goTo(each.t);
    if (picked !== each) open(each);
    reveal(each.t);
    show();
  }

  for (const each of findings) {
    const when = make("span", { class: "when value soft" });
    const object = each.object ? ` ${each.object}` : "";
    const place = [...new Set([each.where.split(" ")[0], each.task])].filter(Boolean).join(", ");
    const what = make("span", { class: "what" }, make("b", {}, each.rule), object, make("br"), make("span", { class: "soft" }, place));
    const button = make(
      "button",
      { type: "button", "aria-expanded": "false", onclick: () => (picked === each && now === each.t ? open(null) : pick(each)) },
      make("span", { class: `severity ${kindOf(each)}` }, each.severity), what, when,
    );
    if (each.accepted) {
      button.title = accepted(each);
      button.firstElementChild.append(make("br"), make("span", { class: "state" }, "accepted"));
    }
    setText(when, seconds(each.t, 6));
    const item = make("li", { class: "finding" }, button);
    items.set(each, { item, button, when });
    $("findings").append(item);
  }

  function filter() {
    const wanted = $("search").value.trim().toLowerCase();
    let any = false;
    for (const each of findings) {
      const words = [each.rule, each.object, each.where, each.task, each.message, accepted(each)].join(" ").toLowerCase();
      const visible = $(`show-${kindOf(each)}`).checked && words.includes(wanted);
      items.get(each).item.hidden = !visible;
      any ||= visible;
    }
    $("no-findings").hidden = any;
  }
  for (const kind of kinds) $(`show-${kind}`).addEventListener("change", filter);
  $("search").addEventListener("input", filter);
  filter();

  let known = -1;
  const foundTimes = byTime.map((each) => each.t);
  views.push((t) => {
    const many = count(foundTimes, t);
    if (findings.length) tile("found so far", `${many} of ${findings.length}`);
    if (many === known && !picked) return;
    known = many;
    for (const each of findings) items.get(each).item.classList.toggle("now", each.t === t);
  });

  // ---- Orders and frames: only the rows in sight are there

  const ROW = 24;
  function said() {
    if (!lines.t.length) return;
    $("lines").hidden = false;
    const toPc = lines.sent.some(Boolean) || lines.received.some(Boolean);
    if (!toPc) setText($("lines-title"), "Serial lines");
    else if (!scene) setText($("lines-title"), "Line to the PC");
    setText($("lines-legend"), toPc ? "← to the board, → from it" : "");
    const scroll = $("said");
    const list = $("said-list");
    list.style.position = "relative";
    list.style.height = `${ROW * lines.t.length}px`;
    let current = -1;
    let drawn = "";
    function rows() {
      const first = Math.max(0, Math.floor(scroll.scrollTop / ROW) - 5);
      const end = Math.min(lines.t.length, first + Math.ceil(scroll.clientHeight / ROW) + 10);
      const wanted = `${first} ${end} ${current}`;
      if (wanted === drawn) return;
      drawn = wanted;
      const focused = list.contains(document.activeElement) ? document.activeElement.dataset.row : undefined;
      list.replaceChildren();
      for (let n = first; n < end; n++) {
        const pin = lines.pin[n];
        const way = lines.received[pin] ? "←" : lines.sent[pin] ? "→" : lines.pins[pin];
        const meaning = lines.received[pin] ? "to the board" : lines.sent[pin] ? "from the board" : lines.pins[pin];
        const arrow = make("span", { class: "way", "aria-hidden": "true" }, way);
        if (!lines.received[pin] && !lines.sent[pin]) arrow.style.width = "auto";
        const button = make(
          "button", { type: "button", "data-row": `${n}`, onclick: () => goTo(lines.t[n]) },
          make("span", { class: "when value" }, seconds(lines.t[n])), arrow, make("span", { class: "heard" }, meaning),
          make("span", {}, lines.text[n]),
        );
        const css = `said${n === current ? " now" : ""}${isOrder(n) ? " order" : ""}`;
        const row = make("li", { class: css }, button);
        row.style.top = `${n * ROW}px`;
        list.append(row);
        if (`${n}` === focused) button.focus({ preventScroll: true });
      }
    }
    scroll.addEventListener("scroll", rows);
    new ResizeObserver(() => {
      drawn = "";
      rows();
    }).observe(scroll);
    views.push((t) => {
      const index = count(lines.t, t) - 1;
      if (index === current) return;
      current = index;
      const top = index * ROW;
      if (top < scroll.scrollTop || top > scroll.scrollTop + scroll.clientHeight - ROW) {
        scroll.scrollTop = top - scroll.clientHeight / 2;
      }
      rows();
    });
  }

  // ---- Tasks and signals against time

  // Stretches as begin and end, and how long they are up to each one: so the share of any time is two look-ups.
  function stretches(column) {
    const edges = sums(column || []);
    const many = edges.length / 2;
    const [begin, end, sum] = [new Float64Array(many), new Float64Array(many), new Float64Array(many + 1)];
    for (let n = 0; n < many; n++) {
      begin[n] = edges[2 * n];
      end[n] = edges[2 * n + 1];
      sum[n + 1] = sum[n] + end[n] - begin[n];
    }
    return { begin, end, sum };
  }
  function until({ begin, end, sum }, t) {
    const n = count(begin, t);
    return n ? sum[n] - Math.max(0, end[n - 1] - t) : 0;
  }
  const share = (known, from, to) => (until(known, to) - until(known, from)) / (to - from || 1);

  let seen = [0, run.end || 1];
  let reveal = () => {};

  function lanes() {
    // More lanes than this are more than a canvas can be high.
    const most = 300;
    const all = signals.filter((each) => each.v.length > 1);
    const changing = all.slice(0, most);
    if (all.length > most) notice(`More than a page shows: of ${all.length} signals the first ${most} have a lane.`);
    if (!run.lanes.length && !changing.length) return;
    $("time").hidden = false;
    if (!run.lanes.length) setText($("time-title"), "Signals");
    else if (changing.length) setText($("time-title"), "Tasks and signals");
    $("states").hidden = !run.lanes.length;
    const rows = [
      ...run.lanes.map((lane) => ({
        name: lane.name, running: stretches(lane.running), ready: stretches(lane.ready), waiting: stretches(lane.waiting),
      })),
      ...changing.map((signal) => ({
        name: signal.channel === "faces" && scene ? `face ${signal.name}` : signal.name, signal,
        least: signal.v.reduce((a, b) => Math.min(a, b)), most: signal.v.reduce((a, b) => Math.max(a, b)),
      })),
    ];
    const canvas = $("canvas");
    const plot = $("plot");
    for (const row of rows) {
      row.load = make("span", { class: "load value" });
      $("names").append(make("li", {}, make("span", {}, row.name), row.load));
    }
    const css = (name) => parseFloat(getComputedStyle($("lane-scroll")).getPropertyValue(name));
    const whole = run.end || 1;

    // A name of the axis as short as the distance of its marks allows.
    function labelled(cycles, step) {
      const digits = Math.max(0, Math.ceil(-Math.log10(step / HZ) - 1e-9));
      return seconds(cycles, Math.min(digits, 9));
    }

    function paint() {
      const style = getComputedStyle(document.documentElement);
      const colour = (name) => style.getPropertyValue(name).trim();
      const [lane, axis] = [css("--lane"), css("--axis")];
      const scale = window.devicePixelRatio || 1;
      const width = plot.clientWidth;
      const height = axis + rows.length * lane;
      if (!width) return;
      if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
        canvas.width = Math.round(width * scale);
        canvas.height = Math.round(height * scale);
        canvas.style.height = `${height}px`;
      }
      const pen = canvas.getContext("2d");
      pen.setTransform(scale, 0, 0, scale, 0, 0);
      pen.clearRect(0, 0, width, height);
      const [from, to] = seen;
      const per = (to - from) / width;

      pen.font = "11px system-ui, sans-serif";
      pen.textBaseline = "top";
      const rough = (90 * per) / HZ;
      const power = 10 ** Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= rough) * HZ;
      pen.fillStyle = colour("--soft");
      pen.strokeStyle = colour("--line");
      pen.beginPath();
      for (let t = Math.ceil(from / step) * step; t <= to; t += step) {
        const x = (t - from) / per;
        pen.moveTo(x, axis - 4);
        pen.lineTo(x, height);
        const text = labelled(t, step);
        const wide = pen.measureText(text).width;
        pen.fillText(text, Math.min(Math.max(x - wide / 2, 0), width - wide), 3);
      }
      for (let n = 0; n <= rows.length; n++) {
        pen.moveTo(0, axis + n * lane);
        pen.lineTo(width, axis + n * lane);
      }
      pen.stroke();

      rows.forEach((row, n) => {
        const bottom = axis + (n + 1) * lane - 2;
        const full = lane - 4;
        if (row.signal) trace(pen, row, bottom, full, from, per, width, colour);
        else {
          columns(pen, row.ready, colour("--wait"), 0.55, bottom, full * 0.62, from, per, width, scale);
          columns(pen, row.waiting, colour("--bad"), 1, bottom, full * 0.62, from, per, width, scale);
          columns(pen, row.running, colour("--run"), 1, bottom, full, from, per, width, scale);
          const part = 100 * share(row.running, from, to);
          setText(row.load, `${part.toFixed(part < 10 ? 2 : 1)} %`);
        }
      });
      inSight();
      hand();
    }

    function inSight(text = "") {
      const digits = Math.min(9, Math.max(3, 2 - Math.floor(Math.log10((seen[1] - seen[0]) / HZ))));
      setText($("span"), text || `${seconds(seen[0], digits)} to ${seconds(seen[1], digits)}`);
    }

    // What is under the pointer: of a lane the stretch, of a number its value.
    function under(e) {
      const t = place(e);
      const row = rows[Math.floor((e.clientY - plot.getBoundingClientRect().top - css("--axis")) / css("--lane"))];
      if (!row) return inSight();
      if (row.signal) return inSight(`${row.name} = ${worded(valueAt(row.signal, t))} at ${seconds(t, 6)}`);
      const slack = 2 * ((seen[1] - seen[0]) / plot.clientWidth);
      for (const [known, does] of [[row.running, "runs"], [row.waiting, "waits at a gate"], [row.ready, "is ready"]]) {
        const n = count(known.begin, t + slack) - 1;
        if (n >= 0 && known.end[n] >= t - slack) {
          const long = (known.end[n] - known.begin[n]) / HZ;
          const lasted = long < 1e-3 ? `${(long * 1e6).toFixed(2)} µs` : `${(long * 1e3).toFixed(3)} ms`;
          return inSight(`${row.name} ${does} for ${lasted} from ${seconds(known.begin[n], 6)}`);
        }
      }
      return inSight();
    }

    // In each column of pixels as high as the share of its time, which is true at any zoom; on a paler ground, so that
    // one sees where something was done at all.
    function columns(pen, known, fill, alpha, bottom, full, from, per, width, scale) {
      if (!known.begin.length) return;
      pen.fillStyle = fill;
      const one = 1 / scale;
      let before = until(known, from);
      for (let x = 0; x < width; x += one) {
        const after = until(known, from + (x + one) * per);
        const part = Math.min(1, (after - before) / (one * per));
        before = after;
        if (part > 0) {
          pen.globalAlpha = alpha * 0.25;
          pen.fillRect(x, bottom - full, one, full);
          pen.globalAlpha = alpha;
          pen.fillRect(x, bottom - part * full, one, part * full);
        }
      }
      pen.globalAlpha = 1;
    }

    // A number: from its least to its most in each column of pixels, and as it stands in between.
    function trace(pen, { signal, least, most }, bottom, full, from, per, width, colour) {
      pen.strokeStyle = colour("--odo");
      pen.lineWidth = 1.4;
      pen.beginPath();
      const y = (value) => bottom - (full * (value - least)) / (most - least || 1);
      let index = count(signal.t, from) - 1;
      let level = index < 0 ? null : y(signal.v[index]);
      if (level !== null) pen.moveTo(0, level);
      for (let x = 0; x < width; x++) {
        const end = count(signal.t, from + (x + 1) * per) - 1;
        if (end > index) {
          let [top, low] = [Infinity, -Infinity];
          for (let n = index + 1; n <= end; n++) {
            top = Math.min(top, y(signal.v[n]));
            low = Math.max(low, y(signal.v[n]));
          }
          if (level === null) pen.moveTo(x, y(signal.v[index + 1]));
          else pen.lineTo(x, level);
          pen.lineTo(x, top);
          pen.lineTo(x, low);
          level = y(signal.v[end]);
          pen.lineTo(x, level);
          index = end;
        } else if (level !== null && x === width - 1) pen.lineTo(width, level);
      }
      pen.stroke();
      pen.lineWidth = 1;
    }

    function hand() {
      const [from, to] = seen;
      const x = ((now - from) / (to - from)) * plot.clientWidth;
      $("hand").style.display = x < 0 || x > plot.clientWidth ? "none" : "";
      $("hand").style.left = `${x - 1}px`;
      for (const row of rows) if (row.signal) setText(row.load, worded(valueAt(row.signal, now)));
    }

    let due = 0;
    function look(from, to) {
      const wide = Math.min(Math.max(to - from, 200), whole);
      const begin = Math.min(Math.max(from, 0), whole - wide);
      seen = [begin, begin + wide];
      if (!due) {
        due = requestAnimationFrame(() => {
          due = 0;
          paint();
        });
      }
    }
    function zoom(factor, at) {
      const [from, to] = seen;
      look(at - (at - from) * factor, at + (to - at) * factor);
    }
    const middle = () => (now >= seen[0] && now <= seen[1] ? now : (seen[0] + seen[1]) / 2);
    const actions = {
      "time-in": () => zoom(0.4, middle()), "time-out": () => zoom(2.5, middle()), "time-all": () => look(0, whole),
    };
    for (const [id, act] of Object.entries(actions)) $(id).addEventListener("click", act);

    const place = (e) => seen[0] + ((e.clientX - plot.getBoundingClientRect().left) / plot.clientWidth) * (seen[1] - seen[0]);
    plot.addEventListener("wheel", (e) => {
      if (e.shiftKey || Math.abs(e.deltaX) > Math.abs(e.deltaY)) {
        const by = ((e.deltaX || e.deltaY) / plot.clientWidth) * (seen[1] - seen[0]);
        look(seen[0] + by, seen[1] + by);
      } else zoom(Math.exp(Math.max(-200, Math.min(200, e.deltaY)) / 250), place(e));
      e.preventDefault();
    }, { passive: false });
    let grip = null;
    plot.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      plot.setPointerCapture(e.pointerId);
      grip = { x: e.clientX, seen, moved: false };
    });
    plot.addEventListener("pointermove", (e) => {
      if (!grip) return under(e);
      const by = e.clientX - grip.x;
      grip.moved ||= Math.abs(by) > 5;
      const wide = grip.seen[1] - grip.seen[0];
      if (grip.moved && wide < whole) look(grip.seen[0] - (by / plot.clientWidth) * wide, grip.seen[1] - (by / plot.clientWidth) * wide);
      else if (grip.moved) goTo(place(e));
    });
    plot.addEventListener("pointerup", (e) => {
      if (grip && !grip.moved) goTo(place(e));
      grip = null;
    });
    plot.addEventListener("pointerleave", () => inSight());
    plot.addEventListener("pointercancel", () => (grip = null));

    // A finding is a matter of microseconds: the lanes go near enough to see who ran.
    reveal = (t) => {
      if (seen[1] - seen[0] > 0.05 * HZ) look(t - 0.01 * HZ, t + 0.01 * HZ);
    };
    views.push((t) => {
      const [from, to] = seen;
      // On to the next leaf, as one turns pages.
      if (t < from || t > to) look(t - 0.1 * (to - from), t + 0.9 * (to - from));
      hand();
    });
    new ResizeObserver(paint).observe(plot);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
    window.hilPaint = paint;
    keys["+"] = keys["="] = actions["time-in"];
    keys["-"] = actions["time-out"];
    keys["0"] = actions["time-all"];
    paint();
  }

  // ---- Keys, light and dark

  const keys = {
    " ": () => play(!playing),
    ArrowLeft: (e) => goTo(now - (e.shiftKey ? 1 : 0.1) * HZ),
    ArrowRight: (e) => goTo(now + (e.shiftKey ? 1 : 0.1) * HZ),
    Home: () => goTo(0),
    End: () => goTo(run.end),
    n: () => neighbour(1),
    p: () => neighbour(-1),
    f: () => $("follow").click(),
  };
  addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || $("about").open) return;
    const at = e.target;
    if (at.matches("input[type=search], select")) return;
    // Space presses a button, ticks a box, opens a summary.
    if (e.key === " " && at.matches("button, summary, input[type=checkbox]") && at !== $("play")) return;
    if ((e.key === "Home" || e.key === "End") && at.matches(".scroll, .parts, .lanes")) return;
    const act = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!act) return;
    e.preventDefault();
    act(e);
  });
  // Space on the play button has played already.
  $("play").addEventListener("keyup", (e) => e.key === " " && e.preventDefault());

  const kept = "hil-light";
  function light(choose) {
    const root = document.documentElement;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    try {
      if (choose) {
        const shown = root.dataset.light || (dark ? "dark" : "light");
        localStorage.setItem(kept, shown === "dark" ? "light" : "dark");
      }
      const chosen = localStorage.getItem(kept);
      if (chosen) root.dataset.light = chosen;
    } catch {
      if (choose) root.dataset.light = (root.dataset.light || (dark ? "dark" : "light")) === "dark" ? "light" : "dark";
    }
    window.hilPaint?.();
  }
  light(false);
  $("light").addEventListener("click", () => light(true));
  $("about-button").addEventListener("click", () => $("about").showModal());
  $("about-close").addEventListener("click", () => $("about").close());

  if (scene) arena();
  else parts();
  said();
  lanes();
  // page.html#t=12.5 begins there.
  const asked = () => Number(/(?:^|[#&])t=([\d.]+)/.exec(location.hash)?.[1] || 0);
  addEventListener("hashchange", () => goTo(asked() * HZ));
  goTo(asked() * HZ);
})();

// drawing.js -- a model as SVG: layers of elements that are made once and moved.
const MANY = 60; // frames, from which on marks are small

class Drawing {
  constructor(svg) {
    this.svg = svg;
    this.camera = new Camera();
    this.shows = "past";
    this.triads = false;
  }

  element(parent, name, kind, attributes = {}) {
    const made = document.createElementNS(this.svg.namespaceURI, name);
    if (kind) made.setAttribute("class", kind);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  }

  hinted(made, text) {
    this.element(made, "title").textContent = text;
    return made;
  }

  // -- making the elements

  show(model) {
    const view = model.view;
    this.model = model;
    this.index = 0;
    this.svg.replaceChildren();
    this.svg.classList.toggle("many", view.frames.length > MANY);
    this.layer = {};
    for (const name of ["ruler", "trail", "path", "lines", "axes", "frames", "bodies", "boxes", "labels"]) {
      this.layer[name] = this.element(this.svg, "g", "layer-" + name);
    }
    const faint = Math.max(0.015, Math.min(0.12, 5 * view.points.length / (model.trail.length + 1)));
    const color = point => ({ style: `--c: var(--p${point % 8}); --faint: ${faint.toFixed(3)}` });
    this.trail = model.trail.map(entry => this.element(this.layer.trail, "polygon", "box swept", color(entry.point)));
    this.paths = view.points.map((_, k) => this.element(this.layer.path, "polyline", "path", color(k)));
    this.next = view.points.map((_, k) => this.element(this.layer.boxes, "polygon", "box next", color(k)));
    this.now = view.points.map((_, k) => this.element(this.layer.boxes, "polygon", "box now", color(k)));
    this.labels = view.points.map(point => {
      const label = this.element(this.layer.labels, "text", "under");
      label.textContent = point.name;
      return label;
    });
    this.makeMechanism(view);
    this.makeRuler();
    this.camera.look(model.side(), model.upward());
    this.resize(true);
  }

  makeMechanism(view) {
    const thin = view.frames.length > MANY ? " thin" : "";
    this.lines = view.lines.map(line =>
      this.hinted(this.element(this.layer.lines, "line", `line ${line.kind}${thin}`), line.name));
    this.axes = view.axes.map(axis =>
      this.hinted(this.element(this.layer.axes, "line", "axis"), `${axis.name}: ${axis.kind}`));
    this.frames = view.frames.map(frame =>
      this.hinted(this.element(this.layer.frames, "circle", frame.kind === "world" ? "frame world" : "frame"),
        `${frame.name}: ${frame.kind}`));
    this.triadLines = view.turn[0].length > 0 ? view.frames.map(() =>
      ["ax", "ay", "az"].map(kind => this.element(this.layer.frames, "line", "triad " + kind))) : [];
    this.bodies = view.bodies.map(body => {
      const mark = this.hinted(this.element(this.layer.bodies, "g", "body"), `${body.name}: ${body.kind}`);
      this.element(mark, "circle", "", { r: 6 });
      this.element(mark, "path", "", { d: "M0 0V-6A6 6 0 0 1 6 0ZM0 0V6A6 6 0 0 1-6 0Z" });
      return mark;
    });
  }

  makeRuler() {
    this.ruler = this.element(this.layer.ruler, "path", "ruler");
    this.rulerText = this.element(this.layer.ruler, "text", "small");
    this.compass = [["ax", "tx", "x"], ["ay", "ty", "y"], ["az", "tz", "z"]].map(([kind, text, letter]) => {
      const label = this.element(this.layer.ruler, "text", text + " under");
      label.textContent = letter;
      return [this.element(this.layer.ruler, "line", "triad " + kind), label];
    });
  }

  // -- moving them

  resize(fit) {
    const width = this.svg.clientWidth || 800, height = this.svg.clientHeight || 500;
    this.camera.width = width;
    this.camera.height = height;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    if (fit) this.camera.fit(this.model.places);
    this.draw();
  }

  fit() {
    this.camera.fit(this.model.places);
    this.draw();
  }

  look(side) {
    this.camera.look(side, this.model.upward());
    this.fit();
  }

  // Everything: after the camera has moved.
  draw() {
    this.drawRuler();
    this.model.trail.forEach((entry, k) => this.outline(this.trail[k], entry.box));
    this.paths.forEach((path, k) => this.drawPath(path, this.model.view.points[k].frame));
    this.at(this.index);
  }

  outline(polygon, box) {
    if (!box) return polygon.removeAttribute("points");
    const hull = convexHull(corners(box).map(p => this.camera.project(p)));
    polygon.setAttribute("points", hull.map(p => p[0].toFixed(1) + "," + p[1].toFixed(1)).join(" "));
  }

  drawPath(path, frame) {
    const list = [];
    for (let i = 0; i <= this.model.last; i++) {
      const p = this.model.position(i, frame);
      if (finite(p)) list.push(this.camera.project(p).map(c => c.toFixed(1)).join(","));
    }
    path.setAttribute("points", list.join(" "));
  }

  segment(line, a, b) {
    const shown = finite(a) && finite(b);
    line.toggleAttribute("hidden", !shown);
    if (!shown) return;
    const [p, q] = [this.camera.project(a), this.camera.project(b)];
    for (const [key, value] of [["x1", p[0]], ["y1", p[1]], ["x2", q[0]], ["y2", q[1]]]) {
      line.setAttribute(key, value.toFixed(1));
    }
  }

  // The instant i: what moves.
  at(i) {
    const { view } = this.model, position = view.frames.map((_, k) => this.model.position(i, k));
    this.index = i;
    view.lines.forEach((line, k) => this.segment(this.lines[k], position[line.a], position[line.b]));
    this.drawFrames(i, position);
    view.bodies.forEach((_, k) => this.place(this.bodies[k], view.centre[i].slice(3 * k, 3 * k + 3)));
    this.drawBoxes(i, position);
  }

  place(mark, p) {
    mark.toggleAttribute("hidden", !finite(p));
    if (!finite(p)) return;
    const [x, y] = this.camera.project(p);
    mark.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
  }

  drawFrames(i, position) {
    const { view } = this.model, { camera } = this, radius = view.frames.length > MANY ? 1.6 : 4;
    this.frames.forEach((circle, k) => {
      this.place(circle, position[k]);
      circle.setAttribute("r", k === 0 ? radius + 3 : radius);
    });
    view.axes.forEach((axis, k) => {
      const d = view.axis[i].slice(3 * k, 3 * k + 3), length = Math.hypot(...d);
      const half = scaled(d, 13 / camera.scale / length), p = position[axis.frame];
      this.segment(this.axes[k], minus(p, half), plus(p, half));
    });
    this.triadLines.forEach((lines, k) => {
      const x = view.turn[i].slice(6 * k, 6 * k + 3), y = view.turn[i].slice(6 * k + 3, 6 * k + 6);
      [x, y, cross(x, y)].forEach((axis, n) => {
        this.segment(lines[n], position[k], plus(position[k], scaled(axis, 24 / camera.scale)));
        lines[n].style.display = this.triads ? "" : "none";
      });
    });
  }

  drawBoxes(i, position) {
    const { model } = this, seen = this.shows !== "none";
    model.trail.forEach((entry, k) => {
      const shown = this.shows === "all" || (this.shows === "past" && entry.last < i);
      this.trail[k].style.display = shown ? "" : "none";
    });
    this.now.forEach((polygon, k) => this.outline(polygon, seen ? model.now[i][k] : null));
    this.next.forEach((polygon, k) => this.outline(polygon, seen && model.next[i] ? model.next[i][k] : null));
    this.drawLabels(position);
  }

  // Beside their points, inside the drawing, not on each other.
  drawLabels(position) {
    const placed = [];
    this.labels.forEach((label, k) => {
      const point = this.model.view.points[k], p = position[point.frame];
      label.toggleAttribute("hidden", !finite(p));
      if (!finite(p)) return;
      const at = this.camera.project(p), width = Math.min(7 * point.name.length, this.camera.width - 20);
      const x = Math.max(4, Math.min(at[0] + 11, this.camera.width - width - 4));
      let y = at[1] - 9;
      for (const other of placed) {
        if (Math.abs(y - other.y) < 14 && x < other.x + other.width && other.x < x + width) y = other.y - 14;
      }
      placed.push({ x, y, width });
      label.setAttribute("x", x.toFixed(1));
      label.setAttribute("y", y.toFixed(1));
    });
  }

  // A length that is easy to read, and the directions of the world's axes.
  drawRuler() {
    const { camera } = this, bottom = camera.height - 16;
    const wanted = Math.min(140, camera.width / 4) / camera.scale, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map(n => n * power).find(n => n <= wanted) || power, pixels = length * camera.scale;
    this.ruler.setAttribute("d", `M84 ${bottom - 5}v5h${pixels.toFixed(1)}v-5`);
    this.rulerText.setAttribute("x", (84 + pixels / 2).toFixed(1));
    this.rulerText.setAttribute("y", bottom - 7);
    this.rulerText.setAttribute("text-anchor", "middle");
    this.rulerText.textContent = String(Number(length.toPrecision(2))) + " m";
    const origin = [34, camera.height - 36];
    Object.values(letters).forEach((axis, k) => {
      const [line, label] = this.compass[k];
      const tip = [origin[0] + 22 * dot(axis, camera.right), origin[1] - 22 * dot(axis, camera.up)];
      [["x1", origin[0]], ["y1", origin[1]], ["x2", tip[0]], ["y2", tip[1]]].forEach(
        ([key, value]) => line.setAttribute(key, value.toFixed(1)));
      const seen = Math.hypot(tip[0] - origin[0], tip[1] - origin[1]) > 7;
      label.setAttribute("x", (tip[0] + (tip[0] - origin[0]) * 0.4 - 3).toFixed(1));
      label.setAttribute("y", (tip[1] + (tip[1] - origin[1]) * 0.4 + 4).toFixed(1));
      label.style.display = seen ? "" : "none";
    });
  }
}

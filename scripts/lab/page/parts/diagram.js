// diagram.js -- work against precision: error or width across, CPU seconds up, both logarithmic; one curve per family.
// Failures stand in a strip on the right, as if infinitely wide; what is exact, in a strip on the left.
const SHAPES = ["M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z", "M-4.5-4.5H4.5V4.5H-4.5Z", "M0-6L6 0L0 6L-6 0Z",
  "M0-6L5.5 4H-5.5Z", "M0 6L5.5-4H-5.5Z"];
const CROSS = "M-5-5L5 5M-5 5L5-5";
const REACH = 28; // pixels from a mark that still mean it
const STRIP = 48;
const NOTICED = 0.999; // widths that differ by less than a thousandth are the same
const UNRUN = new Set(["skipped", "refused"]);

function secondsText(s) {
  const units = [[1, "s"], [1e-3, "ms"], [1e-6, "\u00b5s"], [1e-9, "ns"]];
  const [unit, name] = units.find(([u]) => s >= 0.999 * u) || units[3];
  return `${Number((s / unit).toPrecision(3))} ${name}`;
}

class Diagram {
  constructor(place, data, rows) {
    Object.assign(this, { data, rows, quantity: data.first, hidden: new Set() });
    this.families = [...new Set(data.rows.map(row => row.family))];
    this.svg = element(place, "svg", { class: "plot", role: "group", "aria-label":
      "work against precision; the arrow keys go from mark to mark, Enter shows the row of the table" });
    this.note = place.appendChild(make("p", "", "quiet"));
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.svg);
  }

  show(quantity) {
    this.quantity = quantity;
    this.draw();
  }

  toggle(family, on) {
    this.hidden[on ? "delete" : "add"](family);
    this.draw();
  }

  // -- what is drawn where

  // "point", "exact", "failed", or "" for what has no place
  kind(row) {
    const x = row[this.quantity];
    if (UNRUN.has(row.status)) return "";
    if (row.status !== "complete" || x === Infinity) return "failed";
    if (x === null || !(x >= 0)) return "";
    return x === 0 ? "exact" : "point";
  }

  marks() {
    const all = this.data.rows.map((row, number) => ({ row, number, kind: this.kind(row), x: row[this.quantity],
      family: this.families.indexOf(row.family) }));
    this.missing = all.filter(mark => !mark.kind).length;
    return all.filter(mark => mark.kind && !this.hidden.has(mark.row.family));
  }

  scales(marks) {
    const width = Math.max(200, this.svg.clientWidth), height = Math.max(200, this.svg.clientHeight);
    const left = 62, bottom = height - 44, has = kind => marks.some(mark => mark.kind === kind);
    this.frame = { left, right: width - 10, top: 22, bottom, exact: has("exact") ? left + STRIP : left,
      failed: has("failed") ? width - 10 - STRIP : width - 10 };
    const points = marks.filter(mark => mark.kind === "point");
    this.across = new LogScale(points.map(mark => mark.x), this.frame.exact + 6, this.frame.failed - 6);
    this.up = new LogScale(marks.map(mark => mark.row.seconds), bottom - 6, this.frame.top + 6);
  }

  // A time that is not known is at the top, one that was too short to measure at the bottom.
  height(row) {
    if (row.seconds === null) return this.frame.top + 10;
    return row.seconds > 0 ? this.up.at(row.seconds) : this.frame.bottom - 8;
  }

  // Marks of a strip that would lie on each other stand side by side.
  place(marks) {
    const taken = [], middle = { exact: (this.frame.left + this.frame.exact) / 2,
      failed: (this.frame.failed + this.frame.right) / 2 };
    for (const mark of marks) {
      mark.py = this.height(mark.row);
      mark.px = mark.kind === "point" ? this.across.at(mark.x) : middle[mark.kind];
      if (mark.kind === "point") continue;
      const free = [0, -12, 12, -6, 6, -18, 18].find(d =>
        !taken.some(([x, y]) => Math.hypot(mark.px + d - x, mark.py - y) < 10));
      mark.px += free || 0;
      taken.push([mark.px, mark.py]);
    }
  }

  // No other is as fast and noticeably tighter: of the proofs, or, where there is none, of what proves nothing.
  front(marks) {
    const able = marks.filter(mark => (mark.kind === "point" || mark.kind === "exact") && mark.row.seconds !== null);
    const proofs = able.filter(mark => mark.row.rigorous), list = proofs.length > 0 ? proofs : able;
    list.sort((a, b) => a.row.seconds - b.row.seconds || a.x - b.x);
    let least = Infinity;
    return list.filter(mark => {
      const better = mark.x < NOTICED * least;
      if (better) least = mark.x;
      return better;
    }).reverse();
  }

  // -- drawing

  // The tip and the focus stay with their mark: a page is drawn again whenever its size changes.
  draw() {
    const told = this.picked && !tip.isHidden() ? this.picked : null;
    const focused = told && told.group === document.activeElement;
    const marks = this.shown = this.marks();
    this.scales(marks);
    this.place(marks);
    this.svg.replaceChildren();
    this.drawAxes();
    this.drawCurves(marks);
    this.drawFront(this.front(marks));
    for (const mark of marks) this.drawMark(mark);
    this.describe(marks);
    const again = told && marks.find(mark => mark.row === told.row);
    if (again && focused) this.hold(again);
    else this.pick(again);
  }

  drawAxes() {
    const { left, right, top, bottom, exact, failed } = this.frame;
    for (const x of this.across.ticks((failed - exact) / 56)) {
      const px = this.across.at(x);
      element(this.svg, "path", { class: "grid", d: `M${px} ${top}V${bottom}` });
      element(this.svg, "text", { x: px, y: bottom + 17, "text-anchor": "middle" }, powerText(x));
    }
    for (const y of this.up.ticks((bottom - top) / 34)) {
      const py = this.up.at(y);
      element(this.svg, "path", { class: "grid", d: `M${left} ${py}H${right}` });
      element(this.svg, "text", { x: left - 6, y: py + 4, "text-anchor": "end" }, secondsText(y));
    }
    for (const [from, to, text] of [[left, exact, "exact"], [failed, right, "failed"]]) {
      if (to - from < 1) continue;
      element(this.svg, "rect", { class: "strip", x: from, y: top, width: to - from, height: bottom - top });
      element(this.svg, "text", { x: (from + to) / 2, y: bottom + 17, "text-anchor": "middle" }, text);
    }
    element(this.svg, "path", { class: "axis", d: `M${left} ${top}V${bottom}H${right}` });
    element(this.svg, "text", { x: (exact + failed) / 2, y: bottom + 37, "text-anchor": "middle" }, this.title());
    element(this.svg, "text", { x: 4, y: 13 }, "CPU time of one run");
  }

  title() {
    const units = [...new Set(this.data.units)], text = this.data.quantities.find(q => q[0] === this.quantity)[1];
    if (this.quantity.startsWith("over_sample")) return `${text}: width / width of the sampled hull`;
    return units.length === 1 && units[0] ? `${text}, ${units[0]}` : text;
  }

  drawCurves(marks) {
    this.families.forEach((name, family) => {
      const points = marks.filter(mark => mark.family === family && mark.kind === "point");
      if (points.length < 2) return;
      const d = "M" + points.map(mark => `${mark.px.toFixed(1)} ${mark.py.toFixed(1)}`).join("L");
      element(this.svg, "path", { class: "curve", style: `--c: var(${paint(family)})`, d });
    });
  }

  drawFront(front) {
    this.best = new Set(front);
    if (front.length < 2) return;
    const d = front.map((mark, k) => k === 0 ? `M${mark.px} ${mark.py}` : `V${mark.py}H${mark.px}`);
    // The corners lie where both the width of the slower and the time of the faster hold.
    element(this.svg, "path", { class: "front", d: d.join("").replace(/V([\d.]+)H([\d.]+)/g, "H$2V$1") });
  }

  drawMark(mark) {
    const { row, kind, px, py } = mark, failed = kind === "failed";
    const group = element(this.svg, "g", { class: "mark", role: "img", tabindex: -1, style:
      `--c: var(${paint(mark.family)})`, transform: `translate(${px.toFixed(1)} ${py.toFixed(1)})`, "aria-label":
      `${row.label}: ${failed ? row.status : `${this.title()} ${mark.x}`}, ${secondsText(row.seconds || 0)}` });
    if (this.best.has(mark)) element(group, "circle", { class: "ring", r: 9.5 });
    if (failed) element(group, "path", { class: "halo", d: CROSS });
    element(group, "path", { class: failed ? "cross" : "dot", d: failed ? CROSS : SHAPES[mark.family % SHAPES.length] });
    group.addEventListener("focus", () => this.pick(mark));
    group.addEventListener("blur", () => this.pick(null));
    mark.group = group;
  }

  describe(marks) {
    const failed = marks.filter(mark => mark.kind === "failed").length, list = [];
    if (this.best.size > 0) list.push("Ringed: no other one shown is as fast and noticeably tighter.");
    if (failed > 0) list.push(`Crosses: ${failed} that did not come to the end.`);
    if (this.missing > 0) list.push(`${this.missing} without this number, or that were not run: see the table.`);
    if (marks.length === 0) list.unshift("Nothing to draw.");
    this.note.textContent = list.join(" ");
    if (marks[0]) marks[0].group.setAttribute("tabindex", 0);
  }

  // -- hands

  // The tip of another diagram is none of this one's.
  pick(mark) {
    const before = this.picked;
    this.picked = mark;
    if (before) {
      before.group.classList.remove("picked");
      this.rows.forEach(row => row.classList.remove("picked"));
      if (!mark) tip.hide();
    }
    if (!mark) return;
    mark.group.classList.add("picked");
    this.rows[mark.number].classList.add("picked");
    const box = this.svg.getBoundingClientRect();
    tip.show(tip.row(this.rows[mark.number]), box.left + mark.px, box.top + mark.py);
  }

  // The only mark that Tab leads to has the focus.
  hold(mark) {
    for (const other of this.shown) other.group.setAttribute("tabindex", mark === other ? 0 : -1);
    mark.group.focus({ preventScroll: true });
  }

  nearest(event) {
    const box = this.svg.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    let best = null, least = REACH;
    for (const mark of this.shown) {
      const distance = Math.hypot(mark.px - x, mark.py - y);
      if (distance < least) [best, least] = [mark, distance];
    }
    return best;
  }

  step(way) {
    const order = [...this.shown].sort((a, b) => a.px - b.px || a.py - b.py);
    const next = order[(order.indexOf(this.picked) + way + order.length) % order.length];
    if (next) this.hold(next);
  }

  listen() {
    const follow = event => {
      const mark = this.nearest(event);
      if (mark !== this.picked) this.pick(mark);
    };
    this.svg.addEventListener("pointermove", follow);
    this.svg.addEventListener("pointerdown", follow);
    this.svg.addEventListener("pointerleave", event => { if (event.pointerType === "mouse") this.pick(null); });
    this.svg.addEventListener("keydown", event => {
      const ways = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
      if (ways[event.key]) {
        event.preventDefault();
        this.step(ways[event.key]);
      } else if (event.key === "Enter" && this.picked) {
        this.rows[this.picked.number].scrollIntoView({ block: "center" });
      }
    });
  }
}

// probe_compare.js -- looks at the page of comparisons as a reader does: marks, tips, curves and bands.
const { comparisons } = JSON.parse(document.getElementById("data").textContent);

// What a diagram is to show of a row.
function kindOf(row, quantity) {
  if (row.status === "skipped" || row.status === "refused") return "";
  if (row.status !== "complete" || row[quantity] === Infinity) return "cross";
  return row[quantity] !== null && row[quantity] >= 0 ? "dot" : "";
}

function counted(section, data, quantity) {
  const kinds = data.rows.map(row => kindOf(row, quantity)), count = kind => kinds.filter(k => k === kind).length;
  for (const kind of ["dot", "cross"]) {
    same(section.querySelectorAll(`.mark .${kind}`).length, count(kind), `marks ${kind} for ${quantity}`);
  }
  const svg = section.querySelector("svg.plot");
  check(!/NaN|Infinity/.test(svg.outerHTML), "a place in the diagram is not a number");
  const box = svg.getBoundingClientRect();
  for (const mark of section.querySelectorAll(".mark")) {
    const at = mark.getBoundingClientRect(), x = at.left + at.width / 2, y = at.top + at.height / 2;
    check(x >= box.left && x <= box.right && y >= box.top && y <= box.bottom, "a mark is outside of the diagram");
  }
}

// The front: nothing shown is both left of and below a ringed mark; for the measure of the advice, what has a star.
function front(section, data, quantity) {
  const place = mark => channels(mark.getAttribute("transform"));
  const dots = [...section.querySelectorAll(".mark")].filter(mark => mark.querySelector(".dot"));
  const ringed = dots.filter(mark => mark.querySelector(".ring"));
  const stars = data.rows.filter(row => row.pareto).length;
  if (quantity === data.measure && stars > 0) same(ringed.length, stars, "ringed marks, and stars of the table");
  const timed = data.rows.filter(row => kindOf(row, quantity) === "dot" && row.seconds !== null);
  const proofs = timed.filter(row => row.rigorous), able = proofs.length > 0 ? proofs : timed;
  check(ringed.length > 0 === timed.length > 0, `${ringed.length} marks of ${dots.length} are ringed`);
  for (const mark of ringed) {
    const label = mark.getAttribute("aria-label"), row = able.find(one => label.startsWith(one.label + ":"));
    check(row && !able.some(other => other[quantity] < 0.999 * row[quantity] && other.seconds <= row.seconds),
      `${label} is ringed, but not on the front`);
    check(place(mark).every(Number.isFinite), "a ringed mark has no place");
  }
}

// The middle of a mark in the window.
function middle(mark) {
  const { left, top, width, height } = mark.getBoundingClientRect();
  return [left + width / 2, top + height / 2];
}

// The tip is there and has the words of the row of a mark at that place; marks may lie on each other.
function told(what, marks, [x, y]) {
  const box = by("tip").getBoundingClientRect(), said = by("tip").textContent;
  check(!by("tip").hidden, `${what} shows no tip`);
  const near = marks.filter(mark => Math.hypot(middle(mark)[0] - x, middle(mark)[1] - y) < 1);
  const labels = near.map(mark => mark.getAttribute("aria-label").split(": ")[0]);
  check(labels.some(label => said.includes(label)), `${what}: the tip says ${said}`);
  check(box.left >= 0 && box.right <= innerWidth, `${what}: the tip leaves the window`);
}

const point = (svg, type, [x, y]) =>
  svg.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, bubbles: true }));

// The words under the pointer, under a finger and at the focus are those of the row of the table. The marks are asked
// for when they are needed: the diagram is drawn again when the browser says its size, which may be late.
async function tips(section) {
  const svg = section.querySelector("svg.plot"), marks = () => [...section.querySelectorAll(".mark")];
  if (marks().length === 0) return;
  svg.scrollIntoView({ block: "center" });
  await wait(50);
  for (const type of ["pointermove", "pointerdown"]) {
    for (const mark of marks()) {
      const place = middle(mark);
      point(svg, type, place);
      told(type, marks(), place);
    }
    fits();
    point(svg, "pointermove", [-500, -500]);
    check(by("tip").hidden, "the tip stays when the pointer has left");
  }
  drawnAgain(section, svg, marks);
  marks().find(mark => mark.tabIndex === 0).focus();
  check(!by("tip").hidden, "the focus shows no tip");
  const first = by("tip").textContent;
  press(svg, "ArrowRight");
  if (marks().length > 1) check(by("tip").textContent !== first, "the arrow keys do not go on");
  press(document.body, "Escape");
  check(by("tip").hidden, "Escape does not hide the tip");
  document.activeElement.blur();
}

// A tip outlives that its diagram is drawn again, as long as its mark is there, and so does the focus.
function drawnAgain(section, svg, marks) {
  const legend = [...section.querySelectorAll(".diagram .legend button:not(.plain)")];
  const redraw = () => legend.forEach(made => { made.click(); made.click(); });
  const others = legend.slice(1), twice = () => others.forEach(made => { made.click(); made.click(); });
  const place = middle(marks()[0]);
  point(svg, "pointermove", place);
  twice();
  told("after it was drawn again", marks(), place);
  redraw();
  check(by("tip").hidden, "the tip stays without its mark");
  marks()[0].focus();
  twice();
  check(document.activeElement === marks()[0], "the focus is lost when the diagram is drawn again");
  document.activeElement.blur();
}

async function diagram(section, data) {
  const quantities = [...section.querySelectorAll(".diagram .group button")];
  for (const [quantity] of data.quantities) {
    const chosen = quantities.find(made => made.dataset.value === quantity);
    if (chosen) {
      chosen.click();
      same(chosen.getAttribute("aria-pressed"), "true", quantity);
    }
    counted(section, data, quantity);
    front(section, data, quantity);
  }
  if (quantities.length > 0) quantities.find(made => made.dataset.value === data.measure).click();
  await tips(section);
  const legend = [...section.querySelectorAll(".diagram .legend button:not(.plain)")];
  same(legend.length, new Set(data.rows.map(row => row.family)).size, "curves in the legend");
  const marks = () => section.querySelectorAll(".mark").length, before = marks();
  legend.forEach(made => made.click());
  same(marks(), 0, "marks when every curve is off");
  legend.forEach(made => made.click());
  same(marks(), before, "marks when every curve is on again");
}

async function bands(section, data) {
  const legend = [...section.querySelectorAll(".tracks .legend button:not(.plain)")];
  same(legend.length, data.rows.filter(row => row.track).length, "combinations in the legend of the bands");
  const canvases = () => [...section.querySelectorAll(".tracks canvas")];
  same(canvases().length, Math.min(8, data.names.length), "plots over time");
  if (section.id !== "c1") return;
  const modes = [...section.querySelectorAll(".tracks .group button")];
  modes[0].click();
  await wait(100);
  const drawn = canvases().map(inked);
  check(drawn.every(n => n > 300), `points of the plots: ${drawn}`);
  const on = legend.filter(made => made.getAttribute("aria-pressed") === "true");
  check(on.length > 0, "no band is shown at first");
  legend.forEach(made => { if (made.getAttribute("aria-pressed") === "false") made.click(); });
  modes[1].click();
  await wait(100);
  const wide = canvases().map(inked);
  check(wide.join() !== drawn.join(), "the plots of widths are those of enclosures");
  legend.forEach(made => made.click());
  await wait(100);
  check(canvases().map(inked).every((n, k) => n < wide[k]), "bands that are off are drawn");
  on.forEach(made => made.click());
  modes[0].click();
  await wait(100);
  await readouts(section, data);
  await gaps(section, data, legend);
}

// What is said under one t holds at that t: it is of an instant of its own, or of the tube around it, or has another
// time beside it. So no two proofs of one truth are disjoint.
function heldAt(words, t, data, name) {
  const row = data.rows.filter(one => words.startsWith(one.label + " ")).pop();
  if (!row) return null;
  const [, lo, hi, rest] = words.slice(row.label.length).match(/^ \[(\S+), (\S+)\](.*)$/) || [];
  check(lo !== undefined, `the readout says ${words}`);
  const times = row.track.t, k = times.indexOf(t);
  if (rest === "") {
    check(k >= 0 && row.track.lo[name][k] === Number(lo) && row.track.hi[name][k] === Number(hi),
      `at t = ${t} it says ${words}`);
  } else if (rest.startsWith(" from")) {
    const [from, to] = rest.match(/[\d.e-]+/g).map(Number), at = times.indexOf(from);
    check(from < t && t < to && times[at + 1] === to && row.track.tube.lo[name][at] === Number(lo)
      && row.track.tube.hi[name][at] === Number(hi), `at t = ${t} it says ${words}`);
  } else {
    const own = Number(rest.match(/^ at t = (\S+)$/)[1]);
    check(!row.track.tube && times.includes(own), `at t = ${t} it says ${words}`);
    return null;
  }
  return [Number(lo), Number(hi)];
}

async function readouts(section, data) {
  const over = section.querySelector(".tracks .u-over"), box = over.getBoundingClientRect();
  const seen = new Set();
  for (let x = 3; x < box.width; x += 2.3) {
    over.dispatchEvent(new MouseEvent("mousemove", { clientX: box.left + x, clientY: box.top + 20, bubbles: true }));
    await wait(20);
    const said = section.querySelector(".readout").textContent;
    if (seen.has(said)) continue;
    seen.add(said);
    const [head, ...words] = said.split(" \u00b7 "), t = Number(head.replace("t = ", ""));
    check(Number.isFinite(t) && words.length > 0, `under the pointer it says: ${said}`);
    const sets = words.map(one => heldAt(one, t, data, 0)).filter(Boolean);
    check(Math.max(...sets.map(s => s[0])) <= Math.min(...sets.map(s => s[1])), `disjoint proofs: ${said}`);
  }
  check(seen.size > 20, `${seen.size} readouts`);
  const all = [...seen].join("\n");
  if (!data.sample) return;
  for (const part of [" from t = ", " at t = ", "\u00b1"]) check(all.includes(part), `no readout says${part}`);
}

// A combination that says nothing between its steps is not drawn there.
async function gaps(section, data, legend) {
  const rows = data.rows.filter(row => row.track), k = rows.findIndex(row => !row.track.tube);
  if (k < 0) return;
  const on = legend.filter(made => made.getAttribute("aria-pressed") === "true");
  on.forEach(made => made.click());
  legend[k].click();
  await wait(100);
  const wanted = channels(getComputedStyle(legend[k].querySelector("path")).fill).slice(0, 3);
  const canvas = section.querySelector(".tracks canvas"), pen = canvas.getContext("2d");
  const { data: points, width, height } = pen.getImageData(0, 0, canvas.width, canvas.height);
  const near = i => wanted.every((c, n) => Math.abs(points[4 * i + n] - c) < 24) && points[4 * i + 3] > 127;
  let columns = 0;
  for (let x = 0; x < width; x++) {
    for (let y = 0; y < height; y++) if (near(y * width + x)) { columns++; break; }
  }
  const instants = rows[k].track.t.length;
  check(columns >= instants / 2 && columns <= 4 * instants * devicePixelRatio,
    `${instants} instants are drawn in ${columns} columns of ${width}`);
  legend[k].click();
  on.forEach(made => made.click());
  await wait(100);
}

async function look() {
  for (const section of all(".comparison")) {
    const data = comparisons[Number(section.dataset.number)];
    section.scrollIntoView();
    dispatchEvent(new Event("scroll")); // without a screen none is sent
    await wait(100);
    const rows = section.querySelectorAll("tr[data-row]");
    same(rows.length, data.rows.length, "rows of the table");
    if (data.quantities.length > 0) await diagram(section, data);
    if (data.rows.some(row => row.track) && data.names.length > 0) await bands(section, data);
  }
  scrollTo(0, 0);
}

// probe_compare.js -- looks at the page of comparisons as a reader does: marks, tips, curves and bands.
const { comparisons } = JSON.parse(document.getElementById("data").textContent);

// How many points of a canvas are not empty.
function inked(canvas) {
  const copy = document.createElement("canvas");
  Object.assign(copy, { width: canvas.width, height: canvas.height });
  const pen = copy.getContext("2d", { willReadFrequently: true });
  pen.drawImage(canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
  return count;
}

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

// The words under the pointer, under a finger and at the focus are those of the row of the table.
async function tips(section, data) {
  const svg = section.querySelector("svg.plot"), marks = [...section.querySelectorAll(".mark")];
  if (marks.length === 0) return;
  svg.scrollIntoView({ block: "center" });
  await wait(50);
  for (const type of ["pointermove", "pointerdown"]) {
    const at = marks[0].getBoundingClientRect();
    const place = { clientX: at.left + at.width / 2, clientY: at.top + at.height / 2, bubbles: true };
    svg.dispatchEvent(new PointerEvent(type, place));
    check(!by("tip").hidden, `${type} shows no tip`);
    const said = by("tip").textContent;
    check(data.rows.some(row => said.includes(row.label)), `the tip says ${said}`);
    const box = by("tip").getBoundingClientRect();
    check(box.left >= 0 && box.right <= innerWidth, "the tip leaves the window");
    fits();
    svg.dispatchEvent(new PointerEvent("pointermove", { clientX: -500, clientY: -500, bubbles: true }));
    check(by("tip").hidden, "the tip stays when the pointer has left");
  }
  marks.find(mark => mark.tabIndex === 0).focus();
  check(!by("tip").hidden, "the focus shows no tip");
  const first = by("tip").textContent;
  press(svg, "ArrowRight");
  if (marks.length > 1) check(by("tip").textContent !== first, "the arrow keys do not go on");
  press(document.body, "Escape");
  check(by("tip").hidden, "Escape does not hide the tip");
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
  await tips(section, data);
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
  const over = section.querySelector(".tracks .u-over"), box = over.getBoundingClientRect();
  const place = { clientX: box.left + box.width / 2, clientY: box.top + 20, bubbles: true };
  over.dispatchEvent(new MouseEvent("mousemove", place));
  await wait(100);
  const said = section.querySelector(".readout").textContent;
  check(/t = /.test(said) && /\[/.test(said), `under the pointer it says: ${said}`);
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

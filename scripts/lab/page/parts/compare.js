// compare.js -- the page of comparisons: a diagram and plots over time for each, made when they come into sight.
const { comparisons } = JSON.parse(by("data").textContent);

function showDiagram(place, data, rows) {
  place.append(make("h3", "Work against precision"));
  const diagram = new Diagram(place, data, rows);
  if (data.quantities.length > 1) {
    place.insertBefore(choice("what is across", data.quantities, diagram.quantity, q => diagram.show(q)), diagram.svg);
  }
  const entries = diagram.families.map((text, k) =>
    ({ text, on: true, colour: paint(k), shape: SHAPES[k % SHAPES.length] }));
  const legend = new Legend(place, "curves", entries, (k, on) => diagram.toggle(diagram.families[k], on));
  place.insertBefore(legend.list, diagram.note);
}

// Names in a box of their own, if there are many.
function chooseNames(tools, bands) {
  if (bands.data.names.length <= NAMES_AT_FIRST) return;
  const select = make("select");
  bands.data.names.forEach((name, k) => {
    if (k % NAMES_AT_FIRST !== 0) return;
    const last = Math.min(k + NAMES_AT_FIRST, bands.data.names.length) - 1;
    const option = make("option", k === last ? name : `${name} to ${bands.data.names[last]}`);
    option.value = k;
    select.append(option);
  });
  select.setAttribute("aria-label", "which names");
  select.addEventListener("change", () => {
    const from = Number(select.value);
    bands.names = bands.data.names.map((_, k) => k).slice(from, from + NAMES_AT_FIRST);
    bands.draw();
  });
  tools.append(select);
}

function showBands(place, data) {
  place.append(make("h3", "Enclosures over time"));
  const tools = place.appendChild(make("div", undefined, "tools")), bands = new Bands(place, data);
  const numbers = data.rows.map((_, k) => k).filter(k => data.rows[k].track);
  const first = new Set(bands.first([...numbers]));
  const entries = numbers.map(k => ({ text: data.rows[k].label, on: first.has(k), shape: "M-8-4H8V4H-8Z",
    colour: first.has(k) ? bands.switch(k, true) : "" }));
  if (first.size > 0 && bands.thin()) bands.mode = "width";
  tools.append(choice("what is drawn", [["enclosure", "enclosures"], ["width", "widths"]], bands.mode, mode => {
    bands.mode = mode;
    bands.draw();
  }));
  chooseNames(tools, bands);
  const legend = new Legend(place, "combinations", entries, (k, on) => {
    entries[k].colour = bands.switch(numbers[k], on);
    bands.draw();
  });
  legend.list.classList.add("long");
  place.insertBefore(legend.list, bands.room);
  const notes = ["Bars: bounds at an instant. Boxes: bounds that hold all the time between two instants."];
  if (data.sample) notes.push("Dark dashes: the hull of sampled motions, which no enclosure can be inside of.");
  if (data.reference) notes.push("Dark dots: the reference.");
  place.append(make("p", notes.join(" "), "quiet"));
  bands.draw();
}

function fill(section) {
  const data = comparisons[Number(section.dataset.number)];
  const [diagram, tracks] = section.querySelectorAll(".diagram, .tracks");
  const rows = [...section.querySelectorAll("tr[data-row]")].sort((a, b) => a.dataset.row - b.dataset.row);
  if (data.quantities.length > 0) showDiagram(diagram, data, rows);
  if (data.names.length > 0 && data.rows.some(row => row.track)) showBands(tracks, data);
}

// Made when it comes near, or is printed: a page of many comparisons opens at once and takes little memory.
const NEAR = 800, waiting = new Set(document.querySelectorAll(".comparison"));

function arrive(section) {
  waiting.delete(section);
  fill(section);
}

function look() {
  for (const section of [...waiting]) {
    const { top, bottom } = section.getBoundingClientRect();
    if (top < innerHeight + NEAR && bottom > -NEAR) arrive(section);
  }
}

for (const section of waiting) {
  const data = comparisons[Number(section.dataset.number)];
  section.querySelector(".diagram").hidden = data.quantities.length === 0;
  section.querySelector(".tracks").hidden = data.names.length === 0 || !data.rows.some(row => row.track);
}
look();
addEventListener("scroll", look, { passive: true });
addEventListener("resize", look);
addEventListener("beforeprint", () => [...waiting].forEach(arrive));

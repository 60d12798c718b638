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

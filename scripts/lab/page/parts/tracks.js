// tracks.js -- plots over time with what chooses among them: names, combinations, enclosures or widths.
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

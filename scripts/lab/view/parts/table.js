// table.js -- what is known in numbers at the time of the slider. The texts of enclosures are shown as they came:
// rounded outward where they were computed.
function make(name, text, kind) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

class Ranges {
  constructor(place, values, section) {
    this.place = place;
    this.values = values;
    this.section = section;
  }

  show(model) {
    this.model = model;
    this.rows = [];
    this.place.replaceChildren();
    const head = make("tr");
    this.heads = ["", "", "width", "next"].map(kind => head.appendChild(make("th", "", kind)));
    this.heads[2].textContent = "width";
    const table = make("table"), top = make("thead");
    top.append(head);
    table.append(top, ...model.view.points.map((point, k) => this.body(point, k)));
    if (model.view.points.length > 0) this.place.append(table);
    else this.place.append(make("p", "No point was chosen.", "quiet"));
    this.showCoordinates(model.view.coordinates);
  }

  body(point, k) {
    const body = make("tbody"), title = make("tr"), name = make("th", "", "point");
    name.colSpan = 4;
    name.style.setProperty("--c", `var(--p${k % 8})`);
    name.append(make("i"), point.name);
    title.append(name);
    body.append(title);
    this.rows.push(["x", "y", "z"].map(letter => {
      const row = make("tr"), kinds = ["number", "number later width", "number later next"];
      const cells = kinds.map(kind => make("td", "", kind));
      row.append(make("td", letter, "letter"), ...cells);
      body.append(row);
      return cells;
    }));
    return body;
  }

  showCoordinates(coordinates) {
    this.section.hidden = coordinates.length === 0;
    this.values.replaceChildren();
    this.cells = coordinates.map(coordinate => {
      const row = make("tr"), cell = make("td", "", "number");
      row.append(make("th", coordinate.name), cell, make("td", coordinate.unit, "later"));
      this.values.append(row);
      return cell;
    });
  }

  at(i) {
    const { view, times } = this.model, later = view.swept[i];
    this.heads[1].textContent = times.length > 1 ? `at ${timeText(times[i])} s, m` : "range, m";
    this.heads[3].textContent = later ? `until ${timeText(times[i + 1])} s, m` : "";
    this.rows.forEach((rows, point) => rows.forEach((cells, k) => {
      const now = view.boxes[i][point][k];
      cells[0].textContent = now;
      cells[1].textContent = widthText(now);
      cells[2].textContent = later ? later[point][k] : "";
    }));
    this.cells.forEach((cell, k) => { cell.textContent = view.values[i][k]; });
  }
}

// main.js -- the page: its parts, put together.
const by = id => document.getElementById(id);

addEventListener("error", event => {
  by("problem").hidden = false;
  by("problem").textContent = "This page failed: " + event.message;
});

const data = JSON.parse(by("data").textContent);
const models = data.views.map(view => new Model(view));
const drawing = new Drawing(by("drawing"));
const ranges = new Ranges(by("ranges"), by("values"), by("coordinates"));
const player = new Player({ time: by("time"), play: by("play"), now: by("now"), speed: by("speed"),
  transport: by("transport") }, i => { drawing.at(i); ranges.at(i); });

const samples = {
  world: '<circle class="frame world" cx="13" cy="7" r="6"/>',
  frame: '<circle class="frame" cx="13" cy="7" r="4"/>',
  link: '<line class="line" x1="2" y1="7" x2="24" y2="7"/>',
  closure: '<line class="line closure" x1="0" y1="7" x2="26" y2="7"/>',
  force: '<line class="line force" x1="0" y1="7" x2="26" y2="7"/>',
  axis: '<line class="axis" x1="4" y1="11" x2="22" y2="3"/>',
  body: '<g class="body" transform="translate(13 7)"><circle r="6"/>'
    + '<path d="M0 0V-6A6 6 0 0 1 6 0ZM0 0V6A6 6 0 0 1-6 0Z"/></g>',
  now: '<rect class="box now" style="--c: var(--p0)" x="5" y="1" width="16" height="12"/>',
  next: '<rect class="box next" style="--c: var(--p0)" x="5" y="1" width="16" height="12"/>',
  swept: '<rect class="box swept" style="--c: var(--p0)" x="5" y="1" width="16" height="12"/>',
  path: '<polyline class="path" style="--c: var(--p0)" points="1,11 9,4 17,9 25,3"/>',
};

function legend(model) {
  const { view } = model, list = [["world", "world"], ["frame", "frame"]];
  const has = kind => view.lines.some(line => line.kind === kind);
  if (has("link")) list.push(["link", "link"]);
  if (view.axes.length) list.push(["axis", "axis of a joint"]);
  if (view.bodies.length) list.push(["body", "body"]);
  if (has("closure")) list.push(["closure", "closed loop"]);
  if (has("force")) list.push(["force", "force element"]);
  if (view.points.length) list.push(["now", "box at the instant"]);
  if (model.trail.length) list.push(["next", "all the way to the next"], ["swept", "swept before"]);
  if (model.last > 0 && view.points.length) list.push(["path", "motion of the midpoints"]);
  by("legend").replaceChildren(...list.map(([sample, text]) => {
    const item = make("li");
    item.innerHTML = `<svg aria-hidden="true">${samples[sample]}</svg>`;
    item.append(text);
    return item;
  }));
}

// What the boxes prove.
function meaning(model) {
  const { view } = model;
  if (!view.points.length) return "";
  if (!view.proved) return "The solver of this run proves nothing: these are approximations, not guaranteed ranges.";
  return "Every motion that the tolerances allow has each point inside its box"
    + (model.trail.length ? ", at the instant and all the way to the next. " : ". ")
    + "Bounds are rounded outward. The drawn mechanism is the motion of the midpoints, in plain numbers.";
}

function statusOf(view) {
  if (!view.proved) return ["unproved", `${view.status}, not proved`];
  return [view.status, view.status];
}

function describe(model) {
  const { view } = model, [kind, status] = statusOf(view);
  by("title").textContent = view.title;
  by("source").textContent = `mechanism ${view.mechanism}, ${view.frames.length} frames, from ${data.scene}`;
  by("status").className = "badge " + kind;
  by("status").textContent = view.reason ? `${status} at ${timeLabel(model.times[model.last])}` : status;
  by("reason").hidden = !view.reason;
  by("reason").textContent = view.reason;
  by("ranges-title").textContent = view.proved ? "Guaranteed ranges" : "Approximate values";
  by("meaning").textContent = meaning(model);
  by("facts").replaceChildren(...view.facts.flatMap(([name, text]) => [make("dt", name), make("dd", text)]));
  const notes = model.stride > 1
    ? [...view.notes, `each drawn box of the way so far covers ${model.stride} instants`] : view.notes;
  by("notes").replaceChildren(...notes.map(text => make("li", text)));
  by("triads").checked = drawing.triads = view.turn[0].length > 0 && view.frames.length <= 14;
  by("triads").parentElement.hidden = view.turn[0].length === 0;
  legend(model);
}

function show(number) {
  const model = models[number];
  by("which").value = number;
  describe(model);
  drawing.show(model);
  ranges.show(model);
  player.show(model);
  drawing.moved();
}

drawing.moved = () => {
  drawing.draw();
  for (const button of by("sides").children) {
    button.setAttribute("aria-pressed", String(button.dataset.side === drawing.camera.side));
  }
};

// -- controls

by("which").append(...data.views.map((view, k) => {
  const option = make("option", view.title);
  option.value = k;
  return option;
}));
by("which").hidden = data.views.length < 2;
by("which").addEventListener("change", () => show(Number(by("which").value)));
by("sides").addEventListener("click", event => {
  if (event.target.dataset.side) drawing.look(event.target.dataset.side);
  drawing.moved();
});
by("fit").addEventListener("click", () => drawing.fit());
by("closer").addEventListener("click", () => { drawing.camera.zoom(1.25); drawing.moved(); });
by("farther").addEventListener("click", () => { drawing.camera.zoom(0.8); drawing.moved(); });
by("boxes").addEventListener("change", () => { drawing.shows = by("boxes").value; drawing.draw(); });
by("triads").addEventListener("change", () => { drawing.triads = by("triads").checked; drawing.draw(); });
takeHands(drawing);

// #t=0.5&side=xz&boxes=all&model=2: a place in the page that can be linked to.
function followAddress() {
  const asked = new URLSearchParams(location.hash.slice(1)), model = Number(asked.get("model"));
  if (models[model - 1]) show(model - 1);
  if (asked.has("boxes")) by("boxes").value = drawing.shows = asked.get("boxes");
  if (sides[asked.get("side")] || asked.get("side") === "3d") drawing.look(asked.get("side"));
  if (asked.has("t") && Number.isFinite(Number(asked.get("t")))) player.at(player.model.nearest(Number(asked.get("t"))));
  drawing.moved();
}

by("made").textContent = `made by Ambit ${data.ambit}: ambit view ${data.scene}`;
show(0);
followAddress();
addEventListener("hashchange", followAddress);
new ResizeObserver(() => drawing.resize(true)).observe(by("drawing"));

// bands.js -- enclosures over time: one plot for each name, the chosen combinations, the hull of the samples and the
// reference in them. At its instants a combination is a bar, between them the tube that holds there all the time is a
// box; nothing is drawn where nothing is known. uPlot makes the axes.
const SHOWN_AT_FIRST = 3, NAMES_AT_FIRST = 8, FAR = 3, THIN = 0.02, MANY = 60, HEIGHT = 240;

const half = text => text.replace(")", ", 0.16)").replace("rgb(", "rgba(");
const label = x => String(Number(x.toPrecision(10)));
// Three digits, not below x: a width that is proved stays one.
const upward = x => Number(x.toPrecision(3)) >= x ? x.toPrecision(3) : (x * 1.005).toPrecision(3);

const span = (lo, hi) => `[${lo}, ${hi}]`;

// The number of the part of a track that t is in: from its instant to the next one; -1: in none.
const partOf = (times, t) => times.findIndex((at, k) =>
  k + 1 < times.length && Math.min(at, times[k + 1]) < t && t < Math.max(at, times[k + 1]));

// What is known of a layer at its instant k, as words.
function known({ lo, hi, error, only }, k, isWidth) {
  if (lo[k] === null || !only && hi[k] === null) return "";
  if (only) return lo[k];
  if (isWidth) return upward(hi[k] - lo[k]);
  return lo[k] === hi[k] && error && error[k] > 0 ? `${lo[k]} \u00b1 ${upward(error[k])}` : span(lo[k], hi[k]);
}

function told(layer, t, isWidth) {
  const { text, t: times, tube } = layer, at = times.indexOf(t);
  const words = at >= 0 && known(layer, at, isWidth);
  if (words) return `${text} ${words}`;
  const k = partOf(times, t);
  if (k < 0) return "";
  if (tube && !isWidth && tube.lo[k] !== null && tube.hi[k] !== null) {
    return `${text} ${span(tube.lo[k], tube.hi[k])} from t = ${times[k]} to ${times[k + 1]}`;
  }
  const own = known(layer, k, isWidth);
  return own ? `${text} ${own} at t = ${times[k]}` : "";
}

class Bands {
  constructor(place, data) {
    this.data = data;
    this.place = place;
    this.mode = "enclosure";
    this.chosen = new Map(); // number of the row -> its colour
    this.plots = [];
    this.room = place.appendChild(make("div", undefined, "grid-of-plots"));
    this.names = data.names.map((_, k) => k).slice(0, NAMES_AT_FIRST);
    addEventListener("scheme", () => this.plots.forEach(({ plot }) => plot.redraw(false)));
    new ResizeObserver(() => this.resize()).observe(this.room);
  }

  // Some of the front from the tightest to the fastest, then failures of other families that came far.
  first(numbers) {
    const { rows } = this.data, end = k => Math.abs(rows[k].track.t.at(-1) - rows[k].track.t[0]);
    const front = numbers.filter(k => rows[k].pareto), complete = numbers.filter(k => rows[k].status === "complete");
    const able = (front.length > 0 ? front : complete).sort((a, b) => rows[a].width - rows[b].width);
    const some = able.length <= SHOWN_AT_FIRST ? able : [able[0], able[Math.floor(able.length / 2)], able.at(-1)];
    const rest = numbers.filter(k => rows[k].status !== "complete").sort((a, b) => end(b) - end(a));
    return [...some, ...rest].slice(0, SHOWN_AT_FIRST);
  }

  // The first colour that no other has; the family's own, if it is free.
  colourFor(k) {
    const families = [...new Set(this.data.rows.map(row => row.family))], taken = new Set(this.chosen.values());
    const wanted = families.indexOf(this.data.rows[k].family) % COLOURS;
    const free = [wanted, ...Array(COLOURS).keys()].find(n => !taken.has(n));
    return free === undefined ? wanted : free;
  }

  switch(k, on) {
    if (on) this.chosen.set(k, this.colourFor(k));
    else this.chosen.delete(k);
    return paint(this.chosen.get(k) || 0);
  }

  // Are the chosen bands too narrow to be seen beside what the values do?
  thin() {
    let widest = 0;
    for (const name of this.names) {
      for (const { lo, hi } of this.layers(name).filter(layer => layer.hi)) {
        const places = lo.map((_, i) => i).filter(i => lo[i] !== null && hi[i] !== null);
        const range = Math.max(...places.map(i => hi[i])) - Math.min(...places.map(i => lo[i]));
        for (const i of places) if (range > 0) widest = Math.max(widest, (hi[i] - lo[i]) / range);
      }
    }
    return widest > 0 && widest < THIN;
  }

  // -- the plots

  draw() {
    this.plots.forEach(({ plot }) => plot.destroy());
    this.room.replaceChildren();
    this.plots = this.names.map(name => this.plot(name));
  }

  layers(name) {
    const { rows, sample, reference } = this.data;
    const list = [...this.chosen].map(([k, c]) => ({ text: rows[k].label, track: rows[k].track, c: paint(c) }));
    if (sample) list.push({ text: "sampled hull", track: sample, c: "--ink", sampled: true });
    const bands = list.map(({ text, track, c, sampled }) => ({ text, c, sampled, t: track.t, lo: track.lo[name],
      hi: track.hi[name], error: track.error && track.error[name],
      tube: track.tube && { lo: track.tube.lo[name], hi: track.tube.hi[name] } }));
    if (reference && reference.x[name].some(x => x !== null)) {
      bands.push({ text: "reference", c: "--ink", t: reference.t, lo: reference.x[name], only: true });
    }
    return bands;
  }

  // The range that shows the tightest band well; what leaves it by far is cut off.
  range(layers) {
    const ends = layers.map(({ lo, hi, tube }) => {
      const all = [...lo, ...(hi || []), ...(tube ? [...tube.lo, ...tube.hi] : [])].filter(x => x !== null);
      return all.length ? [Math.min(...all), Math.max(...all)] : null;
    }).filter(Boolean);
    if (ends.length === 0) return [0, 1];
    const best = ends.filter(([a, b]) => b > a).sort((p, q) => (p[1] - p[0]) - (q[1] - q[0]))[0];
    let [low, high] = [Math.min(...ends.map(e => e[0])), Math.max(...ends.map(e => e[1]))];
    if (best) {
      const room = FAR * (best[1] - best[0]);
      [low, high] = [Math.max(low, best[0] - room), Math.min(high, best[1] + room)];
    }
    const margin = 0.06 * (high - low) || Math.abs(low) * 1e-3 || 1;
    return [low - margin, high + margin];
  }

  // Points for the scales; in the mode of widths they are all that is drawn.
  series(layers) {
    const series = [{ label: "t" }], tables = [], isWidth = this.mode === "width";
    for (const layer of layers) {
      const widths = layer.hi && layer.lo.map((lo, i) => lo === null || layer.hi[i] === null || !(layer.hi[i] > lo)
        ? null : layer.hi[i] - lo);
      const points = isWidth ? widths : layer.lo;
      if (!points) continue;
      series.push({ label: layer.text, stroke: () => colour(layer.c), paths: () => null,
        points: { show: isWidth, size: layer.t.length > MANY ? 3 : 5, fill: () => colour(layer.c) } });
      tables.push([layer.t, points]);
    }
    return { series, data: tables.length > 0 ? uPlot.join(tables) : [[]] };
  }

  // What is known in the plot of enclosures, where it is known.
  paint(plot, layers) {
    if (this.mode === "width") return;
    const { ctx, bbox } = plot, dot = devicePixelRatio || 1;
    const x = t => plot.valToPos(t, "x", true), y = value => plot.valToPos(value, "y", true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const layer of layers) {
      ctx.strokeStyle = colour(layer.c);
      this.boxes(ctx, layer, x, y, dot);
      ctx.fillStyle = colour(layer.c);
      this.bars(ctx, layer, x, y, dot);
    }
    ctx.restore();
  }

  boxes(ctx, { t, tube, c }, x, y, dot) {
    ctx.fillStyle = half(colour(c));
    ctx.lineWidth = 0.5 * dot;
    for (let k = 0; tube && k + 1 < t.length; k++) {
      if (tube.lo[k] === null || tube.hi[k] === null) continue;
      const [left, top] = [Math.min(x(t[k]), x(t[k + 1])), y(tube.hi[k])];
      const place = [left, top, Math.abs(x(t[k + 1]) - x(t[k])), y(tube.lo[k]) - top];
      ctx.fillRect(...place);
      ctx.strokeRect(...place);
    }
  }

  // Upright bars, at least as high as they can be seen; of the samples two short lines, of the reference a dot.
  bars(ctx, { t, lo, hi, sampled, only }, x, y, dot) {
    t.forEach((at, k) => {
      const bounds = only ? [lo[k], lo[k]] : [lo[k], hi[k]];
      if (bounds.includes(null)) return;
      const [low, high] = bounds.map(y);
      if (only) {
        ctx.beginPath();
        ctx.arc(x(at), low, 3.5 * dot, 0, 2 * Math.PI);
        ctx.fill();
      } else if (sampled) {
        for (const end of [low, high]) ctx.fillRect(x(at) - 2 * dot, end - 0.5 * dot, 4 * dot, dot);
      } else {
        const height = Math.max(low - high, 2 * dot);
        ctx.fillRect(x(at) - 0.75 * dot, (low + high - height) / 2, 1.5 * dot, height);
      }
    });
  }

  axes() {
    const look = { stroke: () => colour("--quiet"), grid: { stroke: () => colour("--grid"), width: 1 },
      ticks: { stroke: () => colour("--grid"), width: 1 }, font: "12px system-ui, sans-serif" };
    const logarithmic = this.mode === "width";
    const powers = (_, list) => list.map(x => x > 0 && Math.abs(Math.log10(x) % 1) < 1e-6 ? x : null);
    const few = logarithmic
      ? { filter: powers, grid: { ...look.grid, filter: powers }, ticks: { ...look.ticks, filter: powers } } : {};
    const said = x => x === null ? "" : logarithmic ? powerText(x) : label(x);
    const wide = (_, values) => Math.max(40, 16 + 7 * Math.max(0, ...(values || []).map(v => (v || "").length)));
    return [{ ...look, label: "t, s", labelSize: 18, labelFont: look.font, size: 30, space: 60 },
      { ...look, ...few, size: wide, values: (_, list) => list.map(said) }];
  }

  plot(name) {
    const box = this.room.appendChild(make("figure", undefined, "band"));
    const unit = this.data.units[name], title = this.data.names[name] + (unit ? `, ${unit}` : "");
    box.append(make("figcaption", this.mode === "width" ? `width of ${title}` : title));
    const canvas = box.appendChild(make("div")), read = make("p", "", "quiet readout");
    box.append(read);
    const layers = this.layers(name), { series, data } = this.series(layers);
    const linear = { range: () => this.range(layers) }, logarithmic = { distr: 3 };
    const plot = new uPlot({ width: this.width(), height: HEIGHT, series, axes: this.axes(),
      legend: { show: false },
      scales: { x: { time: false }, y: this.mode === "width" ? logarithmic : linear },
      cursor: { points: { show: false }, y: false },
      hooks: { draw: [u => this.paint(u, layers)], setCursor: [u => this.read(u, layers, read)] } }, data, canvas);
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", `${title} over time: ${layers.map(layer => layer.text).join(", ")}`);
    return { plot, read };
  }

  // What each layer says of the instant under the cursor: what holds at it, or all the time around it, or, with its own
  // time, what was known last.
  read(plot, layers, place) {
    const i = plot.cursor.idx;
    if (i === null || i === undefined) return;
    const t = plot.data[0][i], words = layers.map(layer => told(layer, t, this.mode === "width")).filter(Boolean);
    place.textContent = [`t = ${t}`, ...words].join(" \u00b7 ");
  }

  width() { return Math.max(220, this.room.firstChild ? this.room.firstChild.clientWidth : this.room.clientWidth); }

  resize() { for (const { plot } of this.plots) plot.setSize({ width: this.width(), height: HEIGHT }); }
}

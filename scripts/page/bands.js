// bands.js -- enclosures over time: one plot for each name, a band for each chosen combination, the hull of the samples
// and the reference in them. Drawn by uPlot.
const SHOWN_AT_FIRST = 3, NAMES_AT_FIRST = 8, FAR = 3, FEW = 30, THIN = 0.02, HEIGHT = 240;

const half = text => text.replace(")", ", 0.16)").replace("rgb(", "rgba(");
const label = x => String(Number(x.toPrecision(10)));
// Three digits, not below x: a width that is proved stays one.
const upward = x => Number(x.toPrecision(3)) >= x ? x.toPrecision(3) : (x * 1.005).toPrecision(3);

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
    const list = [...this.chosen].map(([k, c]) => ({ text: rows[k].label, track: rows[k].track, colour: paint(c) }));
    if (sample) list.push({ text: "sampled hull", track: sample, colour: "--ink", dash: [3, 3] });
    const bands = list.map(({ text, track, colour: c, dash }) =>
      ({ text, c, dash, t: track.t, lo: track.lo[name], hi: track.hi[name] }));
    if (reference && reference.x[name].some(x => x !== null)) {
      bands.push({ text: "reference", c: "--ink", t: reference.t, lo: reference.x[name], only: true });
    }
    return bands;
  }

  // The range that shows the tightest band well; what leaves it by far is cut off.
  range(layers) {
    const ends = layers.map(({ lo, hi }) => {
      const all = [...lo, ...(hi || [])].filter(x => x !== null);
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

  // One line or two for a layer, and the band between them.
  series(layers) {
    const series = [{ label: "t" }], bands = [], tables = [];
    for (const layer of layers) {
      const widths = layer.hi && layer.lo.map((lo, i) => lo === null || layer.hi[i] === null || !(layer.hi[i] > lo)
        ? null : layer.hi[i] - lo);
      const lines = this.mode === "width" ? [widths] : layer.only ? [layer.lo] : [layer.hi, layer.lo];
      if (!lines[0]) continue;
      const single = lines[0].filter(x => x !== null).length < 2;
      const dots = layer.only && layer.t.length <= FEW;
      lines.forEach(() => series.push({ label: layer.text, stroke: () => colour(layer.c), width: 1.5, dash: layer.dash,
        points: { show: single || dots, size: 7 }, ...(dots && { paths: () => null }) }));
      if (lines.length === 2) {
        bands.push({ series: [series.length - 2, series.length - 1], fill: () => half(colour(layer.c)) });
      }
      tables.push([layer.t, ...lines]);
    }
    return { series, bands, data: tables.length > 0 ? uPlot.join(tables) : [[]] };
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
    const layers = this.layers(name), { series, bands, data } = this.series(layers);
    const linear = { range: () => this.range(layers) }, logarithmic = { distr: 3 };
    const plot = new uPlot({ width: this.width(), height: HEIGHT, series, bands, axes: this.axes(),
      legend: { show: false },
      scales: { x: { time: false }, y: this.mode === "width" ? logarithmic : linear },
      cursor: { points: { show: false }, y: false },
      hooks: { setCursor: [u => this.read(u, name, read)] } }, data, canvas);
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", `${title} over time: ${layers.map(layer => layer.text).join(", ")}`);
    return { plot, read };
  }

  // What each layer says at the last of its instants up to the cursor.
  read(plot, name, place) {
    const i = plot.cursor.idx;
    if (i === null || i === undefined) return;
    const t = plot.data[0][i], words = [`t = ${label(t)}`];
    for (const { text, t: times, lo, hi, only } of this.layers(name)) {
      const k = times.findLastIndex(at => at <= t);
      if (k < 0 || lo[k] === null) continue;
      const band = () => this.mode === "width" ? upward(hi[k] - lo[k]) : `[${lo[k]}, ${hi[k]}]`;
      words.push(`${text} ${only ? lo[k] : band()}`);
    }
    place.textContent = words.join(" \u00b7 ");
  }

  width() { return Math.max(220, this.room.firstChild ? this.room.firstChild.clientWidth : this.room.clientWidth); }

  resize() { for (const { plot } of this.plots) plot.setSize({ width: this.width(), height: HEIGHT }); }
}

// model.js -- one mechanism of the page's data, with what is read off it once: boxes as numbers, its extent.
const MOST_SWEPT = 600; // outlines of swept boxes that are drawn; more are put together

class Model {
  constructor(view) {
    this.view = view;
    this.times = view.t.map(Number);
    this.last = this.times.length - 1;
    this.now = view.boxes.map(list => list.map(boxOf));
    this.next = view.swept.map(list => list ? list.map(boxOf) : []);
    this.joinSwept();
    this.measure();
  }

  position(i, frame) { return this.view.position[i].slice(3 * frame, 3 * frame + 3); }

  // Swept boxes for the trail: { point, first, last, box }, each the hull of `stride` of them in a row.
  joinSwept() {
    const intervals = this.next.length, points = this.view.points.length;
    this.stride = Math.max(1, Math.ceil(intervals * points / MOST_SWEPT));
    this.trail = [];
    for (let point = 0; point < points; point++) {
      for (let first = 0; first < intervals; first += this.stride) {
        const last = Math.min(first + this.stride, intervals) - 1;
        let box = null, whole = true;
        for (let i = first; i <= last; i++) {
          whole = whole && Boolean(this.next[i][point]);
          box = hullOfBoxes(box, this.next[i][point]);
        }
        if (box && whole) this.trail.push({ point, first, last, box });
      }
    }
  }

  // The places to be seen: all drawn positions, and boxes as far as they are not much larger than the mechanism.
  measure() {
    const places = [];
    for (const list of [...this.view.position, ...this.view.centre]) {
      for (let k = 0; k + 2 < list.length; k += 3) {
        if (finite(list.slice(k, k + 3))) places.push(list.slice(k, k + 3));
      }
    }
    let around = places.reduce((box, p) => hullOfBoxes(box, p.map(c => [c, c])), null) || [[0, 0], [0, 0], [0, 0]];
    const reach = Math.max(...around.map(side => side[1] - side[0]));
    const limit = around.map(side => [side[0] - reach, side[1] + reach]);
    const boxes = [...this.trail.map(entry => entry.box), ...this.now.flat()].filter(Boolean);
    for (const box of boxes) {
      const within = (c, k) => reach > 0 ? Math.max(limit[k][0], Math.min(limit[k][1], c)) : c;
      const part = box.map((side, k) => side.map(c => within(c, k)));
      around = hullOfBoxes(around, part);
      places.push(...corners(part));
    }
    this.places = places;
    this.extent = around.map(side => side[1] - side[0]);
    this.size = Math.max(...this.extent) || 1;
  }

  // The axis that gravity points against, else z.
  upward() {
    const g = this.view.gravity || [0, 0, 0];
    const largest = [0, 1, 2].reduce((best, k) => Math.abs(g[k]) > Math.abs(g[best]) ? k : best, 2);
    return [letters.x, letters.y, letters.z][largest];
  }

  // A flat mechanism is looked at from its front.
  side() {
    const flat = this.extent.map(e => e <= 0.02 * this.size);
    if (flat[2]) return "xy";
    if (flat[1]) return "xz";
    return flat[0] ? "yz" : "3d";
  }

  nearest(t) {
    let best = 0;
    this.times.forEach((time, i) => { if (Math.abs(time - t) < Math.abs(this.times[best] - t)) best = i; });
    return best;
  }
}

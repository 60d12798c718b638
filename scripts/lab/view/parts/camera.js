// camera.js -- an orthographic look at the scene: turned about the upward axis, tilted, moved, scaled.
const letters = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const sides = {
  xy: { right: letters.x, up: letters.y },
  xz: { right: letters.x, up: letters.z },
  yz: { right: letters.y, up: letters.z },
};

class Camera {
  constructor() {
    this.width = 800;
    this.height = 500;
    this.target = [0, 0, 0];
    this.scale = 100; // pixels per metre
    this.look("3d", letters.z);
  }

  // "xy", "xz", "yz": along the third axis; "3d": from the front, a little from the right and from above.
  look(side, upward) {
    const front = sides[side] || sides[upward === letters.y ? "xy" : upward === letters.x ? "yz" : "xz"];
    this.side = side;
    this.right0 = sides[side] || upward !== letters.x ? front.right : letters.y;
    this.up0 = sides[side] ? front.up : upward;
    this.toward0 = cross(this.right0, this.up0);
    this.turn = sides[side] ? 0 : 0.55;
    this.tilt = sides[side] ? 0 : 0.38;
    this.aim();
  }

  aim() {
    const c = Math.cos(this.turn), s = Math.sin(this.turn), ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    const toward = plus(scaled(this.toward0, c), scaled(this.right0, s));
    this.right = minus(scaled(this.right0, c), scaled(this.toward0, s));
    this.up = minus(scaled(this.up0, ct), scaled(toward, st));
  }

  rotate(dx, dy) {
    this.side = "";
    this.turn -= dx * 0.008;
    this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.tilt + dy * 0.008));
    this.aim();
  }

  pan(dx, dy) {
    this.target = minus(this.target, plus(scaled(this.right, dx / this.scale), scaled(this.up, -dy / this.scale)));
  }

  // Closer by a factor; the place at (x, y) stays where it is.
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const dx = x - this.width / 2, dy = y - this.height / 2;
    this.pan(-dx, -dy);
    this.scale = Math.max(1e-9, Math.min(1e12, this.scale * factor));
    this.pan(dx, dy);
  }

  project(p) {
    const d = minus(p, this.target);
    return [this.width / 2 + this.scale * dot(d, this.right), this.height / 2 - this.scale * dot(d, this.up)];
  }

  // So that all the points are seen.
  fit(points) {
    let low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (const p of points) {
      const at = [dot(p, this.right), dot(p, this.up)];
      low = [Math.min(low[0], at[0]), Math.min(low[1], at[1])];
      high = [Math.max(high[0], at[0]), Math.max(high[1], at[1])];
    }
    if (!finite(low) || !finite(high)) return;
    const margin = Math.min(70, 0.12 * Math.min(this.width, this.height) + 12);
    const size = [Math.max(high[0] - low[0], 1e-9), Math.max(high[1] - low[1], 1e-9)];
    this.scale = Math.min((this.width - 2 * margin) / size[0], (this.height - 2 * margin) / size[1]);
    if (!Number.isFinite(this.scale) || this.scale > 1e8) this.scale = 100;
    const middle = plus(scaled(this.right, (low[0] + high[0]) / 2), scaled(this.up, (low[1] + high[1]) / 2));
    const toward = cross(this.right, this.up);
    this.target = plus(middle, scaled(toward, dot(this.target, toward)));
  }
}

// player.js -- the time slider, play and pause.
const SECONDS = 6; // a run that is much shorter or longer is played in this time

class Player {
  constructor(parts, changed) {
    this.parts = parts;
    this.changed = changed;
    this.playing = 0;
    parts.time.addEventListener("input", () => { this.pause(); this.at(Number(parts.time.value)); });
    parts.time.addEventListener("change", () => this.remember());
    parts.play.addEventListener("click", () => this.playing ? this.pause() : this.play());
  }

  show(model) {
    this.pause();
    this.model = model;
    this.parts.transport.hidden = model.last === 0;
    this.parts.time.max = model.last;
    this.at(0);
  }

  at(i) {
    const text = timeLabel(this.model.times[i]);
    this.index = i;
    this.parts.time.value = i;
    this.parts.time.setAttribute("aria-valuetext", text);
    this.parts.now.textContent = text;
    this.changed(i);
  }

  // The address then says where the slider is.
  remember() { history.replaceState(null, "", `#t=${this.model.times[this.index]}`); }

  label(symbol, name) {
    this.parts.play.textContent = symbol;
    this.parts.play.setAttribute("aria-label", name);
  }

  pause() {
    if (!this.playing) return;
    clearInterval(this.playing);
    this.playing = 0;
    this.label("\u25b6", "play");
  }

  play() {
    const { times, last } = this.model, whole = times[last] - times[0], length = Math.abs(whole);
    const duration = length >= 1.5 && length <= 30 ? length : SECONDS;
    let done = this.index === last ? 0 : (times[this.index] - times[0]) / whole, before = performance.now();
    const tick = () => {
      const now = performance.now();
      done += (now - before) / 1000 / duration * Number(this.parts.speed.value);
      before = now;
      const i = done >= 1 ? last : this.model.nearest(times[0] + done * whole);
      if (i !== this.index) this.at(i);
      if (done >= 1) this.pause();
    };
    this.label("\u275a\u275a", "pause");
    this.playing = setInterval(tick, 25);
  }
}

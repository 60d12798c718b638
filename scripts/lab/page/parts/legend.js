// legend.js -- buttons that switch what is drawn on and off.
// entries: [{ text, swatch = SVG inside of 18 x 14, colour, on }]; act(k, on)
class Legend {
  constructor(place, label, entries, act) {
    Object.assign(this, { entries, act });
    this.list = place.appendChild(make("ul", undefined, "legend"));
    this.list.setAttribute("aria-label", label);
    this.buttons = entries.map((entry, k) => {
      const item = this.list.appendChild(make("li")), made = button("", "", () => this.turn(k, !this.isOn(k)));
      const picture = element(made, "svg", { "aria-hidden": true, width: 18, height: 14, viewBox: "-9 -7 18 14" });
      element(picture, "path", { d: entry.shape });
      made.append(make("span", entry.text));
      item.append(made);
      this.mark(made, entry);
      return made;
    });
    if (entries.length > 2) this.addAll();
  }

  addAll() {
    for (const [text, on] of [["all", true], ["none", false]]) {
      const item = this.list.appendChild(make("li"));
      item.append(button(text, "plain", () => this.entries.forEach((_, k) => {
        if (this.isOn(k) !== on) this.turn(k, on);
      })));
    }
  }

  isOn(k) { return this.entries[k].on; }

  mark(made, entry) {
    made.setAttribute("aria-pressed", String(entry.on));
    made.style.setProperty("--c", entry.on ? `var(${entry.colour})` : "var(--quiet)");
  }

  turn(k, on) {
    const entry = this.entries[k];
    entry.on = on;
    this.act(k, on);
    this.mark(this.buttons[k], entry);
  }
}

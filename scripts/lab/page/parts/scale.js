// scale.js -- logarithmic scales: their ends, and where they are marked.
const superscripts = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075",
  6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079" };

// 0.001 -> "10⁻³", 20 -> "20", 2e-7 -> "2·10⁻⁷"
function powerText(x) {
  const exponent = Math.floor(Math.log10(x) + 1e-9), factor = Number((x / 10 ** exponent).toPrecision(5));
  if (exponent >= -2 && exponent <= 3) return String(Number(x.toPrecision(5)));
  const power = "10" + [...String(exponent)].map(letter => superscripts[letter]).join("");
  return factor === 1 ? power : `${factor}\u00b7${power}`;
}

const LEAST = 0.04; // decades that are shown at least

class LogScale {
  // values: any numbers; what is not positive and finite does not count
  constructor(values, from, to) {
    const logs = values.filter(x => x > 0 && x < Infinity).map(Math.log10);
    let low = Math.min(...logs), high = Math.max(...logs);
    if (logs.length === 0) [low, high] = [-3, 0];
    const margin = Math.max(0.06 * (high - low), (LEAST - (high - low)) / 2);
    Object.assign(this, { low: low - margin, high: high + margin, from, to });
  }

  at(x) {
    const share = (Math.log10(x) - this.low) / (this.high - this.low);
    return this.from + (this.to - this.from) * Math.max(0, Math.min(1, share));
  }

  // Round numbers with even distances, where the ends are close together.
  evenTicks(n) {
    const low = 10 ** this.low, high = 10 ** this.high, rough = (high - low) / n;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find(k => k * power >= rough) * power, list = [];
    for (let k = Math.ceil(low / step); k * step <= high; k++) list.push(Number((k * step).toPrecision(10)));
    return list;
  }

  // At most n marks or a few more: powers of ten, and some between them where few would be left.
  ticks(n) {
    const list = [], span = this.high - this.low;
    if (span < 0.9) return this.evenTicks(n);
    const step = [1, 2, 3, 5, 10, 20, 50, 100].find(k => k >= span / n) || 200;
    const factors = span < 1.6 ? [1, 2, 3, 5, 7] : span < 2.4 ? [1, 2, 5] : [1];
    for (let k = Math.floor(this.low); k <= this.high; k++) {
      if (k % step !== 0) continue;
      for (const factor of factors) {
        const x = Number(`${factor}e${k}`), log = Math.log10(x);
        if (log >= this.low && log <= this.high) list.push(x);
      }
    }
    return list;
  }
}

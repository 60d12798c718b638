// geometry.js -- vectors, enclosures as texts, outlines of boxes.
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const finite = list => list.every(Number.isFinite);

// The text of an enclosure, "[lo, hi]" or one number, as { lo, hi }; null: empty. The text is the proof; these bounds
// are for drawing and for widths.
function boundsOf(text) {
  if (text === "[empty]") return null;
  if (text === "[entire]") return { lo: -Infinity, hi: Infinity };
  const [lo, hi] = text.replace(/[[\]]/g, "").split(",").map(word => {
    const trimmed = word.trim();
    return trimmed.endsWith("inf") ? (trimmed[0] === "-" ? -Infinity : Infinity) : Number(trimmed);
  });
  return { lo, hi: hi === undefined ? lo : hi };
}

// Three texts as a box [[lo, hi], [lo, hi], [lo, hi]]; null: nothing that could be drawn.
function boxOf(texts) {
  if (!texts) return null;
  const sides = texts.map(boundsOf);
  if (sides.some(side => !side || !finite([side.lo, side.hi]))) return null;
  return sides.map(side => [side.lo, side.hi]);
}

function hullOfBoxes(a, b) {
  if (!a || !b) return a || b;
  return a.map((side, k) => [Math.min(side[0], b[k][0]), Math.max(side[1], b[k][1])]);
}

function corners(box) {
  const list = [];
  for (let k = 0; k < 8; k++) list.push([box[0][k & 1], box[1][(k >> 1) & 1], box[2][k >> 2]]);
  return list;
}

// The convex hull of points in the plane, in order (Andrew's monotone chain).
function convexHull(points) {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = list => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1) {
        const a = chain[chain.length - 2], b = chain[chain.length - 1];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return half(sorted).concat(half(sorted.slice().reverse()));
}

// A decimal text as digits times a power of ten.
function decimalOf(text) {
  const [mantissa, exponent = "0"] = text.trim().split("e"), [whole, fraction = ""] = mantissa.split(".");
  return { digits: BigInt(whole + fraction), exponent: Number(exponent) - fraction.length };
}

// The width of an enclosure from the digits of its text: exact, then three digits of it, rounded up.
function widthText(text) {
  const bounds = boundsOf(text);
  if (!bounds) return "empty";
  if (!finite([bounds.lo, bounds.hi])) return "unbounded";
  if (!text.includes(",")) return "0";
  const [lo, hi] = text.slice(1, -1).split(",").map(decimalOf), exponent = Math.min(lo.exponent, hi.exponent);
  const lifted = d => d.digits * 10n ** BigInt(d.exponent - exponent);
  const width = lifted(hi) - lifted(lo), cut = Math.max(0, String(width).length - 3), unit = 10n ** BigInt(cut);
  const rounded = Number(`${(width + unit - 1n) / unit}e${exponent + cut}`);
  return rounded > 0 && rounded < 1e-3 ? rounded.toExponential() : String(rounded);
}

// A time in six digits; the sign says where that is not all of it.
function timeText(t) {
  const short = Number(Number(t).toPrecision(6));
  return short === Number(t) ? String(short) : "\u2248 " + short;
}

function timeLabel(t) {
  const text = timeText(t);
  return `t ${text.startsWith("\u2248") ? "" : "= "}${text} s`;
}

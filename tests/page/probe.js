// probe.js -- what holds for every page of a report. A part of its own for the page, `look`, stands before it; EXPECTED
// is what the test knows of the data.
const wrong = [], by = id => document.getElementById(id), all = what => [...document.querySelectorAll(what)];
const check = (good, what) => { if (!good) wrong.push(what); };
const same = (is, wanted, what) =>
  check(is === wanted, `${what}: ${JSON.stringify(is)}, not ${JSON.stringify(wanted)}`);
const wait = ms => new Promise(done => setTimeout(done, ms));
const press = (target, key) => target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const isShown = element => element.checkVisibility();

// How many points of a canvas are not empty.
function inked(canvas) {
  const copy = document.createElement("canvas");
  Object.assign(copy, { width: canvas.width, height: canvas.height });
  const pen = copy.getContext("2d", { willReadFrequently: true });
  pen.drawImage(canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
  return count;
}

const channels = text => text.match(/[\d.]+/g).map(Number);
const brightness = ([r, g, b]) => [r, g, b].map(x => x / 255)
  .map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)
  .reduce((sum, x, k) => sum + x * [0.2126, 0.7152, 0.0722][k], 0);

function behind(element) {
  for (let at = element; at; at = at.parentElement) {
    const back = channels(getComputedStyle(at).backgroundColor);
    if (back.length < 4 || back[3] === 1) return back;
  }
  return [255, 255, 255];
}

function contrast(element) {
  const style = getComputedStyle(element), ink = element.ownerSVGElement ? style.fill : style.color;
  const [a, b] = [channels(ink), behind(element)].map(brightness);
  return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
}

// Every text can be read.
function readable() {
  const seen = new Set();
  for (const element of all("body *")) {
    const text = [...element.childNodes].filter(node => node.nodeType === 3).map(node => node.data.trim()).join("");
    if (!text || !isShown(element) || ["SCRIPT", "STYLE", "NOSCRIPT", "OPTION"].includes(element.tagName)) continue;
    if (element.closest(".off")) continue;
    const style = getComputedStyle(element), size = parseFloat(style.fontSize), ratio = contrast(element);
    const what = `${element.tagName}.${element.getAttribute("class") || ""}`;
    if (seen.has(what)) continue;
    if (size < 12 || ratio < 4.5) seen.add(what);
    check(size >= 12, `text of ${size} px: ${what}: ${text.slice(0, 40)}`);
    check(ratio >= 4.5, `contrast ${ratio.toFixed(2)}: ${what}: ${text.slice(0, 40)}`);
  }
}

function fits() {
  const page = document.documentElement;
  if (page.scrollWidth <= innerWidth) return;
  const wide = all("main *").filter(e => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest(".scroll *"));
  const first = wide[0] ? wide[0].outerHTML.slice(0, 200) : "";
  check(false, `the page is ${page.scrollWidth} wide in a window of ${innerWidth}: ${first}`);
}

// Names of the scene stay texts.
function harmless() {
  const fetched = performance.getEntriesByType("resource").filter(entry => !entry.name.startsWith("data:"));
  same(fetched.length, 0, "requests");
  same(all("img, iframe, object, embed, link[rel=stylesheet]").length, 0, "foreign elements");
  check(!window.owned, "a name of the data was executed");
  check(by("problem").hidden, by("problem").textContent);
}

const tables = () => all("table.sortable").filter(isShown);

// A column of numbers rises, falls, and is as it came again; what is no number stays behind.
function sorting(table) {
  const heads = [...table.tHead.rows[0].cells];
  const column = k => [...table.tBodies[0].rows].map(row => row.cells[k].dataset.sort);
  heads.forEach((head, k) => {
    const came = column(k).join("|"), click = () => head.querySelector("button").click();
    click();
    same(head.getAttribute("aria-sort"), "ascending", "aria-sort");
    const rising = column(k).filter(text => text !== "");
    if (head.classList.contains("number")) {
      const numbers = rising.map(Number);
      check(numbers.every((x, i) => i === 0 || numbers[i - 1] <= x), `${head.textContent} does not rise: ${numbers}`);
      check(column(k).slice(0, numbers.length).every(text => text !== ""), `${head.textContent}: gaps are not last`);
    }
    click();
    const falling = column(k).filter(text => text !== "");
    if (head.classList.contains("number")) {
      same(falling.map(Number).join(), rising.map(Number).reverse().join(), head.textContent);
    }
    click();
    same(column(k).join("|"), came, `${head.textContent} as it came`);
  });
}

// Nothing that can be reached has no name; heads and rows say what they are heads of.
function named() {
  for (const element of all("button, select, a[href], .scroll, svg[role], [role=region]")) {
    const name = element.textContent.trim() || element.getAttribute("aria-label") || "";
    check(name !== "" || element.ariaHidden, `no name: ${element.outerHTML.slice(0, 120)}`);
  }
  for (const head of all("th")) check(head.hasAttribute("scope"), `no scope: ${head.textContent}`);
  const ids = all("[id]").map(element => element.id);
  same(new Set(ids).size, ids.length, "ids, each once");
  for (const link of all("a[href^='#']")) check(by(link.hash.slice(1)), `${link.hash} leads nowhere`);
}

function scheme() {
  const back = () => getComputedStyle(document.body).backgroundColor, before = back();
  check(!by("scheme").parentElement.hidden, "the choice of colours is hidden");
  const choose = value => {
    by("scheme").value = value;
    by("scheme").dispatchEvent(new Event("change"));
    return back();
  };
  const light = choose("light"), dark = choose("dark");
  check(brightness(channels(light)) > 0.7 && brightness(channels(dark)) < 0.1, `light ${light}, dark ${dark}`);
  readable();
  same(choose(""), before, "colours as the system has them");
}

(async () => {
  try {
    await wait(300);
    fits();
    harmless();
    named();
    if (tables().length > 0 && EXPECTED.sort) tables().forEach(sorting);
    await look();
    await wait(100);
    fits();
    readable();
    scheme();
    for (const [selector, count] of EXPECTED.counts) same(all(selector).length, count, selector);
    for (const [selector, text] of EXPECTED.texts) {
      const texts = all(selector).map(element => element.textContent), said = texts.join(" | ").slice(0, 300);
      check(texts.some(t => t.includes(text)), `${selector} does not say ${text}, but ${said}`);
    }
    same(innerWidth, EXPECTED.width, "width of the window");
    harmless();
  } catch (problem) {
    wrong.push("the probe failed: " + problem.stack);
  }
  parent.postMessage(JSON.stringify({ wrong, page: getComputedStyle(document.body).backgroundColor }), "*");
})();

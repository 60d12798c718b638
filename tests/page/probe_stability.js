// probe_stability.js -- looks at the page of the stability suite as a reader does: counts, map, filters, cases.
const inMap = () => all("#map a[data-outcome]"), inCases = () => all(".case tbody tr");

function counts() {
  for (const box of all(".count")) {
    const [number, name] = [box.querySelector("b"), box.querySelector("span")].map(part => part.textContent);
    const word = name.replace(/^\S+ /, ""), key = ["changed", "better"].includes(word) ? "verdict" : "outcome";
    same(inMap().filter(run => run.dataset[key] === word).length, Number(number), `runs that are ${word}`);
  }
  same(inMap().length, inCases().length, "marks of the map, and rows of the cases");
}

const choose = (select, value) => {
  select.value = value;
  select.dispatchEvent(new Event("change"));
};

// What is left is what was asked for, in the map as in the cases.
function filtering() {
  for (const select of all("#filters select")) {
    const name = select.dataset.filter;
    for (const option of [...select.options].slice(1)) {
      choose(select, option.value);
      const rows = inCases().filter(row => !row.hidden), marks = inMap().filter(run => !run.classList.contains("off"));
      const wanted = inCases().filter(row => row.dataset[name] === option.value);
      same(rows.length, wanted.length, `${name} ${option.value}: rows`);
      same(marks.length, wanted.length, `${name} ${option.value}: marks`);
      check(rows.every(row => row.dataset[name] === option.value), `${name}: a row of another`);
      check(all(".case").every(box => box.hidden === !box.querySelector("tbody tr:not([hidden])")), "an empty case");
      check(marks.every(isShown), "a mark that is wanted cannot be seen");
    }
    choose(select, "");
    same(inCases().filter(row => row.hidden).length, 0, `hidden rows without ${name}`);
  }
}

async function look() {
  if (!by("filters")) return;
  counts();
  filtering();
  const link = inMap()[inMap().length - 1], row = by(link.hash.slice(1)), box = row.closest("details");
  box.open = false;
  location.hash = link.hash;
  await wait(100);
  check(box.open, "a mark of the map does not open its case");
  same(row.dataset.outcome, link.dataset.outcome, "outcome behind the mark");
  all(".case").forEach(each => { each.open = true; });
  for (const bar of all(".reach i")) {
    const share = parseFloat(bar.style.width);
    check(share >= 0 && share <= 100, `a bar is ${bar.style.width} long`);
  }
  tables().forEach(sorting);
}

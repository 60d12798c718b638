// stability.js -- filters the runs of the suite, and opens what an address points to.
const runs = [...document.querySelectorAll("[data-outcome]")];
const filters = [["group", "group"], ["solver", "solver"], ["arithmetic", "arithmetic"], ["outcome", "outcome"],
  ["verdict", "verdict"]];
const wanted = {};

function addFilter([name, text]) {
  const values = [...new Set(runs.map(run => run.dataset[name]))].filter(Boolean);
  if (values.length < 2) return;
  const label = make("label", text), select = make("select");
  for (const value of ["", ...values]) {
    const option = make("option", value || "any");
    option.value = value;
    select.append(option);
  }
  select.dataset.filter = name;
  select.addEventListener("change", () => {
    wanted[name] = select.value;
    filter();
  });
  label.append(select);
  by("filters").append(label);
}

const fits = run => filters.every(([name]) => !wanted[name] || run.dataset[name] === wanted[name]);

// Columns of the map that hold nothing that is wanted.
function hideColumns(table) {
  const lines = [...table.querySelectorAll("tbody tr:not(.group-line)")], heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, k) => {
    if (k === 0) return;
    const hidden = !lines.some(line => line.cells[k].querySelector(".run:not(.off)"));
    for (const cell of [head, ...lines.map(line => line.cells[k])]) cell.hidden = hidden;
  });
}

function filter() {
  for (const run of runs) {
    const good = fits(run);
    if (run.tagName === "TR") run.hidden = !good;
    else run.classList.toggle("off", !good);
  }
  for (const line of document.querySelectorAll("#map tbody tr:not(.group-line)")) {
    line.hidden = !line.querySelector(".run:not(.off)");
  }
  for (const body of document.querySelectorAll("#map tbody")) {
    body.hidden = !body.querySelector("tr:not(.group-line):not([hidden])");
  }
  for (const box of document.querySelectorAll(".case")) box.hidden = !box.querySelector("tbody tr:not([hidden])");
  for (const group of document.querySelectorAll(".group-of-cases")) {
    group.hidden = !group.querySelector(".case:not([hidden])");
  }
  hideColumns(by("map"));
  const rows = runs.filter(run => run.tagName === "TR"), shown = rows.filter(row => !row.hidden).length;
  by("shown").textContent = shown === rows.length ? `all ${shown} runs` : `${shown} of ${rows.length} runs`;
}

function openTarget() {
  const target = location.hash.length > 1 && by(decodeURIComponent(location.hash.slice(1)));
  const box = target && target.closest("details");
  if (!box) return;
  box.open = true;
  target.scrollIntoView({ block: "nearest" });
}

if (by("filters")) {
  filters.forEach(addFilter);
  const shown = by("filters").appendChild(make("output", "", "quiet"));
  shown.id = "shown";
  by("filters").append(button("open all", "", () => openAll(true)), button("close all", "", () => openAll(false)));
  by("filters").hidden = false;
  filter();
  openTarget();
}

function openAll(open) {
  for (const box of document.querySelectorAll(".case")) box.open = open;
}

addEventListener("hashchange", openTarget);
addEventListener("beforeprint", () => openAll(true));

// sort.js -- tables whose heads sort them: rising, falling, as they came. What has no number stays behind.
function sortBy(cell, numeric) {
  const text = cell.dataset.sort;
  if (!numeric) return text;
  return text === "" ? NaN : Number(text);
}

function compareCells(a, b, numeric, way) {
  if (!numeric) return way * a.localeCompare(b, "en", { numeric: true });
  if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
  return a === b ? 0 : way * (a < b ? -1 : 1);
}

function sortable(table) {
  const body = table.tBodies[0], came = [...body.rows], heads = [...table.tHead.rows[0].cells];
  const ways = { none: "ascending", ascending: "descending", descending: "none" };

  const sort = (k, way) => {
    heads.forEach((head, i) => head.setAttribute("aria-sort", i === k ? way : "none"));
    const numeric = heads[k].classList.contains("number");
    const rows = came.map(row => [sortBy(row.cells[k], numeric), row]);
    const sign = way === "descending" ? -1 : 1;
    if (way !== "none") rows.sort((a, b) => compareCells(a[0], b[0], numeric, sign));
    body.append(...rows.map(row => row[1]));
  };

  heads.forEach((head, k) => {
    const made = button(head.textContent, "sort", () => sort(k, ways[head.getAttribute("aria-sort")]));
    if (head.title) made.title = head.title;
    head.setAttribute("aria-sort", "none");
    head.replaceChildren(made);
  });
}

document.querySelectorAll("table.sortable").forEach(sortable);

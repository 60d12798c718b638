// tip.js -- what is said of a mark under the pointer, the finger or the focus. The words are those of its table row.
const tip = {
  show(content, x, y) {
    const box = by("tip");
    box.replaceChildren(...content);
    box.hidden = false;
    const room = document.documentElement.clientWidth, { width, height } = box.getBoundingClientRect();
    const above = y - height - 14;
    box.style.left = `${Math.max(6, Math.min(x - width / 2, room - width - 6)) + scrollX}px`;
    box.style.top = `${(above > 6 ? above : y + 18) + scrollY}px`;
  },

  hide() { by("tip").hidden = true; },

  isHidden() { return by("tip").hidden; },

  // The cells of a row of a table that say something.
  row(row) {
    const heads = row.closest("table").tHead.rows[0].cells, list = make("dl");
    [...row.cells].slice(1).forEach((cell, k) => {
      if (cell.textContent) list.append(make("dt", heads[k + 1].textContent), make("dd", cell.textContent));
    });
    return [make("strong", row.cells[0].textContent), list];
  },
};

addEventListener("keydown", event => { if (event.key === "Escape") tip.hide(); });
addEventListener("scheme", () => tip.hide());

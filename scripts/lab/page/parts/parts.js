// parts.js -- what every script of a page needs.
const by = id => document.getElementById(id);

addEventListener("error", event => {
  by("problem").hidden = false;
  by("problem").textContent = "This page failed: " + event.message;
});

function make(name, text, kind) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

function button(text, kind, act) {
  const made = make("button", text, kind);
  made.type = "button";
  made.addEventListener("click", () => act(made));
  return made;
}

// Buttons of which one is pressed; entries: [[value, text], ...].
function choice(label, entries, chosen, act) {
  const group = make("span", undefined, "group");
  group.setAttribute("role", "group");
  group.setAttribute("aria-label", label);
  const press = value => {
    for (const other of group.children) other.setAttribute("aria-pressed", String(other.dataset.value === value));
  };
  for (const [value, text] of entries) {
    const made = button(text, "", () => { press(value); act(value); });
    made.dataset.value = value;
    group.append(made);
  }
  press(chosen);
  return group;
}

// A colour of the style sheet, as the scheme of the moment has it.
const colourProbe = make("i");
colourProbe.hidden = true;
document.body.append(colourProbe);
function colour(name) {
  colourProbe.style.color = `var(${name})`;
  return getComputedStyle(colourProbe).color;
}

const COLOURS = 8;
const paint = k => `--p${k % COLOURS}`;

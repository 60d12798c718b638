// element.js -- elements of drawings, whose namespace is that of a drawing which the page parses.
const drawingHome = make("i");
drawingHome.innerHTML = "<svg></svg>";
const SVG = drawingHome.firstChild.namespaceURI;

function element(parent, name, attributes = {}, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  parent.append(made);
  return made;
}

// 1e-5 -> "10 µs"

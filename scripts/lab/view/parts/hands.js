// hands.js -- turning, moving and scaling the drawing: mouse, touch, wheel, keys.
function takeHands(drawing) {
  const { svg } = drawing, down = new Map();

  const place = event => {
    const box = svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  svg.addEventListener("pointerdown", event => {
    svg.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
  });

  const pinch = (id, to) => {
    const other = [...down.keys()].find(key => key !== id), fixed = down.get(other), from = down.get(id);
    const distance = p => Math.hypot(p[0] - fixed[0], p[1] - fixed[1]);
    drawing.camera.zoom(distance(to) / Math.max(distance(from), 1), (to[0] + fixed[0]) / 2, (to[1] + fixed[1]) / 2);
    drawing.camera.pan((to[0] - from[0]) / 2, (to[1] - from[1]) / 2);
  };

  svg.addEventListener("pointermove", event => {
    const from = down.get(event.pointerId);
    if (!from) return;
    const to = place(event), moved = [to[0] - from[0], to[1] - from[1]];
    if (down.size > 1) pinch(event.pointerId, to);
    else if (event.shiftKey || event.buttons > 1) drawing.camera.pan(...moved);
    else drawing.camera.rotate(...moved);
    down.set(event.pointerId, to);
    drawing.moved();
  });

  for (const name of ["pointerup", "pointercancel"]) {
    svg.addEventListener(name, event => down.delete(event.pointerId));
  }

  svg.addEventListener("contextmenu", event => event.preventDefault());

  svg.addEventListener("wheel", event => {
    event.preventDefault();
    drawing.camera.zoom(Math.exp(-event.deltaY * 0.0015), ...place(event));
    drawing.moved();
  }, { passive: false });

  const keys = {
    ArrowLeft: () => drawing.camera.rotate(-15, 0), ArrowRight: () => drawing.camera.rotate(15, 0),
    ArrowUp: () => drawing.camera.rotate(0, -15), ArrowDown: () => drawing.camera.rotate(0, 15),
    "+": () => drawing.camera.zoom(1.2), "=": () => drawing.camera.zoom(1.2), "-": () => drawing.camera.zoom(1 / 1.2),
    "0": () => drawing.camera.fit(drawing.model.places),
  };

  svg.addEventListener("keydown", event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
    drawing.moved();
  });
}

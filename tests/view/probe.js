// probe.js -- put at the end of a page by browser.lua: looks at it the way a reader does, and sends what is wrong to
// the window around it. EXPECTED is what the test knows about the scene.
(async () => {
  const wrong = [], by = id => document.getElementById(id), drawn = what => by("drawing").querySelectorAll(what);
  const check = (good, what) => { if (!good) wrong.push(what); };
  const same = (is, wanted, what) =>
    check(is === wanted, `${what}: ${JSON.stringify(is)}, not ${JSON.stringify(wanted)}`);
  const wait = ms => new Promise(done => setTimeout(done, ms));
  const data = JSON.parse(by("data").textContent), look = () => by("drawing").innerHTML;
  const cells = () => [...by("ranges").querySelectorAll("td.number")].map(cell => cell.textContent);
  const go = async hash => { location.hash = hash; await wait(50); };
  const press = (target, key) => target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));

  const fits = () => {
    const page = document.documentElement;
    check(page.scrollWidth <= innerWidth, `the page is ${page.scrollWidth} wide in a window of ${innerWidth}`);
  };

  const counts = view => {
    const intervals = view.swept.filter(Boolean).length, points = view.points.length;
    same(drawn(".frame").length, view.frames.length, "frames");
    same(drawn(".line").length, view.lines.length, "lines");
    same(drawn(".axis").length, view.axes.length, "axes of joints");
    same(drawn(".body").length, view.bodies.length, "bodies");
    same(drawn(".box.now").length, points, "boxes at the instant");
    const stride = Math.max(1, Math.ceil(view.swept.length * points / 600));
    same(drawn(".box.swept").length, intervals ? Math.ceil(intervals / stride) * points : 0, "swept boxes");
    check(!look().includes("NaN"), "a place in the drawing is not a number");
    same(document.title, data.views[0].title.replace(/[\u0000-\u001f\u007f]/g, " "), "title of the page");
    same(by("title").textContent, view.title, "heading");
  };

  // Where something is drawn, as { x, y, width, height }.
  const place = element => element.getBBox();

  const slider = async view => {
    const n = view.t.length, k = Math.floor(n / 2);
    same(Number(by("time").max), n - 1, "end of the slider");
    await go(`t=${view.t[0]}`);
    const first = [look(), cells().join()];
    await go(`t=${view.t[k]}`);
    same(Number(by("time").value), k, "place of the slider");
    check(look() !== first[0], "the drawing does not move with the slider");
    check(cells().join() !== first[1], "the table does not change with the slider");
    same(cells()[0], view.boxes[k][0][0], "x of the first point in the table");
    if (view.swept[k]) same(cells()[2], view.swept[k][0][0], "x of the first point until the next instant");
    const past = [...drawn(".box.swept")].filter(box => box.style.display !== "none");
    const some = past.length > 0 && past.length < drawn(".box.swept").length;
    check(some || drawn(".box.swept").length === 0, "not the swept boxes so far are shown");
    by("time").value = n - 1;
    by("time").dispatchEvent(new Event("input"));
    same(cells()[0], view.boxes[n - 1][0][0], "x of the first point at the end");
    check(!by("time").disabled && by("time").tabIndex === 0, "the slider cannot be reached by the keyboard");
    check(by("time").getAttribute("aria-valuetext").startsWith("t "), "the slider does not say its time");
  };

  // The drawn point of the midpoints lies inside the drawn box, or on it.
  const inside = view => {
    view.points.forEach((point, k) => {
      if (!drawn(".box.now")[k].getAttribute("points")) return;
      const box = place(drawn(".box.now")[k]), at = drawn(".frame")[point.frame].getAttribute("transform");
      const [x, y] = at.match(/-?[\d.]+/g).map(Number);
      const good = x >= box.x - 1 && x <= box.x + box.width + 1 && y >= box.y - 1 && y <= box.y + box.height + 1;
      check(good, `point ${point.name} is drawn outside its box`);
    });
  };

  const isShown = box => box.style.display !== "none" && box.getAttribute("points");
  const boxesShown = () => [...drawn(".box")].filter(isShown).length;

  const controls = async view => {
    const before = look();
    press(by("drawing"), "ArrowLeft");
    const turned = look();
    check(turned !== before, "the arrow keys do not turn the drawing");
    by("sides").querySelector("[data-side=xz]").click();
    check(look() !== turned, "xz does not change the drawing");
    same(by("sides").querySelector("[aria-pressed=true]").dataset.side, "xz", "pressed side");
    const wide = look();
    by("closer").click();
    check(look() !== wide, "+ does not scale the drawing");
    by("fit").click();
    same(look(), wide, "fit after +");
    for (const [choice, good] of [["none", n => n === 0], ["now", n => n > 0], ["all", n => n >= view.points.length]]) {
      by("boxes").value = choice;
      by("boxes").dispatchEvent(new Event("change"));
      check(good(boxesShown()), `boxes: ${choice} shows ${boxesShown()}`);
    }
    if (view.t.length > 1) await playing(view);
  };

  const playing = async view => {
    await go(`t=${view.t[0]}&side=3d&boxes=past`);
    by("play").click();
    same(by("play").getAttribute("aria-label"), "pause", "the button while playing");
    await wait(1500);
    check(Number(by("time").value) > 0, "play does not move the slider");
    by("play").click();
    const stopped = by("time").value;
    await wait(300);
    same(by("time").value, stopped, "the slider after pause");
  };

  // Names of the scene stay texts.
  const harmless = () => {
    same(document.querySelectorAll("script").length, 3, "scripts, with this one");
    same(document.querySelectorAll("img, iframe, object, embed, link[rel=stylesheet]").length, 0, "foreign elements");
    const fetched = performance.getEntriesByType("resource").filter(entry => !entry.name.startsWith("data:"));
    same(fetched.length, 0, "requests");
    check(!window.owned, "a name of the scene was executed");
  };

  try {
    await wait(100);
    check(by("problem").hidden, by("problem").textContent);
    for (let k = 0; k < data.views.length; k++) {
      const view = data.views[k];
      await go(`model=${k + 1}`);
      counts(view);
      inside(view);
      fits();
      if (view.t.length > 1) await slider(view);
      inside(view);
      await controls(view);
      fits();
    }
    harmless();
    await go("model=1");
    for (const [selector, text] of EXPECTED.texts) {
      const texts = [...document.querySelectorAll(selector)].map(element => element.textContent);
      const said = texts.join(" | ").slice(0, 300);
      check(texts.some(t => t.includes(text)), `${selector} does not say ${text}, but ${said}`);
    }
    for (const [selector, count] of EXPECTED.counts) same(document.querySelectorAll(selector).length, count, selector);
    if (EXPECTED.width) same(innerWidth, EXPECTED.width, "width of the window");
    check(by("problem").hidden, by("problem").textContent);
  } catch (problem) {
    wrong.push("the probe failed: " + problem.stack);
  }
  const { backgroundColor, color } = getComputedStyle(document.body);
  parent.postMessage(JSON.stringify({ wrong, page: backgroundColor, ink: color }), "*");
})();

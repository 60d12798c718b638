// probe_plot.js -- looks at the page of a run: something is drawn, and the plot under the pointer says its bounds.
async function look() {
  for (const band of all(".band")) {
    check(inked(band.querySelector("canvas")) > 500, `nothing is drawn of ${band.textContent}`);
    const over = band.querySelector(".u-over"), box = over.getBoundingClientRect();
    over.dispatchEvent(new MouseEvent("mousemove", { bubbles: true, clientX: box.left + box.width / 2,
      clientY: box.top + box.height / 2 }));
    await wait(50);
    check(/t = .*\[.*,.*\]/.test(band.querySelector(".readout").textContent), "no bounds under the pointer");
  }
  for (const svg of all(".picture svg")) {
    check(svg.querySelectorAll("rect").length > 20, "no boxes in the plane");
    check(!/NaN|Infinity|nan|inf/.test(svg.innerHTML.replace(/<style>.*?<.style>|<metadata>.*?<.metadata>/gs, "")),
      "a place in the picture is not a number");
  }
}

// over_time.js -- the page of one run: its quantities over time.
const place = by("over-time");
if (place) showBands(place, JSON.parse(by("data").textContent));

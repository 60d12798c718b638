// scheme.js -- light or dark: as the system says, or as the reader does, who is remembered where that is allowed.
// It stands in the head, so that the page is never drawn in the wrong colours first. On paper everything is light.
(() => {
  const dark = document.getElementById("dark"), system = dark.media, key = "ambit.scheme";
  const memory = { read: () => localStorage.getItem(key), write: choice => localStorage.setItem(key, choice) };
  const attempt = (act, ...arguments_) => {
    try { return act(...arguments_) || ""; } catch { return ""; } // no storage here
  };
  let chosen = attempt(memory.read);

  const apply = choice => {
    dark.media = { light: "not all", dark: "screen" }[choice] || system;
    dispatchEvent(new Event("scheme"));
  };

  apply(chosen);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => apply(chosen));
  addEventListener("beforeprint", () => apply("light"));
  addEventListener("afterprint", () => apply(chosen));
  addEventListener("DOMContentLoaded", () => {
    const select = document.getElementById("scheme");
    select.parentElement.hidden = false;
    select.value = chosen;
    select.addEventListener("change", () => {
      chosen = select.value;
      attempt(memory.write, chosen);
      apply(chosen);
    });
  });
})();

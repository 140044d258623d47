// Two pictures in a .before-after lie on each other, and a slider shows more of the one or of the other.
for (const pair of document.querySelectorAll(".before-after")) {
  const add = (tag, properties) => pair.appendChild(Object.assign(document.createElement(tag), properties));
  add("span", { className: "line" });
  add("span", { className: "word without", textContent: "without" });
  add("span", { className: "word with", textContent: "with" });
  const slider = add("input", { type: "range", min: 0, max: 100, value: 50, ariaLabel: "share of the picture without the effect, in percent" });
  slider.addEventListener("input", () => pair.style.setProperty("--split", `${slider.value}%`));
  pair.classList.add("is-slider");
}

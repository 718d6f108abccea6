"use strict";
const kLensPixels = 24;
const lens = document.getElementById("lens");

function show(section, mode) {
  const views = section.querySelector(".views");
  views.className = "views " + { side: "", slider: "stacked", swap: "stacked swap" }[mode];
  section.querySelector("input[type=range]").hidden = mode !== "slider";
  slide(section);
}

function slide(section) {
  const range = section.querySelector("input[type=range]");
  const actual = section.querySelector("figure.actual img");
  actual.style.clipPath = range.hidden ? "" : `inset(0 0 0 ${range.value}%)`;
}

function magnify(event) {
  const views = event.currentTarget;
  const box = event.target.getBoundingClientRect();
  if (event.target.tagName !== "IMG") return;
  const x = (event.clientX - box.left) / box.width;
  const y = (event.clientY - box.top) / box.height;
  lens.replaceChildren();
  for (const image of views.querySelectorAll("img")) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = kLensPixels;
    const context = canvas.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.drawImage(image, Math.floor(x * image.naturalWidth) - kLensPixels / 2,
                      Math.floor(y * image.naturalHeight) - kLensPixels / 2,
                      kLensPixels, kLensPixels, 0, 0, kLensPixels, kLensPixels);
    lens.append(canvas);
  }
  const size = event.target;
  lens.append(`${Math.floor(x * size.naturalWidth)}, ${Math.floor(y * size.naturalHeight)}`);
  lens.style.display = "block";
  const left = Math.min(event.clientX + 20, innerWidth - lens.offsetWidth - 8);
  const below = event.clientY + 20 + lens.offsetHeight < innerHeight;
  lens.style.left = `${left}px`;
  lens.style.top = `${below ? event.clientY + 20 : event.clientY - 20 - lens.offsetHeight}px`;
}

for (const section of document.querySelectorAll("section")) {
  const views = section.querySelector(".views");
  views.addEventListener("mousemove", magnify);
  views.addEventListener("mouseleave", () => { lens.style.display = "none"; });
  for (const radio of section.querySelectorAll("input[type=radio]")) {
    radio.addEventListener("change", () => show(section, radio.value));
  }
  const range = section.querySelector("input[type=range]");
  if (range) range.addEventListener("input", () => slide(section));
}
setInterval(() => {
  for (const views of document.querySelectorAll(".swap")) views.classList.toggle("flip");
}, 600);

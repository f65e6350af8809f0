// A picture `name.png#slide-N-P` consists of N panels side by side: show the first two on top of each other, with
// a slider between them, and only the upper P percent of it, without the captions. Without this script, or
// elsewhere, the whole picture is shown.
document$.subscribe(() => {
  for (const image of document.querySelectorAll('img[src*="#slide-"]')) {
    const [panels, percent] = image.src.split("#slide-")[1].split("-").map(Number);
    const build = () => {
      const box = document.createElement("div");
      box.className = "slide";
      box.style.aspectRatio = `${image.naturalWidth / panels} / ${(image.naturalHeight * percent) / 100}`;
      box.style.maxWidth = `${image.naturalWidth / panels}px`;
      const layers = [0, 1].map((panel) => {
        const layer = document.createElement("div");
        layer.className = "slide__layer";
        layer.style.backgroundImage = `url("${image.src}")`;
        layer.style.backgroundSize = `${100 * panels}% ${10000 / percent}%`;
        layer.style.backgroundPosition = `${(100 * panel) / (panels - 1)}% 0`;
        box.append(layer);
        return layer;
      });
      const range = document.createElement("input");
      Object.assign(range, { type: "range", min: 0, max: 100, value: 50 });
      range.setAttribute("aria-label", `${image.alt}: before and after`);
      const line = document.createElement("div");
      line.className = "slide__line";
      const move = () => {
        layers[0].style.clipPath = `inset(0 ${100 - range.value}% 0 0)`;
        layers[1].style.clipPath = `inset(0 0 0 ${range.value}%)`;
        line.style.left = `${range.value}%`;
      };
      range.addEventListener("input", move);
      move();
      box.append(line, range);
      image.replaceWith(box);
    };
    if (image.complete && image.naturalWidth) build();
    else image.addEventListener("load", build);
  }
});

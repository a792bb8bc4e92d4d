// A browser ends a line after a hyphen: after the dashes of `--option`, and within `1e-16`. Here these stay whole.
const WHOLE = /(--[a-z][a-z0-9-]*|\d[\d.]*e-\d+)/;
for (const place of document.querySelectorAll("main code, main td, main th")) {
  const texts = document.createTreeWalker(place, NodeFilter.SHOW_TEXT);
  const found = [];
  while (texts.nextNode()) {
    const text = texts.currentNode;
    if (WHOLE.test(text.data) && !text.parentElement.classList.contains("whole")) found.push(text);
  }
  for (const text of found) {
    // Every second part is one that the expression found.
    const parts = text.data.split(WHOLE).map((part, index) => {
      if (index % 2 === 0) return part;
      const whole = document.createElement("span");
      whole.className = "whole";
      whole.textContent = part;
      return whole;
    });
    text.replaceWith(...parts);
  }
}

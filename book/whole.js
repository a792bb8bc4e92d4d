// A browser ends a line after a hyphen: after the dashes of `--option`, and within `1e-16` and `lbf-in`. Here these stay
// whole. A path in a table, which it takes for one word, may end a line after a slash.
const WHOLE = /(--[a-z][a-z0-9-]*|\d[\d.]*e-\d+|\b[a-z]{1,3}f-[a-z]{1,2}\b)/;

/** What stands between: text, with places to end a line. */
function breakable(text, isPath) {
  if (!isPath) return [text];
  return text.split(/(?<=\/)(?=\w)/).flatMap((part, index) => (index === 0 ? [part] : [document.createElement("wbr"), part]));
}

for (const place of document.querySelectorAll("main :not(pre) > code, main pre > code.said, main td, main th")) {
  const texts = document.createTreeWalker(place, NodeFilter.SHOW_TEXT);
  const found = [];
  while (texts.nextNode()) {
    const text = texts.currentNode;
    if (!text.parentElement.closest(".whole") && (WHOLE.test(text.data) || text.data.includes("/"))) found.push(text);
  }
  for (const text of found) {
    const isPath = text.parentElement.closest("td code") !== null;
    // Every second part is one that the expression found.
    const parts = text.data.split(WHOLE).flatMap((part, index) => {
      if (index % 2 === 0) return breakable(part, isPath);
      const whole = document.createElement("span");
      whole.className = "whole";
      whole.textContent = part;
      return [whole];
    });
    text.replaceWith(...parts);
  }
}

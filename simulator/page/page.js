"use strict";
// Ranking: a click on a head sorts, what is typed below it filters: "> 50", "<= 3", "F2", "!F1".
function number_of(text) {  // of "0.83 \u00b1 0.02" and "1,440" too; NaN for words
  const value = text.split(" \u00b1")[0].replace(/,/g, "").replace("\u2212", "-");
  return value.trim() === "" ? NaN : Number(value);
}
function passes(text, condition) {
  const found = condition.trim().match(/^(<=|>=|<|>|=|!)?\s*(.*)$/);
  const sign = found[1], word = found[2];
  if (word === "") return true;
  const a = number_of(text), b = number_of(word);
  const numbers = !Number.isNaN(a) && !Number.isNaN(b);
  switch (sign) {
    case "<": return numbers && a < b;
    case ">": return numbers && a > b;
    case "<=": return numbers && a <= b;
    case ">=": return numbers && a >= b;
    case "=": return numbers ? a === b : text === word;
    case "!": return !text.includes(word);
    default: return numbers ? a === b : text.toLowerCase().includes(word.toLowerCase());
  }
}
for (const table of document.querySelectorAll("table[data-filter]")) {
  const rows = Array.from(table.tBodies[0].rows);
  const heads = Array.from(table.tHead.rows[0].cells);
  const inputs = heads.map((head) => {
    const input = document.createElement("input");
    input.setAttribute("aria-label", "filter of " + head.textContent);
    input.placeholder = "filter";
    head.append(input);
    input.addEventListener("click", (event) => event.stopPropagation());
    input.addEventListener("input", show);
    return input;
  });
  function show() {
    let count = 0;
    for (const row of rows) {
      const shown = inputs.every((input, k) => passes(row.cells[k].textContent, input.value));
      row.hidden = !shown;
      count += shown ? 1 : 0;
    }
    document.getElementById(table.dataset.filter).textContent = count + " of " + rows.length + " rows";
  }
  heads.forEach((head, k) => {
    let falling = false;
    head.dataset.sort = "";
    head.addEventListener("click", () => {
      falling = !falling;
      const key = (row) => {
        const cell = row.cells[k], number = number_of(cell.dataset.value || cell.textContent);
        return Number.isNaN(number) ? cell.textContent : number;
      };
      const order = (a, b) => typeof a === typeof b ? (a < b ? -1 : a > b ? 1 : 0) : typeof a === "number" ? -1 : 1;
      const sorted = rows.slice().sort((a, b) => (falling ? -1 : 1) * order(key(a), key(b)));
      table.tBodies[0].append(...sorted);
    });
  });
  show();
}
// Cases: one slider moves the line in the histories and colours the section.
for (const part of document.querySelectorAll("[data-case]")) {
  const steps = JSON.parse(part.querySelector("script[type='application/json']").textContent);
  const slider = part.querySelector("input[type=range]"), said = part.querySelector("output");
  const cursors = Array.from(part.querySelectorAll("[data-cursor]"));
  const faults = Array.from(part.querySelectorAll("[data-fault]"));
  const names = Array.from(part.querySelectorAll("[data-rock]"));
  function go() {
    const step = steps[slider.value];
    said.textContent = step.says;
    for (const cursor of cursors) {
      const [zero, one] = cursor.dataset.x.split(" ").map(Number);
      cursor.setAttribute("transform", "translate(" + (step.time - cursor.dataset.cursor) * (one - zero) + " 0)");
    }
    for (const fault of faults) {
      const colours = step.colours[fault.dataset.fault] || [];
      Array.from(fault.children).forEach((line, k) =>
        line.setAttribute("stroke", colours[Math.min(k, colours.length - 1)]));
    }
    for (const name of names) {
      const note = step.notes[name.dataset.rock];
      if (note && name.firstElementChild) name.firstElementChild.textContent = name.dataset.rock + ", " + note;
    }
  }
  part.querySelector(".slider").hidden = false;
  slider.addEventListener("input", go);
  go();
}

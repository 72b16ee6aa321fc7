"use strict";
// Tables that are sorted and filtered. A row is known by its number in the order it was ranked in; a column says of a row its text
// and its place among all, -1 for nothing. Only the rows of one page are elements, however many there are.
const rows_of_a_page = 100;
function number_of(text) {  // of "0.83 \u00b1 0.02", "+3" and "1,440" too; NaN for words
  const value = text.split(" \u00b1")[0].replace(/,/g, "").replace("\u2212", "-");
  return value.trim() === "" ? NaN : Number(value);
}
function counted(n) { return n.toLocaleString("en"); }
/** What is typed below a head, "> 50", "<= 3", "F2" or "!F1", as a function of a text, with one of a number where that is all it asks
 * for; null for nothing. */
function condition_of(typed) {
  const found = typed.trim().match(/^(<=|>=|<|>|=|!)?\s*(.*)$/);
  const sign = found[1], word = found[2], lower = word.toLowerCase(), b = number_of(word);
  if (word === "") return null;
  switch (sign) {  // comparisons are false for NaN
    case "<": return of_numbers((a) => a < b);
    case ">": return of_numbers((a) => a > b);
    case "<=": return of_numbers((a) => a <= b);
    case ">=": return of_numbers((a) => a >= b);
    case "!": return (text) => !text.toLowerCase().includes(lower);
    default: break;
  }
  return (text) => {
    const a = number_of(text);
    if (!Number.isNaN(a) && !Number.isNaN(b)) return a === b;
    return sign === "=" ? text === word : text.toLowerCase().includes(lower);
  };
}
function of_numbers(passes) {
  const of_text = (text) => passes(number_of(text));
  of_text.number = passes;
  return of_text;
}
/** Where each text stands among all: numbers, then words; equal ones at the same place; -1 for nothing. */
function places_of(texts) {
  const numbers = Float64Array.from(texts, number_of), places = new Int32Array(texts.length).fill(-1);
  const compare = (a, b) => {
    const x = numbers[a], y = numbers[b];
    if (Number.isNaN(x) !== Number.isNaN(y)) return Number.isNaN(x) ? 1 : -1;
    if (!Number.isNaN(x)) return x - y;
    return texts[a] < texts[b] ? -1 : texts[a] > texts[b] ? 1 : 0;
  };
  const order = Array.from(texts.keys()).filter((k) => texts[k] !== "").sort(compare);
  order.forEach((k, n) => { places[k] = n > 0 && compare(order[n - 1], k) === 0 ? places[order[n - 1]] : n; });
  return places;
}
// Of a hundred thousand rows a list of texts or numbers made anew with every key is what fills memory: passing() and placing() make
// arrays of bytes and of whole numbers where they cannot do without.
/** A column of which each row has one of some texts. */
function column_of(texts, at) {
  return {
    text: (row) => texts[at(row)],
    passing: (passes) => { const each = Uint8Array.from(texts, passes); return (row) => each[at(row)] === 1; },
    placing: () => { const places = places_of(texts); return (row) => places[at(row)]; },
    has_numbers: () => texts.some((text) => !Number.isNaN(number_of(text))),
  };
}
/** Where a number stands first among sorted ones that have it. */
function place_in(sorted, number) {
  let from = 0, to = sorted.length;
  while (from < to) {
    const middle = (from + to) >> 1;
    if (sorted[middle] < number) from = middle + 1;
    else to = middle;
  }
  return from;
}
/** A column of numbers that are not negative, given as whole ones. */
function column_of_numbers(numbers, decimals) {
  const text = (row) => {
    if (decimals === 0) return String(numbers[row]);
    const digits = String(numbers[row]).padStart(decimals + 1, "0"), point = digits.length - decimals;
    return (digits.slice(0, point) + "." + digits.slice(point)).replace(/\.?0*$/, "");
  };
  const scale = 10 ** decimals;
  const passing = (passes) => passes.number ? (row) => passes.number(numbers[row] / scale) : (row) => passes(text(row));
  const placing = () => { const sorted = new Float64Array(numbers).sort(); return (row) => place_in(sorted, numbers[row]); };
  return {text, passing, placing, has_numbers: () => true};
}
/** Columns that stand in the table whole. */
function columns_of_elements(table) {
  const rows = Array.from(table.tBodies[0].rows);
  return Array.from(table.tHead.rows[0].cells, (head, k) =>
    column_of(rows.map((row) => row.cells[k].textContent), (row) => row));
}
/** Columns of the data that hold all rows of a table of which only the first are elements: campaign/render/row_data.h. */
function columns_of_data(data) {
  return data.columns.map((column) => {
    if (!column.at) return column_of(column.texts, column.texts.length === 1 ? () => 0 : (row) => row);
    const bytes = atob(column.at), width = column.bytes;
    const numbers = width <= 4 ? new Uint32Array(data.rows) : new Float64Array(data.rows);
    for (let k = 0; k < bytes.length; ++k) numbers[Math.floor(k / width)] += bytes.charCodeAt(k) * 256 ** (k % width);
    return column.texts ? column_of(column.texts, (row) => numbers[row]) : column_of_numbers(numbers, column.decimals);
  });
}
function button(words, go) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = words;
  made.addEventListener("click", go);
  return made;
}
function make_sortable(table) {
  const body = table.tBodies[0], heads = Array.from(table.tHead.rows[0].cells);
  const stored = document.querySelector("script[data-rows-of='" + table.dataset.table + "']");
  const data = stored ? JSON.parse(stored.textContent) : {rows: body.rows.length};
  const columns = stored ? columns_of_data(data) : columns_of_elements(table);
  if (stored) stored.remove();  // megabytes of text
  const classes = heads.map((head) => head.className);
  const n_rows = data.rows, said = document.getElementById(table.dataset.filter);
  const shown = new Uint32Array(n_rows);  // rows that pass, in their order
  let n_shown = 0, first = 0, by = -1, steps = 0, falling = false;  // how many of them, and the first on the page
  const pager = document.createElement("p");
  pager.className = "pager";
  const turn = [["first", () => 0], ["previous", () => first - rows_of_a_page], ["next", () => first + rows_of_a_page],
    ["last", () => Math.floor((n_shown - 1) / rows_of_a_page) * rows_of_a_page]]
    .map(([words, to]) => button(words, () => { first = Math.max(0, to()); fill(); }));
  pager.append(...turn);
  table.parentElement.after(pager);
  said.setAttribute("role", "status");

  function fill() {
    const end = Math.min(first + rows_of_a_page, n_shown);
    const rows = Array.from(shown.subarray(first, end), (row) => {
      const line = document.createElement("tr");
      columns.forEach((column, k) => {
        const cell = line.insertCell();
        cell.textContent = column.text(row);
        if (classes[k]) cell.className = classes[k];
      });
      return line;
    });
    body.replaceChildren(...rows);
    const all = counted(n_shown) + " of " + counted(n_rows) + " rows";
    pager.hidden = n_shown <= rows_of_a_page;
    said.textContent = all + (pager.hidden ? "" : "; here " + counted(first + 1) + " to " + counted(end));
    turn[0].disabled = turn[1].disabled = first === 0;
    turn[2].disabled = turn[3].disabled = end === n_shown;
  }
  function choose() {
    const tests = [];
    inputs.forEach((input, k) => {
      const passes = condition_of(input.value);
      if (passes) tests.push(columns[k].passing(passes));
    });
    n_shown = first = 0;
    for (let row = 0; row < n_rows; ++row)
      if (tests.every((passes) => passes(row))) shown[n_shown++] = row;
    if (by >= 0) sort_shown(columns[by].placing());
    fill();
  }
  /** Equal ones as they were ranked; nothing is last either way. */
  function sort_shown(place) {
    const keys = Float64Array.from(shown.subarray(0, n_shown), (row) => {
      const at = place(row);
      return (at < 0 ? n_rows : falling ? n_rows - 1 - at : at) * n_rows + row;
    }).sort();
    keys.forEach((key, k) => { shown[k] = key % n_rows; });
  }
  /** Numbers fall first, words rise; then the other way; then as it was ranked. */
  function sort_by(k) {
    if (by !== k) by = k, steps = 0, falling = columns[k].has_numbers();
    else if (++steps === 1) falling = !falling;
    else by = -1;
    heads.forEach((head, i) => head.setAttribute("aria-sort", i !== by ? "none" : falling ? "descending" : "ascending"));
    choose();
  }
  const inputs = heads.map((head, k) => {
    const words = head.textContent, input = document.createElement("input");
    head.setAttribute("aria-sort", "none");
    head.replaceChildren(button(words, () => sort_by(k)), input);
    input.setAttribute("aria-label", "filter of " + words);
    input.placeholder = "filter";
    input.addEventListener("input", choose);
    return input;
  });
  choose();
}
/** Of a case: shows step k in its section and its histories and returns its words. */
function step_shower(part, steps) {
  const cursors = Array.from(part.querySelectorAll("[data-cursor]"));
  const faults = Array.from(part.querySelectorAll("[data-fault]"));
  const names = Array.from(part.querySelectorAll("[data-rock]")), painted = Array.from(part.querySelectorAll("[data-painted]"));
  const scale = steps[0].scale, scale_drawn = part.querySelector("[data-scale]");
  if (scale && scale_drawn) {  // of a case that was changed since it was drawn it may be another one
    scale_drawn.querySelectorAll("text").forEach((text, i) => { text.textContent = scale.texts[i] || ""; });
    scale_drawn.querySelectorAll("rect").forEach((box, i) => { if (scale.colours[i]) box.setAttribute("fill", scale.colours[i]); });
  }
  return (k) => {
    const step = steps[k];
    for (const cursor of cursors) {
      const [zero, one] = cursor.dataset.x.split(" ").map(Number);
      cursor.setAttribute("transform", "translate(" + (step.time - cursor.dataset.cursor) * (one - zero) + " 0)");
    }
    for (const fault of faults) {
      const parts = step.chi[fault.dataset.fault] || "", last = parts.length - 1;
      for (let i = 0, line = parts && fault.firstElementChild; line; line = line.nextElementSibling, ++i)
        line.setAttribute("stroke", steps[0].chi_colours[parseInt(parts[Math.min(i, last)], 36)]);
    }
    for (const name of names) {
      const note = step.notes[name.dataset.rock];
      if (note && name.firstElementChild) name.firstElementChild.textContent = name.dataset.rock + ", " + note;
    }
    for (const reservoir of painted) {
      const parts = (step.painted || {})[reservoir.dataset.painted] || "";
      Array.from(reservoir.children).forEach((piece, i) => {
        const colour = scale && scale.colours[parseInt(parts[i], 36)] || "none";
        piece.setAttribute("fill", colour);
        piece.setAttribute("stroke", colour);
      });
    }
    return step.says;
  };
}
/** A case with its slider. Returns the steps. */
function show_steps(part) {
  const steps = JSON.parse(part.querySelector("script[type='application/json']").textContent);
  const slider = part.querySelector("input[type=range]"), said = part.querySelector("output"), show = step_shower(part, steps);
  function go() {
    said.textContent = show(slider.value);
    slider.setAttribute("aria-valuetext", said.textContent);
  }
  part.querySelector(".slider").hidden = false;
  slider.addEventListener("input", go);
  go();
  return steps;
}
document.querySelectorAll("table[data-filter]").forEach(make_sortable);
document.querySelectorAll("[data-case]").forEach(show_steps);

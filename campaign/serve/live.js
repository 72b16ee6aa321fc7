"use strict";
// The page of `faultsweep serve`. It asks its server for parts of pages and for drawings and puts them in place; nothing is computed
// or drawn here. Addresses: #/CAMPAIGN, #/CAMPAIGN/17, #/CAMPAIGN/17/beside/19, #/CAMPAIGN/17/what-if.
const view = document.getElementById("view");

class Refused extends Error {}

function made(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) element.setAttribute(name, value);
  element.append(...children);
  return element;
}
function address(...parts) { return "#/" + parts.map(encodeURIComponent).join("/"); }
function link(words, ...parts) { return made("a", {href: address(...parts)}, words); }
function of_case(campaign, number) { return "/api/campaigns/" + encodeURIComponent(campaign) + "/cases/" + encodeURIComponent(number); }

/** A request that has been answered, whatever with. Not by fetch: its texts come 2 ms later, which a slider shows. */
function response_to(address, signal) {
  return new Promise((take, fail) => {
    const request = new XMLHttpRequest();
    request.open("GET", address);
    request.onload = () => take(request);
    request.onerror = () => fail(new Refused("The server no longer answers. Start faultsweep serve again and reload this page."));
    request.onabort = () => fail(new DOMException("", "AbortError"));
    if (signal) signal.addEventListener("abort", () => request.abort());
    request.send();
  });
}
/** What the server says; parameters that are "" are left out. Throws Refused with its words. */
async function asked(path, parameters, signal) {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(parameters || {}))
    for (const one of Array.isArray(value) ? value : [value]) if (one !== "" && one !== undefined) query.append(name, one);
  const words = query.toString(), response = await response_to(path + (words ? "?" + words : ""), signal);
  const text = response.responseText;
  if (response.status === 200) return text;
  let problem = {};
  try { problem = JSON.parse(text).error; } catch { problem = {cause: text.slice(0, 200), cure: ""}; }
  throw new Refused(problem.cause + (problem.cure ? "; " + problem.cure : ""));
}
async function asked_json(path, parameters, signal) { return JSON.parse(await asked(path, parameters, signal)); }

// What the present view has under way: it all ends with the view.
let under_way = [];
function leave() { under_way.forEach((stop) => stop()); under_way = []; }

/** Does something every so many ms as long as the view and the page are looked at. */
function regularly(milliseconds, act) {
  const timer = setInterval(() => { if (!document.hidden) act(); }, milliseconds);
  under_way.push(() => clearInterval(timer));
}
/** A place that shows the newest of what was asked for it; what it shows stays until that is there. */
class Place {
  constructor(element) {
    this.element = element;
    this.newest = null;
    under_way.push(() => this.stop());
  }
  stop() { if (this.newest) this.newest.abort(); this.newest = null; }
  /** @param put  takes the text; without it the text is the place's HTML. */
  async show(path, parameters, put) {
    this.stop();
    const mine = this.newest = new AbortController();
    try {
      const text = await asked(path, parameters, mine.signal);
      if (this.newest !== mine) return;
      if (put) put(text); else this.element.innerHTML = text;
    } catch (error) {
      if (error.name !== "AbortError" && this.newest === mine) this.say(error);
    }
  }
  drawing(path, parameters) { return this.show(path, parameters, (svg) => { this.element.innerHTML = '<div class="chart">' + svg + "</div>"; }); }
  say(error) {
    if (!(error instanceof Refused)) throw error;
    this.element.replaceChildren(made("p", {class: "faint", role: "status"}, error.message));
  }
}
function section(title) {
  const place = made("div", {});
  view.append(made("h2", {}, title), place);
  return new Place(place);
}
function begin(title, ...links) {
  leave();
  document.title = title;
  document.querySelector("h1").textContent = title;
  document.querySelector("nav").replaceChildren(...links);
  view.replaceChildren();
}
function column_of_head(table, key) {
  return Array.from(table.tHead.rows[0].cells).findIndex((head) => head.dataset.key === key);
}
/** The cells of a column lead somewhere. */
function lead(table, key, to) {
  const k = column_of_head(table, key);
  if (k < 0) return;
  for (const row of table.tBodies[0].rows) {
    const text = row.cells[k].textContent;
    if (text) row.cells[k].replaceChildren(link(text, ...to(text)));
  }
}

// The store ----------------------------------------------------------------------------------------------------------------------
function show_store() {
  begin("Campaigns");
  const list = new Place(view.appendChild(made("div")));
  list.show("/api/campaigns", {as: "html"}, (html) => {
    list.element.innerHTML = html;
    const table = list.element.querySelector("table");
    if (table) lead(table, "campaign", (name) => [name]);
  });
}

// A campaign ---------------------------------------------------------------------------------------------------------------------
const rows_of_ranking = 50;

/** The ranking, paged and sorted by the server. Returns what shows it anew. */
function add_ranking(api, campaign) {
  const place = section("Ranking"), table_place = made("div"), order = {by: "", order: "", page: 1, where: ""};
  const where = made("input", {type: "text", size: "40", placeholder: "slides and friction_angle < 20 deg", "aria-label": "only cases where"});
  const said = made("output"), turns = [];
  function turn(words, to) { turns.push(button(words, () => { order.page = to(); show(); })); }
  let n_rows = 0;
  const last = () => Math.max(1, Math.ceil(n_rows / rows_of_ranking));
  turn("first", () => 1);
  turn("previous", () => order.page - 1);
  turn("next", () => order.page + 1);
  turn("last", last);
  place.element.append(made("p", {}, made("label", {}, "only cases where ", where)), table_place, made("p", {class: "pager"}, ...turns, " ", said));
  const rows = new Place(table_place), count = new Place(said);

  function sort_by(name) {
    if (order.by !== name) Object.assign(order, {by: name, order: ""});
    else if (order.order === "") order.order = "ascending";
    else Object.assign(order, {by: "", order: ""});
    order.page = 1;
    show();
  }
  function take(html) {
    const focused = document.activeElement && rows.element.contains(document.activeElement) && document.activeElement.dataset.by;
    rows.element.innerHTML = html;
    const table = rows.element.querySelector("table");
    if (!table) return;
    lead(table, "case", (number) => [campaign, number]);
    for (const head of table.tHead.rows[0].cells) {
      if (!head.dataset.by) continue;
      const sorts = button(head.textContent, () => sort_by(head.dataset.by));
      sorts.dataset.by = head.dataset.by;
      head.replaceChildren(sorts);
      head.setAttribute("aria-sort", head.dataset.by !== order.by ? "none" : order.order || "descending");
      if (focused === head.dataset.by) sorts.focus();
    }
  }
  async function show() {
    await rows.show(api + "/ranking", {as: "html", rows: rows_of_ranking, ...order}, take);
    await count.show(api + "/ranking", {rows: 1, where: order.where}, (text) => {
      n_rows = JSON.parse(text).rows;
      const from = (order.page - 1) * rows_of_ranking;
      said.textContent = n_rows === 0 ? "no rows" :
        "rows " + counted(from + 1) + " to " + counted(Math.min(n_rows, from + rows_of_ranking)) + " of " + counted(n_rows);
      turns[0].disabled = turns[1].disabled = order.page === 1;
      turns[2].disabled = turns[3].disabled = order.page >= last();
    });
  }
  where.addEventListener("change", () => { Object.assign(order, {where: where.value.trim(), page: 1}); show(); });
  show();
  return show;
}
function choice(words, names, chosen, go) {
  const select = made("select", {}, ...names.map((name) => made("option", {value: name}, name.replace(/_/g, " "))));
  select.value = chosen;
  select.addEventListener("change", go);
  return [made("label", {}, words, " ", select), select];
}
/** What became of the cases against two parameters. Returns what shows it anew. */
function add_map(api) {
  const place = section("Where it happens"), choices = made("p", {class: "choices"}), drawing = made("div");
  place.element.append(choices, drawing);
  const map = new Place(drawing);
  let x = {value: ""}, y = {value: ""};
  const show = () => map.drawing(api + "/map.svg", {x: x.value, y: y.value});
  new Place(choices).show(api + "/ranking", {rows: 1}, (text) => {
    const names = JSON.parse(text).columns.cases.filter((one) => one.in === "parameters").map((one) => one.key);
    if (names.length > 2) {
      const [x_label, x_select] = choice("along", names, names[0], show), [y_label, y_select] = choice("up", names, names[1], show);
      x = x_select;
      y = y_select;
      choices.replaceChildren(x_label, y_label);
    }
    show();
  });
  return show;
}
/** An answer that is asked for when it is looked at. Returns what shows it anew, if it is. */
function add_answer(title, path, parameters) {
  const details = made("details", {}, made("summary", {}, title)), body = made("div", {}, made("p", {class: "faint"}, "being computed"));
  details.append(body);
  view.append(details);
  const place = new Place(body), show = () => { if (details.open) place.show(path, {...parameters, as: "html"}); };
  details.addEventListener("toggle", show);
  return show;
}
/** How it stands; calls `news` when there is something new. */
function follow(place, api, news) {
  let decided = -1, since = 0;
  const bar = made("progress", {"aria-label": "cases decided"}), said = made("div", {role: "status"});
  place.element.append(bar, said);
  const standing = new Place(said);
  const look = () => standing.show(api, {}, (text) => {
    const now = JSON.parse(text);
    said.replaceChildren(...now.headline.map((sentence) => made("p", {class: "answer"}, sentence)));
    bar.max = now.cases;
    bar.value = now.done + now.failed;
    bar.hidden = now.waiting === 0;
    const all = now.done + now.failed, patience = 3000;
    if (all !== decided && Date.now() - since > patience) {
      if (decided >= 0) news();
      decided = all;
      since = Date.now();
    }
  });
  regularly(2000, look);
  return look();
}
async function show_campaign(campaign) {
  const api = "/api/campaigns/" + encodeURIComponent(campaign);
  begin(campaign, link("all campaigns"));
  const standing = section("Status"), parts = [add_map(api), add_ranking(api, campaign)];
  view.append(made("h2", {}, "More"));
  parts.push(add_answer("How often each fault slides", api + "/probability", {}),
    add_answer("How soon each fault begins to slide", api + "/curves", {against: "time"}),
    add_answer("What matters", api + "/sensitivity", {}), add_answer("Safe limits", api + "/limits", {}),
    add_answer("Workers, failures and families", api, {}));
  await follow(standing, api, () => parts.forEach((show) => show()));
}

// A case -------------------------------------------------------------------------------------------------------------------------
/** Section and histories with their slider, in `element`. `moved` is told the load step, now and whenever it is another. */
function add_steps(element, api, moved) {
  const place = new Place(element);
  return place.show(api + "/steps", {}, (html) => {
    element.innerHTML = html;
    const part = element.querySelector("[data-case]");
    if (!part) return;
    const steps = show_steps(part), slider = part.querySelector("input[type=range]");
    const tell = () => moved(steps[slider.value].step);
    slider.addEventListener("input", tell);
    tell();
  });
}
const why_no_fields = {
  none: "No fields of this case were kept (\"keep_fields\": \"stages\" in the spec keeps those of all cases). ",
  wanted: "The fields of this case are not written yet: faultsweep run writes them. ",
  failed: "The fields of this case could not be written: see its last attempt, below. ",
  gone: "The files with the fields of this case are gone. ",
};
const map_shows = ["chi", "slip", "state", "pressure"];
/** Charts of one fault at the step, which need stored fields. */
class FaultCharts {
  constructor(element, api, faults) {
    this.api = api;
    this.step = "";
    const [label, select] = choice("fault", faults, faults[0], () => this.draw());
    this.select = select;
    const [shown_label, shown] = choice("map of", map_shows, map_shows[0], () => this.draw());
    this.shown = shown;
    this.places = ["profiles", "fault-map", "stress-path"].map((name) => [name, made("div")]);
    element.append(made("p", {class: "choices"}, label, shown_label), ...this.places.map(([, one]) => one));
    this.places = this.places.map(([name, one]) => [name, new Place(one)]);
  }
  show(step) { this.step = step; this.draw(); }
  draw() {
    for (const [name, place] of this.places)
      place.drawing(this.api + "/" + name + ".svg", {fault: this.select.value, step: name === "stress-path" ? "" : this.step,
        show: name === "fault-map" ? this.shown.value : ""});
  }
}
function settings_of(one) {
  return one.settings.map((setting) => setting.parameter.replace(/_/g, " ") + " " + short_number(setting.given)).join(", ");
}
/** "15.0943434 deg" as "15.09 deg". */
function short_number(text) {
  const [, number, rest] = text.match(/^([-+\d.eE]+)(.*)$/) || [null, "", text];
  return number && Number.isFinite(Number(number)) ? Number(Number(number).toPrecision(4)) + rest : text;
}
async function show_case(campaign, number) {
  const api = of_case(campaign, number);
  begin("Case " + number + " of " + campaign, link(campaign, campaign), link("what if?", campaign, number, "what-if"));
  const settings = view.appendChild(made("p", {class: "answer"})), beside = made("input", {type: "number", min: "1", "aria-label": "case beside this one"});
  const go = button("show beside", () => { if (beside.value) location.hash = address(campaign, number, "beside", beside.value); });
  view.append(made("p", {}, made("label", {}, "another case ", beside), " ", go));
  const steps = section("Step by step"), faults = section("Fault by fault"), told = section("What became of it");
  told.show(api, {as: "html"});
  const said = new Place(settings);
  await said.show(api, {}, (text) => {
    const one = JSON.parse(text);
    settings.textContent = settings_of(one);
    if (!one.result) return;
    if (!one.fields || one.fields.state !== "kept") {
      faults.element.replaceChildren(made("p", {class: "faint"}, why_no_fields[one.fields ? one.fields.state : "none"],
        link("What if?", campaign, number, "what-if"), " runs it again and draws profiles, map and stress path of each fault."));
      add_steps(steps.element, api, () => {});
    } else {
      const charts = new FaultCharts(faults.element, api, one.result.faults);
      add_steps(steps.element, api, (step) => charts.show(step));
    }
  });
}
async function show_beside(campaign, number, other) {
  begin("Cases " + number + " and " + other, link(campaign, campaign), link("case " + number, campaign, number), link("case " + other, campaign, other));
  const rows = section("Both"), columns = view.appendChild(made("div", {class: "beside"}));
  rows.show("/api/campaigns/" + encodeURIComponent(campaign) + "/ranking", {as: "html", where: "case == " + number + " or case == " + other}, (html) => {
    rows.element.innerHTML = html;
    const table = rows.element.querySelector("table");
    if (table) lead(table, "case", (k) => [campaign, k]);
  });
  for (const one of [number, other]) {
    const part = made("div");
    columns.append(made("div", {}, made("h2", {}, "Case " + one), part));
    add_steps(part, of_case(campaign, one), () => {});
  }
}

// What if ------------------------------------------------------------------------------------------------------------------------
/** A parameter as a slider, or as a choice among a few values. */
class Control {
  constructor(parameter, moved) {
    this.of = parameter;
    this.said = made("output");
    this.input = parameter.choices ? this.make_choice() : this.make_slider();
    this.input.addEventListener("input", () => { this.say(); moved(); });
    const words = made("label", {}, made("span", {title: parameter.meaning}, parameter.name, parameter.keeps_operator ? "" : " \u2020"), this.input);
    this.element = made("div", {class: "control"}, words, this.said);
    this.say();
  }
  make_choice() {
    return made("select", {}, made("option", {value: ""}, "as it is"),
      ...this.of.choices.map((one, k) => made("option", {value: k}, one.text)));
  }
  make_slider() {
    const slider = made("input", {type: "range", min: "0", max: "1000", step: "1"});
    slider.value = this.start = String(Math.round(1000 * this.share(this.of.value)));
    return slider;
  }
  share(value) {
    const {from, to, log} = this.of;
    return log ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
  }
  /** As a scene has it. */
  value() {
    const {from, to, log, unit} = this.of, t = this.input.value / 1000;
    const number = Number((log ? from * (to / from) ** t : from + t * (to - from)).toPrecision(4));
    return unit ? number + " " + unit : number;
  }
  is_moved() { return this.of.choices ? this.input.value !== "" : this.input.value !== this.start; }
  say() {
    if (this.of.choices) return;
    this.said.textContent = this.is_moved() ? String(this.value()) : short_number(this.of.value + (this.of.unit ? " " + this.of.unit : ""));
    this.input.setAttribute("aria-valuetext", this.said.textContent);
    this.element && this.element.classList.toggle("moved", this.is_moved());
  }
  reset() { this.input.value = this.of.choices ? "" : this.start; this.say(); }
  add_to(changes) {
    if (!this.is_moved()) return;
    if (this.of.choices) Object.assign(changes, this.of.choices[this.input.value].changes);
    else this.of.pointers.forEach((pointer) => { changes[pointer] = this.value(); });
  }
}

/** Questions to the simulator of the server: the newest one wins, here and there. */
class Questions {
  constructor(path, answered) {
    this.path = path;
    this.answered = answered;
    this.page = Math.random().toString(36).slice(2);
    this.number = 0;
    this.wanted = null;
    this.sent = 0;  // when the question under way was; 0: none is
    this.is_left = false;
    under_way.push(() => { this.is_left = true; });
  }
  /** @param question  without number. */
  ask(question) {
    const patience = 80;  // ms, after which a question that is not answered yet is superseded
    this.wanted = question;
    if (this.sent === 0 || performance.now() - this.sent > patience) this.go();
  }
  async go() {
    const question = this.wanted, number = ++this.number;
    this.wanted = null;
    this.sent = performance.now();
    const began = this.sent;
    let reply = {state: "running"}, wait = 200;  // ms until the server says how far it is
    while (!this.is_left && number === this.number && (reply.state === "running" || reply.state === "building")) {
      try {
        reply = await asked_json(this.path, {...question, page: this.page, ask: number, wait});
        wait = 250;
      } catch (error) {
        if (!(error instanceof Refused)) throw error;
        reply = {state: "refused", problems: [{cause: error.message, cure: ""}]};
      }
      if (!this.is_left && number === this.number) this.answered(reply, question, performance.now() - began);
    }
    if (number !== this.number || this.is_left) return;
    this.sent = 0;
    if (this.wanted) this.go();
  }
}
const step_charts = ["profiles", "fault-map", "stress-path"];
/** What of the changes moves lines of the section; all others only colour it. */
function geometry_of(changes) {
  return JSON.stringify(Object.entries(changes).filter(([pointer]) => /^\/(geometry|faults|pressure_field)(\/|$)/.test(pointer)));
}

class WhatIf {
  constructor(campaign, number, parameters, faults) {
    Object.assign(this, {campaign, number, step: null, faults});
    this.controls = parameters.map((one) => new Control(one, () => this.ask()));
    this.questions = new Questions(of_case(campaign, number) + "/what-if", (...reply) => this.take(...reply));
    this.lay_out();
    this.let_move(false);  // until the case as it was is there, which all others are held against
    this.ask();
  }
  let_move(may) { this.controls.forEach((one) => { one.input.disabled = !may; }); }
  lay_out() {
    const own = this.controls.filter((one) => one.of.of_campaign), others = this.controls.filter((one) => !one.of.of_campaign);
    const [fault, fault_select] = choice("fault", this.faults, this.faults[0], () => this.ask());
    const [kind, kind_select] = choice("also", ["", ...step_charts], "", () => this.ask());
    const [map_of, map_select] = choice("map of", map_shows, map_shows[0], () => this.ask());
    Object.assign(this, {fault: fault_select, kind: kind_select, shown: map_select, said: made("p", {role: "status", class: "faint"}), words: made("div"),
      section: made("div"), history: made("div"), more: made("div"), text: made("pre"), slider: made("input", {type: "range", min: "0", value: "0"}), step_words: made("output")});
    this.slider.addEventListener("input", () => this.show_step());
    this.slider.addEventListener("change", () => { if (this.kind.value) this.ask(); });
    this.part = made("div", {}, this.section, this.history);
    const needs_build = this.controls.some((one) => !one.of.keeps_operator);
    const sliders = made("div", {class: "controls"}, made("h2", {}, "Varied in the campaign"), ...own.map((one) => one.element),
      made("p", {class: "faint"}, needs_build ? "\u2020 needs an operator of its own, which is built first" : ""),
      made("details", {}, made("summary", {}, "Others that use the same operator"), ...others.map((one) => one.element)),
      button("as it was", () => { this.controls.forEach((one) => one.reset()); this.ask(); }));
    const copied = made("details", {}, made("summary", {}, "Export"), ...["scene", "scene as it was", "run line", "campaign"].map((what) =>
      button(what, () => { this.text.textContent = this.as(what); })), this.text);
    const shown = made("div", {}, this.said, this.words, made("div", {class: "slider"}, made("label", {}, "load step", this.slider), this.step_words),
      this.part, made("p", {class: "choices"}, fault, kind, map_of), this.more, copied);
    view.append(made("div", {class: "what-if"}, sliders, shown));
  }
  changes() {
    const changes = {};
    this.controls.forEach((one) => one.add_to(changes));
    return changes;
  }
  ask() {
    const changes = this.changes(), step = this.steps && this.kind.value ? this.steps[this.slider.value].step : "";
    const section = geometry_of(changes) === this.geometry ? [] : ["section"];
    const charts = [...section, "history", ...(this.kind.value ? [this.kind.value] : [])];
    this.questions.ask({changes: JSON.stringify(changes), chart: charts, fault: this.fault.value, step, cursor: "yes",
      show: this.kind.value === "fault-map" ? this.shown.value : ""});
  }
  /** Which case this is, in words. */
  name() {
    const moved = this.controls.filter((one) => one.is_moved()).map((one) => one.of.name + " " + (one.of.choices ? one.of.choices[one.input.value].text : one.value()));
    return "Case " + this.number + (moved.length ? " with " + moved.join(", ") : " as it was");
  }
  take(reply, question, milliseconds) {
    const name = this.name();
    switch (reply.state) {
      case "done": this.said.textContent = name + ": " + reply.outcome + ", " + Math.round(milliseconds) + " ms"; return this.show(reply, question);
      case "building": this.said.textContent = name + ": building its operator: " + (reply.says || ""); break;
      case "running": this.said.textContent = name + ": running" + (reply.says ? ", " + reply.says : ""); break;
      case "refused": this.said.textContent = name + " is not possible: " + reply.problems.map((one) => one.cause + (one.cure ? "; " + one.cure : "")).join(". "); break;
      case "failed": this.said.textContent = name + ": " + reply.says; break;
      case "superseded": if (reply.says) this.said.textContent = reply.says; break;
    }
    return undefined;
  }
  show(reply, question) {
    if (question.chart.length === 0) return this.ask();  // the original is there again
    const lost = question.changes !== "{}" && !reply.differences;  // its simulator was begun anew, or had another page's case
    if (lost && !this.has_asked_again) {
      this.has_asked_again = true;
      return this.questions.ask({changes: "{}", chart: []});
    }
    this.has_asked_again = lost;
    this.reply = reply;
    if (!this.original) this.let_move(true);
    this.original = this.original || reply.scene;
    const lines = [...(reply.differences || []).map((line) => made("p", {class: "answer difference"}, line)),
      ...reply.sentences.map((line) => made("p", {}, line))];
    this.words.replaceChildren(...lines);
    const drawn = (name) => typeof reply.charts[name] === "string" ? '<div class="chart">' + reply.charts[name] + "</div>" : "";
    if (reply.charts.section) {
      this.section.innerHTML = drawn("section");
      this.geometry = geometry_of(JSON.parse(question.changes));
    }
    this.history.innerHTML = drawn("history");
    const more = this.kind.value, chart = reply.charts[more];
    if (more && typeof chart === "object") this.more.replaceChildren(made("p", {class: "faint"}, chart.problems.map((one) => one.cause + "; " + one.cure).join(". ")));
    else this.more.innerHTML = more ? drawn(more) : "";
    if (reply.steps) this.take_steps(reply);
    this.text.textContent = "";
    return undefined;
  }
  /** The step stays where the reader has put it. */
  take_steps(reply) {
    const first = !this.steps;
    this.steps = reply.steps;
    this.slider.max = reply.steps.length - 1;
    if (first) this.slider.value = reply.critical_step;
    this.shower = step_shower(this.part, reply.steps);
    this.show_step();
  }
  show_step() {
    if (!this.shower) return;
    this.step_words.textContent = this.shower(this.slider.value);
    this.slider.setAttribute("aria-valuetext", this.step_words.textContent);
  }
  as(what) {
    if (!this.reply) return "There is nothing yet.";
    const changes = this.changes(), file = "case-" + this.number + ".json";
    const quoted = (text) => "'" + String(text).replace(/'/g, "'\\''") + "'";
    switch (what) {
      case "scene": return JSON.stringify(this.reply.scene, null, 1);
      case "scene as it was": return JSON.stringify(this.original, null, 1);
      case "run line":  // of the scene as it was
        return "faultsim run " + file + Object.entries(changes).map(([pointer, value]) => " --set " + quoted(pointer + "=" + value)).join("");
      default: return JSON.stringify({format: 1, name: "what-if", base: file, design: {kind: "list", cases: [changes]}}, null, 1);
    }
  }
}
async function show_what_if(campaign, number) {
  const api = of_case(campaign, number);
  begin("What if: case " + number + " of " + campaign, link(campaign, campaign), link("case " + number, campaign, number));
  const place = new Place(view.appendChild(made("div"))), signal = undefined;
  try {
    const [{parameters}, one] = await Promise.all([asked_json(api + "/parameters", {}, signal), asked_json(api, {}, signal)]);
    const faults = one.result ? one.result.faults : [];
    if (location.hash !== address(campaign, number, "what-if")) return;
    new WhatIf(campaign, number, parameters, faults);
  } catch (error) {
    place.say(error);
  }
}

// Where to go --------------------------------------------------------------------------------------------------------------------
function go() {
  const [campaign, number, what, other] = location.hash.replace(/^#\/?/, "").split("/").map(decodeURIComponent);
  if (!campaign) return show_store();
  if (!number) return show_campaign(campaign);
  if (what === "what-if") return show_what_if(campaign, number);
  if (what === "beside" && other) return show_beside(campaign, number, other);
  return show_case(campaign, number);
}
addEventListener("hashchange", go);
go();

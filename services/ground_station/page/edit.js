// The editor of a mission: one text, with all that is shown made from it.

import { color, colorOf } from "./canvas.js";
import { EditMap } from "./edit_map.js";
import { gantt, routes } from "./edit_plan.js";
import * as relations from "./edit_relations.js";
import { OF_MAP, TOOLS, places } from "./edit_tools.js";
import { open, theme } from "./opening.js";

const by = id => document.getElementById(id);
const token = new URLSearchParams(location.search).get("token") || "";
const ROUTED = ["geojson", "kml", "qgc"]; // formats that may have the routes of a plan
const SETTLED_MS = 250, POLL_MS = 300;

class Refused extends Error {}

async function ask(path, body) {
  let response;
  try {
    response = await fetch(path, { method: "POST", headers: { "Content-Type": "application/json", "X-Cratous-Token": token }, body: JSON.stringify(body) });
  } catch (error) {
    throw new Refused(`The server does not answer (${error.message}). What is not saved is only on this page.`);
  }
  const told = await response.json();
  if (!response.ok) throw new Refused([told.error, told.item, told.expected && `expected ${told.expected}`].filter(Boolean).join("; "));
  return told;
}

function download(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

class Editor {
  constructor(opened) {
    Object.assign(this, { text: opened.text, digest: opened.digest, saved: opened.text, past: [], future: [], found: opened, tool: null, planned: null, given: opened.relations || "", number: null, waiting: new Set(), settled: 0, polling: false });
    by("name").textContent = opened.file;
    document.title = `${opened.file} – CRATOUS mission editor`;
    this.map = new EditMap(by("map"), {
      moved: (key, north_m, east_m) => this.change({ do: "move", key, north_m, east_m }),
      clicked: (north, east) => this.point(north, east),
      finished: () => this.finish(),
      picked: key => { by("remove").disabled = key === null || !OF_MAP.includes(key[0]); },
    });
    this.listen();
    by("text").value = this.text;
    by("relations").value = this.given;
    this.show(opened);
    this.relations();
    this.mark();
  }

  say(text, bad = false) {
    by("saved").textContent = text;
    by("saved").className = bad ? "bad" : "";
  }

  mark() {
    const open_ = this.text !== this.saved;
    by("saved").textContent = `${open_ ? "not saved" : "saved"}${this.typing() ? "; the relations typed are not in the file" : ""}`;
    by("saved").className = open_ ? "open" : "";
    by("undo").disabled = !this.past.length;
    by("redo").disabled = !this.future.length;
    if (this.planned) by("plan-state").textContent = `${this.planned.of === this.text ? "" : "Of an earlier text: "}${this.planned.text}`;
  }

  // whether the relations in their field are not those that the text last had
  typing() { return by("relations").value !== this.given; }

  // what is typed in the text is the text, without waiting for a pause
  settle() {
    clearTimeout(this.settled);
    if (this.settled) this.set(by("text").value);
    this.settled = 0;
  }

  // the text is another one; what stood before can be had again
  set(text, keep = true) {
    if (text === this.text) return;
    if (keep) { this.past.push(this.text); this.future = []; }
    this.text = text;
    if (by("text").value !== text) by("text").value = text;
    this.mark();
    this.look();
  }

  async look() {
    const { text } = this;
    try {
      const found = await ask("/sketch", { text });
      if (text !== this.text) return; // a newer one is on its way
      this.show(found);
      await this.relations();
    } catch (error) { this.say(error.message, true); }
  }

  show(found) {
    const typing = this.typing();
    this.found = found.drawn ? found : { ...this.found, problems: found.problems };
    this.map.show(found);
    by("problems-none").hidden = found.problems.length > 0;
    by("problems").replaceChildren(...found.problems.map(problem => {
      const item = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      button.className = "violated";
      button.textContent = [problem.line ? `line ${problem.line}` : "", problem.item, problem.error, problem.expected && `expected ${problem.expected}`, problem.got && `got ${problem.got}`].filter(Boolean).join("; ");
      button.addEventListener("click", () => this.line(problem.line));
      item.append(button);
      return item;
    }));
    by("notes").replaceChildren(...found.notes.map(note => Object.assign(document.createElement("li"), { textContent: note })));
    if (found.drawn) this.given = found.relations;
    if (!typing) by("relations").value = this.given;
    this.vehicles();
    by("plan").disabled = by("export").disabled = found.problems.length > 0;
  }

  line(number) {
    if (!number) return;
    const field = by("text"), lines = field.value.split("\n");
    const from = lines.slice(0, number - 1).join("\n").length + (number > 1 ? 1 : 0);
    field.focus();
    field.setSelectionRange(from, from + lines[number - 1].length);
    field.scrollTop = Math.max(0, (number - 6) * field.scrollHeight / lines.length);
  }

  async relations() {
    const text = by("relations").value;
    const told = await ask("/relations", { text, tasks: this.found.tasks });
    if (text === by("relations").value) relations.show(text, told);
    this.mark();
    return told;
  }

  // typed relations go into the text once they are a term
  async typed() {
    try {
      const told = await this.relations();
      if (!told.error && this.typing()) await this.change({ do: "put", key: ["relations"], value: by("relations").value });
    } catch (error) { this.say(error.message, true); }
  }

  async change(change) {
    this.settle();
    const { text } = this;
    try {
      const told = await ask("/change", { text, ...change });
      this.settle();
      if (text !== this.text) throw new Refused("The text was changed meanwhile, so this change was not made.");
      // known before the text is looked at: an undo may come first
      if (change.key?.[0] === "relations") this.given = change.value;
      this.set(told.text);
    } catch (error) {
      this.say(error.message, true);
      this.look();
    }
  }

  draw(name) {
    const tool = TOOLS[name];
    this.tool = tool ? name : null;
    this.map.take(tool);
    for (const button of document.querySelectorAll("#tools [data-tool]")) button.classList.toggle("on", button.dataset.tool === this.tool);
    by("finish").hidden = !tool || Boolean(tool.most);
    by("cancel").hidden = !tool;
    by("circles").hidden = !tool?.circles;
    by("hint").textContent = tool ? tool.hint : "";
  }

  point(north, east) {
    const { drawing } = this.map;
    drawing.push([Math.round(north * 10) / 10, Math.round(east * 10) / 10]);
    this.map.redraw();
    if (places(drawing).length >= TOOLS[this.tool].most) this.finish();
  }

  finish() {
    const tool = TOOLS[this.tool], clicked = places(this.map.drawing);
    if (clicked.length < tool.least) { by("hint").textContent = `${tool.least} places are needed.`; return; }
    const circles_s = by("circles-s").valueAsNumber;
    if (tool.circles && !(circles_s > 0)) { by("hint").textContent = "For how many seconds does it circle? More than 0."; return; }
    this.draw(null);
    this.change({ do: "add", list: tool.list, item: tool.item(clicked, circles_s) });
  }

  remove() {
    const key = this.map.picked;
    if (key && OF_MAP.includes(key[0])) this.change({ do: "remove", key: key.slice(0, 2) });
  }

  back(from, to) {
    this.settle();
    if (!from.length) return;
    to.push(this.text);
    this.set(from.pop(), false);
  }

  async save() {
    this.settle();
    const { text } = this;
    try {
      this.digest = (await ask("/save", { text, digest: this.digest })).digest;
      this.saved = text;
      this.mark();
    } catch (error) { this.say(error.message, true); }
  }

  async export() {
    this.settle();
    const { text } = this, format = by("export-format").value;
    try {
      const routed = ROUTED.includes(format) && this.planned?.of === text;
      const told = await ask("/export", { text, format, ...(routed ? { plan_number: this.number } : {}), ...(format === "qgc" ? { vehicle: Number(by("export-vehicle").value) } : {}) });
      const names = Object.keys(told.files);
      for (const name of names) download(name, told.files[name]);
      const notes = told.unsaid.length ? "; this format does not say:" : "; it says all of the mission";
      by("exported-files").textContent = `${names.join(" and ")}${names.length > 1 ? ", for one folder" : ""}${routed ? ", with the planned routes" : ""}${notes}`;
      by("unsaid").replaceChildren(...told.unsaid.map(one => Object.assign(document.createElement("li"), { textContent: one })));
      by("exported").hidden = false;
    } catch (error) { this.say(error.message, true); }
  }

  // of whom a flight plan may be; the one that was chosen stays
  vehicles() {
    const field = by("export-vehicle"), before = field.value;
    field.hidden = by("export-format").value !== "qgc";
    field.replaceChildren(...(this.found?.drawn?.vehicles ?? []).map(one => new Option(one.label ? `${one.id} ${one.label}` : one.id, one.id)));
    if ([...field.options].some(one => one.value === before)) field.value = before;
  }

  async plan() {
    this.settle();
    const { text } = this;
    this.number = null; // what is told of another plan is not of this one
    this.planned = null;
    this.waiting = new Set();
    this.map.routes([]);
    for (const id of ["gantt", "why", "plan-notes", "constraints"]) by(id).replaceChildren();
    this.state("Planning: starting");
    try { this.number = (await ask("/plan", { text })).plan_number; } catch (error) { this.state(error.message, true); return; }
    this.asked = text;
    this.poll();
  }

  state(text, bad = false) {
    by("plan-state").textContent = text;
    by("plan-state").className = bad ? "bad" : "";
  }

  async poll() {
    if (this.polling) return;
    this.polling = true;
    try {
      for (;;) {
        const { number } = this, told = number !== null && await (await fetch("/planned.json")).json();
        if (number !== this.number) continue; // this page plans anew
        if (number === null) break;
        if (told.plan_number !== number) { this.superseded(); break; }
        const on = told.state === "planning";
        by("plan-stop").hidden = !on;
        if (told.state === "planned") this.result(told);
        else this.state(on ? `Planning: ${told.text}` : told.text, told.state === "failed");
        if (!on && !this.waiting.size) break;
        await new Promise(done => setTimeout(done, POLL_MS));
      }
    } catch (error) { this.say(`The server does not answer (${error.message}).`, true); }
    this.polling = false;
  }

  // the server has one plan, and another page has planned since
  superseded() {
    by("plan-stop").hidden = true;
    by("why").replaceChildren();
    this.waiting = new Set();
    if (!this.planned) this.state("Another page planned its text before this plan was made: plan again.", true);
  }

  result(told) {
    for (const task of this.waiting) if (told.why[task]) {
      this.waiting.delete(task);
      by("why").replaceChildren(...told.why[task].map(line => Object.assign(document.createElement("li"), { textContent: line })));
    }
    if (this.planned) return;
    this.planned = { of: this.asked, text: `${told.text}; proofs: ${told.proofs}` };
    this.state(this.planned.text, told.exit_code !== 0);
    const { drawn } = this.found;
    this.map.routes(routes(told.plan, drawn.starts));
    by("gantt").replaceChildren(gantt(told.plan, told.windows, drawn.vehicles, id => colorOf(this.map.recording, id) || color("c0"), task => this.why(task)));
    by("plan-notes").replaceChildren(...told.notes.map(note => Object.assign(document.createElement("li"), { textContent: note })));
    const head = by("constraints").createTHead().insertRow();
    for (const name of ["constraint", "verdict", "note"]) head.append(Object.assign(document.createElement("th"), { textContent: name }));
    const body = by("constraints").createTBody();
    for (const row of told.constraints) {
      const line = body.insertRow();
      for (const [text, name] of [[row.item, ""], [row.verdict, row.verdict], [row.note, ""]]) Object.assign(line.insertCell(), { textContent: text, className: name });
    }
    this.mark();
  }

  async why(task) {
    try {
      await ask("/why", { task, plan_number: this.number });
      this.waiting.add(String(task));
      by("why").replaceChildren(Object.assign(document.createElement("li"), { textContent: `Planning with each vehicle for p${task} …` }));
      this.poll();
    } catch (error) { this.say(error.message, true); }
  }

  listen() {
    let typed = 0;
    by("text").addEventListener("input", () => { clearTimeout(this.settled); this.settled = setTimeout(() => this.settle(), SETTLED_MS); });
    by("relations").addEventListener("input", () => { clearTimeout(typed); typed = setTimeout(() => this.typed(), SETTLED_MS); });
    by("undo").addEventListener("click", () => this.back(this.past, this.future));
    by("redo").addEventListener("click", () => this.back(this.future, this.past));
    by("save").addEventListener("click", () => this.save());
    by("export").addEventListener("click", () => this.export());
    by("export-format").addEventListener("change", () => this.vehicles());
    by("plan").addEventListener("click", () => this.plan());
    by("plan-stop").addEventListener("click", () => ask("/stop", { plan_number: this.number }).catch(error => this.say(error.message, true)));
    by("remove").addEventListener("click", () => this.remove());
    by("finish").addEventListener("click", () => this.finish());
    by("cancel").addEventListener("click", () => this.draw(null));
    for (const button of document.querySelectorAll("#tools [data-tool]")) button.addEventListener("click", () => this.draw(this.tool === button.dataset.tool ? null : button.dataset.tool));
    by("closer").addEventListener("click", () => this.map.zoom(1.4));
    by("farther").addEventListener("click", () => this.map.zoom(1 / 1.4));
    by("whole").addEventListener("click", () => { this.map.state.view = null; this.map.redraw(); });
    by("theme").addEventListener("click", () => { theme(document.documentElement.className === "dark" ? "light" : "dark"); this.map.redraw(); });
    by("map").addEventListener("pointermove", event => {
      const [north, east] = this.map.under(event.offsetX, event.offsetY);
      by("cursor").textContent = `north ${north.toFixed(0)} m, east ${east.toFixed(0)} m`;
    });
    addEventListener("beforeunload", event => { if (this.settled || this.text !== this.saved || this.typing()) event.preventDefault(); });
    addEventListener("keydown", event => {
      const key = event.key.toLowerCase(), typing = ["TEXTAREA", "INPUT"].includes(event.target.tagName);
      if (event.ctrlKey || event.metaKey) {
        const act = { s: () => this.save(), z: () => this.back(this.past, this.future), y: () => this.back(this.future, this.past) }[key];
        if (act) { event.preventDefault(); act(); }
      } else if (event.key === "Enter" && this.tool && !["TEXTAREA", "BUTTON"].includes(event.target.tagName)) this.finish();
      else if (event.key === "Escape") this.draw(null);
      else if (!typing && event.key === "Delete") this.remove();
    });
  }
}

await open(opened => { new Editor(opened); });

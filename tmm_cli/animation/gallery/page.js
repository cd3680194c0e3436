"use strict";
// Frames were computed; here they are only interpolated. What is searched is what the cards say.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const PLACE = data.place, TURN = data.turn;

// ---- frames: differences become values, with one more at either end for the cubic between them
function course(packed, unit, loops) {
  if (typeof packed === "number") return packed / unit;
  let sum = 0;
  const values = packed.map((difference) => (sum += difference) / unit);
  const last = values.length - 1, turn = values[last] - values[0];
  const before = loops ? values[last - 1] - turn : 2 * values[0] - values[1];
  const after = loops ? values[1] + turn : 2 * values[last] - values[last - 1];
  return Float64Array.from([before, ...values, after]);
}

function between(values, k, share) {
  if (typeof values === "number") return values;
  const a = values[k], b = values[k + 1], c = values[k + 2], d = values[k + 3];
  return b + 0.5 * share * (c - a + share * (2 * a - 5 * b + 4 * c - d + share * (3 * (b - c) + d - a)));
}

// ---- cards
const cards = [...document.querySelectorAll(".card")].map((element, n) => ({
  element, data: data.cards[n], picture: element.querySelector(".picture"), text: plain(element.textContent),
  facts: data.cards[n].facts.map(([name, number]) => ({name: plain(name), number})),
  at: 0, way: 1, moves: Boolean(data.cards[n].bodies.length), turning: true, bodies: null,
}));
const byElement = new Map(cards.map((card) => [card.element, card]));

function unpack(card) {
  const {bodies, loops} = card.data;
  card.bodies = bodies.map(([x, y, turn, stretch]) => ({
    x: course(x, PLACE, loops), y: course(y, PLACE, loops), turn: course(turn, TURN, loops),
    stretch: course(stretch, TURN, loops), groups: [],
  }));
  card.last = Math.max(...bodies.flat().map((packed) => packed.length || 0)) - 1;
  for (const group of card.element.querySelectorAll("[data-body]")) {
    card.bodies[group.dataset.body].groups.push(group);
  }
}

const short = (value) => Math.round(value * 1e4) / 1e4;

function place(card) {
  const at = Math.min(Math.max(card.at, 0), 1) * card.last;
  const k = Math.min(Math.floor(at), card.last - 1), share = at - k;
  for (const body of card.bodies) {
    const turn = between(body.turn, k, share), stretch = between(body.stretch, k, share);
    const c = Math.cos(turn), s = Math.sin(turn);
    const x = between(body.x, k, share), y = between(body.y, k, share);
    const matrix = `matrix(${short(stretch * c)} ${short(stretch * s)} ${short(-s)} ${short(c)} ${short(x)} ${short(y)})`;
    for (const group of body.groups) group.setAttribute("transform", matrix);
  }
}

function move(card, passed) {
  card.at += card.way * passed / card.data.seconds;
  if (card.data.loops) {
    card.at %= 1;
  } else if (card.at > 1 || card.at < 0) {
    card.at = card.at > 1 ? Math.max(2 - card.at, 0) : Math.min(-card.at, 1);
    card.way = -card.way;
  }
  place(card);
}

// ---- only what is seen turns
const seen = new Set();
let running = false, before = 0;
let all = !matchMedia("(prefers-reduced-motion: reduce)").matches;

function step(time) {
  const passed = Math.min(Math.max(time - before, 0), 100) / 1000 * Number(byId("speed").value);
  before = time;
  running = false;
  for (const card of seen) {
    if (!card.turning) continue;
    running = true;
    move(card, passed);
  }
  if (running) requestAnimationFrame(step);
}

function start() {
  if (running || ![...seen].some((card) => card.turning)) return;
  running = true;
  before = performance.now();
  requestAnimationFrame(step);
}

const watch = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    const card = byElement.get(entry.target.closest(".card"));
    if (entry.isIntersecting) {
      if (!card.bodies) unpack(card);
      seen.add(card);
    } else {
      seen.delete(card);
    }
  }
  start();
});

function turn(card, turning) {
  card.turning = turning;
  card.picture.setAttribute("aria-pressed", turning);
}

function turnAll(turning) {
  all = turning;
  byId("play").textContent = byId("play").dataset[all ? "stop" : "go"];
  for (const card of cards) if (card.moves) turn(card, all);
  start();
}

for (const card of cards) {
  if (!card.moves) continue;
  watch.observe(card.picture);
  card.picture.addEventListener("click", () => { turn(card, !card.turning); start(); });
}
byId("play").addEventListener("click", () => turnAll(!all));
turnAll(all);

// ---- search
function plain(text) {
  return text.toLowerCase().normalize("NFD").replace(/\p{M}/gu, "").replace(/\u2212/g, "-").replace(/\s+/g, " ").trim();
}

const parts = (text) => text.split(" ").filter(Boolean).map((word) => word.replace(/[\\^$.*+?()[\]{}|/]/g, "\\$&"));
const LETTER = "[\\p{L}\\p{N}_]";
const COMPARED = {"<": (a, b) => a < b, ">": (a, b) => a > b, "<=": (a, b) => a <= b, ">=": (a, b) => a >= b,
  "=": (a, b) => Math.abs(a - b) <= 5e-3 * Math.abs(b)};

// words that a property's name has, perhaps with a number: k > 1.4
function factSought() {
  const text = plain(byId("fact").value);
  const compared = text.match(/^(.*?)\s*(<=|>=|<|>|=)\s*(-?\d+(?:[.,]\d+)?)$/);
  const words = compared ? compared[1] : text;
  if (!words) return () => true;
  // a word of three letters or less is whole, or k would be found in "kinematic"
  const has = parts(words).map((word) => new RegExp(word.length > 3 ? word : `(?<!${LETTER})${word}(?!${LETTER})`, "u"));
  const number = compared && Number(compared[3].replace(",", "."));
  return (card) => card.facts.some((fact) => has.every((word) => word.test(fact.name)) &&
    (!compared || COMPARED[compared[2]](fact.number, number)));
}

const tags = document.querySelectorAll("[data-field]");

function search() {
  // a number is whole: M1 is not M15
  const words = parts(plain(byId("words").value)).map((word) => new RegExp(/\d$/.test(word) ? `${word}(?!\\d)` : word, "u"));
  const fact = factSought();
  const number = byId("number").value, group = byId("group").value, purpose = byId("purpose").value;
  let shown = 0;
  for (const card of cards) {
    const {number: own, groups, purposes} = card.data;
    const found = words.every((word) => word.test(card.text)) && fact(card) && (!number || own === number) &&
      (!group || groups.includes(group)) && (!purpose || purposes.includes(purpose));
    card.element.hidden = !found;
    shown += found;
  }
  for (const tag of tags) tag.setAttribute("aria-pressed", byId(tag.dataset.field).value === tag.dataset.value);
  byId("none").hidden = shown > 0;
  byId("told").textContent = byId("told").dataset.told.replace("#", shown).replace("#", cards.length);
}

byId("search").addEventListener("input", search);
byId("search").addEventListener("submit", (event) => event.preventDefault());
byId("search").addEventListener("reset", () => setTimeout(search));
byId("cards").addEventListener("click", (event) => {
  const {field, value} = event.target.dataset;
  if (!field) return;
  byId(field).value = byId(field).value === value ? "" : value;
  search();
  event.target.closest(".card").scrollIntoView({block: "nearest"});
});
document.addEventListener("keydown", (event) => {
  if (event.key !== "/" || event.ctrlKey || event.altKey || event.metaKey || event.target.matches("input,select")) return;
  event.preventDefault();
  byId("words").focus();
});
search();

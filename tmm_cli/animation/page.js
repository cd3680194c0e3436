
"use strict";
// Every number of the page is in `data`, computed for frames close together; here they are only interpolated and drawn.
const data = JSON.parse(document.getElementById("data").textContent);
const SVG = "http://www.w3.org/2000/svg";
const last = data.driver.values.length - 1;
const state = {at: 0, way: 1, playing: false, before: 0};
const byId = (id) => document.getElementById(id);

function made(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  parent.appendChild(element);
  return element;
}

// A value in the frame where the page is now; what never changes is one number.
function now(values) {
  if (typeof values === "number") return values;
  const k = Math.min(Math.floor(state.at), last - 1), share = state.at - k;
  const one = values[k], next = values[k + 1];
  if (one === null || next === null) return one === null ? next : one;
  return one + share * (next - one);
}

// ---- the mechanism: groups of marks, each moved with its body
const groups = [...document.querySelectorAll("#mechanism [data-body]")];
const names = data.labels.map((label) =>
  made(byId("labels"), "text", {class: label.kind, dy: ".35em"}, label.text));

function drawMechanism() {
  const placed = data.bodies.map((body) => {
    const turn = now(body.turn), stretch = now(body.stretch), c = Math.cos(turn), s = Math.sin(turn);
    return [stretch * c, stretch * s, -s, c, now(body.x), now(body.y)];
  });
  for (const group of groups) group.setAttribute("transform", `matrix(${placed[group.dataset.body]})`);
  data.labels.forEach((label, n) => {
    const [a, b, c, d, x, y] = placed[label.body], [u, v] = label.at;
    names[n].setAttribute("transform", `translate(${a * u + c * v + x} ${b * u + d * v + y})`);
  });
}

// ---- plans of velocities and accelerations
const AIR = 4; // from a point of a plan to its letter
const plans = data.plans.map((plan) => {
  const figure = document.createElement("figure"), svg = made(figure, "svg", {viewBox: plan.view.join(" ")});
  figure.appendChild(document.createElement("figcaption")).textContent = plan.title;
  byId("plans").appendChild(figure);
  const vectors = plan.vectors.map((vector) => made(svg, "path", {
    stroke: vector.colour, fill: vector.colour, "stroke-width": vector.width, "stroke-linejoin": "round"}));
  const letters = plan.letters.map((letter) => made(svg, "text", {dy: ".35em"}, letter.text));
  return {plan, vectors, letters};
});

function arrow(from, to) {
  const x = to[0] - from[0], y = to[1] - from[1], length = Math.hypot(x, y);
  if (length < 0.3) return "";
  const head = Math.min(3.6, 0.6 * length), u = x / length * head, v = y / length * head;
  const neck = [to[0] - u, to[1] - v];
  return `M${from}L${neck}M${to}L${neck[0] - 0.27 * v},${neck[1] + 0.27 * u}L${neck[0] + 0.27 * v},${neck[1] - 0.27 * u}Z`;
}

function drawPlan({plan, vectors, letters}) {
  const points = plan.points.map(([x, y]) => [now(x) * plan.scale, -now(y) * plan.scale]);
  plan.vectors.forEach((vector, n) => vectors[n].setAttribute("d", arrow(points[vector.from], points[vector.to])));
  // a letter that would cover an earlier one is left out; those of hinges come first
  const taken = [];
  plan.letters.forEach((letter, n) => {
    const [x, y] = points[letter.point], far = Math.hypot(x, y);
    const half = 1.1 * letter.text.length, [left, , wide] = plan.view;
    const beside = x + AIR * (far > 1 ? x / far : -0.7), v = y + AIR * (far > 1 ? y / far : -0.7);
    const u = Math.min(Math.max(beside, left + half), left + wide - half);
    const free = taken.every(([a, b, other]) => Math.abs(u - a) > half + other || Math.abs(v - b) > 3.8);
    if (free) taken.push([u, v, half]);
    letters[n].setAttribute("visibility", free ? "visible" : "hidden");
    letters[n].setAttribute("transform", `translate(${u} ${v})`);
  });
}

// ---- diagrams, with a marker that follows
const WIDE = 320, HIGH = 120, LEFT = 46, RIGHT = 8, TOP = 8, BOTTOM = 16;
const COLOURS = ["#1a1a1a", "#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#c77700"];
const across = (frame) => LEFT + (WIDE - LEFT - RIGHT) * frame / last;
const charts = data.charts.map((chart) => {
  const figure = document.createElement("figure"), caption = document.createElement("figcaption");
  figure.appendChild(caption);
  const svg = made(figure, "svg", {viewBox: `0 0 ${WIDE} ${HIGH}`});
  byId("charts").appendChild(figure);
  const every = chart.courses.flatMap((course) => course.values).filter((value) => value !== null);
  let low = Math.min(...every), high = Math.max(...every);
  const reach = high - low;
  if (Math.min(Math.abs(low), Math.abs(high)) <= reach) { // zero is near enough to be shown
    low = Math.min(0, low);
    high = Math.max(0, high);
  }
  const size = high - low || 1;
  const up = (value) => HIGH - BOTTOM - (HIGH - TOP - BOTTOM) * (value - low) / size;
  if (low <= 0 && high >= 0) {
    made(svg, "path", {d: `M${LEFT} ${up(0)}H${WIDE - RIGHT}`, stroke: "#8a8a8a", "stroke-width": 0.7});
  }
  for (const [frame, number] of data.marks) {
    made(svg, "path", {d: `M${across(frame)} ${TOP}V${HIGH - BOTTOM}`, stroke: "#e4e4e4", "stroke-width": 0.7});
    if (data.marks.length <= 24) made(svg, "text", {x: across(frame), y: HIGH - 4, class: "number"}, number);
  }
  const hand = made(svg, "path", {stroke: "#b3261e", "stroke-width": 0.8});
  const dots = chart.courses.map((course, n) => {
    let pen = "M";
    const d = course.values.map((value, k) => {
      if (value === null) { pen = "M"; return ""; }
      const place = `${pen}${across(k).toFixed(2)} ${up(value).toFixed(2)}`;
      pen = "L";
      return place;
    }).join("");
    const colour = COLOURS[n % COLOURS.length];
    made(svg, "path", {d, fill: "none", stroke: colour, "stroke-width": 1.4, "stroke-linejoin": "round"});
    return made(svg, "circle", {r: 3, fill: colour});
  });
  for (const value of [low, high]) {
    if (value !== 0) made(svg, "text", {x: LEFT - 4, y: up(value) + 3, class: "end"}, figures(value));
  }
  const follow = (event) => {
    const box = svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * WIDE;
    pause();
    show(last * (x - LEFT) / (WIDE - LEFT - RIGHT));
  };
  svg.addEventListener("pointerdown", (event) => { svg.setPointerCapture(event.pointerId); follow(event); });
  svg.addEventListener("pointermove", (event) => { if (event.buttons) follow(event); });
  return {chart, caption, hand, dots, up};
});

function figures(value) {
  return value === null ? "–" : written(Number(value.toPrecision(4)).toString());
}

function written(number) {
  return (data.comma ? number.replace(".", ",") : number).replace("-", "−");
}

function drawChart({chart, caption, hand, dots, up}) {
  const x = across(state.at), told = [];
  hand.setAttribute("d", `M${x} ${TOP}V${HIGH - BOTTOM}`);
  chart.courses.forEach((course, n) => {
    const value = now(course.values);
    dots[n].setAttribute("visibility", value === null ? "hidden" : "visible");
    if (value !== null) dots[n].setAttribute("transform", `translate(${x} ${up(value)})`);
    told.push((course.name ? course.name + " = " : "") + figures(value));
  });
  caption.textContent = `${chart.title}: ${told.join("; ")}`;
}

// ---- where the page is
function show(at) {
  state.at = Math.min(Math.max(at, 0), last);
  drawMechanism();
  plans.forEach(drawPlan);
  charts.forEach(drawChart);
  byId("at").value = state.at;
  const driver = data.driver, value = now(driver.values);
  const place = driver.turn ? ((value % driver.turn) + driver.turn) % driver.turn : value;
  byId("place").textContent = `${driver.name} = ${written(place.toFixed(1))} ${driver.unit}`.replace(" °", "°");
}

function step(time) {
  if (!state.playing) return;
  const passed = Math.min(time - state.before, 100) / 1000 * Number(byId("speed").value);
  state.before = time;
  let at = state.at + state.way * passed / data.seconds * last;
  if (data.loops) {
    at = at % last;
  } else if (at > last || at < 0) {
    state.way = -state.way;
    at = at > last ? 2 * last - at : -at;
  }
  show(at);
  requestAnimationFrame(step);
}

function play() {
  state.playing = true;
  state.before = performance.now();
  byId("play").textContent = "❚❚";
  requestAnimationFrame(step);
}

function pause() {
  state.playing = false;
  byId("play").textContent = "▶";
}

function toggle() {
  if (state.playing) pause(); else play();
}

function jump(by) {
  pause();
  const at = Math.round(state.at) + by;
  show(data.loops ? (at + last) % last : at);
}

function faster(by) {
  const speed = byId("speed");
  speed.selectedIndex = Math.min(Math.max(speed.selectedIndex + by, 0), speed.options.length - 1);
}

const KEYS = {
  " ": toggle, ArrowLeft: () => jump(-1), ArrowRight: () => jump(1), ArrowUp: () => faster(1),
  ArrowDown: () => faster(-1), Home: () => { pause(); show(0); }, End: () => { pause(); show(last); },
};
document.addEventListener("keydown", (event) => {
  if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  KEYS[event.key]();
});
byId("play").addEventListener("click", toggle);
byId("at").max = last;
byId("at").addEventListener("input", (event) => { pause(); show(Number(event.target.value)); });
byId("ways").addEventListener("change", (event) => {
  byId("paths").setAttribute("visibility", event.target.checked ? "visible" : "hidden");
});
show(0);

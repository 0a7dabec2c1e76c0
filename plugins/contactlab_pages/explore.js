/* The page: what one sets, the moving picture, and the words. */

const $ = id => document.getElementById(id);
const SLIDERS = {...RANGES, guess: [-85, 89]};
const SHOW = 7000;             // length of the whole show in ms
const ARRIVAL = .22, DEPARTURE = .74; // parts of the show at which contact begins and ends
const SIZE = 30, MIDDLE = 250, FLOOR = 262; // a radius, and the point of contact, in the picture
const ARROW_FROM = .15;        // least force that has an arrow, over friction's largest
const TIP_AT = 6;              // of the prediction's line, in radii from the ball at rest
const NEAR = 2;                // centre of a ball that is pulled to no speed, from its place of contact, in radii
const SIDEWAYS = (MIDDLE - SIZE - 6) / SIZE, UPWARDS = (FLOOR - 2 * SIZE - 6) / SIZE; // where the ball meets the edges
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

const minus = (value, digits) => (+value.toFixed(digits) + 0).toFixed(digits).replace("-", "\u2212");
const LISTS = ["material", "block"];
const LAWS = [["exact", "elastic"], ["spring", "capped spring"], ["rigid", "rigid"]];
const nameOf = law => (law === "exact" && state.restitution < 1 ? "viscoelastic" : Object.fromEntries(LAWS)[law]);
const turns = spin => spin / (2 * Math.PI);
const spinWords = spin => (Math.abs(spin) < .5 ? "none" : `${spin > 0 ? "back" : "top"}spin ${Math.abs(spin).toFixed(0)} rad/s, ${Math.abs(turns(spin)).toFixed(1)} turns/s`);
const WORDS = {
  angle: value => `${value}\u00b0`, speed: value => `${value.toFixed(1)} m/s`, spin: spinWords, friction: value => value.toFixed(2),
  guess: value => `${minus(value, 0)}\u00b0`, radius: value => `${(1000 * value).toFixed(0)} mm`, restitution: value => value.toFixed(2),
  inertia: value => `${value.toFixed(2)}, ${value < .4 ? "dense core" : value > .4 ? value < .66 ? "hollow" : "thin shell" : "solid"}`,
};

let state = {...FIRST}, found, curves = [], moment = 0, playing = 0, seen = false;
let from = 1;                  // the side from which the ball is thrown: 1 left, -1 right

/* ---- state in the link ---- */
function fromLink() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const [key, first] of Object.entries(FIRST)) {
    if (!given.has(key)) continue;
    const text = given.get(key);
    if (typeof first === "number") {
      const [least, most] = SLIDERS[key], number = Number(text);
      if (text !== "" && Number.isFinite(number)) state[key] = Math.min(Math.max(number, least), most);
    } else if (typeof first === "boolean") state[key] = text === "1";
    else if (text in MATERIALS) state[key] = text;
  }
}
function linkTo(set) {
  const parts = Object.entries(set).filter(([key, value]) => value !== FIRST[key]);
  return "#" + new URLSearchParams(parts.map(([key, value]) => [key, value === true ? "1" : value === false ? "0" : value]));
}
function toLink() {
  try { history.replaceState(null, "", linkTo(state)); } catch { /* a viewer without links */ }
}

/* ---- drawing ---- */
const path = (xs, ys) => xs.map((x, k) => (k ? "L" : "M") + x.toFixed(1) + " " + ys[k].toFixed(1)).join("");
const line = (x1, y1, x2, y2, kind) => `<line class="${kind}" x1="${x1.toFixed(1)}" y1="${y1.toFixed(1)}" x2="${x2.toFixed(1)}" y2="${y2.toFixed(1)}"/>`;
const text = (x, y, what, anchor, kind) => `<text class="${kind || ""}" x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor || "middle"}">${what}</text>`;

const place = x => MIDDLE + from * SIZE * x, height = y => FLOOR - SIZE * y;
/* Return how far the ball may go along (dx, dy) before it meets the edge of the picture, in lengths of (dx, dy). */
const room = (dx, dy) => Math.min(SIDEWAYS / Math.max(Math.abs(dx), 1e-9), UPWARDS / Math.max(dy, 1e-9));
/* The ball starts the farther away, the faster it is: from NEAR to the edge of the picture. */
function distance() {
  const a = state.angle * Math.PI / 180;
  return NEAR + (room(Math.sin(a), Math.cos(a)) - NEAR) * state.speed / $("speed").max;
}

/* Return angle and speed of a ball that is held at a point of the picture, at either side. */
function aimed(point) {
  const aside = Math.abs(MIDDLE - point.x) / SIZE, up = (FLOOR - point.y) / SIZE - 1, far = Math.hypot(aside, up);
  const pulled = Math.min(Math.max((far - NEAR) / (room(aside / far, up / far) - NEAR), 0), 1);
  const angle = Math.min(Math.round(Math.atan2(aside, up) * 180 / Math.PI), +$("angle").max);
  from = point.x > MIDDLE ? -1 : 1;
  return {angle, speed: Math.max(Math.round(10 * $("speed").max * pulled) / 10, +$("speed").min)};
}

/* Return the time of flight that is shown after the contact: until the first ball meets the edge of the picture. */
const flight = () => Math.min(...LAWS.map(([law]) => room(found[law].along, found[law].normal)));

/* Return each ball's centre in radii from the point of contact, and its turn in rad. */
function balls() {
  const {met} = found, before = Math.min(moment / ARRIVAL, 1), after = Math.max((moment - DEPARTURE) / (1 - DEPARTURE), 0);
  const inside = Math.min(Math.max((moment - ARRIVAL) / (DEPARTURE - ARRIVAL), 0), 1);
  const reach = distance() / state.speed, touching = found.duration / met.R, deepest = Math.max(...found.contact.radius);
  return Object.fromEntries(LAWS.map(([law]) => {
    const left = found[law], away = after * flight(), come = (before - 1) * reach;
    return [law, {
      x: met.along * come + (met.along + left.along) / 2 * touching * inside + left.along * away,
      y: 1 - met.normal * come + left.normal * away - (met.C * deepest) ** 2 * Math.sin(Math.PI * inside),
      turn: from * met.R * (state.spin * come + left.spin * away),
    }];
  }));
}

/* Return an arrow along a path whose end points the way (dx, dy). */
function arrow(shape, x, y, dx, dy, kind) {
  const [a, b] = [9 * dx / Math.hypot(dx, dy), 9 * dy / Math.hypot(dx, dy)];
  const head = `M${x - a + b / 2} ${y - b - a / 2}L${x} ${y}L${x - a - b / 2} ${y - b + a / 2}`;
  return `<path class="${kind}" d="${shape}${head}"/>`;
}

/* Return what is drawn around a ball that waits: where it is thrown, and how it spins. */
function aim([x, y]) {
  const {met} = found, along = from * met.along / state.speed, normal = met.normal / state.speed, r = SIZE + 9;
  const far = r + 10 + 40 * state.speed / $("speed").max;
  const [tipX, tipY] = [x + far * along, y + far * normal];
  let svg = arrow(`M${x + r * along} ${y + r * normal}L${tipX} ${tipY}`, tipX, tipY, along, normal, "aim");
  if (state.spin) { // an arc at the side from which it comes, turning as the ball does
    const way = from * Math.sign(state.spin), first = Math.atan2(-normal, -along) + .6 * way, to = first - 1.2 * way;
    const [endX, endY] = [x + r * Math.cos(to), y + r * Math.sin(to)];
    const arc = `M${x + r * Math.cos(first)} ${y + r * Math.sin(first)}A${r} ${r} 0 0 ${way > 0 ? 0 : 1} ${endX} ${endY}`;
    svg += arrow(arc, endX, endY, way * Math.sin(to), -way * Math.cos(to), "aim");
  }
  return svg;
}

function drawStage() {
  const [x, y] = [place, height], {met, exact} = found, drawn = balls(), come = distance() / state.speed;
  let svg = `<rect class="ground" x="0" y="${y(0)}" width="500" height="40"/>`;
  svg += line(x(0), y(1), x(0), y(6), "rule");
  svg += line(x(-met.along * come), y(1 + met.normal * come), x(0), y(1), "rule");
  if (seen) svg += line(x(0), y(1), x(exact.along * flight()), y(1 + exact.normal * flight()), "rule");
  const marks = moment > DEPARTURE ? LAWS.slice().reverse() : LAWS.slice(0, 1);
  for (const [law] of marks) {
    const ball = drawn[law], c = [x(ball.x), y(ball.y)];
    const spoke = k => { const a = -ball.turn + k * Math.PI / 2; return line(c[0], c[1], c[0] + .93 * SIZE * Math.cos(a), c[1] + .93 * SIZE * Math.sin(a), law); };
    svg += `<g data-law="${law}"><circle class="${law} ${law === "exact" ? "ball" : "ghost"}" cx="${c[0].toFixed(2)}" cy="${c[1].toFixed(2)}" r="${SIZE}"/>`;
    svg += (law === "exact" ? [0, 1, 2, 3] : [0]).map(spoke).join("") + "</g>";
    if (law === "exact") {
      if (moment === 0) svg += aim(c);
      svg += `<circle class="grip touch" data-grip="ball" cx="${c[0].toFixed(2)}" cy="${c[1].toFixed(2)}" r="${1.3 * SIZE}"/>`;
    }
  }
  if (state.predict) { // over the ball, so that both can be held
    const a = state.guess * Math.PI / 180, [tipX, tipY] = [x(TIP_AT * Math.sin(a)), y(1 + TIP_AT * Math.cos(a))], left = from * a < 0;
    svg += line(x(0), y(1), tipX, tipY, "guess") + `<g class="grip" data-grip="guess"><circle class="knob" cx="${tipX}" cy="${tipY}" r="8"/>`;
    svg += `<circle class="touch" cx="${tipX}" cy="${tipY}" r="26"/></g>` + text(tipX + (left ? -13 : 13), tipY + 6, "you", left ? "end" : "start");
  }
  const inside = (moment - ARRIVAL) / (DEPARTURE - ARRIVAL);
  const clock = moment === 0 ? `${state.angle}\u00b0, ${state.speed.toFixed(1)} m/s` : inside < 0 ? "arrives" : inside > 1 ? "leaves" : `in contact: ${seconds(inside * found.duration)} of ${seconds(found.duration)}`;
  svg += text(12, 24, clock, "start");
  const side = from * exact.angle < 0 ? [488, "end"] : [12, "start"]; // where no ball is
  if (moment > DEPARTURE) svg += text(side[0], 48, nameOf("exact"), side[1], "named-exact") + text(side[0], 70, "ghost: capped spring", side[1], "named-spring") + text(side[0], 92, "ghost: rigid", side[1], "named-rigid");
  $("stage").innerHTML = svg;
}

function seconds(value) {
  for (const [factor, unit] of [[1, "s"], [1e3, "ms"], [1e6, "\u00b5s"]]) if (value * factor >= 1) return `${(value * factor).toPrecision(3)} ${unit}`;
  return `${(value * 1e6).toFixed(1)} \u00b5s`;
}

const row = () => {
  const inside = Math.min(Math.max((moment - ARRIVAL) / (DEPARTURE - ARRIVAL), 0), 1), times = found.contact.time;
  let low = 0, high = times.length - 1;
  while (high - low > 1) { const middle = (low + high) >> 1; if (times[middle] <= inside) low = middle; else high = middle; }
  return inside >= 1 ? high : low;
};

/* Return the rings of equal state from the rim inwards: outer radius over a, and state. */
function rings(states) {
  const list = [];
  for (let i = states.length - 1; i >= 0; i--) if (states[i] && states[i] !== (list.at(-1) || {}).state) list.push({outer: (i + 1) / states.length, state: states[i]});
  return list;
}

/* Return the step of the contact that is shown: that of the moment, or after the throw one at which it sticks in part. */
function shownStep() {
  if (moment > ARRIVAL && moment <= DEPARTURE) return row();
  if (!seen) return 0;
  const parted = found.contact.states.map((states, k) => [k + 1, rings(states).length]).filter(([, count]) => count > 1);
  return parted.length ? parted[parted.length >> 1][0] : found.contact.time.length >> 1;
}

function drawContact() {
  const colours = ["", "var(--grey)", "var(--blue)", "var(--red)"], {met, contact, duration} = found, k = shownStep();
  const list = k ? rings(contact.states[k - 1]) : []; // the springs of each step
  const size = 104, cx = 125, cy = 112;
  let svg = `<circle class="rule" fill="none" cx="${cx}" cy="${cy}" r="${size}"/>`;
  for (const ring of list) svg += `<circle cx="${cx}" cy="${cy}" r="${(size * ring.outer).toFixed(2)}" fill="${colours[ring.state]}" data-state="${ring.state}"/>`;
  const share = contact.force[k];
  if (list.length && Math.abs(share) > ARROW_FROM) {
    const tip = cx - 90 * from * share, back = tip + 10 * from * Math.sign(share);
    svg += `<path d="M${cx} ${cy}H${tip}M${back} ${cy - 6}L${tip} ${cy}L${back} ${cy + 6}" stroke="var(--ink)" stroke-width="2.5" fill="none"/>`;
  }
  if (!list.length) svg += [`${(2000 * met.C * met.R).toPrecision(2)} mm wide,`, `for ${seconds(duration)}`].map((words, line) => text(cx, cy - 4 + 24 * line, words)).join("");
  let words = !list.length ? "before the contact" : !list.some(ring => ring.state === 1) ? "slips all over" : list.length === 1 ? "sticks"
    : list.at(-1).state === 1 ? "slips at the rim, sticks within" : "sticks in a ring";
  if (moment > DEPARTURE) words = seen ? `at ${Math.round(100 * contact.time[k])} % of the contact: ${words}` : "after the contact";
  $("contact").innerHTML = svg; $("state").textContent = words;
  $("contact").setAttribute("aria-label", `the contact from above: ${words}`);
}

function frame(left, right, top, bottom, xs, ys, toX, toY, name) {
  let svg = line(left, bottom, right, bottom, "axis") + line(left, top, left, bottom, "axis");
  for (const value of xs) svg += line(toX(value), bottom, toX(value), bottom + 5, "axis") + text(toX(value), bottom + 21, value);
  for (const value of ys) svg += line(left - 5, toY(value), left, toY(value), "axis") + text(left - 8, toY(value) + 6, String(value).replace("-", "\u2212"), "end");
  return svg + line(left, toY(0), right, toY(0), "rule") + text((left + right) / 2, bottom + 41, name);
}

function drawForce() {
  const left = 40, right = 392, top = 8, bottom = 212, {contact, capped} = found, k = row();
  const x = t => left + (right - left) * t, y = f => (top + bottom) / 2 - (bottom - top) / 2.1 * f;
  let svg = frame(left, right, top, bottom, [0, .5, 1], [-1, 0, 1], x, y, "time over duration");
  for (const sign of [1, -1]) svg += `<path class="limit" d="${path(contact.time.map(x), contact.limit.map(f => y(sign * f)))}"/>`;
  if (seen) svg += `<path class="curve spring" d="${path(capped.time.map(x), capped.force.map(y))}"/>`;
  const shown = seen ? contact.time.length : k + 1;
  svg += `<path class="curve exact" d="${path(contact.time.slice(0, shown).map(x), contact.force.slice(0, shown).map(y))}"/>`;
  svg += `<circle cx="${x(contact.time[k]).toFixed(1)}" cy="${y(contact.force[k]).toFixed(1)}" r="6" fill="var(--blue)" stroke="var(--paper)" stroke-width="2"/>`;
  $("force").innerHTML = svg;
  $("force").setAttribute("aria-label", `tangential force over friction's largest: ${minus(contact.force[k], 2)}, friction's limit ${minus(contact.limit[k], 2)}`);
}

function drawRebound() {
  if (seen && !curves.length) curves = rebounds(state); // not while one drags: it takes a frame
  const left = 52, right = 392, top = 8, bottom = 212, low = Math.min(-20, ...curves.map(r => Math.min(r[1], r[2]))) - 2;
  const x = a => left + (right - left) * a / 86, y = a => bottom - (bottom - top) * (a - low) / (88 - low);
  let svg = frame(left, right, top, bottom, [0, 30, 60], [-30, 0, 30, 60].filter(a => a > low), x, y, "angle of incidence (\u00b0)");
  if (seen) LAWS.forEach(([law], k) => { svg += `<path class="curve ${law}" d="${path(curves.map(r => x(r[0])), curves.map(r => y(r[k + 1])))}"/>`; });
  if (seen) svg += `<circle cx="${x(state.angle)}" cy="${y(found.exact.angle)}" r="6" fill="var(--blue)" stroke="var(--paper)" stroke-width="2"/>`;
  svg += text(left + 8, top + 14, "rebound angle (\u00b0)", "start") + text(left + 8, top + 36, nameOf("exact"), "start", "named-exact") + text(left + 8, top + 58, "capped spring", "start", "named-spring") + text(left + 8, top + 80, "rigid", "start", "named-rigid");
  $("rebound").innerHTML = svg;
  $("rebound").setAttribute("aria-label", `rebound angle over angle of incidence${seen ? `; at ${state.angle}\u00b0 the ball leaves at ${minus(found.exact.angle, 1)}\u00b0` : ", empty before the throw"}`);
}

/* ---- words ---- */
function answer() {
  const {exact, rigid, spring} = found, angle = `${minus(exact.angle, 1)}\u00b0`;
  const way = exact.speed < 1e-9 ? "nowhere" : Math.abs(exact.angle) < .05 ? "straight up" : `${exact.angle < 0 ? "back the way it came, at" : "on at"} ${angle}`;
  let words = `It goes ${way} with ${spinWords(exact.spin).replace("none", "no spin").replace(/, (.*)/, " ($1)")}; a rigid ball at ${minus(rigid.angle, 1)}\u00b0, the capped spring at ${minus(spring.angle, 1)}\u00b0.`;
  if (state.predict) {
    const off = Math.abs(exact.angle - state.guess);
    words = `You said ${minus(state.guess, 0)}\u00b0: ${off.toFixed(1)}\u00b0 off, ${points(off)} points. ` + words;
  }
  return words;
}
function cautions() {
  const {met, exact} = found, list = [];
  if (met.C > LARGE_CONTACT) list.push(`the contact is ${met.C.toFixed(2)} of the radius, not small: Hertz's theory is doubtful`);
  if (met.pressure > met.yields) list.push(`the pressure reaches ${(met.pressure / 1e9).toPrecision(2)} GPa, above ${(met.yields / 1e9).toPrecision(2)} GPa the softer body yields`);
  if (met.coupling) list.push(`the pressure of unlike materials also shears the surfaces, which is left out (\u039b = ${met.coupling.toPrecision(2)})`);
  if (state.restitution < 1 && exact.psi2 > met.psi1 - 2 * met.chi * (1 + state.restitution) + 1e-9) {
    list.push(`pressure and shear are taken to lose alike: over eight measured balls the tangential restitution is off by ${SHEAR_ERROR} (rms)`);
  }
  return list.length ? `Caution: ${list.join("; ")}.` : "";
}

/* ---- what happens when ---- */
function showMoment() {
  $("time").value = Math.round(1000 * moment);
  const inside = (moment - ARRIVAL) / (DEPARTURE - ARRIVAL);
  $("time").setAttribute("aria-valuetext", inside < 0 ? "arrives" : inside > 1 ? "leaves" : `in contact, ${Math.round(100 * inside)} % of its duration`);
  drawStage(); drawContact(); drawForce();
}
/* Show the answer, or the places for it before the throw. */
function showAnswer() {
  const hint = state.predict ? "Turn the dotted line to where you say it goes. Then throw." : "Drag the ball to either side, and let go. The farther the faster, up to 10 m/s at the edge of the picture.";
  const told = seen ? answer() : playing ? "" : hint, shown = (value, digits) => (seen ? minus(value, digits) : "\u2013");
  $("said").textContent = told;
  $("answers").innerHTML = LAWS.map(([law], k) => { const one = found[law];
    return `<tr class="${k ? "" : "first"}"><th scope="row">${nameOf(law)}</th><td>${shown(one.angle, 1)}${seen ? "\u00b0" : ""}</td><td>${shown(one.spin, 0)}</td><td>${shown(turns(one.spin), 1)}</td></tr>`; }).join("");
  $("stage").setAttribute("aria-label", `${seen ? told : "the ball before the throw"} Arrow keys aim it, Space throws.`);
  $("psi1").textContent = minus(found.met.psi1, 3); $("chi").textContent = found.met.chi.toFixed(3);
  for (const [id, law] of [["psi2", "exact"], ["psi2-spring", "spring"], ["psi2-rigid", "rigid"]]) $(id).textContent = shown(found[law].psi2, 3);
  $("throw").textContent = playing ? "Skip" : !seen ? "Throw" : state.predict ? "Next ball" : "Throw again";
  $("score").textContent = scoreWords();
  drawRebound();
}
function changed() {
  cancelAnimationFrame(playing); playing = 0;
  found = thrown(state); curves = [];
  seen = false; moment = 0;
  for (const [key, words] of Object.entries(WORDS)) {
    $(key).value = state[key]; $(`${key}-shown`).textContent = words(state[key]); $(key).setAttribute("aria-valuetext", words(state[key]));
  }
  for (const key of LISTS) $(key).value = state[key];
  $("predict").checked = state.predict;
  for (const part of document.querySelectorAll(".guessing")) part.hidden = !state.predict;
  $("caution").textContent = cautions();
  showMoment(); showAnswer(); toLink();
}
function finish() {
  if (!seen && state.predict) scored(state, Math.abs(found.exact.angle - state.guess));
  cancelAnimationFrame(playing); playing = 0; moment = 1; seen = true; showMoment(); showAnswer();
}
function play() {
  if (seen && state.predict && !playing) { state = byChance(state); changed(); return; }
  if (playing || calm) { finish(); return; }
  let started;
  const step = now => {
    started ??= now; moment = (now - started) / SHOW;
    if (moment >= 1) { finish(); return; }
    showMoment(); playing = requestAnimationFrame(step);
  };
  moment = 0; playing = requestAnimationFrame(step); showMoment(); showAnswer();
}

/* ---- the ball, and the tip of the prediction, by mouse or finger ---- */
/* Let what is marked as a grip in a picture be dragged: moving(grip, point) on the way, released(grip, moved) at the end. */
function draggable(picture, moving, released) {
  let held, start;
  picture.addEventListener("pointerdown", event => {
    const grip = event.target.closest("[data-grip]")?.dataset.grip;
    if (!grip || !event.isPrimary) return;
    document.documentElement.dataset.by = "pointer"; // no frame of the keyboard's focus
    [held, start] = [grip, event]; picture.setPointerCapture(event.pointerId); event.preventDefault(); picture.focus({preventScroll: true});
  });
  picture.addEventListener("pointermove", event => {
    if (!held || start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 4) return;
    start = null; // it moves: no click
    moving(held, new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse()));
  });
  picture.addEventListener("pointerup", () => { const grip = held; held = null; if (grip) released(grip, !start); });
  picture.addEventListener("pointercancel", () => { held = null; });
  picture.addEventListener("touchstart", event => { if (event.target.closest("[data-grip]")) event.preventDefault(); }, {passive: false});
}
const stage = $("stage");
draggable(stage, (grip, point) => {
  const turned = Math.round(Math.atan2(from * (point.x - MIDDLE), FLOOR - SIZE - point.y) * 180 / Math.PI), [least, most] = SLIDERS.guess;
  Object.assign(state, grip === "ball" ? aimed(point) : {guess: Math.min(Math.max(turned, least), most)});
  changed();
}, (grip, moved) => { if (grip === "ball" && !(state.predict && moved)) play(); });
const KEYS = {ArrowLeft: ["angle", 1], ArrowRight: ["angle", -1], ArrowUp: ["speed", 1], ArrowDown: ["speed", -1]};
stage.addEventListener("keydown", event => {
  if (!(event.key in KEYS)) return;
  const [key, way] = KEYS[event.key];
  $(key).stepUp(key === "angle" ? from * way : way); state[key] = +$(key).value; changed(); event.preventDefault();
});
addEventListener("keydown", () => { delete document.documentElement.dataset.by; }, true);
addEventListener("keydown", event => { // what has a use of its own for the key keeps it
  if (event.key !== " " || event.target.closest("button, select, summary, [type=checkbox]")) return;
  event.preventDefault();
  if (!event.repeat) play();
});

for (const key of LISTS) {
  for (const name of Object.keys(MATERIALS)) $(key).append(new Option(name, name));
  $(key).addEventListener("change", () => { state[key] = $(key).value; changed(); });
}
for (const [key, [least, most]] of Object.entries(SLIDERS)) {
  [$(key).min, $(key).max] = [least, most];
  $(key).addEventListener("input", () => { state[key] = Number($(key).value); changed(); });
}
$("predict").addEventListener("change", () => { state.predict = $("predict").checked; changed(); });
$("throw").addEventListener("click", play);
$("set").addEventListener("submit", event => event.preventDefault());
$("time").addEventListener("input", () => {
  cancelAnimationFrame(playing); playing = 0; moment = $("time").value / 1000;
  if (moment === 1) finish(); else { showMoment(); showAnswer(); }
});
function begin() {
  fromLink(); changed();
  if (state.block || ["radius", "inertia", "restitution"].some(key => state[key] !== FIRST[key])) $("more").open = true;
}
addEventListener("hashchange", () => { state = {...FIRST}; from = 1; begin(); scrollTo(0, 0); });
begin(); writeSheet();
$("print").addEventListener("click", () => print());
addEventListener("beforeprint", () => { $("answered").open ||= $("sheet").open; }); // the answers, on a page of their own

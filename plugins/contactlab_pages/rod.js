/* A steel rod that falls on its end: what one sets is its tilt, and a table of Python tells how it leaves. */

const HALF = .48, TIP = .02, METRE = 200, AFTER = .12, BEFORE = .12; // m, m, px of a metre, s after and before the touch
const FALL = 2500;                    // ms of the show
const TOUCH = [250, 262];             // of the end, in the picture
const ARROW = 90;                     // px of 1 m/s
const RODS = [["exact", "elastic"], ["rigid", "rigid"]];
let tilt = 30, kept = 0, dropped = false, falling = 0; // kept: the place of the restitution

/* Return how a rod leaves at a tilt in degrees: velocities of its centre and of its end in m/s, spin in rad/s. */
function rodAfter(law, degrees) {
  const [along, up, spin] = ROD[kept][RODS.findIndex(([name]) => name === law)][degrees], a = degrees * Math.PI / 180;
  return {along, up, spin, slip: along - spin * (HALF * Math.cos(a) + TIP), rebound: up + spin * HALF * Math.sin(a)};
}

/* Return a rod some seconds after the touch, its axis in the picture. */
function rodAt(law, time) {
  const left = time > 0 ? rodAfter(law, tilt) : {along: 0, up: -1, spin: 0}, a = tilt * Math.PI / 180;
  const x = HALF * Math.sin(a) + left.along * time, y = HALF * Math.cos(a) + TIP + left.up * time, turned = a + left.spin * time;
  const ends = [-1, 1].map(sign => [TOUCH[0] + METRE * (x + sign * HALF * Math.sin(turned)), TOUCH[1] - METRE * (y + sign * HALF * Math.cos(turned))]);
  return `<path class="rod ${law}" data-rod="${law}" d="M${ends.map(end => end.map(each => each.toFixed(2)).join(" ")).join("L")}"/>`;
}

/* Return the name of the rod that is not rigid. */
const rodName = () => BOUNCES[kept] < 1 ? "viscoelastic" : "elastic";

function drawRod(time) {
  const a = tilt * Math.PI / 180, reach = (2 * HALF + TIP) * METRE, grip = [TOUCH[0] + reach * Math.sin(a), TOUCH[1] - reach * Math.cos(a)];
  let svg = `<rect class="ground" x="0" y="${TOUCH[1]}" width="500" height="40"/>` + line(TOUCH[0], TOUCH[1], TOUCH[0], 20, "rule");
  if (time > 0) for (const [law] of RODS.slice().reverse()) {
    const {slip, rebound} = rodAfter(law, tilt), tip = [TOUCH[0] + ARROW * slip, TOUCH[1] - ARROW * rebound];
    svg += rodAt(law, time) + arrow(`M${TOUCH[0]} ${TOUCH[1]}L${tip[0]} ${tip[1]}`, ...tip, slip, -rebound, `curve ${law}`);
  } else svg += rodAt("exact", time);
  if (!falling) svg += `<circle class="grip touch" data-grip="rod" cx="${grip[0].toFixed(1)}" cy="${grip[1].toFixed(1)}" r="36"/>`;
  svg += text(12, 24, `tilt ${tilt}\u00b0, falls at 1 m/s`, "start");
  if (time > 0) svg += text(12, 48, rodName(), "start", "named-exact") + text(12, 70, "rigid", "start", "named-rigid");
  $("rod").innerHTML = svg;
}

function drawEnds() {
  const left = 52, right = 392, top = 8, bottom = 212, x = a => left + (right - left) * a / 75, y = v => (top + bottom) / 2 - (bottom - top) / 2.1 * v;
  let svg = frame(left, right, top, bottom, [0, 30, 60], [-1, 0, 1], x, y, "tilt (\u00b0)");
  for (const [law] of dropped ? RODS.slice().reverse() : []) {
    const all = ROD[kept][0].map((_, degrees) => rodAfter(law, degrees)), now = all[tilt];
    for (const what of ["rebound", "slip"]) {
      svg += `<path class="curve ${law}" d="${path(all.map((_, a) => x(a)), all.map(each => y(each[what])))}"/>`;
      svg += `<circle class="${law}" cx="${x(tilt).toFixed(1)}" cy="${y(now[what]).toFixed(1)}" r="5" fill="var(--paper)" stroke-width="2"/>`;
    }
  }
  $("ends").innerHTML = svg + text(right, y(.68), "rebound (m/s)", "end") + text(left + 10, y(-.75), "slip (m/s)", "start");
}

/* Show the rod before it falls, or where it is, and after that the numbers. */
function showRod() {
  $("tilt").value = tilt; $("tilt-shown").textContent = `${tilt}\u00b0`;
  $("kept").value = BOUNCES.length - 1 - kept; $("kept-shown").textContent = BOUNCES[kept];
  $("rod-answers").innerHTML = RODS.map(([law, name], k) => { const left = rodAfter(law, tilt);
    return `<tr class="${k ? "" : "first"}"><th scope="row">${k ? name : rodName()}</th>${[left.rebound, left.slip, left.spin].map(each => `<td>${dropped ? minus(each, 2) : "\u2013"}</td>`).join("")}</tr>`; }).join("");
  $("drop").textContent = dropped ? "Drop again" : "Drop";
  drawRod(dropped ? AFTER : -BEFORE); drawEnds();
}
function tiltTo(degrees) { cancelAnimationFrame(falling); falling = 0; tilt = degrees; dropped = false; showRod(); }
function keepTo(place) { kept = place; tiltTo(tilt); }
function landed() { cancelAnimationFrame(falling); falling = 0; dropped = true; showRod(); }
function drop() {
  if (falling || calm) { landed(); return; }
  dropped = false; showRod(); $("drop").textContent = "Skip";
  let started;
  const step = now => {
    started ??= now; const time = (now - started) / FALL * (BEFORE + AFTER) - BEFORE;
    if (time >= AFTER) { landed(); return; }
    drawRod(time); falling = requestAnimationFrame(step);
  };
  falling = requestAnimationFrame(step);
}

$("tilt").max = ROD[0][0].length - 1;
$("kept").max = BOUNCES.length - 1;
$("kept").addEventListener("input", () => keepTo(BOUNCES.length - 1 - Number($("kept").value)));
$("tilt").addEventListener("input", () => tiltTo(Number($("tilt").value)));
$("drop").addEventListener("click", drop);
draggable($("rod"), (grip, point) => {
  const lean = Math.round(Math.atan2(point.x - TOUCH[0], TOUCH[1] - point.y) * 180 / Math.PI);
  tiltTo(Math.min(Math.max(lean, 0), ROD[0][0].length - 1));
}, drop);
showRod();

/**
 * A ball in a game: it flies, bounces, rolls and comes to rest; a loop of frames, 60 a second.
 *
 *     node examples/recipes/bouncing_ball.mjs superball
 *
 * In a project of your own: npm install path/to/contactlab/kernels, and import {BALLS, bounce} from "contactlab".
 */
import {pathToFileURL} from "node:url";
import {BALLS, bounce} from "../../contactlab/kernels/contactlab_bounce.mjs";

const FRAME = 1 / 60, FLOOR = {}, DOWN = [0, 0, -1];  // the floor z = 0, of the ball's material
const ROLLING = 0.03;  // resistance over weight of what rolls or turns on its spot; ours

/** Moves a ball by one frame. A hop that takes less than a frame is no bounce any more: the ball stays on the floor. */
export function frame(ball, gravity = 9.81) {
  const {radius} = ball.body;
  for (let left = FRAME; left > 0;) {
    const {position: x, velocity: v} = ball, height = Math.max(x[2] - radius, 0);
    if (height === 0 && v[2] === 0) return roll(ball, gravity, left);
    const root = Math.sqrt(v[2] ** 2 + 2 * gravity * height);
    const lands = v[2] > 0 ? (v[2] + root) / gravity : 2 * height / (root - v[2]), time = Math.min(lands, left);
    left -= time;
    x[0] += time * v[0];
    x[1] += time * v[1];
    x[2] += time * (v[2] - gravity * time / 2);
    v[2] -= gravity * time;
    if (time < lands) continue;
    x[2] = radius;
    const {velocity, spin} = bounce(ball.body, FLOOR, ball.contact, DOWN, v, ball.spin);
    Object.assign(ball, {velocity, spin});
    if (velocity[2] < gravity * FRAME / 2) velocity[2] = 0;
  }
}

/** Moves a ball on the floor: friction ends its slip, then it rolls until rolling resistance ends that. */
function roll({body, contact, position: x, velocity: v, spin: w}, gravity, time) {
  const {radius, gyration_ratio: ratio = Math.sqrt(0.4)} = body, ease = 1 / ratio ** 2;
  const slip = [v[0] - radius * w[1], v[1] + radius * w[0]], speed = Math.hypot(...slip);
  const slides = speed > 0 ? Math.min(speed / (contact.friction * gravity * (1 + ease)), time) : 0;
  for (const k of [0, 1]) {
    const change = slides > 0 ? -contact.friction * gravity * slides * slip[k] / speed : 0;
    x[k] += slides * (v[k] + change / 2);
    v[k] += change;
    w[1 - k] += (k ? 1 : -1) * ease / radius * change;
  }
  const rolls = Math.hypot(v[0], v[1]), brake = ROLLING * gravity, most = rolls / brake;
  const left = Math.max(1 - (time - slides) / most, 0) || 0, mean = Math.min(time - slides, most) * (1 + left) / 2;
  for (const k of [0, 1]) {
    x[k] += mean * v[k];
    v[k] *= left;
    if (slides < time) w[k] *= left;
  }
  w[2] -= Math.sign(w[2]) * Math.min(Math.abs(w[2]), 2.5 * brake / radius * time);
}

/** Returns whether a ball is at rest. */
export const rests = ({velocity, spin}) => [...velocity, ...spin].every(each => each === 0);

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const kind = BALLS[process.argv[2]] ?? BALLS.football;
  const ball = {...kind, position: [0, 0, 1 + kind.body.radius], velocity: [2, 0, 0], spin: [0, -40, 3]};
  for (let k = 1; !rests(ball); k++) {
    const falling = ball.velocity[2] < 0;
    frame(ball);
    const [vx, , vz] = ball.velocity.map(each => each.toFixed(2)), when = `${(k * FRAME).toFixed(2)} s`;
    if (falling && ball.velocity[2] > 0) {
      console.log(`${when}: ${vx} m/s along, ${vz} up, ${ball.spin[1].toFixed(0)} rad/s`);
    }
    if (rests(ball)) console.log(`${when}: at rest, ${ball.position[0].toFixed(2)} m along`);
  }
}

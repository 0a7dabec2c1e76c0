/**
 * A ball in a game: gravity, a floor, and friction that takes spin along; a loop of frames, 60 a second.
 *
 *     node examples/recipes/bouncing_ball.mjs
 *
 * In a project of your own: npm install path/to/contactlab/kernels, and import {bounce} from "contactlab".
 */
import {pathToFileURL} from "node:url";
import {bounce} from "../../contactlab/kernels/contactlab_bounce.mjs";

const FRAME = 1 / 60, FLOOR = {}, DOWN = [0, 0, -1];  // the floor z = 0, of the ball's material

/** Moves a ball by one frame: it flies, bounces where it meets the floor, and rolls if it hops too low to see. */
export function frame(ball, gravity = 9.81) {
  for (let left = FRAME; left > 0;) {
    const {position: x, velocity: v} = ball, height = Math.max(x[2] - ball.radius, 0);
    const root = Math.sqrt(v[2] ** 2 + 2 * gravity * height), rolls = height === 0 && v[2] === 0;
    const lands = rolls ? Infinity : v[2] > 0 ? (v[2] + root) / gravity : 2 * height / (root - v[2]);
    const time = Math.min(lands, left);
    left -= time;
    x[0] += time * v[0];
    x[1] += time * v[1];
    if (rolls) continue;
    x[2] += time * (v[2] - gravity * time / 2);
    v[2] -= gravity * time;
    if (time < lands) continue;
    x[2] = ball.radius;
    Object.assign(ball, bounce(ball, FLOOR, ball.friction, DOWN, v, ball.spin));
    if (ball.velocity[2] < gravity * FRAME / 2) ball.velocity[2] = 0;
  }
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const ball = {
    radius: 0.025, mass: 0.065, poisson: 0.49, friction: 0.8,
    position: [0, 0, 1], velocity: [2, 0, 0], spin: [0, -150, 0],
  };
  for (let k = 1; k <= 120; k++) {
    const falling = ball.velocity[2] < 0;
    frame(ball);
    if (falling && ball.velocity[2] > 0) {
      const [vx, , vz] = ball.velocity.map(each => each.toFixed(2));
      console.log(`${(k * FRAME).toFixed(2)} s: ${vx} m/s along, ${vz} up, ${ball.spin[1].toFixed(0)} rad/s`);
    }
  }
}

/**
 * A ball in a game: gravity, a floor, and friction that takes spin along; a loop of frames, 60 a second.
 *
 *     contactlab kernel --out . && node bouncing_ball.mjs
 *
 * The kernel contactlab_springs.mjs stands beside this file. The floor is the plane z = 0, of the ball's material.
 */
import {pathToFileURL} from "node:url";
import {stateLength, step} from "./contactlab_springs.mjs";

const SPRINGS = 8, FRAME = 1 / 60;
/** Steps in the contact of the fastest impact: at least 11.4 sqrt(chi) are needed. */
const STEPS_A_CONTACT = 50;

/** Returns a ball: what it is made of, the speed of its fastest impact, and how it moves; SI units. */
export function newBall({radius, density, young, poisson, friction, fastest, position, velocity, spin}) {
  const mass = density * 4 / 3 * Math.PI * radius ** 3, shear = young / (2 * (1 + poisson));
  const hertz = 4 / 3 * young / (2 * (1 - poisson ** 2)) * Math.sqrt(radius);  // force over overlap^1.5
  const deepest = (1.25 * mass * fastest ** 2 / hertz) ** 0.4, lasts = 2.9432751843 * deepest / fastest;
  return {
    radius, mass, friction, hertz, inertia: 0.4 * mass * radius ** 2,
    modulus: 4 * shear / (2 - poisson),  // 2 G* of two like materials
    steps: Math.ceil(STEPS_A_CONTACT * FRAME / lasts),  // a frame
    position: [...position], velocity: [...velocity], spin: [...spin],
    contact: new Float64Array(stateLength(SPRINGS)), force: [0, 0, 0], frictionWork: 0,
  };
}

/** Moves a ball by one small step. */
export function move(ball, time, gravity) {
  const {position: x, velocity: v, spin, radius, force} = ball;
  for (let i = 0; i < 3; i++) x[i] += time * v[i];
  const overlap = Math.max(radius - x[2], 0), load = ball.hertz * overlap ** 1.5;
  // Velocity of the lowest point of the ball: v + spin x (0, 0, -radius).
  const moved = [time * (v[0] - spin[1] * radius), time * (v[1] + spin[0] * radius), 0];
  ball.frictionWork += step(ball.contact, SPRINGS, moved, [0, 0, 1], Math.sqrt(radius * overlap),
    ball.friction * load, radius, ball.modulus, force);
  v[0] += time * force[0] / ball.mass;
  v[1] += time * force[1] / ball.mass;
  v[2] += time * (load / ball.mass - gravity);
  spin[0] += time * radius * force[1] / ball.inertia;
  spin[1] -= time * radius * force[0] / ball.inertia;
}

/** Moves a ball by one frame. */
export function frame(ball, gravity = 9.81) {
  const time = FRAME / ball.steps;
  for (let k = 0; k < ball.steps; k++) move(ball, time, gravity);
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const ball = newBall({
    radius: 0.025, density: 1000, young: 1e7, poisson: 0.49, friction: 0.8, fastest: 5,
    position: [0, 0, 1], velocity: [2, 0, 0], spin: [0, -150, 0],
  });
  for (let k = 1; k <= 120; k++) {
    const falling = ball.velocity[2] < 0;
    frame(ball);
    if (falling && ball.velocity[2] > 0) {
      const [vx, , vz] = ball.velocity.map(each => each.toFixed(2));
      console.log(`${(k * FRAME).toFixed(2)} s: ${vx} m/s along, ${vz} up, ${ball.spin[1].toFixed(0)} rad/s`);
    }
  }
}

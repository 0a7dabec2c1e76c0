// What a user of TypeScript writes: tsc --strict accepts these lines, and refuses each below @ts-expect-error.
import {BALLS, bounce, impact, rebound, type Body, type Motion, type SphereBody} from "contactlab";
import {dampedStep, stateLength, step} from "contactlab/springs";
import {bounce as copied} from "./copied/contactlab_bounce.mjs";
import {step as stepped} from "./copied/contactlab_springs.mjs";

const ball: SphereBody = {radius: 0.025, mass: 0.065, poisson: 0.49}, floor: Body = {};
const {velocity, spin}: Motion = bounce(ball, floor, {friction: 0.8, restitution: 0.9}, [0, 0, -1], [2, 0, -4.4],
  [0, -150, 0]);
const again: Motion = copied(ball, {}, 0.8, [0, 0, -1], velocity, spin);
const drop: Motion = bounce(BALLS.superball.body, {}, BALLS.superball.contact, [0, 0, -1], [1, 0, -2], undefined,
  [0, 0, 0]);
const heavy: number = BALLS.football.body.mass + BALLS.football.contact.restitution;
const course = impact(1.2, 1.4412, 50, 200, 0.9), slips: Uint8Array | undefined = course.states[0];
const psi2: number = rebound(1.2, 1.4412) + rebound(1.2, 1.4412, 0.9);

const n = 8, state = new Float64Array(stateLength(n)), force = [0, 0, 0], normal = [0, 0, 1];
const work: number = step(state, n, [1e-7, 0, 0], normal, 1e-4, 0.3, 0.01, 1e11, force)
  + stepped(state, n, new Float64Array(3), normal, 1e-4, 0.3, 0.01, 1e11, force)
  + dampedStep(state, n, [1e-7, 0, 0], normal, 1e-4, 0.3, 0.01, 1e11, force, 0.3, 1, [0.1, 0, 0], 1e-6);

export const refused = [
  // @ts-expect-error: a vector of two numbers
  () => bounce(ball, floor, 0.8, [0, -1], [2, -4.4]),
  // @ts-expect-error: the first body without a radius
  () => bounce(floor, ball, 0.8, [0, 0, -1], [2, 0, -4.4]),
  // @ts-expect-error: restitution of a body
  () => bounce({...ball, restitution: 0.9}, {poisson: 0.3, restitution: 0.9}, 0.8, [0, 0, -1], [2, 0, -4.4]),
  // @ts-expect-error: a contact without friction
  () => bounce(ball, floor, {restitution: 0.9}, [0, 0, -1], [2, 0, -4.4]),
  // @ts-expect-error: restitution as a ninth argument
  () => bounce(ball, floor, 0.8, [0, 0, -1], [2, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], 0.9),
  // @ts-expect-error: an object as a vector
  () => bounce(ball, floor, 0.8, {x: 0, y: 0, z: -1}, [2, 0, -4.4]),
  // @ts-expect-error: no such ball
  () => BALLS.golfBall,
  // @ts-expect-error: a step without its force
  () => step(state, n, [1e-7, 0, 0], normal, 1e-4, 0.3, 0.01, 1e11),
  // @ts-expect-error: a step with loss without its time
  () => dampedStep(state, n, normal, normal, 1e-4, 0.3, 0.01, 1e11, force, 0.3, 1, [0.1, 0, 0]),
  // @ts-expect-error: a force that cannot be set
  () => step(state, n, normal, normal, 1e-4, 0.3, 0.01, 1e11, Object.freeze([0, 0, 0])),
];
console.log(JSON.stringify([again.bounced, drop.velocity, heavy, psi2, course.psi2, slips?.length, work, force]));

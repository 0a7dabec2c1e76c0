// What a user of CommonJS writes: tsc --strict accepts these lines, and refuses the one below @ts-expect-error.
import {BALLS, bounce, type Body, type Motion} from "contactlab";
import springs = require("contactlab/springs");

const floor: Body = {}, ball = BALLS.superball.body;
const length: number = springs.stateLength(8);
const {velocity}: Motion = bounce(ball, floor, {friction: 0.3, restitution: 0.9}, [0, 0, -1], [1, 0, -2]);

// @ts-expect-error: a vector of two numbers
export const refused = () => bounce(ball, floor, 0.8, [0, -1], [2, -4.4]);

console.log(JSON.stringify([length, velocity]));

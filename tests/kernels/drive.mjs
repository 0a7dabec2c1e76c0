// Drives the JavaScript kernel along motions from a file of doubles, as drive.c does the kernel in C.
// node drive.mjs KERNEL IN OUT, or node drive.mjs KERNEL impact PSI1 CHI SPRINGS STEPS
import {readFileSync, writeFileSync} from "node:fs";
import {pathToFileURL} from "node:url";

const [kernel, ...words] = process.argv.slice(2);
const {stateLength, step, dampedStep, impact} = await import(pathToFileURL(kernel));
if (words[0] === "impact") {
  const {psi2, time, force, limit, states} = impact(...words.slice(1).map(Number));
  const last = states.map(state => Array.from(state));
  console.log(JSON.stringify({psi2, time, force, limit, states: last}));
} else {
  const bytes = readFileSync(words[0]);
  const numbers = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const [n, steps, unit, modulus, time] = numbers, width = time === 0 ? 8 : 13, state = new Float64Array(stateLength(n));
  const answers = new Float64Array(4 * steps), force = [0, 0, 0];
  for (let k = 0; k < steps; k++) {
    const row = Array.from(numbers.subarray(5 + width * k, 5 + width * (k + 1)));
    const given = [state, n, row.slice(0, 3), row.slice(3, 6), row[6], row[7], unit, modulus, force];
    const more = [row[8], row[9], row.slice(10), time];
    const work = time === 0 ? step(...given) : dampedStep(...given, ...more);
    answers.set([...force, work], 4 * k);
  }
  writeFileSync(words[1], answers);
}

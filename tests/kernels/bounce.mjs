// As bounce.c does, in JavaScript: node bounce.mjs IN OUT, beside node_modules/contactlab.
import {readFileSync, writeFileSync} from "node:fs";
import {bounce} from "contactlab";

const bytes = readFileSync(process.argv[2]), answers = [];
const rows = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const given = value => (value === 0 ? undefined : value);
const body = ([radius, mass, ratio, young, poisson]) => ({
  radius: given(radius), mass: given(mass), gyration_ratio: given(ratio), young, poisson,
});
for (let k = 0; k < rows.length; k += 27) {
  const row = Array.from(rows.subarray(k, k + 27)), part = at => row.slice(at, at + 3);
  const contact = {friction: row[10], restitution: row[11]};
  try {
    const made = bounce(body(row.slice(0, 5)), body(row.slice(5, 10)), contact, ...[12, 15, 18, 21, 24].map(part));
    answers.push(Number(made.bounced), ...made.velocity, ...made.spin, ...made.otherVelocity, ...made.otherSpin);
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
    answers.push(-1, ...row.slice(15));
  }
}
writeFileSync(process.argv[3], Float64Array.from(answers));


/**
 * Friction of two elastic spheres with partial slip: springs on a doubling grid.
 *
 * `step` is the kernel for engines: Mindlin's partial slip along any path of load and displacement, with
 * n springs in 2 + 3 n numbers a contact, from nothing but the present contact. No path gains energy.
 * Theory, accuracy and measurements: section 13 of `contactlab guide theory`.
 *
 *     const state = new Float64Array(stateLength(8));               // no contact: all zero
 *     const work = step(state, 8, moved, normal, radius, limit, unit, modulus, force);
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */

/** Contacts whose radius is below this times the unit just touch: no friction. */
const TOUCH = 1e-30;

/** Returns the length of the state of a contact with n springs: A and b in m, then w of each, in m.
 *  Where the two bodies change places, A and b keep their signs and every w changes its own. */
export const stateLength = n => 2 + 3 * n;

/**
 * Takes one step of a contact. Returns the friction work in J.
 *
 * @param {Float64Array} state    numbers of the contact, the first stateLength(n) of the array; changed
 * @param {number} n              springs, even
 * @param {number[]} moved        displacement of the first body relative to the second in this step, in m
 * @param {number[]} normal       unit normal of the contact at the end of the step; either sense
 * @param {number} radius         contact radius b at the end of the step, in m; 0 out of contact
 * @param {number} limit          mu times the normal force at the end of the step, in N, at least 0
 * @param {number} unit           any fixed length of the pair, in m, such as its radius
 * @param {number} modulus        2 G*, 1/G* = sum (2 - nu)/(4 G), in Pa
 * @param {number[]} force        friction on the first body, in N; the second has the opposite; set
 *
 * A number that is not finite, a negative limit, or a unit or modulus that is not positive make force and
 * work NaN, until the contact ends.
 */
export function step(state, n, moved, normal, radius, limit, unit, modulus, force) {
  if (!(n >= 2 && n % 2 === 0 && state.length >= stateLength(n))) {
    throw new RangeError(`n = ${n} must be even, and state hold ${stateLength(n)} numbers, not ${state.length}`);
  }
  const [x, y, z] = normal, size = state[0];
  const all = moved[0] + moved[1] + moved[2] + x + y + z + radius + limit + modulus + unit + radius / unit;
  if (!(Number.isFinite(all) && unit > 0 && modulus > 0 && limit >= 0)) {
    state.fill(NaN, 2, stateLength(n));
    force[0] = force[1] = force[2] = NaN;
    state[0] = state[1] = 1;  // a contact, whose springs are NaN
    return NaN;
  }
  force[0] = force[1] = force[2] = 0;
  const b = radius > unit * TOUCH ? radius : 0;
  const lost = b > 0 ? fit(state, n, b, unit) : 0;
  if (!(state[0] > 0)) return 0;

  const cell = state[0] / n, u = b / cell, v = state[1] / cell, growth = u - v;
  const touching = within(u, n);
  const touched = state[0] === size ? within(v, n) : n;  // springs that may hold something
  // Limits in proportion to b² - r², together the limit of the contact.
  const sum = touching * u * u - touching * (4 * touching * touching - 1) / 12;
  const most = touching > 0 ? limit / (modulus * cell * sum) : 0;
  const along = moved[0] * x + moved[1] * y + moved[2] * z;
  const dx = moved[0] - along * x, dy = moved[1] - along * y, dz = moved[2] - along * z;
  let stored = 0, leans = 0;
  for (let k = 2; k < stateLength(touched); k += 3) {
    stored += state[k] ** 2 + state[k + 1] ** 2 + state[k + 2] ** 2;
    leans += (state[k] * x + state[k + 1] * y + state[k + 2] * z) ** 2;
  }
  // Springs are projected on the plane of the contact; a turn of the plane keeps their energy.
  const turned = leans < stored ? Math.sqrt(stored / (stored - leans)) : 1;
  let work = 0, fx = 0, fy = 0, fz = 0;
  for (let i = 0; i < Math.max(touching, touched); i++) {
    const r = i + 0.5, l = i < touching ? most * (u * u - r * r) : 0;
    // A spring that the contact reaches in the step moves from then on only.
    const part = growth > 0 && r > v ? (u - r) / growth : 1;
    const k = 2 + 3 * i, wx = state[k], wy = state[k + 1], wz = state[k + 2];
    const out = wx * x + wy * y + wz * z;
    const hx = turned * (wx - out * x), hy = turned * (wy - out * y), hz = turned * (wz - out * z);
    const tx = hx + part * dx, ty = hy + part * dy, tz = hz + part * dz;
    const square = tx * tx + ty * ty + tz * tz;
    const share = square > l * l ? l / Math.sqrt(square) : 1;
    const kx = share * tx, ky = share * ty, kz = share * tz;
    // The work of a spring: its mean w times its slip.
    work += (tx - kx) * (hx + kx) + (ty - ky) * (hy + ky) + (tz - kz) * (hz + kz);
    state[k] = kx; state[k + 1] = ky; state[k + 2] = kz;
    fx += kx; fy += ky; fz += kz;
  }
  const stiffness = modulus * cell;
  state[1] = b;
  if (b > 0) {
    force[0] = -stiffness * fx; force[1] = -stiffness * fy; force[2] = -stiffness * fz;
  } else {
    state.fill(0, 0, stateLength(n));  // nothing is left of the contact, NaN neither
  }
  return Math.max(work * stiffness / 2, 0) + modulus * lost;
}

/** Returns how many of n springs, at 1/2, 3/2, ... cells, are within u cells of the axis. */
const within = (u, n) => Math.min(n, Math.floor(u + 0.5));

/** Fits the grid to the contact radius b, so that A/4 < b <= A. Returns the energy lost over 2 G*. */
function fit(state, n, b, unit) {
  let lost = 0;
  if (!(state[0] > 0)) state[0] = unit * leastPower(b / unit);
  for (; b > state[0]; state[0] *= 2) {  // neighbours merge, the outer half starts from zero
    let sum = 0;
    for (let i = 0; i < 3 * (n / 2); i++) {
      const from = 2 + 6 * Math.floor(i / 3) + i % 3, inner = state[from], outer = state[from + 3];
      sum += (inner - outer) ** 2;
      state[2 + i] = (inner + outer) / 2;
    }
    state.fill(0, 2 + 3 * (n / 2), stateLength(n));
    lost += sum * state[0] / (4 * n);
  }
  for (; b <= state[0] / 4; state[0] /= 2) {  // cells split into equal halves
    for (let i = 3 * (n / 2); i < 3 * n; i++) lost += state[2 + i] ** 2 * state[0] / (2 * n);
    for (let i = 3 * n - 1; i >= 0; i--) state[2 + i] = state[2 + 3 * Math.floor(i / 6) + i % 3];
  }
  return lost;
}

/** Returns the least power of two that is at least x > 0. */
function leastPower(x) {
  let power = 2 ** Math.max(Math.ceil(Math.log2(x)), -1074);
  while (power < x) power *= 2;
  while (power / 2 >= x) power /= 2;
  return power;
}

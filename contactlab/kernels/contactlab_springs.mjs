/**
 * Friction of two spheres with partial slip, elastic or with loss: springs on a doubling grid.
 *
 * `step` is the kernel for engines: Mindlin's partial slip along any path of load and displacement, with
 * n springs in 2 + 3 n numbers a contact, from nothing but the present contact. No path gains energy.
 * Theory, accuracy and measurements: section 13 of `contactlab guide theory`.
 *
 *     const state = new Float64Array(stateLength(8));               // no contact: all zero
 *     const work = step(state, 8, moved, normal, radius, limit, unit, modulus, force);
 *
 * Where the normal force is damped, `dampedStep` gives shear its share of the loss.
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
export const step = (state, n, moved, normal, radius, limit, unit, modulus, force) =>
  dampedStep(state, n, moved, normal, radius, limit, unit, modulus, force, limit, 0, moved, 1);

/**
 * Takes one step of a contact whose normal force is damped. Returns the energy lost in shear in J.
 *
 * Arguments are those of `step`, with the radius sqrt(R overlap), and
 *
 * @param {number} elastic        mu times the elastic part of the normal force, Hertz's, in N, at least 0
 * @param {number} damping        of the whole contact against slip while it sticks, in N s/m, at least 0: shear loss
 *                                times G* over E* times the damping of the normal force; 0: elastic shear, as `step`
 * @param {number[]} velocity     slip velocity at the end of the step, as well as it is known, in m/s; else that of moved
 * @param {number} time           length of the step in s
 */
export function dampedStep(state, n, moved, normal, radius, limit, unit, modulus, force, elastic, damping, velocity, time) {
  if (!(n >= 2 && n % 2 === 0 && state.length >= stateLength(n))) {
    throw new RangeError(`n = ${n} must be even, and state hold ${stateLength(n)} numbers, not ${state.length}`);
  }
  const [x, y, z] = normal, size = state[0];
  const all = moved[0] + moved[1] + moved[2] + x + y + z + radius + limit + modulus + unit + radius / unit
    + elastic + damping + velocity[0] + velocity[1] + velocity[2] + time;
  if (!(Number.isFinite(all) && unit > 0 && modulus > 0 && limit >= 0 && elastic >= 0 && damping >= 0 && time > 0)) {
    state.fill(NaN, 2, stateLength(n));
    force[0] = force[1] = force[2] = NaN;
    state[0] = state[1] = 1;  // a contact, whose springs are NaN
    return NaN;
  }
  force[0] = force[1] = force[2] = 0;
  const lag = damping > 0 && radius > 0 ? damping / (modulus * radius) : 0;
  // Where damping pulls, the contact shrinks before the overlap does.
  const reached = lag > 0 && limit < elastic ? radius * Math.cbrt(limit / elastic) : radius;
  const b = reached > unit * TOUCH ? reached : 0;
  const lost = b > 0 ? fit(state, n, b, unit, lag > 0) : 0;
  if (!(state[0] > 0)) return 0;

  const cell = state[0] / n, u = b / cell, v = state[1] / cell, growth = u - v;
  const touching = within(u, n);
  const touched = state[0] === size ? within(v, n) : n;  // springs that may hold something
  // Limits in proportion to b² - r² + jump, together the limit of the contact: damping that presses adds the same
  // to every spring.
  const more = limit < 1e9 * elastic ? limit / elastic - 1 : 1e9;
  const jump = lag > 0 && limit > elastic ? more * (u * u * 2 / 3) : 0;
  const sum = touching * u * u - touching * (4 * touching * touching - 1) / 12 + touching * jump;
  const most = touching > 0 ? limit / (modulus * cell * sum) : 0;
  const along = moved[0] * x + moved[1] * y + moved[2] * z;
  const dx = moved[0] - along * x, dy = moved[1] - along * y, dz = moved[2] - along * z;
  const outward = velocity[0] * x + velocity[1] * y + velocity[2] * z;
  const px = lag * (velocity[0] - outward * x), py = lag * (velocity[1] - outward * y), pz = lag * (velocity[2] - outward * z);
  const whole = lag > 0 ? relaxed(time / lag) : null;
  let stored = 0, leans = 0;
  for (let k = 2; k < stateLength(touched); k += 3) {
    stored += state[k] ** 2 + state[k + 1] ** 2 + state[k + 2] ** 2;
    leans += (state[k] * x + state[k + 1] * y + state[k + 2] * z) ** 2;
  }
  // Springs are projected on the plane of the contact; a turn of the plane keeps their energy.
  const turned = leans < stored ? Math.sqrt(stored / (stored - leans)) : 1;
  let work = 0, fx = 0, fy = 0, fz = 0;
  for (let i = 0; i < Math.max(touching, touched); i++) {
    const r = i + 0.5, l = i < touching ? most * (u * u - r * r + jump) : 0;
    // A spring that the contact reaches in the step moves from then on only.
    const part = growth > 0 && r > v ? (u - r) / growth : 1;
    const k = 2 + 3 * i, wx = state[k], wy = state[k + 1], wz = state[k + 2];
    const out = wx * x + wy * y + wz * z;
    const hx = turned * (wx - out * x), hy = turned * (wy - out * y), hz = turned * (wz - out * z);
    const tx = hx + part * dx, ty = hy + part * dy, tz = hz + part * dz;
    if (lag > 0 && i < touching) {
      const before = most * ((r < v ? v * v - r * r : 0) + jump);
      const {left, ramp, gone} = part < 1 ? relaxed(part * time / lag) : whole;
      // The force is at most the limit, so that w is within `reach` of what is left of the one held; where it grows,
      // within `least`, or energy could be gained.
      const reach = before * gone + (l - before) * ramp, least = l * gone;
      const mx = tx - left * hx, my = ty - left * hy, mz = tz - left * hz, size = Math.sqrt(mx * mx + my * my + mz * mz);
      let kx = tx, ky = ty, kz = tz;
      if (size > reach) {
        const cut = reach / size;
        kx = left * hx + cut * mx; ky = left * hy + cut * my; kz = left * hz + cut * mz;
      }
      if (least < reach && size > least) {
        const cut = least / size, ax = left * hx + cut * mx, ay = left * hy + cut * my, az = left * hz + cut * mz;
        const allowed = Math.max(hx * hx + hy * hy + hz * hz, ax * ax + ay * ay + az * az);
        const grown = kx * kx + ky * ky + kz * kz;
        if (grown > allowed) {
          const shrunk = Math.sqrt(allowed / grown);
          kx *= shrunk; ky *= shrunk; kz *= shrunk;
        }
      }
      const gx = kx - hx, gy = ky - hy, gz = kz - hz;
      work += 2 * lag / time * (gx * dx + gy * dy + gz * dz)
        + (hx + kx) * (part * dx - gx) + (hy + ky) * (part * dy - gy) + (hz + kz) * (part * dz - gz);
      state[k] = kx; state[k + 1] = ky; state[k + 2] = kz;
      const sx = kx + px, sy = ky + py, sz = kz + pz, pulled = sx * sx + sy * sy + sz * sz;
      const share = pulled > l * l ? l / Math.sqrt(pulled) : 1;
      fx += share * sx; fy += share * sy; fz += share * sz;
      continue;
    }
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

/** Returns what is left of a deflection after x relaxation times, what is gone of it, and 1 - gone/x. */
function relaxed(x) {
  if (x < 0.03) {  // series: the differences would lose all digits
    const ramp = x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6 * (1 - x / 7)))));
    return {left: 1 - x + x * ramp, ramp, gone: x - x * ramp};
  }
  const left = Math.exp(-x);
  return {left, ramp: 1 - (1 - left) / x, gone: 1 - left};
}

/** Widens each of n cells by a quarter: a new one has the mean w of what it covers, zero beyond the old grid. Returns
 *  the energy lost over 2 G*. */
function widen(state, n) {
  let sum = 0;
  for (let j = 0; j < n; j++) {  // five cells become four, of 4/5 and 1/5, 3/5 and 2/5, ... of two neighbours
    const share = 0.2 * (4 - j % 4), first = j + Math.floor(j / 4);
    for (let k = 0; k < 3; k++) {
      const inner = first < n ? state[2 + 3 * first + k] : 0, outer = first + 1 < n ? state[5 + 3 * first + k] : 0;
      state[2 + 3 * j + k] = share * inner + (1 - share) * outer;
      sum += share * (1 - share) * (inner - outer) ** 2;
    }
  }
  state[0] *= 1.25;
  return sum * state[0] / (2 * n);
}

/** Fits the grid to the contact radius b, so that A/4 < b <= A; with loss it grows by quarters, else it doubles.
 *  Returns the energy lost over 2 G*. */
function fit(state, n, b, unit, lossy) {
  let lost = 0;
  if (!(state[0] > 0)) state[0] = unit * leastPower(b / unit);
  while (lossy && b > state[0]) lost += widen(state, n);
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

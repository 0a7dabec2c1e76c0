/* The impact with other contacts than the kernel's, in its scaled variables (theory 1, 4 and 11). */

/* Return beta of Tsuji's dashpot at a restitution e from 0.5 to 1, and half its oscillator's duration. */
function dashpot(e) {
  const half = beta => Math.acos(beta) / Math.sqrt(1 - beta * beta);
  let low = 0, high = .5;
  for (let k = 0; k < 60; k++) { const beta = (low + high) / 2; if (Math.exp(-2 * beta * half(beta)) > e) low = beta; else high = beta; }
  return {beta: low, half: half(low)};
}

/* Return one impact at a restitution e, with springs that span the largest contact: psi2, the duration,
   and at the ends of the steps time over duration, F, mu P, the contact radius, and the springs' states.
   Tsuji's motion is in closed form, an oscillator x = zeta^1.25 of time s; t makes all smooth at first touch. */
function contactOf(psi1, chi, e, springs, steps) {
  const {beta, half} = dashpot(e), root = Math.sqrt(1 - beta * beta), largest = e ** .4;
  const at = t => {
    const fifth = t ** 5, rest = fifth + (1 - t) / 16, s = 2 * half * fifth / rest, decay = Math.exp(-beta * s);
    const sine = Math.sin(root * s) / root, x = Math.max(decay * sine, 0);
    const pull = Math.max(decay * ((1 - 2 * beta * beta) * sine + 2 * beta * Math.cos(root * s)), 0);
    return {square: x ** .8, most: x ** .2 * pull, pace: 2 * half * (5 - 4 * t) / 16 * t ** 4 / (rest * rest * 1.25 * x ** .2)};
  };
  const squares = Float64Array.from({length: springs}, (_, i) => largest * ((i + .5) / springs) ** 2);
  const w = new Float64Array(springs), time = [0], force = [0], limit = [0], radius = [0], states = [];
  let psi = psi1, before = 0, now = 0;
  for (let k = 1; k <= steps; k++) {
    const h = at((k - .5) / steps).pace / steps, {square, most} = at(k / steps);
    psi -= 1.25 * chi * force[k - 1] * h;
    const moved = psi * h, state = new Uint8Array(springs), height = square > 0 ? most / square ** 1.5 : 0;
    let sum = 0, full = 0;
    for (let i = 0; i < springs; i++) {
      const room = square - squares[i];
      if (room <= 0) { w[i] = 0; continue; }
      const tried = w[i] + (squares[i] < before ? 1 : room / (square - before)) * moved;
      w[i] = Math.max(-height * room, Math.min(height * room, tried));
      state[i] = w[i] === tried ? 1 : tried > 0 ? 2 : 3;
      sum += w[i]; full += room;
    }
    before = square; now += h;
    const tangential = full > 0 ? square ** 1.5 * sum / full : 0;
    psi -= 1.25 * chi * tangential * h;
    time.push(now); force.push(tangential); limit.push(most); radius.push(Math.sqrt(square)); states.push(state);
  }
  return {psi2: psi, duration: now, time: time.map(t => t / now), force, limit, radius, states};
}

/* Return psi2 and, at the times of a contact, F of one spring for all of it with Coulomb's cap:
   F = (3/2) u D, D the displacement, cut where F would exceed the limit (LAMMPS mindlin, LIGGGHTS). */
function cappedImpact(psi1, chi, {time, duration, limit, radius}) {
  const force = [0];
  let psi = psi1, moved = 0;
  for (let k = 1; k < time.length; k++) {
    const h = duration * (time[k] - time[k - 1]), u = radius[k];
    psi -= 1.25 * chi * force[k - 1] * h;
    moved += psi * h;
    const tangential = Math.max(-limit[k], Math.min(limit[k], 1.5 * u * moved));
    moved = u > 0 ? tangential / (1.5 * u) : 0;
    psi -= 1.25 * chi * tangential * h;
    force.push(tangential);
  }
  return {psi2: psi, time, force};
}

/* Return psi2 of rigid bodies: they slip, and roll where slip ends. */
const rigidRebound = (psi1, chi, e) => Math.sign(psi1) * Math.max(Math.abs(psi1) - 2 * chi * (1 + e), 0);

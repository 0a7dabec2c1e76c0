/* The impact of an elastic sphere with partial slip: a bundle of springs for the contact.

Scaled variables (Maw, Barber & Fawcett 1976): psi is the slip velocity, F the tangential force over
mu P_max, u the contact radius over its maximum a, s the distance of a spring from the centre over a.
The deflection w of a spring follows the slip displacement within its limit u² - s²; F is 3/2 times
the integral of w over s, and psi' = -(5/2) chi F. Leapfrog over even steps of the Hertz phase. */

/* Return psi2 and, at the ends of all steps, time over duration, F, mu P over mu P_max, u, and the
   state of each spring: 0 out of contact, 1 stuck, 2 slipping forwards, 3 backwards. */
function impact(psi1, chi, springs, steps) {
  const places = Float64Array.from({length: springs}, (_, i) => ((i + .5) / springs) ** 2);
  const w = new Float64Array(springs);
  const time = [0], force = [0], limit = [0], radius = [0], states = [new Uint8Array(springs)];
  let psi = psi1, square = 0, now = 0;
  for (let k = 1; k <= steps; k++) {
    const h = hertzRate(Math.PI * (k - .5) / steps) * Math.PI / steps;
    const u = k === steps ? 0 : Math.sin(Math.PI * k / steps), next = u * u;
    psi -= 1.25 * chi * force[k - 1] * h;
    const moved = psi * h, state = new Uint8Array(springs);
    let sum = 0, full = 0;
    for (let i = 0; i < springs; i++) {
      const most = next - places[i];
      if (most <= 0) { w[i] = 0; continue; }
      const share = places[i] < square ? 1 : most / (next - square); // met within the step
      const tried = w[i] + share * moved;
      w[i] = Math.max(-most, Math.min(most, tried));
      state[i] = tried > most ? 2 : tried < -most ? 3 : 1;
      sum += w[i]; full += most;
    }
    square = next; now += h;
    const friction = u ** 3, tangential = full > 0 ? friction * sum / full : 0;
    psi -= 1.25 * chi * tangential * h;
    time.push(now); force.push(tangential); limit.push(friction); radius.push(u); states.push(state);
  }
  return {psi2: psi, time: time.map(t => t / now), force, limit, radius, states};
}

/* Return the same of one spring for the whole contact with Coulomb's cap: F = (3/2) u D, D the
   displacement, cut where F would exceed the limit (LAMMPS mindlin, LIGGGHTS). */
function cappedImpact(psi1, chi, steps) {
  const time = [0], force = [0];
  let psi = psi1, moved = 0, now = 0;
  for (let k = 1; k <= steps; k++) {
    const h = hertzRate(Math.PI * (k - .5) / steps) * Math.PI / steps;
    const u = k === steps ? 0 : Math.sin(Math.PI * k / steps), friction = u ** 3;
    psi -= 1.25 * chi * force[k - 1] * h;
    moved += psi * h;
    const tangential = Math.max(-friction, Math.min(friction, 1.5 * u * moved));
    moved = u > 0 ? tangential / (1.5 * u) : 0;
    psi -= 1.25 * chi * tangential * h;
    now += h; time.push(now); force.push(tangential);
  }
  return {psi2: psi, time: time.map(t => t / now), force};
}

/* Return psi2 of rigid bodies: they slip, and roll where slip ends. */
const rigidRebound = (psi1, chi) => Math.sign(psi1) * Math.max(Math.abs(psi1) - 4 * chi, 0);

/* Return dt/dx at the phase x of Hertz's motion, u = sin x, with a unit of time that is no matter. */
function hertzRate(x) {
  const u = Math.sin(x), q = u * u;
  return 2 * u / Math.sqrt(1 + q + q * q / (1 + u));
}

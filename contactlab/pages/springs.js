/* The impact with other contacts than the kernel's, in its scaled variables. */

/* Return psi2 and, at the times of an impact of the kernel, F of one spring for the whole contact
   with Coulomb's cap: F = (3/2) u D, D the displacement, cut where F would exceed the limit u³
   (LAMMPS mindlin, LIGGGHTS). */
function cappedImpact(psi1, chi, {time, limit}) {
  const force = [0];
  let psi = psi1, moved = 0;
  for (let k = 1; k < time.length; k++) {
    const h = DURATION * (time[k] - time[k - 1]), u = Math.cbrt(limit[k]);
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
const rigidRebound = (psi1, chi) => Math.sign(psi1) * Math.max(Math.abs(psi1) - 4 * chi, 0);

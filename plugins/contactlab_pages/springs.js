/* The impact under other laws than the kernel's, in its scaled variables (theory 1). */

/* Return psi2 and, at the times of a contact, F over the largest mu P, of one spring for all of it with Coulomb's cap:
   F = (3/2) u D, D the displacement, cut where F would exceed the limit (LAMMPS mindlin, LIGGGHTS). */
function cappedImpact(psi1, chi, {time, duration, peak, limit, radius}) {
  const force = [0];
  let psi = psi1, moved = 0;
  for (let k = 1; k < time.length; k++) {
    const h = duration * (time[k] - time[k - 1]), u = radius[k];
    psi -= 1.25 * chi * peak * force[k - 1] * h;
    moved += psi * h;
    const tangential = Math.max(-limit[k], Math.min(limit[k], 1.5 * u * moved / peak));
    moved = u > 0 ? peak * tangential / (1.5 * u) : 0;
    psi -= 1.25 * chi * peak * tangential * h;
    force.push(tangential);
  }
  return {psi2: psi, time, force};
}

/* Return psi2 of rigid bodies: they slip, and roll where slip ends. */
const rigidRebound = (psi1, chi, e) => Math.sign(psi1) * Math.max(Math.abs(psi1) - 2 * chi * (1 + e), 0);

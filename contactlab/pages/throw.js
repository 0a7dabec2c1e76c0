/* A ball thrown at a block of the same material: from what one sets to what one sees, in SI. */

const SHARE = 2 / 7, INERTIA = 2 / 5; // of a solid sphere: tangential mass over mass, k²
const DURATION = 2.9432751843;        // of Hertz's contact, times C² R / v
const FIRST_YIELD = 1.6, LARGE_CONTACT = .1;

/* Return psi1, chi, scale of psi, and Hertz's contact: radius over R, duration, pressure. */
function meeting(set) {
  const body = MATERIALS[set.material], nu = body.poisson_ratio, R = set.radius / 1000;
  const along = set.speed * Math.sin(set.angle * Math.PI / 180);
  const normal = set.speed * Math.cos(set.angle * Math.PI / 180);
  const kappa = 2 * (1 - nu) / (2 - nu), scale = kappa / (set.friction * normal);
  const modulus = body.young_modulus / (2 * (1 - nu * nu));
  const mass = 4 / 3 * Math.PI * R ** 3 * body.density;
  const C = (15 * mass * normal ** 2 / (16 * modulus * R ** 3)) ** .2;
  const peak = 1.25 * mass * normal ** 2 / (C * C * R);
  return {
    along, normal, R, C, mass, nu, scale, chi: .5 * kappa / SHARE, psi1: scale * (along + set.spin * R),
    duration: DURATION * C * C * R / normal, pressure: 1.5 * peak / (Math.PI * (C * R) ** 2),
    yields: body.yield_stress ? FIRST_YIELD * body.yield_stress : Infinity,
  };
}

/* Return how the ball leaves if the contact point leaves with psi2. */
function leaving(met, set, psi2) {
  const change = (psi2 - met.psi1) / met.scale, along = met.along + SHARE * change;
  return {
    psi2, along, normal: met.normal, speed: Math.hypot(along, met.normal),
    angle: Math.atan2(along, met.normal) * 180 / Math.PI,
    spin: set.spin + SHARE / INERTIA * change / met.R,
  };
}

/* Return how the elastic ball leaves; spin about the third axis is positive where it adds to the slip. */
function bouncing(met, set) {
  const ball = {radius: met.R, mass: met.mass, poisson: met.nu};
  const left = bounce(ball, {}, set.friction, [0, -1, 0], [met.along, -met.normal, 0], [0, 0, set.spin]);
  return leaving(met, set, met.scale * (left.velocity[0] + left.spin[2] * met.R));
}

/* Return the whole throw: meeting, contact, and how the ball leaves under the three laws. */
function thrown(set) {
  const met = meeting(set), contact = impact(met.psi1, met.chi, SPRINGS, STEPS);
  const capped = cappedImpact(met.psi1, met.chi, contact);
  return {
    met, contact, capped,
    exact: bouncing(met, set),
    spring: leaving(met, set, capped.psi2),
    rigid: leaving(met, set, rigidRebound(met.psi1, met.chi)),
  };
}

/* Return rebound angles of the three laws at all angles of incidence, in degrees. */
function rebounds(set) {
  const rows = [];
  for (let angle = 0; angle <= 84; angle += 2) {
    const at = {...set, angle}, met = meeting(at);
    const contact = impact(met.psi1, met.chi, 40, 160);
    const others = [cappedImpact(met.psi1, met.chi, contact).psi2, rigidRebound(met.psi1, met.chi)];
    rows.push([angle, ...[bouncing(met, at), ...others.map(psi2 => leaving(met, at, psi2))].map(left => left.angle)]);
  }
  return rows;
}

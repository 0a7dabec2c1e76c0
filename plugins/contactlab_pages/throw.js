/* A ball thrown at a block: from what one sets to what one sees, in SI. */

const DURATION = 2.9432751843;        // of Hertz's contact, times C² R / v
const FIRST_YIELD = 1.6, LARGE_CONTACT = .1;
const SHEAR_ERROR = .16;              // of the tangential restitution, rms over eight balls (theory 15)

/* Return ball and block as the kernel has bodies, with their yield stresses. */
function bodies(set) {
  const [one, other] = [set.material, set.block || set.material].map(name => {
    const {young_modulus, poisson_ratio, density, yield_stress} = MATERIALS[name];
    return {young: young_modulus, poisson: poisson_ratio, density, yields: FIRST_YIELD * (yield_stress || Infinity)};
  });
  one.radius = set.radius;
  one.mass = 4 / 3 * Math.PI * set.radius ** 3 * one.density;
  one.gyration_ratio = Math.sqrt(set.inertia);
  return [one, other];
}

/* Return psi1, chi, scale of psi, and Hertz's contact: radius over R, duration, pressure. */
function meeting(set) {
  const pair = bodies(set), [{mass, radius: R}] = pair;
  const along = set.speed * Math.sin(set.angle * Math.PI / 180);
  const normal = set.speed * Math.cos(set.angle * Math.PI / 180);
  const kappa = stiffnesses(...pair), scale = kappa / (set.friction * normal), share = set.inertia / (1 + set.inertia);
  const modulus = 1 / pair.reduce((sum, {young, poisson}) => sum + (1 - poisson ** 2) / young, 0);
  const [first, second] = pair.map(({young, poisson}) => (1 + poisson) * (1 - 2 * poisson) / young);
  const C = (15 * mass * normal ** 2 / (16 * modulus * R ** 3)) ** .2;
  const peak = 1.25 * mass * normal ** 2 / (C * C * R);
  return {
    pair, along, normal, R, C, scale, share, chi: .5 * kappa / share, psi1: scale * (along + set.spin * R),
    unit: C * C * R / normal, pressure: 1.5 * peak / (Math.PI * (C * R) ** 2),
    yields: Math.min(...pair.map(body => body.yields)),
    coupling: kappa * modulus * Math.abs(first - second) / (2 * set.friction),
  };
}

/* Return how the ball leaves if the contact point leaves with psi2. */
function leaving(met, set, psi2) {
  const change = (psi2 - met.psi1) / met.scale, along = met.along + met.share * change, normal = set.restitution * met.normal;
  return {
    psi2, along, normal, speed: Math.hypot(along, normal), angle: Math.atan2(along, normal) * 180 / Math.PI,
    spin: set.spin + met.share / set.inertia * change / met.R,
  };
}

/* Return how the ball leaves; spin about the third axis is positive where it adds to the slip. */
function bouncing(met, set) {
  const [ball, block] = met.pair.map(({radius, mass, gyration_ratio, young, poisson}) => ({radius, mass, gyration_ratio, young, poisson}));
  const left = bounce(ball, block, {friction: set.friction, restitution: set.restitution}, [0, -1, 0],
    [met.along, -met.normal, 0], [0, 0, set.spin]);
  return leaving(met, set, met.scale * (left.velocity[0] + left.spin[2] * met.R));
}

/* Return the whole throw: meeting, contact, and how the ball leaves under the three laws. */
function thrown(set, springs = SPRINGS, steps = STEPS) {
  const met = meeting(set), contact = impact(met.psi1, met.chi, springs, steps, set.restitution);
  const capped = cappedImpact(met.psi1, met.chi, contact);
  return {
    met, contact, capped,
    duration: met.unit * (set.restitution < 1 ? contact.duration : DURATION),
    exact: bouncing(met, set),
    spring: leaving(met, set, capped.psi2),
    rigid: leaving(met, set, rigidRebound(met.psi1, met.chi, set.restitution)),
  };
}

/* Return rebound angles of the three laws at all angles of incidence, in degrees. */
function rebounds(set) {
  return Array.from({length: 43}, (_, k) => {
    const {exact, spring, rigid} = thrown({...set, angle: 2 * k}, 40, 160);
    return [2 * k, exact.angle, spring.angle, rigid.angle];
  });
}

/**
 * A ball thrown at the floor in planck, a game engine in the plane, whose bounces contactlab's bounce computes.
 *
 *     npm install planck path/to/contactlab/kernels
 *     node ball_in_planck.mjs
 *
 * The ball is a circle with the mass and the moment of inertia of its body; walls and floors are static fixtures.
 * planck lets no body turn by more than a quarter of a turn a step: take 240 steps a second for a superball.
 */
import {pathToFileURL} from "node:url";
import {Circle, Edge, Vec2, World} from "planck";
import {BALLS, bounce} from "contactlab";

const SLOW = 0.05;  // m/s of approach, below which planck keeps the contact, and a ball rests

/** Lets bounce answer for every fixture whose user data is a ball, {body, contact}, as it meets what is static. */
export function bounces(world) {
  world.on("pre-solve", contact => {
    const fixtures = [contact.getFixtureA(), contact.getFixtureB()];
    const k = fixtures.findIndex(each => each.getUserData()?.contact);
    if (k < 0 || !fixtures[1 - k].getBody().isStatic()) return;
    const {x, y} = contact.getWorldManifold(null).normal;  // from the first fixture to the second
    const moving = fixtures[k].getBody(), v = moving.getLinearVelocity(), ball = fixtures[k].getUserData();
    const normal = k ? [-x, -y, 0] : [x, y, 0];
    contact.resetFriction();
    contact.resetRestitution();
    if (v.x * normal[0] + v.y * normal[1] < SLOW) return;
    const {velocity, spin} = bounce(ball.body, {}, ball.contact, normal, [v.x, v.y, 0],
      [0, 0, moving.getAngularVelocity()]);
    moving.setLinearVelocity(new Vec2(velocity[0], velocity[1]));
    moving.setAngularVelocity(spin[2]);
    contact.setFriction(0);  // planck finds bodies that part, stops them at the surface, and adds no impulse
    contact.setRestitution(0);
  });
}

/** Returns a world with a floor, and a ball that flies towards it. */
export function thrown(ball, velocity, spin, {gravity = 9.81, ours = true} = {}) {
  const {radius, mass, gyration_ratio: ratio = Math.sqrt(0.4)} = ball.body;
  const {friction, restitution} = ball.contact;
  const world = new World({gravity: new Vec2(0, -gravity)});
  world.createBody().createFixture({shape: new Edge(new Vec2(-100, 0), new Vec2(100, 0)), friction, restitution});
  const position = new Vec2(0, radius + 0.2);
  const body = world.createDynamicBody({position, linearVelocity: new Vec2(...velocity), angularVelocity: spin});
  body.createFixture({shape: new Circle(radius), friction, restitution, userData: ball});
  body.setMassData({mass, center: new Vec2(0, 0), I: mass * (ratio * radius) ** 2});
  if (ours) bounces(world);
  return {world, body};
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  for (const [name, ours] of [["planck", false], ["contactlab", true]]) {
    const {world, body} = thrown(BALLS.superball, [2, -4.4], 150, {ours});
    while (body.getLinearVelocity().y < 0) world.step(1 / 240);
    const {x, y} = body.getLinearVelocity(), spin = body.getAngularVelocity();
    console.log(`${name}: ${x.toFixed(2)} m/s along, ${y.toFixed(2)} up, ${spin.toFixed(1)} rad/s`);
  }
}

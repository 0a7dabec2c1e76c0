/* For a class: a score over ten predictions, and six questions whose answers the page works out. */

const ROUND = 10, MOST_POINTS = 10, DEGREES_A_POINT = 2;
const guesses = {errors: [], seen: new Set()};

/* Return the points of a prediction that is off by so many degrees. */
const points = off => Math.max(MOST_POINTS - Math.floor(off / DEGREES_A_POINT), 0);

/* Take a prediction into the score; a throw counts once. */
function scored(set, off) {
  const known = JSON.stringify({...set, guess: 0});
  if (guesses.seen.has(known)) return;
  guesses.seen.add(known);
  if (guesses.errors.length === ROUND) guesses.errors = [];
  guesses.errors.push(off);
}

/* Return the words of the score. */
function scoreWords() {
  const {errors} = guesses, sum = list => list.reduce((total, each) => total + each, 0);
  if (!errors.length) return `${ROUND} predictions: ${MOST_POINTS} points each, one less for each ${DEGREES_A_POINT}\u00b0 off.`;
  const all = `${sum(errors.map(points))} of ${MOST_POINTS * errors.length} points`;
  if (errors.length < ROUND) return `Prediction ${errors.length} of ${ROUND}: ${all}.`;
  return `${ROUND} predictions: ${all}, ${(sum(errors) / ROUND).toFixed(1)}\u00b0 off in the mean. The next begins a new round.`;
}

/* Return a throw by chance, of the same ball. */
function byChance(set) {
  const chance = (least, most, step) => +(least + step * Math.floor(Math.random() * ((most - least) / step + 1))).toFixed(2);
  return {...set, angle: chance(0, 75, 5), speed: chance(1, 5, .5), spin: chance(-300, 300, 50), friction: chance(.1, .9, .1), guess: 0};
}

const STEEL = {angle: 45, speed: 3, spin: 0, friction: .3, radius: .01, inertia: .4, restitution: 1, material: "steel", block: ""};
const PLASTIC = {...STEEL, material: "pmma", speed: 2};
const SUPERBALL = {...STEEL, material: "rubber", radius: .025, speed: 5, spin: 200, friction: .8};
/* What is asked, the throws it is about, and the answer from how the balls leave. */
const QUESTIONS = [
  ["A steel ball without spin grazes steel at 60\u00b0 and 3 m/s, friction 0.1. By how much do the elastic and the rigid ball part?",
    [{...STEEL, angle: 60, friction: .1}],
    ([one]) => `Not at all: the contact slips from first touch to last, and both leave at ${degrees(one.exact)} with ${spinWords(one.exact.spin)}.`],
  ["A plastic ball (pmma) of 10 mm radius falls straight down at 2 m/s with backspin 200 rad/s, friction 0.3. Which way does it leave?",
    [{...PLASTIC, angle: 0, spin: 200}],
    ([one]) => `To the side from which balls are thrown, at ${degrees(one.exact)}. Its lower side moves on, so friction pushes it back; the spin falls from 200 to ${minus(one.exact.spin, 0)} rad/s.`],
  ["A steel ball without spin hits steel at 30\u00b0, friction 0.3, once at 3 m/s and once at 6 m/s. What changes?",
    [{...STEEL, angle: 30}, {...STEEL, angle: 30, speed: 6}],
    ([one, two]) => `The angle does not, ${degrees(one.exact)} and ${degrees(two.exact)}: elastic contact has no speed of its own. The spin doubles, ${minus(one.exact.spin, 0)} to ${minus(two.exact.spin, 0)} rad/s.`],
  ["A steel ball without spin hits steel at 45\u00b0 and 3 m/s, friction 0.3. The restitution falls from 1 to 0.7. Does it leave steeper or flatter?",
    [STEEL, {...STEEL, restitution: .7}],
    ([one, two]) => `Flatter, at ${degrees(two.exact)} in place of ${degrees(one.exact)}, as it rises more slowly.`],
  ["A solid plastic ball and a thin shell (inertia 0.67) hit at 30\u00b0 and 2 m/s without spin, friction 0.8. Which one leaves steeper?",
    [{...PLASTIC, angle: 30, friction: .8}, {...PLASTIC, angle: 30, friction: .8, inertia: .67}],
    ([solid, shell]) => `The shell, at ${degrees(shell.exact)}; the solid ball at ${degrees(solid.exact)}. A shell is harder to spin, so friction slows it more.`],
  ["A rubber ball of 25 mm radius is thrown at rubber at 45\u00b0 and 5 m/s with backspin 200 rad/s, friction 0.8. Does it come back? And a rigid one?",
    [SUPERBALL],
    ([one]) => `It comes back, at ${degrees(one.exact)}, and the spin turns from 200 to ${minus(one.exact.spin, 0)} rad/s. The rigid ball goes on at ${degrees(one.rigid)}: it keeps no energy along the surface to turn back with.`],
];
const degrees = left => `${minus(left.angle, 1)}\u00b0`;

/* Write the questions and their answers. */
function writeSheet() {
  $("questions").innerHTML = QUESTIONS.map(([asked, [set]]) => `<li>${asked} <a href="${linkTo({...FIRST, ...set, predict: true})}">Throw it.</a></li>`).join("");
  $("solutions").innerHTML = QUESTIONS.map(([, sets, told]) => `<li>${told(sets.map(set => thrown(set)))}</li>`).join("");
}

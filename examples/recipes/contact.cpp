// Two spheres that meet, in a code of one's own: the springs of contactlab's kernel in single precision.
//
//     contactlab kernel --out build
//     g++ -std=c++17 -O2 -I build contact.cpp -o contact && ./contact
//
// It prints the angle of incidence, psi1 and psi2 of eleven impacts, turned and spinning about the normal.

#define CONTACTLAB_REAL float
#include "contactlab_springs.h"

#include <array>
#include <cstdio>

using Vector = std::array<double, 3>;

static double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static Vector cross(const Vector &a, const Vector &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
static void add(Vector &a, double factor, const Vector &b)
{
  for (int k = 0; k < 3; ++k) a[k] += factor * b[k];
}

constexpr int SPRINGS = 8;
constexpr double RADIUS = 0.01, DENSITY = 2500, YOUNG = 60e9, POISSON = 0.3, FRICTION = 0.2, SPEED = 0.02, STEP = 1e-6;

struct Sphere {
  Vector place, velocity, spin;
};

// The springs lie in the plane of the contact and turn with the bodies: by the mean of both spins about
// the normal. The turn of the normal itself the kernel sees.
static void turn(float *state, const Vector &normal, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < SPRINGS; ++i) {
    float *w = state + 2 + 3 * i;
    const Vector held{w[0], w[1], w[2]}, across = cross(normal, held);
    for (int k = 0; k < 3; ++k) w[k] = float(c * held[k] + s * across[k]);
  }
}

// Follows one impact. Places and velocities are in double precision, as the overlap is a small difference.
static void meet(Sphere &one, Sphere &two)
{
  const double mass = DENSITY * 4.0 / 3.0 * M_PI * RADIUS * RADIUS * RADIUS, inertia = 0.4 * mass * RADIUS * RADIUS;
  const double stiff = YOUNG / (2 * (1 - POISSON * POISSON)), shear = YOUNG / (2 * (1 + POISSON));
  float state[CONTACTLAB_SPRINGS_STATE(SPRINGS)] = {0}, force[3];
  bool touched = false;
  for (;;) {
    add(one.place, STEP, one.velocity);
    add(two.place, STEP, two.velocity);
    Vector normal = two.place;
    add(normal, -1, one.place);
    const double apart = std::sqrt(dot(normal, normal)), overlap = 2 * RADIUS - apart;
    if (overlap <= 0 && touched) return;
    if (overlap <= 0) continue;
    touched = true;
    for (double &part : normal) part /= apart;

    Vector slip = one.velocity, spins = one.spin;
    add(spins, 1, two.spin);
    add(slip, -1, two.velocity);
    add(slip, RADIUS, cross(spins, normal));
    turn(state, normal, 0.5 * dot(spins, normal) * STEP);
    const double radius = std::sqrt(0.5 * RADIUS * overlap), load = 4.0 / 3.0 * stiff * radius * overlap;
    float moved[3], along[3];
    for (int k = 0; k < 3; ++k) moved[k] = float(slip[k] * STEP), along[k] = float(normal[k]);
    contactlab_springs_step(state, SPRINGS, moved, along, float(radius), float(FRICTION * load), float(RADIUS),
                            float(4 * shear / (2 - POISSON)), force);

    const Vector friction{force[0], force[1], force[2]};
    for (Sphere *ball : {&one, &two}) {
      const double sense = ball == &one ? 1 : -1;
      add(ball->velocity, sense * STEP / mass, friction);
      add(ball->velocity, -sense * STEP * load / mass, normal);
      add(ball->spin, RADIUS * STEP / inertia, cross(normal, friction));
    }
  }
}

int main()
{
  const double kappa = 2 * (1 - POISSON) / (2 - POISSON);
  const Vector normal{0.6, 0, 0.8}, along{0.8, 0, -0.6};
  for (int degrees = 5; degrees < 60; degrees += 5) {
    const double slip = SPEED * std::tan(degrees * M_PI / 180), scale = kappa / (FRICTION * SPEED);
    Sphere one{}, two{};
    add(two.place, 2 * RADIUS, normal);
    add(one.velocity, SPEED, normal);
    add(one.velocity, slip, along);
    add(one.spin, 3, normal);
    meet(one, two);
    Vector after = one.velocity, spins = one.spin;
    add(spins, 1, two.spin);
    add(after, -1, two.velocity);
    add(after, RADIUS, cross(spins, normal));
    std::printf("%d %.4f %.4f\n", degrees, slip * scale, dot(after, along) * scale);
  }
}

// Convergence of the rigid solver within one step, by number of colours. Begin at measure().
//
// A settling pile, a pyramid and a stack are frozen, and one step is solved with more and more
// sweeps. The printed error is the distance of the velocities from those of 16,384 coloured sweeps,
// in the norm of kinetic energy, divided by the distance without any contact. See
// docs/decisions/022-mass-splitting-and-lanes.md.
//
//   solver_bench convergence [--csv]
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/piles.h"
#include "bench/solver/solver_bench.h"
#include "solver/rigid/rigid_physics.h"
#include "tests/fixtures/flags.h"

namespace sunder::solver {
namespace {

using bench::Pile;

constexpr double kDt_s = 1.0 / 60;
constexpr int kColors[] = {0, 8, 64};
constexpr int kSweeps[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024};
constexpr int kReferenceSweeps = 16384;

struct World {
  std::unique_ptr<Physics> physics;
  std::vector<BodyId> ids;
};

World make_world(const Pile& set, int colors, int sweeps) {
  RigidOptions options;
  options.sleeping = false;
  options.max_colors = colors;
  options.sweeps = sweeps;
  options.accelerated = false;
  World world;
  world.physics = make_rigid_physics(options);
  world.ids = world.physics->replace({}, set.bodies);
  return world;
}

/// Replaces poses and velocities of the pile by those after `time_s` of simulation.
void freeze(Pile& set, double time_s) {
  World world = make_world(set, 64, 1);
  for (int i = 0; i < time_s / kDt_s; ++i) {
    world.physics->collide(kDt_s);
    world.physics->solve(kDt_s, 4);
  }
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    const BodyState state = world.physics->state(world.ids[i]);
    set.bodies[i].X_WB = state.X_WB;
    set.bodies[i].velocity_W = state.velocity_W;
    set.bodies[i].angular_velocity_W = state.angular_velocity_W;
  }
}

/// Appends a body's velocities, scaled so that the sum of their squares is twice its kinetic
/// energy.
void add_scaled(const BodyDesc& body, const Quat& rotation_WB, const Vec3& velocity_W,
                const Vec3& angular_velocity_W, std::vector<double>& all) {
  const Vec3 linear = std::sqrt(body.mass_kg) * velocity_W;
  const Vec3 spin_B = rotation_WB.conjugate() * angular_velocity_W;
  const Vec3 angular = body.inertia_B.diagonal().cwiseSqrt().cwiseProduct(spin_B);
  for (const Vec3& part : {linear, angular}) all.insert(all.end(), part.begin(), part.end());
}

/// Returns the scaled velocities of all dynamic bodies after one step.
std::vector<double> solve_step(const Pile& set, int colors, int sweeps) {
  World world = make_world(set, colors, sweeps);
  world.physics->collide(kDt_s);
  world.physics->solve(kDt_s, 1);
  std::vector<double> all;
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    if (set.bodies[i].is_static) continue;
    const BodyState state = world.physics->state(world.ids[i]);
    add_scaled(set.bodies[i], state.X_WB.rotation, state.velocity_W, state.angular_velocity_W, all);
  }
  return all;
}

/// Returns the scaled velocities of all dynamic bodies after one step of free fall.
std::vector<double> free_fall(const Pile& set) {
  std::vector<double> all;
  for (const BodyDesc& body : set.bodies) {
    if (body.is_static) continue;
    add_scaled(body, body.X_WB.rotation, body.velocity_W - Vec3(0, 9.81 * kDt_s, 0),
               body.angular_velocity_W, all);
  }
  return all;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

void measure(const char* name, Pile set, double time_s, double friction, bool csv) {
  for (BodyDesc& body : set.bodies)
    for (ShapeDesc& shape : body.shapes) shape.friction = friction;
  freeze(set, time_s);
  const std::vector<double> reference = solve_step(set, 64, kReferenceSweeps);
  const double no_contact = distance(free_fall(set), reference);
  if (!csv) std::printf("\n%s, friction %.1f\n%8s", name, friction, "sweeps");
  for (const int colors : kColors)
    if (!csv) std::printf("     K = %-2d", colors);
  if (!csv) std::printf("\n");
  for (const int sweeps : kSweeps) {
    if (csv) std::printf("%s,%g,%d", name, friction, sweeps);
    if (!csv) std::printf("%8d", sweeps);
    for (const int colors : kColors)
      std::printf(csv ? ",%.3e" : "  %9.2e",
                  distance(solve_step(set, colors, sweeps), reference) / no_contact);
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunder::solver

int sunder::bench::measure_convergence(int argc, char** argv) {
  bool csv = false;
  if (!read_flags(argc, argv, {{"--csv", &csv}})) return kUsageError;
  if (csv) std::printf("scene,friction,sweeps,k0,k8,k64\n");
  for (const double friction : {0.0, 0.6}) {
    solver::measure("rubble of 150", rubble(150), 0.9, friction, csv);
    solver::measure("pyramid of 55", pyramid(10), 0, friction, csv);
    solver::measure("stack of 10", stack(10), 0, friction, csv);
  }
  return 0;
}

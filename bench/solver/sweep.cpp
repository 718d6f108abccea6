// Timing of one sweep over the contacts, compared with reading and writing the same bytes once, and
// timing of contact colouring. Begin at run().
//
//   solver_bench sweep [--sides A,B,...] [--colors N] [--growth]
//
// With --growth, the program prints the cost per contact point of a sweep and of a step as the
// number of bodies grows.
//
// A sweep is timed as the difference between steps with few and with many sweeps, each the best of
// several, so that other load on the machine matters little. The bytes of a sweep are the front of
// every constraint block, and velocity and position of every body.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <sstream>
#include <string>
#include <vector>

#include "bench/piles.h"
#include "bench/solver/solver_bench.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/constraint_block.h"
#include "solver/rigid/rigid_physics.h"
#include "tests/fixtures/flags.h"

namespace sunder::solver {
namespace {

using bench::Pile;
using bench::touching_cubes;

constexpr double kSweepDt_s = 1.0 / 60;
constexpr double kRestDt_s = 1.0 / 480;  // short enough for columns of 46 cubes to stand
constexpr int kMoreSweeps = 10, kTries = 7, kSteps = 6, kStepSubsteps = 4;

/// Returns the thread's processor time, which other load changes least; wall time with more
/// threads.
double now_ms() {
  if (threads() > 1) {
    const auto t = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(t).count();
  }
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Timed {
  std::unique_ptr<Physics> physics;
  double best_ms = 1e30;
  SolveReport report;

  Timed(const Pile& set, int colors, int lanes, int sweeps) {
    RigidOptions options;
    options.sleeping = false;
    options.max_colors = colors;
    options.lanes = lanes;
    options.sweeps = sweeps;
    options.accelerated = false;
    physics = make_rigid_physics(options);
    physics->replace({}, set.bodies);
    physics->collide(kSweepDt_s);
  }
  void solve() {
    const double start = now_ms();
    report = physics->solve(kSweepDt_s, 1);
    best_ms = std::min(best_ms, now_ms() - start);
  }
};

/// Returns the milliseconds to read and write `bytes` once, the best of several passes over an
/// array that is reused, as a sweep reuses its contacts.
double stream_ms(std::size_t bytes) {
  std::vector<float> data(bytes / sizeof(float), 1.f);
  float* const first = data.data();
  const auto size = static_cast<std::ptrdiff_t>(data.size());
  const std::size_t chunk = 1 << 15;
  double best = 1e30;
  for (int i = 0; i < 3 * kTries; ++i) {
    const double start = now_ms();
    for_chunks(static_cast<std::size_t>(size), chunk,
               [&](std::size_t begin, std::size_t end, std::size_t) {
                 for (std::size_t k = begin; k < end; ++k) first[k] = first[k] * 0.5f + 1.f;
               });
    best = std::min(best, now_ms() - start);
  }
  return best;
}

template <std::uint32_t lanes>
double bytes_of(const SolveReport& report, std::size_t bodies) {
  const std::size_t front = offsetof(ConstraintBlock<lanes>, point);
  return static_cast<double>(report.contacts) * static_cast<double>(front) / lanes +
         static_cast<double>(report.contact_points) * sizeof(PointLanes<lanes>) / lanes +
         static_cast<double>(bodies) * 64;
}

double bytes_of(const SolveReport& report, std::size_t bodies, int lanes) {
  return lanes == 16  ? bytes_of<16>(report, bodies)
         : lanes == 8 ? bytes_of<8>(report, bodies)
         : lanes == 4 ? bytes_of<4>(report, bodies)
                      : bytes_of<1>(report, bodies);
}

/// Time and bytes of one sweep, and the report of the step.
struct SweepTime {
  double ms = 0, bytes = 0;
  SolveReport report;
};

SweepTime time_sweep(const Pile& set, int colors, int lanes) {
  Timed few(set, colors, lanes, 1), many(set, colors, lanes, 1 + kMoreSweeps);
  for (int i = 0; i < kTries; ++i) few.solve(), many.solve();
  return {(many.best_ms - few.best_ms) / (2 * kMoreSweeps),
          bytes_of(few.report, set.bodies.size() - 1, lanes), few.report};
}

void sweep(const Pile& set, int colors, int lanes, int thread_count) {
  set_threads(thread_count);
  const SweepTime swept = time_sweep(set, colors, lanes);
  const double stream = stream_ms(static_cast<std::size_t>(swept.bytes));
  const double points = swept.report.contact_points;
  std::printf("%8zu %9.0f %6d %8d %9.3f %9.2f %10.2f %12.2f %7.1f %9.0f\n", set.bodies.size() - 1,
              points, lanes, thread_count, swept.ms, 1e6 * swept.ms / points, swept.bytes / 1e6,
              1e6 * stream / points, swept.ms / stream, swept.bytes / points);
  std::fflush(stdout);
}

/// Nanoseconds per contact point of the parts of a step, the best of several, for resting cubes.
struct StepCost {
  double collide_ns = 1e30, solve_ns = 1e30;
  double points = 0;  ///< Contact points of the last step.
};

StepCost time_steps(const Pile& set) {
  RigidOptions options;
  options.sleeping = false;
  const auto physics = make_rigid_physics(options);
  physics->replace({}, set.bodies);
  StepCost cost;
  for (int i = 0; i < kSteps; ++i) {
    const double start = now_ms();
    physics->collide(kRestDt_s);
    const double middle = now_ms();
    cost.points = physics->solve(kRestDt_s, kStepSubsteps).contact_points;
    cost.collide_ns = std::min(cost.collide_ns, 1e6 * (middle - start) / cost.points);
    cost.solve_ns = std::min(cost.solve_ns, 1e6 * (now_ms() - middle) / cost.points);
  }
  return cost;
}

/// Prints the cost per contact point as the number of bodies grows.
int growth(const std::vector<int>& sides) {
  set_threads(1);
  const int lanes = lanes_in_use(0);
  std::printf("touching cubes at rest, one thread, %d lanes, steps of %d substeps; ns a point\n",
              lanes, kStepSubsteps);
  std::printf("  bodies    points  megabytes   sweep  stream  times    step  collide   solve\n");
  for (const int side : sides) {
    const Pile set = touching_cubes(side);
    const SweepTime swept = time_sweep(set, kMaxColors, lanes);
    const double stream = stream_ms(static_cast<std::size_t>(swept.bytes));
    const double ns = 1e6 / swept.report.contact_points;
    const StepCost step = time_steps(set);
    std::printf("%8zu %9.0f %10.2f %7.2f %7.2f %6.2f %7.1f %8.1f %7.1f\n", set.bodies.size() - 1,
                step.points, swept.bytes / 1e6, ns * swept.ms, ns * stream, swept.ms / stream,
                step.collide_ns + step.solve_ns, step.collide_ns, step.solve_ns);
    std::fflush(stdout);
  }
  return 0;
}

/// Times colouring of the contacts of a grid of bodies, and removal and insertion of some of them.
void recolor() {
  constexpr std::uint32_t kSide = 26, kGone = 5000;
  Bodies bodies;
  bodies.motion.assign(kSide * kSide * kSide, Motion::kAwake);
  bodies.is_new.assign(bodies.motion.size(), 0);
  Contacts contacts;
  contacts.body_colors.assign(bodies.size(), 0);
  auto touch = [&](std::uint32_t a, std::uint32_t b) {
    Pair pair;
    pair.shape_a = ShapeSlot(a), pair.shape_b = ShapeSlot(b);
    pair.body_a = BodySlot(a), pair.body_b = BodySlot(b);
    contacts.add(pair);
  };
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (i % kSide + 1 < kSide) touch(i, i + 1);
    if (i / kSide % kSide + 1 < kSide) touch(i, i + kSide);
    if (i / kSide / kSide + 1 < kSide) touch(i, i + kSide * kSide);
  }
  auto insert = [&](PairSlot pair) {
    Manifold m;
    m.body_a = contacts.pairs[pair].body_a, m.body_b = contacts.pairs[pair].body_b, m.count = 4;
    contacts.add_manifold(pair, m, bodies);
  };
  const auto count = static_cast<std::uint32_t>(contacts.pairs.size());
  double all_ms = now_ms();
  for (const PairSlot pair : contacts.pairs.slots()) insert(pair);
  all_ms = now_ms() - all_ms;
  double out_ms = 1e30, in_ms = 1e30;
  Random random(1);
  for (int i = 0; i < kTries; ++i) {
    std::vector<PairSlot> gone;
    for (const PairSlot pair : contacts.pairs.slots())
      if (gone.size() < kGone && random.below(count / kGone) == 0) gone.push_back(pair);
    const double start = now_ms();
    for (const PairSlot pair : gone) contacts.remove_manifold(pair);
    const double middle = now_ms();
    for (const PairSlot pair : gone) insert(pair);
    out_ms = std::min(out_ms, middle - start), in_ms = std::min(in_ms, now_ms() - middle);
  }
  std::printf(
      "\ncolours: %u contacts made in %.2f ms; of them about %u removed in %.3f ms, "
      "put back in %.3f ms (with their manifolds, %zu bytes each)\n",
      count, all_ms, kGone, out_ms, in_ms, sizeof(Manifold));
}

int run(const std::vector<int>& sides, int colors) {
  std::printf("touching cubes, at most %d colours\n", colors);
  std::printf(
      "  bodies    points  lanes  threads  ms/sweep  ns/point  megabytes  stream ns/pt  "
      "times  bytes/pt\n");
  const int most = lanes_in_use(0);
  for (const int side : sides) {
    const Pile set = touching_cubes(side);
    for (const int lanes : {1, 4, 8, 16})
      if (lanes <= most) sweep(set, colors, lanes, 1);
    sweep(set, colors, most, 2);
  }
  recolor();
  return 0;
}

}  // namespace
}  // namespace sunder::solver

int sunder::bench::measure_sweep(int argc, char** argv) {
  std::string list;
  int colors = 64;
  bool grows = false;
  if (!read_flags(
          argc, argv,
          {{"--sides", &list, "A,B,..."}, {"--colors", &colors, "0..64"}, {"--growth", &grows}}))
    return kUsageError;
  std::vector<int> sides;
  std::stringstream words(list);
  for (std::string side; std::getline(words, side, ',');) sides.push_back(std::atoi(side.c_str()));
  if (grows) return solver::growth(sides.empty() ? std::vector{10, 14, 22, 31, 46} : sides);
  return solver::run(sides.empty() ? std::vector{10, 20, 46} : sides, colors);
}

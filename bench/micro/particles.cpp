// Timing of a step of debris and dust. Targets on 2 cores: 50,000 debris particles 4 ms; 20,000
// dust particles on a grid of 64 × 32 × 64 8 ms; no cost without dust.
//
// The argument is the number of threads; the column CPU is the processor time of all threads.
#include <algorithm>
#include <deque>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/trace.h"
#include "solver/particles/debris_and_dust.h"

namespace sunder {
namespace {

constexpr double kDt = 1.0 / 60;

/// Rubble of 800 boxes on and above a ground of 20 × 20 m; the fraction `moving` has a velocity.
struct Rubble {
  explicit Rubble(double moving) {
    Random random(4);
    for (std::uint32_t b = 0; b < 800; ++b) {
      const Vec3 half(random.uniform(0.1, 0.5), random.uniform(0.1, 0.4), random.uniform(0.1, 0.5));
      hulls.push_back(make_box(-half, half));
      ObstacleBody body;
      body.key = b;
      body.X_WB.position = Vec3(random.uniform(-8, 8), random.uniform(0, 4), random.uniform(-8, 8));
      body.X_WB.rotation =
          Quat(1, random.uniform(-0.4, 0.4), random.uniform(-1, 1), 0).normalized();
      body.moves = random.uniform() < moving;
      if (body.moves) body.velocity_W = 2 * random.direction();
      bodies.push_back(body);
      ObstacleShape shape;
      shape.body = b;
      shape.hull = &hulls.back();
      shape.box_R = {-half, half};
      shape.volume_m3 = 8 * half.prod();
      shapes.push_back(shape);
    }
  }
  Obstacles view() const { return {bodies, shapes, 0}; }

  std::deque<ConvexPolyhedron> hulls;
  std::vector<ObstacleBody> bodies;
  std::vector<ObstacleShape> shapes;
};

/// Emits `count` particles from 400 faces in the rubble.
void emit_particles(Particles& particles, std::uint32_t count, double debris_ratio) {
  Random random(8);
  for (int f = 0; f < 400; ++f) {
    const Vec3 at(random.uniform(-7, 7), random.uniform(0.5, 4), random.uniform(-7, 7));
    const std::vector<Vec3> corners = {at, at + Vec3(0, 0, 0.5), at + Vec3(0.5, 0, 0.5),
                                       at + Vec3(0.5, 0, 0)};
    ExposedPolygon face;
    face.corners_W = corners;
    face.motion = {at, 3 * random.direction(), Vec3::Zero()};
    face.crumbling.particles_per_m2 = count / (400 * 0.25);
    face.crumbling.debris_ratio = debris_ratio;
    particles.emit(std::span(&face, 1));
  }
}

std::unique_ptr<Particles> make_particles(benchmark::State& state) {
  set_threads(static_cast<int>(state.range(0)));
  solver::DebrisAndDustOptions options;
  options.limits = {60000, 30000};
  return solver::make_debris_and_dust(options);
}

/// Times steps and keeps their median and minimum, which other load changes little.
class Steps {
 public:
  void advance(Particles& particles, const Obstacles& obstacles) {
    const Stopwatch watch;
    particles.advance(kDt, obstacles);
    ms_.push_back(watch.ms());
  }
  double quickest_ms() const { return *std::min_element(ms_.begin(), ms_.end()); }
  double median_ms() {
    const auto middle = ms_.begin() + static_cast<std::ptrdiff_t>(ms_.size() / 2);
    std::nth_element(ms_.begin(), middle, ms_.end());
    return *middle;
  }

 private:
  std::vector<double> ms_;
};

void show(benchmark::State& state, Steps& steps, const Particles& particles) {
  const ParticleReport report = particles.report();
  state.counters["quickest_ms"] = steps.quickest_ms();
  state.counters["median_ms"] = steps.median_ms();
  state.counters["debris"] = report.debris.alive;
  state.counters["awake"] = report.debris.awake;
  state.counters["dust"] = report.dust.alive;
  state.counters["cells"] = report.air_cells;
  state.counters["iterations"] = report.air_iterations;
}

/// Times the first second of `count` particles in rubble, a quarter of which moves, after emission.
void run_first_second(benchmark::State& state, std::uint32_t count, double debris_ratio) {
  const Rubble rubble(0.25);
  auto particles = make_particles(state);
  Steps steps;
  int step = 60;
  for (auto _ : state) {
    if (step == 60) {
      state.PauseTiming();
      particles = make_particles(state);
      emit_particles(*particles, count, debris_ratio);
      if (debris_ratio == 0) particles->advance(kDt, rubble.view());
      step = 0;
      state.ResumeTiming();
    }
    steps.advance(*particles, rubble.view());
    ++step;
  }
  show(state, steps, *particles);
}

/// Times 50,000 debris particles that are all awake.
void debris_awake(benchmark::State& state) { run_first_second(state, 50000, 1); }

void debris_asleep(benchmark::State& state) {
  const Rubble rubble(0);
  auto particles = make_particles(state);
  Steps steps;
  emit_particles(*particles, 50000, 1);
  for (int step = 0; step < 600; ++step) particles->advance(kDt, rubble.view());
  for (auto _ : state) steps.advance(*particles, rubble.view());
  show(state, steps, *particles);
}

void dust(benchmark::State& state) { run_first_second(state, 20000, 0); }

void nothing(benchmark::State& state) {
  const Rubble rubble(0.25);
  auto particles = make_particles(state);
  Steps steps;
  for (auto _ : state) steps.advance(*particles, rubble.view());
  show(state, steps, *particles);
}

void configure(benchmark::internal::Benchmark* bench) {
  bench->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}
BENCHMARK(debris_awake)->Name("particles/debris_awake")->Apply(configure);
BENCHMARK(debris_asleep)->Name("particles/debris_asleep")->Apply(configure);
BENCHMARK(dust)->Name("particles/dust")->Apply(configure);
BENCHMARK(nothing)->Name("particles/nothing")->Apply(configure);

}  // namespace
}  // namespace sunder

// What a picture costs, pass by pass: N broken bricks in a heap, at 1280x720.
// The counters are milliseconds of processor time, a software driver's threads included: they mean
// the same on a busy machine.
#include <cstddef>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/model/compound.h"
#include "engine/model/piece_mesh.h"
#include "render/renderer.h"

namespace {

using namespace sunder;

/// A random convex of about `size_m`, half of whose faces are broken ones.
std::shared_ptr<const Mesh> make_chunk(double size_m, Random& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < 12; ++i) points.push_back(0.5 * size_m * random.direction());
  ConvexPolyhedron polyhedron = make_hull(points);
  for (std::size_t f = 0; f < polyhedron.faces.size(); f += 2) {
    polyhedron.faces[f].kind = FaceKind::kInterior;
  }
  const std::vector<std::uint8_t> none_hidden(polyhedron.faces.size());
  return make_mesh(*make_convex(std::move(polyhedron), MaterialIndex(0)), none_hidden);
}

Frame make_heap(int pieces) {
  Random random(1);
  auto meshes = std::make_shared<MeshStore>();
  Material brick;
  brick.surface = {Texture::kBrick, Vec3f(0.42f, 0.15f, 0.08f)};
  brick.interior = {Texture::kConcrete, Vec3f(0.45f, 0.18f, 0.1f)};
  Frame frame;
  for (int i = 0; i < pieces; ++i) {
    meshes->push_back(make_chunk(random.uniform(0.2, 0.7), random));
    FrameBody body;
    body.key = static_cast<std::uint64_t>(i);
    body.X_WB.position =
        Vec3(random.uniform(-6, 6), 4 * random.uniform() * random.uniform(), random.uniform(-4, 4));
    frame.bodies.push_back(body);
    frame.instances.push_back(
        {MeshIndex(static_cast<std::size_t>(i)), static_cast<std::uint32_t>(i)});
  }
  frame.materials = std::make_shared<const std::vector<Material>>(std::vector<Material>{brick});
  frame.meshes = meshes;
  frame.view.eye_W = Vec3(3, 3, 12);
  return frame;
}

void draw_heap(benchmark::State& state) {
  const Frame frame = make_heap(static_cast<int>(state.range(0)));
  render::Renderer renderer({.time_passes = true});
  renderer.draw(frame);  // compiles shaders, uploads meshes
  for (auto _ : state) {
    benchmark::DoNotOptimize(renderer.draw(frame));
    for (const render::PassTime& pass : renderer.pass_times()) {
      state.counters[pass.name] +=
          benchmark::Counter(pass.cpu_ms, benchmark::Counter::kAvgIterations);
    }
  }
  state.SetLabel(renderer.description());
}
BENCHMARK(draw_heap)->Arg(2000)->Arg(20000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

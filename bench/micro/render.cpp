// Timing of a picture at 1280x720, in total and by pass: a heap of broken bricks, the falling
// house, and smooth boulders with a million vertices in all.
//
// The counters are milliseconds of processor time, with the threads of a software driver, so that
// they can be compared on a busy machine.
#include <cmath>
#include <cstddef>
#include <exception>
#include <numbers>
#include <optional>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/io/frame_file.h"
#include "engine/model/compound.h"
#include "engine/model/piece_mesh.h"
#include "render/renderer.h"

namespace {

using namespace sunder;

/// Returns a random convex of about `size_m`; every second face is a fracture surface.
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

/// Returns a bumpy ball of `rows` x `rows` vertices that triangles share.
std::shared_ptr<const Mesh> make_boulder(std::uint32_t rows, double radius_m) {
  auto mesh = std::make_shared<Mesh>();
  const auto at = [&](double row, double column) {
    const SinCos height = sin_cos(std::numbers::pi * (row + 0.5) / rows);
    const SinCos around = sin_cos(2 * std::numbers::pi * column / rows);
    const Vec3 out(height.sin * around.cos, height.cos, height.sin * around.sin);
    const double bumps = sin_cos(9 * out.x()).sin * sin_cos(7 * out.y()).sin +
                         sin_cos(8 * out.z() + 3 * out.x()).sin;
    return Vec3(radius_m * (1 + 0.06 * bumps) * out);
  };
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < rows; ++column) {
      const Vec3 down = at(row + 0.01, column) - at(row - 0.01, column);
      const Vec3 along = at(row, column + 0.01) - at(row, column - 0.01);
      mesh->vertices.push_back({at(row, column).cast<float>(),
                                along.cross(down).normalized().cast<float>(), Mesh::kSurface});
      if (row == 0) continue;
      const std::uint32_t next = (column + 1) % rows;
      const std::uint32_t here = row * rows, above = here - rows;
      mesh->indices.insert(mesh->indices.end(), {above + column, above + next, here + column,
                                                 here + column, above + next, here + next});
    }
  }
  mesh->material = MaterialIndex(0);
  return mesh;
}

Frame make_boulders(int side, std::uint32_t rows) {
  auto meshes = std::make_shared<MeshStore>();
  meshes->push_back(make_boulder(rows, 0.6));
  Frame frame;
  for (int i = 0; i < side * side; ++i) {
    FrameBody body;
    body.key = static_cast<std::uint64_t>(i);
    body.X_WB.position = Vec3(1.2 * (i % side - 0.5 * side), 0.5, 1.2 * (i / side - 0.5 * side));
    frame.bodies.push_back(body);
    frame.instances.push_back({MeshIndex(0), static_cast<std::uint32_t>(i)});
  }
  Material stone;
  stone.surface = {Texture::kConcrete, Vec3f(0.42f, 0.4f, 0.38f)};
  frame.materials = std::make_shared<const std::vector<Material>>(std::vector<Material>{stone});
  frame.meshes = meshes;
  frame.view.eye_W = Vec3(3, 6, 11);
  return frame;
}

/// Times whole pictures, then passes in further pictures, because timing a pass waits for its end.
void draw(benchmark::State& state, const Frame& frame) {
  std::size_t vertices = 0;
  for (const Instance& instance : frame.instances) {
    vertices += (*frame.meshes)[instance.mesh.value]->vertices.size();
  }
  state.counters["instances"] = static_cast<double>(frame.instances.size());
  state.counters["vertices"] = static_cast<double>(vertices);
  std::optional<render::Renderer> made;
  try {
    made.emplace(render::RenderOptions{});
  } catch (const std::exception& error) {  // no driver
    state.SkipWithError(error.what());
    return;
  }
  render::Renderer& renderer = *made;
  renderer.draw(frame);  // compiles shaders and uploads meshes
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(frame));

  constexpr int kPictures = 5;
  render::Renderer timed({.time_passes = true});
  timed.draw(frame);
  for (int i = 0; i < kPictures; ++i) {
    timed.draw(frame);
    for (const render::PassTime& pass : timed.pass_times()) {
      state.counters[pass.name] += pass.cpu_ms / kPictures;
    }
  }
  state.SetLabel(renderer.description());
}

void draw_heap(benchmark::State& state) {
  draw(state, make_heap(static_cast<int>(state.range(0))));
}
BENCHMARK(draw_heap)
    ->Name("render/draw_heap")
    ->Arg(2000)
    ->Arg(20000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void draw_house(benchmark::State& state) {
  draw(state, *read_frame(SUNDER_ROOT "/tests/golden/house.frame"));
}
BENCHMARK(draw_house)->Name("render/draw_house")->Unit(benchmark::kMillisecond)->UseRealTime();

void draw_million_vertices(benchmark::State& state) { draw(state, make_boulders(8, 125)); }
BENCHMARK(draw_million_vertices)
    ->Name("render/draw_million_vertices")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

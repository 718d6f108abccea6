#include "engine/model/checks/scene_accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/geometry/bvh.h"

namespace sunder {
namespace {

constexpr double kSinkFactor = 1.55;  // penetration over load·g·h²; measured (docs/decisions/027)
constexpr double kTouchDistance = 0.02;  // distance over a body's size within which bodies touch
// least height difference of centres, over the smaller size, of bodies on each other
constexpr double kMinHeightDifference = 0.25;
// Buckling limits of a chain of blocks on rotational springs (docs/decisions/027), of size/N² in
// penetration. Close to the limit, buckling takes a minute.
constexpr double kBuckleSelf = 1.96, kBuckleLoaded = 0.62;
constexpr double kMaxSink = 0.02;  // largest penetration over a body's size for a stack to stand
// penetration over a body's size beyond which bodies may pass through each other
constexpr double kCrushSink = 0.5;
constexpr double kFrame_s = 1.0 / 60;
constexpr double kFloatEpsilon = std::numeric_limits<float>::epsilon();
// limit in engine/io/particle_codes.cpp: 2^22 steps of 1/128 m
constexpr double kMaxDebrisDistance_m = 32768;

/// A movable body, reduced to its box.
struct Block {
  std::string name;
  Box box;
  double height = 0;  ///< Height of its centre, against gravity.
  double mass_kg = 0;
  double size_m = 0;
  double slenderness_1_m = 0;  ///< Height over squared narrower width.
};

std::vector<Block> blocks_of(const Scene& scene, const Vec3& up) {
  Eigen::Index upward = 0;
  up.cwiseAbs().maxCoeff(&upward);
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const Solid& solid = scene.solids[i];
    if (solid.compound.is_anchored()) continue;
    Block block;
    block.name = name_or_index(solid.name, "solid", i);
    for (const ConvexPtr& convex : solid.compound.convexes)
      for (const Vec3& corner : convex->polyhedron.vertices) block.box.extend(solid.X_WR * corner);
    block.mass_kg = mass_of(solid.compound, scene.materials).mass_kg;
    blocks.push_back(block);
  }
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    const Vec3 reach = Vec3::Constant(ball.radius_m);
    Block block{name_or_index(ball.name, "ball", i),
                {ball.center_W - reach, ball.center_W + reach}};
    block.mass_kg = ball_mass_kg(ball, scene.materials);
    blocks.push_back(block);
  }
  for (Block& block : blocks) {
    block.height = block.box.center().dot(up);
    Vec3 width = block.box.extent();
    block.size_m = width.minCoeff();
    double& tall_m = width[upward];
    const double height_m = std::exchange(tall_m, std::numeric_limits<double>::infinity());
    block.slenderness_1_m = height_m / (width.minCoeff() * width.minCoeff());
  }
  return blocks;
}

/// Returns for each block the blocks below that it touches.
std::vector<std::vector<std::uint32_t>> supports(const std::vector<Block>& blocks) {
  std::vector<Box> boxes;
  for (const Block& block : blocks) boxes.push_back(block.box);
  const Bvh tree(boxes);
  std::vector<std::vector<std::uint32_t>> below(blocks.size());
  std::vector<std::uint32_t> hits;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Vec3 reach = Vec3::Constant(kTouchDistance * blocks[i].size_m);
    hits.clear();
    tree.overlaps({blocks[i].box.min - reach, blocks[i].box.max + reach}, hits);
    for (const std::uint32_t other : hits) {
      const double least = kMinHeightDifference * std::min(blocks[i].size_m, blocks[other].size_m);
      if (blocks[i].height > blocks[other].height + least) below[i].push_back(other);
    }
  }
  return below;
}

double buckling_sink_m(const Stack& stack) {
  const double n = stack.bodies;
  const double limit =
      (stack.load > 2 * n ? kBuckleLoaded : kBuckleSelf) / (n * stack.slenderness_1_m);
  return std::min(kMaxSink * stack.size_m, limit);
}

}  // namespace

Stacks find_stacks(const Scene& scene) {
  Stacks found;
  if (scene.gravity_W.isZero()) return found;
  const std::vector<Block> blocks = blocks_of(scene, -scene.gravity_W.normalized());
  if (blocks.empty()) return found;
  const auto below = supports(blocks);
  std::vector<std::uint32_t> order(blocks.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(
      order, [&](std::uint32_t a, std::uint32_t b) { return blocks[a].height > blocks[b].height; });
  std::vector<Stack> stacks(blocks.size());
  std::vector<double> carried_kg(blocks.size());
  double max_load = 0, max_stiffness = 0;
  for (const std::uint32_t i : order) {
    Stack& stack = stacks[i];
    ++stack.bodies;
    stack.size_m = stack.bodies > 1 ? std::min(stack.size_m, blocks[i].size_m) : blocks[i].size_m;
    stack.slenderness_1_m += blocks[i].slenderness_1_m;
    carried_kg[i] += blocks[i].mass_kg;
    stack.load = carried_kg[i] / blocks[i].mass_kg;
    if (stack.load > max_load) max_load = stack.load, found.deepest = stack;
    const double stiffness = stack.load / buckling_sink_m(stack);
    if (stiffness > max_stiffness) max_stiffness = stiffness, found.weakest = stack;
    for (const std::uint32_t lower : below[i]) {
      carried_kg[lower] += carried_kg[i] / static_cast<double>(below[i].size());
      if (stack.bodies > stacks[lower].bodies) stacks[lower] = stack;
    }
  }
  return found;
}

double expected_penetration_m(const Stack& stack, double gravity_m_s2, double h_s) {
  return kSinkFactor * stack.load * gravity_m_s2 * h_s * h_s;
}

int substeps_for_penetration(const Stack& stack, double gravity_m_s2, double dt_s,
                             double target_m) {
  const double sink_m = expected_penetration_m(stack, gravity_m_s2, dt_s);
  return std::max(1, static_cast<int>(std::ceil(std::min(1e6, std::sqrt(sink_m / target_m)))));
}

int substeps_against_buckling(const Stack& stack, double gravity_m_s2, double dt_s) {
  if (stack.bodies == 0) return 1;
  return substeps_for_penetration(stack, gravity_m_s2, dt_s, buckling_sink_m(stack));
}

Accuracy accuracy_against_buckling(const Scene& scene, int max_substeps) {
  const Accuracy& accuracy = scene.accuracy;
  const int all =
      substeps_against_buckling(find_stacks(scene).weakest, scene.gravity_W.norm(), accuracy.dt_s);
  return divide_step(accuracy, all, max_substeps);
}

Accuracy divide_step(Accuracy accuracy, int all, int max_substeps) {
  const int steps = (all + max_substeps - 1) / max_substeps;
  accuracy.dt_s /= steps;
  accuracy.substeps = (all + steps - 1) / steps;
  return accuracy;
}

std::string long_step_warning(const Scene& scene) {
  const double dt_s = scene.accuracy.dt_s;
  if (dt_s < 1.001 * kFrame_s) return {};
  char text[300];
  std::snprintf(
      text, sizeof text,
      "dt_s = %.4g s is longer than a frame (1/60 s) and than the step of any preset: stacks may "
      "collapse, and bodies penetrate each other; set accuracy.dt_s to 1/60 or less",
      dt_s);
  return text;
}

std::string far_warning(const Scene& scene) {
  std::string name;
  double farthest_m = kMaxDebrisDistance_m;
  const auto check_position = [&](const std::string& own_name, const char* kind, std::size_t index,
                                  const Vec3& position_W) {
    const double away_m = position_W.cwiseAbs().maxCoeff();
    if (away_m <= farthest_m) return;
    farthest_m = away_m;
    name = name_or_index(own_name, kind, index);
  };
  for (std::size_t i = 0; i < scene.solids.size(); ++i)
    check_position(scene.solids[i].name, "solid", i, scene.solids[i].X_WR.position);
  for (std::size_t i = 0; i < scene.balls.size(); ++i)
    check_position(scene.balls[i].name, "ball", i, scene.balls[i].center_W);
  for (std::size_t i = 0; i < scene.shots.size(); ++i)
    check_position(scene.shots[i].ball.name, "shot", i, scene.shots[i].ball.center_W);
  if (name.empty()) return {};
  char text[500];
  std::snprintf(text, sizeof text,
                "'%s' is %.4g m from the origin: bodies are not affected, but positions of debris "
                "and dust have a precision of only %.1g m, and recordings store debris only up to "
                "%.4g m; move the scene closer to the origin",
                name.c_str(), farthest_m, farthest_m * kFloatEpsilon, kMaxDebrisDistance_m);
  return text;
}

std::string crush_warning(const Scene& scene, int max_substeps) {
  if (scene.gravity_W.isZero()) return {};
  const Accuracy& accuracy = scene.accuracy;
  const std::vector<Block> blocks = blocks_of(scene, -scene.gravity_W.normalized());
  if (blocks.size() < 2) return {};
  const Block& heavy = *std::ranges::max_element(blocks, {}, &Block::mass_kg);
  // The body with the largest penetration over its size has the least mass times size.
  const Block& light = *std::ranges::min_element(
      blocks, {}, [](const Block& block) { return block.mass_kg * block.size_m; });
  const double ratio = heavy.mass_kg / light.mass_kg, g = scene.gravity_W.norm();
  const Stack pair{2, 1 + ratio, light.size_m};
  if (expected_penetration_m(pair, g, accuracy.dt_s / accuracy.substeps) < kCrushSink * pair.size_m)
    return {};
  const Accuracy sufficient = divide_step(
      accuracy, substeps_for_penetration(pair, g, accuracy.dt_s, kMaxSink * pair.size_m),
      max_substeps);
  char text[500];
  std::snprintf(text, sizeof text,
                "'%s' weighs %.4g times as much as '%s', and would sink into it if it came to rest "
                "on it: this needs %d substeps of dt 1/%.4g s, the scene has %d of 1/%.4g s; raise "
                "accuracy.substeps%s, or make the lighter one heavier",
                heavy.name.c_str(), ratio, light.name.c_str(), sufficient.substeps,
                1 / sufficient.dt_s, accuracy.substeps, 1 / accuracy.dt_s,
                sufficient.dt_s < accuracy.dt_s ? " and reduce accuracy.dt_s" : "");
  return text;
}

std::string accuracy_warning(const Scene& scene, int max_substeps) {
  const Accuracy& accuracy = scene.accuracy;
  const Stacks stacks = find_stacks(scene);
  const double g = scene.gravity_W.norm();
  char text[500];
  if (substeps_against_buckling(stacks.weakest, g, accuracy.dt_s) > accuracy.substeps) {
    const Accuracy sufficient = accuracy_against_buckling(scene, max_substeps);
    std::snprintf(text, sizeof text,
                  "a stack of %u %s, the lowest under %.4g times its own weight, may sink in "
                  "and buckle: it needs %d substeps of dt 1/%.4g s, the scene has %d of 1/%.4g s; "
                  "raise accuracy.substeps%s, or use a more accurate preset",
                  stacks.weakest.bodies, stacks.weakest.bodies == 1 ? "body" : "bodies",
                  stacks.weakest.load, sufficient.substeps, 1 / sufficient.dt_s, accuracy.substeps,
                  1 / accuracy.dt_s,
                  sufficient.dt_s < accuracy.dt_s ? " and reduce accuracy.dt_s" : "");
    return text;
  }
  const double sink_m =
      expected_penetration_m(stacks.deepest, g, accuracy.dt_s / accuracy.substeps);
  if (accuracy.error_target_m > 0 && sink_m > accuracy.error_target_m) {
    std::snprintf(text, sizeof text,
                  "error_target_m = %g cannot be reached with dt 1/%.4g s and %d substeps, the "
                  "maximum: expect a penetration of about %.2g m; reduce accuracy.dt_s",
                  accuracy.error_target_m, 1 / accuracy.dt_s, accuracy.substeps, sink_m);
    return text;
  }
  return {};
}

}  // namespace sunder

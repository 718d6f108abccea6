#include "scenes/solid_break.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/file_ending.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/fracture.h"
#include "fracture/vacd/vacd.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kEvent = 1;
/// Smallest volume of a brick of the pattern, as a fraction of the largest convex's volume.
constexpr double kMinBrickFraction = 1e-5;

/// A pattern "kind:sizes" while it is parsed.
struct Spec {
  const std::string& option;
  const std::string& text;
  std::vector<double> sizes;

  [[noreturn]] void refuse(const std::string& expected) const {
    throw InputError(option + " " + text + ": expected " + expected);
  }
  void need(bool right_count) const {
    if (!right_count) refuse(kPatternHelp);
  }
  double real(std::size_t i, double low, double high, const char* name,
              bool is_whole = false) const {
    if (sizes[i] < low || sizes[i] > high || (is_whole && sizes[i] != std::floor(sizes[i]))) {
      refuse(std::string(name) + " to be a " + (is_whole ? "whole " : "") + "number from " +
             format(low) + " to " + format(high));
    }
    return sizes[i];
  }
  int whole(std::size_t i, double low, double high, const char* name) const {
    return static_cast<int>(real(i, low, high, name, true));
  }
};

PatternSpec parse_built_in(const std::string& option, const std::string& text,
                           const std::string& kind) {
  using Kind = PatternSpec::Kind;
  const Spec spec{
      option, text,
      numbers_in(std::string_view(text).substr(kind.size() + 1), kind == "web" ? 'x' : ',')};
  const std::size_t count = spec.sizes.size();
  PatternSpec pattern;
  if (kind == "voronoi") {
    spec.need(count == 1 || count == 2);
    pattern.kind = Kind::kVoronoi;
    pattern.cells = spec.whole(0, 1, 5000, "N");
    if (count == 2) pattern.falloff = spec.real(1, 1, 10, "FALLOFF");
  } else if (kind == "web") {
    spec.need(count == 2);
    pattern.kind = Kind::kWeb;
    pattern.rings = spec.whole(0, 1, 100, "RINGS");
    pattern.spokes = spec.whole(1, 3, 200, "SPOKES");
  } else if (kind == "radial") {
    spec.need(count == 1);
    pattern.kind = Kind::kRadial;
    pattern.cells = spec.whole(0, 3, 200, "N");
  } else if (kind == "brick") {
    spec.need(count == 3);
    pattern.kind = Kind::kBrick;
    for (std::size_t i = 0; i < 3; ++i) {
      pattern.brick_m[static_cast<Eigen::Index>(i)] = spec.real(i, 1e-9, 1e9, "X, Y and Z");
    }
  } else if (kind == "slabs") {
    spec.need(count == 1);
    pattern.kind = Kind::kSlabs;
    pattern.cells = spec.whole(0, 1, 1000, "N");
  } else if (kind == "grid") {
    spec.need(count == 1);
    pattern.kind = Kind::kGrid;
    pattern.cells = spec.whole(0, 1, 30, "N");
  } else {
    spec.refuse(kPatternHelp);
  }
  return pattern;
}

/// Returns the stretch of a pattern that fits its extents to a solid that extends up to `reach`
/// from the impact along each axis. The pattern's axes are those of `rotation`.
Mat3 stretch_onto(const Vec3& reach, const Quat& rotation) {
  const Vec3 half_P = (rotation.conjugate() * reach).cwiseAbs();
  return Mat3((half_P / reach.norm()).asDiagonal());
}

/// Throws InputError for bricks so small that all their parts would be welded again.
void check_bricks(const SolidBreak& options, const Vec3& brick_m, const Compound& compound) {
  double largest_m3 = 0;
  for (const ConvexPtr& convex : compound.convexes) {
    largest_m3 = std::max(largest_m3, convex->solid.volume_m3);
  }
  if (brick_m.prod() >= kMinBrickFraction * largest_m3) return;
  throw InputError(options.name + ": the bricks are too small for this solid; give larger ones");
}

/// Applies the break of one island to its structure, and adds the result to the plan.
void collect(Structure& structure, BreakEdit edit, BreakPlan& plan) {
  BreakPlan& loose = edit.loose;
  plan.clip_ms += loose.clip_ms;
  plan.islands_ms += loose.islands_ms;
  plan.failed += loose.failed;
  plan.failed_m3 += loose.failed_m3;
  plan.welded += loose.welded;
  plan.debris_volume_m3 += loose.debris_volume_m3;
  plan.untouched += edit.changed ? loose.untouched : structure.size();
  if (edit.changed) structure.apply(edit);
  if (structure.size() > 0) plan.pieces.push_back(structure.compound());
  std::move(loose.pieces.begin(), loose.pieces.end(), std::back_inserter(plan.pieces));
}

std::vector<Structure> structures_of(const Compound& compound) {
  std::vector<Structure> structures;
  for (const Compound& part : fracture::split_islands(compound)) structures.emplace_back(part);
  return structures;
}

fracture::PreparedBreak prepare(const BreakCommand& command, const Compound& compound) {
  fracture::PatternLibrary library;
  return fracture::prepare_break(command, bounds(compound), library);
}

}  // namespace

std::vector<double> numbers_in(std::string_view text, char between) {
  std::vector<double> found;
  for (bool more = true; more;) {
    const std::size_t end = std::min(text.find(between), text.size());
    more = end < text.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + end, number);
    if (error != std::errc() || stop != text.data() + end || !std::isfinite(number)) return {};
    found.push_back(number);
    text.remove_prefix(more ? end + 1 : end);
  }
  return found;
}

PatternSpec parse_pattern(const std::string& text, const std::string& option) {
  if (has_ending(text, ".obj") || std::filesystem::is_regular_file(text)) {
    PatternSpec pattern;
    pattern.kind = PatternSpec::Kind::kFile;
    pattern.file = text;
    return pattern;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw InputError(option + " " + text + ": expected " + kPatternHelp);
  }
  return parse_built_in(option, text, text.substr(0, colon));
}

BreakCommand break_command(const Compound& compound, const SolidBreak& options) {
  const Box box = bounds(compound);
  Material material;
  material.pattern = options.pattern;
  material.impact_radius_m = options.radius_m.value_or(kInfinity);
  StructureImpact hit;
  hit.point_R = options.at_R.value_or(box.center());
  const Vec3 inward = box.center() - hit.point_R;
  hit.direction_R =
      inward.norm() > 1e-9 * box.extent().norm() ? inward.normalized() : Vec3(-Vec3::UnitY());
  double nearest = kInfinity;
  std::size_t nearest_convex = 0;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    const double distance = (compound.convexes[c]->solid.centroid - hit.point_R).norm();
    if (distance < nearest) nearest_convex = c;
    nearest = std::min(nearest, distance);
  }
  hit.convex = ConvexSlot(nearest_convex);
  const Vec3 reach =
      (box.max - hit.point_R).cwiseAbs().cwiseMax((box.min - hit.point_R).cwiseAbs());
  if (material.pattern.kind == PatternSpec::Kind::kBrick) {
    check_bricks(options, material.pattern.brick_m, compound);
  }
  std::size_t count = 1;  // materials that the convexes may name, all of which break alike
  for (const ConvexPtr& convex : compound.convexes) {
    count = std::max(count, std::size_t{convex->material.value} + 1);
  }
  const std::vector<Material> materials(count, material);
  const auto breaker = fracture::make_pattern_breaker();
  BreakCommand command =
      breaker->command(*compound.convexes[nearest_convex], materials, hit, kEvent, options.seed);
  using Kind = PatternSpec::Kind;
  const Kind kind = material.pattern.kind;
  if (!options.radius_m &&
      (kind == Kind::kVoronoi || kind == Kind::kGrid || kind == Kind::kSlabs)) {
    if (kind == Kind::kVoronoi) command.X_RP.rotation = Quat::Identity();
    command.stretch_P = stretch_onto(reach, command.X_RP.rotation);
  }
  return command;
}

PreparedSolidBreak::PreparedSolidBreak(const Compound& compound, const BreakCommand& command)
    : structures_(structures_of(compound)),
      ready_(prepare(command, compound)),
      event_(command.event) {}

std::vector<BreakEdit> PreparedSolidBreak::plan() const {
  constexpr std::size_t kManyParts = 16;
  std::vector<BreakEdit> edits(structures_.size());
  const auto break_part = [&](std::size_t i) {
    edits[i] = fracture::break_structure(structures_[i], *ready_.pattern, ready_.placement,
                                         ready_.sphere, event_);
  };
  if (structures_.size() >= kManyParts) {  // many are small: in parallel, each by one thread
    for_chunks(structures_.size(), 1,
               [&](std::size_t i, std::size_t, std::size_t) { break_part(i); });
  } else {
    for (std::size_t i = 0; i < structures_.size(); ++i) break_part(i);
  }
  return edits;
}

BreakPlan PreparedSolidBreak::apply(std::vector<BreakEdit> edits) && {
  BreakPlan plan;
  for (std::size_t i = 0; i < edits.size(); ++i) collect(structures_[i], std::move(edits[i]), plan);
  return plan;
}

std::optional<std::uint32_t> NodeRetries::next(double failed_fraction) {
  constexpr double kMaxFailedFraction = 1e-4;  // of the volume
  constexpr int kMaxRetries = 2;
  if (failed_fraction <= kMaxFailedFraction || retries_ == kMaxRetries) return std::nullopt;
  ++retries_;
  nodes_ = std::min<std::size_t>(2 * nodes_, fracture::kMostNodes);
  return static_cast<std::uint32_t>(nodes_);
}

}  // namespace sunder::scenes

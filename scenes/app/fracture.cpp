// sunder fracture: breaks one solid once, and measures all quantities that a break must conserve.
//
// Read first: fracture_mesh(), then carry_out().
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/io/figures.h"
#include "engine/io/file_ending.h"
#include "engine/io/statistics.h"
#include "fracture/check/audit.h"
#include "fracture/check/case_file.h"
#include "scenes/app/arguments.h"
#include "scenes/app/commands.h"
#include "scenes/app/mesh_report.h"
#include "scenes/app/work_progress.h"
#include "scenes/file/text_file.h"
#include "scenes/solid_break.h"

namespace sunder::app {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A break is timed at most kMaxTimings times, and no more after kEnoughTime_ms in all.
constexpr int kMaxTimings = 20;
constexpr double kEnoughTime_ms = 200;

/// The result of a break.
struct Broken {
  fracture::Audit before, after;
  BreakPlan plan;
  std::optional<fracture::DoubleCountedVolume>
      double_counted;  ///< Volume that overlaps count twice.
  double prepare_ms = 0;
  double total_ms = 0;
};

/// Returns the break that the options describe.
BreakCommand command_of(const FractureOptions& options, const scenes::MeshSolid& mesh) {
  scenes::SolidBreak solid;
  solid.name = "--pattern " + options.pattern;
  solid.pattern = scenes::parse_pattern(options.pattern, "--pattern");
  if (!options.at.empty()) solid.at_R = parse_point("--at", options.at) - mesh.origin;
  solid.radius_m = options.radius_m;
  solid.seed = options.seed;
  return scenes::break_command(mesh.compound, solid);
}

/// Estimated fractions of all work after preparation of the mesh, and after the break.
constexpr double kMeshShare = 0.7, kBrokenShare = 0.9;

/// Carries out the break several times for the fastest: caches are cold in the first.
Broken carry_out(const Compound& compound, const BreakCommand& command, WorkProgress& progress) {
  progress("breaking", kMeshShare);
  Broken broken;
  Stopwatch watch;
  scenes::PreparedSolidBreak ready(compound, command);
  broken.prepare_ms = watch.ms();

  std::vector<BreakEdit> edits;
  const Stopwatch all;
  broken.total_ms = kInfinity;
  for (int time = 0; time < kMaxTimings && (time < 2 || all.ms() < kEnoughTime_ms); ++time) {
    watch.lap_ms();
    std::vector<BreakEdit> again = ready.plan();
    if (watch.ms() >= broken.total_ms) continue;
    broken.total_ms = watch.ms();
    edits = std::move(again);
  }
  broken.plan = std::move(ready).apply(std::move(edits));
  progress("measuring", kBrokenShare);
  broken.double_counted = fracture::double_counted_volume(compound);
  broken.before = fracture::audit(std::span(&compound, 1));
  broken.after = fracture::audit(broken.plan.pieces);
  return broken;
}

double volume_error(const Broken& broken) {
  const double out = broken.after.volume_m3 + broken.plan.debris_volume_m3;
  return std::abs(out - broken.before.volume_m3) / broken.before.volume_m3;
}

std::int64_t whole(std::size_t count) { return static_cast<std::int64_t>(count); }

Figures figures_of(const scenes::MeshSolid& solid, double scale, const Broken& broken) {
  Figures figures = input_figures(solid, scale);
  const fracture::Audit& after = broken.after;
  figures["/pieces"] = whole(after.pieces);
  figures["/convexes"] = whole(after.convexes);
  figures["/islands"] = whole(after.islands);
  figures["/welded"] = whole(broken.plan.welded);
  figures["/failed"] = whole(broken.plan.failed);
  figures["/failed_volume_m3"] = broken.plan.failed_m3;
  figures["/volume_in_m3"] = broken.before.volume_m3;
  add_doubled(broken.double_counted, figures);
  figures["/volume_out_m3"] = after.volume_m3;
  figures["/debris_volume_m3"] = broken.plan.debris_volume_m3;
  figures["/volume_error"] = volume_error(broken);
  figures["/watertight_pieces"] = whole(after.watertight_pieces);
  add_faults(after.surface, figures);
  figures["/walled_pieces"] = whole(after.walled_pieces);
  figures["/negative_volumes"] = whole(after.negative_volumes);
  figures["/overlap_volume_m3"] = after.overlap_m3;
  figures["/overlap_method"] = std::string(after.overlap_is_exact ? "exact" : "upper bound");
  figures["/untouched_convexes"] = whole(broken.plan.untouched);
  figures["/prepare_ms"] = solid.prepare_ms + broken.prepare_ms;
  figures["/clip_ms"] = broken.plan.clip_ms;
  figures["/islands_ms"] = broken.plan.islands_ms;
  figures["/total_ms"] = broken.total_ms;
  return figures;
}

std::string summary(const scenes::MeshSolid& solid, double scale, const Broken& broken) {
  const fracture::Audit& after = broken.after;
  char text[600];
  std::snprintf(
      text, sizeof text,
      "pieces   %zu of %zu convexes, %zu watertight; %u convexes untouched, %u cells welded\n"
      "volume   %.9g m³ became %.9g m³, an error of %.2g; pieces overlap by %.3g m³\n"
      "time     prepared in %.2f ms; the break took %.3f ms (cutting %.3f, islands %.3f)\n",
      after.pieces, after.convexes, after.watertight_pieces, broken.plan.untouched,
      broken.plan.welded, broken.before.volume_m3, after.volume_m3 + broken.plan.debris_volume_m3,
      volume_error(broken), after.overlap_m3, solid.prepare_ms + broken.prepare_ms, broken.total_ms,
      broken.plan.clip_ms, broken.plan.islands_ms);
  return input_summary(solid, scale) + text + doubled_summary(broken.double_counted);
}

/// A solid, its break, and the result.
struct Attempt {
  scenes::MeshSolid solid;
  std::vector<Appearance> appearances;
  fracture::BreakCase example;
  Broken broken;

  /// Returns the fraction of the volume in convexes that were left whole as they failed to break.
  double failed_fraction() const { return broken.plan.failed_m3 / broken.before.volume_m3; }
};

fracture::BreakCase case_of(const FractureOptions& options, const scenes::MeshOptions& solid_of,
                            Attempt& attempt, WorkProgress& progress) {
  if (!has_ending(options.mesh, ".case")) {
    if (options.pattern.empty()) {
      throw InputError("--pattern is missing: " + std::string(scenes::kPatternHelp));
    }
    scenes::parse_pattern(options.pattern,
                          "--pattern");  // finds errors before work that may take long
    scenes::MeshOptions mesh = solid_of;
    mesh.appearances = &attempt.appearances;
    mesh.progress = [&](const char* step, double share) { progress(step, kMeshShare * share); };
    attempt.solid = scenes::make_mesh_solid(options.mesh, mesh);
    return {attempt.solid.compound, command_of(options, attempt.solid)};
  }
  if (!options.pattern.empty() || !options.at.empty() || options.radius_m) {
    throw InputError(options.mesh +
                     ": a case file contains the break; remove --pattern, --at and --radius");
  }
  std::istringstream text(scenes::read_text(options.mesh, file_kinds::kCase));
  fracture::BreakCase example = fracture::read_case(text, options.mesh);
  attempt.solid = scenes::as_mesh_solid(options.mesh, example.compound);
  return example;
}

Attempt attempt_with(const FractureOptions& options, const scenes::MeshOptions& solid_of,
                     WorkProgress& progress) {
  Attempt attempt;
  attempt.example = case_of(options, solid_of, attempt, progress);
  attempt.broken = carry_out(attempt.example.compound, attempt.example.command, progress);
  return attempt;
}

/// Breaks the solid. If too much of a mesh is left whole, decomposes it again with more nodes, as
/// less volume fails with a smaller convex. Returns the attempt that leaves the least volume whole.
Attempt break_with_retries(const FractureOptions& options, WorkProgress& progress) {
  Attempt best = attempt_with(options, options.solid, progress);
  // Nodes from a file and a given number of convexes are not changed.
  const bool may_have_more = best.solid.vacd && options.solid.convexes == 0 &&
                             scenes::vacd_options(options.solid).nodes.empty();
  scenes::NodeRetries retries(best.solid.compound.convexes.size());
  while (may_have_more) {
    const std::optional<std::uint32_t> nodes = retries.next(best.failed_fraction());
    if (!nodes) break;
    scenes::MeshOptions more = options.solid;
    more.nodes = std::to_string(*nodes);
    Attempt next = attempt_with(options, more, progress);
    if (next.broken.plan.failed_m3 < best.broken.plan.failed_m3) best = std::move(next);
  }
  return best;
}

}  // namespace

int fracture_mesh(const FractureOptions& options) {
  options.apply();
  check_output(options.output);
  std::optional<WorkProgress> progress(std::in_place, options.mesh, options.quiet);
  Attempt attempt = break_with_retries(options, *progress);
  auto& [solid, appearances, example, broken] = attempt;
  progress.reset();
  if (const BreakPlan& plan = broken.plan; plan.failed > 0)
    solid.warnings.push_back(
        uncut_convexes_warning(plan.failed, plan.failed_m3, broken.before.volume_m3) +
        "; more --nodes may help");
  options.print(summary(solid, options.solid.scale, broken));
  if (!options.output.empty()) {
    const std::size_t walled =
        write_solids(options.output, broken.plan.pieces, stone(), appearances, options.explode,
                     options.walls == "keep" ? Walls::kKeep : Walls::kRemove, solid.origin);
    options.print("wrote " + options.output + "\n");
    if (walled > 0) {
      solid.warnings.push_back(
          "inner walls are kept in " + std::to_string(walled) +
          " pieces, whose surfaces would be open without them; other --nodes may help");
    }
  }
  print_warnings(solid);
  options.write_json(format_figures(figures_of(solid, options.solid.scale, broken)));
  return 0;
}

}  // namespace sunder::app

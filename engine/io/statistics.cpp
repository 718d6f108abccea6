#include "engine/io/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/base/archive.h"
#include "engine/base/printed.h"
#include "engine/model/work_log.h"

namespace sunder {

using Json = nlohmann::ordered_json;

struct Statistics::Series {
  RunInfo info;
  std::vector<FrameReport> reports;  ///< Reports of frames 1, 2, …; without penetrations.
  FrameReport first, last;
  LimitsHit limits;              ///< Of all frames, the first included.
  std::uint32_t limits_hit = 0;  ///< Of all frames, the first included.
  std::vector<double> fracture_ms;
  /// For each element of `reports`, index of its first element of `fracture_ms`.
  std::vector<std::size_t> first_fracture;
  std::uint64_t pieces = 0;
  std::uint64_t frames = 0;
  std::set<std::string> part_names;  ///< WorkItem::name of reports that were read.

  /// Selects wall time or processor time.
  using Clock = double (FrameReport::*)[kStages];
  std::vector<double> stage_ms(int stage, Clock clock = &FrameReport::stage_ms) const {
    std::vector<double> values;
    for (const FrameReport& report : reports) values.push_back((report.*clock)[stage]);
    return values;
  }
  std::vector<double> frame_ms(Clock clock = &FrameReport::stage_ms) const {
    std::vector<double> values;
    for (const FrameReport& report : reports) {
      const auto& ms = report.*clock;
      values.push_back(std::accumulate(ms, ms + kStages, 0.0));
    }
    return values;
  }
  std::vector<double> penetrations() const {
    return {last.penetrations_m.begin(), last.penetrations_m.end()};
  }
  /// Returns the fracture times of one element of `reports`.
  std::span<const double> fractures(std::size_t report) const {
    const std::size_t end =
        report + 1 < first_fracture.size() ? first_fracture[report + 1] : fracture_ms.size();
    return std::span(fracture_ms).subspan(first_fracture[report], end - first_fracture[report]);
  }
  double worst(double FrameReport::*figure) const {
    double most = 0;
    for (const FrameReport& report : reports) most = std::max(most, report.*figure);
    return most;
  }
  /// Totals of all frames: flows and residual, and sums of absolute values.
  struct Energy {
    EnergyFlows flows;
    double residual_J = 0, abs_residual_J = 0, moved_J = 0;
  };
  Energy energy() const {
    Energy all;
    for (const FrameReport& report : reports) {
      all.flows += report.energy;
      all.residual_J += report.energy_residual_J;
      all.abs_residual_J += std::abs(report.energy_residual_J);
      all.moved_J += report.energy.moved();
    }
    return all;
  }
  template <class Number>
  Number sum(Number FrameReport::*figure) const {
    Number total = 0;
    for (const FrameReport& report : reports) total += report.*figure;
    return total;
  }
};

namespace {

constexpr std::size_t kBusiestFrames = 120;  // two seconds

/// Returns the 95th percentile of the two seconds for which it is largest.
double busiest_p95(const std::vector<double>& frame_ms) {
  if (frame_ms.size() <= kBusiestFrames) return quantile(frame_ms, 0.95);
  double worst = 0;
  for (std::size_t i = 0; i + kBusiestFrames <= frame_ms.size(); i += kBusiestFrames / 8) {
    const auto begin = frame_ms.begin() + static_cast<std::ptrdiff_t>(i);
    worst = std::max(worst, quantile({begin, begin + kBusiestFrames}, 0.95));
  }
  return worst;
}

constexpr std::pair<const char*, std::uint32_t Counts::*> kCounts[] = {
    {"bodies", &Counts::bodies},     {"awake", &Counts::awake},
    {"convexes", &Counts::convexes}, {"compounds", &Counts::compounds},
    {"contacts", &Counts::contacts}, {"debris", &Counts::debris},
    {"dust", &Counts::dust}};

Json counts_json(const Counts& counts) {
  Json json;
  for (const auto& [name, count] : kCounts) json[name] = counts.*count;
  return json;
}

Counts peak_of(const std::vector<FrameReport>& reports) {
  Counts peak;
  for (const FrameReport& report : reports) {
    for (const auto& [name, count] : kCounts) {
      peak.*count = std::max(peak.*count, report.counts.*count);
    }
  }
  return peak;
}

/// Returns the mean time of a frame in a stage with more threads.
Json loops_json(double stage_ms, const LoopTimes& loops, double frames) {
  const double serial_ms = stage_ms - loops.work_ms;
  Json json{{"work_ms", stage_ms / frames}, {"serial_ms", serial_ms / frames}};
  for (std::size_t i = 0; i < kLoopThreads.size(); ++i) {
    json["threads_ms"][std::to_string(kLoopThreads[i])] =
        (serial_ms + loops.threads_ms[i]) / frames;
  }
  json["span_ms"] = (serial_ms + loops.span_ms) / frames;
  return json;
}

/// Returns count, time, and time per item of work, by stage and name.
Json work_json(std::span<const WorkItem> items) {
  Json json = Json::object();
  for (const WorkItem& item : items) {
    Json& entry = json[kStageNames[static_cast<int>(item.stage)]][item.name];
    entry["count"] = item.count;
    if (item.ms <= 0) continue;
    entry["ms"] = item.ms;
    if (item.loops.work_ms > 0) entry["work_and_span"] = loops_json(item.ms, item.loops, 1);
    if (item.count > 0) entry["ns_each"] = 1e6 * item.ms / static_cast<double>(item.count);
  }
  return json;
}

/// Returns work and span of each stage and of the frame; null if loops were not counted.
Json work_and_span_json(std::span<const FrameReport> reports) {
  std::array<double, kStages> stage_ms = {};
  std::array<LoopTimes, kStages> loops;
  double all_ms = 0;
  LoopTimes all;
  for (const FrameReport& report : reports) {
    for (std::size_t s = 0; s < kStages; ++s) {
      stage_ms[s] += report.stage_ms[s], all_ms += report.stage_ms[s];
      loops[s] += report.stage_loops[s], all += report.stage_loops[s];
    }
  }
  if (all.work_ms == 0) return nullptr;
  Json json;
  const auto frames = static_cast<double>(reports.size());
  for (std::size_t s = 0; s < kStages; ++s)
    json[kStageNames[s]] = loops_json(stage_ms[s], loops[s], frames);
  json["frame"] = loops_json(all_ms, all, frames);
  return json;
}

/// Adds p50_ms and so on for a series of times, with `prefix` before each name.
void add_times(Json& json, const std::string& prefix, const std::vector<double>& ms) {
  json[prefix + "p50_ms"] = quantile(ms, 0.5);
  json[prefix + "p95_ms"] = quantile(ms, 0.95);
  json[prefix + "p99_ms"] = quantile(ms, 0.99);
  json[prefix + "max_ms"] = quantile(ms, 1);
  const double count = static_cast<double>(std::max<std::size_t>(1, ms.size()));
  json[prefix + "mean_ms"] = std::accumulate(ms.begin(), ms.end(), 0.0) / count;
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

Json energy_json(const EnergyFlows& energy, double residual_J) {
  Json json = Json::object();
  EnergyFlows::for_each(energy, [&](const char* name, double value, int) { json[name] = value; });
  json["residual"] = residual_J;
  return json;
}

Json limits_json(const LimitsHit& limits) {
  Json json = Json::object();
  limits.for_each([&](const LimitText& text, std::uint32_t count) { json[text.name] = count; });
  return json;
}

/// Returns the fractures of one frame; times only if there are any.
Json fractures_json(std::span<const double> ms) {
  Json json{{"events", ms.size()}};
  if (ms.empty()) return json;
  json["mean_ms"] = std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
  json["max_ms"] = *std::max_element(ms.begin(), ms.end());
  return json;
}

Json frame_json(const FrameReport& report, double ms, std::span<const double> fracture_ms) {
  Json stages, cpu;
  for (int s = 0; s < kStages; ++s) {
    stages[kStageNames[s]] = report.stage_ms[s];
    cpu[kStageNames[s]] = report.stage_cpu_ms[s];
  }
  return {{"ms", ms},
          {"stages_ms", stages},
          {"stages_cpu_ms", cpu},
          {"counts", counts_json(report.counts)},
          {"carried_over", report.carried_over},
          {"energy_flows_J", energy_json(report.energy, report.energy_residual_J)},
          {"fractures", fractures_json(fracture_ms)},
          {"friction_excess", ratio(report.friction_excess_Ns, report.friction_allowed_Ns)},
          {"kinetic_J", report.kinetic_J},
          {"momentum_residual", report.momentum_residual},
          {"plastic_J", report.plastic_J},
          {"potential_J", report.potential_J},
          {"work", work_json(report.work)}};
}

/// Writes or reads work items, whose names are kept in `names`.
void archive_work(Archive& bytes, std::vector<WorkItem>& items, std::set<std::string>& names) {
  std::uint64_t count = items.size();
  bytes(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (bytes.reads()) items.emplace_back();
    WorkItem& item = items[i];
    std::string name = item.name;
    bytes(item.stage, name, item.count, item.ms, item.loops);
    if (bytes.reads()) item.name = names.insert(name).first->c_str();
  }
}

}  // namespace

std::string uncut_convexes_warning(std::uint64_t convexes, double volume_m3, double of_m3) {
  return std::to_string(convexes) + (convexes == 1 ? " convex was" : " convexes were") +
         printed(" not cut, %.3g %% of the volume, because the volumes of ",
                 100 * ratio(volume_m3, of_m3)) +
         (convexes == 1 ? "its" : "their") + " parts did not match";
}

std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  std::string arm;  // which has numbers in place of a name
  for (std::string line; std::getline(in, line) && !line.empty();) {
    const std::string value = line.substr(std::min(line.find(':') + 2, line.size()));
    if (line.starts_with("model name")) return value;
    if (line.starts_with("CPU implementer")) arm = "ARM, implementer " + value;
    if (line.starts_with("CPU part")) arm += ", part " + value;
  }
  return arm.empty() ? "unknown" : arm;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const auto index = static_cast<std::ptrdiff_t>(std::max(0.0, rank - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

Statistics::Statistics(RunInfo info) : series_(std::make_unique<Series>()) {
  series_->info = std::move(info);
}

Statistics::~Statistics() = default;

void Statistics::take(const FramePtr& frame) {
  Series& series = *series_;
  if (series.frames++ == 0) {
    series.first = frame->report;
  } else {
    series.reports.push_back(frame->report);
    series.reports.back().penetrations_m = std::vector<float>();  // clear() would keep the memory
    series.first_fracture.push_back(series.fracture_ms.size());
  }
  series.last = frame->report;
  series.limits += frame->report.limits;
  series.limits_hit += frame->report.limits_hit;
  for (const BreakEvent& event : frame->breaks) {
    series.fracture_ms.push_back(event.plan_ms);
    series.pieces += event.pieces;
  }
}

const RunInfo& Statistics::info() const { return series_->info; }

std::string Statistics::limits_warning() const {
  return sunder::limits_warning(series_->limits, series_->limits_hit);
}

std::pair<std::uint64_t, double> Statistics::failed() const {
  return {series_->sum(&FrameReport::failed), series_->sum(&FrameReport::failed_m3)};
}

void archive(Archive& bytes, Statistics& statistics) {
  Statistics::Series& s = *statistics.series_;
  bytes(s.info.preset, s.reports, s.first, s.last, s.limits, s.limits_hit, s.fracture_ms,
        s.first_fracture, s.pieces, s.frames);
  for (FrameReport& report : s.reports) archive_work(bytes, report.work, s.part_names);
}

std::string limits_warning(const LimitsHit& limits, std::uint32_t hits) {
  std::string list;
  limits.for_each([&](const LimitText& text, std::uint32_t count) {
    if (text.by_design) return;
    list += std::string(list.empty() ? "" : "; ") + text.name + " " + std::to_string(count) +
            (count == 1 ? " time (" : " times (") + text.advice + ")";
  });
  if (!list.empty()) return "limits were reached, see docs/json.md for what each does: " + list;
  if (hits == 0) return "";
  return "limits were reached " + std::to_string(hits) + (hits == 1 ? " time" : " times") +
         "; simulate the scene again to see which";
}

std::string Statistics::json(const std::string& state_hash, bool per_frame) const {
  const Series& s = *series_;
  const std::vector<double> frame_ms = s.frame_ms();
  const double steps_per_frame = std::max(1.0, std::round(1 / (60 * s.info.accuracy.dt_s)));
  Json json{{"scene", s.info.scene},        {"preset", s.info.preset},
            {"threads", s.info.threads},    {"frames", s.reports.size()},
            {"dt_s", s.info.accuracy.dt_s}, {"substeps", s.info.accuracy.substeps}};
  json["solver"] = {{"max_colors", s.info.solver.max_colors},
                    {"sweeps", s.info.solver.sweeps},
                    {"lanes", s.info.solver.lanes}};
  if (!state_hash.empty()) json["state_hash"] = state_hash;
  json["steps"] = static_cast<std::uint64_t>(steps_per_frame) * s.reports.size();
  for (int i = 0; i < kStages; ++i) {
    Json& stage = json["stages"][kStageNames[i]];
    add_times(stage, "", s.stage_ms(i));
    add_times(stage, "cpu_", s.stage_ms(i, &FrameReport::stage_cpu_ms));
  }
  WorkLog work;
  for (const FrameReport& report : s.reports) {
    for (const WorkItem& item : report.work) work.add(item);
  }
  json["work"] = work_json(work.items());
  if (Json loops = work_and_span_json(s.reports); !loops.is_null())
    json["work_and_span"] = std::move(loops);
  Json& frame = json["frame"];
  add_times(frame, "", frame_ms);
  add_times(frame, "cpu_", s.frame_ms(&FrameReport::stage_cpu_ms));
  frame["busiest_2s_p95_ms"] = busiest_p95(frame_ms);
  json["counts"] = counts_json(s.last.counts);
  json["peak"] = counts_json(peak_of(s.reports));
  json["fractures"] = {{"events", s.fracture_ms.size()},
                       {"pieces", s.pieces},
                       {"p50_ms", quantile(s.fracture_ms, 0.5)},
                       {"p99_ms", quantile(s.fracture_ms, 0.99)},
                       {"max_ms", quantile(s.fracture_ms, 1)},
                       {"carried_over", s.sum(&FrameReport::carried_over)},
                       {"failed", s.sum(&FrameReport::failed)},
                       {"failed_volume_m3", s.sum(&FrameReport::failed_m3)}};
  const std::vector<double> depth = s.penetrations();
  json["penetration_m"] = {
      {"p50", quantile(depth, 0.5)}, {"p99", quantile(depth, 0.99)}, {"max", quantile(depth, 1)}};
  if (s.info.accuracy.error_target_m > 0) json["error_target_m"] = s.info.accuracy.error_target_m;
  const auto [flows, residual_J, abs_residual_J, moved_J] = s.energy();
  json["energy_J"] = {{"kinetic", s.last.kinetic_J},
                      {"potential", s.last.potential_J},
                      {"plastic", s.last.plastic_J},
                      {"moved", moved_J}};
  json["energy_flows_J"] = energy_json(flows, residual_J);
  json["energy_residual"] = ratio(abs_residual_J, moved_J);
  json["momentum_residual"] = s.worst(&FrameReport::momentum_residual);
  json["friction_excess"] =
      ratio(s.sum(&FrameReport::friction_excess_Ns), s.sum(&FrameReport::friction_allowed_Ns));
  json["mass_kg"] = {{"initial", s.first.mass_kg}, {"final", s.last.mass_kg}};
  json["limits_hit"] = s.limits_hit;
  json["limits_hit_by_name"] = limits_json(s.limits);
  json["aged"] = s.sum(&FrameReport::aged);
  json["joints_lost"] = s.sum(&FrameReport::joints_lost);
  json["modelled"] = s.info.modelled;
  json["warnings"] = s.info.warnings;
  if (const std::uint32_t failed = s.sum(&FrameReport::failed); failed > 0) {
    json["warnings"].push_back(
        uncut_convexes_warning(failed, s.sum(&FrameReport::failed_m3), s.first.volume_m3));
  }
  if (const std::string limits = limits_warning(); !limits.empty())
    json["warnings"].push_back(limits);
  json["cpu"] = cpu_name();
  json["sunder_version"] = SUNDER_VERSION;
  if (per_frame) {
    Json& list = json["per_frame"] = Json::array();
    for (std::size_t i = 0; i < s.reports.size(); ++i) {
      list.push_back(frame_json(s.reports[i], frame_ms[i], s.fractures(i)));
    }
  }
  return json.dump(2) + "\n";
}

std::string Statistics::table() const {
  const Series& s = *series_;
  std::string text = printed("%-10s %9s %9s %9s\n", "stage", "p50 ms", "p95 ms", "max ms");
  const auto row = [&](const char* name, const std::vector<double>& ms) {
    text += printed("%-10s %9.3f %9.3f %9.3f\n", name, quantile(ms, 0.5), quantile(ms, 0.95),
                    quantile(ms, 1));
  };
  for (int i = 0; i < kStages; ++i) row(kStageNames[i], s.stage_ms(i));
  const std::vector<double> frame_ms = s.frame_ms();
  row("frame", frame_ms);
  text += printed("busiest 2 s: p95 %.3f ms\n", busiest_p95(frame_ms));
  const Counts& c = s.last.counts;
  text += printed("bodies %u (awake %u), convexes %u, compounds %u, contacts %u\n", c.bodies,
                  c.awake, c.convexes, c.compounds, c.contacts);
  text += printed("breaks %zu into %llu pieces, slowest plan %.2f ms\n", s.fracture_ms.size(),
                  static_cast<unsigned long long>(s.pieces), quantile(s.fracture_ms, 1));
  const std::vector<double> depth = s.penetrations();
  text += printed("penetration p50 %.2f mm, p99 %.2f mm, max %.2f mm\n", 1e3 * quantile(depth, 0.5),
                  1e3 * quantile(depth, 0.99), 1e3 * quantile(depth, 1));
  text +=
      printed("mass %.6f kg -> %.6f kg, momentum residual %.1e, limits hit %u\n", s.first.mass_kg,
              s.last.mass_kg, s.worst(&FrameReport::momentum_residual), s.limits_hit);
  return text;
}

}  // namespace sunder

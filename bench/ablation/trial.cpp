#include "bench/ablation/trial.h"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string_view>

#include "bench/piles.h"
#include "bench/truths/truth.h"
#include "engine/base/cpu_time.h"
#include "engine/base/parallel.h"

namespace sunder::ablation {
namespace {

using bench::Pile;

/// Minutes long or chaotic, and told as well by others.
constexpr std::string_view kLeftOut[] = {"slope of the heap", "column of 1.5",
                                         "ball through a pane", "anchored wall", "dry wall"};

bool left_out(const truths::Truth& truth) {
  return std::ranges::any_of(kLeftOut, [&](std::string_view name) {
    return std::string_view(truth.what).find(name) != std::string_view::npos;
  });
}

Pile shot_wall() {
  Pile pile = bench::wall(20, 12);
  pile.ball(300, 0.4, Vec3(4, 1.2, -3), Vec3(0, 0, 20));
  return pile;
}

/// Boxes in one point.
Pile crowd() {
  Pile pile;
  pile.ground();
  for (int i = 0; i < 200; ++i) pile.box(Vec3(0.2, 0.2, 0.2), Vec3(0, 2, 0));
  return pile;
}

struct Scene {
  const char* name;
  std::function<Pile(std::uint64_t seed)> make;
  int frames;
  std::uint64_t seeds = 1;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = {
      {"rubble of 600, 4 seeds", [](std::uint64_t seed) { return bench::rubble(600, seed); }, 360,
       4},
      {"wall of 240 that is shot", [](std::uint64_t) { return shot_wall(); }, 300},
      {"1,000 cubes", [](std::uint64_t) { return bench::touching_cubes(10); }, 120},
      {"pyramid of 210", [](std::uint64_t) { return bench::pyramid(20); }, 300},
      {"200 boxes in one point", [](std::uint64_t) { return crowd(); }, 120}};
  return all;
}

/// At 60 Hz and 4 substeps; what it cost is left out.
PileFigures settle(const Pile& pile, int frames) {
  const auto physics = solver::make_rigid_physics({});
  const std::vector<BodyId> ids = physics->replace({}, pile.bodies);
  SolveReport last;
  for (int frame = 0; frame < frames; ++frame) {
    physics->collide(1.0 / 60);
    last = physics->solve(1.0 / 60, 4);
  }
  PileFigures figures;
  const std::vector<float> depths = physics->penetrations();
  for (const float depth : depths) {
    figures.mean_mm += 1e3 * static_cast<double>(depth) / static_cast<double>(depths.size());
    figures.deepest_mm = std::max(figures.deepest_mm, 1e3 * static_cast<double>(depth));
  }
  const auto bodies = static_cast<double>(ids.size());
  for (const BodyId id : ids)
    figures.rms_m_s += physics->state(id).velocity_W.squaredNorm() / bodies;
  figures.rms_m_s = std::sqrt(figures.rms_m_s);
  figures.awake = last.awake / bodies;
  return figures;
}

/// The numbers of a rule, turned off and on again.
class Switch {
 public:
  explicit Switch(const Rule& rule) : other_(rule.off) {}
  void turn() {
    for (Change& change : other_) change.value = set_number(change.number, change.value);
  }

 private:
  std::vector<Change> other_;
};

/// Of time: the mean over seeds, each in turns with the solver as it is.
PileFigures try_pile(const Scene& scene, Switch& rule) {
  PileFigures sum;
  double on_ms = 0, off_ms = 0;
  for (std::uint64_t seed = 1; seed <= scene.seeds; ++seed) {
    const Pile pile = scene.make(seed);
    const double start_ms = cpu_ms();
    settle(pile, scene.frames);
    const double middle_ms = cpu_ms();
    rule.turn();
    const PileFigures off = settle(pile, scene.frames);
    rule.turn();
    on_ms += middle_ms - start_ms, off_ms += cpu_ms() - middle_ms;
    const double share = 1 / static_cast<double>(scene.seeds);
    sum.mean_mm += share * off.mean_mm, sum.deepest_mm += share * off.deepest_mm;
    sum.rms_m_s += share * off.rms_m_s, sum.awake += share * off.awake;
  }
  sum.cost = off_ms / on_ms;
  return sum;
}

/// Writes what it finds, line by line.
void measure(const Rule& rule, const std::vector<std::size_t>& presets, std::FILE* to) {
  set_threads(1);
  Switch off(rule);
  off.turn();
  const truths::Truths all = truths::all_truths();
  for (const std::size_t preset : presets) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].measure || left_out(all[i])) continue;
      std::fprintf(to, "t %zu %zu %.17g\n", i, preset, all[i].measure(truths::kPresets[preset]));
      std::fflush(to);
    }
  }
  off.turn();
  for (const Scene& scene : scenes()) {
    const PileFigures f = try_pile(scene, off);
    std::fprintf(to, "p %.9g %.9g %.9g %.9g %.9g\n", f.mean_mm, f.deepest_mm, f.rms_m_s, f.awake,
                 f.cost);
    std::fflush(to);
  }
}

Trial read(const std::string& text) {
  Trial trial;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    std::size_t truth = 0, preset = 0;
    double value = 0;
    PileFigures f;
    if (std::sscanf(line.c_str(), "t %zu %zu %lg", &truth, &preset, &value) == 3)
      trial.truths[{truth, preset}] = value;
    else if (std::sscanf(line.c_str(), "p %lg %lg %lg %lg %lg", &f.mean_mm, &f.deepest_mm,
                         &f.rms_m_s, &f.awake, &f.cost) == 5)
      trial.piles.push_back(f);
  }
  return trial;
}

struct Job {
  std::size_t rule;
  int from;
  pid_t process;
  std::string text;
};

Job begin(const std::vector<Rule>& rules, std::size_t rule,
          const std::vector<std::size_t>& presets) {
  int ends[2];
  if (pipe(ends) != 0) return {rule, -1, 0, ""};
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process == 0) {
    close(ends[0]);
    std::FILE* to = fdopen(ends[1], "w");
    measure(rules[rule], presets, to);
    std::fclose(to);
    _exit(0);
  }
  close(ends[1]);
  std::fprintf(stderr, "%s\n", rules[rule].name.c_str());
  return {rule, ends[0], process, ""};
}

}  // namespace

std::vector<std::string> pile_names() {
  std::vector<std::string> names;
  for (const Scene& scene : scenes()) names.emplace_back(scene.name);
  return names;
}

std::vector<Trial> try_all(const std::vector<Rule>& rules, const std::vector<std::size_t>& presets,
                           int jobs) {
  std::vector<Trial> trials(rules.size());
  std::vector<Job> running;
  for (std::size_t next = 0; next < rules.size() || !running.empty();) {
    while (next < rules.size() && running.size() < static_cast<std::size_t>(jobs))
      running.push_back(begin(rules, next++, presets));
    std::vector<pollfd> ready;
    for (const Job& job : running) ready.push_back({job.from, POLLIN, 0});
    poll(ready.data(), ready.size(), -1);
    for (std::size_t i = running.size(); i-- > 0;) {
      if (ready[i].revents == 0) continue;
      Job& job = running[i];
      char part[4096];
      const ssize_t size = ::read(job.from, part, sizeof part);
      if (size > 0) {
        job.text.append(part, static_cast<std::size_t>(size));
        continue;
      }
      close(job.from);
      waitpid(job.process, nullptr, 0);
      trials[job.rule] = read(job.text);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return trials;
}

}  // namespace sunder::ablation

#include "fracture/stress/spring_level.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "fracture/stress/spring_math.h"

namespace sunder::fracture {
namespace {

// Regularization of a block, over the sum of its eigenvalues.
constexpr double kLeastRotation = 1e-9;

}  // namespace

const char* Spring::wrong_field() const {
  if (a == kWorld && b == kWorld) return "a";
  if (!is_within(place, kMostPlace_m)) return "place";
  if (!is_bounded(stretch_N_m, kMostStiffness_N_m)) return "stretch_N_m";
  return is_semidefinite(rotation_Nm, kMostStiffness_N_m) ? nullptr : "rotation_Nm";
}

template <class Real>
const char* SpringLevel<Real>::wrong_field() const {
  if (inverse_.size() != places_.size()) return "inverse_";
  const auto nodes = static_cast<std::uint32_t>(size());
  if (runs_.size() != (size() + kRun - 1) / kRun) return "runs_";
  for (std::uint32_t r = 0; r < runs_.size(); ++r) {
    if (!runs_[r]) return "runs_";
    const Run& run = *runs_[r];
    if (run.begin != r * kRun || run.end != std::min(nodes, run.begin + kRun) ||
        run.links.size() != run.springs.size() || !are_different_below(run.beside, runs_.size()))
      return "runs_";
    const auto is_end = [&](std::uint32_t node) {
      return node == Spring::kWorld ||
             (node < nodes && std::ranges::find(run.beside, node / kRun) != run.beside.end());
    };
    for (std::size_t i = 0; i < run.springs.size(); ++i) {
      const Spring& spring = run.springs[i];
      const auto is_here = [&](std::uint32_t node) { return node >= run.begin && node < run.end; };
      if (!is_end(spring.a) || !is_end(spring.b)) return "runs_";
      if (!is_here(spring.a) && !is_here(spring.b)) return "runs_";
      if (run.links[i].a != std::min(spring.a, nodes) ||
          run.links[i].b != std::min(spring.b, nodes))
        return "runs_";
    }
  }
  return nullptr;
}

template <class Real>
SpringLevel<Real>::SpringLevel(std::size_t nodes, std::vector<Spring> springs)
    : places_(nodes, Vec3::Zero()), inverse_(nodes) {
  std::vector<std::shared_ptr<Run>> runs;
  for (std::uint32_t begin = 0; begin < nodes; begin += kRun) {
    const auto end = std::min(static_cast<std::uint32_t>(nodes), begin + kRun);
    runs.push_back(std::make_shared<Run>(Run{begin, end, {}, {}, {}}));
  }
  runs_.resize(runs.size());
  for (const Spring& spring : springs) put(spring, runs);
  finish(std::move(runs), nullptr);
}

template <class Real>
SpringLevel<Real>::SpringLevel(const SpringLevel& old, const SpringEdit& edit) : SpringLevel(old) {
  std::vector<std::uint8_t> touched(runs_.size(), 0);
  for (std::size_t i = 0; i < edit.changes.size(); ++i) {
    if (edit.changes[i] != SpringEdit::Change::kNone) touched[i / kRun] = 1;
  }
  std::vector<std::shared_ptr<Run>> runs(runs_.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Run& before = *runs_[r];
    const auto is_touched = [&](std::uint32_t other) { return touched[other] != 0; };
    if (!touched[r] && std::ranges::none_of(before.beside, is_touched)) continue;
    runs[r] = std::make_shared<Run>(Run{before.begin, before.end, {}, {}, {}});
    for (const Spring& spring : before.springs) {
      if (!edit.is_at(spring)) runs[r]->springs.push_back(spring);
    }
  }
  for (const Spring& spring : edit.springs) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end == Spring::kWorld || runs[end / kRun]) continue;
      runs[end / kRun] = std::make_shared<Run>(*runs_[end / kRun]);
      runs[end / kRun]->links.clear();
    }
    put(spring, runs);
  }
  finish(std::move(runs), &edit);
}

/// Adds a spring to the runs of its ends.
template <class Real>
void SpringLevel<Real>::put(const Spring& spring, std::vector<std::shared_ptr<Run>>& runs) const {
  const bool from_a = spring.a != Spring::kWorld, from_b = spring.b != Spring::kWorld;
  if (from_a) runs[spring.a / kRun]->springs.push_back(spring);
  if (from_b && !(from_a && spring.a / kRun == spring.b / kRun)) {
    runs[spring.b / kRun]->springs.push_back(spring);
  }
}

/// Completes runs whose springs are set: places and inverse blocks of their nodes, or only of nodes
/// in the edit, and all their links.
template <class Real>
void SpringLevel<Real>::finish(std::vector<std::shared_ptr<Run>> runs, const SpringEdit* edit) {
  for_chunks(runs.size(), 1, [&](std::size_t r, std::size_t, std::size_t) {
    if (runs[r]) place_nodes(*runs[r], edit);
  });
  for_chunks(runs.size(), 1, [&](std::size_t r, std::size_t, std::size_t) {
    if (!runs[r]) return;
    Run& run = *runs[r];
    invert_blocks(run, edit);
    run.links.reserve(run.springs.size());
    run.beside.clear();
    for (const Spring& spring : run.springs) {
      run.links.push_back(link_of(spring));
      for (const std::uint32_t end : {spring.a, spring.b}) {
        const std::uint32_t other = end / kRun;
        if (end == Spring::kWorld || std::ranges::find(run.beside, other) != run.beside.end()) {
          continue;
        }
        run.beside.push_back(other);
      }
    }
    runs_[r] = std::move(runs[r]);
  });
}

template <class Real>
void SpringLevel<Real>::place_nodes(const Run& run, const SpringEdit* edit) {
  std::vector<double> stretch(run.end - run.begin, 0);
  std::vector<Vec3> moment(run.end - run.begin, Vec3::Zero());
  for (const Spring& spring : run.springs) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end < run.begin || end >= run.end) continue;
      stretch[end - run.begin] += spring.stretch_N_m;
      moment[end - run.begin] += spring.stretch_N_m * spring.place;
    }
  }
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    if (edit && !edit->is_at(i)) continue;
    const double sum = stretch[i - run.begin];
    if (sum > 0) places_[i] = moment[i - run.begin] / sum;
  }
}

template <class Real>
typename SpringLevel<Real>::Link SpringLevel<Real>::link_of(const Spring& spring) const {
  const auto nodes = static_cast<std::uint32_t>(size());
  const auto arm = [&](std::uint32_t node) {
    const Vec3 from_node = spring.place - places_[node];
    return rounded<Real>(from_node, from_node.norm());
  };
  Link link;
  link.a = std::min(spring.a, nodes);
  link.b = std::min(spring.b, nodes);
  link.arm_a = link.a < nodes ? arm(link.a) : Simd4<Real>{};
  link.arm_b = link.b < nodes ? arm(link.b) : Simd4<Real>{};
  link.rotation = rounded<Real>(spring.rotation_Nm);
  link.rotation.diagonal[3] = static_cast<Real>(spring.stretch_N_m);
  return link;
}

template <class Real>
void SpringLevel<Real>::invert_blocks(const Run& run, const SpringEdit* edit) {
  std::vector<double> stretch(run.end - run.begin, 0);
  std::vector<Mat3> rotation(run.end - run.begin, Mat3::Zero());
  for (const Spring& spring : run.springs) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end < run.begin || end >= run.end) continue;
      stretch[end - run.begin] += spring.stretch_N_m;
      rotation[end - run.begin] +=
          spring.rotation_Nm + spring.stretch_N_m * parallel_axis(spring.place - places_[end]);
    }
  }
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    if (edit && !edit->is_at(i)) continue;
    inverse_[i] = {};
    if (!(stretch[i - run.begin] > 0)) continue;
    // Rotation of slivers about their length is almost free.
    Mat3& block = rotation[i - run.begin];
    block.diagonal().array() += kLeastRotation * block.trace();
    inverse_[i] = rounded<Real>(Mat3(block.inverse()));
    inverse_[i].diagonal[3] = static_cast<Real>(1 / stretch[i - run.begin]);
  }
}

template <class Real>
template <class Start>
void SpringLevel<Real>::apply(const Nodal<Real>& x, Nodal<Real>& y, Real sign,
                              const Start& start) const {
  y.resize(size() + 1);
  for_chunks(runs_.size(), 1, [&](std::size_t r, std::size_t, std::size_t) {
    const Run& run = *runs_[r];
    for (std::uint32_t i = run.begin; i < run.end; ++i) y[i] = start(i);
    for (const Link& link : run.links) {
      const Six<Real>&at_a = x[link.a], &at_b = x[link.b];
      const Simd4<Real> rotated = at_b.angular - at_a.angular;
      const Simd4<Real> shifted = at_b.linear - at_a.linear + cross(at_b.angular, link.arm_b) -
                                  cross(at_a.angular, link.arm_a);
      const Simd4<Real> force = splat<Real>(sign * link.rotation.diagonal[3]) * shifted;
      const Simd4<Real> torque = splat<Real>(sign) * (link.rotation * rotated);
      if (link.a - run.begin < run.end - run.begin) {
        y[link.a].linear -= force;
        y[link.a].angular -= cross(link.arm_a, force) + torque;
      }
      if (link.b - run.begin < run.end - run.begin) {
        y[link.b].linear += force;
        y[link.b].angular += cross(link.arm_b, force) + torque;
      }
    }
  });
}

template <class Real>
void SpringLevel<Real>::multiply(const Nodal<Real>& x, Nodal<Real>& y) const {
  apply(x, y, 1, [](std::uint32_t) { return Six<Real>{}; });
}

template <class Real>
void SpringLevel<Real>::residual(const Nodal<Real>& f, const Nodal<Real>& x, Nodal<Real>& y) const {
  apply(x, y, -1, [&](std::uint32_t i) { return f[i]; });
}

template <class Real>
void SpringLevel<Real>::relax(Real factor, const Nodal<Real>& r, Nodal<Real>& x, bool add) const {
  x.resize(size() + 1);
  for_chunks(size(), kRun, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Symmetric<Real>& inverse = inverse_[i];
      const Simd4<Real> linear = splat<Real>(factor * inverse.diagonal[3]) * r[i].linear;
      const Simd4<Real> angular = splat<Real>(factor) * (inverse * r[i].angular);
      x[i].linear = add ? x[i].linear + linear : linear;
      x[i].angular = add ? x[i].angular + angular : angular;
    }
  });
}

template class SpringLevel<float>;
template class SpringLevel<double>;

}  // namespace sunder::fracture

#include "fracture/spring_level.h"

#include <algorithm>
#include <limits>

#include <Eigen/Dense>

#include "engine/base/parallel.h"

namespace sunder::fracture {
namespace {

constexpr std::uint32_t kRun = 1024;  // nodes a thread takes at a time
constexpr double kLeastTurn = 1e-9;   // of a block's eigenvalues, as part of their sum

/// As stored in `Real`, without what is rounding beside `size`: products of such numbers end up
/// below what a processor multiplies fast.
template <class Real>
Quad<Real> rounded(const Vec3& v, double size) {
  const double least = size * double{std::numeric_limits<Real>::epsilon()};
  return quad<Real>((v.array().abs() > least).select(v, Vec3::Zero()));
}

template <class Real>
Symmetric<Real> rounded(const Mat3& m) {
  Symmetric<Real> result;
  result.diagonal = quad<Real>(m.diagonal());
  result.rest = rounded<Real>(Vec3(m(1, 2), m(0, 2), m(0, 1)), m.trace());
  return result;
}

Mat3 lever(const Vec3& arm) { return arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose(); }

/// Neighbours of every node and how strongly they hold it, as begin offsets and flat lists.
struct Couplings {
  std::vector<std::uint32_t> first, other;
  std::vector<double> strength;
  std::vector<double> strongest;  ///< Per node.

  Couplings(std::size_t nodes, const std::vector<Spring>& springs)
      : first(nodes + 2, 0), strongest(nodes, 0) {
    const auto each = [&](auto&& visit) {
      for (const Spring& s : springs) {
        if (s.a == Spring::kWorld || s.b == Spring::kWorld) continue;
        visit(s.a, s.b, s.stretch_N_m);
        visit(s.b, s.a, s.stretch_N_m);
      }
    };
    each([&](std::uint32_t node, std::uint32_t, double) { ++first[node + 2]; });
    for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
    other.resize(first.back());
    strength.resize(first.back());
    each([&](std::uint32_t node, std::uint32_t neighbour, double stretch) {
      other[first[node + 1]] = neighbour;
      strength[first[node + 1]++] = stretch;
      strongest[node] = std::max(strongest[node], stretch);
    });
  }
};

/// Groups of neighbouring nodes, each numbered by when it began.
class Groups {
 public:
  Groups(const Couplings& couplings, std::size_t nodes)
      : couplings_(couplings), group_(nodes, kFree), pull_(nodes, 0) {}

  /// Every group grows by what its members hold strongest, to `size` nodes if it can.
  std::uint32_t grow(std::size_t size) {
    std::uint32_t groups = 0;
    for (std::uint32_t seed = 0; seed < group_.size(); ++seed) {
      if (group_[seed] != kFree) continue;
      rim_.clear();
      add(seed, groups);
      std::size_t members = 1;
      for (; members < size; ++members) {
        const auto best = strongest_of_rim();
        if (best == kFree) break;
        add(best, groups);
      }
      for (const std::uint32_t node : rim_) pull_[node] = 0;
      if (members > 1 || !join_neighbour(seed)) ++groups;
    }
    return groups;
  }

  std::vector<std::uint32_t> take() { return std::move(group_); }

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  // A node is held weakly by what holds it less than this share of what holds it most.
  static constexpr double kWeak = 0.25;

  void add(std::uint32_t node, std::uint32_t group) {
    group_[node] = group;
    for (std::uint32_t k = couplings_.first[node]; k < couplings_.first[node + 1]; ++k) {
      const std::uint32_t other = couplings_.other[k];
      if (group_[other] != kFree || couplings_.strength[k] < kWeak * couplings_.strongest[other]) {
        continue;
      }
      if (pull_[other] == 0) rim_.push_back(other);
      pull_[other] += 1;
    }
  }

  std::uint32_t strongest_of_rim() const {
    std::uint32_t best = kFree;
    for (const std::uint32_t node : rim_) {
      if (group_[node] == kFree && (best == kFree || pull_[node] > pull_[best])) best = node;
    }
    return best;
  }

  /// A node left alone goes to the group that holds it strongest.
  bool join_neighbour(std::uint32_t node) {
    double most = 0;
    const std::uint32_t alone = group_[node];
    for (std::uint32_t k = couplings_.first[node]; k < couplings_.first[node + 1]; ++k) {
      const std::uint32_t other = group_[couplings_.other[k]];
      if (other == kFree || other == alone || couplings_.strength[k] <= most) continue;
      most = couplings_.strength[k];
      group_[node] = other;
    }
    return most > 0;
  }

  const Couplings& couplings_;
  std::vector<std::uint32_t> group_;
  std::vector<std::uint32_t> rim_;  ///< Free nodes beside the group that grows.
  std::vector<double> pull_;        ///< Of that group on each of them.
};

/// Springs between the same two nodes become one.
std::vector<Spring> merge(std::vector<Spring> springs) {
  std::sort(springs.begin(), springs.end(),
            [](const Spring& x, const Spring& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  std::vector<Spring> merged;
  for (std::size_t begin = 0, end = 0; begin < springs.size(); begin = end) {
    Spring one = springs[begin];
    one.stretch_N_m = 0;
    Vec3 moment = Vec3::Zero();
    for (; end < springs.size() && springs[end].a == one.a && springs[end].b == one.b; ++end) {
      one.stretch_N_m += springs[end].stretch_N_m;
      moment += springs[end].stretch_N_m * springs[end].place;
    }
    one.place = moment / one.stretch_N_m;
    one.turn.setZero();
    for (std::size_t i = begin; i < end; ++i) {
      one.turn += springs[i].turn + springs[i].stretch_N_m * lever(springs[i].place - one.place);
    }
    merged.push_back(one);
  }
  return merged;
}

}  // namespace

template <class Real>
SpringLevel<Real>::SpringLevel(std::size_t nodes, std::vector<Spring> springs)
    : places_(nodes, Vec3::Zero()), springs_(std::move(springs)) {
  place_nodes();
  make_runs();
  invert_blocks();
}

template <class Real>
void SpringLevel<Real>::place_nodes() {
  std::vector<double> stretch(size(), 0);
  for (const Spring& spring : springs_) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end == Spring::kWorld) continue;
      stretch[end] += spring.stretch_N_m;
      places_[end] += spring.stretch_N_m * spring.place;
    }
  }
  for (std::size_t i = 0; i < size(); ++i) places_[i] /= stretch[i];
}

template <class Real>
void SpringLevel<Real>::make_runs() {
  const auto nodes = static_cast<std::uint32_t>(size());
  for (std::uint32_t begin = 0; begin < nodes; begin += kRun) {
    runs_.push_back({begin, std::min(nodes, begin + kRun), {}});
  }
  for (const Spring& spring : springs_) {
    const auto arm = [&](std::uint32_t node) {
      const Vec3 way = spring.place - places_[node];
      return rounded<Real>(way, way.norm());
    };
    Link link;
    link.a = std::min(spring.a, nodes);
    link.b = std::min(spring.b, nodes);
    link.arm_a = link.a < nodes ? arm(link.a) : Quad<Real>{};
    link.arm_b = link.b < nodes ? arm(link.b) : Quad<Real>{};
    link.turn = rounded<Real>(spring.turn);
    link.turn.diagonal[3] = static_cast<Real>(spring.stretch_N_m);
    if (link.a < nodes) runs_[link.a / kRun].links.push_back(link);
    if (link.b < nodes && (link.a == nodes || link.b / kRun != link.a / kRun)) {
      runs_[link.b / kRun].links.push_back(link);
    }
  }
}

template <class Real>
void SpringLevel<Real>::invert_blocks() {
  std::vector<double> push(size(), 0);
  std::vector<Mat3> turn(size(), Mat3::Zero());
  for (const Spring& spring : springs_) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end == Spring::kWorld) continue;
      push[end] += spring.stretch_N_m;
      turn[end] += spring.turn + spring.stretch_N_m * lever(spring.place - places_[end]);
    }
  }
  inverse_.resize(size());
  for (std::size_t i = 0; i < size(); ++i) {
    // Slivers turn about their length almost freely.
    turn[i].diagonal().array() += kLeastTurn * turn[i].trace();
    inverse_[i] = rounded<Real>(Mat3(turn[i].inverse()));
    inverse_[i].diagonal[3] = static_cast<Real>(1 / push[i]);
  }
}

template <class Real>
template <class Start>
void SpringLevel<Real>::apply(const Nodal<Real>& x, Nodal<Real>& y, Real sign,
                              const Start& start) const {
  y.resize(size() + 1);
  for_chunks(runs_.size(), 1, [&](std::size_t r, std::size_t, std::size_t) {
    const Run& run = runs_[r];
    for (std::uint32_t i = run.begin; i < run.end; ++i) y[i] = start(i);
    for (const Link& link : run.links) {
      const Six<Real>&at_a = x[link.a], &at_b = x[link.b];
      const Quad<Real> turned = at_b.angular - at_a.angular;
      const Quad<Real> shifted = at_b.linear - at_a.linear + cross(at_b.angular, link.arm_b) -
                                 cross(at_a.angular, link.arm_a);
      const Quad<Real> force = splat<Real>(sign * link.turn.diagonal[3]) * shifted;
      const Quad<Real> torque = splat<Real>(sign) * (link.turn * turned);
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
      const Quad<Real> push = splat<Real>(factor * inverse.diagonal[3]) * r[i].linear;
      const Quad<Real> turn = splat<Real>(factor) * (inverse * r[i].angular);
      x[i].linear = add ? x[i].linear + push : push;
      x[i].angular = add ? x[i].angular + turn : turn;
    }
  });
}

template <class Real>
SpringLevel<Real> SpringLevel<Real>::coarsen(std::size_t group_size) {
  const Couplings couplings(size(), springs_);
  Groups growing(couplings, size());
  const std::uint32_t groups = growing.grow(group_size);
  group_ = growing.take();
  std::vector<Spring> between;
  for (Spring spring : springs_) {
    spring.a = spring.a == Spring::kWorld ? Spring::kWorld : group_[spring.a];
    spring.b = spring.b == Spring::kWorld ? Spring::kWorld : group_[spring.b];
    if (spring.a == spring.b) continue;
    if (spring.a > spring.b) std::swap(spring.a, spring.b);
    between.push_back(spring);
  }
  SpringLevel coarse(groups, merge(std::move(between)));
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec3 way = places_[i] - coarse.places_[group_[i]];
    arms_.push_back(rounded<Real>(way, way.norm()));
  }
  return coarse;
}

template <class Real>
void SpringLevel<Real>::restrict_to(const Nodal<Real>& forces, Nodal<Real>& sums) const {
  std::fill(sums.begin(), sums.end(), Six<Real>{});
  for (std::size_t i = 0; i < size(); ++i) {
    Six<Real>& sum = sums[group_[i]];
    sum.linear += forces[i].linear;
    sum.angular += forces[i].angular + cross(arms_[i], forces[i].linear);
  }
}

template <class Real>
void SpringLevel<Real>::prolong(Real factor, const Nodal<Real>& motions, Nodal<Real>& x) const {
  for_chunks(size(), kRun, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Six<Real>& motion = motions[group_[i]];
      x[i].linear += splat<Real>(factor) * (motion.linear + cross(motion.angular, arms_[i]));
      x[i].angular += splat<Real>(factor) * motion.angular;
    }
  });
}

template class SpringLevel<float>;
template class SpringLevel<double>;

}  // namespace sunder::fracture

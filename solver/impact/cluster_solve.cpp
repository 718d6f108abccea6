#include "solver/impact/cluster_solve.h"

#include <algorithm>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/nncg.h"
#include "solver/impact/complementarity.h"
#include "solver/impact/tuning.h"

namespace sunder::solver {
namespace {

/// Contacts connected through moving bodies.
class Group {
 public:
  Group(std::vector<const ContactRow*> rows, double softness)
      : rows_(std::move(rows)), softness_(softness) {}

  /// Returns the impulse of each row, and adds the impulses to the velocities.
  std::vector<double> solve(double fastest_m_s, std::vector<BodyVelocity>& v,
                            std::uint64_t& work) const {
    const auto closes = [&](const ContactRow* row) {
      return row->speed(v) > kProbeConvergence * fastest_m_s;
    };
    work += rows_.size();
    if (std::ranges::none_of(rows_, closes)) return std::vector<double>(rows_.size(), 0);
    if (rows_.size() > kMaxExactContacts) return solve_by_sweeps(fastest_m_s, v, work);
    work += rows_.size() * rows_.size();
    return solve_exactly(v);
  }

 private:
  std::vector<double> solve_exactly(std::vector<BodyVelocity>& v) const;
  std::vector<double> solve_by_sweeps(double fastest_m_s, std::vector<BodyVelocity>& v,
                                      std::uint64_t& work) const;
  void sweep(std::vector<BodyVelocity>& v, std::vector<double>& impulses_Ns,
             std::vector<double>& change) const;

  std::vector<const ContactRow*> rows_;
  double softness_;
};

std::vector<double> Group::solve_exactly(std::vector<BodyVelocity>& v) const {
  const auto n = static_cast<Eigen::Index>(rows_.size());
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd closing(n);
  const auto row = [&](Eigen::Index i) -> const ContactRow& {
    return *rows_[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    closing[i] = row(i).speed(v);
    for (Eigen::Index j = 0; j < i; ++j) A(i, j) = A(j, i) = row(i).coupling(row(j));
    A(i, i) = row(i).inverse_mass + softness_;
  }
  const Eigen::VectorXd impulses = solve_complementarity(A, closing);
  for (Eigen::Index i = 0; i < n; ++i) row(i).apply_impulse(v, impulses[i]);
  return {impulses.begin(), impulses.end()};
}

/// Does one symmetric sweep of projected Gauss-Seidel; `change` receives the change per impulse.
void Group::sweep(std::vector<BodyVelocity>& v, std::vector<double>& impulses_Ns,
                  std::vector<double>& change) const {
  const std::size_t n = rows_.size();
  std::fill(change.begin(), change.end(), 0.0);
  for (std::size_t k = 0; k < 2 * n; ++k) {
    const std::size_t i = k < n ? k : 2 * n - 1 - k;
    const ContactRow& row = *rows_[i];
    double& sum = impulses_Ns[i];
    const double wanted = (row.speed(v) - softness_ * sum) / (row.inverse_mass + softness_);
    const double impulse = std::max(sum + wanted, 0.0) - sum;
    if (impulse == 0) continue;
    sum += impulse;
    change[i] += impulse;
    row.apply_impulse(v, impulse);
  }
}

/// Solves by nonsmooth nonlinear conjugate gradients over sweeps (engine/base/nncg.h).
std::vector<double> Group::solve_by_sweeps(double fastest_m_s, std::vector<BodyVelocity>& v,
                                           std::uint64_t& work) const {
  const std::size_t n = rows_.size();
  std::vector<double> impulses_Ns(n, 0), change(n, 0), direction(n, 0);
  Nncg nncg;
  for (int round = 0; round < kMaxProbeSweeps; ++round) {
    work += 3 * n;
    sweep(v, impulses_Ns, change);
    double square = 0, worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double scaled = change[i] * change[i] * rows_[i]->inverse_mass;
      square += scaled;
      worst = std::max(worst, scaled * rows_[i]->inverse_mass);
    }
    if (worst <= kProbeConvergence * kProbeConvergence * fastest_m_s * fastest_m_s)
      return impulses_Ns;
    const double beta = nncg.beta(square);
    for (std::size_t i = 0; i < n; ++i) {
      direction[i] *= beta;
      if (direction[i] != 0) {
        impulses_Ns[i] += direction[i];
        rows_[i]->apply_impulse(v, direction[i]);
      }
      direction[i] += change[i];
    }
  }
  sweep(v, impulses_Ns, change);
  return impulses_Ns;
}

}  // namespace

double ContactRow::coupling(const ContactRow& other) const {
  double sum = 0;
  if (other.a == a)
    sum += normal.dot(other.linear_response_a) + angular_a.dot(other.angular_response_a);
  if (other.a == b)
    sum -= normal.dot(other.linear_response_a) + angular_b.dot(other.angular_response_a);
  if (other.b == a)
    sum -= normal.dot(other.linear_response_b) + angular_a.dot(other.angular_response_b);
  if (other.b == b)
    sum += normal.dot(other.linear_response_b) + angular_b.dot(other.angular_response_b);
  for (const JointResponse& on : other.joint_responses) {
    if (on.body == a) sum -= normal.dot(on.change.linear) + angular_a.dot(on.change.angular);
    if (on.body == b) sum += normal.dot(on.change.linear) + angular_b.dot(on.change.angular);
  }
  return sum;
}

ClusterMotion solve_cluster(const std::vector<ContactRow>& rows,
                            std::span<const std::uint32_t> closed,
                            std::span<const std::uint32_t> active, double softness,
                            double fastest_m_s, const std::vector<BodyVelocity>& velocities) {
  DisjointSets bodies(velocities.size());
  for (const std::uint32_t i : active) {
    const ContactRow& row = rows[closed[i]];
    if (row.moves_a && row.moves_b) bodies.join(row.a, row.b);
    for (const ContactRow::JointResponse& on : row.joint_responses) {
      bodies.join(row.moves_a ? row.a : row.b, on.body);
    }
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> grouped;  // group and position in `closed`
  grouped.reserve(active.size());
  for (const std::uint32_t i : active) {
    const ContactRow& row = rows[closed[i]];
    grouped.emplace_back(bodies.root(row.moves_a ? row.a : row.b), i);
  }
  std::ranges::sort(grouped);
  ClusterMotion solved{velocities, std::vector<double>(closed.size(), 0)};
  for (std::size_t begin = 0, end = 0; begin < grouped.size(); begin = end) {
    std::vector<const ContactRow*> group;
    for (; end < grouped.size() && grouped[end].first == grouped[begin].first; ++end) {
      group.push_back(&rows[closed[grouped[end].second]]);
    }
    const std::vector<double> impulses_Ns =
        Group(std::move(group), softness).solve(fastest_m_s, solved.velocities, solved.work);
    for (std::size_t i = begin; i < end; ++i) {
      solved.impulses_Ns[grouped[i].second] = impulses_Ns[i - begin];
    }
  }
  return solved;
}

}  // namespace sunder::solver

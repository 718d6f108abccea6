#include "solver/impact/linkage.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace sunder::solver {
namespace {

// Added to the unit diagonal, so that linearly dependent rows have a solution.
constexpr double kRegularization = 1e-12;
// Share of a contact's inverse mass without joints below which the one with joints is rounding.
constexpr double kMinInverseMass = 1e-11;

}  // namespace

Linkage::Linkage(std::vector<ContactRow> rows) : rows_(std::move(rows)) {
  const auto n = static_cast<Eigen::Index>(rows_.size());
  if (n == 0) return;
  const auto row = [&](Eigen::Index i) -> const ContactRow& {
    return rows_[static_cast<std::size_t>(i)];
  };
  unit_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) unit_[i] = 1 / std::sqrt(row(i).coupling(row(i)));
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      A(i, j) = A(j, i) = unit_[i] * unit_[j] * row(i).coupling(row(j));
    }
    A(i, i) = 1 + kRegularization;
  }
  coupling_.compute(A);
}

Eigen::VectorXd Linkage::impulses_Ns(const Eigen::VectorXd& speeds_m_s) const {
  return unit_.cwiseProduct(coupling_.solve(unit_.cwiseProduct(speeds_m_s)));
}

void Linkage::project(std::vector<BodyVelocity>& velocities) const {
  if (rows_.empty()) return;
  Eigen::VectorXd speeds(unit_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    speeds[static_cast<Eigen::Index>(i)] = rows_[i].speed(velocities);
  }
  const Eigen::VectorXd impulses = impulses_Ns(speeds);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].apply_impulse(velocities, impulses[static_cast<Eigen::Index>(i)]);
  }
}

void Linkage::add_joint_responses(ContactRow& row, std::size_t bodies) const {
  if (rows_.empty()) return;
  Eigen::VectorXd speeds(unit_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    speeds[static_cast<Eigen::Index>(i)] = rows_[i].coupling(row);
  }
  if (speeds.isZero(0)) return;
  const Eigen::VectorXd impulses = impulses_Ns(speeds);
  std::vector<BodyVelocity> change(bodies);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].apply_impulse(change, -impulses[static_cast<Eigen::Index>(i)]);
  }
  for (std::uint32_t b = 0; b < bodies; ++b) {
    if (!change[b].linear.isZero(0) || !change[b].angular.isZero(0)) {
      row.joint_responses.push_back({b, change[b]});
    }
  }
  const double free = row.inverse_mass;
  row.inverse_mass = row.coupling(row);
  if (row.inverse_mass < kMinInverseMass * free) row.inverse_mass = 0;
}

}  // namespace sunder::solver

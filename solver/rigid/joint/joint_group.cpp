#include "solver/rigid/joint/joint_group.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder::solver {
namespace {

constexpr double kRate = 0.25;      // of an error that a substep takes out
constexpr double kJointPush = 2;    // fastest correction, in speeds of falling
constexpr double kSoftness = 1e-6;  // of a row's response: two hinges of a door say the same twice

/// Response of row i of one joint to an impulse along row j of another, through what they share.
double response(const JointWork& m, const JointRow& i, const JointWork& n, const JointRow& j) {
  const double pushes = double{i.push.dot(j.push)};
  double sum = 0;
  if (m.row_a != 0 && m.row_a == n.row_a)
    sum += double{m.inverse_mass_a} * pushes + double{i.angular_a.dot(j.angular_a)};
  if (m.row_b != 0 && m.row_b == n.row_b)
    sum += double{m.inverse_mass_b} * pushes + double{i.angular_b.dot(j.angular_b)};
  if (m.row_a != 0 && m.row_a == n.row_b)
    sum -= double{m.inverse_mass_a} * pushes + double{i.angular_a.dot(j.angular_b)};
  if (m.row_b != 0 && m.row_b == n.row_a)
    sum -= double{m.inverse_mass_b} * pushes + double{i.angular_b.dot(j.angular_a)};
  return sum;
}

bool share(const JointWork& m, const JointWork& n) {
  const auto meets = [&](std::uint32_t row) {
    return row != 0 && (row == n.row_a || row == n.row_b);
  };
  return meets(m.row_a) || meets(m.row_b);
}

/// Lays out the envelope: a joint's rows begin with those of the first joint it shares a body with.
void lay_out(JointGroup& group, std::span<const JointWork> works) {
  Envelope& e = group.matrix;
  e.first.clear();
  e.start.assign(1, 0);
  std::vector<std::uint32_t> first_row;
  for (std::size_t m = 0; m < works.size(); ++m) {
    const std::uint32_t at = e.rows();
    first_row.push_back(at);
    std::uint32_t first = at;
    for (std::size_t n = 0; n < m; ++n) {
      if (!share(works[m], works[n])) continue;
      first = first_row[n];
      break;
    }
    for (int i = 0; i < works[m].rows; ++i) {
      e.first.push_back(first);
      e.start.push_back(e.start.back() + at + static_cast<std::uint32_t>(i) + 1 - first);
    }
  }
  e.entries.resize(e.start.back());
  group.softness.resize(e.rows());
  group.change.resize(e.rows());
}

void fill(JointGroup& group, std::span<const JointWork> works) {
  Envelope& e = group.matrix;
  std::fill(e.entries.begin(), e.entries.end(), 0.0);
  std::vector<std::uint32_t> first_row;
  std::uint32_t at = 0;
  for (std::size_t m = 0; m < works.size(); ++m) {
    first_row.push_back(at);
    const JointWork& work = works[m];
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(work.rows); ++i) {
      for (std::size_t n = 0; n <= m; ++n) {
        if (first_row[n] < e.first[at + i] || (n < m && !share(work, works[n]))) continue;
        const auto columns = n < m ? static_cast<std::uint32_t>(works[n].rows) : i + 1;
        for (std::uint32_t j = 0; j < columns; ++j)
          e.at(at + i, first_row[n] + j) = response(work, work.row[i], works[n], works[n].row[j]);
      }
      double& diagonal = e.at(at + i, at + i);
      // What a broken joint, or one between two immovable ends, is asked does not matter.
      const bool moves = diagonal > 0 && !work.broken;
      group.softness[at + i] = moves ? kSoftness * diagonal : 1;
      diagonal = moves ? diagonal + group.softness[at + i] : 1;
    }
    at += static_cast<std::uint32_t>(work.rows);
  }
  e.factor();
}

/// What the correction of an error asks for, as a speed.
double bias(const JointWork& work, int i, const StepContext& step, bool biased) {
  const double error = work.row[static_cast<std::size_t>(i)].error;
  const double apart = work.kind == JointDesc::Kind::kRope ? std::min(0.0, error) : 0;
  if (apart < 0) return apart / step.h_s;  // a slack rope may run out
  if (!biased) return 0;
  const double push_m_s = kJointPush * step.froude.speed_m_s(work.reach_m);
  const double most = i < work.place_rows ? push_m_s : push_m_s / work.reach_m;
  return std::clamp(kRate / step.h_s * error, -most, most);
}

/// On b, of this substep.
Vec3 push_of(const JointWork& work) {
  Vec3 push = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(work.rows); ++i) {
    push += work.impulse[i] * work.row[i].push.cast<double>();
  }
  return push;
}

void take_out(JointWork& work) {
  work.broken = true;
  work.impulse = {};
  work.owed = {};
  for (JointRow& row : work.row) row = JointRow{};
}

}  // namespace

void Envelope::factor() {
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t j = first[i]; j <= i; ++j) {
      double sum = at(i, j);
      for (std::uint32_t k = std::max(first[i], first[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = j < i ? sum / at(j, j) : std::sqrt(std::max(sum, 1e-12 * at(i, i)));
    }
  }
}

void Envelope::solve(std::span<double> x) const {
  const auto entry = [&](std::uint32_t row, std::uint32_t column) {
    return entries[start[row] + column - first[row]];
  };
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t k = first[i]; k < i; ++k) x[i] -= entry(i, k) * x[k];
    x[i] /= entry(i, i);
  }
  for (std::uint32_t i = rows(); i-- > 0;) {
    x[i] /= entry(i, i);
    for (std::uint32_t k = first[i]; k < i; ++k) x[k] -= entry(i, k) * x[i];
  }
}

void begin_group(JointGroup& group, std::span<JointWork> works, const BodyRow* rows) {
  for (JointWork& work : works) refresh_rows(work, rows);
  lay_out(group, works);
  fill(group, works);
}

void warm_start_group(std::span<JointWork> works, const StepContext& step, BodyRow* rows) {
  for (JointWork& work : works) {
    for (double& impulse : work.impulse) impulse *= double{step.impulse_scale};
    work.apply(work.sum(work.impulse), rows);
  }
}

void solve_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 bool biased, BodyRow* rows) {
  if (biased) {
    for (JointWork& work : works) work.apply(std::exchange(work.owed, {}), rows);
  }
  std::vector<double>& change = group.change;
  std::size_t at = 0;
  for (const JointWork& work : works) {
    for (int i = 0; i < work.rows; ++i, ++at) {
      const auto r = static_cast<std::size_t>(i);
      change[at] = work.broken ? 0
                               : -work.speed(i, rows) - bias(work, i, step, biased) -
                                     group.softness[at] * work.impulse[r];
    }
  }
  group.matrix.solve(change);
  at = 0;
  for (JointWork& work : works) {
    if (work.kind == JointDesc::Kind::kRope)  // it pulls, and never pushes
      change[at] = std::min(change[at], -work.impulse[0]);
    work.apply(work.sum(std::span(change).subspan(at)), rows);
    for (int i = 0; i < work.rows; ++i, ++at)
      work.impulse[static_cast<std::size_t>(i)] += change[at];
  }
}

void refresh_group(JointGroup& group, std::span<JointWork> works, const BodyRow* rows) {
  for (JointWork& work : works) {
    if (work.broken) continue;
    const JointPush before = work.sum(work.impulse);
    refresh_rows(work, rows);
    work.owed = work.sum(work.impulse) - before;
  }
  fill(group, works);
}

void scale_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const float* share_of_row, BodyRow* rows) {
  const auto share_of = [&](const JointWork& work) {
    return share_of_row[work.row_b != 0 ? work.row_b : work.row_a];
  };
  if (std::ranges::all_of(works, [&](const JointWork& work) { return share_of(work) == 1; }))
    return;
  for (JointWork& work : works) {
    const float share = share_of(work);
    work.total_W -= push_of(work);
    for (double& impulse : work.impulse) impulse *= double{share};
    work.owed = {share * work.owed.push, share * work.owed.angular_a, share * work.owed.angular_b};
  }
  solve_group(group, works, step, false, rows);
  for (JointWork& work : works) work.total_W += push_of(work);
}

void test_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                BodyRow* rows) {
  bool any = false;
  for (JointWork& work : works) {
    if (work.broken) continue;
    const Vec3 push = push_of(work);
    double square = 0;
    for (int i = work.place_rows; i < work.rows; ++i) {
      const double impulse = work.impulse[static_cast<std::size_t>(i)];
      square += impulse * impulse;
    }
    if (push.norm() <= step.h_s * work.breaking_N &&
        std::sqrt(square) <= step.h_s * work.breaking_Nm) {
      work.total_W += push;
      continue;
    }
    work.apply(JointPush{} - work.sum(work.impulse), rows);
    take_out(work);
    any = true;
  }
  if (any) fill(group, works);
}

}  // namespace sunder::solver

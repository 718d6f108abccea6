#include "solver/rigid/joint/joint_group.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/rigid/tolerances.h"

namespace sunder::solver {
namespace {

constexpr int kRopeRounds = 8;
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
  group.first_row.clear();
  group.first_shared.clear();
  for (std::size_t m = 0; m < works.size(); ++m) {
    const std::uint32_t at = e.rows();
    std::uint32_t n = 0;
    while (n < m && !share(works[m], works[n])) ++n;
    group.first_row.push_back(at);
    group.first_shared.push_back(n);
    const std::uint32_t first = group.first_row[n];
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
  const std::vector<std::uint32_t>& first_row = group.first_row;
  for (std::size_t m = 0; m < works.size(); ++m) {
    const JointWork& work = works[m];
    const std::uint32_t at = first_row[m];
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(work.rows); ++i) {
      for (std::size_t n = group.first_shared[m]; n <= m; ++n) {
        if (n < m && !share(work, works[n])) continue;
        if (work.slack || works[n].slack) continue;
        const auto columns = n < m ? static_cast<std::uint32_t>(works[n].rows) : i + 1;
        for (std::uint32_t j = 0; j < columns; ++j)
          e.at(at + i, first_row[n] + j) = response(work, work.row[i], works[n], works[n].row[j]);
      }
      double& diagonal = e.at(at + i, at + i);
      // What a broken joint, a slack rope, or what is between two immovable ends is asked does not
      // matter.
      const bool moves = diagonal > 0 && !work.broken;
      group.softness[at + i] = work.row[i].softness > 0 ? work.row[i].softness
                               : moves                  ? kSoftness * diagonal
                                                        : 1;
      diagonal = moves ? diagonal + group.softness[at + i] : 1;
    }
  }
  e.factor();
}

/// What the correction of an error asks for, as a speed: of what there is, and of what the turn of
/// this substep would add.
double bias(const JointWork& work, int i, const StepContext& step, bool biased) {
  const double error = work.row[static_cast<std::size_t>(i)].error;
  const double apart = work.kind == JointDesc::Kind::kRope ? std::min(0.0, error) : 0;
  if (apart < 0) return apart / step.h_s;  // a slack rope may run out
  if (!biased || i >= work.held_rows) return 0;
  const double push_m_s = kPush * step.froude.speed_m_s(work.reach_m);
  const double most = i < work.place_rows ? push_m_s : push_m_s / work.reach_m;
  return std::clamp(kStiffness / step.h_s * error, -most, most) +
         0.5 * step.h_s * work.row[static_cast<std::size_t>(i)].bend_s2;
}

/// Of this substep.
JointImpulse impulse_of(const JointWork& work) {
  JointImpulse sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(work.rows); ++i) {
    sum.linear_W += work.impulse[i] * work.row[i].push.cast<double>();
    sum.angular_W += work.impulse[i] * work.row[i].turn.cast<double>();
  }
  return sum;
}

/// What all rows have to add so that they hold.
void find_change(JointGroup& group, std::span<const JointWork> works, const StepContext& step,
                 bool biased, const BodyRow* rows) {
  std::size_t at = 0;
  for (const JointWork& work : works) {
    for (int i = 0; i < work.rows; ++i, ++at) {
      const bool bears = !work.broken && !work.slack;
      group.change[at] = !bears
                             ? 0
                             : -work.speed(i, rows) - bias(work, i, step, biased) -
                                   group.softness[at] * work.impulse[static_cast<std::size_t>(i)];
    }
  }
  group.matrix.solve(group.change);
}

/// A rope pulls and never pushes: lets go of those that would; whether there are any.
bool let_go(const JointGroup& group, std::span<JointWork> works, BodyRow* rows) {
  bool any = false;
  std::size_t at = 0;
  for (JointWork& work : works) {
    if (work.kind == JointDesc::Kind::kRope && !work.slack && !work.broken &&
        work.impulse[0] + group.change[at] > 0) {
      work.apply(JointPush{} - work.sum(work.impulse), rows);
      work.impulse = {};
      work.slack = any = true;
    }
    at += static_cast<std::size_t>(work.rows);
  }
  return any;
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

void begin_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const BodyRow* rows) {
  bool other = false;  // numbers of rows than were laid out
  for (JointWork& work : works) {
    if (work.broken) continue;
    const int before = work.rows;
    refresh_rows(work, step.h_s, rows);
    other = other || work.rows != before;
  }
  if (other) lay_out(group, works);
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
  bool other = false;  // ropes bear than were factored
  for (JointWork& work : works) {
    if (!work.slack || work.speed(0, rows) + bias(work, 0, step, biased) <= 0) continue;
    work.slack = false;
    other = true;
  }
  for (int round = 0; round < kRopeRounds; ++round) {
    if (other) fill(group, works);
    find_change(group, works, step, biased, rows);
    other = let_go(group, works, rows);
    if (!other) break;
  }
  std::size_t at = 0;
  for (JointWork& work : works) {
    if (work.slack) group.change[at] = 0;
    work.apply(work.sum(std::span(group.change).subspan(at)), rows);
    for (int i = 0; i < work.rows; ++i, ++at)
      work.impulse[static_cast<std::size_t>(i)] += group.change[at];
  }
  if (other) fill(group, works);
}

void refresh_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                   const BodyRow* rows) {
  for (JointWork& work : works) work.owed = work.sum(work.impulse);
  begin_group(group, works, step, rows);
  for (JointWork& work : works) work.owed = work.sum(work.impulse) - work.owed;
}

void settle_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                  BodyRow* rows) {
  for (JointWork& work : works) work.kept_impulse = std::exchange(work.impulse, {});
  begin_group(group, works, step, rows);
  solve_group(group, works, step, false, rows);
  for (JointWork& work : works) {
    work.total += impulse_of(work);
    work.impulse = work.kept_impulse;
  }
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
    work.total += -impulse_of(work);
    for (double& impulse : work.impulse) impulse *= double{share};
    work.owed = {share * work.owed.push, share * work.owed.angular_a, share * work.owed.angular_b};
  }
  solve_group(group, works, step, false, rows);
  for (JointWork& work : works) work.total += impulse_of(work);
}

void test_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                BodyRow* rows) {
  bool any = false;
  for (JointWork& work : works) {
    if (work.broken) continue;
    const JointImpulse impulse = impulse_of(work);
    double square = 0;
    for (int i = work.place_rows; i < work.held_rows; ++i) {
      const double along = work.impulse[static_cast<std::size_t>(i)];
      square += along * along;
    }
    if (impulse.linear_W.norm() <= step.h_s * work.breaking_N &&
        std::sqrt(square) <= step.h_s * work.breaking_Nm) {
      work.total += impulse;
      continue;
    }
    work.apply(JointPush{} - work.sum(work.impulse), rows);
    take_out(work);
    any = true;
  }
  if (any) fill(group, works);
  if (!group.swings_free) return;
  for (JointWork& work : works) work.owed = work.sum(work.impulse);
}

}  // namespace sunder::solver

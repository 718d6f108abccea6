#include "solver/rigid/joint/joint_group.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/rigid/joint/plastic.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr int kAlignRounds = 3;
// relative to a row's response: the two hinges of a door have redundant rows
constexpr double kSoftness = 1e-6;

/// Returns the response of row i of one joint to an impulse along row j of another, by shared
/// bodies.
double response(const JointWork& m, const JointRow& i, const JointWork& n, const JointRow& j) {
  const double linear = double{i.push.dot(j.push)};
  double sum = 0;
  if (m.row_a > 0 && m.row_a == n.row_a)
    sum += double{m.inverse_mass_a} * linear + double{i.angular_a.dot(j.angular_a)};
  if (m.row_b > 0 && m.row_b == n.row_b)
    sum += double{m.inverse_mass_b} * linear + double{i.angular_b.dot(j.angular_b)};
  if (m.row_a > 0 && m.row_a == n.row_b)
    sum -= double{m.inverse_mass_a} * linear + double{i.angular_a.dot(j.angular_b)};
  if (m.row_b > 0 && m.row_b == n.row_a)
    sum -= double{m.inverse_mass_b} * linear + double{i.angular_b.dot(j.angular_a)};
  return sum;
}

bool share(const JointWork& m, const JointWork& n) {
  const auto meets = [&](std::int32_t row) {
    return row > 0 && (row == n.row_a || row == n.row_b);
  };
  return meets(m.row_a) || meets(m.row_b);
}

template <class Visit>
void for_plastic(std::span<JointWork> works, const Visit& visit) {
  for (JointWork& work : works)
    if (work.kind == JointKind::kPlastic) visit(work);
}

/// Sets the envelope: a joint's rows begin at those of the first joint that it shares a body with.
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
  e.entries.resize(e.start.back() + Envelope::kPadding);
  group.bounded = std::ranges::any_of(works, [](const JointWork& work) {
    return work.kind == JointDesc::Kind::kRope || work.kind == JointDesc::Kind::kPlastic;
  });
  group.softness.resize(e.rows());
  group.change.resize(e.rows());
}

/// Returns the response of the rows of a joint to those of another, or of itself: then only the
/// lower half is set, unless the rows are turned.
Mat6 responses(const JointWork& m, const JointWork& n) {
  Mat6 block = Mat6::Zero();
  const bool half = &m == &n && m.kind != JointKind::kPlastic;
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < (half ? i + 1 : n.rows); ++j)
      block(i, j) =
          response(m, m.row[static_cast<std::size_t>(i)], n, n.row[static_cast<std::size_t>(j)]);
  return block;
}

/// Adds the softness of a joint's rows to the diagonal.
void soften(const JointWork& work, std::span<double> softness, Mat6& block) {
  for (int i = 0; i < work.rows; ++i) {
    const double own = work.row[static_cast<std::size_t>(i)].softness;
    double& diagonal = block(i, i);
    // Rows of a broken joint, or between two immovable ends, have no effect.
    const bool moves = diagonal > 0 && !work.broken;
    double& soft = softness[static_cast<std::size_t>(i)];
    soft = own > 0 ? own : moves ? kSoftness * diagonal : 1;
    diagonal = moves ? diagonal + soft : 1;
  }
}

void fill(JointGroup& group, std::span<const JointWork> works) {
  Envelope& e = group.matrix;
  std::fill(e.entries.begin(), e.entries.end(), 0.0);
  for (std::size_t m = 0; m < works.size(); ++m) {
    const std::uint32_t at = group.first_row[m];
    for (std::size_t n = group.first_shared[m]; n <= m; ++n) {
      if (n < m && !share(works[m], works[n])) continue;
      Mat6 block = responses(works[m], works[n]);
      if (n == m) soften(works[m], std::span(group.softness).subspan(at), block);
      turn_rows(works[m], works[n], block);
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(works[m].rows); ++i) {
        const auto columns = n < m ? static_cast<std::uint32_t>(works[n].rows) : i + 1;
        for (std::uint32_t j = 0; j < columns; ++j)
          e.at(at + i, group.first_row[n] + j) = block(i, j);
      }
    }
  }
  group.bounded ? group.pinned.invalidate() : e.factor();
}

/// Returns the correction speed of row i: of its error, and of the error that rotation adds in this
/// substep.
double bias(const JointWork& work, int i, const StepContext& step, bool biased) {
  const double error = work.row[static_cast<std::size_t>(i)].error;
  const double apart = work.kind == JointDesc::Kind::kRope ? std::min(0.0, error) : 0;
  if (apart < 0) return apart / step.h_s;  // a slack rope may move up to its length
  if (!biased || i >= work.held_rows) return 0;
  const double ahead = 0.5 * step.h_s * work.row[static_cast<std::size_t>(i)].error_acceleration;
  if (i > 0 && work.plastic.softness > 0) return ahead;  // the flow is no error
  const double push_m_s = kMaxJointPushSpeed * step.froude.speed_m_s(work.reach_m);
  const double most = i < work.place_rows ? push_m_s : push_m_s / work.reach_m;
  return std::clamp(kJointCorrection / step.h_s * error, -most, most) + ahead;
}

/// Returns the impulse of this substep.
AnchorImpulse impulse_of(const JointWork& work) {
  AnchorImpulse sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(work.rows); ++i) {
    sum.linear_W += work.impulse[i] * work.row[i].push.cast<double>();
    sum.angular_W += work.impulse[i] * work.row[i].turn.cast<double>();
  }
  return sum;
}

/// Solves for the change with bounds, along the turned rows of plastic joints.
void find_bounded_change(JointGroup& group, std::span<JointWork> works) {
  const auto each = [&](const auto& visit) {
    for (std::size_t m = 0; m < works.size(); ++m) {
      const std::span change = std::span(group.change).subspan(group.first_row[m]);
      visit(works[m], change.first(static_cast<std::size_t>(works[m].rows)));
    }
  };
  std::vector<RowBounds>& bounds = group.pinned.bounds;
  bounds.clear();
  each([&](JointWork& work, std::span<double> target) {
    if (work.kind == JointKind::kPlastic) turn_target(work, target);
    for (std::size_t i = 0; i < target.size(); ++i) {
      if (work.kind != JointKind::kPlastic) work.bounds[i].now = work.impulse[i];
      bounds.push_back(work.bounds[i]);
    }
  });
  group.pinned.solve(group.matrix, group.change);
  const RowBounds* row = bounds.data();
  each([&](JointWork& work, std::span<double> change) {
    for (std::size_t i = 0; i < change.size(); ++i) work.bounds[i].pin = (row++)->pin;
    if (work.kind == JointKind::kPlastic) turn_back(work, change);
  });
}

/// Finds the changes of impulses that satisfy all rows, as far as bounds allow.
void find_change(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 bool biased, const BodyRow* rows) {
  std::size_t at = 0;
  for (const JointWork& work : works) {
    for (int i = 0; i < work.rows; ++i, ++at) {
      group.change[at] = work.broken
                             ? 0
                             : -work.speed(i, rows) - bias(work, i, step, biased) -
                                   group.softness[at] * work.impulse[static_cast<std::size_t>(i)];
    }
  }
  group.bounded ? find_bounded_change(group, works) : group.matrix.solve(group.change);
}

/// True if a plastic joint exceeds its strength, since the direction of its impulse has changed.
bool exceeds_strength(std::span<JointWork> works, const StepContext& step, const BodyRow* rows) {
  bool over = false;
  for_plastic(works, [&](JointWork& work) {
    record_flow_speed(work, rows);
    over = over || exceeds_strength(work, step.h_s);
  });
  return over;
}

void disable(JointWork& work) {
  work.broken = true;
  work.impulse = {};
  work.pending = {};
  for (JointRow& row : work.row) row = JointRow{};
}

/// Updates the rows for the current poses and velocities.
void renew_rows(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                const BodyRow* rows) {
  bool other = false;  // true if a number of rows has changed
  for (JointWork& work : works) {
    if (work.broken) continue;
    const int before = work.rows;
    refresh_rows(work, step.h_s, rows);
    other = other || work.rows != before;
  }
  if (other) lay_out(group, works);
}

}  // namespace

void begin_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const BodyRow* rows) {
  renew_rows(group, works, step, rows);
  for_plastic(works, [&](JointWork& work) { align_rows(work, step.h_s); });
  fill(group, works);
}

void warm_start_group(std::span<JointWork> works, BodyRow* rows) {
  for (JointWork& work : works) work.apply(work.sum(work.impulse), rows);
}

void solve_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 bool biased, BodyRow* rows) {
  if (biased) {
    for (JointWork& work : works) work.apply(std::exchange(work.pending, {}), rows);
  }
  for (int round = 1;; ++round) {
    find_change(group, works, step, biased, rows);
    std::size_t at = 0;
    for (JointWork& work : works) {
      work.apply(work.sum(std::span(group.change).subspan(at)), rows);
      for (int i = 0; i < work.rows; ++i, ++at)
        work.impulse[static_cast<std::size_t>(i)] += group.change[at];
    }
    if (!biased || !exceeds_strength(works, step, rows) || round == kAlignRounds) return;
    for_plastic(works, [&](JointWork& work) { align_rows(work, step.h_s); });
    fill(group, works);
  }
}

void refresh_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                   const BodyRow* rows) {
  for (JointWork& work : works) work.pending = work.sum(work.impulse);
  renew_rows(group, works, step, rows);
  for_plastic(works, [&](JointWork& work) {
    absorb_flow(work, rows);
    align_rows(work, step.h_s);
  });
  fill(group, works);
  for (JointWork& work : works) work.pending = work.sum(work.impulse) - work.pending;
}

void solve_group_final(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                       BodyRow* rows) {
  for (JointWork& work : works) work.kept_impulse = std::exchange(work.impulse, {});
  renew_rows(group, works, step, rows);
  for_plastic(works, fix_flow);
  fill(group, works);
  solve_group(group, works, step, false, rows);
  for (JointWork& work : works) {
    work.total += impulse_of(work);
    work.impulse = work.kept_impulse;
  }
}

void scale_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const float* scale_of_row, BodyRow* rows) {
  const auto share_of = [&](const JointWork& work) {
    return scale_of_row[work.row_b > 0 ? work.row_b : work.row_a];
  };
  if (std::ranges::all_of(works, [&](const JointWork& work) { return share_of(work) == 1; }))
    return;
  for (JointWork& work : works) {
    const float share = share_of(work);
    work.total += -impulse_of(work);
    for (double& impulse : work.impulse) impulse *= double{share};
    work.pending = {share * work.pending.push, share * work.pending.angular_a,
                    share * work.pending.angular_b};
  }
  solve_group(group, works, step, false, rows);
  for (JointWork& work : works) work.total += impulse_of(work);
}

void break_overloaded_joints(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                             BodyRow* rows) {
  bool any = false;
  for_plastic(works, [&](JointWork& work) { record_axial(work, step.h_s); });
  for (JointWork& work : works) {
    if (work.broken) continue;
    const AnchorImpulse impulse = impulse_of(work);
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
    disable(work);
    any = true;
  }
  if (any) fill(group, works);
  if (!group.hangs_free) return;
  for (JointWork& work : works) work.pending = work.sum(work.impulse);
}

}  // namespace sunder::solver

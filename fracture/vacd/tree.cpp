// Cuts form a tree: the children of a piece are the islands on both sides of its cut. The tree is
// grown to more leaves than allowed, loosest hull first, and then pruned to the leaves of least
// total volume (as classification trees are: Breiman et al. 1984), so that a cut without gain may
// prepare one with gain.
#include "fracture/vacd/tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "fracture/tuning.h"
#include "fracture/vacd/branch.h"

namespace sunder::fracture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns the least total hull volume of two trees that share n + 1 leaves, by n.
std::vector<double> least_shared(const std::vector<double>& a, const std::vector<double>& b,
                                 std::size_t most) {
  std::vector<double> sum(std::min(most, a.size() + b.size()), kInfinity);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size() && i + j + 1 < sum.size(); ++j) {
      sum[i + j + 1] = std::min(sum[i + j + 1], a[i] + b[j]);
    }
  }
  return sum;
}

class Tree {
 public:
  Tree(std::vector<VacdPiece> pieces, const RefineLimits& limits, PlaneIdAllocator& plane_ids)
      : limits_(limits),
        ids_(plane_ids),
        roots_(pieces.size()),
        leaves_(pieces.size()),
        most_(limits.convexes > 0 ? std::max<std::size_t>(limits.convexes, pieces.size())
                                  : ~std::size_t{0}) {
    branches_.resize(pieces.size());
    for_chunks(pieces.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
      branches_[p] = make_branch(std::move(pieces[p]));
    });
    for (const Branch& branch : branches_) hull_m3_ += branch.hull_m3;
  }

  void grow();
  std::vector<VacdPiece> pruned();

 private:
  bool too_many_polygons(const Branch& branch) const {
    return branch.piece.mesh.faces.size() > limits_.polygons;
  }
  std::vector<std::uint32_t> loosest() const;
  std::vector<std::vector<double>> combined(const std::vector<std::uint32_t>& children) const;
  void collect_leaves(const std::vector<std::uint32_t>& siblings, std::size_t count,
                      std::vector<VacdPiece>& pieces);

  const RefineLimits limits_;
  PlaneIdAllocator& ids_;
  std::vector<Branch> branches_;
  const std::size_t roots_;
  std::size_t leaves_;
  const std::size_t most_;  ///< Maximum number of pieces.
  double hull_m3_ = 0;
  /// Per branch, by number of leaves less one: least total hull volume of its leaves.
  std::vector<std::vector<double>> least_;
};

/// Returns the leaves to be cut next, loosest first.
std::vector<std::uint32_t> Tree::loosest() const {
  std::vector<std::uint32_t> order;
  for (std::uint32_t n = 0; n < branches_.size(); ++n) {
    const Branch& branch = branches_[n];
    if (branch.tried || !branch.children.empty() || branch.piece.is_inside_mesh()) continue;
    const bool loose =
        limits_.convexes > 0 && branch.slack() > kTightSlack * hull_m3_ / limits_.convexes;
    if (loose || too_many_polygons(branch)) order.push_back(n);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const bool many_a = too_many_polygons(branches_[a]), many_b = too_many_polygons(branches_[b]);
    if (many_a != many_b) return many_a;
    return branches_[a].slack() != branches_[b].slack()
               ? branches_[a].slack() > branches_[b].slack()
               : a < b;
  });
  order.resize(std::min(order.size(), kPiecesCutAtOnce));
  return order;
}

void Tree::grow() {
  const double wanted = limits_.convexes > 0 ? kTreeOvergrowth * limits_.convexes : kInfinity;
  while (static_cast<double>(leaves_) < wanted) {
    const std::vector<std::uint32_t> next = loosest();
    if (next.empty()) return;
    if (limits_.progress) limits_.progress(static_cast<double>(leaves_) / wanted);
    std::vector<PlaneId> ids;
    for (std::size_t i = 0; i < next.size(); ++i) ids.push_back(ids_.next());
    std::vector<std::vector<Branch>> parts(next.size());
    for_chunks(next.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      parts[i] = cut_branch(branches_[next[i]], ids[i]);
    });
    for (std::size_t i = 0; i < next.size(); ++i) {
      branches_[next[i]].tried = true;
      if (parts[i].empty()) continue;
      leaves_ += parts[i].size() - 1;
      for (Branch& part : parts[i]) {
        branches_[next[i]].children.push_back(static_cast<std::uint32_t>(branches_.size()));
        branches_.push_back(std::move(part));
      }
    }
  }
}

/// Returns the least hull volumes of the first child, of the first two, and so on.
std::vector<std::vector<double>> Tree::combined(const std::vector<std::uint32_t>& children) const {
  std::vector<std::vector<double>> sums;
  for (const std::uint32_t child : children) {
    sums.push_back(sums.empty() ? least_[child] : least_shared(sums.back(), least_[child], most_));
  }
  return sums;
}

/// Appends the best `count` leaves below some siblings.
void Tree::collect_leaves(const std::vector<std::uint32_t>& siblings, std::size_t count,
                          std::vector<VacdPiece>& pieces) {
  const auto sums = combined(siblings);
  std::vector<std::size_t> share(siblings.size());
  for (std::size_t c = siblings.size(); c-- > 0; count -= share[c]) {
    const std::vector<double>& own = least_[siblings[c]];
    share[c] = count;
    for (std::size_t mine = 1; c > 0 && mine <= own.size(); ++mine) {
      if (count - mine < 1 || count - mine > sums[c - 1].size()) continue;
      if (sums[c - 1][count - mine - 1] + own[mine - 1] != sums[c][count - 1]) continue;
      share[c] = mine;
      break;
    }
  }
  for (std::size_t c = 0; c < siblings.size(); ++c) {
    Branch& branch = branches_[siblings[c]];
    if (share[c] == 1) {
      pieces.push_back(std::move(branch.piece));
    } else {
      collect_leaves(branch.children, share[c], pieces);
    }
  }
}

std::vector<VacdPiece> Tree::pruned() {
  least_.resize(branches_.size());
  for (std::size_t n = branches_.size(); n-- > 0;) {  // Children have larger indices than parents.
    const auto sums = combined(branches_[n].children);
    least_[n] = sums.empty() ? std::vector<double>(1) : sums.back();
    const double penalty_m3 = too_many_polygons(branches_[n]) ? 1e3 * hull_m3_ : 0;
    least_[n][0] = branches_[n].hull_m3 + penalty_m3;
  }
  std::vector<std::uint32_t> roots(roots_);
  std::iota(roots.begin(), roots.end(), 0u);
  std::vector<VacdPiece> pieces;
  if (roots.empty()) return pieces;
  const std::vector<double> all = combined(roots).back();
  const std::size_t count =
      limits_.convexes == 0
          ? leaves_
          : 1 + static_cast<std::size_t>(std::min_element(all.begin(), all.end()) - all.begin());
  collect_leaves(roots, count, pieces);
  return pieces;
}

}  // namespace

std::vector<VacdPiece> refine(std::vector<VacdPiece> pieces, const RefineLimits& limits,
                              PlaneIdAllocator& plane_ids) {
  const bool small = std::all_of(pieces.begin(), pieces.end(), [&](const VacdPiece& piece) {
    return piece.mesh.faces.size() <= limits.polygons;
  });
  if (limits.convexes == 0 && small) return pieces;
  Tree tree(std::move(pieces), limits, plane_ids);
  tree.grow();
  return tree.pruned();
}

}  // namespace sunder::fracture

// Blocks of 1, 4, 8 and 16 lanes, and the choice among them for the processor.
#include "solver/rigid/contact/contact_blocks.h"

#include <algorithm>
#include <vector>

#include "solver/base/lanes.h"

namespace sunder::solver {
namespace {

constexpr std::size_t kCacheLine = 64;

template <std::uint32_t kWidth>
class BlocksOf final : public ContactBlocks {
 public:
  std::unique_ptr<ContactBlocks> copy() const override {
    return std::make_unique<BlocksOf<kWidth>>();
  }
  std::uint32_t lanes() const override { return kWidth; }
  std::uint32_t size() const override { return used_; }
  void clear(std::size_t manifolds) override {
    used_ = 0;
    const std::size_t blocks = manifolds / kWidth + kMaxColors;
    if (blocks > blocks_.capacity()) blocks_.reserve(std::max(blocks, 2 * blocks_.size()));
  }
  void allocate_arms(bool wanted) override { arms_.resize(wanted ? used_ : 0); }
  void update_arms(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    const auto h_s = static_cast<float>(step.context.h_s);
    for (std::uint32_t i = begin; i < end; ++i)
      solver::update_arms(blocks_[i], arms_[i], step.rows, h_s);
  }
  void apply_arm_change(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i)
      solver::apply_arm_change(blocks_[i], arms_[i], step.rows);
  }
  void allocate_search() override { search_.resize(used_); }
  void add(std::uint32_t first, std::uint32_t count, bool split) override {
    for (std::uint32_t i = 0; i < count; i += kWidth) {
      // Blocks of the last step are overwritten, not cleared.
      if (used_ == blocks_.size()) blocks_.emplace_back();
      ConstraintBlock<kWidth>& block = blocks_[used_++];
      block.first = first + i;
      block.count = std::min(kWidth, count - i);
      block.split = split;
    }
  }

  void prepare(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (i + 1 < end) fetch_manifolds(blocks_[i + 1], step);
      prepare_block(step, blocks_[i], arms_.empty() ? nullptr : &arms_[i]);
    }
  }
  void warm_start(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i) solver::warm_start(blocks_[i], step.rows);
  }
  void sweep_biased(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (i + 1 < end) fetch_bodies(blocks_[i + 1], step);
      solver::sweep_biased(blocks_[i], step.rows, step.soft);
    }
  }
  void sweep_relaxed(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (i + 1 < end) fetch_bodies(blocks_[i + 1], step);
      solver::sweep_relaxed(blocks_[i], step.rows, step.soft);
    }
  }
  void sum_impulses(std::uint32_t begin, std::uint32_t end) override {
    for (std::uint32_t i = begin; i < end; ++i) solver::sum_impulses(blocks_[i]);
  }
  void scale_impulses(std::uint32_t begin, std::uint32_t end, const float* scale_of_row) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      ArmLanes<kWidth>* const arms = arms_.empty() ? nullptr : &arms_[i];
      solver::scale_impulses(blocks_[i], arms, scale_of_row);
    }
  }
  void record_spin_change(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                          const float* scale_of_row) override {
    const auto h_s = static_cast<float>(step.context.h_s);
    for (std::uint32_t i = begin; i < end; ++i)
      solver::record_spin_change(blocks_[i], arms_[i], step.rows, scale_of_row, h_s);
  }
  void save_impulses(std::uint32_t begin, std::uint32_t end) override {
    for (std::uint32_t i = begin; i < end; ++i) solver::save_impulses(blocks_[i], search_[i]);
  }
  void find_change_energy(std::uint32_t begin, std::uint32_t end, float* energy) const override {
    for (std::uint32_t i = begin; i < end; ++i) {
      float of_lane[kWidth];
      solver::find_change_energy(blocks_[i], search_[i], of_lane);
      std::copy_n(of_lane, std::min(blocks_[i].count, kWidth), energy + blocks_[i].first);
    }
  }
  void step_along_direction(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                            float beta) override {
    for (std::uint32_t i = begin; i < end; ++i)
      solver::step_along_direction(blocks_[i], search_[i], step.rows, beta);
  }
  bool apply_restitution(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    const auto h_s = static_cast<float>(step.context.h_s);
    bool any = false;
    for (std::uint32_t i = begin; i < end; ++i)
      any |= solver::apply_restitution(blocks_[i], arms_[i], step.rows, h_s);
    return any;
  }
  void allocate_impacts(std::size_t manifolds) override {
    // Overwritten, not cleared.
    if (impacts_.size() < used_) impacts_.resize(used_);
    if (pairs_.size() < manifolds) pairs_.resize(manifolds), contacts_.resize(manifolds);
  }
  void prepare_impact(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i)
      solver::prepare_impact(step, blocks_[i], impacts_[i]);
  }
  bool find_gaps(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    bool any = false;
    for (std::uint32_t i = begin; i < end; ++i)
      any |= solver::find_gaps(blocks_[i], impacts_[i], step.rows, step.soft.inverse_h);
    return any;
  }
  void extract_contacts(std::uint32_t begin, std::uint32_t end) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t first = blocks_[i].first;
      solver::extract_contacts(blocks_[i], impacts_[i], &pairs_[first], &contacts_[first]);
    }
  }
  bool propagate(std::uint32_t first, std::uint32_t count, const ContactStep& step,
                 const ImpactSweep& sweep) override {
    return solver::propagate<kWidth>(&pairs_[first], &contacts_[first], count, step.rows, step.soft,
                                     sweep);
  }
  void apply_propagation(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i)
      solver::apply_propagation(blocks_[i], impacts_[i], &contacts_[blocks_[i].first], step.rows);
  }
  void store(std::uint32_t begin, std::uint32_t end, const ContactStep& step) override {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (i + 1 < end) fetch_manifolds(blocks_[i + 1], step);
      find_work(blocks_[i], step.rows);
      store_block(step, blocks_[i]);
    }
  }

  Vec3 outside_impulse_Ns() const override {
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t i = 0; i < used_; ++i) {
      const ConstraintBlock<kWidth>& c = blocks_[i];
      for (std::uint32_t lane = 0; lane < c.count; ++lane)
        sum += (c.outside_sign[lane] * lane_of(c.total, lane)).template cast<double>();
    }
    return sum;
  }
  ContactWork work() const override {
    ContactWork sum;
    for (std::uint32_t i = 0; i < used_; ++i) {
      const WorkLanes<kWidth>& work = blocks_[i].work;
      for (std::uint32_t lane = 0; lane < blocks_[i].count; ++lane) {
        sum.normal_J += double{work.normal_J[lane]};
        sum.friction_J += double{work.friction_J[lane]};
        sum.drive_J += double{work.drive_J[lane]};
        sum.allowed_Ns += double{work.allowed_Ns[lane]};
        sum.excess_Ns += double{work.excess_Ns[lane]};
      }
    }
    return sum;
  }

 private:
  // Prefetches scattered memory one block ahead; the blocks themselves are contiguous.
  static void fetch_manifolds(const ConstraintBlock<kWidth>& c, const ContactStep& step) {
    for (std::uint32_t lane = 0; lane < c.count; ++lane) {
      const Manifold* m = &step.contacts.manifolds[step.manifolds[c.first + lane]];
      for (std::size_t at = 0; at < sizeof *m; at += kCacheLine)
        __builtin_prefetch(reinterpret_cast<const char*>(m) + at, 1);
    }
  }
  static void fetch_bodies(const ConstraintBlock<kWidth>& c, const ContactStep& step) {
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
      __builtin_prefetch(&step.rows.rows[c.row_a[lane]], 1);
      __builtin_prefetch(&step.rows.rows[c.row_b[lane]], 1);
    }
  }

  std::vector<ConstraintBlock<kWidth>> blocks_;
  std::vector<ArmLanes<kWidth>> arms_;
  std::vector<SearchLanes<kWidth>> search_;
  std::vector<ImpactLanes<kWidth>> impacts_;
  std::vector<ImpactPair> pairs_;  ///< By manifold to solve; so are contacts_.
  std::vector<ImpactContact> contacts_;
  std::uint32_t used_ = 0;
};

/// Returns the maximum number of lanes that the processor has instructions for.
int supported_lanes() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return 16;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") ? 8 : 4;
#else
  return 4;
#endif
}

}  // namespace

std::unique_ptr<ContactBlocks> make_contact_blocks(int most_lanes) {
  static const int kSupported = supported_lanes();
  const int most = most_lanes == 0 ? kSupported : std::min(most_lanes, kSupported);
  if (most >= 16) return std::make_unique<BlocksOf<16>>();
  if (most >= 8) return std::make_unique<BlocksOf<8>>();
  if (most >= 4) return std::make_unique<BlocksOf<4>>();
  return std::make_unique<BlocksOf<1>>();
}

}  // namespace sunder::solver

// A contact that comes into being at rest, as thousands do when a scene starts or a wall breaks,
// knows nothing of the load it is to bear. Soft contacts learn it by sinking, and meanwhile what
// stands on them moves. So contacts that come with new bodies are given, before their first solve,
// the impulses that would keep all at rest, and a rest separation at which they bear them without
// sinking. What nothing supports gets nothing: bodies that fall together do not press.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "solver/base/stage_runner.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/load_path.h"
#include "solver/rigid/contact/prepare.h"

namespace sunder::solver {

/// Four lanes are what every processor has, and bits must not follow the lanes.
inline constexpr std::uint32_t kStaticLanes = 4;
using Wide4 = WideOf<kStaticLanes>;
using StaticBlock = ConstraintBlock<kStaticLanes>;

/// Loads of one block's contacts, or a change of them.
struct BlockLoads {
  Wide4 press[4] = {};
  Wide4 slide_1 = {}, slide_2 = {}, twist = {};
};

class StaticWarmStart {
 public:
  /// Loads what is cold and hardly moves: what moves is under no load that could be known
  /// before. `factor`: 1; 0 for none; tests load too much by it.
  void apply(const StepContext& step, double factor, const Bodies& bodies, Contacts& contacts);

 private:
  bool collect(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void find_resting(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void make_blocks(const Contacts& contacts);
  void begin(const StepContext& step, const Bodies& bodies, const Contacts& contacts);
  void estimate(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void find_loads(const ContactStep& step, double kick_m_s);
  std::size_t find_supported(double kick_m_s, const Bodies& bodies);
  void release_overloaded(const Vec3& gravity_W, const SoftStep& soft, const Bodies& bodies,
                          const Contacts& contacts);
  void store(const SoftStep& soft, float stored_scale, float factor, const Bodies& bodies,
             Contacts& contacts) const;

  std::vector<ManifoldSlot> manifolds_;  ///< By colour and number of points.
  std::vector<StaticBlock> blocks_;
  std::vector<StageItems> colors_;  ///< The blocks of each; the overflow last.
  std::vector<BlockLoads> change_, direction_;
  std::vector<std::pair<double, double>> square_;  ///< Of each block's change, and of its loads.
  std::vector<BodyRow> rows_;                      ///< As row_of().
  ByBody<std::uint8_t> concerned_;
  std::vector<BodySlot> concerned_bodies_;
  ByBody<Mat3f> root_W_;
  ByBody<BodyLoad> loads_;
};

}  // namespace sunder::solver

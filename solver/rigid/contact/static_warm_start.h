// Static warm start. A contact that begins at rest, as thousands do when a scene starts or a wall
// breaks, has no impulse to start with. Soft contacts would get theirs by sinking, and the bodies
// on them would move meanwhile. So contacts of new bodies get, before their first solve, the
// impulses that keep all bodies at rest, and a rest separation at which they have these impulses
// without sinking. Bodies without support get none: bodies that fall together exert no force on
// each other.
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

/// Four lanes are available on every processor; results must not depend on the number of lanes.
inline constexpr std::uint32_t kStaticLanes = 4;
using Wide4 = WideOf<kStaticLanes>;
using StaticBlock = ConstraintBlock<kStaticLanes>;

/// Impulses of a block's contacts, or a change of them.
struct BlockImpulses {
  Wide4 normal[4] = {};
  Wide4 friction_1 = {}, friction_2 = {}, twist = {};
};

class StaticWarmStart {
 public:
  /// Sets the impulses of cold contacts that hardly move: the load of a moving body cannot be
  /// known. `factor` is 1, or 0 for no warm start; tests use others to overload contacts.
  void apply(const StepContext& step, double factor, const Bodies& bodies, Contacts& contacts);

 private:
  bool collect(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void find_resting(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void make_blocks(const Contacts& contacts);
  void begin(const StepContext& step, const Bodies& bodies, const Contacts& contacts);
  void estimate_impulses(const StepContext& step, const Bodies& bodies, Contacts& contacts);
  void find_impulses(const ContactStep& step, double gravity_dv_m_s);
  std::size_t find_supported(double gravity_dv_m_s, const Bodies& bodies);
  void mark_overloaded(const Vec3& gravity_W, const SoftStep& soft, const Bodies& bodies,
                       const Contacts& contacts);
  void store(const SoftStep& soft, float factor, const Bodies& bodies, Contacts& contacts) const;

  std::vector<ManifoldSlot> manifolds_;  ///< By colour and number of points.
  std::vector<StaticBlock> blocks_;
  std::vector<StageItems> colors_;  ///< Blocks of each colour; those without a colour last.
  std::vector<BlockImpulses> change_, direction_;
  /// Squares of each block's change and of its impulses.
  std::vector<std::pair<double, double>> square_;
  std::vector<BodyRow> rows_;  ///< By row_of().
  ByBody<std::uint8_t> involved_;
  std::vector<BodySlot> involved_bodies_;
  ByBody<Mat3f> root_W_;
  ByBody<BodyImpulse> loads_;
};

}  // namespace sunder::solver

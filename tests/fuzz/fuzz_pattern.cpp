// Any bytes as a pattern file: a pattern that breaks a box without losing any of it, or an
// InputError.
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "engine/base/check.h"
#include "fracture/fracture.h"
#include "fracture/solids.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  if (size > 4096) return 0;
  std::istringstream obj(std::string(data, data + size));
  try {
    const fracture::Pattern pattern = fracture::read_pattern(obj, "fuzz.obj");
    const Compound box = fracture::box_compound(Vec3(-.7, -.5, -.6), Vec3(.8, .9, .5));
    const BreakPlan plan = fracture::fracture(box, pattern, {}, {Vec3::Zero(), 1}, 1);
    double sum = plan.debris_volume_m3;
    for (const Compound& piece : plan.pieces) sum += volume(piece);
    SUNDER_CHECK(std::abs(sum - volume(box)) <= 1e-12 * volume(box));
  } catch (const InputError&) {
  }
  return 0;
}

// Fuzz target: any bytes as a pattern file break a box and keep its volume, or give an InputError.
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "engine/base/check.h"
#include "fracture/fracture.h"
#include "fracture/solids.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

void break_by_file(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > 4096) return;
  std::istringstream obj(std::string(bytes.begin(), bytes.end()));
  try {
    const fracture::Pattern pattern = fracture::read_pattern(obj, "fuzz.obj");
    const Compound box = fracture::box_compound(Vec3(-.7, -.5, -.6), Vec3(.8, .9, .5));
    const BreakPlan plan = fracture::fracture(box, pattern, {}, {Vec3::Zero(), 1}, 1);
    double sum = plan.debris_volume_m3;
    for (const Compound& piece : plan.pieces) sum += volume(piece);
    SUNDER_CHECK(std::abs(sum - volume(box)) <= 1e-12 * volume(box));
  } catch (const InputError&) {
  }
}

const fuzz::Registration pattern_target("pattern", break_by_file);

}  // namespace
}  // namespace sunder

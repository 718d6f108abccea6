// A break can be carried out again from its case file.
#include "fracture/case_file.h"

#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "fracture/pattern_breaker.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

BreakCase example(const char* solid = "voronoi:7") {
  BreakCase example{make_solid(solid), {}};
  example.compound.anchored[2] = kAnchoredAllRound;
  example.command.event = 0xfedcba9876543210;
  example.command.seed = 5;
  example.command.pattern.kind = PatternSpec::Kind::kVoronoi;
  example.command.pattern.cells = 30;
  example.command.pattern.file = "a file with \"quotes\"";
  example.command.stretch_P = Vec3(1, 1. / 3, 1).asDiagonal();
  example.command.X_RP.position = Vec3(.7, .1, .1);
  return example;
}

TEST(CaseFile, replays_to_the_same_bits) {
  const auto breaker = make_pattern_breaker();
  const double endless = std::numeric_limits<double>::infinity();
  for (const auto& [solid, radius] : {std::pair("voronoi:7", .6), std::pair("voronoi:7", endless),
                                      std::pair("hall:2", 1.5), std::pair("hall:2", endless)}) {
    BreakCase written = example(solid);
    written.command.radius_m = radius;
    std::stringstream file;
    write_case(file, written);
    const BreakCase read = read_case(file, "a.case");
    EXPECT_EQ(hash_of(read.compound), hash_of(written.compound));
    EXPECT_EQ(read.compound.anchored, written.compound.anchored);
    EXPECT_EQ(read.command.pattern.file, written.command.pattern.file);
    const BreakPlan again = breaker->plan(read.compound, read.command);
    EXPECT_TRUE(again.broke());
    EXPECT_EQ(hash_of(again), hash_of(breaker->plan(written.compound, written.command)));
  }
}

TEST(CaseFile, cut_short_anywhere_is_an_error) {
  std::stringstream file;
  write_case(file, example("hall:2"));
  const std::string text = file.str();
  for (std::size_t length = 0; length + 40 < text.size(); length += 197) {
    std::istringstream part(text.substr(0, length));
    EXPECT_THROW(read_case(part, "a.case"), InputError) << length;
  }
}

}  // namespace
}  // namespace sunder::fracture

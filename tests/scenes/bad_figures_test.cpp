// Tests of values in scene files that are each allowed, but contradict each other or have no
// effect: they are refused with place, key and remedy.
#include <gtest/gtest.h>

#include "tests/scenes/refusal.h"

namespace sunder::scenes {
namespace {

/// Returns the message that refuses a scene with these lines from line 3 on; empty if accepted.
std::string refusal_of(const std::string& lines, std::vector<std::string> set = {}) {
  LoadOptions options;
  options.set = std::move(set);
  return refusal(kGood + lines + "\n", options);
}

void expect_refusals(std::initializer_list<Fault> faults, const std::string& before) {
  for (const Fault& fault : faults) {
    const std::string message = refusal_of(before + fault.lines);
    EXPECT_TRUE(message.starts_with(fault.message))
        << fault.lines << "\nexpected: " << fault.message << "\nsaid:     " << message;
  }
}

TEST(BadMaterials, WhoseFiguresContradictEachOtherAreRefused) {
  expect_refusals(
      {{"name = \"x\"\nyoungs_Pa = 1e9\ntensile_Pa = 1.1e8",
        "bad.toml:6: tensile_Pa = 1.1e+08 in [[material]] is above the theoretical strength of a "
        "solid, a tenth of youngs_Pa = 1e+09 (bad.toml:5); lower tensile_Pa, or raise youngs_Pa"},
       {"name = \"x\"\nshear_Pa = 4e9",
        "bad.toml:5: shear_Pa = 4e+09 in [[material]] is above the theoretical strength of a "
        "solid, a tenth of youngs_Pa = 3e+10 (not given here); lower shear_Pa, or raise youngs_Pa"},
       {"name = \"brick\"\nyoungs_Pa = 7e7",
        "bad.toml:5: compressive_Pa = 8e+06 (not given here) in [[material]] is above the "
        "theoretical strength of a solid, a tenth of youngs_Pa = 7e+07 (bad.toml:5); lower "
        "compressive_Pa, or raise youngs_Pa"},
       {"name = \"x\"\nlike = \"steel\"\nyield_Pa = 1e11",
        "bad.toml:6: yield_Pa = 1e+11 in [[material]] is above the theoretical strength of a "
        "solid, a tenth of youngs_Pa = 2e+11 (not given here); lower yield_Pa, or raise youngs_Pa"},
       {"name = \"x\"\ntensile_Pa = 3e6\ncompressive_Pa = 2e6",
        "bad.toml:6: compressive_Pa = 2e+06 in [[material]] is below tensile_Pa = 3e+06 "
        "(bad.toml:5); raise compressive_Pa, or lower tensile_Pa"},
       {"name = \"concrete\"\ntensile_Pa = 4e7",
        "bad.toml:5: compressive_Pa = 3e+07 (not given here) in [[material]] is below tensile_Pa = "
        "4e+07 (bad.toml:5); raise compressive_Pa, or lower tensile_Pa"}},
      "[[material]]\n");
}

TEST(BadMaterials, UnlimitedOrConsistentStrengthsAreAccepted) {
  for (const char* figures :
       {"tensile_Pa = inf", "tensile_Pa = 3e6\ncompressive_Pa = 0", "compressive_Pa = 1",
        "tensile_Pa = 3e6\ncompressive_Pa = 3e6", "youngs_Pa = 1e9\nshear_Pa = 1e8"}) {
    EXPECT_EQ(refusal_of(std::string("[[material]]\nname = \"x\"\n") + figures), "") << figures;
  }
}

TEST(BadMaterials, FiguresSetByFlagsAreNamedWithTheirFlags) {
  const std::string stone = "[[material]]\nname = \"x\"\ntensile_Pa = 2e6";
  EXPECT_EQ(refusal_of(stone, {"material.0.youngs_Pa=1e7"}),
            "bad.toml:5: tensile_Pa = 2e+06 in [[material]] is above the theoretical strength of a "
            "solid, a tenth of youngs_Pa = 1e+07 (--set material.0.youngs_Pa=1e7); lower "
            "tensile_Pa, or raise youngs_Pa");
  EXPECT_EQ(refusal_of(stone, {"material.0.tensile_Pa=1e12"}),
            "--set material.0.tensile_Pa=1e12: tensile_Pa = 1e+12 in [[material]] is above the "
            "theoretical strength of a solid, a tenth of youngs_Pa = 3e+10 (not given here); lower "
            "tensile_Pa, or raise youngs_Pa");
}

TEST(BadBlasts, ThatDoNothingAreRefused) {
  expect_refusals({{"impulse_Ns_m2 = 0",
                    "bad.toml:6: impulse_Ns_m2 in [[script.blast]] is the number 0; allowed: a "
                    "number from 0.001 to 1e+09, in N·s/m²"},
                   {"radius_m = 0",
                    "bad.toml:6: radius_m in [[script.blast]] is the number 0; allowed: a number "
                    "from 0.01 to 1000, in m"},
                   {"tnt_kg = 0",
                    "bad.toml:6: tnt_kg in [[script.blast]] is the number 0; allowed: a number "
                    "from 0.001 to 1e+06, in kg"}},
                  "[[script.blast]]\ntime_s = 1\nat = [0, 0, 0]\n");
}

TEST(BadBlasts, OfTwoStrengthsAreRefused) {
  expect_refusals({{"tnt_kg = 1\nimpulse_Ns_m2 = 100",
                    "bad.toml:7: impulse_Ns_m2 in [[script.blast]] is given beside tnt_kg, which "
                    "decides it; keep one"},
                   {"tnt_kg = 1\nradius_m = 100",
                    "bad.toml:7: radius_m in [[script.blast]] is given beside tnt_kg, which "
                    "decides it; keep one"},
                   {"burst = \"air\"",
                    "bad.toml:6: burst in [[script.blast]] is for a charge; give tnt_kg, or take "
                    "it away"}},
                  "[[script.blast]]\ntime_s = 1\nat = [0, 0, 0]\n");
  EXPECT_EQ(refusal_of("[[script.blast]]\ntime_s = 1\nat = [0, 0, 0]\ntnt_kg = 2\nburst = \"air\""),
            "");
}

}  // namespace
}  // namespace sunder::scenes

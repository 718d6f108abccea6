#include "scenes/file/patterns.h"

#include <cmath>
#include <string>
#include <string_view>

#include "engine/base/check.h"
#include "fracture/pattern/pattern.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

/// Theoretical strength of a flawless solid over Young's modulus. Atomic bonds break at a stress of
/// sqrt(E·gamma/a), which is E/10 within a factor of two (A. A. Griffith, Phil. Trans. R. Soc. A
/// 221, 1921; E. Orowan, Rep. Prog. Phys. 12, 1949). No bulk solid reaches this strength.
constexpr double kTheoreticalStrength = 0.1;

/// A property of a material, with its key.
struct Figure {
  std::string_view key;
  double value = 0;

  bool breaks() const { return value > 0 && std::isfinite(value); }
  std::string text() const { return std::string(key) + " = " + format(value); }
};

/// Throws InputError: the property `wrong` contradicts `limit`, as `why` says. The message has the
/// place of each property that the table gives; any other is inherited, or a default.
[[noreturn]] void refuse(const Value& table, const Figure& wrong, const std::string& why,
                         const Figure& limit, const std::string& remedy) {
  const Value* wrong_at = find(table, wrong.key);
  const Value* limit_at = find(table, limit.key);
  const std::string where = (wrong_at ? *wrong_at : limit_at ? *limit_at : table).where;
  throw InputError(where + ": " + wrong.text() + (wrong_at ? "" : " (not given here)") +
                   " in [[material]] " + why + " " + limit.text() + " (" +
                   (limit_at ? limit_at->where : "not given here") + "); " + remedy);
}

}  // namespace

void read_pattern(const Value& table, const std::filesystem::path& folder, PatternSpec& pattern) {
  read(schema().pattern, table, {}, pattern);
  using Kind = PatternSpec::Kind;
  if (pattern.kind == Kind::kGrid && pattern.cells > ranges::kMostGridCells) {
    const Value* cells = find(table, "cells");
    throw InputError((cells ? *cells : table).where + ": cells in [material.pattern] is " +
                     std::to_string(pattern.cells) + " along each side of a grid; allowed: " +
                     format(ranges::kCells.low) + " to " + format(ranges::kMostGridCells));
  }
  if (pattern.kind != Kind::kFile) return;
  const Value* file = find(table, "file");
  if (pattern.file.empty()) {
    throw InputError(table.where +
                     ": kind = \"file\" in [material.pattern] needs file = \"X.obj\"");
  }
  if (file) pattern.file = (folder / pattern.file).string();
  try {
    fracture::make_pattern(pattern, {}, 0);
  } catch (const InputError& error) {
    throw InputError((file ? *file : table).where + ": " + error.what());
  }
}

void read_stronger(const Value& table, const std::filesystem::path& folder, Material& material) {
  if (!find(table, "stronger")) return;
  material.stronger.clear();
  for (const Value* entry : tables(table, "stronger")) {
    ImpactResponse impact{0, material.pattern, material.impact_radius_m};
    read(schema().stronger, *entry, {}, impact);
    if (const Value* pattern = find(*entry, "pattern")) {
      read_pattern(*pattern, folder, impact.pattern);
    }
    if (!material.stronger.empty() && impact.energy_J <= material.stronger.back().energy_J) {
      throw InputError(entry->where + ": energy_J in [[material.stronger]] is " +
                       format(impact.energy_J) +
                       ", not more than in the previous entry; sort the entries by energy_J");
    }
    material.stronger.push_back(std::move(impact));
  }
}

void check_strengths(const Value& table, const Material& material) {
  const Figure stiffness{"youngs_Pa", material.youngs_Pa};
  const Figure tensile{"tensile_Pa", material.tensile_Pa};
  const Figure compressive{"compressive_Pa", material.compressive_Pa};
  for (const Figure& strength : {tensile, Figure{"shear_Pa", material.shear_Pa}, compressive,
                                 Figure{"yield_Pa", material.yield_Pa}}) {
    if (!strength.breaks() || strength.value <= kTheoreticalStrength * stiffness.value) continue;
    refuse(table, strength, "is above the theoretical strength of a solid, a tenth of", stiffness,
           "lower " + std::string(strength.key) + ", or raise youngs_Pa");
  }
  // Only fibrous materials, such as wood, bear more tension; materials of scenes are isotropic.
  if (tensile.breaks() && compressive.breaks() && compressive.value < tensile.value) {
    refuse(table, compressive, "is below", tensile, "raise compressive_Pa, or lower tensile_Pa");
  }
}

}  // namespace sunder::scenes

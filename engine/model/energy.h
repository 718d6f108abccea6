// Accounting of kinetic energy: changes of the energy of all bodies, by cause (docs/decisions/048).
#pragma once

namespace sunder {

/// Changes of the kinetic energy of all bodies that are neither static nor kinematic, in J.
struct EnergyFlows {
  double gravity = 0;  ///< Work of gravity.
  /// Work of drives, of blasts, of contacts with kinematic bodies, and of what slows down bodies
  /// that are too fast (Limit::kSpeeds).
  double drives = 0;
  /// Energy of bodies that the script added, less that of bodies that it removed.
  double script = 0;
  // Losses:
  double cracks = 0;    ///< Energy of new crack area.
  double crushing = 0;  ///< Energy of perforation, beyond its cracks.
  double contacts = 0;  ///< Loss in normal impulses of contacts: plastic impacts.
  double friction = 0;  ///< Loss in sliding, torsional and rolling friction.
  double joints = 0;    ///< Loss in joints that are not plastic.
  double bending = 0;   ///< Loss in plastic joints.
  double debris = 0;    ///< Energy of pieces that are too small for bodies.
  double sleep = 0;     ///< Energy of bodies when they fell asleep.

  /// Calls visit(name, value, sign) for each cause; sign is +1 for gains, −1 for losses.
  template <class Self, class Visit>
  static void for_each(Self& self, const Visit& visit) {
    visit("gravity", self.gravity, 1), visit("drives", self.drives, 1);
    visit("script", self.script, 1);
    visit("cracks", self.cracks, -1), visit("crushing", self.crushing, -1);
    visit("contacts", self.contacts, -1), visit("friction", self.friction, -1);
    visit("joints", self.joints, -1), visit("bending", self.bending, -1);
    visit("debris", self.debris, -1), visit("sleep", self.sleep, -1);
  }

  EnergyFlows& operator+=(const EnergyFlows& o) {
    gravity += o.gravity, drives += o.drives, script += o.script;
    cracks += o.cracks, crushing += o.crushing, contacts += o.contacts, friction += o.friction;
    joints += o.joints, bending += o.bending, debris += o.debris, sleep += o.sleep;
    return *this;
  }
  /// Returns the net change of the kinetic energy.
  double sum() const {
    double total = 0;
    for_each(*this, [&](const char*, double value, int sign) { total += sign * value; });
    return total;
  }
  /// Returns the sum of absolute values.
  double moved() const {
    double total = 0;
    for_each(*this, [&](const char*, double value, int) { total += value < 0 ? -value : value; });
    return total;
  }
};

}  // namespace sunder

// The energy book: what changed the kinetic energy of the bodies of a run, by cause.
#pragma once

namespace sunder {

/// Changes of the kinetic energy of all bodies that are neither static nor kinematic, J.
struct EnergyFlows {
  double gravity = 0;  ///< Work of gravity.
  double drives = 0;   ///< Work of drives, blasts, and contacts with kinematic bodies.
  double script = 0;   ///< Of bodies that came in, less that of bodies that were taken away.
  // Taken from the motion:
  double cracks = 0;    ///< By new crack surface.
  double crushing = 0;  ///< By perforation, beyond its cracks.
  double contacts = 0;  ///< By normal impulses of contacts: plastic impacts.
  double friction = 0;  ///< By sliding, twisting and rolling friction.
  double joints = 0;    ///< By joints that do not bend.
  double bending = 0;   ///< By plastic joints.
  double debris = 0;    ///< Carried off by pieces that are too small for bodies.
  double sleep = 0;     ///< By bodies that were put to sleep.

  /// Calls visit(name, value, sign) for each; sign is +1 for what is added, −1 for what is taken.
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
  /// The change of the kinetic energy that they amount to.
  double sum() const {
    double total = 0;
    for_each(*this, [&](const char*, double value, int sign) { total += sign * value; });
    return total;
  }
  /// Sum of their sizes: the energy that changed hands.
  double moved() const {
    double total = 0;
    for_each(*this, [&](const char*, double value, int) { total += value < 0 ? -value : value; });
    return total;
  }
};

}  // namespace sunder

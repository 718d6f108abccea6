#include "solver/rigid/contact/contact_reports.h"

#include <algorithm>

namespace sunder::solver {

std::vector<ContactLoad> find_contact_loads(const Contacts& contacts, const Bodies& bodies,
                                            const Shapes& shapes) {
  std::vector<const Manifold*> loaded;
  for (const Manifold& m : contacts.manifolds)
    if (m.count > 0 && (bodies.reports_load[m.body_a] || bodies.reports_load[m.body_b]))
      loaded.push_back(&m);
  std::sort(loaded.begin(), loaded.end(), [&](const Manifold* m, const Manifold* n) {
    return contacts.pairs[m->pair].key() < contacts.pairs[n->pair].key();
  });
  std::vector<ContactLoad> loads;
  for (const Manifold* loaded_m : loaded) {
    const Manifold& m = *loaded_m;
    const Pair& pair = contacts.pairs[m.pair];
    const Vec3 impulse = m.step_impulse_W.cast<double>();
    if (impulse.isZero(0)) continue;
    const Vec3 point = bodies.position[m.body_a] + m.middle_of_load().cast<double>();
    for (const bool on_b : {false, true}) {
      const BodySlot body = on_b ? m.body_b : m.body_a;
      if (!bodies.reports_load[body]) continue;
      const Shape& shape = shapes[on_b ? pair.shape_b : pair.shape_a];
      loads.push_back({bodies.tag[body], shape.tag, on_b ? impulse : Vec3(-impulse), point});
    }
  }
  return loads;
}

std::vector<float> find_penetrations(const Contacts& contacts) {
  std::vector<float> depths;
  for (const Manifold& m : contacts.manifolds)
    for (std::size_t i = 0; i < m.count; ++i)
      if (m.points[i].impulse_Ns > 0) depths.push_back(std::max(0.f, -m.points[i].separation_m));
  return depths;
}

}  // namespace sunder::solver

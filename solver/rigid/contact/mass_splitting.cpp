#include "solver/rigid/contact/mass_splitting.h"

namespace sunder::solver {

void MassSplitting::split(std::span<const ManifoldSlot> manifolds, const Bodies& bodies,
                          const Contacts& contacts) {
  sides_.assign(manifolds.size(), {});
  if (manifolds.empty()) return;
  count_.assign(bodies.size(), 0);
  end_.assign(bodies.size(), 0);
  auto for_each_body = [&](const auto& visit) {
    for (std::size_t i = 0; i < manifolds.size(); ++i) {
      const Manifold& m = contacts.manifolds[manifolds[i]];
      if (bodies.awake(m.body_a)) visit(m.body_a, sides_[i].part_a, sides_[i].parts_a);
      if (bodies.awake(m.body_b)) visit(m.body_b, sides_[i].part_b, sides_[i].parts_b);
    }
  };
  for_each_body([&](BodySlot body, auto&, auto&) { ++count_[body]; });
  std::uint32_t all = 0;
  for (const BodySlot body : bodies.slots()) {
    end_[body] = all;
    all += count_[body];
  }
  for_each_body([&](BodySlot body, std::uint32_t& part, std::uint32_t& parts) {
    part = end_[body]++;
    parts = count_[body];
  });
  parts_.resize(all);
}

void MassSplitting::join(BodySlot body, BodyRow& row) const {
  if (sides_.empty() || count_[body] == 0) return;
  const std::uint32_t end = end_[body];
  Wide sum = parts_[end - count_[body]];
  for (std::uint32_t i = end - count_[body] + 1; i < end; ++i) sum += parts_[i];
  row.velocity += sum;
}

}  // namespace sunder::solver

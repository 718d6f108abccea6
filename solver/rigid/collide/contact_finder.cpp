#include "solver/rigid/collide/contact_finder.h"

#include "solver/rigid/tuning.h"

namespace sunder::solver {

std::span<const ManifoldSlot> ContactFinder::of(BodySlot body) {
  if (all_.empty()) {
    std::vector<ShapeSlot> shapes;
    if (broad_phase_) shapes = shapes_.of_body(body, bodies_);
    queries_ += shapes.size();
    if (broad_phase_ && queries_ * kManifoldsPerQuery <= contacts_.manifolds.size()) {
      found_.clear();
      for (const PairSlot pair : broad_phase_->pairs_with(shapes, shapes_, contacts_))
        if (contacts_.pairs[pair].touching()) found_.push_back(contacts_.pairs[pair].manifold);
      looked_at_ += found_.size();
      return found_;
    }
    all_ = ContactsOfBodies(contacts_, bodies_);
    looked_at_ += contacts_.manifolds.size();
  }
  looked_at_ += all_.of(body).size();
  return all_.of(body);
}

}  // namespace sunder::solver

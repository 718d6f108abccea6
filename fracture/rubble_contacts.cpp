// What touches among fragments, their neighbours and ghosts.
#include <algorithm>
#include <set>
#include <tuple>

#include "fracture/rubble.h"

namespace sunder::fracture {

Rubble::Rubble(const Structure& structure, const std::vector<std::uint32_t>& touched,
               const Fragments& fragments)
    : structure_(structure),
      touched_(touched),
      fragments_(fragments.all),
      ghosts_(fragments.ghosts),
      first_fragment_(structure.slot_count()) {
  find_contacts_of_fragments();
}

void Rubble::find_neighbours() {
  const auto add = [&](std::uint32_t slot) {
    if (!is_touched(slot)) neighbours_.push_back(slot);
  };
  for (const std::uint32_t slot : touched_) {
    for (const Link& link : structure_.links(slot)) add(link.other);
    for (const std::uint32_t number : structure_.ghosts_of(slot)) {
      for (const std::uint32_t other : structure_.ghost(number).of) add(other);
    }
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
}

/// The faces by which neighbours touched what was cut.
void Rubble::add_neighbours(std::vector<ConvexPtr>& convexes, std::vector<FaceEntry>& faces) const {
  for (std::uint32_t i = 0; i < neighbours_.size(); ++i) {
    convexes.push_back(structure_.convex(neighbours_[i]));
    std::uint32_t last_face = 0xffffffff;
    for (const Link& link : structure_.links(neighbours_[i])) {
      if (!is_touched(link.other) || link.face == last_face) continue;
      last_face = link.face;
      faces.push_back(known_face(*convexes.back(), i, link.face));
    }
  }
  const auto same = [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) == std::tie(y.convex, y.face);
  };
  std::sort(faces.begin(), faces.end(), [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) < std::tie(y.convex, y.face);
  });
  faces.erase(std::unique(faces.begin(), faces.end(), same), faces.end());
}

/// Ghosts that weigh, by nodes: those that were cut, and those among neighbours, of which only the
/// faces count that are in the planes given.
std::vector<Ghost> Rubble::add_ghosts(std::vector<ConvexPtr>& convexes,
                                      std::vector<FaceEntry>& faces) const {
  std::vector<Ghost> ghosts = ghosts_;
  std::vector<std::uint32_t> known;
  for (const std::uint32_t slot : neighbours_) {
    for (const std::uint32_t number : structure_.ghosts_of(slot)) {
      if (!is_any_touched(structure_.ghost(number))) known.push_back(number);
    }
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const std::uint32_t number : known) ghosts.push_back(structure_.ghost(number));
  std::erase_if(ghosts, [](const Ghost& ghost) { return ghost.sign == 0; });
  if (ghosts.empty()) return ghosts;

  std::set<PlaneId> planes;
  for (const FaceEntry& face : faces) planes.insert(face.id);
  for (const Ghost& ghost : ghosts) {
    const auto index = static_cast<std::uint32_t>(convexes.size());
    const std::size_t first = faces.size();
    add_faces(*ghost.convex, index, faces);
    convexes.push_back(ghost.convex);
    if (is_fragment(ghost.of.back())) continue;
    const auto at = faces.begin() + static_cast<std::ptrdiff_t>(first);
    for (auto face = at; face != faces.end(); ++face) face->known = true;
    faces.erase(std::remove_if(at, faces.end(),
                               [&](const FaceEntry& face) { return !planes.contains(face.id); }),
                faces.end());
  }
  return ghosts;
}

void Rubble::find_contacts_of_fragments() {
  find_neighbours();
  // Neighbours first, then fragments: the order of nodes; then ghosts.
  std::vector<ConvexPtr> convexes;
  std::vector<FaceEntry> faces;
  add_neighbours(convexes, faces);
  for (const Fragment& fragment : fragments_) {
    add_faces(*fragment.convex, static_cast<std::uint32_t>(convexes.size()), faces);
    convexes.push_back(fragment.convex);
  }
  const auto count = static_cast<std::uint32_t>(convexes.size());
  const std::vector<Ghost> ghosts = add_ghosts(convexes, faces);
  for (const Bond& bond : find_contacts(convexes, faces)) {
    if (bond.b >= count) {
      correct(bond, count, ghosts);
    } else {
      contacts_.push_back(
          {node_of(bond.a), node_of(bond.b), bond.face_a, bond.face_b, bond.area_m2});
    }
  }
}

/// Puts down a contact with at least one ghost to the first convexes of ghosts that have the face.
void Rubble::correct(const Bond& bond, std::uint32_t convexes, const std::vector<Ghost>& ghosts) {
  Correction correction{{0, 0, bond.face_a, bond.face_b, bond.area_m2}, 1};
  const auto resolve = [&](std::uint32_t index, std::uint32_t& node, std::uint32_t& face) {
    if (index < convexes) {
      node = node_of(index);
      return true;
    }
    const Ghost& ghost = ghosts[index - convexes];
    correction.sign *= ghost.sign;
    const PlaneId id = ghost.convex->polyhedron.faces[face].id;
    for (const std::uint32_t of : ghost.of) {
      const auto& own = convex(of)->polyhedron.faces;
      const auto at = std::find_if(own.begin(), own.end(), [&](auto& f) { return f.id == id; });
      if (at == own.end()) continue;
      node = of;
      face = static_cast<std::uint32_t>(at - own.begin());
      return true;
    }
    return false;
  };
  Contact& contact = correction.contact;
  if (resolve(bond.a, contact.a, contact.face_a) && resolve(bond.b, contact.b, contact.face_b)) {
    corrections_.push_back(correction);
  }
}

}  // namespace sunder::fracture

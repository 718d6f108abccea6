// Steps 4 and 5 of a fracture: what the cuts left is put together again, as pieces (paper 3.1).
//
// Read first: edit(). The constructor finds what touches, edit() what holds together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/cut/fragments.h"

namespace sunder::fracture {

/// Fragments and their neighbours, on their way into pieces. A node is a slot of the structure, or
/// from `slot_count()` on a fragment.
class Reassembly {
 public:
  /// Of the fragments that the convexes in slots `touched`, ascending, which `sphere` reaches, were
  /// cut into. All four must outlive it.
  Reassembly(const Structure& structure, const std::vector<ConvexSlot>& touched,
             const Fragments& fragments, const ImpactSphere& sphere);

  /// What becomes of the structure.
  BreakEdit edit();

 private:
  /// A contact with at least one fragment, by nodes.
  struct Contact {
    std::uint32_t a, b, face_a, face_b;
    double area_m2;
  };
  /// Contacts among ghosts and with them, for `sign` times their area, as if among their convexes:
  /// so area counts once where convexes overlap.
  struct Correction {
    Contact contact;
    int sign;
  };

  bool is_touched(ConvexSlot slot) const {
    return std::binary_search(touched_.begin(), touched_.end(), slot);
  }
  bool is_any_touched(const Ghost& ghost) const {
    return std::any_of(ghost.of.begin(), ghost.of.end(),
                       [&](std::uint32_t slot) { return is_touched(ConvexSlot(slot)); });
  }
  bool is_fragment(std::uint32_t node) const { return node >= first_fragment_; }
  const Fragment& fragment(std::uint32_t node) const { return fragments_[node - first_fragment_]; }
  std::uint32_t group(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).group : Fragment::kRest;
  }
  /// The node of convex number `index` in the order neighbours, fragments.
  std::uint32_t node_of(std::uint32_t index) const {
    const auto neighbours = static_cast<std::uint32_t>(neighbours_.size());
    return index < neighbours ? neighbours_[index].value : first_fragment_ + index - neighbours;
  }
  const ConvexPtr& convex(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).convex : structure_.convex(ConvexSlot(node));
  }

  /// Of one side of a contact: what a crack there takes.
  MaterialIndex cracked(std::uint32_t node, std::uint32_t other) const {
    const MaterialIndex own = convex(node)->material;
    return sphere_.spares(own) ? convex(other)->material : own;
  }

  void find_contacts_of_fragments();
  void find_neighbours();
  void add_neighbours(std::vector<ConvexPtr>& convexes, std::vector<FaceEntry>& faces) const;
  std::vector<Ghost> add_ghosts(std::vector<ConvexPtr>& convexes,
                                std::vector<FaceEntry>& faces) const;
  void correct(const Bond& bond, std::uint32_t convexes, const std::vector<Ghost>& ghosts);
  void join_rest(std::uint32_t a, std::uint32_t b);
  std::vector<std::vector<std::uint32_t>> find_pieces();
  void separate_rest(std::vector<std::vector<std::uint32_t>>& pieces);
  void join_groups(std::vector<std::vector<std::uint32_t>>& pieces) const;
  void keep_rest(BreakEdit& edit);
  Compound make_piece(const std::vector<std::uint32_t>& nodes) const;
  void place_ghosts(BreakEdit& edit) const;
  void expose(BreakPlan& plan) const;
  /// Piece (0: the structure) and index of a node, after the break.
  std::pair<std::uint32_t, std::uint32_t> place(std::uint32_t node) const {
    const auto it = places_.find(node);
    return it == places_.end() ? std::pair{0u, node} : it->second;
  }

  const Structure& structure_;
  const std::vector<ConvexSlot>& touched_;
  const std::vector<Fragment>& fragments_;
  const std::vector<Ghost>& ghosts_;  ///< Those that were cut, by nodes.
  const ImpactSphere& sphere_;
  std::uint32_t first_fragment_;
  std::vector<Contact> contacts_;
  std::vector<Correction> corrections_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rest_contacts_;
  std::vector<ConvexSlot> neighbours_;  ///< Beside touched ones.
  std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> places_;
};

}  // namespace sunder::fracture

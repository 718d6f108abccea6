// The structure `compound`: a solid of other structures as parts, which touch or overlap.
//
// Read first: build_compound().
#include <algorithm>
#include <cstdint>
#include <utility>

#include "fracture/adjacency/islands.h"
#include "scenes/file/moved_part.h"
#include "scenes/file/placement.h"
#include "scenes/file/schema.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct NoParameters {};

/// The parts of all copies of a [[solid.part]].
struct Member {
  const Value* table;
  std::vector<Part> parts;
};

Member read_member(const Value& table, const BuildContext& context) {
  const Keys<PartHead>& keys = schema().part;
  PartHead head;
  read_keys(table, keys.table, keys.keys, {}, &head);
  const std::vector<Copy> copies = read_copies(table, keys.table);
  const std::vector<Piece> pieces = read_structure(table, keys.table, head.structure,
                                                   {keys.keys, placement_keys().keys}, context);
  Member member{&table, {}};
  for (const Copy& copy : copies) {
    for (const Piece& piece : pieces) {
      const std::size_t more = piece.parts.size() * piece.copies.size();
      check_parts(static_cast<double>(member.parts.size() + more), table);
      for (const Pose& X_SM : piece.copies) {
        for (Part part : piece.parts) {
          part.anchored = 0;  // the key `anchored` of the solid decides
          const Pose X_SP = X_SM * Pose{piece.at, Quat::Identity()};
          member.parts.push_back(placed(moved(std::move(part), X_SP), copy));
        }
      }
    }
  }
  return member;
}

Compound joined(std::vector<Part> parts, const Value& table) {
  try {
    return fracture::make_compound(std::move(parts));
  } catch (const InputError& error) {  // for too many overlaps
    throw InputError(table.where + ": " + error.what());
  }
}

bool contains(const ConvexPolyhedron& convex, const Vec3& point) {
  return std::all_of(convex.faces.begin(), convex.faces.end(),
                     [&](const ConvexPolyhedron::Face& f) { return f.plane.distance(point) <= 0; });
}

double distance(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm();
}

/// Throws InputError if the compound has several islands; the message is about the smallest.
void check_connected(const Compound& whole, const std::vector<Member>& members) {
  const std::vector<std::uint32_t> island = fracture::find_islands(whole);
  std::vector<std::size_t> size(*std::max_element(island.begin(), island.end()) + 1, 0);
  for (const std::uint32_t i : island) ++size[i];
  if (size.size() == 1) return;
  const auto stray = std::min_element(size.rbegin(), size.rend()).base() - size.begin() - 1;
  const auto is_stray = [&](std::size_t c) { return island[c] == stray; };
  Box box;
  std::size_t first = island.size();
  for (std::size_t c = island.size(); c-- > 0;) {
    if (is_stray(c)) box.extend(whole.convexes[c]->box), first = c;
  }
  double gap_m = 1e300;
  for (std::size_t c = 0; c < island.size(); ++c) {
    if (!is_stray(c)) gap_m = std::min(gap_m, distance(box, whole.convexes[c]->box));
  }
  const Vec3 middle = mass_properties(whole.convexes[first]->polyhedron).centroid;
  const auto owner = std::find_if(members.begin(), members.end(), [&](const Member& member) {
    return std::any_of(member.parts.begin(), member.parts.end(),
                       [&](const Part& part) { return contains(part.polyhedron, middle); });
  });
  throw InputError((owner == members.end() ? members[0] : *owner).table->where +
                   ": [[solid.part]] is not connected to the others: it shares no face with "
                   "another part, and overlaps none" +
                   (gap_m > 0 ? "; the nearest is " + format(gap_m) + " m away" : "") +
                   "; move it, or make it a separate [[solid]]");
}

std::vector<Piece> build_compound(const void*, const Value& table, const BuildContext& context) {
  std::vector<Member> members;
  Piece whole;
  for (const Value* part : tables(table, "part")) {
    members.push_back(read_member(*part, context));
    const std::vector<Part>& parts = members.back().parts;
    check_parts(static_cast<double>(whole.parts.size() + parts.size()), *part);
    whole.parts.insert(whole.parts.end(), parts.begin(), parts.end());
  }
  if (whole.parts.empty()) {
    throw InputError(table.where + ": missing [[solid.part]]: a compound has at least one");
  }
  check_connected(joined(whole.parts, table), members);
  return {whole};
}

}  // namespace

StructureType compound_structure() {
  return {
      "compound",
      "Parts that touch or overlap, as one solid. An overlap has the material of the first part.",
      {table_key("part", "Parts.")},
      []() -> std::shared_ptr<void> { return std::make_shared<NoParameters>(); },
      build_compound};
}

}  // namespace sunder::scenes

// The C interface: queries, events and figures.
#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/io/state_hash.h"
#include "scenes/api/c_base.h"

namespace sunder::scenes {
namespace {

QueryFilter query_filter(const SunderQuery* query) {
  QueryFilter filter;
  if (!query) return filter;
  need_cookie(query->cookie, kQueryCookie, "query", "sunder_default_query");
  filter.mask = query->mask;
  filter.ground = query->ground;
  if (query->accepts || query->ignored.key != SUNDER_NO_KEY) {
    filter.accepts = [query = *query](BodyKey key) {
      if (key == key_of(query.ignored)) return false;
      return !query.accepts || query.accepts(body_of(key), query.accepts_user);
    };
  }
  return filter;
}

void need_ray(const SunderVec3& from_W, const SunderVec3& direction_W) {
  need_vector(from_W, kMaxPosition_m, "from_W");
  need_vector(direction_W, kMaxPosition_m, "direction_W");
}

SunderCastHit cast_hit(WorldEntry& entry, const CastHit& hit) {
  return {body_of(hit.body), hit.slot,         material_of(entry, hit.material),
          hit.distance_m,    vec(hit.point_W), vec(hit.normal_W)};
}

SunderOverlap overlap_of(const Overlap& overlap) { return {body_of(overlap.body), overlap.slot}; }

Array<SunderBody> bodies_of(const std::vector<BodyKey>& keys) {
  Array<SunderBody> bodies;
  std::ranges::transform(keys, std::back_inserter(bodies), body_of);
  return bodies;
}

EventArrays event_arrays(WorldEntry& entry, const Events& events) {
  EventArrays arrays;
  std::size_t children = 0;
  for (const BreakEvent& event : events.breaks) children += event.child_keys.size();
  arrays.children.reserve(children);  // pointers to elements stay valid
  const auto body = [](std::uint64_t key) { return SunderBody{static_cast<std::uint32_t>(key)}; };
  for (const BreakEvent& event : events.breaks) {
    const SunderBody* first = arrays.children.data() + arrays.children.size();
    std::ranges::transform(event.child_keys, std::back_inserter(arrays.children), body);
    const std::uint32_t count = count_of(event.child_keys.size());
    arrays.breaks.push_back({event.time_s, body(event.parent_key), count > 0 ? first : nullptr,
                             count, event.pieces, material_of(entry, event.material),
                             vec(event.point_W), event.energy_J, event.new_area_m2});
  }
  for (const Hit& hit : events.hits)
    arrays.hits.push_back({body_of(hit.a), body_of(hit.b), vec(hit.point_W), vec(hit.normal_W),
                           hit.speed_m_s, hit.mass_kg});
  arrays.appeared = bodies_of(events.appeared);
  arrays.gone = bodies_of(events.gone);
  arrays.fell_asleep = bodies_of(events.fell_asleep);
  arrays.woke = bodies_of(events.woke);
  for (const JointKey key : events.joints_lost) arrays.joints_lost.push_back({key.value});
  return arrays;
}

template <class T, class Value, class Convert>
void copy_to(const std::vector<Value>& from, T* to, const Convert& convert) {
  if (to) std::ranges::transform(from, to, convert);
}

}  // namespace
}  // namespace sunder::scenes

using namespace sunder;
using namespace sunder::scenes;

static_assert(kStages == SUNDER_STAGES && static_cast<int>(Stage::kAct) == SUNDER_STAGE_ACT &&
              static_cast<int>(Stage::kSnapshot) == SUNDER_STAGE_SNAPSHOT);

SunderResult sunder_world_time(SunderWorld world, double* time_s) {
  return ask_world("sunder_world_time", world, [&](WorldEntry& entry) {
    need_pointer(time_s, "time_s");
    *time_s = entry.world.time_s();
  });
}

SunderResult sunder_world_contains_body(SunderWorld world, SunderBody body, bool* is_in) {
  return ask_world("sunder_world_contains_body", world, [&](WorldEntry& entry) {
    need_pointer(is_in, "is_in");
    *is_in = entry.world.contains(key_of(body));
  });
}

SunderResult sunder_world_contains_joint(SunderWorld world, SunderJoint joint, bool* is_in) {
  return ask_world("sunder_world_contains_joint", world, [&](WorldEntry& entry) {
    need_pointer(is_in, "is_in");
    *is_in = entry.world.contains(JointKey(std::size_t{joint.key}));
  });
}

SunderResult sunder_world_body_count(SunderWorld world, uint32_t* count) {
  return ask_world("sunder_world_body_count", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    *count = count_of(entry.world.size());
  });
}

SunderResult sunder_world_body(SunderWorld world, SunderBody body, SunderBodyInfo* info) {
  return ask_world("sunder_world_body", world, [&](WorldEntry& entry) {
    need_pointer(info, "info");
    need_body(entry, body, "body");
    const BodyView view = entry.world.body(key_of(body));
    SunderBodyInfo found{};
    found.body = body;
    found.root = body_of(view.root);
    found.motion = motion(view.motion);
    found.com_W = vec(view.com_W);
    found.mass_kg = view.mass_kg;
    found.volume_m3 = view.volume_m3;
    found.convexes = view.convexes;
    found.is_static = view.is_static;
    found.is_kinematic = view.is_kinematic;
    found.asleep = view.asleep;
    found.user_data = view.user_data;
    found.filter = filter_of(view.filter);
    copy_name(view.name, found.name);
    *info = found;
  });
}

SunderResult sunder_world_bodies(SunderWorld world, const SunderBodyArrays* arrays,
                                 uint32_t* count) {
  return ask_world("sunder_world_bodies", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    const BodyArrays& all = entry.world.bodies();
    const std::uint32_t room = *count, needed = count_of(all.key.size());
    *count = needed;
    if (!arrays) return;
    if (room < needed)
      refuse("arrays have room for " + std::to_string(room) + " elements; expected " +
             std::to_string(needed));
    const auto vector = [](const Vec3& v) { return vec(v); };
    const auto bit = [](std::uint8_t value) { return static_cast<std::uint8_t>(value ? 1 : 0); };
    copy_to(all.key, arrays->body, body_of);
    copy_to(all.position_W, arrays->position_W, vector);
    copy_to(all.rotation_W, arrays->rotation_W, [](const Quat& q) { return quat(q); });
    copy_to(all.velocity_W, arrays->velocity_W, vector);
    copy_to(all.angular_velocity_W, arrays->angular_velocity_W, vector);
    copy_to(all.is_static, arrays->is_static, bit);
    copy_to(all.asleep, arrays->asleep, bit);
  });
}

SunderQuery sunder_default_query() {
  return {kQueryCookie, 0xffffffffu, true, {SUNDER_NO_KEY}, nullptr, nullptr};
}

SunderResult sunder_world_cast(SunderWorld world, SunderVec3 from_W, SunderVec3 direction_W,
                               double most_m, double radius_m, const SunderQuery* query,
                               SunderCastHit* hit, bool* found) {
  return ask_world("sunder_world_cast", world, [&](WorldEntry& entry) {
    need_pointer(hit, "hit");
    need_pointer(found, "found");
    need_ray(from_W, direction_W);
    const auto first =
        entry.world.cast(vec(from_W), vec(direction_W), most_m, radius_m, query_filter(query));
    *found = first.has_value();
    if (first) *hit = cast_hit(entry, *first);
  });
}

SunderResult sunder_world_cast_all(SunderWorld world, SunderVec3 from_W, SunderVec3 direction_W,
                                   double most_m, double radius_m, const SunderQuery* query,
                                   SunderCastHit* hits, uint32_t* count) {
  return ask_world("sunder_world_cast_all", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    need_ray(from_W, direction_W);
    fill(entry.world.cast_all(vec(from_W), vec(direction_W), most_m, radius_m, query_filter(query)),
         hits, count, "hits", [&](const CastHit& hit) { return cast_hit(entry, hit); });
  });
}

SunderResult sunder_world_overlap_ball(SunderWorld world, SunderVec3 center_W, double radius_m,
                                       const SunderQuery* query, SunderOverlap* overlaps,
                                       uint32_t* count) {
  return ask_world("sunder_world_overlap_ball", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    need_vector(center_W, kMaxPosition_m, "center_W");
    fill(entry.world.overlap(vec(center_W), radius_m, query_filter(query)), overlaps, count,
         "overlaps", overlap_of);
  });
}

SunderResult sunder_world_overlap_box(SunderWorld world, SunderVec3 min_W, SunderVec3 max_W,
                                      const SunderQuery* query, SunderOverlap* overlaps,
                                      uint32_t* count) {
  return ask_world("sunder_world_overlap_box", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    need_vector(min_W, kMaxPosition_m, "min_W");
    need_vector(max_W, kMaxPosition_m, "max_W");
    fill(entry.world.overlap(Box{vec(min_W), vec(max_W)}, query_filter(query)), overlaps, count,
         "overlaps", overlap_of);
  });
}

SunderResult sunder_world_contacts(SunderWorld world, SunderBody body, SunderContact* contacts,
                                   uint32_t* count) {
  return ask_world("sunder_world_contacts", world, [&](WorldEntry& entry) {
    need_pointer(count, "count");
    need_body(entry, body, "body");
    fill(entry.world.contacts(key_of(body)), contacts, count, "contacts",
         [](const Contact& contact) {
           return SunderContact{body_of(contact.other), vec(contact.point_W), vec(contact.force_W)};
         });
  });
}

SunderResult sunder_world_events(SunderWorld world, SunderEvents* events) {
  return ask_world("sunder_world_events", world, [&](WorldEntry& entry) {
    need_pointer(events, "events");
    if (!entry.events) entry.events = event_arrays(entry, entry.world.events());
    const EventArrays& arrays = *entry.events;
    *events = {data_of(arrays.breaks),      count_of(arrays.breaks.size()),
               data_of(arrays.hits),        count_of(arrays.hits.size()),
               data_of(arrays.appeared),    count_of(arrays.appeared.size()),
               data_of(arrays.gone),        count_of(arrays.gone.size()),
               data_of(arrays.fell_asleep), count_of(arrays.fell_asleep.size()),
               data_of(arrays.woke),        count_of(arrays.woke.size()),
               data_of(arrays.joints_lost), count_of(arrays.joints_lost.size())};
  });
}

SunderResult sunder_world_report(SunderWorld world, SunderReport* report) {
  return ask_world("sunder_world_report", world, [&](WorldEntry& entry) {
    need_pointer(report, "report");
    const FrameReport& last = entry.world.report();
    SunderReport copy{};
    for (int i = 0; i < kStages; ++i) {
      copy.stage_ms[i] = last.stage_ms[i];
      copy.stage_cpu_ms[i] = last.stage_cpu_ms[i];
    }
    copy.moving_bodies = last.counts.bodies;
    copy.awake_bodies = last.counts.awake;
    copy.convexes = last.counts.convexes;
    copy.contacts = last.counts.contacts;
    copy.mass_kg = last.mass_kg;
    copy.volume_m3 = last.volume_m3;
    copy.kinetic_J = last.kinetic_J;
    copy.potential_J = last.potential_J;
    copy.plastic_J = last.plastic_J;
    copy.energy_residual_J = last.energy_residual_J;
    copy.momentum_residual = last.momentum_residual;
    copy.carried_over = last.carried_over;
    copy.failed = last.failed;
    copy.limits_hit = last.limits_hit;
    copy.aged = last.aged;
    copy.joints_lost = last.joints_lost;
    *report = copy;
  });
}

SunderResult sunder_world_state_hash(SunderWorld world, uint64_t* hash) {
  return ask_world("sunder_world_state_hash", world, [&](WorldEntry& entry) {
    need_pointer(hash, "hash");
    *hash = hash_state(*entry.world.frame());
  });
}

SunderResult sunder_run_hash(const uint64_t* state_hashes, uint32_t count, char hex[17]) {
  return guard("sunder_run_hash", SUNDER_ERROR_ARGUMENT, [&] {
    need_pointer(hex, "hex");
    if (count > 0) need_pointer(state_hashes, "state_hashes");
    const std::string text = hash_run({state_hashes, count});
    text.copy(hex, 16);
    hex[16] = 0;
  });
}

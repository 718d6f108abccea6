#include "engine/io/event_log.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "engine/base/check.h"
#include "engine/io/bytes.h"

namespace sunder {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Vec3& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json new_event(const char* kind, double time_s, std::uint64_t body) {
  return {{"time_s", time_s}, {"event", kind}, {"body", body}};
}

void add_name(const Frame& frame, std::uint32_t name, Json& event) {
  if (frame.names && name < frame.names->size()) event["name"] = (*frame.names)[name];
}

void add_state(const FrameBody& body, Json& event) {
  const Quat& q = body.X_WB.rotation;
  event["mass_kg"] = body.mass_kg;
  event["static"] = body.is_static;
  event["position_m"] = numbers(body.X_WB.position);
  event["rotation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  event["velocity_m_s"] = numbers(body.velocity_W);
  event["angular_velocity_rad_s"] = numbers(body.angular_velocity_W);
}

Json event_of(const Frame& frame, const BreakEvent& at) {
  Json event = new_event("break", at.time_s, at.parent_key);
  add_name(frame, at.name, event);
  event["material"] = (*frame.materials)[at.material.value].name;
  event["point_m"] = numbers(at.point_W);
  event["energy_J"] = at.energy_J;
  event["new_area_m2"] = at.new_area_m2;
  event["pieces"] = at.pieces;
  event["children"] = at.child_keys;
  const auto rest = std::ranges::lower_bound(frame.bodies, at.parent_key, {}, &FrameBody::key);
  if (rest != frame.bodies.end() && rest->key == at.parent_key) event["rest_kg"] = rest->mass_kg;
  return event;
}

Json event_of(const Frame& frame, const Hit& hit) {
  Json event = new_event("hit", frame.time_s, hit.a.value);
  if (hit.b.none()) {
    event["other"] = nullptr;
  } else {
    event["other"] = hit.b.value;
  }
  event["point_m"] = numbers(hit.point_W);
  event["normal"] = numbers(hit.normal_W);
  event["speed_m_s"] = hit.speed_m_s;
  event["mass_kg"] = hit.mass_kg;
  return event;
}

/// Returns the event of lost joints, of which only those of the scene and of calls have keys.
Json event_of(const Frame& frame, const std::vector<JointKey>& lost) {
  Json event = {{"time_s", frame.time_s},
                {"event", "joints lost"},
                {"count", frame.report.joints_lost},
                {"joints", Json::array()}};
  for (const JointKey key : lost) event["joints"].push_back(key.value);
  return event;
}

}  // namespace

EventLog::EventLog(const std::filesystem::path& path, const World& world)
    : path_(path), out_(create_file(path)), world_(world) {}

void EventLog::take(const FramePtr& frame) {
  std::string lines;
  const auto put = [&](const Json& event) {
    lines += event.dump() + "\n";
    ++events_;
  };
  const Events& events = world_.events();
  for (const Hit& hit : events.hits) put(event_of(*frame, hit));
  std::set<std::uint64_t> broken;
  for (const BreakEvent& at : frame->breaks) {
    put(event_of(*frame, at));
    broken.insert(at.parent_key);
  }
  for (const FrameBody& body : frame->bodies) {
    if (body.key == kGroundKey) continue;
    const auto [place, is_new] = known_.try_emplace(body.key);
    Known& known = place->second;
    if (is_new) {
      Json event = new_event("appear", frame->time_s, body.key);
      add_name(*frame, body.name, event);
      if (body.previous_key != body.key) event["previous"] = body.previous_key;
      add_state(body, event);
      put(event);
    } else if (known.asleep != body.asleep) {
      put(new_event(body.asleep ? "sleep" : "wake", frame->time_s, body.key));
    }
    known = {body.asleep, frame->index};
  }
  for (auto it = known_.begin(); it != known_.end();) {
    const bool gone = it->second.frame != frame->index;
    if (gone && !broken.contains(it->first)) put(new_event("disappear", frame->time_s, it->first));
    it = gone ? known_.erase(it) : std::next(it);
  }
  if (frame->report.joints_lost > 0) put(event_of(*frame, events.joints_lost));
  out_ << lines;
  if (!out_) throw FileError(path_.string() + ": cannot be written; is the disk full?");
}

void EventLog::finish() {
  out_.close();
  if (!out_) throw FileError(path_.string() + ": cannot be written; is the disk full?");
}

}  // namespace sunder

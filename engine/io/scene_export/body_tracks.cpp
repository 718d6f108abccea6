// Begin with add().
#include "engine/io/scene_export/body_tracks.h"

#include <algorithm>

#include "engine/base/parallel.h"

namespace sunder {

/// A body of the last frame.
struct BodyTracks::Active {
  BodyTrack track;
  Drawn drawn;                     ///< Meshes of the last frame.
  std::vector<InstanceSpan> open;  ///< Spans of the meshes of the last frame, ascending.

  void add_pose(std::uint32_t number, const FrameBody& body);
  void set_drawn(std::uint32_t number, Drawn now);
};

namespace {

constexpr std::size_t kBodiesAChunk = 32;

std::pair<std::uint32_t, std::uint32_t> order_of(const InstanceSpan& span) {
  return {span.mesh.value, span.material.value};
}

}  // namespace

void BodyTracks::Active::add_pose(std::uint32_t number, const FrameBody& body) {
  track.positions.add(number, body.X_WB * (track.center_R - body.com_R));
  track.rotations.add(number, body.X_WB.rotation);
}

/// Ends the spans of meshes that are no longer drawn, and begins those of new ones.
void BodyTracks::Active::set_drawn(std::uint32_t number, Drawn now) {
  if (now == drawn) return;
  std::vector<InstanceSpan> wanted, kept, ended, begun;
  for (const auto& [mesh, material] : now) wanted.push_back({mesh, material, number});
  std::ranges::sort(wanted, {}, order_of);
  const auto is_before = [](const InstanceSpan& a, const InstanceSpan& b) {
    return order_of(a) < order_of(b);
  };
  std::ranges::set_difference(open, wanted, std::back_inserter(ended), is_before);
  std::ranges::set_difference(wanted, open, std::back_inserter(begun), is_before);
  std::ranges::set_intersection(open, wanted, std::back_inserter(kept), is_before);
  for (InstanceSpan& span : ended) span.end = number;
  track.spans.insert(track.spans.end(), ended.begin(), ended.end());
  open.clear();
  std::ranges::merge(kept, begun, std::back_inserter(open), is_before);
  drawn = std::move(now);
}

BodyTracks::BodyTracks(const PositionKeys& positions, const RotationKeys& rotations,
                       std::function<void(const BodyTrack&)> take)
    : positions_(positions), rotations_(rotations), take_(std::move(take)) {}

BodyTracks::~BodyTracks() = default;

/// Returns the meshes that are drawn on each body of a frame.
std::vector<BodyTracks::Drawn> BodyTracks::drawn_on_bodies(const Frame& frame) const {
  std::vector<Drawn> drawn(frame.bodies.size());
  for (const Instance& instance : frame.instances) {
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    if (!mesh.indices.empty()) drawn[instance.body].push_back({instance.mesh, instance.material});
  }
  return drawn;
}

void BodyTracks::skip(const Frame& frame) {
  for (const FrameBody& body : frame.bodies) {
    if (body.previous_key != body.key) parents_.emplace(body.key, body.previous_key);
  }
}

/// Returns the key of the body of the last frame that a new body was part of; its own if there is
/// none.
std::uint64_t BodyTracks::parent_of(const FrameBody& body) const {
  std::uint64_t key = body.previous_key;
  for (auto at = parents_.find(key); at != parents_.end(); at = parents_.find(key))
    key = at->second;
  return key;
}

/// Makes `active_` one for each body of the frame; ends those of bodies that are gone.
void BodyTracks::match(std::uint32_t number, const Frame& frame) {
  std::vector<std::unique_ptr<Active>> now;
  now.reserve(frame.bodies.size());
  std::size_t a = 0;
  const auto end_until = [&](std::uint64_t key) {
    for (; a < active_.size() && active_[a]->track.key < key; ++a) {
      active_[a]->track.gone = number;
      end(*active_[a]);
    }
  };
  for (const FrameBody& body : frame.bodies) {
    end_until(body.key);
    if (a < active_.size() && active_[a]->track.key == body.key) {
      now.push_back(std::move(active_[a++]));
    } else {
      now.push_back(
          std::make_unique<Active>(Active{BodyTrack{body.key,
                                                    number == 0 ? body.key : parent_of(body),
                                                    body.name,
                                                    body.mass_kg,
                                                    number,
                                                    kUntilEnd,
                                                    body.com_R,
                                                    KeyReducer(positions_),
                                                    KeyReducer(rotations_),
                                                    {}},
                                          {},
                                          {}}));
    }
  }
  end_until(~std::uint64_t{0});
  active_ = std::move(now);
  parents_.clear();
}

void BodyTracks::add(std::uint32_t number, const Frame& frame) {
  std::vector<Drawn> drawn = drawn_on_bodies(frame);
  match(number, frame);
  for_chunks(active_.size(), kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      active_[i]->add_pose(number, frame.bodies[i]);
      active_[i]->set_drawn(number, std::move(drawn[i]));
    }
  });
}

void BodyTracks::end(Active& active) {
  BodyTrack& track = active.track;
  track.positions.finish();
  track.rotations.finish();
  for (InstanceSpan span : active.open) {
    span.end = track.gone;
    track.spans.push_back(span);
  }
  take_(track);
}

void BodyTracks::finish() {
  for (const std::unique_ptr<Active>& active : active_) end(*active);
  active_.clear();
}

}  // namespace sunder

// Begin with take(), then difference_of().
#include "engine/io/recording/recording_verifier.h"

#include <algorithm>
#include <vector>

#include "engine/base/printed.h"
#include "engine/io/particle_codes.h"
#include "engine/io/recording/frame_coder.h"
#include "engine/io/state_hash.h"

namespace sunder {
namespace {

std::string count_text(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string numbers_text(const auto& numbers, int digits) {
  std::string text = "(";
  for (Eigen::Index i = 0; i < numbers.size(); ++i)
    text += (i == 0 ? "" : ", ") + printed("%.*g", digits, static_cast<double>(numbers[i]));
  return text + ")";
}

/// Returns true if numbers are as recorded, in steps of 1 / `steps`.
bool are_near(const auto& now, const auto& then, double steps) {
  return (now - then).cwiseAbs().maxCoeff() < 1 / steps;
}

/// Returns both values of a field, the recorded one only if it is not the same step.
std::string values_text(const auto& now, const auto& then, const char* name, const char* unit,
                        double steps) {
  const std::string text = std::string(name) + " " + numbers_text(now, 9) + unit;
  if (are_near(now, then, steps))
    return text + ", recorded as the same to " + printed("%.1g", 1 / steps) + unit;
  return text + ", recorded " + numbers_text(then, 5) + unit;
}

std::string flag_text(bool now, const char* name) {
  return std::string(now ? name : (std::string("not ") + name)) + ", recorded " +
         (now ? "not " : "") + name;
}

/// The meshes drawn on each body of a frame.
using MeshLists = std::vector<std::vector<std::uint32_t>>;

MeshLists meshes_of(const Frame& frame) {
  MeshLists meshes(frame.bodies.size());
  for (const Instance& instance : frame.instances)
    meshes[instance.body].push_back(instance.mesh.value);
  return meshes;
}

/// A body of a frame as it is compared.
struct Compared {
  const FrameBody& body;
  const std::vector<std::uint32_t>& meshes;
};

/// Returns a list of the fields that differ, each with both values; empty if none does.
std::string fields_text(const Compared& now, const Compared& then, std::int32_t hashes) {
  std::string text;
  const auto add = [&](const std::string& field) { text += (text.empty() ? "" : "; ") + field; };
  const FrameBody &a = now.body, &b = then.body;
  const auto compare = [&](HashedField field, const auto& x, const auto& y, const char* name,
                           const char* unit, double steps) {
    if (has_hashes_of_fields(hashes) ? differs(field, a, hashes) : !are_near(x, y, steps))
      add(values_text(x, y, name, unit, steps));
  };
  compare(HashedField::kPosition, a.X_WB.position, b.X_WB.position, "position", " m",
          kPositionSteps);
  compare(HashedField::kOrientation, a.X_WB.rotation.coeffs(), b.X_WB.rotation.coeffs(),
          "orientation (x, y, z, w)", "", kRotationSteps);
  compare(HashedField::kVelocity, a.velocity_W, b.velocity_W, "velocity", " m/s", kSpeedSteps);
  compare(HashedField::kAngularVelocity, a.angular_velocity_W, b.angular_velocity_W,
          "angular velocity", " rad/s", kSpeedSteps);
  if (a.asleep != b.asleep) add(flag_text(a.asleep, "asleep"));
  if (a.is_static != b.is_static) add(flag_text(a.is_static, "static"));
  if (now.meshes != then.meshes)
    add(now.meshes.size() == then.meshes.size()
            ? std::string("its meshes are others")
            : count_text(now.meshes.size(), "mesh", "meshes") + ", recorded " +
                  std::to_string(then.meshes.size()));
  if (text.empty() && differs(a, hashes)) add("a field, by less than is recorded of it");
  return text;
}

/// Returns the name of a body, if it has one, and its key.
std::string title_of(const FrameBody& body, const Frame& frame) {
  const std::string key = "body " + std::to_string(body.key);
  if (!frame.names || body.name >= frame.names->size() || (*frame.names)[body.name].empty())
    return key;
  return key + " '" + (*frame.names)[body.name] + "'";
}

/// Returns the first difference of bodies, and how many bodies differ; empty if none does. Both
/// lists ascend by key.
std::string bodies_text(const Frame& now, const Frame& then,
                        const std::vector<std::int32_t>& hashes_then) {
  const MeshLists meshes_now = meshes_of(now), meshes_then = meshes_of(then);
  std::string first;
  std::size_t count = 0;
  for (std::size_t a = 0, b = 0; a < now.bodies.size() || b < then.bodies.size();) {
    std::string text;
    if (a == now.bodies.size() ||
        (b < then.bodies.size() && then.bodies[b].key < now.bodies[a].key)) {
      text = title_of(then.bodies[b], then) + " is only in the recording";
      ++b;
    } else if (b == then.bodies.size() || now.bodies[a].key < then.bodies[b].key) {
      text = title_of(now.bodies[a], now) + " is not in the recording";
      ++a;
    } else {
      text = fields_text({now.bodies[a], meshes_now[a]}, {then.bodies[b], meshes_then[b]},
                         hashes_then[b]);
      if (!text.empty()) text = title_of(now.bodies[a], now) + ": " + text;
      ++a, ++b;
    }
    if (!text.empty() && count++ == 0) first = text;
  }
  if (count > 1) first += "; " + count_text(count - 1, "more body differs", "more bodies differ");
  if (count > 0 && now.bodies.size() != then.bodies.size())
    first += "; " + count_text(now.bodies.size(), "body", "bodies") + ", recorded " +
             std::to_string(then.bodies.size());
  return first;
}

/// Returns the first difference of particles; empty if there is none.
template <class Particle>
std::string particles_text(const std::vector<Particle>& now, const std::vector<Particle>& then,
                           const char* name) {
  if (now.size() != then.size())
    return std::to_string(now.size()) + " particles of " + name + ", recorded " +
           std::to_string(then.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (encode(now[i]) == encode(then[i])) continue;
    return "particle " + std::to_string(i) + " of " + name + ": position " +
           numbers_text(now[i].position_W, 5) + " m, recorded " +
           numbers_text(then[i].position_W, 5) + " m";
  }
  return "";
}

/// Returns the differences of two frames of different states.
std::string difference_of(const Frame& now, const Frame& then,
                          const std::vector<std::int32_t>& hashes_then) {
  for (const std::string& text :
       {bodies_text(now, then, hashes_then), particles_text(now.debris, then.debris, "debris"),
        particles_text(now.dust, then.dust, "dust")})
    if (!text.empty()) return text;
  return "a body differs in bits of which the recording has no hash";
}

}  // namespace

void RecordingVerifier::take(const FramePtr& frame) {
  const auto read = [&] {
    recorded_ = recording_.next();
    if (recorded_) ++read_, last_read_ = recorded_->index;
  };
  if (!started_) read();
  started_ = true;
  while (recorded_ && recorded_->index < frame->index) read();
  ended_ = !recorded_;
  if (ended_) return;
  if (recorded_->index > frame->index) {
    ++not_recorded_;
    return;
  }
  last_compared_ = frame->index;
  if (hash_state(*recorded_) == hash_state(*frame) && meshes_of(*recorded_) == meshes_of(*frame)) {
    ++same_;
    return;
  }
  if (different_++ > 0) return;
  first_different_ = frame->index;
  difference_ = "frame " + std::to_string(frame->index) + " differs, after " +
                count_text(same_, "equal frame", "equal frames") + ": " +
                difference_of(*frame, *recorded_, recording_.body_hashes());
}

std::string RecordingVerifier::result() const {
  const std::string matching = count_text(same_, "frame matches", "frames match");
  if (reached_damage()) return recording_.damage() + "; " + matching + " before that";
  if (different_ == 0) return matching + " the recording" + ranges_text();
  if (last_compared_ == first_different_) return difference_;
  return difference_ + "; in all, " + std::to_string(different_) + " of " +
         count_text(same_ + different_, "frame", "frames") + " differ" + ranges_text();
}

/// Returns a list of the frames that only the run or only the recording has; empty if there are
/// none.
std::string RecordingVerifier::ranges_text() const {
  std::string text;
  if (not_recorded_ > 0)
    text += "; it has none of the " + count_text(not_recorded_, "frame", "frames") +
            " with which the run begins";
  const std::string last = std::to_string(last_read_);
  if (ended_)
    text += "; it ends with frame " + last + " and the run goes on: compare the frames that both " +
            "have by --frames " + last;
  if (const std::uint32_t more = recording_.frames() - read_; more > 0)
    text += "; it is longer than the run, by " + count_text(more, "frame", "frames");
  return text;
}

}  // namespace sunder

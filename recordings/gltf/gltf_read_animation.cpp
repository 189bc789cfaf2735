// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "recordings/base/motion_limits.h"
#include "recordings/gltf/gltf_model.h"
#include "recordings/motion/bake_root_motion.h"
#include "recordings/takes/nominal_rate.h"

namespace marey::recordings {
namespace {

constexpr double kMaxFrame = 1e6;

enum class Blend { kStep, kLinear, kCubic };

/// One animated property of one node.
struct Track {
  std::size_t node = 0;
  std::string path;  ///< "translation", "rotation" or "scale".
  Blend blend = Blend::kLinear;
  std::size_t components = 3;
  std::vector<double> times_s;
  std::vector<double> values;

  /// Returns value `part` of key `key`: 0, or for cubic tracks 0 in-tangent, 1 value, 2
  /// out.
  [[nodiscard]] glm::dvec4 value(std::size_t key, std::size_t part) const {
    const std::size_t row = blend == Blend::kCubic ? 3 * key + part : key;
    glm::dvec4 v(0.0);
    for (std::size_t i = 0; i < components; ++i) {
      v[static_cast<int>(i)] = values[row * components + i];
    }
    return v;
  }
};

glm::dquat quaternion(const glm::dvec4& xyzw) {
  const glm::dquat q(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
  return glm::length(q) > 1e-9 ? glm::normalize(q) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

glm::dvec4 sample(const Track& track, double time_s) {
  const auto& times = track.times_s;
  // Keys are floats: a key slightly after this time is treated as equal.
  const auto after = std::ranges::upper_bound(times, time_s + 1e-5);
  const auto next = static_cast<std::size_t>(after - times.begin());
  if (next == 0) return track.value(0, 1);
  if (next == times.size() || track.blend == Blend::kStep)
    return track.value(next - 1, 1);
  // A key slightly before it, within float precision, is treated as equal too.
  if (time_s - times[next - 1] <= 1.2e-7 * std::max(1.0, std::abs(time_s))) {
    return track.value(next - 1, 1);
  }
  const double span = times[next] - times[next - 1];
  const double t = std::max(0.0, (time_s - times[next - 1]) / span);
  const glm::dvec4 a = track.value(next - 1, 1);
  const glm::dvec4 b = track.value(next, 1);
  if (track.blend == Blend::kCubic) {
    // glTF 2.0 specification, appendix C.4.
    return (1 + 2 * t) * (1 - t) * (1 - t) * a +
           span * t * (1 - t) * (1 - t) * track.value(next - 1, 2) +
           t * t * (3 - 2 * t) * b + span * t * t * (t - 1) * track.value(next, 0);
  }
  if (track.path == "rotation") {
    const glm::dquat q = glm::slerp(quaternion(a), quaternion(b), t);
    return {q.x, q.y, q.z, q.w};
  }
  return glm::mix(a, b, t);
}

Result<Track> read_track(const NamedModel& file,
                         const tinygltf::Animation& animation,
                         const tinygltf::AnimationChannel& channel) {
  Track track;
  track.node = static_cast<std::size_t>(channel.target_node);
  track.path = channel.target_path;
  track.components = track.path == "rotation" ? 4 : 3;
  if (channel.sampler < 0 ||
      static_cast<std::size_t>(channel.sampler) >= animation.samplers.size() ||
      track.node >= file.model.nodes.size()) {
    return file.fail("an animation channel names a sampler or node that does not exist");
  }
  const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
  if (sampler.interpolation == "STEP") track.blend = Blend::kStep;
  if (sampler.interpolation == "CUBICSPLINE") track.blend = Blend::kCubic;
  auto times = accessor_values(file, sampler.input, 1);
  if (!times) return times.error();
  auto values = accessor_values(file, sampler.output, track.components);
  if (!values) return values.error();
  track.times_s = *std::move(times);
  track.values = *std::move(values);
  const std::size_t rows = track.times_s.size() * (track.blend == Blend::kCubic ? 3 : 1);
  if (track.times_s.empty() || track.values.size() != rows * track.components) {
    return file.fail("an animation channel does not have one value per key");
  }
  if (std::ranges::adjacent_find(track.times_s, std::greater_equal<>{}) !=
      track.times_s.end()) {
    return file.fail("the times of an animation do not ascend");
  }
  return track;
}

Result<std::vector<Track>> read_tracks(const NamedModel& file,
                                       const tinygltf::Animation& animation) {
  std::vector<Track> tracks;
  for (const tinygltf::AnimationChannel& channel : animation.channels) {
    const std::string& path = channel.target_path;
    const bool moves = path == "translation" || path == "rotation" || path == "scale";
    if (!moves || channel.target_node < 0) continue;
    auto track = read_track(file, animation, channel);
    if (!track) return track.error();
    tracks.push_back(*std::move(track));
  }
  return tracks;
}

/// Returns the rate of the track with most keys, if they are even and dense enough to be
/// frames.
double rate_of(const std::vector<Track>& tracks) {
  const auto& times = std::ranges::max_element(tracks, {}, [](const Track& track) {
                        return track.times_s.size();
                      })->times_s;
  if (times.size() < 2) return kBlendedKeysHz;
  const double step =
      (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double even = times.front() + step * static_cast<double>(i);
    if (std::abs(times[i] - even) > 0.01 * step) return kBlendedKeysHz;
  }
  const double hz = 1.0 / step;
  // Times are floats, so the step is rounded.
  if (hz < kMinKeysHz || hz > 1.001 * kMaxRateHz) return kBlendedKeysHz;
  return std::min(nominal_rate(hz, 2e-7), kMaxRateHz);
}

void apply(const Track& track, double time_s, NodePose& pose) {
  const glm::dvec4 value = sample(track, time_s);
  if (track.path == "rotation") {
    pose.rotation = quaternion(value);
  } else if (track.path == "translation") {
    pose.translation = glm::dvec3(value);
  } else {
    pose.scale = glm::dvec3(value);
  }
}

/// The nodes that determine the joints' positions: joints, and the ancestors of the root.
/// A scene may hold any number of other nodes, which are not evaluated in each frame.
struct MovingPart {
  NodeTree tree;  ///< Parents first, so that positions are computed in order.
  std::vector<std::optional<std::size_t>> place_of_node;
  std::vector<std::size_t> place_of_joint;
};

MovingPart moving_part(const NodeTree& tree, const NodeSkeleton& body) {
  std::vector<std::size_t> nodes = body.node_of_joint;
  for (auto above = tree.parent[nodes.front()]; above; above = tree.parent[*above]) {
    nodes.insert(nodes.begin(), *above);
  }
  MovingPart part;
  part.tree.world_from_file = tree.world_from_file;
  part.place_of_node.resize(tree.rest.size());
  for (const std::size_t node : nodes) {
    const std::size_t place = part.tree.rest.size();
    const auto& above = tree.parent[node];
    part.place_of_node[node] = place;
    part.tree.rest.push_back(tree.rest[node]);
    part.tree.parent.push_back(above ? part.place_of_node[*above] : std::nullopt);
    part.tree.parents_first.push_back(place);
  }
  for (const std::size_t node : body.node_of_joint) {
    part.place_of_joint.push_back(*part.place_of_node[node]);
  }
  return part;
}

/// Returns the tracks that move `part`, with node indices of `part`. The last of several
/// tracks of one property is used.
std::vector<Track> moving_tracks(const MovingPart& part, std::vector<Track> tracks) {
  std::map<std::pair<std::size_t, std::string>, std::size_t> last;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    last[{tracks[i].node, tracks[i].path}] = i;
  }
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto& place = part.place_of_node[tracks[i].node];
    if (!place || last.at({tracks[i].node, tracks[i].path}) != i) continue;
    tracks[i].node = *place;
    kept.push_back(std::move(tracks[i]));
  }
  return kept;
}

/// Returns every joint's frame in its parent's, without scale.
std::vector<RigidTransform> parent_from_joints(const PlacedNodes& placed,
                                               const MovingPart& part,
                                               const NodeSkeleton& body) {
  std::vector<RigidTransform> world_from_joint;
  std::vector<RigidTransform> local;
  for (std::size_t i = 0; i < part.place_of_joint.size(); ++i) {
    const std::size_t node = part.place_of_joint[i];
    world_from_joint.push_back(
        {placed.rotation[node], glm::dvec3(placed.world_from_node[node][3])});
    const auto& parent = body.skeleton.joints[i].parent;
    local.push_back(parent
                        ? inverse(world_from_joint[index(*parent)]) * world_from_joint[i]
                        : world_from_joint[i]);
  }
  return local;
}

}  // namespace

Result<ReadAnimation> read_animation(const NamedModel& file,
                                     const NodeTree& tree,
                                     const NodeSkeleton& body,
                                     const EachFrame& each) {
  ReadAnimation result;
  for (const auto& animation : file.model.animations) {
    result.names.push_back(animation.name);
  }
  if (file.model.animations.empty()) return result;
  auto tracks = read_tracks(file, file.model.animations.front());
  if (!tracks) return tracks.error();
  if (tracks->empty()) return result;

  double start_s = tracks->front().times_s.front();
  double end_s = tracks->front().times_s.back();
  for (const Track& track : *tracks) {
    start_s = std::min(start_s, track.times_s.front());
    end_s = std::max(end_s, track.times_s.back());
  }
  Motion motion;
  motion.skeleton = body.skeleton;
  motion.rate.hz = rate_of(*tracks);
  const double first = std::round(start_s * motion.rate.hz);
  const double last = std::round(end_s * motion.rate.hz);
  if (!(std::abs(first) <= kMaxFrame && std::abs(last) <= kMaxFrame)) {
    return file.fail("the animation has frames beyond the millionth");
  }
  const auto frames = static_cast<std::size_t>(last - first) + 1;
  const MovingPart part = moving_part(tree, body);
  const std::vector<Track> moving = moving_tracks(part, *std::move(tracks));
  std::size_t numbers = 0;
  for (const Track& track : moving) numbers += track.values.size();
  if (too_many_rotations(part.tree.rest.size(), frames, numbers)) {
    return file.fail("the animation's few keys stand for " + std::to_string(frames) +
                     " frames, which do not fit into memory");
  }
  motion.first_frame = static_cast<int>(first);
  std::vector<NodePose> poses = part.tree.rest;
  std::vector<glm::dmat4> world_from_joint(each ? part.place_of_joint.size() : 0);
  const auto last_frame = static_cast<int>(last);
  for (int frame = motion.first_frame; frame <= last_frame; ++frame) {
    const double time_s = frame / motion.rate.hz;
    for (const Track& track : moving) apply(track, time_s, poses[track.node]);
    const PlacedNodes placed = place_nodes(part.tree, poses);
    for (const std::size_t node : part.place_of_joint) {
      if (is_near(placed, node)) continue;
      return file.fail("the animation takes a joint further than 10 km away");
    }
    if (each) {
      for (std::size_t i = 0; i < part.place_of_joint.size(); ++i) {
        world_from_joint[i] = placed.world_from_node[part.place_of_joint[i]];
      }
      each(world_from_joint);
    }
    PosedBones posed =
        bake_root_motion(body.skeleton, parent_from_joints(placed, part, body));
    motion.poses.push_back(std::move(posed.pose));
    result.ignored_translation_m =
        std::max(result.ignored_translation_m, posed.ignored_translation_m);
  }
  result.motion = std::move(motion);
  return result;
}

}  // namespace marey::recordings

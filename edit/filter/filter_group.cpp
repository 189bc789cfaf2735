// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/filter/filter_group.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/filter/channel_filter.h"
#include "edit/signal/rotation_channels.h"
#include "edit/state/op_weights.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::edit {
namespace {

using Channels = std::vector<std::vector<double>>;

/// Returns the turn about the vertical of the pelvis at the first frame.
glm::dquat first_heading(const EditState& state) {
  const auto joints = world_from_joints(state.motion.skeleton, state.motion.poses[0]);
  const glm::dquat hips =
      retarget::rotation_from_t_pose(state.map, joints, state.map.hips());
  // A pelvis that lies down has no level front; then its left side is level enough.
  constexpr double kLevel = 0.3;
  glm::dvec3 level = hips * glm::dvec3(0.0, 0.0, 1.0);
  if (std::hypot(level.x, level.z) < kLevel) level = hips * glm::dvec3(1.0, 0.0, 0.0);
  return glm::angleAxis(std::atan2(level.x, level.z), glm::dvec3(0.0, 1.0, 0.0));
}

/// The root's place in its own first frame.
struct RootChannels {
  glm::dquat heading;
  glm::dvec3 start{0.0};
  Channels channels;

  explicit RootChannels(const EditState& state)
      : heading(first_heading(state)),
        start(state.motion.poses[0].root_in_world),
        channels(3) {
    for (const Pose& pose : state.motion.poses) {
      const glm::dvec3 p = glm::conjugate(heading) * (pose.root_in_world - start);
      for (int axis = 0; axis < 3; ++axis) {
        channels[static_cast<std::size_t>(axis)].push_back(p[axis]);
      }
    }
  }
  [[nodiscard]] glm::dvec3 in_world(const Channels& filtered, std::size_t frame) const {
    return start + heading * glm::dvec3(filtered[0][frame],
                                        filtered[1][frame],
                                        filtered[2][frame]);
  }
};

std::vector<glm::dquat> rotations_of(const Motion& motion, std::size_t joint) {
  std::vector<glm::dquat> out;
  out.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) out.push_back(pose.parent_from_joint[joint]);
  return out;
}

/// Returns a weight per frame; empty: all are equal.
std::vector<double> weights_of(const EditState& state,
                               const std::vector<std::size_t>& joints) {
  constexpr double kInferred = 0.1;
  std::vector<double> out(state.motion.poses.size(), 1.0);
  std::size_t inferred_frames = 0;
  for (std::size_t t = 0; t < out.size(); ++t) {
    bool inferred = state.lineage.frames[t].trust == Source::kInferred;
    if (!state.uncertainty.empty()) {
      std::size_t count = 0;
      for (const std::size_t joint : joints) {
        if (state.uncertainty[t][joint].source == Source::kInferred) ++count;
      }
      inferred = 2 * count > joints.size();
    }
    if (!inferred) continue;
    out[t] = kInferred;
    ++inferred_frames;
  }
  if (inferred_frames == 0 || inferred_frames == out.size()) return {};
  return out;
}

double rms_apart(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) squares += (a[t] - b[t]) * (a[t] - b[t]);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Root mean square of the angles of a from b, per axis.
double rms_apart_rad(const std::vector<glm::dquat>& a, const std::vector<glm::dquat>& b) {
  double squares = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    const glm::dvec3 apart = rotation_vector(glm::conjugate(a[t]) * b[t]);
    squares += glm::dot(apart, apart) / 3.0;
  }
  return std::sqrt(squares / static_cast<double>(a.size()));
}

}  // namespace

FilteredGroup filter_group(const FilterOp& op,
                           const EditState& state,
                           EditGroup group,
                           std::span<const int> impacts,
                           Motion& out) {
  FilteredGroup found{group, std::nullopt, 0.0, 0.0};
  std::vector<std::size_t> joints;
  for (const JointIndex joint : joints_of_groups(state, std::array{group})) {
    joints.push_back(index(joint));
  }
  const double hz = state.motion.rate.hz;
  Channels all;
  for (const std::size_t joint : joints) {
    const RotationChannels channels(rotations_of(state.motion, joint));
    for (const auto& channel : channels.channels()) all.push_back(channel);
  }
  const bool has_root = group == EditGroup::kRoot;
  const RootChannels root(state);
  if (has_root) all.insert(all.end(), root.channels.begin(), root.channels.end());
  ChannelFilter filter(op, all, weights_of(state, joints), impacts, hz);
  found.cutoff_hz = filter.cutoff_hz();
  if (!found.cutoff_hz) return found;
  const double noise_share = filter.removed_noise_share();
  std::vector<double> noise_rad;
  for (const std::size_t joint : joints) {
    const auto before = rotations_of(state.motion, joint);
    const auto after = filter_rotations(
        before, [&](std::span<std::vector<double>> channels) { filter.run(channels); });
    for (std::size_t t = 0; t < after.size(); ++t) {
      out.poses[t].parent_from_joint[joint] = after[t];
    }
    noise_rad.push_back(rms_apart_rad(before, after) / noise_share);
  }
  found.noise_rad = median_of(std::move(noise_rad));
  if (!has_root) return found;
  Channels filtered = root.channels;
  filter.run(filtered);
  std::vector<double> noise_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    noise_m.push_back(rms_apart(filtered[axis], root.channels[axis]) / noise_share);
  }
  found.noise_m = median_of(std::move(noise_m));
  for (std::size_t t = 0; t < out.poses.size(); ++t) {
    out.poses[t].root_in_world = root.in_world(filtered, t);
  }
  return found;
}

}  // namespace marey::edit

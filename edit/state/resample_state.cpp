// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/resample_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "edit/state/frame_places.h"
#include "edit/state/time_map.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"

namespace marey::edit {
namespace {

/// Tolerance at the ends of the motion. [frames]
constexpr double kBeyondEnd = 1e-9;

// A posture that moved by more than this was not captured. [m]
constexpr double kInvented_m = 0.010;

/// Interpolates channels of equally spaced samples by natural cubic splines.
class SplineSlopes {
 public:
  explicit SplineSlopes(std::size_t count) : factor_(count, 0.0), rest_(count, 0.0) {}

  /// Computes the second derivatives of the natural cubic spline through `values`.
  void solve(const std::vector<double>& values, std::vector<double>& bend) {
    const std::size_t n = values.size();
    bend.assign(n, 0.0);
    if (n < 3) return;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double pivot = 4.0 - factor_[i - 1];
      factor_[i] = 1.0 / pivot;
      const double change = 6.0 * (values[i - 1] - 2.0 * values[i] + values[i + 1]);
      rest_[i] = (change - rest_[i - 1]) / pivot;
    }
    for (std::size_t i = n - 2; i >= 1; --i) {
      bend[i] = rest_[i] - factor_[i] * bend[i + 1];
    }
    factor_.assign(n, 0.0);
    rest_.assign(n, 0.0);
  }

 private:
  std::vector<double> factor_;
  std::vector<double> rest_;
};

double spline_at(const std::vector<double>& values,
                 const std::vector<double>& bend,
                 std::size_t before,
                 double share) {
  const double rest = 1.0 - share;
  return rest * values[before] + share * values[before + 1] +
         (rest * (rest * rest - 1.0) * bend[before] +
          share * (share * share - 1.0) * bend[before + 1]) /
             6.0;
}

/// Interpolates the rotation of one joint by splines through the components of its
/// quaternions, which does not depend on the axes of parent or joint.
void resample_joint(const Motion& from,
                    std::size_t joint,
                    const std::vector<FramePlace>& places,
                    SplineSlopes& slopes,
                    Motion& out) {
  const std::size_t count = from.poses.size();
  std::array<std::vector<double>, 4> values;
  std::array<std::vector<double>, 4> bend;
  for (auto& channel : values) channel.resize(count);
  glm::dquat last(1.0, 0.0, 0.0, 0.0);
  for (std::size_t t = 0; t < count; ++t) {
    glm::dquat q = from.poses[t].parent_from_joint[joint];
    if (t > 0 && glm::dot(q, last) < 0.0) q = -q;
    last = q;
    values[0][t] = q.w;
    values[1][t] = q.x;
    values[2][t] = q.y;
    values[3][t] = q.z;
  }
  for (std::size_t c = 0; c < 4; ++c) slopes.solve(values[c], bend[c]);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [before, share] = places[k];
    glm::dquat& q = out.poses[k].parent_from_joint[joint];
    if (share == 0.0) {
      q = from.poses[before].parent_from_joint[joint];
      continue;
    }
    const auto at = [&](std::size_t c) {
      return spline_at(values[c], bend[c], before, share);
    };
    q = glm::normalize(glm::dquat(at(0), at(1), at(2), at(3)));
  }
}

void resample_root(const Motion& from,
                   const std::vector<FramePlace>& places,
                   SplineSlopes& slopes,
                   Motion& out) {
  std::vector<double> values(from.poses.size());
  std::vector<double> bend;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t t = 0; t < values.size(); ++t) {
      values[t] = from.poses[t].root_in_world[axis];
    }
    slopes.solve(values, bend);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto [before, share] = places[k];
      out.poses[k].root_in_world[axis] =
          share == 0.0 ? values[before] : spline_at(values, bend, before, share);
    }
  }
}

Motion resample_motion(const Motion& from,
                       const std::vector<FramePlace>& places,
                       double rate_hz) {
  Motion out{from.skeleton, FrameRate{rate_hz}, 0, {}};
  const std::size_t joints = from.skeleton.joints.size();
  const bool is_slice = std::all_of(
      places.begin(), places.end(), [](const FramePlace& b) { return b.share == 0.0; });
  if (is_slice) {
    out.poses.reserve(places.size());
    for (const FramePlace& place : places) out.poses.push_back(from.poses[place.before]);
    return out;
  }
  out.poses.resize(places.size());
  for (Pose& pose : out.poses) pose.parent_from_joint.resize(joints);
  SplineSlopes slopes(from.poses.size());
  resample_root(from, places, slopes, out);
  for (std::size_t j = 0; j < joints; ++j) resample_joint(from, j, places, slopes, out);
  return out;
}

std::vector<std::vector<JointUncertainty>> resample_uncertainty(
    const std::vector<std::vector<JointUncertainty>>& from,
    const std::vector<FramePlace>& places) {
  std::vector<std::vector<JointUncertainty>> out;
  if (from.empty()) return out;
  out.reserve(places.size());
  for (const auto& [before, share] : places) {
    out.push_back(from[before]);
    if (share == 0.0) continue;
    for (std::size_t j = 0; j < out.back().size(); ++j) {
      JointUncertainty& entry = out.back()[j];
      const JointUncertainty& next = from[before + 1][j];
      entry.sigma_m = std::max(entry.sigma_m, next.sigma_m);
      entry.source = worse_source(entry.source, next.source);
      entry.segment_source = worse_source(entry.segment_source, next.segment_source);
    }
  }
  return out;
}

/// Contacts hold up to half a frame before their first and after their last frame.
std::vector<FrameRange> resample_runs(const std::vector<FrameRange>& runs,
                                      std::span<const double> at_frame) {
  std::vector<FrameRange> out;
  for (const FrameRange& run : runs) {
    const auto first =
        std::lower_bound(at_frame.begin(), at_frame.end(), run.first - 0.5);
    const auto end = std::lower_bound(at_frame.begin(), at_frame.end(), run.last + 0.5);
    if (first >= end) continue;
    out.push_back({static_cast<int>(first - at_frame.begin()),
                   static_cast<int>(end - at_frame.begin()) - 1});
  }
  return out;
}

Contacts resample_contacts(const Contacts& from, std::span<const double> at_frame) {
  Contacts out = from;
  out.frame_count = static_cast<int>(at_frame.size());
  for (FootContacts& foot : out.feet) {
    for (auto* runs : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
      *runs = resample_runs(*runs, at_frame);
    }
  }
  return out;
}

}  // namespace

Pose between_poses(const Pose& a, const Pose& b, double share) {
  if (share <= 0.0) return a;
  if (share >= 1.0) return b;
  Pose out = a;
  if (a.root_in_world != b.root_in_world) {
    out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  }
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    glm::dquat to = b.parent_from_joint[j];
    const glm::dquat& from = a.parent_from_joint[j];
    if (from == to) continue;
    if (glm::dot(from, to) < 0.0) to = -to;
    out.parent_from_joint[j] = glm::normalize(glm::slerp(from, to, share));
  }
  return out;
}

EditState resample_state(const EditState& state,
                         std::span<const double> at_frame,
                         double rate_hz) {
  MAREY_ASSERT(rate_hz > 0.0 && !at_frame.empty());
  MAREY_ASSERT(at_frame.front() >= -kBeyondEnd &&
               at_frame.back() <= state.frame_count() - 1 + kBeyondEnd);
  const std::vector<FramePlace> places =
      frame_places(at_frame, state.motion.poses.size());
  const TimeMap times(at_frame, state.motion.rate.hz, rate_hz);
  EditState out;
  out.motion = resample_motion(state.motion, places, rate_hz);
  out.map = state.map;
  out.uncertainty = resample_uncertainty(state.uncertainty, places);
  out.lineage = resample_lineage(state.lineage, places);
  out.contacts = resample_contacts(state.contacts, at_frame);
  out.constraints = times.mapped(state.constraints);
  out.contact_edits = times.mapped(state.contact_edits);
  out.annotations = resample_annotations(state.annotations, places, times);
  return out;
}

EditState slice_state(const EditState& state, const FrameRange& frames) {
  MAREY_ASSERT(frames.first >= 0 && frames.first <= frames.last &&
               frames.last < state.frame_count());
  std::vector<double> at_frame;
  at_frame.reserve(static_cast<std::size_t>(frames.last - frames.first + 1));
  for (int frame = frames.first; frame <= frames.last; ++frame) at_frame.push_back(frame);
  return resample_state(state, at_frame, state.motion.rate.hz);
}

void mark_invented(EditState& state, const FrameRange& frames, int op) {
  if (frames.last < frames.first) return;
  touch(state.lineage, frames, op);
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    state.lineage.frames[t].trust = Source::kInferred;
    if (state.uncertainty.empty()) continue;
    for (JointUncertainty& entry : state.uncertainty[t]) {
      entry.source = Source::kInferred;
      entry.segment_source = Source::kInferred;
    }
  }
}

namespace {

/// Joints from the hips on; those above may be far from the body.
std::vector<char> is_body_joint(const EditState& state) {
  std::vector<char> out(state.motion.skeleton.joints.size(), 1);
  auto joint = state.motion.skeleton[state.map.hips()].parent;
  for (; joint; joint = state.motion.skeleton[*joint].parent) out[index(*joint)] = 0;
  return out;
}

}  // namespace

double mark_displaced(EditState& state,
                      const Motion& before,
                      const FrameRange& frames,
                      int op,
                      bool relative) {
  MAREY_ASSERT(before.poses.size() == state.motion.poses.size());
  if (frames.last < frames.first) return 0.0;
  touch(state.lineage, frames, op);
  double largest_m = 0.0;
  const std::vector<char> counts = is_body_joint(state);
  const std::size_t hips = index(state.map.hips());
  std::vector<RigidTransform> old_joints(before.skeleton.joints.size());
  std::vector<RigidTransform> new_joints(old_joints.size());
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    world_from_joints(before.skeleton, before.poses[t], old_joints);
    world_from_joints(state.motion.skeleton, state.motion.poses[t], new_joints);
    const RigidTransform moved_from_old =
        relative ? new_joints[hips] * inverse(old_joints[hips]) : RigidTransform{};
    double frame_m = 0.0;
    for (std::size_t j = 0; j < old_joints.size(); ++j) {
      if (!counts[j]) continue;
      const double moved_m = glm::distance(moved_from_old * old_joints[j].translation,
                                           new_joints[j].translation);
      frame_m = std::max(frame_m, moved_m);
      if (moved_m <= kInvented_m || state.uncertainty.empty()) continue;
      state.uncertainty[t][j].source = Source::kInferred;
      state.uncertainty[t][j].segment_source = Source::kInferred;
    }
    if (frame_m > kInvented_m) state.lineage.frames[t].trust = Source::kInferred;
    largest_m = std::max(largest_m, frame_m);
  }
  return largest_m;
}

}  // namespace marey::edit

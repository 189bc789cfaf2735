// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_ghost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/motion/zmp_figures.h"
#include "core/humanoid.h"
#include "core/transform.h"
#include "live/page/page_frame.h"
#include "retarget/body/place_masses.h"

namespace marey::app {
namespace {

/// Returns the pose between two frames of a motion.
Pose pose_between(const Motion& motion, double frame) {
  const double last = static_cast<double>(motion.poses.size() - 1);
  const double at = std::clamp(frame, 0.0, last);
  const auto before = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(before);
  if (share == 0.0) return motion.poses[before];
  const Pose& a = motion.poses[before];
  const Pose& b = motion.poses[before + 1];
  Pose out = a;
  out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    out.parent_from_joint[j] =
        glm::slerp(a.parent_from_joint[j], b.parent_from_joint[j], share);
  }
  return out;
}

using OptionalPoses = std::vector<std::optional<Pose>>;

/// The places of one joint in consecutive frames. [m]
using JointPlaces = std::vector<std::optional<glm::dvec3>>;

constexpr std::array<HumanBone, 3> kGraphBones{
    HumanBone::kLeftFoot, HumanBone::kRightFoot, HumanBone::kHips};

/// Computes the places of kGraphBones. `pose` returns the pose of a frame, or null.
template <class PoseOf>
std::array<JointPlaces, 3> graph_places(const Skeleton& skeleton,
                                        std::size_t count,
                                        const PoseOf& pose_of) {
  std::array<JointPlaces, 3> out;
  std::vector<RigidTransform> world(skeleton.joints.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Pose* pose = pose_of(i);
    if (pose != nullptr) world_from_joints(skeleton, *pose, world);
    for (std::size_t b = 0; b < kGraphBones.size(); ++b) {
      const auto joint = skeleton.find(kGraphBones[b]);
      std::optional<glm::dvec3>& place = out[b].emplace_back();
      if (pose != nullptr && joint) place = world[index(*joint)].translation;
    }
  }
  return out;
}

std::vector<std::optional<double>> heights_of(const JointPlaces& places) {
  std::vector<std::optional<double>> out;
  for (const auto& place : places) {
    out.push_back(place ? std::optional<double>(place->y) : std::nullopt);
  }
  return out;
}

/// Returns the speed by differences to the neighbours that exist. [m/s]
std::vector<std::optional<double>> speeds_of(const JointPlaces& places, double rate_hz) {
  std::vector<std::optional<double>> out(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i]) continue;
    const std::size_t from = i > 0 && places[i - 1] ? i - 1 : i;
    const std::size_t to = i + 1 < places.size() && places[i + 1] ? i + 1 : i;
    if (from == to) continue;
    out[i] = glm::distance(*places[to], *places[from]) * rate_hz /
             static_cast<double>(to - from);
  }
  return out;
}

/// Returns the rms uncertainty of a frame's joints. [mm]
std::optional<double> frame_sigma_mm(const edit::EditState& state, std::size_t frame) {
  if (frame >= state.uncertainty.size()) return std::nullopt;
  double sum = 0.0;
  for (const JointUncertainty& joint : state.uncertainty[frame]) {
    sum += 1e6 * joint.sigma_m * joint.sigma_m;
  }
  const double count =
      std::max<double>(1.0, static_cast<double>(state.uncertainty[frame].size()));
  return std::sqrt(sum / count);
}

EditGraph sigma_graph(const edit::EditState& source,
                      const edit::EditState& result,
                      const OptionalPoses& ghost,
                      const FrameRange& span) {
  EditGraph graph{"joint uncertainty", "mm", {}, {}};
  for (std::size_t i = 0; i < ghost.size(); ++i) {
    const std::size_t frame = static_cast<std::size_t>(span.first) + i;
    graph.values.push_back(frame_sigma_mm(result, frame));
    const double of_source = result.lineage.frames[frame].source_frame;
    graph.before.push_back(
        ghost[i] ? frame_sigma_mm(source, static_cast<std::size_t>(of_source + 0.5))
                 : std::nullopt);
  }
  return graph;
}

}  // namespace

OptionalPoses ghost_poses(const edit::EditState& source,
                          const edit::EditState& result,
                          const FrameRange& span) {
  OptionalPoses out;
  for (int t = span.first; t <= span.last; ++t) {
    const edit::FrameLineage& lineage =
        result.lineage.frames[static_cast<std::size_t>(t)];
    std::optional<Pose>& pose = out.emplace_back();
    if (lineage.source == 0) pose = pose_between(source.motion, lineage.source_frame);
  }
  return out;
}

/// Returns centre of mass, support area and zero moment point per frame; empty if the
/// body has no masses.
std::vector<retarget::BalanceFrame> balance_of(const edit::EditState& state) {
  const auto masses = retarget::place_masses(state.motion.skeleton, state.map, {});
  if (!masses) return {};
  return motion_zmp(state.motion, state.map, state.contacts, *masses).frames;
}

std::string edit_block(const edit::EditState& source,
                       const edit::EditState& result,
                       const OptionalPoses& ghost,
                       const FrameRange& span) {
  std::string out;
  live::append_motion_block_head(static_cast<std::uint32_t>(ghost.size()), 2, out);
  const std::vector<retarget::BalanceFrame> balance = balance_of(result);
  std::array<live::PageFigure, 2> figures;
  figures[0].joints = source.motion.skeleton.joints.size();
  figures[1].joints = result.motion.skeleton.joints.size();
  for (std::size_t i = 0; i < ghost.size(); ++i) {
    const std::size_t frame = static_cast<std::size_t>(span.first) + i;
    figures[0].pose = ghost[i] ? &*ghost[i] : nullptr;
    figures[1].pose = &result.motion.poses[frame];
    if (frame < result.uncertainty.size()) {
      figures[1].uncertainty = result.uncertainty[frame];
    }
    if (frame < balance.size()) {
      const retarget::BalanceFrame& one = balance[frame];
      figures[1].balance =
          live::PageBalance{one.centre_of_mass_in_world, one.support_xz_m, one.zmp_xz_m};
    }
    live::append_frame({.frame = static_cast<std::uint32_t>(frame),
                        .time_s = static_cast<double>(frame) / result.motion.rate.hz,
                        .sent_s = 0.0,
                        .figures = figures},
                       out);
  }
  return out;
}

std::vector<EditGraph> edit_graphs(const edit::EditState& source,
                                   const edit::EditState& result,
                                   const OptionalPoses& ghost,
                                   const FrameRange& span) {
  const auto first = static_cast<std::size_t>(span.first);
  const auto values =
      graph_places(result.motion.skeleton, ghost.size(), [&](std::size_t i) {
        return &result.motion.poses[first + i];
      });
  const auto before =
      graph_places(source.motion.skeleton, ghost.size(), [&](std::size_t i) {
        return ghost[i] ? &*ghost[i] : nullptr;
      });
  const double rate = result.motion.rate.hz;
  std::vector<EditGraph> out;
  const auto add_height = [&](const char* graph_name, std::size_t bone) {
    out.push_back({graph_name, "m", heights_of(values[bone]), heights_of(before[bone])});
  };
  const auto add_speed = [&](const char* graph_name, std::size_t bone) {
    out.push_back({graph_name,
                   "m/s",
                   speeds_of(values[bone], rate),
                   speeds_of(before[bone], rate)});
  };
  add_height("left foot height", 0);
  add_height("right foot height", 1);
  add_speed("left foot speed", 0);
  add_speed("right foot speed", 1);
  add_height("hips height", 2);
  add_speed("hips speed", 2);
  if (!result.uncertainty.empty()) {
    out.push_back(sigma_graph(source, result, ghost, span));
  }
  return out;
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_stills.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kSpread = 5;

double whole_mm(double length_m) {
  return rounded(1e3 * length_m, 0);
}

Json place_mm(const glm::dvec3& p_in_world) {
  return {whole_mm(p_in_world.x), whole_mm(p_in_world.y), whole_mm(p_in_world.z)};
}

/// Frames to show, in ascending order, and the frame of the largest error.
struct Chosen {
  std::vector<std::size_t> frames;
  std::size_t worst = 0;
};

std::optional<Chosen> chosen_frames(const std::vector<double>& rms_m) {
  std::vector<std::size_t> shown;
  for (std::size_t f = 0; f < rms_m.size(); ++f) {
    if (rms_m[f] > 0.0) shown.push_back(f);
  }
  if (shown.empty()) return std::nullopt;
  Chosen out;
  out.worst = static_cast<std::size_t>(std::max_element(rms_m.begin(), rms_m.end()) -
                                       rms_m.begin());
  out.frames.push_back(out.worst);
  for (std::size_t i = 0; i < kSpread; ++i) {
    out.frames.push_back(shown[(2 * i + 1) * shown.size() / (2 * kSpread)]);
  }
  std::sort(out.frames.begin(), out.frames.end());
  out.frames.erase(std::unique(out.frames.begin(), out.frames.end()), out.frames.end());
  return out;
}

/// Returns the heading of the body on the floor, computed from the more horizontal of its
/// forward axis and the normal of its left axis. (x, z), of length 1.
glm::dvec2 facing(const RigidTransform& world_from_hips) {
  const glm::dvec3 forward = world_from_hips.rotation * glm::dvec3(0.0, 0.0, 1.0);
  const glm::dvec3 left = world_from_hips.rotation * glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec2 ahead(forward.x, forward.z);
  const glm::dvec2 across(-left.z, left.x);
  const glm::dvec2 way = glm::length(across) > glm::length(ahead) ? across : ahead;
  return glm::length(way) > 0.0 ? glm::normalize(way) : glm::dvec2(0.0, 1.0);
}

/// Returns the positions of joints, then of tips, in the order of still_bones().
Json joints_mm(const Skeleton& skeleton, const std::vector<RigidTransform>& world) {
  Json out = Json::array();
  for (const RigidTransform& joint : world) out.push_back(place_mm(joint.translation));
  for (std::size_t j = 0; j < world.size(); ++j) {
    const auto& tip = skeleton.joints[j].tip_in_joint;
    if (tip) out.push_back(place_mm(world[j] * *tip));
  }
  return out;
}

/// Returns for each visible marker [marker, place, fate] and, if it is on the body, its
/// place on the body.
Json still_markers(const Body& body,
                   const reconstruct::SolvedMarkers& solved,
                   const MarkerHistory& history,
                   std::size_t frame) {
  Json out = Json::array();
  const std::size_t placed = body.markers.size();
  for (std::size_t m = 0; m < history.after.markers(); ++m) {
    const auto& sample = history.after.at(frame, m);
    if (!sample) continue;
    Json marker{
        m, static_cast<int>(history.fate(frame, m)), place_mm(sample->p_in_world)};
    for (std::size_t b = 0; b < placed; ++b) {
      if (body.markers[b].label != history.after.labels[m]) continue;
      const glm::dvec3& on_body = solved.modelled_in_world[frame * placed + b];
      marker.push_back(place_mm(on_body));
      marker.push_back(rounded(1e3 * glm::distance(on_body, sample->p_in_world), 1));
      break;
    }
    out.push_back(std::move(marker));
  }
  return out;
}

}  // namespace

Json still_bones(const Skeleton& skeleton) {
  Json bones = Json::array();
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const auto& parent = skeleton.joints[j].parent;
    if (parent) bones.push_back({index(*parent), j, index(*parent)});
  }
  std::size_t tip = skeleton.joints.size();
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].tip_in_joint) bones.push_back({j, tip++, j});
  }
  return bones;
}

Json marker_stills(const Body& body,
                   const reconstruct::SolvedMarkers& solved,
                   const MarkerHistory& history) {
  Json out = Json::array();
  const auto chosen = chosen_frames(solved.frame_rms_m);
  if (!chosen) return out;
  const Motion& motion = solved.estimate.motion;
  for (const std::size_t f : chosen->frames) {
    const auto world = world_from_joints(motion.skeleton, motion.poses[f]);
    const glm::dvec2 way = facing(world.front());
    Json sources = Json::array();
    for (const JointUncertainty& uncertainty : solved.estimate.uncertainty[f]) {
      sources.push_back(static_cast<int>(uncertainty.source));
    }
    out.push_back({{"frame", f},
                   {"is_worst", f == chosen->worst},
                   {"rms_mm", rounded(1e3 * solved.frame_rms_m[f], 2)},
                   {"facing", {rounded(way.x, 4), rounded(way.y, 4)}},
                   {"joints_mm", joints_mm(motion.skeleton, world)},
                   {"sources", sources},
                   {"markers", still_markers(body, solved, history, f)}});
  }
  return out;
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "tests/support/files/posed_glb.h"

namespace marey::testing {

/// Places of the bones of a body in one frame. Y is up; any heading, any unit.
using Landmarks = std::map<HumanBone, glm::dvec3>;

/// Reads the landmarks of a captured motion from its file's own numbers: a .bvh with the
/// names of Bandai or CMU, an .amc with its .asf in the same folder, a .glb. In metres,
/// Y up.
/// Throws std::runtime_error for a file of another kind, or without these names.
[[nodiscard]] std::vector<Landmarks> read_landmarks(const std::filesystem::path& path);

/// Maps bones to the nodes of a body by the names of common schemes. Bones without a node
/// are left out.
[[nodiscard]] std::map<HumanBone, std::string> bone_nodes(
    const std::vector<std::string>& names);

/// Measures of a retargeted file.
struct BodyFigures {
  std::size_t frames = 0;
  double skin_depth_mm = 0.0;  ///< Deepest vertex below Y = 0; 0: none is.
  int skin_frame = -1;
  std::string skin_node;
  /// Lowest landmark of the source, feet left out, below the floor that its ankles stand
  /// on. [mm]
  double source_depth_mm = 0.0;
  /// Directions of leg segments against the source's at the same time, and of the line
  /// from mid-hip to mid-shoulder: the largest median, which, and the largest 95th
  /// percentile. The bodies are first turned about Y to the same mean heading. [deg]
  double worst_median_deg = 0.0;
  std::string worst_segment;
  double worst_p95_deg = 0.0;
  double trunk_median_deg = 0.0;
  double arms_median_deg = 0.0;  ///< The largest of arms, which `worst_...` leave out.
  /// Yaw of each foot (ankle to toe joint) against the source's, where both are less
  /// steep than 60 degrees: the largest that is exceeded for a quarter of a second on
  /// end, of which foot, from which frame on. 0 without toe joints. [deg]
  double foot_yaw_deg = 0.0;
  std::string foot_yaw_bone;
  int foot_yaw_frame = -1;
  /// The median of each segment: "leftUpperLeg", ..., "trunk", "neck". [deg]
  std::map<std::string, double> medians_deg;
  double heading_deg = 0.0;  ///< Mean heading of the body relative to the source.
  /// Share of frames in which left and right are exchanged: feet that point backwards
  /// where the source's do not.
  double exchanged_share = 0.0;
  /// Fastest joint, in body heights (head to ankle) per second, and the source's.
  double max_speed = 0.0;
  double source_max_speed = 0.0;
};

/// Judges the program's output, frame by frame, without the program's code.
/// Throws std::runtime_error when the frames do not agree.
[[nodiscard]] BodyFigures judge_body(PosedGlb& body,
                                     const std::map<HumanBone, std::string>& nodes,
                                     const std::vector<Landmarks>& source);

}  // namespace marey::testing

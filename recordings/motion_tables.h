// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/provenance.h"
#include "core/result.h"
#include "core/transform.h"

namespace marey::recordings {

/// A row of joints.csv.
struct JointRow {
  int frame = 0;
  double time_s = 0.0;  ///< Since the trial's frame 0.
  std::string joint;
  glm::dvec3 p_in_world{0.0};  ///< [m]
  double sigma_m = 0.0;
};

/// A row of segments.csv.
struct SegmentRow {
  int frame = 0;
  double time_s = 0.0;  ///< Since the trial's frame 0.
  std::string segment;
  RigidTransform world_from_segment;
  Source source = Source::kInferred;
};

/// Writes joints.csv: `frame,time,joint,x,y,z,sigma`, every joint centre of every frame
/// in world metres, six decimals. At once or not at all. Memory does not grow with
/// frames. Errors: the disk; a joint name that a table cannot hold (comma, quote or line
/// end). Precondition: one doubt per joint and frame; every number finite.
/// `start_s`: the time of the first frame, on a clock of the recording's own; without it
/// that is first_frame / rate.
[[nodiscard]] Status write_joints_csv(const std::filesystem::path& path,
                                      const EstimatedMotion& estimated,
                                      std::optional<double> start_s = {});

/// Writes `frame,time,joint,x,y,z`: joints.csv of a motion of which no doubt is known.
/// Otherwise as write_joints_csv().
[[nodiscard]] Status write_places_csv(const std::filesystem::path& path,
                                      const Motion& motion);

/// Writes segments.csv: `frame,time,segment,x,y,z,qw,qx,qy,qz,source`, the place and the
/// rotation of every joint's frame in the world, six decimals, qw >= 0; otherwise as
/// write_joints_csv().
[[nodiscard]] Status write_segments_csv(const std::filesystem::path& path,
                                        const EstimatedMotion& estimated,
                                        std::optional<double> start_s = {});

// Readers. `file` is what error messages call the text. Errors (kBadInput), with the
// line: another header; a row with a field too few or too many, or that is not a number.
[[nodiscard]] Result<std::vector<JointRow>> parse_joints_csv(std::string_view text,
                                                             const std::string& file);
[[nodiscard]] Result<std::vector<SegmentRow>> parse_segments_csv(std::string_view text,
                                                                 const std::string& file);
[[nodiscard]] Result<std::vector<JointRow>> read_joints_csv(
    const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<SegmentRow>> read_segments_csv(
    const std::filesystem::path& path);
/// Reads what write_places_csv() wrote; every sigma is 0.
[[nodiscard]] Result<std::vector<JointRow>> read_places_csv(
    const std::filesystem::path& path);

}  // namespace marey::recordings

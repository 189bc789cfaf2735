// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "core/source.h"
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
struct SegmentTableRow {
  int frame = 0;
  double time_s = 0.0;  ///< Since the trial's frame 0.
  std::string segment;
  RigidTransform world_from_segment;
  Source source = Source::kInferred;
};

/// Writes joints.csv: `frame,time,joint,x,y,z,sigma`, every joint centre of every frame
/// in world metres, six decimals. The file is written as a whole or not at all. Memory
/// does not grow with frames. `start_s` is the time of the first frame on the recording's
/// own clock; default: first_frame / rate. Errors: the disk; a joint name with a comma,
/// quote or line end. Preconditions: one uncertainty per joint and frame; every number is
/// finite.
[[nodiscard]] Status write_joints_csv(const std::filesystem::path& path,
                                      const EstimatedMotion& estimated,
                                      std::optional<double> start_s = {});

/// Writes `frame,time,joint,x,y,z`: joints.csv of a motion without uncertainty. Otherwise
/// as write_joints_csv().
[[nodiscard]] Status write_places_csv(const std::filesystem::path& path,
                                      const Motion& motion);

/// Writes segments.csv: `frame,time,segment,x,y,z,qw,qx,qy,qz,source`, the position and
/// the rotation of every joint's frame in the world, six decimals, qw >= 0. Otherwise as
/// write_joints_csv().
[[nodiscard]] Status write_segments_csv(const std::filesystem::path& path,
                                        const EstimatedMotion& estimated,
                                        std::optional<double> start_s = {});

// Readers. `file` is the name of the text in error messages. Errors (kBadInput), with the
// line: another header; a row with a missing or additional field, or with one that is no
// number.
[[nodiscard]] Result<std::vector<JointRow>> parse_joints_csv(std::string_view text,
                                                             const std::string& file);
[[nodiscard]] Result<std::vector<SegmentTableRow>> parse_segments_csv(
    std::string_view text, const std::string& file);
[[nodiscard]] Result<std::vector<JointRow>> read_joints_csv(
    const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<SegmentTableRow>> read_segments_csv(
    const std::filesystem::path& path);
/// Reads the output of write_places_csv(); every sigma is 0.
[[nodiscard]] Result<std::vector<JointRow>> read_places_csv(
    const std::filesystem::path& path);

}  // namespace marey::recordings

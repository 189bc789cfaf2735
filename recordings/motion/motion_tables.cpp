// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/motion_tables.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/base/time.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"
#include "recordings/base/number_text.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kJointsHeader = "frame,time,joint,x,y,z,sigma";
constexpr std::string_view kPlacesHeader = "frame,time,joint,x,y,z";
constexpr std::string_view kSegmentsHeader =
    "frame,time,segment,x,y,z,qw,qx,qy,qz,source";

void append_cell(std::string& line, double value) {
  line += ',';
  append_fixed(line, value);
}

void append_cells(std::string& line, const glm::dvec3& v) {
  append_cell(line, v.x);
  append_cell(line, v.y);
  append_cell(line, v.z);
}

Status check_names(const std::filesystem::path& path, const Skeleton& skeleton) {
  for (const Joint& joint : skeleton.joints) {
    if (joint.name.find_first_of(",\"\r\n") == std::string::npos) continue;
    return bad_input(path.string(),
                     "a table cannot hold the joint name '" + joint.name + "'",
                     "rename the joint without comma, quote or line end");
  }
  return Done{};
}

/// Writes `header` and one row per frame and joint; `finish_row` appends the cells after
/// the position.
template <class FinishRow>
Status write_rows(const std::filesystem::path& path,
                  std::string_view header,
                  const Motion& motion,
                  std::optional<double> start_s,
                  const FinishRow& finish_row) {
  const std::vector<Joint>& joints = motion.skeleton.joints;
  if (Status names = check_names(path, motion.skeleton); !names) return names;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();

  std::string lines(header);
  lines += '\n';
  std::vector<RigidTransform> world_from_joint(joints.size());
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    world_from_joints(motion.skeleton, motion.poses[i], world_from_joint);
    const int frame = motion.first_frame + static_cast<int>(i);
    std::string start;
    append_exact(start, frame);
    append_cell(start,
                start_s ? *start_s + static_cast<double>(i) / motion.rate.hz
                        : seconds(frame_time(frame, motion.rate)));
    for (std::size_t j = 0; j < joints.size(); ++j) {
      lines.append(start).append(",").append(joints[j].name);
      append_cells(lines, world_from_joint[j].translation);
      finish_row(lines, world_from_joint[j].rotation, i, j);
      lines += '\n';
    }
    file->append(lines);  // Frame by frame, so that memory does not grow.
    lines.clear();
  }
  file->append(lines);
  return file->commit();
}

/// Applies write_rows() with the estimate of each joint.
template <class FinishRow>
Status write_table(const std::filesystem::path& path,
                   std::string_view header,
                   const EstimatedMotion& estimated,
                   std::optional<double> start_s,
                   const FinishRow& finish_row) {
  MAREY_ASSERT(estimated.uncertainty.size() == estimated.motion.poses.size());
  const auto finish =
      [&](std::string& line, const glm::dquat& rotation, std::size_t i, std::size_t j) {
        MAREY_ASSERT(j < estimated.uncertainty[i].size());
        finish_row(line, rotation, estimated.uncertainty[i][j]);
      };
  return write_rows(path, header, estimated.motion, start_s, finish);
}

std::optional<Source> source_of(std::string_view word) {
  for (const Source source : {Source::kMeasured, Source::kRepaired, Source::kInferred}) {
    if (word == name(source)) return source;
  }
  return std::nullopt;
}

JointRow place_row(CsvFields& fields) {
  JointRow row;
  row.frame = fields.number<int>();
  row.time_s = fields.number<double>();
  row.joint = fields.text();
  for (int i = 0; i < 3; ++i) row.p_in_world[i] = fields.number<double>();
  return row;
}

JointRow joint_row(CsvFields& fields) {
  JointRow row = place_row(fields);
  row.sigma_m = fields.number<double>();
  return row;
}

/// nullopt when the last field is not a source.
std::optional<SegmentTableRow> segment_row(CsvFields& fields) {
  SegmentTableRow row;
  row.frame = fields.number<int>();
  row.time_s = fields.number<double>();
  row.segment = fields.text();
  RigidTransform& pose = row.world_from_segment;
  for (int i = 0; i < 3; ++i) pose.translation[i] = fields.number<double>();
  std::array<double, 4> wxyz{};
  for (double& value : wxyz) value = fields.number<double>();
  pose.rotation = glm::dquat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const std::optional<Source> source = source_of(fields.text());
  if (!source) return std::nullopt;
  row.source = *source;
  return row;
}

/// Parses every row of a table; `take` makes a Row, or an optional one, of a line's
/// fields.
template <class Row, class Take>
Result<std::vector<Row>> parse_table(std::string_view text,
                                     const std::string& file,
                                     std::string_view header,
                                     const Take& take) {
  CsvLines lines(text);
  if (const auto first = lines.next(); !first || *first != header) {
    return bad_input(file + ":1",
                     std::string("the first line is not '").append(header).append("'"),
                     "name a table that marey wrote");
  }
  std::vector<Row> rows;
  while (const std::optional<std::string_view> line = lines.next()) {
    CsvFields fields(*line);
    std::optional<Row> row = take(fields);
    if (!row || !fields.good() || !fields.ended()) {
      std::string where = file + ":";
      append_exact(where, lines.number());
      return bad_input(std::move(where),
                       std::string("the row does not match '").append(header).append("'"),
                       "correct or remove it");
    }
    rows.push_back(*std::move(row));
  }
  return rows;
}

}  // namespace

Status write_joints_csv(const std::filesystem::path& path,
                        const EstimatedMotion& estimated,
                        std::optional<double> start_s) {
  return write_table(
      path,
      kJointsHeader,
      estimated,
      start_s,
      [](std::string& line, const glm::dquat&, const JointUncertainty& uncertainty) {
        append_cell(line, uncertainty.sigma_m);
      });
}

Status write_places_csv(const std::filesystem::path& path, const Motion& motion) {
  return write_rows(path,
                    kPlacesHeader,
                    motion,
                    std::nullopt,
                    [](std::string&, const glm::dquat&, std::size_t, std::size_t) {});
}

Status write_segments_csv(const std::filesystem::path& path,
                          const EstimatedMotion& estimated,
                          std::optional<double> start_s) {
  return write_table(path,
                     kSegmentsHeader,
                     estimated,
                     start_s,
                     [](std::string& line,
                        const glm::dquat& rotation,
                        const JointUncertainty& uncertainty) {
                       const glm::dquat q = rotation.w < 0.0 ? -rotation : rotation;
                       append_cell(line, q.w);
                       append_cells(line, {q.x, q.y, q.z});
                       line.append(",").append(name(uncertainty.source));
                     });
}

Result<std::vector<JointRow>> parse_joints_csv(std::string_view text,
                                               const std::string& file) {
  return parse_table<JointRow>(text, file, kJointsHeader, [](CsvFields& fields) {
    return std::optional(joint_row(fields));
  });
}

Result<std::vector<SegmentTableRow>> parse_segments_csv(std::string_view text,
                                                        const std::string& file) {
  return parse_table<SegmentTableRow>(text, file, kSegmentsHeader, segment_row);
}

Result<std::vector<JointRow>> read_joints_csv(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_joints_csv(*text, path.string());
}

Result<std::vector<SegmentTableRow>> read_segments_csv(
    const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_segments_csv(*text, path.string());
}

Result<std::vector<JointRow>> read_places_csv(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_table<JointRow>(
      *text, path.string(), kPlacesHeader, [](CsvFields& fields) {
        return std::optional(place_row(fields));
      });
}

}  // namespace marey::recordings

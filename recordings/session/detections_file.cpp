// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/detections_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"
#include "recordings/base/number_text.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kAnyVersion = "# marey detections ";
constexpr std::string_view kVersion = "# marey detections 4 ";
constexpr std::string_view kSource = "# source: ";
constexpr std::string_view kCamera =
    "# camera,width_px,height_px,rate_hz,offset_ns,unsure,duplicated,damaged: ";
constexpr double kMinTag_px2 = 1.0;  // A tag has at least 64 cells.
constexpr std::string_view kHeader =
    "frame,tag,x0,y0,x1,y1,x2,y2,x3,y3,sigma,margin,hamming or frame,point,x,y,sigma";
constexpr std::ptrdiff_t kPointCommas = 4;
constexpr std::string_view kNoTag = ",,,,,,,,,,,,";
constexpr std::string_view kEnd = "# end, frames: ";

void append_header(std::string& text, const CameraDetections& found) {
  text.append(kSource).append(found.source).append("\n").append(kCamera);
  append_exact(text, static_cast<int>(found.camera));
  for (const int side_px : {found.width_px, found.height_px}) {
    text += ',';
    append_exact(text, side_px);
  }
  text += ',';
  append_exact(text, found.rate.hz);
  text += ',';
  if (found.offset) text += std::to_string(found.offset->count());
  for (const int count :
       {found.dropped.unsure, found.dropped.duplicated, found.damaged_frames}) {
    text += ',';
    append_exact(text, count);
  }
  text += '\n';
  text.append(kHeader).append("\n");
}

void append_cell(std::string& text, double value) {
  text += ',';
  append_exact(text, value);
}

void append_tag(std::string& text, const TagDetection& tag) {
  text += ',';
  append_exact(text, number(tag.id));
  for (const glm::dvec2& corner_px : tag.corners_px) {
    append_cell(text, corner_px.x);
    append_cell(text, corner_px.y);
  }
  append_cell(text, tag.sigma_px);
  append_cell(text, tag.decision_margin);
  text += ',';
  append_exact(text, tag.hamming);
}

void append_point(std::string& text, const PointDetection& point) {
  text += ',';
  append_exact(text, point.point);
  append_cell(text, point.pixel_px.x);
  append_cell(text, point.pixel_px.y);
  append_cell(text, point.sigma_px);
}

/// Signed area; the edges cross only in invalid files.
double area_px2(const std::array<glm::dvec2, 4>& corners_px) {
  const glm::dvec2 a = corners_px[2] - corners_px[0];
  const glm::dvec2 b = corners_px[3] - corners_px[1];
  return 0.5 * (a.x * b.y - a.y * b.x);
}

TagDetection take_tag(CsvFields& fields) {
  TagDetection tag;
  tag.id = TagId{fields.number<int>()};
  for (glm::dvec2& corner_px : tag.corners_px) {
    corner_px.x = fields.number<double>();
    corner_px.y = fields.number<double>();
  }
  tag.sigma_px = fields.number<double>();
  tag.decision_margin = fields.number<double>();
  tag.hamming = fields.number<int>();
  return tag;
}

PointDetection take_point(CsvFields& fields) {
  PointDetection point;
  point.point = fields.number<int>();
  point.pixel_px.x = fields.number<double>();
  point.pixel_px.y = fields.number<double>();
  point.sigma_px = fields.number<double>();
  return point;
}

class DetectionsParser {
 public:
  DetectionsParser(std::string_view text, const std::string& file)
      : lines_(text), file_(file) {}

  Result<std::optional<CameraDetections>> parse(std::string_view key) {
    const std::string_view first = lines_.next().value_or("");
    if (!first.starts_with(kAnyVersion)) return fail("this is not a table of detections");
    if (first != std::string(kVersion).append(key))
      return std::optional<CameraDetections>();
    if (!take_header()) return fail("the lines above the table do not fit");
    while (const std::optional<std::string_view> line = lines_.next()) {
      if (line->starts_with(kEnd)) return finish(line->substr(kEnd.size()));
      if (const char* problem = take_row(*line)) return fail(problem);
    }
    return fail("the end of the table is missing");
  }

 private:
  bool take_header() {
    const std::string_view source = lines_.next().value_or("");
    const std::string_view camera = lines_.next().value_or("");
    if (!source.starts_with(kSource) || !camera.starts_with(kCamera)) return false;
    found_.source = source.substr(kSource.size());
    CsvFields fields(camera.substr(kCamera.size()));
    found_.camera = CameraId{fields.number<int>()};
    found_.width_px = fields.number<int>();
    found_.height_px = fields.number<int>();
    found_.rate.hz = fields.number<double>();
    const std::string_view offset = fields.text();
    if (!offset.empty()) {
      CsvFields alone(offset);
      found_.offset = Timestamp{alone.number<std::int64_t>()};
      if (!alone.good()) return false;
    }
    found_.dropped.unsure = fields.number<int>();
    found_.dropped.duplicated = fields.number<int>();
    found_.damaged_frames = fields.number<int>();
    return fields.good() && fields.ended() && lines_.next().value_or("") == kHeader;
  }

  /// Reads one row. Returns the error; null on success.
  const char* take_row(std::string_view line) {
    CsvFields fields(line);
    const int frame = fields.number<int>();
    if (!fields.good()) return "the row does not begin with a frame number";
    std::vector<FrameDetections>& frames = found_.frames;
    const bool is_new = frames.empty() || frames.back().frame != frame;
    if (is_new && !frames.empty() && frame != frames.back().frame + 1) {
      return "the frames are not in order";
    }
    if (is_new) frames.push_back({frame, {}});
    std::vector<TagDetection>& tags = frames.back().tags;
    std::vector<PointDetection>& points = frames.back().points;
    if (line.ends_with(kNoTag)) return is_new ? nullptr : "a frame is listed twice";
    if (!is_new && tags.empty() && points.empty()) return "a frame is listed twice";
    if (std::count(line.begin(), line.end(), ',') == kPointCommas) {
      return take_point_row(fields, points);
    }
    if (!points.empty()) return "a tag comes after points";
    const TagDetection tag = take_tag(fields);
    if (!fields.good() || !fields.ended()) return "the row is not 13 numbers";
    if (tag.sigma_px <= 0.0) return "a tag's sigma is not above zero";
    if (!(std::abs(area_px2(tag.corners_px)) >= kMinTag_px2)) {
      return "a tag's corners enclose no area";
    }
    if (!tags.empty() && tags.back().id >= tag.id) return "the tags are not in order";
    tags.push_back(tag);
    return nullptr;
  }

  static const char* take_point_row(CsvFields& fields,
                                    std::vector<PointDetection>& points) {
    const PointDetection point = take_point(fields);
    if (!fields.good() || !fields.ended()) return "the row is not 5 numbers";
    if (point.sigma_px <= 0.0) return "a point's sigma is not above zero";
    if (point.point < 0) return "a point's number is below zero";
    if (!points.empty() && points.back().point >= point.point) {
      return "the points are not in order";
    }
    points.push_back(point);
    return nullptr;
  }

  Result<std::optional<CameraDetections>> finish(std::string_view frame_count) {
    CsvFields fields(frame_count);
    const auto frames = fields.number<std::size_t>();
    if (!fields.good() || frames != found_.frames.size() || lines_.next()) {
      return fail("the table's end does not fit its rows");
    }
    return std::optional(std::move(found_));
  }

  [[nodiscard]] Error fail(const char* cause) const {
    std::string where = file_ + ":";
    append_exact(where, std::max(lines_.number(), 1));
    return bad_input(std::move(where), cause, "delete the file; it will be made again");
  }

  CsvLines lines_;
  const std::string& file_;
  CameraDetections found_;
};

}  // namespace

std::string detections_text(const CameraDetections& detections, std::string_view key) {
  MAREY_ASSERT(key.find_first_of("\r\n") == std::string_view::npos);
  MAREY_ASSERT(detections.source.find_first_of("\r\n") == std::string::npos);
  std::string text = std::string(kVersion).append(key).append("\n");
  append_header(text, detections);
  for (const FrameDetections& frame : detections.frames) {
    for (const TagDetection& tag : frame.tags) {
      append_exact(text, frame.frame);
      append_tag(text, tag);
      text += '\n';
    }
    for (const PointDetection& point : frame.points) {
      append_exact(text, frame.frame);
      append_point(text, point);
      text += '\n';
    }
    if (!frame.tags.empty() || !frame.points.empty()) continue;
    append_exact(text, frame.frame);
    text.append(kNoTag).append("\n");
  }
  text.append(kEnd).append(std::to_string(detections.frames.size())).append("\n");
  return text;
}

Status write_detections(const std::filesystem::path& path,
                        const CameraDetections& detections,
                        std::string_view key) {
  if (detections.source.find_first_of("\r\n") != std::string::npos) {
    std::string shown = detections.source;
    for (char& c : shown) c = c == '\r' || c == '\n' ? ' ' : c;
    return bad_input(std::move(shown),
                     "the recording's name holds a line break",
                     "rename it, and correct its path in the session");
  }
  return write_file(path, detections_text(detections, key));
}

Result<std::optional<CameraDetections>> parse_detections(std::string_view text,
                                                         std::string_view key,
                                                         const std::string& file) {
  return DetectionsParser(text, file).parse(key);
}

Result<std::optional<CameraDetections>> read_detections(const std::filesystem::path& path,
                                                        std::string_view key) {
  std::error_code problem;
  if (!std::filesystem::exists(path, problem) && !problem) {
    return std::optional<CameraDetections>();
  }
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_detections(*text, key, path.string());
}

}  // namespace marey::recordings

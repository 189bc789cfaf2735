// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/calibration_import.h"

#include <algorithm>
#include <string>

#include "core/base/in_quotes.h"
#include "recordings/base/opencv_xml.h"
#include "recordings/base/yaml_reader.h"
#include "recordings/session/camera_numbers.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

/// Returns the first line with content. Comments of YAML and TOML begin with the same
/// mark.
std::string_view first_line(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t start = line.find_first_not_of(kBlank);
    if (start != std::string_view::npos && line[start] != '#') return line.substr(start);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

}  // namespace

bool is_yaml_or_xml(std::string_view text) {
  const std::string_view line = first_line(text);
  if (line.starts_with('<') || line.starts_with('%') || line.starts_with("---")) {
    return true;
  }
  // "key: value", where TOML has [key] or key = value.
  const std::size_t mark = line.find_first_of(":=[");
  return mark != std::string_view::npos && line[mark] == ':';
}

Result<Calibration> import_calibration(std::string_view text,
                                       const std::filesystem::path& path,
                                       CameraParts parts) {
  const std::string file = path.string();
  Result<TomlDocument> document = first_line(text).starts_with('<')
                                      ? parse_opencv_xml(text, file)
                                      : parse_yaml(text, file);
  if (!document) return document.error();
  TomlReader root(*document);
  Calibration calibration;
  Status status = Done{};
  if (is_opencv(root)) {
    status = import_opencv(root, path, calibration);
  } else if (is_camchain(root)) {
    status = import_camchain(root, path, parts, calibration);
  } else {
    root.fail("",
              "no camera in it: neither OpenCV's camera_matrix, or M1 and M2, nor cam0, "
              "cam1... of Kalibr or TagSLAM",
              "name the file that the calibration wrote");
  }
  if (document->mistake) return *document->mistake;
  if (!status) return status.error();
  for (const Camera& camera : calibration.cameras) {
    if (glm::length(centre_in_world(camera)) <= kMaxCameraDistance_m) continue;
    return bad_input(
        file,
        in_quotes(camera.name) +
            " stands more than 100 m from the first camera or the origin",
        "give positions in metres: divide them by 1000 if they are millimetres");
  }
  calibration.quality.resize(calibration.cameras.size());
  calibration.clocks.resize(calibration.cameras.size());
  return calibration;
}

}  // namespace marey::recordings

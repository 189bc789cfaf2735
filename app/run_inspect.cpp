// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/inspect_body.h"
#include "app/inspect_markers.h"
#include "app/lens_words.h"
#include "app/read_body.h"
#include "core/extension.h"
#include "recordings/atomic_file.h"
#include "recordings/calibration_file.h"
#include "recordings/motion_tables.h"
#include "recordings/subject_file.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

Result<Json> inspect_session(const std::filesystem::path& file) {
  const auto session = recordings::read_session(file);
  if (!session) return session.error();
  Json trials = Json::array();
  for (const recordings::Trial& trial : session->trials) {
    trials.push_back({{"name", trial.name},
                      {"kind", recordings::name(trial.kind)},
                      {"videos", trial.videos.size()}});
  }
  const bool has_body = !session->tags.empty();
  return Json{{"kind", "session"},
              {"name", session->name},
              {"subject", has_body ? Json(session->subject.name) : Json()},
              {"stature_m", has_body ? Json(session->subject.stature_m) : Json()},
              {"cameras", session->cameras},
              {"tags", session->tags.size()},
              {"trials", trials}};
}

Result<Json> inspect_calibration(const std::filesystem::path& file) {
  const auto calibration = recordings::read_calibration(file);
  if (!calibration) return calibration.error();
  Json cameras = Json::array();
  for (std::size_t c = 0; c < calibration->cameras.size(); ++c) {
    const Camera& camera = calibration->cameras[c];
    const glm::dvec3 centre = centre_in_world(camera);
    cameras.push_back(
        {{"name", camera.name},
         {"size_px", {camera.intrinsics.width_px, camera.intrinsics.height_px}},
         {"focal_px", {camera.intrinsics.focal_px.x, camera.intrinsics.focal_px.y}},
         {"lens", lens_word(camera.intrinsics.lens)},
         {"centre_in_world_m", {centre.x, centre.y, centre.z}},
         {"rms_px", calibration->quality[c].rms_px}});
  }
  return Json{
      {"kind", "calibration"}, {"rms_px", calibration->rms_px}, {"cameras", cameras}};
}

Result<Json> inspect_subject(const std::filesystem::path& file) {
  const auto body = recordings::read_subject(file);
  if (!body) return body.error();
  return Json{{"kind", "subject"},
              {"name", body->name},
              {"stature_m", body->stature_m},
              {"leg_length_m", leg_length_m(body->proportions)},
              {"tags", body->tags.size()}};
}

Result<Json> inspect_joints(const std::filesystem::path& file) {
  const auto rows = recordings::read_joints_csv(file);
  if (!rows) return rows.error();
  std::set<std::string> joints;
  std::set<int> frames;
  for (const recordings::JointRow& row : *rows) {
    joints.insert(row.joint);
    frames.insert(row.frame);
  }
  return Json{{"kind", "joints"}, {"frames", frames.size()}, {"joints", joints}};
}

Result<Json> inspect_segments(const std::filesystem::path& file) {
  const auto rows = recordings::read_segments_csv(file);
  if (!rows) return rows.error();
  std::set<std::string> segments;
  std::set<int> frames;
  std::map<std::string, int> sources;
  for (const recordings::SegmentRow& row : *rows) {
    segments.insert(row.segment);
    frames.insert(row.frame);
    ++sources[std::string(name(row.source))];
  }
  return Json{{"kind", "segments"},
              {"frames", frames.size()},
              {"segments", segments},
              {"places_by_source", sources}};
}

Result<Json> inspect_report(const std::filesystem::path& file) {
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  const Json report = Json::parse(*text, nullptr, false);
  if (!report.is_object() || !report.contains("summary")) {
    return bad_input(file.string(),
                     "is not a report of marey's",
                     "give the report.json that marey process wrote");
  }
  return Json{{"kind", "report"},
              {"session", report.value("session", Json())},
              {"summary", report["summary"]},
              {"warnings", report.value("warnings", Json::array())}};
}

bool is_body(const std::filesystem::path& file) {
  const std::string kind = kind_by_extension(file);
  return is_gltf(file) || kind == ".bvh" || kind == ".amc";
}

Result<Json> inspect(const std::filesystem::path& file,
                     const InspectBodyOptions& options,
                     Console& console) {
  std::error_code ignored;
  const std::string kind = kind_by_extension(file);
  const std::string named = file.filename().string();
  if (!std::filesystem::exists(file, ignored)) {
    return bad_input(file.string(), "does not exist", "check its name");
  }
  if (std::filesystem::is_directory(file, ignored)) return inspect_session(file);
  const bool is_toml = kind == ".toml";
  if (named == "calibration.toml" || kind == ".yaml" || kind == ".yml" ||
      kind == ".xml" || (is_toml && recordings::is_calibration(file))) {
    return inspect_calibration(file);
  }
  if (named == "subject.toml") return inspect_subject(file);
  if (is_toml) return inspect_session(file);
  if (named == "joints.csv") return inspect_joints(file);
  if (named == "segments.csv") return inspect_segments(file);
  if (named == "report.json") return inspect_report(file);
  if (is_body(file)) return inspect_body(file, options, console);
  if (kind == ".c3d" || kind == ".trc") return inspect_markers(file);
  return bad_input(
      file.string(),
      "is not a kind of file that marey knows",
      "give a session, a calibration (.toml, .yaml, .yml, .xml), subject.toml, "
      "joints.csv, segments.csv, report.json, .c3d, .trc, .bvh, .amc, .glb, .gltf, .vrm "
      "or "
      ".vrma");
}

/// Files from elsewhere may hold names that are not UTF-8, which JSON must be.
std::string text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// "key: value" lines, nested with two spaces.
void print(const Json& value, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [key, item] : value.items()) {
    const bool flat =
        !item.is_structured() ||
        (item.is_array() && std::none_of(item.begin(), item.end(), [](const Json& i) {
           return i.is_object();
         }));
    if (flat) {
      std::printf("%s%s: %s\n", indent.c_str(), key.c_str(), text(item, -1).c_str());
    } else {
      std::printf("%s%s:\n", indent.c_str(), key.c_str());
      print(item, depth + 1);
    }
  }
}

}  // namespace

Exit run_inspect(const std::filesystem::path& file,
                 const InspectBodyOptions& options,
                 bool json,
                 Console& console) {
  if (options.asks() && !is_body(file)) {
    return console.fail(bad_input(file.string(),
                                  "is no body, which alone has a bone map and a picture",
                                  "give a .bvh, .amc, .glb, .gltf, .vrm or .vrma file"));
  }
  const auto found = inspect(file, options, console);
  if (!found) return console.fail(found.error());
  if (json) {
    std::printf("%s\n", text(*found, 2).c_str());
  } else {
    print(bones_as_lines(*found), 0);
  }
  return Exit::kOk;
}

}  // namespace marey::app

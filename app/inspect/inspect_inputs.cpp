// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_inputs.h"

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/inspect/inspect_engine.h"
#include "app/shell/lens_words.h"
#include "app/shell/program_name.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/character_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/markers/marker_map.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/mot.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/detections_file.h"
#include "recordings/session/plan_file.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using recordings::FileKind;

Result<Json> inspect_places(const fs::path& file, bool with_sigma) {
  const auto rows =
      with_sigma ? recordings::read_joints_csv(file) : recordings::read_places_csv(file);
  if (!rows) return rows.error();
  std::set<std::string> joints;
  std::set<int> frames;
  for (const recordings::JointRow& row : *rows) {
    joints.insert(row.joint);
    frames.insert(row.frame);
  }
  return Json{{"kind", with_sigma ? "joints" : "places"},
              {"frames", frames.size()},
              {"joints", joints}};
}

Result<Json> inspect_segments(const fs::path& file) {
  const auto rows = recordings::read_segments_csv(file);
  if (!rows) return rows.error();
  std::set<std::string> segments;
  std::set<int> frames;
  std::map<std::string, int> sources;
  for (const recordings::SegmentTableRow& row : *rows) {
    segments.insert(row.segment);
    frames.insert(row.frame);
    ++sources[std::string(name(row.source))];
  }
  return Json{{"kind", "segments"},
              {"frames", frames.size()},
              {"segments", segments},
              {"places_by_source", sources}};
}

Result<Json> inspect_plan(const fs::path& file) {
  const auto plan = recordings::read_plan(file);
  if (!plan) return plan.error();
  Json cameras = Json::array();
  for (const Camera& camera : plan->cameras) cameras.push_back(camera.name);
  return Json{{"kind", "plan"},
              {"cameras", cameras},
              {"tags", plan->tags.size()},
              {"stature_m", plan->stature_m ? Json(*plan->stature_m) : Json()}};
}

Result<Json> inspect_character(const fs::path& file) {
  const auto spec = recordings::read_character_spec(file);
  if (!spec) return spec.error();
  Json body;
  if (const auto* average = std::get_if<AverageBody>(&spec->body)) {
    body = {{"stature_m", average->stature_m}};
  } else if (const auto* avatar = std::get_if<AvatarBody>(&spec->body)) {
    body = {{"avatar", avatar->path}};
  } else if (const auto* subject = std::get_if<SubjectBody>(&spec->body)) {
    body = {{"subject", subject->path}};
  }
  const auto& mass = spec->traits.mass.total_kg;
  return Json{{"kind", "character file"},
              {"name", spec->name},
              {"body", body},
              {"mass_kg", mass ? Json(*mass) : Json()},
              {"limits", spec->traits.limits.size()},
              {"loads", spec->traits.loads.size()}};
}

Result<Json> inspect_floor(const fs::path& file) {
  const auto floor = recordings::read_floor(file);
  if (!floor) return floor.error();
  Json parts = Json::array();
  for (const FloorPart& part : floor->parts) {
    parts.push_back({{"name", part.name},
                     {"height_m", part.height_m},
                     {"moves", !part.path.empty()}});
  }
  return Json{{"kind", "floor"}, {"base_m", floor->base_height_m}, {"parts", parts}};
}

Result<Json> inspect_recipe(const fs::path& file) {
  const auto recipe = recordings::read_edit_recipe(file);
  if (!recipe) return recipe.error();
  Json sources = Json::array();
  for (const EditSource& source : recipe->sources) sources.push_back(source.path);
  Json ops = Json::array();
  for (const EditOp& op : recipe->ops) {
    ops.push_back(std::string(name(op.parameters)) + "@" + std::to_string(op.version));
  }
  return Json{{"kind", "edit recipe"},
              {"name", recipe->name},
              {"sources", sources},
              {"operations", ops}};
}

Result<Json> inspect_marker_map(const fs::path& file) {
  const auto map = recordings::read_marker_map(file);
  if (!map) return map.error();
  Json labels = Json::object();
  // Labels are unique; operator[] would compare each with all before it.
  Json::object_t::Container& list = *labels.get_ptr<Json::object_t*>();
  for (const MarkerMapEntry& entry : map->entries) {
    list.emplace_back(entry.label, entry.name);
  }
  return Json{{"kind", "marker map"}, {"markers", labels}};
}

Result<Json> inspect_constraints(const fs::path& file) {
  const auto read = recordings::read_constraints(file);
  if (!read) return read.error();
  Json constraints = Json::array();
  for (const Constraint& constraint : read->set.constraints) {
    constraints.push_back({{"name", constraint.id},
                           {"segment", constraint.point.segment},
                           {"importance", constraint.importance}});
  }
  return Json{
      {"kind", "constraints"}, {"constraints", constraints}, {"notes", read->notes}};
}

Result<Json> inspect_detections(const fs::path& file) {
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  // "# marey detections 4 KEY": KEY is the key of the cache.
  std::string_view key = std::string_view(*text).substr(0, text->find('\n'));
  for (int word = 0; word < 4; ++word) {
    key.remove_prefix(std::min(key.find(' '), key.size() - 1) + 1);
  }
  const auto found = recordings::parse_detections(*text, key, file.string());
  if (!found) return found.error();
  if (!*found) {
    return bad_input(file.string(),
                     "the table is of another version of marey",
                     "delete the file; marey creates it again");
  }
  const CameraDetections& camera = **found;
  std::set<int> tags;
  std::size_t sightings = 0;
  std::size_t points = 0;
  for (const FrameDetections& frame : camera.frames) {
    for (const TagDetection& tag : frame.tags) tags.insert(number(tag.id));
    sightings += frame.tags.size();
    points += frame.points.size();
  }
  return Json{{"kind", "detections"},
              {"source", camera.source},
              {"size_px", {camera.width_px, camera.height_px}},
              {"rate_hz", camera.rate.hz},
              {"frames", camera.frames.size()},
              {"tags", tags},
              {"tag_sightings", sightings},
              {"board_points", points},
              {"damaged_frames", camera.damaged_frames}};
}

/// Inspects OUT.repair.csv, which has a row for each filled or declined sample.
Result<Json> inspect_repair(const fs::path& file) {
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  std::map<std::string, int> methods;
  for (std::size_t at = text->find('\n');
       at != std::string::npos && at + 1 < text->size();
       at = text->find('\n', at + 1)) {
    const std::string_view line =
        std::string_view(*text).substr(at + 1, text->find('\n', at + 1) - at - 1);
    const std::size_t end = line.rfind(',');
    const std::size_t begin =
        end == std::string_view::npos || end == 0 ? end : line.rfind(',', end - 1);
    if (begin == std::string_view::npos) continue;
    ++methods[std::string(line.substr(begin + 1, end - begin - 1))];
  }
  return Json{{"kind", "repair table"}, {"samples_by_method", methods}};
}

}  // namespace

Result<Json> inspect_calibration(const fs::path& file) {
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

Result<Json> inspect_subject(const fs::path& file) {
  const auto body = recordings::read_subject(file);
  if (!body) return body.error();
  Json causes = Json::array();
  for (const Finding& warning : body->warnings) causes.push_back(warning.cause);
  return Json{{"kind", "subject"},
              {"name", body->name},
              {"stature_m", body->stature_m},
              {"leg_length_m", leg_length_m(body->proportions)},
              {"tags", body->tags.size()},
              {"doubts", causes}};
}

Result<Json> inspect_table(const fs::path& file) {
  const auto kind = recordings::file_kind(file);
  if (!kind) return kind.error();
  if (*kind == FileKind::kSegments) return inspect_segments(file);
  return inspect_places(file, *kind != FileKind::kPlaces);
}

Result<Json> inspect_angles(const fs::path& file) {
  const auto table = recordings::read_mot(file);
  if (!table) return table.error();
  Json columns = Json::array();
  std::size_t angles = 0;
  for (const recordings::MotColumn& column : table->columns) {
    columns.push_back(column.name);
    angles += column.is_angle ? 1 : 0;
  }
  const bool is_empty = table->time_s.empty();
  return Json{{"kind", "joint angles"},
              {"name", table->name},
              {"rows", table->rows()},
              {"start_s", is_empty ? Json() : Json(table->time_s.front())},
              {"end_s", is_empty ? Json() : Json(table->time_s.back())},
              {"angles", angles},
              {"columns", columns},
              {"notes", table->notes}};
}

Result<Json> inspect_acclaim(const fs::path& file) {
  const auto asf = recordings::read_asf(file);
  if (!asf) return asf.error();
  Json joints = Json::array();
  for (const Joint& joint : asf->skeleton.joints) joints.push_back(joint.name);
  return Json{{"kind", "acclaim skeleton"},
              {"unit_m", asf->unit_m},
              {"angles", asf->in_degrees ? "degrees" : "radians"},
              {"joints", joints}};
}

Result<Json> inspect_kind(const fs::path& file, FileKind kind) {
  switch (kind) {
    case FileKind::kCalibration:
    case FileKind::kLenses:
      return inspect_calibration(file);
    case FileKind::kSubject:
      return inspect_subject(file);
    case FileKind::kPlan:
      return inspect_plan(file);
    case FileKind::kCharacter:
      return inspect_character(file);
    case FileKind::kFloor:
      return inspect_floor(file);
    case FileKind::kMarkerMap:
      return inspect_marker_map(file);
    case FileKind::kEditRecipe:
      return inspect_recipe(file);
    case FileKind::kScene:
      return inspect_scene(file);
    case FileKind::kTrials:
      return inspect_trials(file);
    case FileKind::kConstraints:
      return inspect_constraints(file);
    case FileKind::kJoints:
    case FileKind::kSegments:
    case FileKind::kPlaces:
      return inspect_table(file);
    case FileKind::kDetections:
      return inspect_detections(file);
    case FileKind::kRepair:
      return inspect_repair(file);
    default:
      break;
  }
  return bad_input(file.string(),
                   kind == FileKind::kBoneMap
                       ? "a bone map can only be read with its body"
                       : "is not a kind of file that marey supports",
                   kind == FileKind::kBoneMap
                       ? "inspect the body with it: marey inspect BODY --bones " +
                             shell_command({file.string()})
                       : "give a file that marey reads or writes; "
                         "docs/formats/README.md lists them");
}

}  // namespace marey::app

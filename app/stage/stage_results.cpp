// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/stage_results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "app/stage/figures/throw_figures.h"
#include "app/stage/run/action_wishes.h"
#include "app/stage/run/trial_log.h"
#include "core/base/format_text.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/atomic_folder.h"
#include "recordings/gltf/gltf.h"
#include "retarget/feet/floor_at.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using StageJson = nlohmann::ordered_json;

// Infinite times have no number in JSON.
StageJson finite_or_null(double value) {
  return std::isfinite(value) ? StageJson(value) : StageJson(nullptr);
}

std::string joined_ids(const std::vector<std::string>& ids) {
  std::string out;
  for (const std::string& id : ids) out += (out.empty() ? "" : ", ") + id;
  return out;
}

StageJson value_json(const BodyFigure& value) {
  StageJson out{{"body", value.body},
                {"value", value.value},
                {"time_s", value.time_s},
                {"count", value.count}};
  if (value.beyond > 0) out["steps_out_of_reach"] = value.beyond;
  return out;
}

StageJson figure_json(const MeasuredFigure& measured) {
  const SceneFigure& figure = measured.figure;
  const SceneFigureRule& rule = rule_of(figure.kind);
  StageJson bodies = StageJson::array();
  for (const BodyFigure& body : measured.bodies) bodies.push_back(value_json(body));
  StageJson out{{"kind", rule.word}, {"unit", rule.unit}, {"bodies", figure.bodies}};
  if (!figure.action.empty()) out["action"] = figure.action;
  if (!figure.target.empty()) out["target"] = figure.target;
  if (figure.min) out["min"] = *figure.min;
  if (figure.max) out["max"] = *figure.max;
  if (figure.ascending) out["ascending"] = measured.ascends;
  out["worst"] = measured.worst ? value_json(*measured.worst) : StageJson(nullptr);
  out["passed"] = measured.passed;
  out["values"] = std::move(bodies);
  if (!measured.unmeasured.empty()) out["unmeasured"] = measured.unmeasured;
  return out;
}

StageJson action_json(const StageRecord& record, const StageActionRun& run) {
  const SceneAction& action = record.scene.script[run.action];
  StageJson events = StageJson::array();
  for (const StageEvent& event : run.events) {
    events.push_back({{"name", event.name}, {"time_s", event.time_s}});
  }
  return {{"id", action.id},
          {"do", kSceneDeeds[action.deed.index()]},
          {"body", record.bodies[run.body].id},
          {"start_s", run.start_s},
          {"end_s", finite_or_null(run.end_s)},
          {"events", std::move(events)}};
}

StageJson throw_json(const StageRecord& record, const StageThrow& thrown) {
  StageJson out{{"action", record.scene.script[thrown.action].id},
                {"body", record.bodies[thrown.body].id}};
  if (thrown.trial) out["trial"] = *thrown.trial;
  out["start_s"] = thrown.start_s;
  out["release_s"] = thrown.release_s;
  constexpr std::array kNames{"place_left_m",
                              "place_up_m",
                              "place_forward_m",
                              "azimuth_rad",
                              "elevation_rad",
                              "speed_m_s",
                              "release_after_s"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    out["asked"][kNames[i]] = thrown.asked[i];
    out["measured"][kNames[i]] = thrown.measured[i];
  }
  return out;
}

StageJson point_json(const glm::dvec3& p) {
  return StageJson::array({p.x, p.y, p.z});
}

// A picture's camera, and the corners of the floor's parts at its time.
StageJson picture_json(const StageRecord& record, const ScenePicture& picture) {
  StageJson floor = StageJson::array();
  for (std::size_t i = 0; i < record.floor.parts.size(); ++i) {
    const FloorPart& part = record.floor.parts[i];
    const glm::dvec3 moved_m = retarget::moved_at(part, picture.time_s);
    StageJson corners = StageJson::array();
    for (const std::array<bool, 2> far : {std::array{false, false},
                                          std::array{true, false},
                                          std::array{true, true},
                                          std::array{false, true}}) {
      const glm::dvec2 xz((far[0] ? part.max_xz_m : part.min_xz_m).x + moved_m.x,
                          (far[1] ? part.max_xz_m : part.min_xz_m).y + moved_m.z);
      const double y = retarget::plane_at(record.floor, i, xz, picture.time_s).height_m;
      corners.push_back(point_json({xz.x, y, xz.y}));
    }
    floor.push_back(std::move(corners));
  }
  return {{"time_s", picture.time_s},
          {"camera_m", point_json(picture.camera_in_world)},
          {"looks_at_m", point_json(picture.looks_at_in_world)},
          {"width_px", picture.width_px},
          {"height_px", picture.height_px},
          {"floor_m", std::move(floor)}};
}

std::string bounds_of(const SceneFigure& figure) {
  std::string out;
  if (figure.min) out += format_text(", at least %.4g", *figure.min);
  if (figure.max) out += format_text(", at most %.4g", *figure.max);
  if (figure.ascending) out += ", ascending";
  return out;
}

std::string title_of(const SceneFigure& figure) {
  std::string out(rule_of(figure.kind).word);
  if (!figure.action.empty()) out += " \"" + figure.action + "\"";
  if (!figure.bodies.empty()) out += " of " + joined_ids(figure.bodies);
  return out;
}

std::string value_of(const MeasuredFigure& measured) {
  if (!measured.worst) return "not measured";
  const std::string unit(rule_of(measured.figure.kind).unit);
  return format_text("%.4g", measured.worst->value) + (unit.empty() ? "" : " " + unit) +
         format_text(" at %.2f s", measured.worst->time_s) +
         (measured.worst->body.empty() ? "" : " (" + measured.worst->body + ")");
}

// The postures of a body at the rate of the file.
std::vector<Pose> frames_of(const StageRecord& record, std::size_t body) {
  const double rate_hz = std::min(record.scene.out.glb_rate_hz, record.scene.step_hz);
  const std::vector<Pose>& poses = record.tracks[body].poses;
  std::vector<Pose> out;
  for (std::size_t frame = 0;; ++frame) {
    const auto step = static_cast<std::size_t>(
        std::llround(static_cast<double>(frame) * record.scene.step_hz / rate_hz));
    if (step >= poses.size()) return out;
    out.push_back(poses[step]);
  }
}

Status write_glb(const StageResult& result, const fs::path& path) {
  const StageRecord& record = result.record;
  std::vector<std::vector<Pose>> poses;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    poses.push_back(frames_of(record, i));
  }
  std::vector<recordings::BodyClip> bodies;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const auto& mesh = result.cast.meshes[i];
    bodies.push_back({record.bodies[i].id,
                      &record.bodies[i].character.skeleton,
                      mesh ? &*mesh : nullptr,
                      poses[i]});
  }
  const double rate_hz = std::min(record.scene.out.glb_rate_hz, record.scene.step_hz);
  return recordings::write_characters(path, bodies, {rate_hz}, record.scene.name);
}

}  // namespace

Status check_stage_folder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return Done{};
  if (fs::is_directory(folder, ignored) &&
      (fs::is_empty(folder, ignored) || fs::exists(folder / "stage.json", ignored))) {
    return Done{};
  }
  return bad_input(folder.string(),
                   "it exists and is not the result of a scene",
                   "choose another folder, or remove it");
}

nlohmann::ordered_json stage_json(const StageResult& result) {
  const StageRecord& record = result.record;
  StageJson out{{"format", 1},
                {"scene", record.scene.name},
                {"seed", record.scene.seed},
                {"step_hz", record.scene.step_hz},
                {"steps", record.step_count()},
                {"mean_step_ms", record.mean_step_ms}};
  out["bodies"] = StageJson::array();
  for (const StageBody& body : record.bodies) {
    out["bodies"].push_back({{"id", body.id}, {"stature_m", body.stature_m}});
  }
  out["figures"] = StageJson::array();
  for (const MeasuredFigure& figure : result.figures) {
    out["figures"].push_back(figure_json(figure));
  }
  out["actions"] = StageJson::array();
  for (const StageActionRun& run : record.actions) {
    out["actions"].push_back(action_json(record, run));
  }
  out["throws"] = StageJson::array();
  for (const StageThrow& thrown : record.throws) {
    out["throws"].push_back(throw_json(record, thrown));
  }
  out["pictures"] = StageJson::array();
  for (const ScenePicture& picture : record.scene.out.pictures) {
    out["pictures"].push_back(picture_json(record, picture));
  }
  out["problems"] = StageJson::array();
  for (const Error& problem : result.problems) {
    out["problems"].push_back(
        {{"where", problem.where}, {"cause", problem.cause}, {"next", problem.next}});
  }
  return out;
}

std::vector<std::string> stage_lines(const StageResult& result) {
  std::vector<std::string> out;
  for (const MeasuredFigure& measured : result.figures) {
    out.push_back((measured.passed ? "met:     " : "not met: ") +
                  title_of(measured.figure) + ": " + value_of(measured) +
                  bounds_of(measured.figure));
  }
  return out;
}

std::vector<Finding> assess_stage(const StageResult& result) {
  std::vector<Finding> out;
  for (const Error& problem : result.problems) {
    out.push_back(tolerated(Severity::kPoor, "action", problem));
  }
  for (const MeasuredFigure& measured : result.figures) {
    if (measured.passed) continue;
    std::string where = "scene \"" + result.record.scene.name + "\"";
    if (measured.figure.line > 0) {
      where += ", line " + std::to_string(measured.figure.line);
    }
    Finding finding;
    finding.severity = Severity::kPoor;
    finding.id = std::string(rule_of(measured.figure.kind).word);
    finding.where = std::move(where);
    finding.cause = title_of(measured.figure) + " is " + value_of(measured) +
                    bounds_of(measured.figure);
    finding.next = "look at that time in the .glb, or change the bound";
    if (measured.worst) {
      finding.measured(measured.worst->value,
                       measured.figure.max ? measured.figure.max : measured.figure.min,
                       std::string(rule_of(measured.figure.kind).unit));
    }
    out.push_back(std::move(finding));
  }
  return out;
}

Result<std::vector<fs::path>> write_stage(const StageResult& result,
                                          const fs::path& folder) {
  if (const Status ok = check_stage_folder(folder); !ok) return ok.error();
  auto partial = recordings::AtomicFolder::create(folder);
  if (!partial) return partial.error();
  std::vector<fs::path> files;
  if (result.record.scene.out.glb) {
    const std::string name = result.record.scene.name + ".glb";
    const Status ok = write_glb(result, partial->partial() / name);
    if (!ok) return ok.error();
    files.push_back(folder / name);
  }
  if (const auto rows = trial_rows(result.record); !rows.empty()) {
    std::string table = trial_header() + "\n";
    for (const TrialRow& row : rows) table += trial_line(row) + "\n";
    const Status ok = recordings::write_file(partial->partial() / "trials.csv", table);
    if (!ok) return ok.error();
    files.push_back(folder / "trials.csv");
  }
  const Status ok = recordings::write_file(partial->partial() / "stage.json",
                                           stage_json(result).dump(2) + "\n");
  if (!ok) return ok.error();
  files.push_back(folder / "stage.json");
  if (const Status done = partial->commit(); !done) return done.error();
  return files;
}

}  // namespace marey::app

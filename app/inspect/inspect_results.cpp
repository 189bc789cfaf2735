// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_results.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/inspect/inspect_inputs.h"
#include "app/shell/json_file.h"
#include "app/view/view_trial.h"
#include "recordings/session/session.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/take_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored)) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

/// Returns the values with lists replaced by their lengths, because reports have a number
/// for every frame.
Json outline(const Json& value, int depth) {
  if (value.is_array()) return value.size();
  if (!value.is_object()) return value;
  Json out = Json::object();
  for (const auto& [key, item] : value.items()) {
    if (depth > 0 || !item.is_object()) out[key] = outline(item, depth - 1);
  }
  return out;
}

/// Returns the kind of a .json report, from keys that are unique to each kind.
std::string kind_of_report(const Json& json) {
  constexpr std::array<std::pair<const char*, const char*>, 5> kKeys{
      {{"summary", "report"},
       {"label_set", "fit"},
       {"samples_left_empty", "repair"},
       {"volume", "plan"},
       {"cameras", "calibration report"}}};
  for (const auto& [key, kind] : kKeys) {
    if (json.is_object() && json.contains(key)) return kind;
  }
  return {};
}

Json report_summary(const Json& report) {
  return Json{{"kind", "report"},
              {"session", report.value("session", Json())},
              {"summary", report["summary"]},
              {"warnings", report.value("warnings", Json::array())}};
}

Result<Json> inspect_trial(const fs::path& folder) {
  auto segments = inspect_table(folder / "segments.csv");
  if (!segments) return segments.error();
  return Json{{"kind", "trial"},
              {"name", fs::weakly_canonical(folder).filename().string()},
              {"frames", (*segments)["frames"]},
              {"places_by_source", (*segments)["places_by_source"]},
              {"files", files_in(folder)}};
}

Result<Json> inspect_results(const fs::path& folder) {
  Json out{{"kind", "results"}};
  for (const char* name : {"report.json", "fit.json", "plan.json", "calibration.json"}) {
    if (!is_there(folder / name)) continue;
    auto found = inspect_report(folder / name);
    if (!found) return found.error();
    out[fs::path(name).stem().string()] = *std::move(found);
  }
  out["files"] = files_in(folder);
  Json trials = Json::array();
  for (const std::string& name : solved_trials(folder)) {
    auto trial = inspect_trial(folder / name);
    if (!trial) return trial.error();
    trial->erase("kind");
    trials.push_back(*std::move(trial));
  }
  out["trials"] = std::move(trials);
  return out;
}

/// Returns the folders of the takes in a folder written by marey record.
std::vector<fs::path> takes_in(const fs::path& folder) {
  std::vector<fs::path> takes;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path take = entry.path() / recordings::kTakeFile;
    if (is_there(take)) takes.push_back(take);
  }
  std::ranges::sort(takes);
  return takes;
}

double length_s(const recordings::TakeCamera& camera) {
  if (camera.frames.empty()) return 0.0;
  return seconds(camera.frames.back().time - camera.frames.front().time);
}

}  // namespace

Result<Json> inspect_session(const fs::path& file) {
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

Result<Json> inspect_take(const fs::path& file) {
  const auto take = recordings::read_take(file);
  if (!take) return take.error();
  Json cameras = Json::array();
  for (const recordings::TakeCamera& camera : take->cameras) {
    int dropped = 0;
    int damaged = 0;
    for (const recordings::TakeFrame& frame : camera.frames) {
      dropped += frame.dropped_before > 0 ? 1 : 0;
      damaged += frame.damaged ? 1 : 0;
    }
    cameras.push_back({{"name", camera.name},
                       {"file", camera.file},
                       {"size_px", {camera.width_px, camera.height_px}},
                       {"rate_hz", camera.rate.hz},
                       {"frames", camera.frames.size()},
                       {"duration_s", length_s(camera)},
                       {"places_with_lost_frames", dropped},
                       {"damaged_frames", damaged},
                       {"device", camera.device}});
  }
  Json events = Json::array();
  for (const recordings::TakeEvent& event : take->events) {
    events.push_back(
        {{"camera", take->cameras[static_cast<std::size_t>(event.camera)].name},
         {"time_s", seconds(event.time)},
         {"text", event.text}});
  }
  return Json{{"kind", "take"},
              {"trial", take->trial},
              {"started", take->started},
              {"finished", take->finished},
              {"cameras", cameras},
              {"events", events}};
}

Result<Json> inspect_live_take(const fs::path& file) {
  const auto take = recordings::read_live_take(file);
  if (!take) return take.error();
  const auto& instants = take->instants;
  std::size_t views = 0;
  std::size_t tags = 0;
  for (const recordings::LiveTakeInstant& instant : instants) {
    views += instant.seen.views.size();
    for (const CameraTags& view : instant.seen.views) tags += view.tags.size();
  }
  const double duration_s =
      instants.empty() ? 0.0
                       : seconds(instants.back().seen.time - instants.front().seen.time);
  return Json{{"kind", "live take"},
              {"session", take->head.session},
              {"started", take->head.started},
              {"finished", take->finished},
              {"rate_hz", take->head.rate.hz},
              {"cameras", take->head.cameras},
              {"instants", instants.size()},
              {"duration_s", duration_s},
              {"views", views},
              {"tag_sightings", tags}};
}

Result<Json> inspect_report(const fs::path& file) {
  const auto json = read_json(file);
  if (!json) return json.error();
  const std::string kind = kind_of_report(*json);
  if (kind == "report") return report_summary(*json);
  if (!kind.empty()) {
    Json out{{"kind", kind}};
    out.update(outline(*json, 1));
    return out;
  }
  return bad_input(file.string(),
                   "is not a report of marey's",
                   "give a report.json, fit.json, plan.json, calibration.json or "
                   ".repair.json that marey wrote");
}

Result<Json> inspect_folder(const fs::path& folder) {
  if (is_there(folder / recordings::kLiveTakeFile)) {
    return inspect_live_take(folder / recordings::kLiveTakeFile);
  }
  if (is_there(folder / recordings::kTakeFile)) {
    return inspect_take(folder / recordings::kTakeFile);
  }
  if (is_there(folder / "segments.csv")) return inspect_trial(folder);
  if (is_there(folder / "session.toml")) {
    auto out = inspect_session(folder);
    if (!out) return out;
    Json takes = Json::array();
    for (const fs::path& file : takes_in(folder)) {
      auto take = inspect_take(file);
      if (!take) return take.error();
      takes.push_back(*std::move(take));
    }
    if (!takes.empty()) (*out)["takes"] = std::move(takes);
    return out;
  }
  const std::vector<std::string> files = files_in(folder);
  const bool has_results =
      std::ranges::any_of(files,
                          [](const std::string& name) {
                            return name == "report.json" || name == "fit.json" ||
                                   name == "plan.json" || name == "calibration.toml" ||
                                   name == "calibration.json" || name == "subject.toml";
                          }) ||
      !solved_trials(folder).empty();
  if (has_results) return inspect_results(folder);
  return bad_input(folder.string(),
                   "holds no session.toml, no results and no take",
                   "give a session, a take, or the --out folder of process, fit or plan");
}

}  // namespace marey::app

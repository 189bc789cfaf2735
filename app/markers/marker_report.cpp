// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/markers/complete_markers.h"
#include "app/markers/marker_curves.h"
#include "app/markers/marker_history.h"
#include "app/markers/marker_stills.h"
#include "app/pages/fill_page.h"
#include "app/pages/report_json.h"
#include "app/pages/report_page.h"
#include "app/shell/version.h"
#include "reconstruct/labels/name_markers.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

// Number of pixel columns of a wide screen.
constexpr std::size_t kMaxColumns = 2000;
// Maximum number of pictures of repairs, for one trial and for all trials.
constexpr std::size_t kMaxCurves = 8;
constexpr std::size_t kMaxCurvesOfAll = 64;

/// Returns the distances from the body over time, reduced to the resolution of the page:
/// root mean square and maximum of each group of frames; null if nothing was measured.
Json residual_curve(const std::vector<double>& frame_rms_m) {
  const std::size_t frames = frame_rms_m.size();
  const std::size_t step =
      std::max<std::size_t>(1, (frames + kMaxColumns - 1) / kMaxColumns);
  Json rms = Json::array();
  Json worst = Json::array();
  for (std::size_t from = 0; from < frames; from += step) {
    double squares = 0.0;
    double max_m = 0.0;
    std::size_t count = 0;
    for (std::size_t f = from; f < std::min(frames, from + step); ++f) {
      if (frame_rms_m[f] <= 0.0) continue;
      squares += frame_rms_m[f] * frame_rms_m[f];
      max_m = std::max(max_m, frame_rms_m[f]);
      ++count;
    }
    const double mean = count > 0 ? squares / static_cast<double>(count) : 0.0;
    rms.push_back(count > 0 ? Json(rounded(1e3 * std::sqrt(mean), 2)) : Json());
    worst.push_back(count > 0 ? Json(rounded(1e3 * max_m, 2)) : Json());
  }
  return {{"step", step}, {"rms_mm", rms}, {"worst_mm", worst}};
}

Json page_trial(const Repair& repair, const MarkerHistory& history, std::size_t curves) {
  const MarkerTracks& tracks = history.after;
  return {{"first_frame", tracks.first_frame},
          {"markers", timeline_json(repair, history)},
          {"curves", repair_curves(repair, history, curves)},
          {"residuals", Json()},
          {"stills", Json::array()}};
}

Json page_trial(const Body& body, const MarkerTrial& trial, std::size_t curves) {
  const MarkerTracks& repaired = trial.repair.repaired.tracks;
  const MarkerHistory history = history_of(
      trial.repair,
      trial.solved ? complete_markers(body, *trial.solved, repaired).tracks : repaired);
  Json out = page_trial(trial.repair, history, curves);
  out["notes"] = trial.file.notes;
  if (!trial.solved) return out;
  out["residuals"] = residual_curve(trial.solved->frame_rms_m);
  out["stills"] = marker_stills(body, *trial.solved, history);
  return out;
}

/// Removes lists that the page has in another form.
void drop_lists(Json& trial) {
  trial.erase("gaps");
  trial.erase("faults");
}

Json lengths(const Body& body) {
  Json out = Json::array();
  for (const HumanBone bone : human_bones()) {
    const auto from = parent(bone);
    if (!from) continue;
    out.push_back(
        {{"joint", name(bone)},
         {"from", name(*from)},
         {"length_mm", rounded(1e3 * glm::length(body.proportions[bone]), 1)},
         {"sigma_mm", rounded(1e3 * body.joint_centre_sigma_m[index(bone)], 2)}});
  }
  return out;
}

Json fates() {
  Json out = Json::array();
  for (std::size_t i = 0; i < kSampleFateCount; ++i) {
    out.push_back(name(static_cast<SampleFate>(i)));
  }
  return out;
}

std::string filled(const Json& data) {
  return fill_page(markers_page(),
                   {{"style", std::string(report_style()) + std::string(markers_style())},
                    {"data", json_in_html(data)},
                    {"script", std::string(markers_script())}});
}

/// Returns the meaning of the labels of a file that was only repaired.
Json label_json(const MarkerTracks& tracks, const reconstruct::MarkerNames& names) {
  Json out = Json::array();
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    std::size_t samples = 0;
    for (std::size_t f = 0; f < tracks.frames(); ++f) samples += tracks.at(f, m) ? 1 : 0;
    const auto* landmark = names.landmarks[m];
    out.push_back({{"label", tracks.labels[m]},
                   {"landmark", landmark != nullptr ? Json(landmark->name) : Json()},
                   {"samples", samples}});
  }
  return out;
}

}  // namespace

std::string fit_page(const FitRun& run) {
  Json figures = fit_json(run);
  // Durations differ between runs.
  figures.erase("seconds");
  for (Json& trial : figures["trials"]) drop_lists(trial);
  const std::size_t curves = std::clamp<std::size_t>(
      kMaxCurvesOfAll / std::max<std::size_t>(1, run.trials.size()), 1, kMaxCurves);
  Json trials = Json::array();
  for (const MarkerTrial& trial : run.trials) {
    trials.push_back(page_trial(run.body, trial, curves));
  }
  return filled({{"kind", "fit"},
                 {"marey_version", kVersion},
                 {"figures", figures},
                 {"fates", fates()},
                 {"lengths", lengths(run.body)},
                 {"bones", still_bones(make_humanoid(run.body.proportions))},
                 {"trials", trials}});
}

std::string repair_page(const Repair& repair, std::span<const std::string> notes) {
  const auto names = reconstruct::name_markers(repair.as_read.labels);
  Json trial = repair_json(repair);
  drop_lists(trial);
  const MarkerHistory history = history_of(repair, repair.repaired.tracks);
  Json page = page_trial(repair, history, kMaxCurves);
  page["notes"] = notes;
  const Json figures{{"label_set", names.set},
                     {"prefix", names.prefix},
                     {"labels", label_json(repair.as_read, names)},
                     {"trials", Json::array({trial})},
                     {"warnings", names.notes}};
  return filled({{"kind", "repair"},
                 {"marey_version", kVersion},
                 {"figures", figures},
                 {"fates", fates()},
                 {"lengths", Json::array()},
                 {"bones", Json::array()},
                 {"trials", Json::array({page})}});
}

}  // namespace marey::app

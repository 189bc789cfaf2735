// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_files.h"

#include <algorithm>
#include <utility>

#include "app/motion/raw_body.h"
#include "app/shell/program_name.h"
#include "app/view/view_cameras.h"
#include "app/view/view_figure.h"
#include "app/view/view_live_take.h"
#include "app/view/view_trial.h"
#include "core/base/extension.h"
#include "core/base/input_file.h"
#include "core/resample.h"
#include "recordings/markers/marker_file.h"
#include "recordings/session/calibration_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

Result<ViewedRecording> motion_view(const fs::path& file) {
  ViewedRecording out;
  auto figure = figure_of_file(file, out.remarks);
  if (!figure) return figure.error();
  out.title = file.filename().string();
  out.rate = figure->motion.rate;
  out.first_frame = figure->motion.first_frame;
  out.frames = static_cast<int>(figure->motion.poses.size());
  if (out.frames > 1) out.contacts = contact_spans(figure->motion, out.first_frame);
  out.figures.push_back(*std::move(figure));
  return out;
}

/// Returns the spans of frames in which a marker was not measured.
live::PageTrack track_of(const MarkerTracks& tracks, std::size_t marker) {
  live::PageTrack track{tracks.labels[marker], {}};
  for (std::size_t i = 0; i < tracks.frames(); ++i) {
    const auto& sample = tracks.at(i, marker);
    const Source source = sample ? sample->source : Source::kInferred;
    add_gap(track, tracks.first_frame + static_cast<int>(i), source);
  }
  return track;
}

Result<ViewedRecording> marker_view(const fs::path& file) {
  auto markers = recordings::read_markers(file);
  if (!markers) return markers.error();
  ViewedRecording out;
  const MarkerTracks& tracks = markers->tracks;
  out.title = file.filename().string();
  out.rate = tracks.rate;
  out.first_frame = tracks.first_frame;
  out.frames = std::max(1, static_cast<int>(tracks.frames()));
  for (std::size_t i = 0; i < tracks.markers(); ++i) {
    out.tracks.push_back(track_of(tracks, i));
  }
  for (const recordings::MarkerEvent& event : markers->events) {
    const double frame = (event.time_s - tracks.start_s) * tracks.rate.hz;
    if (!(frame >= 0.0 && frame < out.frames)) continue;
    const std::string words = event.context.empty() ? "" : event.context + " ";
    out.notes.push_back(
        {out.first_frame + static_cast<int>(frame + 0.5), words + event.label});
  }
  out.remarks = std::move(markers->notes);
  out.points = std::move(markers->tracks);
  return out;
}

Result<ViewedRecording> camera_view(const fs::path& file) {
  auto cameras = page_cameras(file);
  if (!cameras) return cameras.error();
  ViewedRecording out;
  out.title = file.filename().string();
  out.cameras = *std::move(cameras);
  return out;
}

Result<ViewedRecording> folder_view(const fs::path& folder, const std::string& wanted) {
  std::error_code ignored;
  if (fs::exists(folder / "segments.csv", ignored)) return read_trial_view(folder);
  const std::vector<std::string> trials = solved_trials(folder);
  if (trials.empty()) {
    const fs::path cameras = folder / "calibration.toml";
    if (fs::exists(cameras, ignored) && wanted.empty()) return camera_view(cameras);
    return bad_input(folder.string(),
                     "holds no results: no trial in it has a segments.csv",
                     "give the --out folder of process, fit or plan; marey demo makes "
                     "results to look at");
  }
  std::string others;
  for (const std::string& name : trials) others += " " + name;
  const std::string trial = wanted.empty() ? trials.front() : wanted;
  if (std::ranges::find(trials, trial) == trials.end()) {
    return bad_input(
        folder.string(), "has no trial \"" + trial + "\"", "choose one of:" + others);
  }
  auto out = read_trial_view(folder / trial);
  if (out && wanted.empty() && trials.size() > 1) {
    out->remarks.push_back("shows the trial " + trial + " of:" + others +
                           "; the page and --trial show others");
  }
  return out;
}

Result<ViewedRecording> any_view(const fs::path& what, const std::string& trial) {
  std::error_code ignored;
  if (!fs::exists(what, ignored)) return check_input_file(what).error();
  if (is_live_take(what)) return read_live_take_view(what);
  if (fs::is_directory(what, ignored)) return folder_view(what, trial);
  const std::string kind = kind_by_extension(what);
  if (is_body_file(what)) return motion_view(what);
  if (kind == ".c3d" || kind == ".trc") return marker_view(what);
  if (kind == ".toml" && recordings::is_calibration(what)) return camera_view(what);
  return bad_input(
      what.string(),
      "is not a kind of file that can be shown",
      "give a motion (" + body_extensions() +
          "), markers (.c3d or .trc), a calibration.toml, a folder of results or a take "
          "of marey live");
}

/// Resamples the motion to the recording's rate, from its first frame on.
void take_rate(FrameRate rate, Motion& motion) {
  if (motion.rate.hz != rate.hz) motion = resample(motion, rate);
}

}  // namespace

Result<ViewedRecording> read_view(const ViewChoice& choice) {
  auto out = any_view(choice.what, choice.trial);
  if (!out) return out;
  for (ViewedFigure& figure : out->figures) take_rate(out->rate, figure.motion);
  for (ViewedFigure& figure : out->figures) figure.balance = balance_of(figure.motion);
  for (const fs::path& avatar : choice.avatars) {
    if (out->figures.empty()) {
      return bad_input(choice.what.string(),
                       "holds no motion to put on an avatar",
                       "leave --avatar out, or give a motion");
    }
    auto figure = figure_on_avatar(out->figures.front().motion, avatar, out->remarks);
    if (!figure) return figure.error();
    figure->balance = balance_of(figure->motion);
    out->figures.push_back(*std::move(figure));
  }
  return out;
}

}  // namespace marey::app

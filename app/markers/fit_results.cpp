// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_results.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "app/markers/complete_markers.h"
#include "app/motion/angle_table.h"
#include "app/motion/retarget_files.h"
#include "app/motion/write_motion.h"
#include "core/base/assert.h"
#include "core/base/extension.h"
#include "recordings/motion/mot.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::FileAxes;

recordings::MotTable mot_table(const MarkerTrial& trial) {
  const MarkerTracks& tracks = trial.repair.repaired.tracks;
  auto table = angle_table(trial.solved->estimate.motion, trial.name);
  MAREY_ASSERT(table.has_value());
  // Times are on the recording's clock, like its forces.
  table->time_s.clear();
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    table->time_s.push_back(tracks.time_s(f));
  }
  return *std::move(table);
}

Status write_marker_files(const fs::path& folder,
                          MarkerTracks tracks,
                          MarkerTrial& trial) {
  trial.file.tracks = std::move(tracks);
  trial.file.tracks.labels = trial.repair.as_read.labels;
  // Other content of a C3D is copied in the file's axes. If the user gave other axes, it
  // is not copied, because the copy would keep the wrong ones.
  const FileAxes& axes = trial.file.axes;
  const bool is_given = axes.up_from == recordings::Evidence::kUser ||
                        axes.unit_from == recordings::Evidence::kUser;
  recordings::MarkerWriteOptions c3d;
  if (!is_given && kind_by_extension(trial.path) == ".c3d") c3d.source = trial.path;
  Status ok = recordings::write_markers(folder / "markers.c3d", trial.file, c3d);
  if (ok) {
    // A TRC does not store the up axis; readers assume Y up.
    recordings::MarkerWriteOptions trc;
    trc.axes = axes;
    trc.axes->up = recordings::FileAxis::kPlusY;
    ok = recordings::write_markers(folder / "markers.trc", trial.file, trc);
  }
  trial.file.tracks = {};
  return ok;
}

}  // namespace

Status write_trial(const Body& body,
                   std::span<const fs::path> avatars,
                   const fs::path& folder,
                   MarkerTrial& trial) {
  const MarkerTracks& repaired = trial.repair.repaired.tracks;
  if (!trial.solved) {
    trial.samples_empty = static_cast<std::size_t>(std::count_if(
        repaired.samples.begin(), repaired.samples.end(), [](const auto& s) {
          return !s.has_value();
        }));
    return write_marker_files(folder, repaired, trial);
  }
  CompletedMarkers completed = complete_markers(body, *trial.solved, repaired);
  trial.samples_predicted = completed.predicted;
  trial.samples_empty = completed.empty;
  if (const Status ok = write_marker_files(folder, std::move(completed.tracks), trial);
      !ok) {
    return ok;
  }
  const EstimatedMotion& estimate = trial.solved->estimate;
  if (const Status ok =
          write_motion(folder, estimate, body.proportions, repaired.start_s);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_mot(folder / "motion.mot", mot_table(trial));
      !ok) {
    return ok;
  }
  for (const fs::path& avatar : avatars) {
    const auto written =
        retarget_to_files(estimate.motion, avatar, folder / avatar.stem().string());
    if (!written) return written.error();
    for (const fs::path& file : written->files) {
      trial.avatars.push_back((fs::path(trial.name) / file.filename()).string());
    }
  }
  return Done{};
}

Status check_avatars(std::span<const fs::path> avatars) {
  std::set<std::string> names{"motion", "markers"};
  for (const fs::path& avatar : avatars) {
    if (!names.insert(avatar.stem().string()).second) {
      return bad_input(avatar.string(),
                       "two results would be called \"" + avatar.stem().string() + "\"",
                       "rename the avatar's file: results are named after it");
    }
    if (const Status ok = check_avatar(avatar); !ok) return ok;
  }
  return Done{};
}

}  // namespace marey::app

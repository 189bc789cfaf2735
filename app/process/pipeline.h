// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/pages/report.h"
#include "app/process/calibrate_session.h"
#include "app/shell/console.h"
#include "calib/rig/calibrate_cameras.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/tags/solve_motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// How far a session is taken.
enum class Stage { kTrack, kCalibrate, kSolve, kProcess };

struct PipelineOptions {
  std::filesystem::path session;               ///< session.toml or its folder.
  std::filesystem::path out;                   ///< Where results go; created.
  std::optional<std::filesystem::path> media;  ///< Overrides the session's.
  std::vector<std::filesystem::path> avatars;  ///< GLB, VRM or BVH, each of its own name.
  /// Instead of the session's lens: a word of recordings::kLensWords.
  std::optional<std::string> lens;
};

/// The line through the rooms, drawn once: videos to tag corners to cameras, subject,
/// motion, other bodies and files. Each stage leaves a file that the next one reads, so
/// that a stage can be run alone. Cameras and subject are read back from their files even
/// in the run that wrote them: a stage sees the same numbers either way. Tags are not.
///
/// Every stage's errors are its room's. Files appear whole or not at all.
class Pipeline {
 public:
  /// Reads and checks what can be checked before the long work: the session, that its
  /// videos are there, that it has the trials that `stage` needs, and that every avatar
  /// can be read and has the bones.
  [[nodiscard]] static Result<Pipeline> open(Stage stage,
                                             const PipelineOptions& options,
                                             Console& console);

  /// Tag corners of every trial, from the cache in OUT/TRIAL/detections where it is
  /// current. A motion trial that cannot be read is a failure, and left out from then on;
  /// an error when it was the last.
  [[nodiscard]] Status track();
  /// Cameras: OUT/calibration.toml, and what there is to say of them, in
  /// OUT/calibration.json and calibration.html. Cameras too poor to be trusted are
  /// failures.
  [[nodiscard]] Status calibrate();
  /// The subject: OUT/subject.toml. Reads calibration.toml. Checks first that in every
  /// trial the cameras agree on the tags.
  [[nodiscard]] Status fit();
  /// Motion of every motion trial: joints.csv, segments.csv, motion.bvh, motion.glb,
  /// motion.npz, markers.c3d, markers.trc.
  /// Reads calibration.toml and subject.toml.
  [[nodiscard]] Status solve();
  /// Every solved motion on every avatar: AVATAR.glb and AVATAR.bvh.
  [[nodiscard]] Status retarget();
  /// OUT/report.json and OUT/report.html.
  [[nodiscard]] Status write_report();

  [[nodiscard]] const Report& report() const { return report_; }
  /// What should have been there and is missing, though the rest went on without it, and
  /// what is too poor to be trusted; also among the report's warnings.
  [[nodiscard]] const std::vector<Error>& failures() const { return failures_; }

 private:
  struct SolvedMotion {
    const recordings::Trial* trial = nullptr;
    reconstruct::SolvedTrial solved;
    std::vector<ReportBody> avatars;
  };

  Pipeline(recordings::Session session, PipelineOptions options, Console& console);

  [[nodiscard]] Result<CalibrationSights> calibration_sights();
  [[nodiscard]] Status check_subject(const SessionRig& found,
                                     std::vector<CameraDetections> standing) const;
  [[nodiscard]] Status track_trial(const recordings::Trial& trial);
  [[nodiscard]] Result<std::vector<CameraDetections>> detections_of(
      const recordings::Trial& trial);
  [[nodiscard]] Result<std::vector<CameraDetections>> unshrunk_detections_of(
      const recordings::Trial& trial);
  [[nodiscard]] Status show_cameras(SessionRig found, double rate_hz);
  [[nodiscard]] Status need_cameras();
  [[nodiscard]] Status need_body();
  [[nodiscard]] Status check_trials();
  [[nodiscard]] Result<reconstruct::SolvedTrial> solve_trial(
      const recordings::Trial& trial, const Progress& progress);
  [[nodiscard]] Status assess_standing();
  [[nodiscard]] Status assess_trials();
  [[nodiscard]] Result<ReportBody> retarget_one(SolvedMotion& motion,
                                                const std::filesystem::path& avatar);
  [[nodiscard]] std::vector<const recordings::Trial*> motion_trials() const;
  /// The error with its file: rooms that see no files leave the place empty, or name a
  /// table of session.toml, "[board]".
  [[nodiscard]] Error in_session(Error error) const;
  void time_stage(const std::string& name, double seconds);

  recordings::Session session_;
  PipelineOptions options_;
  Console* console_;
  std::map<std::string, std::vector<CameraDetections>> detections_;  ///< By trial.
  std::vector<Camera> cameras_;
  std::optional<Body> body_;
  std::vector<SolvedMotion> motions_;
  std::vector<Error> failures_;
  std::set<std::string> poor_trials_;  ///< Names of trials with an entry in failures_.
  Report report_;
};

}  // namespace marey::app

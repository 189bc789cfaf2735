// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/pages/report.h"
#include "app/process/calibrate_session.h"
#include "app/shell/console.h"
#include "calib/rig/calibrate_cameras.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/finding.h"
#include "reconstruct/tags/solve_motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Last stage of a run.
enum class Stage { kTrack, kCalibrate, kSolve, kProcess };

struct PipelineOptions {
  std::filesystem::path session;               ///< session.toml or its folder.
  std::filesystem::path out;                   ///< Folder of the results; created.
  std::optional<std::filesystem::path> media;  ///< Replaces the session's.
  std::vector<std::filesystem::path> avatars;  ///< GLB, VRM or BVH; names differ.
  /// Replaces the session's lens: a word of recordings::kLensWords.
  std::optional<std::string> lens;
};

/// Processes a session in stages: videos, tag corners, cameras, subject, motion, motion
/// of other bodies, files. Each stage writes a file that the next stage reads, so a stage
/// can run alone. Cameras and subject are read from their files even in the run that
/// wrote them, so a stage gets the same numbers in both cases. Tags are kept in memory.
///
/// Each stage returns the errors of the functions that it calls. Files appear complete or
/// not at all.
class Pipeline {
 public:
  /// Reads the session and runs all checks that need no long computation: its videos
  /// exist, it has the trials that `stage` needs, and every avatar can be read and has
  /// the required bones.
  [[nodiscard]] static Result<Pipeline> open(Stage stage,
                                             const PipelineOptions& options,
                                             Console& console);

  /// Detects the tag corners of every trial, or reads them from the cache in
  /// OUT/TRIAL/detections if it is current. A motion trial that cannot be read is a
  /// failure and is removed from the session. It is an error if no motion trial is left.
  [[nodiscard]] Status track();
  /// Calibrates the cameras. Writes OUT/calibration.toml, and the findings about them in
  /// OUT/calibration.json and calibration.html. Cameras of insufficient quality are
  /// failures.
  [[nodiscard]] Status calibrate();
  /// Fits the subject and writes OUT/subject.toml. Reads calibration.toml. Checks first
  /// that the cameras agree on the tags in every trial.
  [[nodiscard]] Status fit();
  /// Solves every motion trial and writes joints.csv, segments.csv, motion.bvh,
  /// motion.glb, motion.npz, markers.c3d and markers.trc. Reads calibration.toml and
  /// subject.toml.
  [[nodiscard]] Status solve();
  /// Retargets every solved motion to every avatar. Writes AVATAR.bvh, and AVATAR.glb and
  /// AVATAR.vrma where the avatar has a mesh and the bones of VRM's humanoid.
  [[nodiscard]] Status retarget();
  /// Completes the report: figures of each solved motion, and the findings on them.
  [[nodiscard]] Status assess();
  /// Calls assess() and writes OUT/report.json and OUT/report.html.
  [[nodiscard]] Status write_report();

  /// Its findings are the problems with which the run was completed: missing inputs, and
  /// results of insufficient quality (both poor), and warnings (fair).
  [[nodiscard]] const Report& report() const { return report_; }

  /// Returns the motions of solve() with the names of their trials, in the session's
  /// order. Valid until the next call of solve().
  [[nodiscard]] std::vector<std::pair<std::string, const EstimatedMotion*>> motions()
      const;

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
  [[nodiscard]] Status add_floor_findings();
  [[nodiscard]] Status add_trial_findings();
  [[nodiscard]] Result<ReportBody> retarget_one(SolvedMotion& motion,
                                                const std::filesystem::path& avatar);
  [[nodiscard]] std::vector<const recordings::Trial*> motion_trials() const;
  /// Adds the session file to an error. Functions without access to files leave the place
  /// empty, or name a table of session.toml, such as "[board]".
  [[nodiscard]] Error in_session(Error error) const;
  void add(Finding finding);
  void add_of_trial(const std::string& trial, Finding finding);
  void time_stage(const std::string& name, double seconds);

  recordings::Session session_;
  PipelineOptions options_;
  Console* console_;
  std::map<std::string, std::vector<CameraDetections>> detections_;  ///< Key: trial.
  std::vector<Camera> cameras_;
  std::optional<Body> body_;
  std::vector<SolvedMotion> motions_;
  std::set<std::string> poor_trials_;  ///< Names of trials with poor findings.
  Report report_;
};

/// Runs the stages up to `stage`, without the avatars' motions and the report.
[[nodiscard]] Status run_to(Stage stage, Pipeline& pipeline);

}  // namespace marey::app

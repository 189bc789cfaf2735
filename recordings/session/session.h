// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/frame_range.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/board.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/tag_family.h"

namespace marey::recordings {

/// The purpose of a trial.
enum class TrialKind {
  kCalibration,    ///< The board is waved through the volume.
  kFloor,          ///< The board lies still on the floor.
  kStatic,         ///< The subject stands still.
  kRangeOfMotion,  ///< The subject moves every joint.
  kMotion,         ///< The motion to be reconstructed.
};

/// Returns the word of session.toml: "range-of-motion".
[[nodiscard]] std::string_view name(TrialKind kind);

/// One camera's recording of a trial.
struct TrialVideo {
  CameraId camera{};
  /// A video file or a folder of images; absolute, or relative to the working folder.
  std::filesystem::path path;
  /// Set if the session gives it: frame k was exposed at k / rate + offset.
  std::optional<Timestamp> offset;
  int line = 0;  ///< In session.toml, for messages.
};

/// Recording settings of a camera.
struct SessionDevice {
  std::string path;  ///< "/dev/video0".
  int width_px = 1280;
  int height_px = 720;
  FrameRate rate{30.0};
  /// nullopt: chosen by the camera. Exposure in seconds; focus and gain in the driver's
  /// units.
  std::optional<double> exposure_s;
  std::optional<int> focus;
  std::optional<int> gain;
  int line = 0;  ///< In session.toml, for messages.
};

struct Trial {
  std::string name;  ///< Safe as the name of a folder.
  TrialKind kind = TrialKind::kMotion;
  std::optional<FrameRate> rate;  ///< nullopt: the video's own rate.
  /// Factor by which the videos play slower than real time. Above 1 only with a rate,
  /// which is then that of the camera.
  double slow_motion = 1.0;
  std::optional<FrameRange> frames;  ///< nullopt: all.
  std::vector<TrialVideo> videos;    ///< At least one; ascending cameras, each once.
  /// Table of frame times (recordings/takes/frame_stamps.h), if the session names one;
  /// relative paths as for the videos.
  std::optional<std::filesystem::path> timestamps;
  /// The session names no videos: they are the output of `marey record`, if it has run.
  bool is_recorded = false;
  int line = 0;  ///< In session.toml, for messages.
};

struct Subject {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
};

/// Assumption about the cameras' clocks during calibration.
enum class ClockChoice {
  kAuto,     ///< One clock, unless the detections contradict it.
  kShared,   ///< One clock: frames of equal number are simultaneous.
  kOffsets,  ///< One clock per camera, all at one rate.
  kDrifts,   ///< One clock per camera, with its own rate.
};

/// Words for lenses in session.toml and on the command line; nullopt selects the best
/// model.
inline constexpr std::array<std::pair<std::string_view, std::optional<LensModel>>, 4>
    kLensWords{{
        {"auto", std::nullopt},
        {"brown-conrady", LensModel::kBrownConrady},
        {"rational", LensModel::kRational},
        {"fisheye", LensModel::kFisheye},
    }};

/// [calibration] of session.toml: options of the camera calibration.
struct CalibrationChoices {
  std::optional<LensModel> lens =
      LensModel::kBrownConrady;  ///< nullopt: selected by the fit.
  ClockChoice clocks = ClockChoice::kAuto;
  double max_offset_s = 5.0;  ///< Maximum offset between the starts of the cameras.
  bool line_delays = false;
  bool warp = false;
  bool cross_validate = true;
  /// A calibration whose lenses are used unchanged; absolute, or relative to the working
  /// folder.
  std::optional<std::filesystem::path> lenses;
  int lenses_line = 0;  ///< In session.toml, for messages.
  /// Height of a tag's lowest corner while the subject stands still; used if the static
  /// trial defines the floor.
  double lowest_corner_m = 0.0;
};

/// Content of session.toml (docs/formats/README.md).
struct Session {
  std::filesystem::path file;  ///< session.toml itself.
  std::string name;
  Subject subject;  ///< Without a name if the session is for cameras alone.
  /// Families in use, each with its tags: the target's first, then those of the body.
  std::vector<TagFamilyUse> families;
  std::vector<TagOnSegment> tags;  ///< On the body; in the order of the file.
  CalibrationTarget target;        ///< The calibration target.
  CalibrationChoices calibration;
  std::vector<std::string> cameras;  ///< Names, by CameraId; safe as names of folders.
  /// By CameraId; nullopt for a camera without a device.
  std::vector<std::optional<SessionDevice>> devices;
  std::vector<Trial> trials;  ///< In the order of the file.

  /// Returns the family of a tag. Precondition: the tag is on the target or on the body.
  [[nodiscard]] const std::string& family_of(TagId id) const;
  /// Returns the first trial of this kind; null if there is none.
  [[nodiscard]] const Trial* find(TrialKind kind) const;
  /// Returns the trial of this name; null if there is none.
  [[nodiscard]] const Trial* find(std::string_view trial_name) const;
};

struct ReadSessionOptions {
  /// Base folder of video paths, instead of the session's `media`; itself relative to the
  /// working folder.
  std::optional<std::filesystem::path> media;
};

/// Reads a session. `path` is its session.toml or the folder that contains it. Does not
/// open videos; see check_files().
///
/// Errors (kBadInput), each with its line: not TOML; a key that is unknown, missing, of
/// the wrong type or out of range; an unusable target (see docs/formats/README.md); a
/// tag, camera or trial named twice; a body tag that is also on the target; an unknown
/// segment or camera; a name that is not a valid folder name; a trial without videos
/// while no camera has a device; a frame range whose end is before its start; a floor
/// trial that covers all of the calibration's videos; time offsets of a trial other than
/// motion; fewer than two cameras; no calibration trial; no floor trial (nor a static
/// one), subject or tags though there are trials of a person; two trials of one kind
/// other than motion.
[[nodiscard]] Result<Session> read_session(const std::filesystem::path& path,
                                           const ReadSessionOptions& options = {});

/// Returns true if any part of the trial's recording exists. Precondition: is_recorded.
[[nodiscard]] bool has_recording(const Trial& trial);

/// Returns true if at least one of the videos that a trial names exists.
[[nodiscard]] bool has_video(const Trial& trial);

/// Checks that every video exists. Errors (kBadInput): the first missing video, with its
/// line in session.toml; a trial that has not been recorded yet. A recorded trial may
/// lack the video of one of its cameras.
[[nodiscard]] Status check_files(const Session& session);

}  // namespace marey::recordings

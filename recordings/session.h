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

#include "core/board.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/ids.h"
#include "core/result.h"
#include "core/tag_family.h"
#include "core/time.h"

namespace marey::recordings {

/// What a trial is for.
enum class TrialKind {
  kCalibration,    ///< The board is waved through the volume.
  kFloor,          ///< The board lies still on the floor.
  kStatic,         ///< The subject stands still.
  kRangeOfMotion,  ///< The subject moves every joint.
  kMotion,         ///< What it is all for.
};

/// The word of session.toml: "range-of-motion".
[[nodiscard]] std::string_view name(TrialKind kind);

/// Frames first to last, both included, counted from 0.
struct FrameRange {
  int first = 0;
  int last = 0;
};

/// What one camera recorded of a trial.
struct TrialVideo {
  CameraId camera{};
  /// A video file or a folder of images; absolute, or relative to the working folder.
  std::filesystem::path path;
  /// When the session says so: frame k was exposed at k / rate + offset.
  std::optional<Timestamp> offset;
  int line = 0;  ///< In session.toml, for messages.
};

/// How a camera is recorded from.
struct SessionDevice {
  std::string path;  ///< "/dev/video0".
  int width_px = 1280;
  int height_px = 720;
  FrameRate rate{30.0};
  /// nullopt leaves each to the camera. Exposure [s]; focus and gain in the driver's own
  /// units.
  std::optional<double> exposure_s;
  std::optional<int> focus;
  std::optional<int> gain;
  int line = 0;  ///< In session.toml, for messages.
};

struct Trial {
  std::string name;  ///< Safe as the name of a folder.
  TrialKind kind = TrialKind::kMotion;
  std::optional<FrameRate> rate;  ///< nullopt: as the video says.
  /// Factor by which its videos play slower than life. Above 1 only with a rate, which is
  /// then that of the camera.
  double slow_motion = 1.0;
  std::optional<FrameRange> frames;  ///< nullopt: all.
  std::vector<TrialVideo> videos;    ///< At least one; ascending cameras, each once.
  /// The table of when their frames were taken (recordings/frame_stamps.h), where the
  /// session names one; as the videos' paths.
  std::optional<std::filesystem::path> timestamps;
  /// The session names no videos: they are what `marey record` makes, if it has.
  bool is_recorded = false;
  int line = 0;  ///< In session.toml, for messages.
};

struct Subject {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
};

/// Which clocks cameras are taken to run on while they are calibrated.
enum class ClockChoice {
  kAuto,     ///< One, unless what they see says otherwise.
  kShared,   ///< One: frames of a number belong together.
  kOffsets,  ///< Each its own, at one rate.
  kDrifts,   ///< Each its own.
};

/// Words for lenses in session.toml and on the command line; nullopt is what serves best.
inline constexpr std::array<std::pair<std::string_view, std::optional<LensModel>>, 4>
    kLensWords{{
        {"auto", std::nullopt},
        {"brown-conrady", LensModel::kBrownConrady},
        {"rational", LensModel::kRational},
        {"fisheye", LensModel::kFisheye},
    }};

/// [calibration] of session.toml: how cameras are calibrated.
struct CalibrationChoices {
  std::optional<LensModel> lens =
      LensModel::kBrownConrady;  ///< nullopt: what serves best.
  ClockChoice clocks = ClockChoice::kAuto;
  double most_offset_s = 5.0;  ///< As far apart the cameras may have been started.
  bool line_delays = false;
  bool warp = false;
  bool cross_validate = true;
  /// A calibration whose lenses are taken as they are; absolute, or relative to the
  /// working folder.
  std::optional<std::filesystem::path> lenses;
  int lenses_line = 0;  ///< In session.toml, for messages.
  /// How high the lowest corner of a tag is while the subject stands still, where that
  /// says where the floor is.
  double lowest_corner_m = 0.0;
};

/// What session.toml says (docs/formats.md).
struct Session {
  std::filesystem::path file;  ///< session.toml itself.
  std::string name;
  Subject subject;  ///< Without a name when the session is for cameras alone.
  /// In use, each with its tags: the target's first, then those of the body.
  std::vector<TagFamilyUse> families;
  std::vector<TagOnSegment> tags;  ///< On the body; in the order of the file.
  CalibrationTarget target;        ///< What the cameras are calibrated with.
  CalibrationChoices calibration;
  std::vector<std::string> cameras;  ///< Names, by CameraId; safe as names of folders.
  /// By CameraId; nullopt of a camera that is not recorded from.
  std::vector<std::optional<SessionDevice>> devices;
  std::vector<Trial> trials;  ///< In the order of the file.

  /// The family of a tag on the target or the body. Precondition: it is on one of them.
  [[nodiscard]] const std::string& family_of(TagId id) const;
  /// The first trial of this kind, if any.
  [[nodiscard]] const Trial* find(TrialKind kind) const;
  /// The trial of this name, if any.
  [[nodiscard]] const Trial* find(std::string_view trial_name) const;
};

struct ReadSessionOptions {
  /// The folder that video paths are relative to, instead of the session's `media`;
  /// itself relative to the working folder.
  std::optional<std::filesystem::path> media;
};

/// Reads a session. `path` is its session.toml or the folder that holds it. Touches no
/// video: see check_files().
///
/// Errors (kBadInput), each with its line: not TOML; a key that is unknown, missing, of
/// the wrong type or out of range; a target that cannot serve (see docs/formats.md); a
/// tag, camera or trial named twice; a body tag that is also on the target; an unknown
/// segment or camera; a name that cannot be a folder's; a trial without videos while no
/// camera has a device; frames the wrong way round; a floor trial that is all of the
/// calibration's videos; time offsets of anything but motion; fewer than two cameras; no
/// calibration trial; no floor trial (nor a static one), subject or tags though there are
/// trials of a person; two trials of one kind other than motion.
[[nodiscard]] Result<Session> read_session(const std::filesystem::path& path,
                                           const ReadSessionOptions& options = {});

/// Whether anything of a trial to be recorded is there. Precondition: is_recorded.
[[nodiscard]] bool has_recording(const Trial& trial);

/// Returns whether at least one of the videos that a trial names exists.
[[nodiscard]] bool has_video(const Trial& trial);

/// Whether every video is there. Errors (kBadInput): the first that is not, with the line
/// that names it; a trial to be recorded that was not. That one of its cameras has no
/// video is no error.
[[nodiscard]] Status check_files(const Session& session);

}  // namespace marey::recordings

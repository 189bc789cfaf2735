// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/in_quotes.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/session/find_trial_conflict.h"
#include "recordings/session/session.h"
#include "recordings/session/session_calibration.h"
#include "recordings/session/session_device.h"
#include "recordings/session/session_family.h"
#include "recordings/session/session_target.h"

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

constexpr std::array kKinds{TrialKind::kCalibration,
                            TrialKind::kFloor,
                            TrialKind::kStatic,
                            TrialKind::kRangeOfMotion,
                            TrialKind::kMotion};

// Wide enough for all real values; detects millimetres given as metres.
constexpr Limits kTagSize{0.005, 1.0, "m"};
constexpr Limits kStature{0.3, 2.8, "m"};
constexpr Limits kMass{2.0, 500.0, "kg"};
constexpr Limits kRate{0.1, 2000.0, "frames per second"};
constexpr Limits kSlowMotion{1.01, 100.0, "times"};
constexpr Limits kOffset{-60.0, 60.0, "s"};

/// Safe as a folder name, a key of calibration.toml and a word on a command line.
bool is_safe_name(std::string_view word) {
  constexpr std::string_view kSafe =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  constexpr std::size_t kMaxLength = 64;
  return !word.empty() && word.size() <= kMaxLength && word[0] != '.' && word[0] != '-' &&
         word.find_first_not_of(kSafe) == std::string_view::npos;
}

/// Reads session.toml from top to bottom; a mistake is kept in the document.
class SessionReader {
 public:
  SessionReader(TomlDocument& document,
                const ReadSessionOptions& options,
                Session& session)
      : root_(document), options_(options), session_(session) {}

  void read() {
    root_.allow({"format",
                 "name",
                 "media",
                 "subject",
                 "tags",
                 "board",
                 "wand",
                 "calibration",
                 "camera",
                 "trial"});
    (void)root_.integer("format", {1, 1});
    session_.name = root_.text("name");
    read_media();
    const bool only_cameras = !has_a_person();
    if (!only_cameras || root_.has("subject")) read_subject();
    if (!only_cameras || root_.has("tags")) read_usual_family();
    session_.target = read_target(root_, usual_family_, session_);
    if (!only_cameras || root_.has("tags")) read_tags();
    read_wand_segment(root_, session_);
    session_.calibration = read_calibration_choices(root_, session_.file.parent_path());
    read_cameras();
    read_trials();
  }

 private:
  bool has_a_person();
  void read_media();
  void read_subject();
  void read_usual_family();
  void read_tags();
  void read_tag(TomlReader& reader);
  void read_cameras();
  void read_trials();
  Trial read_trial(TomlReader& reader);
  FrameRange read_frames(TomlReader& reader);
  TrialKind read_kind(TomlReader& reader);
  void read_videos(TomlReader& trial, Trial& out);
  void read_offsets(TomlReader& trial, Trial& out);
  std::string read_name(TomlReader& reader,
                        std::string_view what,
                        const std::vector<std::string>& taken,
                        std::span<const std::string_view> reserved);
  std::optional<CameraId> camera_of(TomlReader& videos, const std::string& name);

  TomlReader root_;
  const ReadSessionOptions& options_;
  Session& session_;
  fs::path media_;
  KnownFamily usual_family_ = default_family();
};

/// Returns false if the session consists of calibration and floor trials alone.
bool SessionReader::has_a_person() {
  const std::vector<TomlReader> trials = root_.tables("trial");
  return trials.empty() ||
         std::any_of(trials.begin(), trials.end(), [](TomlReader trial) {
           const std::string kind = trial.has("kind") ? trial.text("kind") : "";
           return kind != name(TrialKind::kCalibration) &&
                  kind != name(TrialKind::kFloor);
         });
}

void SessionReader::read_media() {
  const fs::path base = session_.file.parent_path();
  media_ =
      options_.media.value_or(root_.has("media") ? base / root_.text("media") : base);
}

void SessionReader::read_subject() {
  TomlReader subject = root_.table("subject");
  subject.allow({"name", "stature_m", "mass_kg"});
  session_.subject.name = subject.text("name");
  session_.subject.stature_m = subject.number("stature_m", kStature);
  if (subject.has("mass_kg")) session_.subject.mass_kg = subject.number("mass_kg", kMass);
}

void SessionReader::read_usual_family() {
  TomlReader tags = root_.table("tags");
  tags.allow({"family", "tag"});
  usual_family_ = read_family(tags, default_family());
}

void SessionReader::read_tags() {
  TomlReader tags = root_.table("tags");
  if (!tags.has("tag")) {
    tags.fail("",
              "no tag is on the body",
              "add a [[tags.tag]] with id, segment and size_m for each");
  }
  for (TomlReader& reader : tags.tables("tag")) read_tag(reader);
}

void SessionReader::read_tag(TomlReader& reader) {
  reader.allow({"id", "family", "segment", "size_m"});
  const KnownFamily family = read_family(reader, usual_family_);
  const auto id = TagId{reader.integer("id", {0, 1e6})};
  if (reader.ok() && number(id) >= family.tags) {
    reader.fail("id",
                with_number("\"id\" is ", number(id)) +
                    with_number(", but " + std::string(family.name) + " ends at ",
                                family.tags - 1),
                "correct the id, or the `family`: tag36h11 is the usual one");
  }
  const std::string segment = reader.text("segment");
  const double size_m = reader.number("size_m", kTagSize);
  if (!reader.ok()) return;

  const auto same_id = [&](const TagOnSegment& tag) { return tag.id == id; };
  if (std::any_of(session_.tags.begin(), session_.tags.end(), same_id)) {
    reader.fail("id",
                with_number("tag ", number(id)) + " is listed twice",
                "remove one, or correct its id");
  }
  if (const auto place = place_on_target(session_.target, id, family)) {
    reader.fail("id",
                with_number("tag ", number(id)) + " is on the body and " + *place,
                "glue a tag with another id to the body, or correct the entry of the "
                "other in session.toml");
  }
  const std::optional<HumanBone> bone = human_bone(segment);
  if (!bone) {
    reader.fail(
        "segment", "unknown segment " + in_quotes(segment), bone_suggestion(segment));
    return;
  }
  session_.tags.push_back({id, *bone, size_m});
  use_tag(family, id, session_);
}

std::string SessionReader::read_name(TomlReader& reader,
                                     std::string_view what,
                                     const std::vector<std::string>& taken,
                                     std::span<const std::string_view> reserved) {
  std::string word = reader.text("name");
  if (!reader.ok()) return word;
  const std::string title = std::string(what).append(" name ").append(in_quotes(word));
  if (!is_safe_name(word)) {
    reader.fail("name",
                title + " cannot be the name of a folder",
                "use up to 64 of A-Z a-z 0-9 . _ - and begin with a letter or digit");
  }
  if (std::find(reserved.begin(), reserved.end(), word) != reserved.end()) {
    reader.fail("name", title + " is one of marey's own files' names", "choose another");
  }
  if (std::find(taken.begin(), taken.end(), word) != taken.end()) {
    reader.fail("name", title + " is used twice", "give each its own name");
  }
  return word;
}

void SessionReader::read_cameras() {
  // Tables of calibration.toml that Pose2Sim does not treat as cameras.
  constexpr std::array<std::string_view, 4> kReserved{
      "metadata", "capture_volume", "charuco", "checkerboard"};
  for (TomlReader& reader : root_.tables("camera")) {
    reader.allow(kCameraKeys);
    session_.cameras.push_back(read_name(reader, "camera", session_.cameras, kReserved));
    session_.devices.push_back(read_device(reader, session_));
  }
  if (session_.cameras.size() < 2) {
    root_.fail("camera",
               with_number("two cameras are needed, found ",
                           static_cast<int>(session_.cameras.size())),
               "add a [[camera]] with its name for each");
  }
}

void SessionReader::read_trials() {
  for (TomlReader& reader : root_.tables("trial")) {
    Trial trial = read_trial(reader);
    const auto mistake = find_trial_conflict(trial, session_);
    if (mistake && reader.ok()) reader.fail(mistake->key, mistake->cause, mistake->next);
    session_.trials.push_back(std::move(trial));
  }
  for (const TrialKind kind : {TrialKind::kCalibration, TrialKind::kFloor}) {
    // Without a subject the floor is not needed; a static trial of a subject also
    // determines it.
    const bool is_needed =
        kind == TrialKind::kCalibration ||
        (has_a_person() && session_.find(TrialKind::kStatic) == nullptr);
    if (session_.find(kind) != nullptr || !is_needed) continue;
    const std::string word(name(kind));
    root_.fail(
        "trial",
        "no trial has the kind " + in_quotes(word),
        "add a [[trial]] with kind = " + in_quotes(word) +
            (kind == TrialKind::kFloor ? ": the board lying still on the floor; or "
                                         "one of a subject who stands still"
                                       : ": the board waved through the volume"));
  }
}

TrialKind SessionReader::read_kind(TomlReader& reader) {
  const std::string word = reader.text("kind");
  std::vector<std::string_view> words;
  for (const TrialKind kind : kKinds) {
    words.push_back(name(kind));
    if (word == words.back()) return kind;
  }
  reader.fail("kind", "unknown kind " + in_quotes(word), suggestion(word, words));
  return TrialKind::kMotion;
}

Trial SessionReader::read_trial(TomlReader& reader) {
  // Files that the program writes next to the trials' folders.
  constexpr std::array<std::string_view, 4> kReserved{
      "calibration.toml", "subject.toml", "report.json", "report.html"};
  constexpr std::array<std::string_view, 8> kKeys{"name",
                                                  "kind",
                                                  "fps",
                                                  "slow_motion",
                                                  "frames",
                                                  "videos",
                                                  "timestamps",
                                                  "time_offset_s"};
  reader.allow(kKeys);
  std::vector<std::string> taken;
  for (const Trial& earlier : session_.trials) taken.push_back(earlier.name);
  Trial trial;
  trial.line = reader.line();
  trial.name = read_name(reader, "trial", taken, kReserved);
  trial.kind = read_kind(reader);
  if (reader.has("fps")) trial.rate = FrameRate{reader.number("fps", kRate)};
  if (reader.has("slow_motion")) {
    trial.slow_motion = reader.number("slow_motion", kSlowMotion);
  }
  if (reader.has("frames")) trial.frames = read_frames(reader);
  read_videos(reader, trial);
  if (reader.has("timestamps")) {
    trial.timestamps = (media_ / reader.text("timestamps")).lexically_normal();
  }
  if (reader.has("time_offset_s")) read_offsets(reader, trial);
  return trial;
}

FrameRange SessionReader::read_frames(TomlReader& reader) {
  constexpr double kMaxValue = 1e8;
  const char* next = "write the first and the last frame to use: frames = [0, 126]";
  const std::vector<double> frames = reader.numbers("frames", 2);
  for (const double frame : frames) {
    if (frame >= 0 && frame <= kMaxValue && frame == std::floor(frame)) continue;
    reader.fail("frames", "\"frames\" must be two whole numbers from 0", next);
    return {};
  }
  if (frames[0] > frames[1]) {
    reader.fail("frames", "the first frame comes after the last", next);
  }
  return {static_cast<int>(frames[0]), static_cast<int>(frames[1])};
}

std::optional<CameraId> SessionReader::camera_of(TomlReader& videos,
                                                 const std::string& name) {
  const auto& names = session_.cameras;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return CameraId{static_cast<int>(found - names.begin())};
  if (!videos.ok()) return std::nullopt;  // The session may have no camera at all.
  const std::vector<std::string_view> words(names.begin(), names.end());
  videos.fail(name, "unknown camera " + in_quotes(name), suggestion(name, words));
  return std::nullopt;
}

void SessionReader::read_videos(TomlReader& trial, Trial& out) {
  if (!trial.has("videos") && add_recorded_videos(session_, out)) return;
  if (!trial.has("videos") || trial.table("videos").keys().empty()) {
    trial.fail("videos",
               "trial " + in_quotes(out.name) + " has no video",
               "write videos = { CAMERA = \"FILE\" } for its cameras");
    return;
  }
  TomlReader videos = trial.table("videos");
  for (const std::string& name : videos.keys()) {
    const std::optional<CameraId> camera = camera_of(videos, name);
    const std::string path = videos.text(name);
    if (!videos.ok()) return;
    if (path.empty()) {
      videos.fail(
          name, "the video of " + in_quotes(name) + " has no name", "name its file");
    }
    if (path.find_first_of("\n\r") != std::string::npos) {
      videos.fail(name,
                  "the video of " + in_quotes(name) + " has a line break in its name",
                  "rename the file");
    }
    const fs::path full = (media_ / path).lexically_normal();
    for (const TrialVideo& other : out.videos) {
      if (other.path != full) continue;
      videos.fail(name,
                  "two cameras have the same video " + in_quotes(path),
                  "name each camera's own");
    }
    out.videos.push_back({*camera, full, std::nullopt, videos.line(name)});
  }
  std::sort(out.videos.begin(), out.videos.end(), [](const auto& a, const auto& b) {
    return a.camera < b.camera;
  });
}

void SessionReader::read_offsets(TomlReader& trial, Trial& out) {
  if (out.kind != TrialKind::kMotion) {
    trial.fail("time_offset_s",
               "time offsets are for motion trials",
               "remove it here: start the cameras together, or cut the videos so that "
               "they do");
    return;
  }
  TomlReader offsets = trial.table("time_offset_s");
  for (const std::string& name : offsets.keys()) {
    const std::optional<CameraId> camera = camera_of(offsets, name);
    const double offset_s = offsets.number(name, kOffset);
    if (!offsets.ok()) return;
    const auto video =
        std::find_if(out.videos.begin(), out.videos.end(), [&](const auto& candidate) {
          return candidate.camera == *camera;
        });
    if (video == out.videos.end()) {
      offsets.fail(name,
                   "camera " + in_quotes(name) + " has an offset but no video",
                   "remove the offset, or add the video");
      return;
    }
    video->offset = from_seconds(offset_s);
  }
}

}  // namespace

Result<Session> read_session(const fs::path& path, const ReadSessionOptions& options) {
  std::error_code ignored;
  Session session;
  session.file = fs::is_directory(path, ignored) ? path / "session.toml" : path;
  const Result<std::string> text = read_file(session.file);
  if (!text) return text.error();
  Result<TomlDocument> document = parse_toml(*text, session.file.string(), "session.md");
  if (!document) return document.error();
  SessionReader(*document, options, session).read();
  if (document->mistake) return mistake_of(*document, TomlKind::kSession);
  return session;
}

}  // namespace marey::recordings

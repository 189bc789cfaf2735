// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/frame_range.h"

namespace marey {

/// Quality of a clip, and of one figure of it. The quality of a clip is its worst
/// figure's, unless a person corrected it (labels/verdicts.csv).
enum class Verdict { kPass, kWarn, kFail };

[[nodiscard]] constexpr std::string_view name(Verdict verdict) {
  constexpr std::string_view kNames[] = {"pass", "warn", "fail"};
  return kNames[static_cast<int>(verdict)];
}

/// One measured property of a clip.
struct ClipFigure {
  std::string name;  ///< "slide_cm_s": the unit is a part of it.
  double value = 0.0;
  std::optional<Verdict> verdict;    ///< nullopt: only reported.
  std::string joint;                 ///< Where it is worst; empty: the whole body.
  std::optional<FrameRange> frames;  ///< When it is worst, in the clip.
};

/// A place in a clip that a verdict is about.
struct ClipProblem {
  FrameRange frames;  ///< In the clip.
  std::string kind;   ///< "spike", "slide", "frozen", "swap"...
  std::string joint;  ///< Empty: the whole body.
  double value = 0.0;
};

/// A name for a part of a clip, by a person or by marey.
struct ClipLabel {
  double start_s = 0.0;  ///< Since the first frame of the clip.
  double end_s = 0.0;
  std::string text;
  std::string by;          ///< "marey", or the name of a table or a person.
  double certainty = 1.0;  ///< 0 to 1.
};

/// An instant with a name: "left.strike".
struct ClipEvent {
  int frame = 0;
  std::string name;
};

/// The reason for the rate of a clip.
enum class RateBasis {
  kFile,    ///< The file states it, and nothing else does.
  kTable,   ///< An index table states it.
  kOption,  ///< library.toml states it.
};

[[nodiscard]] constexpr std::string_view name(RateBasis basis) {
  constexpr std::string_view kNames[] = {"file", "table", "option"};
  return kNames[static_cast<int>(basis)];
}

/// Origin of a clip, and permitted use.
struct Provenance {
  std::string source_id;  ///< SHA-256 of the source file's bytes, 64 digits.
  std::string path;  ///< Path of the source, relative to the library if it is below it.
  std::string kind;  ///< "bvh", "amc", "npz", "glb", "take", "c3d"...
  std::string licence;  ///< SPDX expression, or "unknown".
  std::string origin;   ///< Repository, address or person.
  std::string commit;   ///< Version of the origin; empty: unknown.
  std::string subject;  ///< The person who moves; empty: unknown.
  std::string attribution;
};

/// One motion of a library, without its frames. Frames count from the clip's first one.
struct ClipRecord {
  /// First 16 hexadecimal digits of SHA-256(source_id, body, first frame, last frame).
  /// The same, however the motion was processed.
  std::string clip_id;
  std::string object_key;  ///< Name of its motion object: 64 hexadecimal digits.
  std::string name;        ///< For people: name of the file, and number of the segment.
  Provenance provenance;
  std::string body;     ///< Name of the body in the source; empty: the only one.
  int first_frame = 0;  ///< In the source.
  int last_frame = 0;
  double rate_hz = 0.0;
  RateBasis rate_by = RateBasis::kFile;
  Verdict quality = Verdict::kPass;
  std::vector<ClipFigure> figures;    ///< Ascending by name.
  std::vector<ClipProblem> problems;  ///< Ascending by first frame, then kind and joint.
  std::vector<ClipLabel> labels;      ///< Ascending by start, then text.
  std::vector<ClipEvent> events;      ///< Ascending by frame, then name.
  std::string split;                  ///< "train", "val", "test"; empty: none.
  /// Id of the clip that this one repeats: an earlier or a longer one; empty: none.
  std::string duplicate_of;
  std::string mirror_of;  ///< The same, for the mirror image.

  [[nodiscard]] int frame_count() const { return last_frame - first_frame + 1; }
  [[nodiscard]] double duration_s() const {
    return rate_hz > 0.0 ? (frame_count() - 1) / rate_hz : 0.0;
  }
};

}  // namespace marey

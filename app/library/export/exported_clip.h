// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/export/export_options.h"
#include "app/motion/motion_files.h"
#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/library/library_motion.h"

namespace marey::app {

/// A clip in the form in which an export writes it.
struct ExportedClip {
  /// Record of the exported motion. At another rate, its frames are numbers at that rate;
  /// a mirrored copy has the id ID_mirror, and mirror_of names the clip.
  ClipRecord record;
  /// The motion. Only for the skeleton "own" and the named ones it rests in marey's
  /// T-pose; a body's file keeps its own rest pose.
  LibraryMotion motion;
};

/// The target body of an export.
struct ExportBody {
  std::optional<Skeleton> skeleton = std::nullopt;    ///< nullopt: each clip's own.
  std::optional<OpenedAvatar> avatar = std::nullopt;  ///< Set for a body's file.

  /// Look for write_motion_file(); without a file if there is no mesh.
  [[nodiscard]] BodyLook look() const { return avatar ? avatar->look : BodyLook{}; }
};

/// Reads the body of ExportOptions::skeleton. Errors: those of open_avatar(); a name that
/// is neither a skeleton nor a file (kBadInput).
[[nodiscard]] Result<ExportBody> open_export_body(const std::string& skeleton);

/// A label of a mirrored copy that was left out, because its side is not known.
struct UnknownSide {
  std::string clip_id;
  std::string label;
};

/// Returns the copy of a record for the mirrored motion: id, mirror_of, labels, events
/// and joints with sides exchanged. Labels and events with an unknown side
/// (exchanged_sides()) are left out and appended to `unknown`.
[[nodiscard]] ClipRecord mirrored_record(const ClipRecord& record,
                                         std::vector<UnknownSide>& unknown);

/// Converts clips one by one.
class ClipConverter {
 public:
  /// Borrows all; they must outlive the converter.
  ClipConverter(const ExportOptions& options, const ExportBody& body)
      : options_(options), body_(body) {}

  /// Converts a clip: retargets, resamples and places it. The result has the clip, and
  /// its mirrored copy if that is wanted. Errors (kBadInput): the body cannot be
  /// retargeted; no instant of the new rate lies in the clip.
  [[nodiscard]] Result<std::vector<ExportedClip>> convert(
      const ClipRecord& record,
      LibraryMotion motion,
      std::vector<UnknownSide>& unknown) const;

 private:
  const ExportOptions& options_;
  const ExportBody& body_;
};

}  // namespace marey::app

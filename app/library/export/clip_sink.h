// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "app/library/export/export_options.h"
#include "app/library/export/exported_clip.h"
#include "core/base/result.h"

namespace marey::app {

/// Writes the clips of an export in one layout, one after the other.
class ClipSink {
 public:
  virtual ~ClipSink() = default;

  /// Checks that a clip fits the layout, before anything of it is written. Errors
  /// (kBadInput): the reason for which it must be left out.
  [[nodiscard]] virtual Status check(const ExportedClip& clip) const = 0;
  /// Writes a clip. Errors: the disk; what no other clip would repair.
  /// Precondition: check() passes.
  [[nodiscard]] virtual Status add(const ExportedClip& clip) = 0;
  /// Writes files of all clips. Errors: the disk.
  [[nodiscard]] virtual Status finish() = 0;
};

/// Makes the writer of a layout in a folder. Borrows the body.
[[nodiscard]] std::unique_ptr<ClipSink> make_clip_sink(
    const ExportOptions& options,
    const ExportBody& body,
    const std::filesystem::path& folder);

/// Returns numpy's archive of a clip: layout 1 of recordings::npz_bytes() with contacts,
/// uncertainty, clip_id, licence and labels. Errors: those of npz_bytes().
[[nodiscard]] Result<std::string> clip_npz(const ExportedClip& clip);

}  // namespace marey::app

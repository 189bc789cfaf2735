// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/result.h"
#include "recordings/session.h"

namespace marey::recordings {

/// Puts a copy of the session's file into `folder`, where `trial` is to be recorded, so
/// that the folder is a session of its own; videos that the session names stay where they
/// are. A file that is there already is left alone.
///
/// Errors (kBadInput): the session there does not have the trial as one to record; its
/// own videos, or its `lenses`, are relative and cannot be named from there; the disk.
[[nodiscard]] Status copy_session(const Session& session,
                                  const std::filesystem::path& folder,
                                  const Trial& trial);

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "recordings/session/session.h"

namespace marey::recordings {

/// Copies the session's file into `folder`, where `trial` is to be recorded, so that the
/// folder is a session of its own. Videos named by the session are not moved. A file that
/// already exists is not changed.
///
/// Errors (kBadInput): the session in the folder does not have the trial as one to
/// record; its own videos, or its `lenses`, are relative and have no path from there; a
/// disk error.
[[nodiscard]] Status copy_session(const Session& session,
                                  const std::filesystem::path& folder,
                                  const Trial& trial);

}  // namespace marey::recordings

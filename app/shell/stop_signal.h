// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Handlers for Ctrl-C, SIGTERM and SIGHUP. A SIGHUP that is ignored, as under nohup(1),
// stays ignored.

namespace marey::app {

/// Installs handlers that remove half-written files and end the process at once, with
/// exit code 130. All other files appear complete or not at all.
void exit_on_stop_signals();

/// Installs handlers for commands that finish their work first. The first signal makes
/// stop_wanted() return true; the second ends the process at once, with exit code 130. A
/// closed pipe on standard output or standard error does not end the process.
void catch_stop_signals();

/// Returns true after the first signal. Safe in any thread.
[[nodiscard]] bool stop_wanted();

}  // namespace marey::app

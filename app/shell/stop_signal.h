// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::app {

/// Installs handlers for Ctrl-C, SIGTERM and SIGHUP. The first signal makes stop_wanted()
/// return true; the second ends the process at once, with exit code 130. A closed pipe on
/// standard output or standard error does not end the process.
void catch_stop_signals();

/// Returns true after the first signal. Safe in any thread.
[[nodiscard]] bool stop_wanted();

}  // namespace marey::app

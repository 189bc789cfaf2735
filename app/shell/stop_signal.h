// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::app {

/// From now on Ctrl-C, SIGTERM and SIGHUP ask for an end, which stop_wanted() tells, and
/// the second of them is the end, at once, with the exit code 130. A reader of our output
/// that is gone ends nothing.
void catch_stop_signals();

[[nodiscard]] bool stop_wanted();

}  // namespace marey::app

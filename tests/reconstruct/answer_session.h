// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/truth/judge_session.h"

namespace marey::testing {

/// Processes a session like `marey solve`: checks its views, fits the subject and solves
/// the motion. Ends at the first error, or at a warning that is not about a left-out hand
/// or foot. Some 10 s of processor time.
[[nodiscard]] SessionAnswer answer_session(const SimulatedSession& session);

}  // namespace marey::testing

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/judge_session.h"

namespace marey::testing {

/// Does what `marey solve` does with a session: checks its views, fits the subject and
/// solves the motion. Ends at the first error, or at a doubt that is not about a hand or
/// foot that was left out. Some 10 s of processor time.
[[nodiscard]] SessionAnswer answer_session(const SimulatedSession& session);

}  // namespace marey::testing

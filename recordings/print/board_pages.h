// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recordings/print/printed_page.h"

namespace marey::recordings {

/// Paper of a printed board, and permission to use several pages.
struct BoardPages {
  Paper paper;
  /// Reject a board that needs more than one page, rather than tile it.
  bool one_page = false;
};

}  // namespace marey::recordings

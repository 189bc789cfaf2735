// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "core/tag_pattern.h"
#include "recordings/print/printed_page.h"
#include "recordings/print/tag_sheet.h"

namespace marey::recordings {

/// Lays the tags of a sheet out on pages, in the orientation that needs fewer pages. Each
/// tag has its quiet zone, its name, a dimension line and cut marks. Errors (kBadInput):
/// the paper is too small for the ruler, or for one of the pieces. Preconditions: at
/// least one tag; sizes are positive.
[[nodiscard]] Result<PrintedDocument> lay_out_tags(const TagSheet& sheet);

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "library/export/licence_terms.h"

#include "app/library/export/export_options.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Clips under one licence expression.
struct LicenceGroup {
  std::string expression;  ///< As stated; "unknown" if none is.
  library::LicenceDecision decision;
  std::vector<std::size_t> clips;  ///< Places in the list of records, ascending.
};

/// Decides on every licence of the clips, ascending by expression. Within one expression
/// the strictest decision counts, if only some of its clips are changed.
[[nodiscard]] std::vector<LicenceGroup> decide_licences(
    std::span<const ClipRecord* const> clips, const ExportOptions& options);

/// Returns one error (kBadInput) with all licences that do not permit the export, their
/// clips' numbers, and the option that permits each; Done if there is none.
[[nodiscard]] Status check_licences(std::span<const LicenceGroup> groups,
                                    const ExportOptions& options);

}  // namespace marey::app

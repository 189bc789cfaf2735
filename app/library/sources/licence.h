// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::app {

/// Returns the licences that spdx_licence() accepts, in SPDX's spelling. The terms of
/// each are in library/export/licence_terms.h.
[[nodiscard]] std::span<const std::string_view> known_licences();

/// Returns a licence in SPDX's spelling: "CC-BY-4.0" for "cc-by-4.0". It is an expression
/// of SPDX (version 2.3, annex D) of known licences, of "LicenseRef-NAME" for others, and
/// of AND, OR, WITH and parentheses; or "unknown".
/// Errors (kBadInput, place "--licence"): an unknown licence or exception, with the
/// nearest one; not an expression.
[[nodiscard]] Result<std::string> spdx_licence(std::string_view text);

}  // namespace marey::app

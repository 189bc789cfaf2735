// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/result.h"
#include "recordings/printed_page.h"

namespace marey::recordings {

/// Writes `document` as a PDF of vectors, true to scale. The same document gives the same
/// bytes on the same machine; letters are those of its sans-serif font. Errors:
/// AtomicFile's; Cairo's own are kInternal.
/// Precondition: at least one page.
[[nodiscard]] Status write_pdf(const std::filesystem::path& path,
                               const PrintedDocument& document);

}  // namespace marey::recordings

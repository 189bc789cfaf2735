// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "recordings/print/printed_page.h"

namespace marey::recordings {

/// Writes `document` as a vector PDF, true to scale. The same document gives the same
/// bytes on the same machine; text uses the machine's sans-serif font. Errors: those of
/// AtomicFile; Cairo's own are kInternal. Precondition: at least one page.
[[nodiscard]] Status write_pdf(const std::filesystem::path& path,
                               const PrintedDocument& document);

}  // namespace marey::recordings

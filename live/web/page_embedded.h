// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "live/web/web_content.h"

namespace marey::live {

/// The page as it was built in: "/", "/page.js", "/page.css", "/icon.svg", gzipped. Built
/// with -DMAREY_VIEWER=OFF, a plain page that says so.
[[nodiscard]] std::vector<WebContent> embedded_page();

}  // namespace marey::live

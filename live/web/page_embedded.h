// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "live/web/web_content.h"

namespace marey::live {

/// Returns the embedded page: "/", "/page.js", "/page.css", "/icon.svg", gzipped. A build
/// with -DMAREY_VIEWER=OFF contains a plain page that states this.
[[nodiscard]] std::vector<WebContent> embedded_page();

}  // namespace marey::live

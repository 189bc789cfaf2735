// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "live/web/received_text.h"

namespace marey::app {

/// Set of the pages that request thumbnails of the cameras. A page in the background
/// withdraws only its own request. A closed page stays in the set until no page is open.
class ThumbnailRequests {
 public:
  void ask(live::ClientId page, bool on) {
    if (on) {
      pages_.insert(page);
    } else {
      pages_.erase(page);
    }
  }
  /// Clears the set when no page is open.
  void reset() { pages_.clear(); }
  [[nodiscard]] bool any() const { return !pages_.empty(); }

 private:
  std::set<live::ClientId> pages_;
};

}  // namespace marey::app

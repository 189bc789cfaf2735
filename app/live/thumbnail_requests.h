// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "live/web/received_text.h"

namespace marey::app {

/// Which pages want cameras' small pictures: one in the background, which does not, takes
/// them from no other. A page that was closed wants them until none is open.
class ThumbnailRequests {
 public:
  void ask(live::ClientId page, bool on) {
    if (on) {
      pages_.insert(page);
    } else {
      pages_.erase(page);
    }
  }
  /// No page is open.
  void forget() { pages_.clear(); }
  [[nodiscard]] bool any() const { return !pages_.empty(); }

 private:
  std::set<live::ClientId> pages_;
};

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/found_figure.h"

#include <algorithm>

namespace marey::library {

void add_place(std::vector<FoundPlace>& places, const FoundPlace& place, int gap) {
  if (!places.empty()) {
    FoundPlace& last = places.back();
    if (last.bone == place.bone && place.frames.first <= last.frames.last + gap + 1) {
      last.frames.last = std::max(last.frames.last, place.frames.last);
      last.value = std::max(last.value, place.value);
      return;
    }
  }
  places.push_back(place);
}

}  // namespace marey::library

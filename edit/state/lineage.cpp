// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/lineage.h"

#include <algorithm>
#include <map>

namespace marey::edit {

Lineage lineage_of_source(int source, int frame_count) {
  Lineage out;
  out.frames.resize(static_cast<std::size_t>(frame_count));
  for (int frame = 0; frame < frame_count; ++frame) {
    FrameLineage& entry = out.frames[static_cast<std::size_t>(frame)];
    entry.source = source;
    entry.source_frame = frame;
  }
  return out;
}

void touch(Lineage& lineage, const FrameRange& frames, int op) {
  std::map<std::optional<std::size_t>, std::size_t> made;
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    FrameLineage& entry = lineage.frames[static_cast<std::size_t>(frame)];
    const auto [place, is_new] = made.try_emplace(entry.history, lineage.touches.size());
    if (is_new) lineage.touches.push_back({op, entry.history});
    entry.history = place->second;
  }
}

std::vector<int> ops_of(const Lineage& lineage, int frame) {
  std::vector<int> out;
  auto history = lineage.frames[static_cast<std::size_t>(frame)].history;
  while (history) {
    out.push_back(lineage.touches[*history].op);
    history = lineage.touches[*history].earlier;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace marey::edit

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/sample_frames.h"

#include <algorithm>
#include <limits>

#include "capture/video/open_frames.h"
#include "core/base/frame_range.h"

namespace marey::capture {

void sample_frames(const std::filesystem::path& path,
                   const std::optional<FrameRange>& range,
                   int count,
                   const std::function<bool(const GrayFrame&)>& visit) {
  auto source = open_frames(path);
  if (!source) return;
  const int first = range ? range->first : 0;
  const int all = (*source)->info().expected_frames.value_or(0);
  const int end = range ? range->last + 1 : std::numeric_limits<int>::max();
  const int frames = std::min(end, range && all == 0 ? end : all) - first;
  const int step = std::max(1, frames / count);
  // Skips the first frames, before the subject enters.
  const int begin = first + step / 2;
  for (int visited = 0; visited < count;) {
    const auto next = (*source)->next();
    if (!next || !*next || (**next).index >= end) return;
    const GrayFrame& frame = **next;
    if (frame.index < begin || (frame.index - begin) % step != 0 || frame.damaged) {
      continue;
    }
    if (!visit(frame)) return;
    ++visited;
  }
}

cv::Mat matrix_of(const GrayFrame& frame) {
  return cv::Mat(frame.height_px,
                 frame.width_px,
                 CV_8UC1,
                 const_cast<std::uint8_t*>(frame.pixels),
                 static_cast<std::size_t>(frame.stride));
}

}  // namespace marey::capture

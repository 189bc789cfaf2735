// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "edit/state/lineage.h"
#include "edit/state/time_map.h"

#include "core/edit/annotation.h"
#include "core/source.h"

namespace marey::edit {

/// Place of a new frame between two frames of the recording that is resampled.
struct FramePlace {
  std::size_t before = 0;
  double share = 0.0;  ///< 0: the frame `before` itself; else towards the next one.
};

/// Returns the places of frames given as indices with their fractions. An index within
/// 1e-9 of a frame is the frame's. Precondition: `at_frame` lies within `count` frames.
[[nodiscard]] std::vector<FramePlace> frame_places(std::span<const double> at_frame,
                                                   std::size_t count);

/// Returns the one of two sources that is trusted less.
[[nodiscard]] Source worse_source(Source a, Source b);

/// Returns the lineage of new frames: source frames are interpolated, and the trust is
/// the worse one of both neighbours. Linear in frames.
[[nodiscard]] Lineage resample_lineage(const Lineage& from,
                                       const std::vector<FramePlace>& places);

/// Returns the annotations of new frames: notes by TimeMap::mapped(), curves interpolated
/// linearly.
[[nodiscard]] Annotations resample_annotations(const Annotations& from,
                                               const std::vector<FramePlace>& places,
                                               const TimeMap& times);

}  // namespace marey::edit

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/frame_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

namespace marey::edit {
namespace {

/// An instant this near to a frame is the frame's. [frames]
constexpr double kOnFrame = 1e-9;

}  // namespace

std::vector<FramePlace> frame_places(std::span<const double> at_frame,
                                     std::size_t count) {
  std::vector<FramePlace> out;
  out.reserve(at_frame.size());
  for (const double at : at_frame) {
    const double nearest = std::round(at);
    if (std::abs(at - nearest) <= kOnFrame || count < 2) {
      out.push_back({static_cast<std::size_t>(nearest), 0.0});
      continue;
    }
    const auto before = std::min(static_cast<std::size_t>(at), count - 2);
    out.push_back({before, at - static_cast<double>(before)});
  }
  return out;
}

Source worse_source(Source a, Source b) {
  return static_cast<int>(a) > static_cast<int>(b) ? a : b;
}

Lineage resample_lineage(const Lineage& from, const std::vector<FramePlace>& places) {
  Lineage out;
  out.touches = from.touches;
  out.frames.reserve(places.size());
  for (const auto& [before, share] : places) {
    FrameLineage entry = from.frames[before];
    if (share > 0.0) {
      const FrameLineage& next = from.frames[before + 1];
      const Source trust = worse_source(entry.trust, next.trust);
      if (next.source == entry.source) {
        entry.source_frame = glm::mix(entry.source_frame, next.source_frame, share);
      } else if (share >= 0.5) {
        entry = next;
      }
      entry.trust = trust;
    }
    out.frames.push_back(entry);
  }
  return out;
}

Annotations resample_annotations(const Annotations& from,
                                 const std::vector<FramePlace>& places,
                                 const TimeMap& times) {
  Annotations out;
  out.notes = times.mapped(from.notes);
  for (const ValueCurve& curve : from.curves) {
    ValueCurve sampled{curve.name, {}};
    sampled.values.reserve(places.size());
    for (const auto& [before, share] : places) {
      const double value = curve.values[before];
      sampled.values.push_back(
          share == 0.0 ? value : glm::mix(value, curve.values[before + 1], share));
    }
    out.curves.push_back(std::move(sampled));
  }
  return out;
}

}  // namespace marey::edit

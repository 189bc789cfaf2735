// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phase_ring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kWithoutEdge_s = std::numeric_limits<double>::infinity();

bool one_flies(PhaseClass a, PhaseClass b) {
  return (a == PhaseClass::kNone) != (b == PhaseClass::kNone);
}

}  // namespace

PhaseRing::PhaseRing(std::span<const Phase> phases, double duration_s, bool loops)
    : phases_(phases), duration_s_(duration_s), loops_(loops) {
  MAREY_ASSERT(!phases.empty());
  MAREY_ASSERT(!loops || duration_s > 0.0);
  if (loops && phases.size() > 1 && phases.front().feet == phases.back().feet) {
    phases_ = phases.subspan(1);
  }
  // One phase without end needs no repetitions.
  loops_ = loops && phases_.size() > 1;
}

std::size_t PhaseRing::edges() const {
  return loops_ ? phases_.size() : phases_.size() - 1;
}

PhaseRing::Place PhaseRing::at(double source_s) const {
  double offset_s = loops_ ? std::floor(source_s / duration_s_) * duration_s_ : 0.0;
  const auto after = std::upper_bound(
      phases_.begin() + 1, phases_.end(), source_s, [&](double time_s, const Phase& p) {
        return time_s < p.start_s + offset_s;
      });
  auto index = static_cast<std::size_t>(after - phases_.begin() - 1);
  if (loops_ && source_s < phases_.front().start_s + offset_s) {
    index = phases_.size() - 1;
    offset_s -= duration_s_;
  }
  return {index, offset_s};
}

PhaseRing::Place PhaseRing::next(Place place) const {
  if (++place.index == phases_.size()) {
    place.index = 0;
    place.offset_s += duration_s_;
  }
  return place;
}

PhaseRing::Place PhaseRing::previous(Place place) const {
  if (place.index == 0) {
    place.index = phases_.size();
    place.offset_s -= duration_s_;
  }
  --place.index;
  return place;
}

double PhaseRing::start_s(Place place) const {
  if (!loops_ && place.index == 0) return -kWithoutEdge_s;
  return phases_[place.index].start_s + place.offset_s;
}

double PhaseRing::end_s(Place place) const {
  if (!loops_ && place.index + 1 == phases_.size()) return kWithoutEdge_s;
  return start_s(next(place));
}

double PhaseRing::after_edge_s(Place place) const {
  const double start = start_s(place);
  while (true) {
    const double edge_s = start_s(place);
    if (edge_s + kFlightEdge_s <= start || edge_s == -kWithoutEdge_s) {
      return -kWithoutEdge_s;
    }
    const Place before = previous(place);
    if (one_flies(feet(before), feet(place))) return edge_s + kFlightEdge_s;
    place = before;
  }
}

double PhaseRing::before_edge_s(Place place) const {
  const double end = end_s(place);
  while (true) {
    const double edge_s = end_s(place);
    if (edge_s - kFlightEdge_s >= end || edge_s == kWithoutEdge_s) return kWithoutEdge_s;
    const Place after = next(place);
    if (one_flies(feet(after), feet(place))) return edge_s - kFlightEdge_s;
    place = after;
  }
}

}  // namespace marey::engine

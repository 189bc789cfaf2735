// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/time_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marey::edit {
namespace {

constexpr double kRounding_s = 1e-9;

}  // namespace

double TimeMap::new_time_s(double old_time_s) const {
  const double frame = old_time_s * old_hz_;
  const std::size_t count = at_frame_.size();
  if (count == 1) return (frame - at_frame_[0]) / old_hz_;
  const auto after = std::upper_bound(at_frame_.begin(), at_frame_.end(), frame);
  const auto place = std::clamp<std::ptrdiff_t>(
      after - at_frame_.begin() - 1, 0, static_cast<std::ptrdiff_t>(count) - 2);
  const auto before = static_cast<std::size_t>(place);
  const double share =
      (frame - at_frame_[before]) / (at_frame_[before + 1] - at_frame_[before]);
  return (static_cast<double>(before) + share) / new_hz_;
}

std::vector<Annotation> TimeMap::mapped(const std::vector<Annotation>& notes) const {
  std::vector<Annotation> out;
  for (const Annotation& note : notes) {
    Annotation moved{note.text, new_time_s(note.start_s), new_time_s(note.end_s)};
    if (moved.end_s < -kRounding_s || moved.start_s > end_s() + kRounding_s) continue;
    moved.start_s = std::clamp(moved.start_s, 0.0, end_s());
    moved.end_s = std::clamp(moved.end_s, 0.0, end_s());
    if (moved.is_event() && !note.is_event()) continue;
    out.push_back(std::move(moved));
  }
  return out;
}

ConstraintSet TimeMap::mapped(const ConstraintSet& set) const {
  ConstraintSet out;
  out.unknown_xml = set.unknown_xml;
  for (const Constraint& constraint : set.constraints) {
    Constraint moved = constraint;
    Activation& when = moved.activation;
    if (when.start_s) {
      const double full_s = new_time_s(*when.start_s + when.start_duration_s);
      when.start_s = new_time_s(*when.start_s);
      when.start_duration_s = full_s - *when.start_s;
      if (*when.start_s > end_s() + kRounding_s) continue;
    }
    if (when.stop_s) {
      const double over_s = new_time_s(*when.stop_s + when.stop_duration_s);
      when.stop_s = new_time_s(*when.stop_s);
      when.stop_duration_s = over_s - *when.stop_s;
      if (over_s < -kRounding_s) continue;
    }
    out.constraints.push_back(std::move(moved));
  }
  return out;
}

std::vector<ContactEdit> TimeMap::mapped(const std::vector<ContactEdit>& edits) const {
  std::vector<ContactEdit> out;
  for (ContactEdit edit : edits) {
    edit.from_s = new_time_s(edit.from_s);
    edit.to_s = new_time_s(edit.to_s);
    const double low_s = std::min(edit.from_s, edit.to_s);
    const double high_s = std::max(edit.from_s, edit.to_s);
    if (high_s < -kRounding_s || low_s > end_s() + kRounding_s) continue;
    out.push_back(edit);
  }
  return out;
}

}  // namespace marey::edit

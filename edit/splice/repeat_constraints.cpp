// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/repeat_constraints.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/constraint_copies.h"
#include "edit/state/full_time.h"
#include "edit/state/move_state.h"

#include "core/base/assert.h"

namespace marey::edit {
namespace {

constexpr double kSameSeam_s = 1e-9;
constexpr double kSeamFade_s = 0.1;
/// Ends of one stance differ by the gap of the cycle, which planting closes.
constexpr GoalTolerance kOneStance{0.010, 1.4e-3};

bool reaches_start(const Constraint& constraint) {
  return full_time(constraint.activation).from_s <= kSameSeam_s;
}

bool reaches_end(const Constraint& constraint, double period_s) {
  return full_time(constraint.activation).to_s >= period_s - kSameSeam_s;
}

const std::string* leader_of(const Constraint& constraint) {
  const auto* goal = std::get_if<DistanceToConstraint>(&constraint.goal);
  return goal == nullptr ? nullptr : &goal->other_id;
}

/// A footprint that was replaced by the one that the foot has since the copy before.
struct SharedFootprint {
  BodyPoint point;
  glm::dvec3 was_in_world{0.0};
  glm::dvec3 is_in_world{0.0};
};

/// Constraints of the copies of a cycle, one copy after the other.
class CycleCopies {
 public:
  CycleCopies(const ConstraintSet& once, double period_s)
      : once_(once), period_s_(period_s), out_(once) {
    for (const Constraint& c : once.constraints) id_[c.id] = c.id;
  }

  void add_copy(const PlanarMove& move, double seam_s) {
    before_ = std::exchange(id_, {});
    continued_.clear();
    footprints_.clear();
    std::vector<std::string> starting;
    // Constraints that may continue another come first: they decide on the footprints.
    for (const Constraint& c : once_.constraints) {
      if (leader_of(c) == nullptr && reaches_start(c)) add(c, move, seam_s, starting);
    }
    // A distance to a constraint follows that constraint.
    while (id_.size() < once_.constraints.size()) {
      const std::size_t done = id_.size();
      for (const Constraint& c : once_.constraints) {
        const std::string* leader = leader_of(c);
        if (id_.contains(c.id) || (leader != nullptr && !id_.contains(*leader))) continue;
        add(c, move, seam_s, starting);
      }
      MAREY_ASSERT(id_.size() > done);
    }
    std::vector<std::string> ending;
    for (const Constraint& c : once_.constraints) {
      if (reaches_end(c, period_s_) && !continued_.contains(c.id)) {
        ending.push_back(before_[c.id]);
      }
    }
    meet_at(seam_s, ending, starting);
  }

  [[nodiscard]] ConstraintSet take() { return std::move(out_); }

 private:
  /// Returns the constraint of the copy before that continues as this one.
  const Constraint* continues_as(const Constraint& original, const Constraint& copy) {
    const Constraint* found = nullptr;
    for (const Constraint& c : once_.constraints) {
      if (!reaches_end(c, period_s_) || continued_.contains(c.id)) continue;
      const Constraint& last = *out_.find(before_[c.id]);
      if (!is_same_point(last.point, copy.point) ||
          !is_same_goal(last.goal, copy.goal, kOneStance)) {
        continue;
      }
      if (found == nullptr || c.id == original.id) found = &c;
    }
    return found;
  }

  void continue_with(const Constraint& last, const Constraint& copy) {
    Constraint& longer = *out_.find(before_[last.id]);
    longer.activation.stop_s = copy.activation.stop_s;
    longer.activation.stop_duration_s = copy.activation.stop_duration_s;
    continued_.insert(last.id);
    const auto* is = std::get_if<Support>(&longer.goal);
    const auto* was = std::get_if<Support>(&copy.goal);
    if (is != nullptr && is->footprint_in_world) {
      footprints_.push_back(
          {copy.point, *was->footprint_in_world, *is->footprint_in_world});
    }
  }

  void share_footprint(Constraint& copy) const {
    auto* const support = std::get_if<Support>(&copy.goal);
    if (support == nullptr || !support->footprint_in_world) return;
    for (const SharedFootprint& shared : footprints_) {
      if (is_same_point(copy.point, shared.point) &&
          *support->footprint_in_world == shared.was_in_world) {
        support->footprint_in_world = shared.is_in_world;
        return;
      }
    }
  }

  void add(const Constraint& original,
           const PlanarMove& move,
           double seam_s,
           std::vector<std::string>& starting) {
    Constraint copy = original;
    move_constraint(move.transform(), copy);
    Activation& when = copy.activation;
    if (when.start_s) *when.start_s += seam_s;
    if (when.stop_s) *when.stop_s += seam_s;
    if (auto* const goal = std::get_if<DistanceToConstraint>(&copy.goal)) {
      goal->other_id = id_[goal->other_id];
    }
    const bool starts = reaches_start(original);
    const Constraint* last = starts ? continues_as(original, copy) : nullptr;
    if (last != nullptr) {
      continue_with(*last, copy);
      id_[original.id] = before_[last->id];
      return;
    }
    share_footprint(copy);
    copy.id = free_constraint_id(out_, original.id);
    id_[original.id] = copy.id;
    if (starts) starting.push_back(copy.id);
    out_.constraints.push_back(std::move(copy));
  }

  /// Limits constraints to their side of a seam. Two on one segment cross-fade.
  void meet_at(double seam_s,
               const std::vector<std::string>& ending,
               const std::vector<std::string>& starting) {
    const double fade_s = std::min(kSeamFade_s, 0.5 * period_s_);
    const auto has_segment = [&](const std::vector<std::string>& ids,
                                 const Constraint& constraint) {
      return std::any_of(ids.begin(), ids.end(), [&](const std::string& id) {
        return out_.find(id)->point.segment == constraint.point.segment;
      });
    };
    for (const std::string& id : ending) {
      Constraint& constraint = *out_.find(id);
      Activation& when = constraint.activation;
      const bool fades = has_segment(starting, constraint);
      const double stop_s = fades ? seam_s - 0.5 * fade_s : seam_s;
      if (when.stop_s && *when.stop_s <= stop_s) continue;
      if (fades || !when.stop_s) when.stop_duration_s = fade_s;
      when.stop_s = stop_s;
    }
    for (const std::string& id : starting) {
      Constraint& constraint = *out_.find(id);
      Activation& when = constraint.activation;
      const bool fades = has_segment(ending, constraint);
      if (fades || !when.start_s) when.start_duration_s = fade_s;
      when.start_s = (fades ? seam_s + 0.5 * fade_s : seam_s) - when.start_duration_s;
      // A short one is full for no time, but does not end before it starts.
      if (when.stop_s) when.stop_s = std::max(*when.stop_s, *when.start_s);
    }
  }

  const ConstraintSet& once_;
  double period_s_;
  ConstraintSet out_;
  std::map<std::string, std::string> id_;      ///< Ids in the newest copy.
  std::map<std::string, std::string> before_;  ///< Ids in the copy before.
  /// Ids in `once_` of constraints of the copy before that continue in the newest one.
  std::set<std::string> continued_;
  std::vector<SharedFootprint> footprints_;  ///< Replaced in the newest copy.
};

}  // namespace

ConstraintSet repeat_constraints(const ConstraintSet& once,
                                 const PlanarMove& step,
                                 double period_s,
                                 int count) {
  CycleCopies copies(once, period_s);
  for (int copy = 1; copy < count; ++copy) {
    copies.add_copy(power(step, copy), copy * period_s);
  }
  return copies.take();
}

}  // namespace marey::edit

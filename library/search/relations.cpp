// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/relations.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <tuple>

#include "library/search/relation_measures.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::array<std::string_view, kRelationCount> kWords = {
    "hand_left above head",
    "hand_right above head",
    "hand_left above shoulder",
    "hand_right above shoulder",
    "hand_left before body",
    "hand_right before body",
    "hand_left behind body",
    "hand_right behind body",
    "hand_left raised",
    "hand_right raised",
    "hands together",
    "left in front",
    "right in front",
    "knee_left bent",
    "knee_right bent",
    "foot_left bears",
    "foot_right bears",
    "flight",
    "crouched",
    "lying",
    "moving",
    "turning_left",
    "turning_right",
};

// State of a measure against its two levels.
enum class LevelState { kNo, kBetween, kYes };

LevelState above(std::optional<double> value, double begins, double lasts) {
  if (!value || *value < lasts) return LevelState::kNo;
  return *value >= begins ? LevelState::kYes : LevelState::kBetween;
}

LevelState below(std::optional<double> value, double begins, double lasts) {
  if (!value) return LevelState::kNo;
  return above(-*value, -begins, -lasts);
}

// Both measures must hold: the lesser state.
LevelState both(LevelState a, LevelState b) {
  return std::min(a, b);
}

LevelState hand_state(const RelationMeasures::Side& side, Relation left_word) {
  switch (left_word) {
    case Relation::kLeftHandAboveHead:
      return above(side.hand_over_head, 0.15, 0.10);
    case Relation::kLeftHandAboveShoulder:
      return above(side.hand_over_shoulder, 0.05, 0.0);
    case Relation::kLeftHandBeforeBody:
      return above(side.hand_before_trunk, 0.30, 0.25);
    case Relation::kLeftHandBehindBody:
      return below(side.hand_before_trunk, -0.10, -0.05);
    case Relation::kLeftHandRaised:
      return above(side.hand_over_elbow, 0.10, 0.05);
    case Relation::kLeftInFront:
      return above(side.ankle_forward, 0.12, 0.08);
    case Relation::kLeftKneeBent:
      return below(side.knee_rad, 120.0 * kDegree, 125.0 * kDegree);
    default:
      break;
  }
  return LevelState::kNo;
}

LevelState body_state(const RelationMeasures& m, Relation relation) {
  switch (relation) {
    case Relation::kHandsTogether:
      return below(m.hands_apart, 0.20, 0.25);
    case Relation::kFlight:
      return above(std::min(m.sides[0].foot_height, m.sides[1].foot_height), 0.04, 0.02);
    case Relation::kCrouched:
      return below(m.hip_height, 0.70, 0.75);
    case Relation::kLying:
      return both(below(m.hip_height, 0.45, 0.50),
                  below(m.trunk_elevation_rad, 30.0 * kDegree, 40.0 * kDegree));
    case Relation::kMoving:
      return above(m.speed, 0.40, 0.25);
    case Relation::kTurningLeft:
      return above(m.turn_rate, 30.0 * kDegree, 20.0 * kDegree);
    case Relation::kTurningRight:
      return above(-m.turn_rate, 30.0 * kDegree, 20.0 * kDegree);
    default:
      break;
  }
  return LevelState::kNo;
}

// Words come in pairs, the left one first, except for those of the whole body.
bool has_sides(Relation relation) {
  return relation < Relation::kHandsTogether ||
         (relation > Relation::kHandsTogether && relation < Relation::kFlight) ||
         relation > Relation::kMoving;
}

Relation left_word(Relation relation) {
  const Relation other = mirrored(relation);
  return std::min(relation, other);
}

LevelState state_of(const RelationMeasures& m, Relation relation) {
  const Relation left = left_word(relation);
  if (!has_sides(relation) || relation > Relation::kMoving) {
    return body_state(m, relation);
  }
  return hand_state(m.sides[relation == left ? 0 : 1], left);
}

std::vector<char> frames_that_hold(const std::vector<RelationMeasures>& measures,
                                   Relation relation) {
  std::vector<char> holds(measures.size(), 0);
  bool is_on = false;
  for (std::size_t k = 0; k < measures.size(); ++k) {
    const LevelState state = state_of(measures[k], relation);
    is_on = state == LevelState::kYes || (is_on && state == LevelState::kBetween);
    holds[k] = is_on ? 1 : 0;
  }
  return holds;
}

std::vector<char> frames_of(const std::vector<FrameRange>& ranges, std::size_t count) {
  std::vector<char> holds(count, 0);
  for (const FrameRange& range : ranges) {
    for (int k = std::max(0, range.first); k <= range.last; ++k) {
      if (static_cast<std::size_t>(k) < count) holds[static_cast<std::size_t>(k)] = 1;
    }
  }
  return holds;
}

void remove_frames(std::vector<char>& holds, const std::vector<char>& others) {
  for (std::size_t k = 0; k < holds.size(); ++k) {
    if (others[k] != 0) holds[k] = 0;
  }
}

void append_runs(Relation relation,
                 const std::vector<char>& holds,
                 std::vector<RelationRun>& runs) {
  for (std::size_t k = 0; k < holds.size(); ++k) {
    if (holds[k] == 0) continue;
    const std::size_t first = k;
    while (k + 1 < holds.size() && holds[k + 1] != 0) ++k;
    runs.push_back({relation, {static_cast<int>(first), static_cast<int>(k)}});
  }
}

}  // namespace

std::string_view name(Relation relation) {
  return kWords[static_cast<std::size_t>(relation)];
}

std::optional<Relation> relation(std::string_view words) {
  const auto found = std::find(kWords.begin(), kWords.end(), words);
  if (found == kWords.end()) return std::nullopt;
  return static_cast<Relation>(found - kWords.begin());
}

Relation mirrored(Relation relation) {
  if (!has_sides(relation)) return relation;
  const int k = static_cast<int>(relation);
  const int first = relation < Relation::kHandsTogether ? 0
                    : relation < Relation::kFlight
                        ? static_cast<int>(Relation::kLeftInFront)
                        : static_cast<int>(Relation::kTurningLeft);
  return static_cast<Relation>(first + ((k - first) ^ 1));
}

std::vector<RelationRun> find_relations(const Motion& motion,
                                        const retarget::BodyMap& map,
                                        const Contacts& contacts) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  const auto measures = measure_relations(motion, map, contacts);
  const std::array<std::vector<char>, 2> bears = {
      frames_of(contacts.feet[0].stance, measures.size()),
      frames_of(contacts.feet[1].stance, measures.size())};
  const std::vector<char> lying = frames_that_hold(measures, Relation::kLying);
  std::vector<RelationRun> runs;
  for (int k = 0; k < kRelationCount; ++k) {
    const auto word = static_cast<Relation>(k);
    std::vector<char> holds;
    if (word == Relation::kLeftFootBears || word == Relation::kRightFootBears) {
      holds = bears[word == Relation::kLeftFootBears ? 0 : 1];
    } else {
      holds = frames_that_hold(measures, word);
    }
    if (word == Relation::kCrouched) remove_frames(holds, lying);
    if (word == Relation::kFlight) {
      remove_frames(holds, bears[0]);
      remove_frames(holds, bears[1]);
    }
    append_runs(word, holds, runs);
  }
  std::stable_sort(
      runs.begin(), runs.end(), [](const RelationRun& a, const RelationRun& b) {
        return std::tie(a.frames.first, a.relation) <
               std::tie(b.frames.first, b.relation);
      });
  return runs;
}

}  // namespace marey::library

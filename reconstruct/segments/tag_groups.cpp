// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/tag_groups.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/clusters/tag_clusters.h"
#include "reconstruct/segments/exchanged_segments.h"

namespace marey::reconstruct {
namespace {

constexpr std::size_t kMaxFrames = 160;
// Pairs that are seen together less often are not compared.
constexpr std::size_t kMinTogether = 30;
constexpr std::size_t kMaxTogether = 80;
// Limits of the turn that nine tenths of the frames stay within. [rad] Tags of one
// segment turn by 1 to 3 degrees relative to each other, slightly more on soft tissue;
// those of neighbours by 7 and more. Misread tags turn by tens of degrees relative to all
// others.
constexpr double kTurnsAway_rad = 0.2;
constexpr double kMovesAsOne_rad = 0.08;
// Largest turn relative to another segment's tags, as a share of that relative to its
// own.
constexpr double kShareOfOwn = 0.33;

using Group = std::vector<std::size_t>;

/// Returns the turn between two tags [rad]: nine tenths of the frames that show both are
/// within it of their medoid. nullopt if fewer than kMinTogether do.
std::optional<double> turn_between(std::size_t a,
                                   std::size_t b,
                                   std::span<const TagPoses> frames) {
  std::vector<glm::dquat> turns;
  for (const TagPoses& frame : frames) {
    const auto in_a = frame.find(a);
    const auto in_b = frame.find(b);
    if (in_a == frame.end() || in_b == frame.end()) continue;
    turns.push_back(glm::conjugate(in_a->second.rotation) * in_b->second.rotation);
  }
  if (turns.size() < kMinTogether) return std::nullopt;
  const std::size_t step = 1 + turns.size() / kMaxTogether;
  std::optional<double> minimum;
  for (std::size_t i = 0; i < turns.size(); i += step) {
    std::vector<double> angles;
    for (std::size_t j = 0; j < turns.size(); j += step) {
      angles.push_back(glm::length(rotation_vector(glm::conjugate(turns[i]) * turns[j])));
    }
    const double within = quantile(std::move(angles), 0.9);
    if (!minimum || within < *minimum) minimum = within;
  }
  return minimum;
}

class Grouping {
 public:
  Grouping(std::span<const TagOnSegment> tags, std::span<const TagPoses> frames)
      : tags_(tags), frames_(frames) {}

  std::vector<HumanBone> run() {
    std::map<HumanBone, Group> declared;
    for (std::size_t tag = 0; tag < tags_.size(); ++tag) {
      declared[solved_segment(tags_[tag].segment)].push_back(tag);
    }
    bool is_split = false;
    for (const auto& [segment, members] : declared) {
      const std::vector<Group> parts = parts_of(members);
      is_split = is_split || parts.size() > 1;
      for (const Group& part : parts) {
        std::optional<double> own;
        for (const Group& other : parts) {
          const auto between = &other == &part ? std::nullopt : min_turn(part, other);
          if (between && (!own || *between < *own)) own = between;
        }
        groups_.push_back(part);
        own_turns_.push_back(own);
      }
    }
    if (is_split) join_loose();
    return labelled();
  }

 private:
  std::optional<double> turn(std::size_t a, std::size_t b) {
    const auto key = std::minmax(a, b);
    const auto known = turns_.find(key);
    if (known != turns_.end()) return known->second;
    return turns_[key] = turn_between(key.first, key.second, frames_);
  }

  /// Returns the smallest turn between two groups' tags; nullopt if none are compared.
  std::optional<double> min_turn(const Group& a, const Group& b) {
    std::optional<double> minimum;
    for (const std::size_t i : a) {
      for (const std::size_t j : b) {
        const auto one = turn(i, j);
        if (one && (!minimum || *one < *minimum)) minimum = one;
      }
    }
    return minimum;
  }

  /// Returns the largest turn between two groups' tags; nullopt if none are compared.
  std::optional<double> max_turn(const Group& a, const Group& b) {
    std::optional<double> maximum;
    for (const std::size_t i : a) {
      for (const std::size_t j : b) {
        const auto one = turn(i, j);
        if (one && (!maximum || *one > *maximum)) maximum = one;
      }
    }
    return maximum;
  }

  /// Splits the tags of one segment into parts that turn relative to each other.
  std::vector<Group> parts_of(const Group& members) {
    std::vector<Group> parts;
    for (const std::size_t tag : members) {
      Group joined{tag};
      std::vector<Group> others;
      for (Group& part : parts) {
        const auto between = min_turn({tag}, part);
        if (between && *between > kTurnsAway_rad) {
          others.push_back(std::move(part));
        } else {
          joined.insert(joined.end(), part.begin(), part.end());
        }
      }
      others.push_back(std::move(joined));
      parts = std::move(others);
    }
    return parts;
  }

  /// Joins parts of segments with the groups that they move with, smallest turn first.
  void join_loose() {
    for (;;) {
      double min_rad = kMovesAsOne_rad;
      std::pair<std::size_t, std::size_t> best{0, 0};
      for (std::size_t i = 0; i < groups_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const auto between = joined_turn(i, j);
          if (!between || *between >= min_rad) continue;
          min_rad = *between;
          best = {j, i};
        }
      }
      if (best.first == best.second) return;
      Group& to = groups_[best.first];
      const Group& from = groups_[best.second];
      to.insert(to.end(), from.begin(), from.end());
      const auto at = static_cast<std::ptrdiff_t>(best.second);
      groups_.erase(groups_.begin() + at);
      if (!own_turns_[best.second]) own_turns_[best.first].reset();
      own_turns_.erase(own_turns_.begin() + at);
    }
  }

  /// Returns the turn between two groups; nullopt unless one is a part of a segment and
  /// turns by far more relative to the segment's other parts.
  std::optional<double> joined_turn(std::size_t i, std::size_t j) {
    if (!own_turns_[i] && !own_turns_[j]) return std::nullopt;
    if (have_neighbours(groups_[i], groups_[j])) return std::nullopt;
    const auto between = max_turn(groups_[i], groups_[j]);
    for (const std::size_t part : {i, j}) {
      if (between && own_turns_[part] && *between > kShareOfOwn * *own_turns_[part]) {
        return std::nullopt;
      }
    }
    return between;
  }

  // Skin near a joint turns with the bone beyond it, that of a forearm with the hand.
  [[nodiscard]] bool have_neighbours(const Group& a, const Group& b) const {
    return std::any_of(a.begin(), a.end(), [&](std::size_t i) {
      return std::any_of(b.begin(), b.end(), [&](std::size_t j) {
        return are_neighbours(solved_segment(tags_[i].segment),
                              solved_segment(tags_[j].segment));
      });
    });
  }

  /// Assigns to each group the segment that most of its tags were declared on, and each
  /// segment to one group. Tags of the other groups keep the declared segments.
  std::vector<HumanBone> labelled() const {
    // Most tags first, then the group with the fewest others: a group with tags of two
    // segments leaves a segment to a group with tags of that segment only.
    std::vector<std::tuple<std::ptrdiff_t, std::size_t, std::size_t, HumanBone>> votes;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::map<HumanBone, std::ptrdiff_t> counts;
      for (const std::size_t tag : groups_[g]) {
        ++counts[solved_segment(tags_[tag].segment)];
      }
      for (const auto& [segment, count] : counts) {
        votes.emplace_back(-count, groups_[g].size(), g, segment);
      }
    }
    std::sort(votes.begin(), votes.end());
    std::vector<HumanBone> segments;
    for (const TagOnSegment& tag : tags_) segments.push_back(solved_segment(tag.segment));
    std::map<std::size_t, HumanBone> given;
    std::vector<HumanBone> taken;
    for (const auto& [count, size, group, segment] : votes) {
      if (given.contains(group) || std::count(taken.begin(), taken.end(), segment) > 0) {
        continue;
      }
      given[group] = segment;
      taken.push_back(segment);
      for (const std::size_t tag : groups_[group]) segments[tag] = segment;
    }
    return segments;
  }

  std::span<const TagOnSegment> tags_;
  std::span<const TagPoses> frames_;
  std::vector<Group> groups_;
  /// By group: turn of a part of a segment relative to the segment's other parts.
  std::vector<std::optional<double>> own_turns_;
  std::map<std::pair<std::size_t, std::size_t>, std::optional<double>> turns_;
};

}  // namespace

std::vector<TagPoses> locate_single_tags(std::span<const Camera> cameras,
                                         std::span<const TagOnSegment> tags,
                                         const Sightings& trial) {
  std::vector<TagPoses> frames;
  const std::size_t step = 1 + trial.frames.size() / kMaxFrames;
  for (std::size_t i = 0; i < trial.frames.size(); i += step) {
    TagPoses& poses = frames.emplace_back();
    for (const TagSighting& sighting : trial.frames[i]) {
      if (poses.contains(sighting.tag)) continue;
      const auto pose = locate_tag(sighting.tag, cameras, tags, trial.frames[i]);
      if (pose) poses[sighting.tag] = *pose;
    }
  }
  return frames;
}

std::vector<HumanBone> segments_by_rigidity(std::span<const TagOnSegment> tags,
                                            std::span<const TagPoses> frames) {
  return Grouping(tags, frames).run();
}

}  // namespace marey::reconstruct

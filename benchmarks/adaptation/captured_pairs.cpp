// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "benchmarks/parts/captured_clips.h"
#include "core/humanoid.h"
#include "core/transform.h"

namespace marey {
namespace {

constexpr double kStill_m = 0.03;
constexpr double kLow_m = 0.05;  // Height of an ankle above its lowest one.
constexpr double kMaxStance_s = 2.0;
constexpr double kMinExcursion_m = 0.15;

/// Joint positions of one frame that determine the pairs. Sides: left, right.
struct Places {
  glm::dvec3 hips{0.0};
  std::array<glm::dvec3, 2> wrists{};
  std::array<glm::dvec3, 2> ankles{};
};

std::vector<Places> places_of(const CapturedClip& clip) {
  const Skeleton& s = clip.character.skeleton;
  std::vector<Places> out;
  for (const Pose& pose : clip.poses) {
    const auto world_from_joint = world_from_joints(s, pose);
    const auto place = [&](HumanBone bone) {
      return world_from_joint[index(*s.find(bone))].translation;
    };
    out.push_back({place(HumanBone::kHips),
                   {place(HumanBone::kLeftHand), place(HumanBone::kRightHand)},
                   {place(HumanBone::kLeftFoot), place(HumanBone::kRightFoot)}});
  }
  return out;
}

double excursion_m(const Places& p, std::size_t standing) {
  return glm::distance(p.wrists[0], p.hips) + glm::distance(p.wrists[1], p.hips) +
         glm::distance(p.ankles[1 - standing], p.ankles[standing]);
}

struct Candidate {
  CapturedPair pair;
  double gain_m = 0.0;
};

class PairFinder {
 public:
  explicit PairFinder(const CapturedClip& clip)
      : places_(places_of(clip)),
        longest_(static_cast<std::size_t>(kMaxStance_s * clip.rate_hz)) {
    for (std::size_t side = 0; side < 2; ++side) {
      lowest_m_[side] = 1e9;
      for (const Places& p : places_) {
        lowest_m_[side] = std::min(lowest_m_[side], p.ankles[side].y);
      }
    }
  }

  [[nodiscard]] std::vector<Candidate> find() const {
    std::vector<Candidate> found;
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t begin = 0; begin < places_.size();) {
        const std::size_t end = end_of_stance(begin, side);
        if (end > begin) look_within(begin, end, side, found);
        begin = std::max(end, begin + 1);
      }
    }
    return found;
  }

 private:
  [[nodiscard]] bool stands(std::size_t frame,
                            std::size_t since,
                            std::size_t side) const {
    const glm::dvec3& ankle = places_[frame].ankles[side];
    return ankle.y < lowest_m_[side] + kLow_m &&
           glm::distance(ankle, places_[since].ankles[side]) < kStill_m;
  }

  [[nodiscard]] std::size_t end_of_stance(std::size_t begin, std::size_t side) const {
    std::size_t end = begin;
    while (end < places_.size() && end - begin < longest_ && stands(end, begin, side)) {
      ++end;
    }
    return end;
  }

  void look_within(std::size_t begin,
                   std::size_t end,
                   std::size_t side,
                   std::vector<Candidate>& found) const {
    std::size_t near = begin;
    std::size_t far = begin;
    for (std::size_t f = begin; f < end; ++f) {
      if (excursion_m(places_[f], side) < excursion_m(places_[near], side)) near = f;
      if (excursion_m(places_[f], side) > excursion_m(places_[far], side)) far = f;
    }
    const double gain_m =
        excursion_m(places_[far], side) - excursion_m(places_[near], side);
    if (gain_m < kMinExcursion_m) return;
    const bool other = stands(near, near, 1 - side) && stands(far, near, 1 - side);
    const CapturedPair pair{near, far, side == 0 || other, side == 1 || other};
    for (const Candidate& c : found) {
      if (c.pair.near_frame == near && c.pair.far_frame == far) return;
    }
    found.push_back({pair, gain_m});
  }

  std::vector<Places> places_;
  std::size_t longest_;
  std::array<double, 2> lowest_m_{};
};

}  // namespace

std::vector<CapturedPair> choose_pairs(const CapturedClip& clip, std::size_t maximum) {
  auto found = PairFinder(clip).find();
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.gain_m > b.gain_m;
  });
  if (found.size() > maximum) found.resize(maximum);
  std::vector<CapturedPair> pairs;
  for (const Candidate& c : found) pairs.push_back(c.pair);
  std::sort(pairs.begin(), pairs.end(), [](const CapturedPair& a, const CapturedPair& b) {
    return a.near_frame < b.near_frame;
  });
  return pairs;
}

}  // namespace marey

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/balance_answers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <glm/geometric.hpp>

#include "benchmarks/adaptation/posture_measures.h"
#include "core/base/degrees.h"
#include "core/humanoid.h"
#include "core/transform.h"

namespace marey {
namespace {

using retarget::Adapter;
using retarget::AdaptOptions;

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

bool is_below(const Skeleton& skeleton, std::size_t joint, std::size_t ancestor) {
  while (joint > ancestor) joint = index(*skeleton.joints[joint].parent);
  return joint == ancestor;
}

ConstraintSet constraints_of(const Skeleton& skeleton, const Question& asked) {
  ConstraintSet set;
  for (const JointIndex joint : asked.standing) {
    Constraint c;
    c.id = skeleton[joint].name;
    c.point.segment = skeleton[joint].name;
    c.goal = Support{};
    set.constraints.push_back(std::move(c));
  }
  for (std::size_t k = 0; k < asked.moved.size(); ++k) {
    Constraint c;
    c.id = skeleton[asked.moved[k]].name;
    c.point.segment = c.id;
    c.goal = DistanceToPoint{0.0, asked.targets_in_world[k]};
    set.constraints.push_back(std::move(c));
  }
  return set;
}

void measure_answer(const Character& body,
                    const Question& asked,
                    const Pose& found,
                    Figures& out) {
  const Skeleton& skeleton = body.skeleton;
  const auto before = world_from_joints(skeleton, *asked.reference);
  const auto after = world_from_joints(skeleton, found);
  double sum_deg = 0.0;
  double chest_deg = 0.0;
  double other_deg = 0.0;
  for (std::size_t j = 0; j < before.size(); ++j) {
    const double deg =
        kDegreesPerRadian * glm::length(rotation_vector(
                                after[j].rotation * glm::conjugate(before[j].rotation)));
    sum_deg += deg;
    bool reaches = false;
    for (const JointIndex moved : asked.moved) {
      const JointIndex lower = *skeleton[moved].parent;
      const std::size_t upper = index(*skeleton[lower].parent);
      reaches = reaches || is_below(skeleton, j, upper);
    }
    if (!reaches) other_deg = std::max(other_deg, deg);
    for (const HumanBone bone : {HumanBone::kSpine,
                                 HumanBone::kChest,
                                 HumanBone::kUpperChest,
                                 HumanBone::kNeck,
                                 HumanBone::kHead}) {
      const auto joint = skeleton.find(bone);
      if (joint && index(*joint) == j) chest_deg = std::max(chest_deg, deg);
    }
  }
  out.mean_deg.push_back(sum_deg / static_cast<double>(before.size()));
  out.chest_deg.push_back(chest_deg);
  out.other_deg.push_back(other_deg);
  double target_m = 0.0;
  for (std::size_t k = 0; k < asked.moved.size(); ++k) {
    target_m = std::max(target_m,
                        glm::distance(after[index(asked.moved[k])].translation,
                                      asked.targets_in_world[k]));
  }
  double foot_m = 0.0;
  for (const JointIndex joint : asked.standing) {
    foot_m = std::max(
        foot_m,
        glm::distance(after[index(joint)].translation, before[index(joint)].translation));
  }
  const glm::dvec3 off =
      centre_of_mass(body, found) - centre_of_mass(body, *asked.reference);
  out.target_mm.push_back(1e3 * target_m);
  out.foot_mm.push_back(1e3 * foot_m);
  out.com_mm.push_back(1e3 * std::hypot(off.x, off.z));
}

}  // namespace

void Figures::add(const Figures& more) {
  append(mean_deg, more.mean_deg);
  append(chest_deg, more.chest_deg);
  append(other_deg, more.other_deg);
  append(target_mm, more.target_mm);
  append(foot_mm, more.foot_mm);
  append(com_mm, more.com_mm);
}

void answer_all(const Character& body, const Question& asked, AllFigures& figures) {
  const ConstraintSet set = constraints_of(body.skeleton, asked);
  for (std::size_t a = 0; a < kAnswerers.size(); ++a) {
    AdaptOptions options;
    options.method = kAnswerers[a].method;
    options.balance = kAnswerers[a].balance;
    auto adapter = Adapter::make(body, set, options);
    if (!adapter) {
      std::fprintf(stderr, "%s\n", adapter.error().message().c_str());
      std::exit(2);
    }
    Pose found;
    static_cast<void>(adapter->adapt(*asked.reference, 1e3, found));
    measure_answer(body, asked, found, figures[a]);
  }
}

}  // namespace marey

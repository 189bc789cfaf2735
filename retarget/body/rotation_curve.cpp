// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/rotation_curve.h"

#include "core/base/assert.h"

namespace marey::retarget {
namespace {

constexpr double kSamePlace = 1e-9;

// Returns the rotation vector per unit of arc length at knot k, in the knot's own frame:
// from the knot before to the knot after, over the arc length between them. (The mean of
// both slopes, weighted by the other's span, would follow a parabola better. But for a
// knot that coincides with the next one, as of a vertebra without length, it would be off
// by whole turns.)
glm::dvec3 slope(const RotationCurve& c, std::size_t k) {
  const auto last = static_cast<std::size_t>(c.count - 1);
  const auto turn = [&](std::size_t from, std::size_t to) {
    return rotation_vector(glm::conjugate(c.rotation[from]) * c.rotation[to]);
  };
  if (k == 0) return turn(0, 1) / (c.at[1] - c.at[0]);
  if (k == last) return -turn(last, last - 1) / (c.at[last] - c.at[last - 1]);
  return (turn(k, k + 1) - turn(k, k - 1)) / (c.at[k + 1] - c.at[k - 1]);
}

}  // namespace

void RotationCurve::add(double where, const glm::dquat& value) {
  if (count > 0 && where - at[static_cast<std::size_t>(count - 1)] < kSamePlace) --count;
  MAREY_ASSERT(count < static_cast<int>(at.size()));
  at[static_cast<std::size_t>(count)] = where;
  rotation[static_cast<std::size_t>(count)] = value;
  ++count;
}

glm::dquat sample(const RotationCurve& curve, double where) {
  MAREY_ASSERT(curve.count > 0);
  const auto last = static_cast<std::size_t>(curve.count - 1);
  std::size_t k = 0;
  while (k < last && curve.at[k + 1] <= where + kSamePlace) ++k;
  if (k == last || where <= curve.at[k] + kSamePlace) return curve.rotation[k];

  const double span = curve.at[k + 1] - curve.at[k];
  const double t = (where - curve.at[k]) / span;
  const glm::dquat& q0 = curve.rotation[k];
  const glm::dquat& q3 = curve.rotation[k + 1];
  const glm::dquat q1 = q0 * rotation_from_vector(slope(curve, k) * (span / 3.0));
  const glm::dquat q2 = q3 * rotation_from_vector(slope(curve, k + 1) * (-span / 3.0));
  const glm::dquat q01 = glm::slerp(q0, q1, t);
  const glm::dquat q12 = glm::slerp(q1, q2, t);
  const glm::dquat q23 = glm::slerp(q2, q3, t);
  return glm::slerp(glm::slerp(q01, q12, t), glm::slerp(q12, q23, t), t);
}

}  // namespace marey::retarget

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/find_flights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"

namespace marey::dynamics {
namespace {

using B = HumanBone;

constexpr double kGravity = 9.81;  // [m/s^2]
// A crouching body falls with hardly more than half of this acceleration.
constexpr double kFalling = 0.6;
// Largest relative error of free fall due to masses that are not this person's.
constexpr double kMaxOff = 0.15;
// Share of free fall at the limits of a flight: accelerations vary by a few percent.
constexpr double kReached = 0.92;

/// A segment from one joint to another, or to the tip of the first if both are equal.
struct MassOnBone {
  B from, to;
  double mass;   ///< Share of the body's mass.
  double along;  ///< Place of its centre, from the first joint.
};

// Trunk from mid hip to cervicale and head from there to the vertex, the paper's
// alternatives; foot from the ankle to the ball.
constexpr std::array kMasses{
    MassOnBone{B::kHips, B::kNeck, 0.4346, 0.486},
    MassOnBone{B::kHead, B::kHead, 0.0694, 0.5},
    MassOnBone{B::kLeftUpperArm, B::kLeftLowerArm, 0.0271, 0.577},
    MassOnBone{B::kRightUpperArm, B::kRightLowerArm, 0.0271, 0.577},
    MassOnBone{B::kLeftLowerArm, B::kLeftHand, 0.0162, 0.457},
    MassOnBone{B::kRightLowerArm, B::kRightHand, 0.0162, 0.457},
    MassOnBone{B::kLeftHand, B::kLeftHand, 0.0061, 0.36},
    MassOnBone{B::kRightHand, B::kRightHand, 0.0061, 0.36},
    MassOnBone{B::kLeftUpperLeg, B::kLeftLowerLeg, 0.1416, 0.410},
    MassOnBone{B::kRightUpperLeg, B::kRightLowerLeg, 0.1416, 0.410},
    MassOnBone{B::kLeftLowerLeg, B::kLeftFoot, 0.0433, 0.446},
    MassOnBone{B::kRightLowerLeg, B::kRightFoot, 0.0433, 0.446},
    MassOnBone{B::kLeftFoot, B::kLeftToes, 0.0137, 0.5},
    MassOnBone{B::kRightFoot, B::kRightToes, 0.0137, 0.5},
};

/// Returns the heights of the centre of mass above the floor. [m]
std::vector<double> heights(const Motion& motion) {
  std::vector<double> out;
  out.reserve(motion.poses.size());
  std::vector<RigidTransform> joints(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, joints);
    double moment = 0.0;
    double mass = 0.0;
    for (const MassOnBone& one : kMasses) {
      const std::size_t from = index(one.from);
      const glm::dvec3 tip =
          motion.skeleton.joints[from].tip_in_joint.value_or(glm::dvec3(0.0));
      const double start = joints[from].translation.y;
      const double end = one.from == one.to ? (joints[from] * tip).y
                                            : joints[index(one.to)].translation.y;
      moment += one.mass * (start + one.along * (end - start));
      mass += one.mass;
    }
    out.push_back(moment / mass);
  }
  return out;
}

/// Returns the accelerations of the parabola through `reach` values on either side of
/// each, by least squares; 0 if there are fewer. [m/s^2]
std::vector<double> accelerations(const std::vector<double>& y,
                                  std::size_t reach,
                                  double rate_hz) {
  std::vector<double> out(y.size(), 0.0);
  const auto n = static_cast<double>(2 * reach + 1);
  const auto square = [&](std::size_t k) {
    const double t = static_cast<double>(k) - static_cast<double>(reach);
    return t * t;
  };
  double s2 = 0.0;
  double s4 = 0.0;
  for (std::size_t k = 0; k <= 2 * reach; ++k) {
    s2 += square(k);
    s4 += square(k) * square(k);
  }
  for (std::size_t i = reach; i + reach < y.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k <= 2 * reach; ++k) {
      sum += (n * square(k) - s2) * (y[i - reach + k] - y[i]);
    }
    out[i] = 2.0 * sum / (n * s4 - s2 * s2) * rate_hz * rate_hz;
  }
  return out;
}

/// Returns the position where the line from value a[i] to a[i + 1] reaches `level`.
double crossing(const std::vector<double>& a, std::size_t i, double level) {
  return static_cast<double>(i) + (level - a[i]) / (a[i + 1] - a[i]);
}

/// Returns the height at a position between two poses.
double height(const std::vector<double>& y, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), y.size() - 2);
  return y[i] + (place - static_cast<double>(i)) * (y[i + 1] - y[i]);
}

}  // namespace

std::vector<Flight> find_flights(const Motion& motion,
                                 const FindFlightsOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  MAREY_ASSERT(motion.skeleton.joints.size() == kHumanBoneCount);
  const double rate_hz = motion.rate.hz;
  const auto reach = static_cast<std::size_t>(
      std::max(2.0, std::round(0.5 * options.smoothing_s * rate_hz)));
  const std::vector<double> y = heights(motion);
  const std::vector<double> a = accelerations(y, reach, rate_hz);
  std::vector<Flight> flights;
  std::size_t end = 0;
  for (std::size_t first = 0; first < a.size(); first = end + 1) {
    for (end = first; end < a.size() && a[end] < -kFalling * kGravity;) ++end;
    if (static_cast<double>(end - first) < options.min_flight_s * rate_hz) continue;
    // Intervals next to poses without an acceleration can have begun earlier, or end
    // later.
    if (first <= reach || end + reach >= a.size() || end == first) continue;
    std::vector<double> falling(a.begin() + static_cast<std::ptrdiff_t>(first),
                                a.begin() + static_cast<std::ptrdiff_t>(end));
    Flight flight;
    flight.acceleration_m_s2 = median(std::move(falling));
    if (flight.acceleration_m_s2 > -(1.0 - kMaxOff) * kGravity) continue;
    const double level = kReached * std::max(flight.acceleration_m_s2, -kGravity);
    std::size_t in = first;
    while (a[in] > level) ++in;
    std::size_t out = end - 1;
    while (a[out] > level) --out;
    const double takeoff = crossing(a, in - 1, level);
    const double landing = crossing(a, out, level);
    flight.takeoff_s = takeoff / rate_hz;
    flight.landing_s = landing / rate_hz;
    const double start_m = height(y, takeoff);
    const double max_m =
        *std::max_element(y.begin() + static_cast<std::ptrdiff_t>(in),
                          y.begin() + static_cast<std::ptrdiff_t>(out + 1));
    flight.rise_m = std::max(0.0, max_m - start_m);
    flights.push_back(flight);
  }
  return flights;
}

}  // namespace marey::dynamics

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/cross_validate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::calib {
namespace {

// Relative error below which additional unknowns are accepted.
constexpr double kMaxErrorRatio = 0.97;

double inlier_rms_px(const RigModel& model) {
  double sum = 0.0;
  int count = 0;
  for (const Sighting& sighting : model.sightings) {
    if (sighting.is_outlier) continue;
    for (const double e : errors_px(model, sighting)) {
      sum += e * e;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

/// Returns the mean squared error of inliers by camera and frame.
std::map<std::pair<std::size_t, int>, double> frame_errors(const RigModel& model) {
  std::map<std::pair<std::size_t, int>, std::pair<double, int>> sums;
  for (const Sighting& sighting : model.sightings) {
    if (sighting.is_outlier || model.targets[sighting.target].stays) continue;
    auto& [sum, count] = sums[{sighting.camera, sighting.frame}];
    for (const double e : errors_px(model, sighting)) {
      sum += e * e;
      ++count;
    }
  }
  std::map<std::pair<std::size_t, int>, double> means;
  for (const auto& [frame, of] : sums) {
    if (of.second > 0) means[frame] = of.first / of.second;
  }
  return means;
}

RefineOptions places_only() {
  RefineOptions options;
  options.intrinsics = false;
  options.camera_poses = false;
  options.covariance = false;
  options.quick = true;
  return options;
}

/// Returns the expected squared distance of the centre from its true position. [m^2]
double centre_variance(const RigCovariance& covariance, std::size_t camera) {
  constexpr std::size_t kCentre = Intrinsics::kParameterCount + 3;
  const std::size_t at = RigCovariance::kPerCamera * camera + kCentre;
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum += covariance.at(at + i, at + i);
  return sum;
}

/// Fills the results of the halves in time, if both have enough data.
void compare_in_time(const RigModel& model,
                     const RefineOptions& options,
                     Steps& steps,
                     CrossValidation& out) {
  RigModel first = half_in_time(model, 0);
  RigModel second = half_in_time(model, 1);
  RefineOptions refine = options;
  refine.covariance = true;
  refine.quick = true;
  const auto uncertainty = refine_rig(first, refine);
  steps.step();
  if (!uncertainty || uncertainty->covariance.values.empty()) return;
  const auto other = refine_rig(second, refine);
  if (!other || other->covariance.values.empty()) return;
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    out.time_apart_m.push_back(
        glm::distance(first.cameras[c].world_from_camera.translation,
                      second.cameras[c].world_from_camera.translation));
    out.time_expected_m.push_back(std::sqrt(centre_variance(uncertainty->covariance, c) +
                                            centre_variance(other->covariance, c)));
  }
}

std::optional<double> without_camera_px(const RigModel& model, std::size_t camera) {
  RigModel others = model;
  std::erase_if(others.sightings, [&](const Sighting& s) { return s.camera == camera; });
  std::set<std::pair<std::size_t, int>> known;
  for (const Sighting& s : others.sightings) known.insert({s.target, s.instant});
  if (others.sightings.empty() || !refine_rig(others, places_only())) return std::nullopt;
  std::vector<double> errors;
  for (const Sighting& s : model.sightings) {
    const RigidTarget& target = model.targets[s.target];
    if (s.camera != camera || s.is_outlier || target.stays) continue;
    if (target.knot_spacing_s <= 0.0 && !known.contains({s.target, s.instant})) continue;
    const std::vector<double> own = errors_px(others, s);
    errors.insert(errors.end(), own.begin(), own.end());
  }
  if (errors.empty()) return std::nullopt;
  return median(std::move(errors));
}

}  // namespace

RigModel half_of(const RigModel& model, int parity) {
  RigModel half = model;
  std::erase_if(half.sightings, [&](const Sighting& s) {
    return !model.targets[s.target].stays && std::abs(s.frame) % 2 != parity;
  });
  return half;
}

RigModel half_in_time(const RigModel& model, int half) {
  std::vector<int> frames;
  for (const Sighting& s : model.sightings) {
    if (!model.targets[s.target].stays) frames.push_back(s.frame);
  }
  RigModel out = model;
  if (frames.empty()) return out;
  const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
  std::nth_element(frames.begin(), middle, frames.end());
  std::erase_if(out.sightings, [&](const Sighting& s) {
    return !model.targets[s.target].stays && (s.frame < *middle ? 0 : 1) != half;
  });
  return out;
}

std::optional<RigModel> held_out_model(const RigModel& solved, const RigModel& held_out) {
  RigModel tested = held_out;
  tested.cameras = solved.cameras;
  for (std::size_t t = 0; t < tested.targets.size(); ++t) {
    tested.targets[t].warp_m = solved.targets[t].warp_m;
    tested.targets[t].bends = solved.targets[t].bends;
  }
  if (!refine_rig(tested, places_only())) return std::nullopt;
  return tested;
}

bool predicts_better(const RigModel& model, const RigModel& simpler) {
  const auto model_errors = frame_errors(model);
  const auto simpler_errors = frame_errors(simpler);
  std::vector<double> falls;  // Reduction of each frame's mean squared error.
  double sum_ours = 0.0;
  double sum_theirs = 0.0;
  for (const auto& [frame, squares] : simpler_errors) {
    const auto found = model_errors.find(frame);
    if (found == model_errors.end()) continue;
    falls.push_back(squares - found->second);
    sum_ours += found->second;
    sum_theirs += squares;
  }
  const auto n = static_cast<double>(falls.size());
  if (n < 2.0 || sum_ours >= kMaxErrorRatio * kMaxErrorRatio * sum_theirs) return false;
  const double mean = (sum_theirs - sum_ours) / n;
  double spread = 0.0;
  for (const double fall : falls) spread += (fall - mean) * (fall - mean);
  return mean > 2.0 * std::sqrt(spread / (n - 1.0) / n);
}

std::optional<CrossValidation> cross_validate(const RigModel& model,
                                              const RefineOptions& options,
                                              Steps& steps) {
  RefineOptions quick = options;
  quick.covariance = false;
  quick.quick = true;
  RigModel even = half_of(model, 0);
  RigModel odd = half_of(model, 1);
  if (!refine_rig(even, quick)) return std::nullopt;
  steps.step();
  if (!refine_rig(odd, quick)) return std::nullopt;
  steps.step();
  const auto held_out = held_out_model(even, half_of(model, 1));
  if (!held_out) return std::nullopt;
  steps.step();
  CrossValidation out;
  out.seen_rms_px = inlier_rms_px(even);
  out.held_out_rms_px = inlier_rms_px(*held_out);
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    const RigCamera& a = even.cameras[c];
    const RigCamera& b = odd.cameras[c];
    out.centre_apart_m.push_back(
        glm::distance(a.world_from_camera.translation, b.world_from_camera.translation));
    out.turn_apart_rad.push_back(glm::length(rotation_vector(
        glm::conjugate(a.world_from_camera.rotation) * b.world_from_camera.rotation)));
    out.focal_apart_px.push_back(a.intrinsics.focal_px.x - b.intrinsics.focal_px.x);
    out.held_out_camera_px.push_back(without_camera_px(model, c));
    steps.step();
  }
  compare_in_time(model, options, steps, out);
  return out;
}

void widen_by_halves(CalibratedRig& rig) {
  constexpr double kMaxExpectedRatio = 2.0;
  if (!rig.cross_validation || rig.cross_validation->time_apart_m.empty()) return;
  std::vector<double> factors(rig.covariance.size(), 1.0);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const double expected_m = rig.cross_validation->time_expected_m[c];
    if (!(expected_m > 0.0)) continue;
    const double ratio = rig.cross_validation->time_apart_m[c] / expected_m;
    if (ratio <= kMaxExpectedRatio) continue;
    rig.quality[c].centre_sigma_m *= ratio;
    rig.quality[c].focal_sigma_px *= ratio;
    if (rig.covariance.values.empty()) continue;
    std::fill_n(
        factors.begin() + static_cast<std::ptrdiff_t>(RigCovariance::kPerCamera * c),
        RigCovariance::kPerCamera,
        ratio);
  }
  const std::size_t size = rig.covariance.values.empty() ? 0 : rig.covariance.size();
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = 0; column < size; ++column) {
      rig.covariance.values[row * size + column] *= factors[row] * factors[column];
    }
  }
}

bool find_warp(RigModel& model, const RefineOptions& options) {
  RigModel bent = model;
  for (RigidTarget& target : bent.targets) target.bends = !target.stays;
  RefineOptions quick = options;
  quick.covariance = false;
  quick.quick = true;
  std::array<std::array<double, 3>, 2> warp_m{};
  for (int parity = 0; parity < 2; ++parity) {
    RigModel half = half_of(bent, parity);
    if (half.targets.size() < 2 || !refine_rig(half, quick)) return false;
    warp_m[static_cast<std::size_t>(parity)] = half.targets[1].warp_m;
  }
  double apart = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    apart += std::pow(warp_m[0][i] - warp_m[1][i], 2.0);
    size += std::pow(0.5 * (warp_m[0][i] + warp_m[1][i]), 2.0);
  }
  if (std::sqrt(size) < 1e-4 || std::sqrt(apart) > 0.5 * std::sqrt(size)) return false;
  for (std::size_t t = 0; t < model.targets.size(); ++t) {
    model.targets[t].bends = bent.targets[t].bends;
  }
  return true;
}

}  // namespace marey::calib

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/refine_rig.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "calib/bundle/bundle_problem.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr int kRebuilds = 4;

double width_of(const RigModel& model, const Sighting& sighting) {
  return model.cameras[sighting.camera].intrinsics.width_px;
}

/// Returns the root mean square of a sighting's errors, in sigmas of one coordinate;
/// nullopt if it has none.
std::optional<double> error_in_sigmas(const RigModel& model, const Sighting& sighting) {
  const std::vector<double> errors = errors_px(model, sighting);
  if (errors.empty()) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double e = errors[i] / sighting.corners[i].sigma_px;
    sum += 0.5 * e * e;
  }
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

void leave_out_the_unplaced(RigModel& model) {
  for (Sighting& sighting : model.sightings) {
    const std::vector<double> errors = errors_px(model, sighting);
    sighting.is_outlier =
        errors.empty() ||
        *std::max_element(errors.begin(), errors.end()) >= width_of(model, sighting);
  }
}

/// Marks sightings with an error above a multiple of their camera's typical error.
void mark_outliers(RigModel& model) {
  std::vector<std::vector<double>> errors(model.cameras.size());
  std::vector<std::optional<double>> own(model.sightings.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    own[i] = error_in_sigmas(model, model.sightings[i]);
    if (own[i]) errors[model.sightings[i].camera].push_back(*own[i]);
  }
  std::vector<double> usual(model.cameras.size(), 1.0);
  for (std::size_t c = 0; c < usual.size(); ++c) {
    if (errors[c].empty()) continue;
    // For few sightings, the fit may make the residuals too small.
    usual[c] = std::max(1.0, median(std::move(errors[c])));
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    Sighting& sighting = model.sightings[i];
    // A threshold for eight coordinates of a tag is lower than for the two of a point.
    const double max_px = (sighting.count == 4 ? 3.0 : 3.7) * usual[sighting.camera];
    sighting.is_outlier = !own[i] || *own[i] > max_px;
  }
}

bool solve_once(RigModel& model, const RefineOptions& options, bool robust) {
  BundleProblem problem(model, options, robust);
  if (!problem.solve()) return false;
  problem.write_back(model);
  return true;
}

/// The knots of a sighting depend on the clocks: rebuilt until the clocks converge.
bool solve(RigModel& model, const RefineOptions& options, bool robust) {
  for (int i = 0; i < kRebuilds; ++i) {
    std::vector<double> offsets;
    for (const RigCamera& camera : model.cameras) offsets.push_back(camera.offset_s);
    if (!solve_once(model, options, robust)) return false;
    double moved_s = 0.0;
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      moved_s = std::max(moved_s, std::abs(model.cameras[c].offset_s - offsets[c]));
    }
    if (moved_s < 1e-4) break;
  }
  return true;
}

/// Enlarges the clock sigmas by the effects that were not solved for: drift and line
/// delay, with their priors, and the residuals.
void set_clock_sigmas(const RigModel& model,
                      const RefineOptions& options,
                      RigUncertainty& uncertainty) {
  RefineOptions all = options;
  all.drifts = true;
  all.line_delays = true;
  if (options.drifts && options.line_delays) return;
  const auto wide = BundleProblem(model, all, false).uncertainty();
  if (!wide) return;
  for (std::size_t c = 0; c < uncertainty.clocks.size(); ++c) {
    ClockSigma& clock = uncertainty.clocks[c];
    const ClockSigma& other = wide->clocks[c];
    clock.offset_s = std::max(clock.offset_s, other.offset_s);
    if (options.drifts) clock.drift = std::max(clock.drift, other.drift);
    if (options.line_delays) {
      clock.line_delay_s = std::max(clock.line_delay_s, other.line_delay_s);
    }
  }
}

}  // namespace

std::optional<RigUncertainty> refine_rig(RigModel& model, const RefineOptions& options) {
  leave_out_the_unplaced(model);
  if (!solve(model, options, true)) return std::nullopt;
  mark_outliers(model);
  if (!solve(model, options, false)) return std::nullopt;
  if (!options.covariance) return RigUncertainty{};
  auto uncertainty = BundleProblem(model, options, false).uncertainty();
  if (uncertainty && options.offsets) set_clock_sigmas(model, options, *uncertainty);
  return uncertainty;
}

}  // namespace marey::calib

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/refine_rig.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "calib/bundle_problem.h"
#include "core/assert.h"
#include "core/quantile.h"

namespace marey::calib {
namespace {

constexpr int kRebuilds = 4;

double width_of(const RigModel& model, const Sighting& sighting) {
  return model.cameras[sighting.camera].intrinsics.width_px;
}

/// Root mean square of a sighting's errors, in sigmas of one coordinate; nullopt where it
/// has none.
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

/// Per camera, sightings of more than this many times what is usual there.
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
    // Of a few sightings that the solver can please, the error says little.
    usual[c] = std::max(1.0, median(std::move(errors[c])));
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    Sighting& sighting = model.sightings[i];
    // Eight coordinates of a tag err alike less often than the two of a point.
    const double most = (sighting.count == 4 ? 3.0 : 3.7) * usual[sighting.camera];
    sighting.is_outlier = !own[i] || *own[i] > most;
  }
}

bool solve_once(RigModel& model, const RefineOptions& options, bool robust) {
  BundleProblem problem(model, options, robust);
  if (!problem.solve()) return false;
  problem.write_back(model);
  return true;
}

/// The knots about a sighting follow the clocks: rebuilt until these rest.
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

/// A clock is no surer than what was left out of it allows: that it drifts, and that rows
/// follow each other. Both are as their priors have them, and as the data.
void doubt_clocks(const RigModel& model, const RefineOptions& options, RigDoubt& doubt) {
  RefineOptions all = options;
  all.drifts = true;
  all.line_delays = true;
  if (options.drifts && options.line_delays) return;
  const auto wide = BundleProblem(model, all, false).doubt();
  if (!wide) return;
  for (std::size_t c = 0; c < doubt.clocks.size(); ++c) {
    ClockSigma& clock = doubt.clocks[c];
    const ClockSigma& other = wide->clocks[c];
    clock.offset_s = std::max(clock.offset_s, other.offset_s);
    if (options.drifts) clock.drift = std::max(clock.drift, other.drift);
    if (options.line_delays) {
      clock.line_delay_s = std::max(clock.line_delay_s, other.line_delay_s);
    }
  }
}

}  // namespace

std::optional<RigDoubt> refine_rig(RigModel& model, const RefineOptions& options) {
  leave_out_the_unplaced(model);
  if (!solve(model, options, true)) return std::nullopt;
  mark_outliers(model);
  if (!solve(model, options, false)) return std::nullopt;
  if (!options.covariance) return RigDoubt{};
  auto doubt = BundleProblem(model, options, false).doubt();
  if (doubt && options.offsets) doubt_clocks(model, options, *doubt);
  return doubt;
}

}  // namespace marey::calib

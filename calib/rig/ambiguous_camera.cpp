// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/ambiguous_camera.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/bundle/refine_rig.h"
#include "calib/model/planar_pose.h"

namespace marey::calib {
namespace {

constexpr std::size_t kMaxShared = 8;
// A second solution nearer than this is within the uncertainty of the first.
constexpr double kMinDistance_m = 0.1;
constexpr double kMinAngle_rad = 0.05;
// Difference of costs in squared sigmas; exceeded by chance once in some thousand cases.
constexpr double kMaxCostRise = 16.0;

/// A board at one instant in one camera.
struct SharedView {
  RigidTransform world_from_target;
  std::vector<glm::dvec3> p_in_target;
  std::vector<glm::dvec2> pixels_px;
  std::vector<double> sigmas_px;
};

/// Returns the views of the moving board that another camera shares.
std::vector<SharedView> shared_views_of(const RigModel& model, std::size_t camera) {
  using Key = std::pair<std::size_t, int>;
  std::map<Key, std::set<std::size_t>> seen_by;
  for (const Sighting& s : model.sightings) {
    if (!s.is_outlier) seen_by[{s.target, s.instant}].insert(s.camera);
  }
  std::map<Key, SharedView> views;
  for (const Sighting& s : model.sightings) {
    const RigidTarget& target = model.targets[s.target];
    const Key key(s.target, s.instant);
    const bool is_of_use = s.camera == camera && !s.is_outlier &&
                           target.knot_spacing_s <= 0.0 && target.pieces.empty() &&
                           seen_by.at(key).size() > 1;
    const auto pose = is_of_use ? world_from_target(model, s) : std::nullopt;
    if (!pose) continue;
    SharedView& view = views[key];
    view.world_from_target = *pose;
    std::array<glm::dvec2, 4> seen{};
    for (std::size_t i = 0; i < 4; ++i) seen[i] = s.corners[i].pixel_px;
    if (s.count == 4) seen = unshrunk(seen, model.cameras[camera].shrinkage);
    for (int i = 0; i < s.count; ++i) {
      view.p_in_target.push_back(corner_in_target(target, s, i));
      view.pixels_px.push_back(seen[static_cast<std::size_t>(i)]);
      view.sigmas_px.push_back(s.corners[static_cast<std::size_t>(i)].sigma_px);
    }
  }
  std::vector<SharedView> out;
  for (auto& [key, view] : views) out.push_back(std::move(view));
  return out;
}

struct Placed {
  RigidTransform world_from_camera;
  double cost = 0.0;  ///< In squared sigmas.
  double rms_px = 0.0;
};

/// Returns the camera pose nearest to a start that fits its views, boards held.
std::optional<Placed> fit_camera_pose(const RigCamera& camera,
                                      const std::vector<SharedView>& views,
                                      const RigidTransform& start) {
  RigModel model;
  model.cameras.push_back(camera);
  model.cameras[0].world_from_camera = start;
  model.cameras[0].shrinkage = {};
  model.targets.emplace_back();
  model.targets[0].stays = true;
  model.targets[0].world_from_target[0] = RigidTransform{};
  for (const SharedView& view : views) {
    for (std::size_t i = 0; i < view.p_in_target.size(); ++i) {
      Sighting sighting;
      sighting.count = 1;
      sighting.corners[0] = {view.world_from_target * view.p_in_target[i],
                             view.pixels_px[i],
                             view.sigmas_px[i]};
      model.sightings.push_back(sighting);
    }
  }
  RefineOptions refine;
  refine.intrinsics = false;
  refine.covariance = false;
  if (!refine_rig(model, refine)) return std::nullopt;
  Placed out{model.cameras[0].world_from_camera, 0.0, 0.0};
  double squares = 0.0;
  for (const Sighting& sighting : model.sightings) {
    const std::vector<double> errors = errors_px(model, sighting);
    if (errors.empty()) return std::nullopt;
    const double sigmas = errors[0] / sighting.corners[0].sigma_px;
    // Limits the effect of one wrong tag on the comparison.
    out.cost += std::min(sigmas * sigmas, 25.0);
    squares += errors[0] * errors[0];
  }
  out.rms_px = std::sqrt(squares / static_cast<double>(model.sightings.size()));
  return out;
}

bool is_elsewhere(const RigidTransform& a, const RigidTransform& b) {
  return glm::distance(a.translation, b.translation) > kMinDistance_m ||
         glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation)) >
             kMinAngle_rad;
}

}  // namespace

std::optional<AmbiguousCamera> ambiguous_camera(const RigModel& model) {
  std::optional<AmbiguousCamera> worst;
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    const std::vector<SharedView> views = shared_views_of(model, c);
    if (views.empty() || views.size() > kMaxShared) continue;
    const RigCamera& camera = model.cameras[c];
    const auto found = fit_camera_pose(camera, views, camera.world_from_camera);
    if (!found) continue;
    for (const SharedView& view : views) {
      for (const PlacedPlane& plane :
           place_plane(camera.intrinsics, view.p_in_target, view.pixels_px)) {
        const RigidTransform start =
            view.world_from_target * inverse(plane.camera_from_plane);
        if (!is_elsewhere(start, camera.world_from_camera)) continue;
        const auto other = fit_camera_pose(camera, views, start);
        if (!other || other->cost > found->cost + kMaxCostRise ||
            !is_elsewhere(other->world_from_camera, found->world_from_camera)) {
          continue;
        }
        const double apart_m = glm::distance(other->world_from_camera.translation,
                                             found->world_from_camera.translation);
        if (worst && worst->apart_m >= apart_m) continue;
        worst = AmbiguousCamera{CameraId{static_cast<int>(c)},
                                static_cast<int>(views.size()),
                                apart_m,
                                found->rms_px,
                                other->rms_px};
      }
    }
  }
  return worst;
}

}  // namespace marey::calib
